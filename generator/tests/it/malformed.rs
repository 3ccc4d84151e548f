//! Messages about invalid input: every problem with its file, place, and remedy.
//!
//! Each file of `malformed/` is read as for a user; the snapshots have the text that the user sees.

mod slips;
use bryant_generator::read_str;
use bryant_generator::{Diagnostic, Diagnostics};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed")
}

/// Reads with paths relative to the directory, so that messages do not depend on its location.
fn problems(name: &str, text: &str) -> Diagnostics {
    let loader = |path: &Path| std::fs::read_to_string(directory().join(path));
    match read_str(name, text, &loader) {
        Ok(_) => panic!("{name} is accepted"),
        Err(diagnostics) => diagnostics,
    }
}

fn nothing_included(_: &Path) -> io::Result<String> {
    Err(io::ErrorKind::NotFound.into())
}

#[test]
fn messages_are_those_reviewed() {
    let mut files: Vec<PathBuf> = std::fs::read_dir(directory())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "yaml"))
        .collect();
    files.sort();
    assert!(files.len() >= 30, "{} malformed models", files.len());
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../malformed");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for path in files {
            let name = path.file_name().unwrap().to_str().unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            let found = problems(name, &text);
            for problem in &found.problems {
                complete(problem);
            }
            insta::assert_snapshot!(name.trim_end_matches(".yaml"), found.to_string());
        }
    });
}

/// Checks that a message has a file, a place, the problem, and a remedy.
fn complete(problem: &Diagnostic) {
    let Diagnostic {
        file,
        message,
        help,
        ..
    } = problem;
    let known = [".yaml", ".csv", ".rs"]
        .iter()
        .any(|end| file.ends_with(end));
    assert!(known && !file.starts_with('/'), "{file}");
    assert!(message.len() > 10 && help.len() > 3, "{}", problem.line());
    assert!(
        !message.contains('\n') && !help.contains('\n'),
        "{}",
        problem.line()
    );
    let whole_file = ["the file is empty", "the file has no numbers"]
        .iter()
        .any(|of_all| message.contains(of_all));
    assert!(
        whole_file || (problem.line > 0 && problem.column > 0),
        "{}",
        problem.line()
    );
}

/// Reads hostile text: one short message is expected soon.
fn refused(text: &str) -> Diagnostic {
    let begin = Instant::now();
    let found =
        read_str("big.yaml", text, &nothing_included).expect_err("hostile text is accepted");
    // a megabyte takes milliseconds; a minute would be another order of growth
    assert!(
        begin.elapsed() < Duration::from_secs(60),
        "{:?}",
        begin.elapsed()
    );
    assert!(found.to_string().len() < 100_000);
    found.problems.into_iter().next().unwrap()
}

#[test]
fn two_hundred_thousand_elements_are_refused() {
    let mut text = "model: m\ndimension: 2\nsystems:\n  - name: man\n    elements:\n".to_owned();
    text += "      - { name: e0, mass: 1, cg: [0, 0], inertia: 1 }\n";
    for k in 1..200_000 {
        let parent = k - 1;
        text += &format!(
            "      - {{ name: e{k}, on: e{parent}, at: [0, 1], mass: 1, cg: [0, 0], inertia: 1 }}\n"
        );
    }
    assert_eq!(
        refused(&text).line(),
        "big.yaml:6:7: more than 2000 elements (help: at most 2000 elements may stand here)"
    );
}

#[test]
fn a_megabyte_of_brackets_is_refused() {
    for bracket in ["[", "{", "[{", "- ", "? "] {
        let text = format!(
            "model: m\nsystems: {}",
            bracket.repeat((1 << 20) / bracket.len())
        );
        let problem = refused(&text);
        assert!(problem.line == 2, "{bracket}: {}", problem.line());
    }
    let text = format!("model: m\nsystems: {}", "[".repeat(1 << 20));
    assert!(refused(&text).message.contains("nested more than"));
}

#[test]
fn a_megabyte_of_other_things_is_refused() {
    for piece in [
        "a", "\"", "\n", "&a ", "*a ", "!", "%", "(", "#", "a: ", "- a\n", "\u{0}", "é", "\t", "|",
        "'", ",", "---\n",
    ] {
        refused(&piece.repeat((1 << 20) / piece.len()));
    }
    refused(&format!(
        "model: m\ndimension: 2\nsystems:\n  - name: man\n    elements:\n      - {{ name: a, mass: {}, cg: [0, 0], inertia: 1 }}\n",
        "(".repeat(1 << 20)
    ));
}

#[test]
fn a_file_beyond_the_limit_is_not_parsed() {
    let text = "# no model\n".repeat(2 << 20);
    assert!(refused(&text).message.contains("bytes"));
}

#[test]
fn many_problems_are_counted_and_the_first_are_shown() {
    let mut text = "model: m\ndimension: 2\nsystems:\n  - name: man\n    elements:\n".to_owned();
    for k in 0..1500 {
        text += &format!("      - {{ name: e{k}, mass: 0, cg: [0, 0], inertia: 1 }}\n");
    }
    let found = read_str("big.yaml", &text, &nothing_included).unwrap_err();
    assert_eq!(found.problems.len(), 1000);
    assert!(found.to_string().ends_with("… and 950 more problems"));
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let missing = bryant_generator::read(Path::new("no/such.yaml")).unwrap_err();
    assert!(
        missing.problems[0]
            .line()
            .starts_with("no/such.yaml: there is no file \"no/such.yaml\"")
    );
    let folder = bryant_generator::read(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap_err();
    assert!(folder.problems[0].message.contains("it is not a file"));
}
