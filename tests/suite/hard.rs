//! Every hard case is a test by its name: `cargo test --test hard`, or with a word of a name behind it.

use bryant::stability::report::text::text;
use bryant::stability::{Compiler, run_case};
use libtest_mimic::{Arguments, Failed, Trial};
use std::path::Path;
use std::sync::Arc;

fn main() {
    let arguments = Arguments::from_args();
    // Beside what else is built here, and as long.
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hard-cache");
    if std::env::var_os("BRYANT_CACHE").is_none() {
        // No thread is running yet.
        #[allow(unsafe_code)]
        unsafe {
            std::env::set_var("BRYANT_CACHE", &cache);
        }
    }
    let compiler = match Compiler::new() {
        Ok(compiler) => Arc::new(compiler),
        Err(error) => {
            eprintln!("error: {error}");
            std::process::exit(1);
        }
    };
    let trials = bryant_hard::cases().into_iter().map(|case| {
        let compiler = Arc::clone(&compiler);
        let name = format!("{}: {}", case.group.title(), case.name);
        Trial::test(name, move || {
            let outcome = run_case(&case, &*compiler, false);
            match outcome.holds() {
                true => Ok(()),
                false => Err(Failed::from(text(&[outcome], false))),
            }
        })
    });
    libtest_mimic::run(&arguments, trials.collect()).exit();
}
