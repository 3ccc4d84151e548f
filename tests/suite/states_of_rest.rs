//! `bryant settle`: states of rest from which runs start.

use super::command_call::call;
use super::directory;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Standard gravity [m/s²].
const G: f64 = 9.80665;

/// The first row of a run from a state, by column.
fn first_row(path: &Path, model: &str) -> Vec<(String, f64)> {
    let arguments = [
        "run",
        model,
        "--start",
        "rest.json",
        "--duration",
        "1 ms",
        "--every",
        "1 ms",
        "--csv",
        "run.csv",
        "--no-files",
        "--no-verify",
    ];
    call(path, &arguments, 0);
    let table = fs::read_to_string(path.join("run.csv")).unwrap();
    let mut rows = table.lines();
    let names = rows.next().unwrap().split(',').map(str::to_owned);
    let values = rows
        .next()
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap());
    names.zip(values).collect()
}

/// A person on a seat with a back, feet on the floor, in a moving car.
const SITTER: &str = include_str!("../../docs/settle/sitter.yaml");

/// The seat carries the weight of the body, and the run begins without a jerk.
#[test]
fn somebody_on_a_seat_starts_without_a_jerk() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("sitter.yaml"), SITTER).unwrap();
    let (told, _) = call(
        path,
        &["settle", "sitter.yaml", "-o", "rest.json", "--json"],
        0,
    );
    let told: Value = serde_json::from_str(&told).unwrap();
    assert!(told["acceleration"].as_f64().unwrap() < 1e-3 * G, "{told}");
    assert_eq!(told["rests_on"].as_array().unwrap().len(), 3, "{told}");
    let state: Value =
        serde_json::from_str(&fs::read_to_string(path.join("rest.json")).unwrap()).unwrap();
    let velocities = state["velocities"].as_object().unwrap();
    assert!(
        velocities
            .values()
            .all(|v| [0.0, 10.0].contains(&v.as_f64().unwrap())),
        "{state}"
    );
    let row = first_row(path, "sitter.yaml");
    let value = |name: &str| {
        row.iter()
            .find(|(column, _)| column.starts_with(name))
            .unwrap()
            .1
    };
    // at rest an accelerometer reads gravity
    assert!(
        (value("head") - G).abs() < 0.01 * G && (value("torso") - G).abs() < 0.01 * G,
        "{row:?}"
    );
    let sum = |axis: &str| {
        ["seat", "back", "floor"]
            .map(|name| value(&format!("{name} {axis}")))
            .iter()
            .sum::<f64>()
    };
    // 0.001 g of 76 kg
    assert!(
        sum("x").abs() < 0.76 && (sum("z") - 76.0 * G).abs() < 0.76,
        "{row:?}"
    );
}

/// A scene of real size whose belts and seat do not hold its legs: in its state of rest a curve is exceeded, and no run
/// from there could be trusted.
#[test]
fn a_state_of_rest_that_cannot_be_trusted_is_refused() {
    let directory = directory();
    let path = directory.path();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/scenes/occupant.yaml");
    fs::copy(scene, path.join("occupant.yaml")).unwrap();
    let (_, error) = call(path, &["settle", "occupant.yaml", "-o", "rest.json"], 3);
    assert!(
        error.contains("cushion-right-thigh") && error.contains("exceeds the last point"),
        "{error}"
    );
    assert!(!path.join("rest.json").exists());
}

/// A ball over nothing.
const BALL: &str = "model: corner
dimension: 2
systems:
  - name: ball
    elements: [{ name: body, mass: 5, cg: [0, 0], inertia: 0.02 }]
    start: { position: [0, 0.3] }
forces:
  - { field: earth, acceleration: [0, -9.81] }
";

