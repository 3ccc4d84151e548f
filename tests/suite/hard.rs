//! Every hard case is a test by its name: `cargo test --test hard` runs one in three, chosen at random, or with a word of a name behind it all of that
//! name. `bryant stability` runs all.

#[path = "share.rs"]
mod share;

use bryant::stability::report::text::text;
use bryant::stability::{Scenes, run_case};
use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;

fn main() {
    let arguments = Arguments::from_args();
    let scenes = Arc::new(Scenes::new());
    let cases = bryant_hard::cases();
    let chosen = match arguments.filter {
        Some(_) => cases,
        None => share::share(3, cases),
    };
    let trials = chosen.into_iter().map(|case| {
        let scenes = Arc::clone(&scenes);
        let name = format!("{}: {}", case.group.title(), case.name);
        Trial::test(name, move || {
            let outcome = run_case(&case, &*scenes, false);
            match outcome.holds() {
                true => Ok(()),
                false => Err(Failed::from(text(&[outcome], false))),
            }
        })
    });
    libtest_mimic::run(&arguments, trials.collect()).exit();
}
