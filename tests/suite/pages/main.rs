//! The pages (README, CONTRIBUTING, docs) say what is: their commands are run, and what they print and draw is compared
//! with what stands there.
//!
//! Each page is a test by its name: `cargo test --test pages`, or with a part of a name behind it. [`page`] says what a
//! page may contain and what the marks in its HTML comments mean. Two environment variables change what is done:
//!
//! - `PAGES_UPDATE=1` writes what the commands print and draw into the pages.
//! - `PAGES_ALL=1` also runs what is marked as slow, and all lines of tables of runs.
//!
//! At the end stands what was not run, with the reason that its page gives.

#[path = "../command_call.rs"]
#[allow(dead_code)]
mod command_call;
mod compare;
mod names;
mod output;
mod page;
mod picture;
mod run;
#[path = "../share.rs"]
mod share;
mod table;

use libtest_mimic::{Arguments, Failed, Trial};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// The root of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Whether an environment variable asks for something.
pub fn asked(name: &str) -> bool {
    std::env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0")
}

/// All pages, relative to the root.
pub fn pages() -> Vec<PathBuf> {
    let mut found = vec![PathBuf::from("README.md"), PathBuf::from("CONTRIBUTING.md")];
    let mut folders = vec![PathBuf::from("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).unwrap() {
            let path = folder.join(entry.unwrap().file_name());
            if root().join(&path).is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "md") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn main() {
    let left_out = Arc::new(Mutex::new(Vec::new()));
    let mut trials: Vec<Trial> = names::trials();
    for page in pages() {
        let left_out = Arc::clone(&left_out);
        trials.push(Trial::test(page.display().to_string(), move || {
            let told = run::page(&page);
            left_out.lock().unwrap().extend(told.left_out);
            match told.problems.is_empty() {
                true => Ok(()),
                false => Err(Failed::from(told.problems.join("\n\n"))),
            }
        }));
    }
    // the longest pages first, so that two threads end at about the same time
    let first = |name: &str| !name.contains("applications") && name != "README.md";
    trials.sort_by_key(|trial| first(trial.name()));
    let conclusion = libtest_mimic::run(&Arguments::from_args(), trials);
    let mut left_out = left_out.lock().unwrap().clone();
    left_out.sort();
    if !left_out.is_empty() {
        println!(
            "{} blocks, tables and pictures were not run:",
            left_out.len()
        );
    }
    for line in left_out {
        println!("  {line}");
    }
    conclusion.exit();
}
