//! Invalid studies, folders and options: exit code 2, and a message with the place and a remedy.

use super::directory;
use super::folder::files;
use crate::command_call::{bryant, call, expect};

/// A change of the study, and the expected words of the message.
#[track_caller]
fn refused(from: &str, to: &str, says: &[&str]) {
    let directory = directory();
    let at = directory.path();
    assert!(super::SEAT.contains(from));
    std::fs::write(at.join("wrong.yaml"), super::SEAT.replacen(from, to, 1)).unwrap();
    let (_, said) = call(at, &["sweep", "wrong.yaml", "--out", "results"], 2);
    for word in says {
        assert!(said.contains(word), "no \"{word}\" in: {said}");
    }
    assert!(!at.join("results").exists(), "a folder for nothing");
}

#[test]
fn a_parameter_that_is_not_there_is_guessed() {
    refused(
        "lap_slack",
        "lap_slak",
        &["wrong.yaml:6", "lap_slak", "did you mean \"lap_slack\"?"],
    );
}

#[test]
fn a_range_stays_within_the_bounds_of_the_model() {
    refused(
        "to: 60 mm",
        "to: 60 m",
        &["wrong.yaml:6", "lap_slack", "help:"],
    );
}

#[test]
fn an_output_that_is_not_there_is_guessed() {
    refused(
        "lap belt force",
        "lap belt forse",
        &["wrong.yaml:10", "did you mean \"lap belt force\"?"],
    );
}

#[test]
fn all_that_is_wrong_is_said_at_once() {
    let says = ["friktion", "\"peek\""];
    refused(
        "friction: { from: 0, to: 0.6 }",
        "friktion: { from: 0, to: 0.6 }",
        &says[..1],
    );
    refused(
        "friction: { from: 0, to: 0.6 }\nrun: { duration: 60 ms, sampling: 0.1 ms }\nresponses:\n  - { name: lap, of: lap belt force, what: peak }",
        "friktion: { from: 0, to: 0.6 }\nrun: { duration: 60 ms, sampling: 0.1 ms }\nresponses:\n  - { name: lap, of: lap belt force, what: peek }",
        &says,
    );
}

#[test]
fn a_grid_beyond_all_bounds_is_refused() {
    refused(
        "design: sobol\nruns: 160\nseed: 3\nparameters:\n  lap_slack: { from: 0 mm, to: 60 mm }\n  friction: { from: 0, to: 0.6 }",
        "design: grid\nparameters:\n  lap_slack: { from: 0 mm, to: 60 mm, steps: 1000000000 }\n  friction: { from: 0, to: 0.6, steps: 1000000000 }",
        &["wrong.yaml:3", "1e18 runs; at most 1e9", "help:"],
    );
}

#[test]
fn samples_beyond_memory_are_refused() {
    refused(
        "sampling: 0.1 ms",
        "sampling: 1e-12 s",
        &["at most 1000000", "help:"],
    );
}

#[test]
fn steps_and_precision_that_make_no_sense_are_refused() {
    refused(
        "sampling: 0.1 ms",
        "method: rk4",
        &["wrong.yaml:8", "there is no `step`", "help:"],
    );
    refused(
        "sampling: 0.1 ms",
        "step: 1 ns",
        &["at most 1000000 are taken", "help:"],
    );
    refused(
        "sampling: 0.1 ms",
        "accuracy: 1e-5, precision: single",
        &["is not possible in single precision", "1.2e-4", "help:"],
    );
}

#[test]
fn a_model_that_is_not_there_is_named() {
    refused(
        "model: child-seat",
        "model: childseat",
        &["childseat", "did you mean \"child-seat\"?"],
    );
    refused(
        "model: child-seat",
        "model: other/seat.yaml",
        &["other/seat.yaml", "help:"],
    );
}

