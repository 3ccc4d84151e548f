//! Responses of a single run equal those of a study with one row, whatever rows the table has.

use super::command_call::call;
use super::{directory, json};
use serde_json::Value;

/// One row of the pendulum, with every kind of response that it allows.
const STUDY: &str = "\
model: clock.yaml
design: list
rows: [{ gravity: 5 m/s^2 }]
run: { duration: 2 s, accuracy: 1e-4, sampling: 4 ms }
responses:
  - { of: swing, what: peak }
  - { of: swing, what: minimum }
  - { of: swing, what: time of minimum }
  - { of: swing, what: range }
  - { of: swing, what: clip, duration: 30 ms }
  - { of: swing, what: contiguous clip, duration: 0.1 s }
  - { of: swing, what: value, at: 0.7 s }
  - { name: mean height, of: bob height, what: mean }
  - { of: bob height, what: integral }
  - { of: bob height, what: excursion }
tables: [csv]
";

/// Names and values of the responses of a run.
fn responses(text: &str) -> Vec<(String, f64)> {
    let all = json(text)["responses"].as_array().unwrap().clone();
    let each = |response: &Value| {
        let name = response["response"].as_str().unwrap().to_owned();
        (name, response["value"].as_f64().unwrap())
    };
    all.iter().map(each).collect()
}

const RUN: [&str; 8] = [
    "run",
    "clock.yaml",
    "--no-files",
    "--json",
    "--set",
    "gravity=5 m/s^2",
    "--duration",
    "2 s",
];

#[test]
fn responses_are_those_of_a_study_of_one_row() {
    let directory = directory();
    let directory = directory.path();
    // 0.1 s, the time between the rows, is not a multiple of 4 ms
    std::fs::write(directory.join("study.yaml"), STUDY).unwrap();
    call(directory, &["sweep", "study.yaml"], 0);
    let table = std::fs::read_to_string(directory.join("study-results/results.csv")).unwrap();
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let (headings, row) = (lines.next().unwrap(), lines.next().unwrap());
    let column = |name: &str| {
        let named = |heading: &&str| heading.split(" [").next() == Some(name);
        let place = headings.iter().position(named).unwrap();
        row[place].parse::<f64>().unwrap()
    };
    let estimate = column("error estimate");
    assert!(estimate > 0.0 && estimate < 1e-4);

    let (text, _) = call(
        directory,
        &[&RUN[..], &["--responses", "study.yaml"]].concat(),
        0,
    );
    let found = responses(&text);
    assert_eq!(found.len(), 10);
    for (name, value) in &found {
        let expected = column(name);
        // a response smaller than 1 % of its signal, 0.5, is measured by the signal
        let scale = expected.abs().max(5e-3);
        let error = (value - expected).abs() / scale;
        assert!(error <= estimate.max(1e-6), "{name}: {value}, {expected}");
    }
    // the pendulum starts at its peak and does not lose energy
    assert!((found[0].1 - 30f64.to_radians()).abs() < 1e-12);
    assert!((found[1].1 + 30f64.to_radians()).abs() < 1e-4);
}

#[test]
fn rows_of_the_table_leave_no_trace_in_responses() {
    let directory = directory();
    let run = |more: &[&str]| {
        let asked = ["-r", "range of swing", "-r", "time of minimum of swing"];
        let sampled = ["-r", "3 ms clip of bob height", "--sampling", "1 ms"];
        let arguments = [&RUN[..], &asked, &sampled, more].concat();
        let value = call(directory.path(), &arguments, 0).0;
        let apart = json(&value)["responses"][0]["difference"].as_f64().unwrap();
        assert!(apart > 0.0 && apart < 1e-5, "{apart}");
        responses(&value)
    };
    let plain = run(&[]);
    assert_eq!(plain, run(&["--every", "0.5 s"]));
    // rows that agree neither with the steps nor with the samples: steps end on rows, and not on samples
    for every in ["0.1 s", "0.37 s"] {
        let fixed = run(&["--method", "rk4", "--step", "3 ms", "--every", every]);
        for ((name, a), (_, b)) in plain.iter().zip(&fixed) {
            assert!((a - b).abs() < 1e-6 * a.abs(), "{name}: {a} {b} {every}");
        }
    }
}

#[test]
fn responses_stand_under_the_table_or_beside_it() {
    let directory = directory();
    let call = |more: &[&str]| {
        let run = ["run", "clock.yaml", "-r", "peak of swing"];
        call(directory.path(), &[&run[..], more].concat(), 0)
    };
    // 30° are 0.5236; both runs begin there
    let line = "peak of swing  0.5236 rad  as in its check\n";
    let (table, _) = call(&[]);
    assert!(table.contains(&format!("\n\n{line}\n")), "{table}");
    let (table, told) = call(&["--csv", "-"]);
    assert!(!table.contains("peak") && told.contains(line), "{told}");
    let (table, _) = call(&["--no-verify"]);
    assert!(
        table.contains("\n\npeak of swing  0.5236 rad\n\n"),
        "{table}"
    );
}

#[test]
fn a_run_that_fails_has_no_responses() {
    let directory = directory();
    let run = ["run", "cut-short.yaml", "--no-files", "-r", "peak of swing"];
    let (table, _) = call(directory.path(), &run, 3);
    assert!(table.contains("peak of swing  not known\n"), "{table}");
    let (value, _) = call(directory.path(), &[&run[..], &["--json"]].concat(), 3);
    assert_eq!(json(&value)["responses"][0]["value"], Value::Null);
}

