//! Runs that begin where others ended, through a state file.

use super::command_call::call;
use super::json;
use serde_json::Value;
use std::path::Path;

/// 1 kg that is kicked between 0.5 s and 0.6 s with a triangle of up to 20 m/s², and is at rest before.
const KICK: &str = "\
model: kick
dimension: 2
systems:
  - name: ball
    elements: [{ name: body, mass: 1 kg, cg: [0, 0], inertia: 1e-4 }]
    start: { position: [0, 0] }
forces:
  - field: kick
    acceleration: [{ points: [[0.5, 0], [0.55, 20], [0.6, 0]], extrapolate: hold }, 0]
outputs:
  - { name: x, of: ball/body, what: position, component: x }
  - { name: speed, of: ball/body, what: velocity, component: x }
run: { duration: 1 s, every: 50 ms }
";

fn run(here: &Path, model: &str, arguments: &[&str]) -> Value {
    let all = ["run", model, "--no-files", "--json"];
    let all: Vec<&str> = all.iter().chain(arguments).copied().collect();
    json(&call(here, &all, 0).0)
}

fn rows(run: &Value) -> Vec<Vec<f64>> {
    let row = |row: &Value| {
        let numbers = row.as_array().unwrap().iter();
        numbers.map(|number| number.as_f64().unwrap()).collect()
    };
    run["rows"].as_array().unwrap().iter().map(row).collect()
}

#[test]
fn a_kick_is_felt_by_a_run_that_begins_before_it_or_within_it() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("kick.yaml"), KICK).unwrap();
    // 1 m/s: on average half of it for 0.1 s, then all of it for 0.4 s
    let (x, speed) = (0.05 + 0.4, 1.0);
    for at in ["0.25 s", "0.5 s", "0.537 s", "0.6 s", "0.9 s"] {
        run(here, "kick.yaml", &["--duration", at, "--final-state", "s"]);
        let second = run(here, "kick.yaml", &["--start", "s"]);
        let rows = rows(&second);
        let from = at.trim_end_matches(" s").parse::<f64>().unwrap();
        assert_eq!(rows[0][0], from);
        assert!(
            (rows[1][0] / 0.05)
                .fract()
                .min(1.0 - (rows[1][0] / 0.05).fract())
                < 1e-9
        );
        let last = rows.last().unwrap();
        assert_eq!(last[0], 1.0);
        assert!(
            (last[1] - x).abs() < 1e-6 && (last[2] - speed).abs() < 1e-6,
            "{at}: {last:?}"
        );
        assert_eq!(second["report"]["start_s"], from);
        let simulated = second["report"]["simulated_s"].as_f64().unwrap();
        assert!((simulated - (1.0 - from)).abs() < 1e-15);
        let kinetic = &second["energy"]["kinetic_at_end"];
        assert!((kinetic.as_f64().unwrap() - 0.5).abs() < 1e-6, "{kinetic}");
    }
}

#[test]
fn a_run_in_two_halves_equals_the_whole_run() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let scene = |name: &str| format!("{}/benches/scenes/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    for (model, at) in [
        ("child-seat".to_owned(), "62 ms"),
        (scene("occupant"), "58 ms"),
        (scene("pedestrian"), "115 ms"),
    ] {
        let sharp = ["--tolerance", "1e-9"];
        let whole = run(here, &model, &sharp);
        let ends = ["--duration", at, "--final-state", "state.json"];
        let first = run(here, &model, &[&sharp[..], &ends].concat());
        let second = run(
            here,
            &model,
            &[&sharp[..], &["--start", "state.json"]].concat(),
        );
        let (whole, first, second) = (rows(&whole), rows(&first), rows(&second));
        // the sample between the two runs is in both
        assert_eq!(first.len() + second.len(), whole.len() + 1, "{model}");
        assert_eq!(first.last().unwrap()[0], second[0][0]);
        for column in 1..whole[0].len() {
            let size = |m: f64, row: &Vec<f64>| m.max(row[column].abs());
            let largest = whole.iter().fold(0.0, size);
            let tail = &whole[whole.len() - second.len() + 1..];
            for (row, expected) in second[1..].iter().zip(tail) {
                assert_eq!(row[0], expected[0]);
                // the default promise is 1e-3 at a tolerance that is a hundred times this one
                let error = (row[column] - expected[column]).abs();
                assert!(
                    error <= 1e-5 * largest,
                    "{model}: column {column} at {}: {error}",
                    row[0]
                );
            }
        }
    }
}

