//! Every hard case is a test by its name: `cargo test --test hard` runs one in three, and one in twelve of those over a
//! million steps, chosen at random; with a word of a name behind it, all of that name. `bryant stability` runs all.

#[path = "share.rs"]
mod share;

use bryant::stability::report::text::text;
use bryant::stability::{Scenes, run_case};
use bryant_hard::Case;
use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;

fn main() {
    let arguments = Arguments::from_args();
    let scenes = Arc::new(Scenes::new());
    let cases = bryant_hard::cases();
    let chosen = match arguments.filter {
        Some(_) => cases,
        None => {
            // half of the time of all cases
            let long = |case: &Case| case.name.contains("a million steps");
            let (long, others) = cases.into_iter().partition::<Vec<_>, _>(long);
            [share::share(3, others), share::share(12, long)].concat()
        }
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