#[test]
fn what_cannot_be_read_off_a_run_is_refused_before_it() {
    let directory = directory();
    std::fs::write(directory.path().join("study.yaml"), STUDY).unwrap();
    let run = ["run", "clock.yaml"];
    for (more, needle) in [
        (&["-r", "peak of swingg"][..], "did you mean \"swing\"?"),
        (&["-r", "peak of arm"], "there are: swing, bob height"),
        (&["-r", "HIC15 of swing"], "needs an acceleration"),
        (&["-r", "3 ms clap of swing"], "with one of peak, minimum"),
        (&["-r", "2 s clip of swing"], "beyond the run of 1 s"),
        (
            &["-r", "peak of swing", "-r", "peak_swing"],
            "asked for twice",
        ),
        (&["--sampling", "1 ms"], "--response"),
        (
            &["-r", "1 ms clip of swing", "--sampling", "2 ms"],
            "shorter time with --sampling",
        ),
        (
            &["-r", "peak of swing", "--sampling", "0.1 us"],
            "longer time with --sampling",
        ),
        (
            &["--responses", "study.yaml", "--duration", "0.5 s"],
            "0.7 s is beyond the end of the run",
        ),
        (&["--responses", "no.yaml"], "no.yaml"),
    ] {
        let (_, told) = call(directory.path(), &[&run[..], more].concat(), 2);
        assert!(told.contains(needle) && told.contains("help:"), "{told}");
    }
    assert!(!directory.path().join("clock.csv").exists());
    let (table, _) = call(
        directory.path(),
        &["run", "clock.yaml", "--responses", "study.yaml"],
        0,
    );
    assert!(
        table.contains("end at 2 s, this one at 1 s: --duration '2 s'"),
        "{table}"
    );
}

/// 1 kg that oscillates on 10⁸ N/m, by half of its static depth, and is lifted off before the run ends. Its amplitude
/// of 49 nm is five tolerances, and neither its first row nor its last shows what has become of it.
const LIFTED: &str = "\
model: lifted
dimension: 2
systems:
  - name: ball
    elements: [{ name: body, mass: 1 kg, cg: [0, 0], inertia: 1e-4 }]
    start: { position: [0, 0.01 - 1.5 * 9.81e-8] }
forces:
  - { field: gravity, acceleration: [0, { points: [[0, -9.81], [0.15, -9.81], [0.16, 100]] }] }
  - contact: floor
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [10 mm, 10 mm] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { points: [[0, 0], [1 mm, 100 kN]], extrapolate: linear }
outputs:
  - { name: force, of: contact floor, what: force }
  - { name: speed, of: ball/body, what: velocity, component: z }
run: { duration: 0.2 s, every: 0.2 s }
";

#[test]
fn a_response_that_is_not_accurate_makes_the_run_sharper() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("lifted.yaml"), LIFTED).unwrap();
    let run = |more: &[&str]| {
        let run = ["run", "lifted.yaml", "--no-files", "--json"];
        json(&call(at, &[&run[..], more].concat(), 0).0)
    };
    let asked = ["-r", "value at 0.1 s of force"];
    // the force is k δ, and δ = g/ω² (1 + cos(ω t)/2) with ω = 10⁴ rad/s
    let exact = 9.81 * (1.0 + 0.5 * 1000.0_f64.cos());
    let error = |run: &Value| {
        let value = run["responses"][0]["value"].as_f64().unwrap();
        (value / exact - 1.0).abs()
    };
    // the rows alone accept the first run
    assert!(run(&[])["accuracy"]["before"].is_null());
    let unchecked = run(&[&asked[..], &["--no-verify"]].concat());
    assert!(error(&unchecked) > 1e-3, "this test has lost its subject");
    let checked = run(&asked);
    assert!(error(&checked) < 1e-3, "{checked}");
    assert!(!checked["accuracy"]["before"].is_null());
    let wanted = run(&[&asked[..], &["--accuracy", "0.1%"]].concat());
    assert!(error(&wanted) < 1e-3, "{wanted}");
    // if the user chose a method, the program does not change it, but says so
    let run = ["run", "lifted.yaml", "--no-files"];
    let chosen = ["--method", "rk4", "--step", "0.1 ms"];
    let (_, told) = call(at, &[&run[..], &chosen, &asked].concat(), 0);
    assert!(
        told.contains("responses are not as accurate as 10 %"),
        "{told}"
    );
}

#[test]
fn a_response_of_what_is_nothing_does_not_count() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    // the horizontal velocity of a ball that falls vertically is rounding, and its speed at rest shrinks with the
    // tolerance
    let still = LIFTED.replace("1.5 * 9.81e-8", "9.81e-8");
    let fixed = still.replace("[0.15, -9.81], [0.16, 100]", "[1, -9.81]");
    let text = fixed.replace(
        "outputs:",
        "outputs:\n  - { name: aside, of: ball/body, what: velocity, component: x }",
    );
    std::fs::write(at.join("rest.yaml"), text).unwrap();
    let run = [
        "run",
        "rest.yaml",
        "--no-files",
        "-r",
        "peak of speed",
        "-r",
        "peak of aside",
    ];
    let (_, told) = call(at, &run, 0);
    assert!(!told.contains("responses are not as accurate"), "{told}");
}