/// Two floors of 45 degrees with springs.
#[test]
fn a_ball_rests_in_a_corner_and_the_run_stays_there() {
    let directory = directory();
    let path = directory.path();
    let one = |name: &str, normal: &str| {
        format!(
            "  - contact: {name}\n    ellipsoid: {{ on: ball/body, center: [0, 0], semi_axes: [0.1, 0.1] }}\n    \
             plane: {{ on: frame, at: [0, 0], normal: {normal} }}\n    elastic: {{ points: [[0, 0], [1, 1e5]], extrapolate: linear }}\n"
        )
    };
    let scene = format!(
        "{BALL}{}{}outputs: [{{ name: z, of: ball/body, what: position, component: z }}]\nrun: {{ duration: 1 s, every: 0.1 s }}\n",
        one("left", "[1, 1]"),
        one("right", "[-1, 1]")
    );
    fs::write(path.join("corner.yaml"), scene).unwrap();
    let (told, _) = call(
        path,
        &[
            "settle",
            "corner.yaml",
            "-o",
            "rest.json",
            "--residual",
            "1e-6",
        ],
        0,
    );
    // each normal force is m g/√2 = 34.68 N
    assert_eq!(told.matches("34.7 N").count(), 2, "{told}");
    let arguments = [
        "run",
        "corner.yaml",
        "--start",
        "rest.json",
        "--csv",
        "run.csv",
    ];
    call(path, &arguments, 0);
    let table = fs::read_to_string(path.join("run.csv")).unwrap();
    let heights: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(1).unwrap().parse().unwrap())
        .collect();
    // (√2 r − √2 d) above the corner, d = m g/(√2 k); 1e-6 g over ω² = k/m moves it by 5e-10 m, and a run is accurate
    // to 0.1 % of 1 g/ω²
    let exact = 2f64.sqrt() * (0.1 - 5.0 * 9.81 / (2f64.sqrt() * 1e5));
    assert!((heights[0] - exact).abs() < 1e-9, "{} {exact}", heights[0]);
    for height in &heights {
        assert!(
            (height - exact).abs() < 1e-3 * 5.0 * 9.81 / 1e5,
            "{height} {exact}"
        );
    }
}

#[test]
fn what_does_not_rest_is_said_and_nothing_is_written() {
    let directory = directory();
    let path = directory.path();
    let falls = BALL.to_owned() + "run: { duration: 1 s, every: 0.1 s }\n";
    fs::write(path.join("falls.yaml"), falls).unwrap();
    let (_, error) = call(
        path,
        &[
            "settle",
            "falls.yaml",
            "-o",
            "rest.json",
            "--evaluations",
            "20000",
        ],
        3,
    );
    assert!(
        error.contains("does not come to rest")
            && error.contains("ball/body")
            && error.contains("1.000 g"),
        "{error}"
    );
    let stands = super::PENDULUM.replace("30 deg", "180 deg");
    fs::write(path.join("stands.yaml"), stands).unwrap();
    let (_, error) = call(path, &["settle", "stands.yaml", "-o", "rest.json"], 3);
    assert!(error.contains("a slight push moves it away"), "{error}");
    assert!(!path.join("rest.json").exists());
    // without a file name the state is printed, and the messages go to standard error
    let (state, told) = call(path, &["settle", "clock.yaml"], 0);
    let state: Value = serde_json::from_str(&state).unwrap();
    let angles = state["coordinates"].as_object().unwrap();
    assert!(
        angles.len() == 1
            && angles
                .values()
                .all(|angle| angle.as_f64().unwrap().abs() < 1e-3),
        "{state}"
    );
    assert!(told.contains("rests after"), "{told}");
    for (option, wrong) in [("--residual", "0.5"), ("--set", "gravity=-1")] {
        call(path, &["settle", "clock.yaml", option, wrong], 2);
    }
}

/// A body on a slope of 45°, held by friction by speed, or by friction that holds.
const SLOPE: &str = "model: slope
dimension: 2
systems:
  - name: block
    elements: [{ name: body, mass: 5, cg: [0, 0], inertia: 0.02 }]
    start: { position: [0, 0.14] }
surfaces:
  slope: { on: frame, at: [0, 0], normal: [1, 1] }