#[test]
fn a_state_that_is_not_one_of_the_model_is_refused() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("kick.yaml"), KICK).unwrap();
    let occupant = format!(
        "{}/benches/scenes/occupant.yaml",
        env!("CARGO_MANIFEST_DIR")
    );
    let none = ["--no-verify", "--duration", "1 ms", "--every", "1 ms"];
    run(
        here,
        "kick.yaml",
        &[&none[..], &["--final-state", "kick.json"]].concat(),
    );
    run(
        here,
        &occupant,
        &[&none[..], &["--final-state", "man.json"]].concat(),
    );
    let text = |file: &str| std::fs::read_to_string(here.join(file)).unwrap();
    let (kick, man) = (text("kick.json"), text("man.json"));
    let state: Value = serde_json::from_str(&man).unwrap();
    let qw = &state["coordinates"]["man/pelvis.qw"];
    let double = man.replace(
        &format!("\"man/pelvis.qw\": {qw}"),
        &format!("\"man/pelvis.qw\": {}", 2.0 * qw.as_f64().unwrap()),
    );
    assert_ne!(double, man);
    for (model, state, expected) in [
        (
            "kick.yaml",
            kick.replace("ball.vx", "ball.vy"),
            "it lacks ball.vx",
        ),
        (
            "kick.yaml",
            kick.replace("\"ball.x\"", "\"more\": 1, \"ball.x\""),
            "kick has no more (coordinates)",
        ),
        (
            "kick.yaml",
            kick.replace("\"time\": 0.001", "\"time\": 1.0"),
            "state.json:3: the time of the state is 1 s, but",
        ),
        (
            "kick.yaml",
            kick.replace("\"time\": 0.001", "\"time\": -1e-3"),
            "state.json:3: the time of the state is -0.001 s, but",
        ),
        (
            "kick.yaml",
            kick.replace("\"time\": 0.001", "\"time\": 1e999"),
            "number out of range",
        ),
        (
            "kick.yaml",
            kick.replace("\"time\"", "\"Time\""),
            "unknown field `Time`",
        ),
        (
            "kick.yaml",
            kick.replace("\"ball.x\"", "\"ball.x\": 1.0, \"ball.x\""),
            "\"ball.x\" is given twice at line ",
        ),
        ("kick.yaml", String::new(), "this is no state"),
        ("kick.yaml", man.clone(), "it lacks ball.x"),
        (occupant.as_str(), double, "man/pelvis.qw is"),
    ] {
        std::fs::write(here.join("state.json"), state).unwrap();
        let arguments = ["run", model, "--no-files", "--start", "state.json"];
        let (stdout, stderr) = call(here, &arguments, 2);
        assert!(stderr.contains(expected), "{expected}\n{stderr}");
        assert!(stdout.is_empty(), "{stdout}");
    }
    let arguments = ["run", "kick.yaml", "--no-files", "--start", "nothing.json"];
    assert!(call(here, &arguments, 2).1.contains("nothing.json"));
}

#[test]
fn a_run_that_was_given_up_goes_on_from_its_last_sample() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let give_up = [
        "--max-steps",
        "300",
        "--no-verify",
        "--final-state",
        "state.json",
    ];
    let arguments = [&["run", "child-seat", "--no-files"][..], &give_up].concat();
    call(here, &arguments, 3);
    let whole = rows(&run(here, "child-seat", &["--no-verify"]));
    let rest = rows(&run(
        here,
        "child-seat",
        &["--no-verify", "--start", "state.json"],
    ));
    assert!(rest[0][0] > 0.0 && rest.len() < whole.len());
    let last = whole.len() - 1;
    assert_eq!(rest.last().unwrap()[0], whole[last][0]);
    for (a, b) in rest.last().unwrap().iter().zip(&whole[last]) {
        assert!((a - b).abs() <= 1e-3 * b.abs().max(1.0), "{a} {b}");
    }
}
