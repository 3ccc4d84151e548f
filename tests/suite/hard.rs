//! Every hard case is a test by its name: `cargo test --test hard`, or with a word of a name behind it.

use bryant::stability::report::text::text;
use bryant::stability::{Scenes, run_case};
use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;

fn main() {
    let scenes = Arc::new(Scenes::new());
    let trials = bryant_hard::cases().into_iter().map(|case| {
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
    libtest_mimic::run(&Arguments::from_args(), trials.collect()).exit();
}