forces:
  - { field: earth, acceleration: [0, -9.81] }
  - { contact: slope, ellipsoid: { on: block/body, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: slope, stiffness: 100 kN/m, damping: 500, FRICTION }
run: { duration: 1 s, every: 0.1 s }
";

/// A body that slides off has no state of rest near its start: within few stops the search says so, with the contact
/// that does not hold it.
#[test]
fn what_slides_away_is_said_with_what_does_not_hold_it() {
    let directory = directory();
    let path = directory.path();
    let slides = SLOPE.replace("FRICTION", "friction: 2");
    fs::write(path.join("slope.yaml"), &slides).unwrap();
    let (_, error) = call(path, &["settle", "slope.yaml", "-o", "rest.json"], 3);
    for said in [
        "\"block/body\" is 0.6",
        "from there",
        "contact \"slope\"",
        "friction by speed does not hold; give it `friction_displacement`",
    ] {
        assert!(error.contains(said), "{said}\n{error}");
    }
    // it slides into a trough, where it would rest: 0.1 m from both planes, at (0.4, 0.1 √2 − 0.4) from (0, 0.14),
    // which is 0.565 m, less the dents
    let trough = slides.replace(
        "run:",
        "  - { contact: stop, ellipsoid: { on: block/body, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0.4, -0.4], normal: [-1, 1] }, stiffness: 100 kN/m, damping: 500 }\nrun:",
    );
    fs::write(path.join("slope.yaml"), &trough).unwrap();
    let (_, error) = call(path, &["settle", "slope.yaml", "-o", "rest.json"], 3);
    assert!(
        error.contains("\"block/body\" rests 0.57 m") && error.contains("is this what you want?"),
        "{error}"
    );
    assert!(!path.join("rest.json").exists());
    let allowed = [
        "settle",
        "slope.yaml",
        "-o",
        "rest.json",
        "--distance",
        "1 m",
    ];
    let (told, _) = call(path, &allowed, 0);
    assert!(
        told.contains("farthest from its start is \"block/body\", 0.565 m"),
        "{told}"
    );
    for wrong in ["0", "-1 m", "3 kg", "far"] {
        call(path, &["settle", "slope.yaml", "--distance", wrong], 2);
    }
}

/// A body that hangs in a reel sinks for ever, as long as no switch has locked it.
#[test]
fn what_hangs_in_an_open_reel_is_said() {
    let directory = directory();
    let path = directory.path();
    let scene = format!(
        "{BALL}  - {{ belt: strap, from: {{ on: frame, at: [0, 2] }}, to: {{ on: ball/body, at: [0, 0] }}, stiffness: 10 kN, retractor: {{ lock: crash, spool: 5 N }} }}
switches: [{{ switch: crash, when: {{ time: 10 ms }} }}]
run: {{ duration: 1 s, every: 0.1 s }}
"
    );
    fs::write(path.join("reel.yaml"), scene).unwrap();
    let (_, error) = call(path, &["settle", "reel.yaml", "-o", "rest.json"], 3);
    assert!(
        error.contains("belt \"strap\" (up to 5 N) hangs in a reel that is not locked"),
        "{error}"
    );
}

/// The start that `--yaml` writes, in the words of a model, is the state of rest.
#[test]
fn a_state_of_rest_becomes_the_start_of_a_model() {
    let directory = directory();
    let path = directory.path();
    // a start has no memory of friction; without it he slides off, and rests where nobody would sit
    let smooth = SITTER.replace(", friction: 0.5, friction_displacement: 0.5 mm", "");
    assert_ne!(smooth, SITTER);
    fs::write(path.join("sitter.yaml"), &smooth).unwrap();
    let (_, error) = call(path, &["settle", "sitter.yaml", "-o", "rest.json"], 3);
    assert!(
        error.contains("\"man/torso\" rests 0.58 m from its start: is this what you want?"),
        "{error}"
    );
    let off = [
        "settle",
        "sitter.yaml",
        "--distance",
        "off",
        "-o",
        "rest.json",
    ];
    call(path, &off, 0);
    let by_state = first_row(path, "sitter.yaml");
    call(
        path,
        &[
            "settle",
            "sitter.yaml",
            "--distance",
            "off",
            "--yaml",
            "-o",
            "rest.yaml",
        ],
        0,
    );
    let start = fs::read_to_string(path.join("rest.yaml")).unwrap();
    let start = start.split("    start:\n").nth(1).unwrap();
    let seated = smooth.replace(
        "    start: { position: [0, 0.52], velocity: [10, 0], angles: { torso: -15 deg } }\n",
        &format!("    start:\n{start}"),
    );
    assert_ne!(seated, smooth);
    fs::write(path.join("seated.yaml"), seated).unwrap();
    let arguments = [
        "run",
        "seated.yaml",
        "--csv",
        "run.csv",
        "--no-files",
        "--no-verify",
        "--duration",
        "1 ms",
        "--every",
        "1 ms",
    ];
    call(path, &arguments, 0);
    let table = fs::read_to_string(path.join("run.csv")).unwrap();
    let row: Vec<f64> = table
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap())
        .collect();
    for ((name, by_state), by_start) in by_state.iter().zip(&row) {
        assert!(
            (by_state - by_start).abs() <= 1e-9 * by_state.abs().max(1.0),
            "{name}: {by_state} {by_start}"
        );
    }
}