#[test]
fn what_is_no_study_is_refused_at_its_place() {
    let directory = directory();
    let at = directory.path();
    std::fs::write(at.join("no.yaml"), "model: [child-seat\n").unwrap();
    let (_, said) = call(at, &["sweep", "no.yaml"], 2);
    assert!(said.contains("no.yaml:"), "{said}");
    std::fs::write(at.join("no.yaml"), "just a word\n").unwrap();
    let (_, said) = call(at, &["sweep", "no.yaml"], 2);
    assert!(said.contains("no.yaml"), "{said}");
    let (_, said) = call(at, &["sweep", "nothing.yaml"], 2);
    assert!(
        said.contains("nothing.yaml") && said.contains("help:"),
        "{said}"
    );
    std::fs::write(at.join("no.yaml"), [0xFF, 0xFE, 0x00]).unwrap();
    let (_, said) = call(at, &["sweep", "no.yaml"], 2);
    assert!(said.contains("no.yaml"), "{said}");
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let directory = directory();
    let at = directory.path();
    for (options, says) in [
        (["--shard", "9/8"], "9/8"),
        (["--shard", "-1/8"], "-1/8"),
        (["--shard", "2"], "--shard I/2"),
        (["--lanes", "16"], "8, 4, 2 or 1"),
        (["--threads", "0"], "--threads"),
    ] {
        let option = format!("{}={}", options[0], options[1]);
        let (_, said) = call(at, &["sweep", "seat.yaml", "--out", "results", &option], 2);
        assert!(said.contains(says), "{option}: {said}");
        assert!(
            !at.join("results").exists(),
            "{option}: a folder for nothing"
        );
    }
    let arguments = ["sweep", "seat.yaml", "--out", "results"];
    let task = bryant(at).args(arguments).env("HQ_TASK_ID", "3").output();
    let (_, said) = expect(task.unwrap(), &arguments, 2);
    assert!(
        said.contains("HQ_TASK_ID") && said.contains("--shard N"),
        "{said}"
    );
}

#[test]
fn a_folder_of_something_else_is_left_alone() {
    let directory = directory();
    let at = directory.path();
    std::fs::create_dir(at.join("photos")).unwrap();
    std::fs::write(at.join("photos/cat.jpg"), "a cat").unwrap();
    let (_, said) = call(at, &["sweep", "seat.yaml", "--out", "photos"], 2);
    assert!(
        said.contains("photos") && said.contains("help: name a new folder"),
        "{said}"
    );
    let (_, said) = call(at, &["merge", "photos"], 2);
    assert!(said.contains("is not a folder of results"), "{said}");
    assert_eq!(files(&at.join("photos")).len(), 1);
    let (_, said) = call(at, &["merge", "nothing"], 2);
    assert!(said.contains("nothing") && said.contains("--out"), "{said}");
}

#[test]
fn results_of_another_study_are_not_mixed() {
    let directory = directory();
    let at = directory.path();
    let part = ["sweep", "seat.yaml", "--out", "results", "--shard", "0/10"];
    call(at, &part, 0);
    let before = files(&at.join("results"));
    std::fs::write(
        at.join("other.yaml"),
        super::SEAT.replace("seed: 3", "seed: 4"),
    )
    .unwrap();
    let (_, said) = call(at, &["sweep", "other.yaml", "--out", "results"], 2);
    assert!(
        said.contains("differs: the study") && said.contains("help:"),
        "{said}"
    );
    let (_, said) = call(
        at,
        &["sweep", "seat.yaml", "--out", "results", "--no-estimate"],
        2,
    );
    assert!(said.contains("differs: the arithmetic"), "{said}");
    assert!(
        before == files(&at.join("results")),
        "something was written"
    );

    // the missing blocks of an unfinished folder
    let (_, said) = call(at, &["merge", "results", "--shards", "10"], 2);
    assert!(said.contains("9 of 10 blocks are missing: 1–9"), "{said}");
    assert!(
        said.contains("of shards 1–9 of 10") && said.contains("help:"),
        "{said}"
    );

    // a process that ended before it had kept the study
    std::fs::remove_file(at.join("results/study/facts.json")).unwrap();
    let (_, said) = call(at, &["merge", "results"], 2);
    assert!(
        said.contains("facts.json is missing") && said.contains("help:"),
        "{said}"
    );
    call(at, &part, 0);
    assert!(before == files(&at.join("results")), "not what it was");
}
