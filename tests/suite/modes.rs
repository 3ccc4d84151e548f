//! `bryant modes`: frequencies, damping and shapes where they have closed forms.

use crate::command_call::call;
use crate::reports::page;
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use tempfile::tempdir;

/// Three carts in a row between springs, the first of which is fixed to a wall.
const CARTS: &str = "\
model: carts
dimension: 2
parameters: { k: { value: 1000 N/m, min: 0 }, d: { value: 0, min: 0 } }
systems:
  - name: s
    reference: fixed
    elements:
      - { name: a, joint: { slider: x }, mass: 2, cg: [0, 0], inertia: 1 }
      - { name: b, on: a, at: [1, 0], joint: { slider: x }, mass: 2, cg: [0, 0], inertia: 1 }
      - { name: c, on: b, at: [1, 0], joint: { slider: x }, mass: 2, cg: [0, 0], inertia: 1 }
forces:
  - { joint: s/a, stiffness: k, damping: d }
  - { joint: s/b, stiffness: k, damping: d }
  - { joint: s/c, stiffness: k, damping: d }
run: { duration: 1 s, every: 10 ms }
";

/// A rod on a ball joint below a ceiling; it is as heavy about both axes.
const ROD: &str = "\
model: rod
dimension: 3
systems:
  - name: s
    reference: fixed
    elements: [{ name: rod, mass: 2, cg: [0, 0, -0.5], inertia: [0.1, 0.1, 0.02] }]
forces:
  - { field: gravity, acceleration: [0, 0, -9.81] }
run: { duration: 1 s, every: 10 ms }
";

fn found(folder: &Path, text: &str, options: &[&str]) -> Vec<Value> {
    std::fs::write(folder.join("model.yaml"), text).unwrap();
    let all = [&["modes", "model.yaml", "--json"], options].concat();
    let (said, _) = call(folder, &all, 0);
    let said: Value = serde_json::from_str(&said).unwrap();
    said["modes"].as_array().unwrap().clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[track_caller]
fn near(found: f64, expected: f64, share: f64) {
    let error = (found - expected).abs();
    assert!(error <= share * expected.abs(), "{found}, not {expected}");
}

#[test]
fn carts_between_springs_have_the_frequencies_of_a_chain() {
    let folder = tempdir().unwrap();
    let modes = found(folder.path(), CARTS, &[]);
    assert_eq!(modes.len(), 3);
    for (k, mode) in modes.iter().enumerate() {
        // one end fixed, the other free
        let angle = (2 * k + 1) as f64 * PI / 14.0;
        let omega = 2.0 * (1000.0_f64 / 2.0).sqrt() * angle.sin();
        near(number(&mode["frequency_Hz"]), omega / TAU, 1e-12);
        assert!(number(&mode["damping"]).abs() < 1e-12);
        // cart n moves by sin(2 n angle); coordinates are relative to the one before
        let place = |n: usize| (2.0 * n as f64 * angle).sin();
        let shape: Vec<f64> = (0..3).map(|n| place(n + 1) - place(n)).collect();
        // without damping all move in phase; the phase is free
        let entry = |n: usize| number(&mode["shape"][n]["re"]) + number(&mode["shape"][n]["im"]);
        for n in 0..3 {
            near(entry(n) * shape[0], entry(0) * shape[n], 1e-9);
        }
    }
}

#[test]
fn damping_in_proportion_to_stiffness_grows_with_the_frequency() {
    let folder = tempdir().unwrap();
    // d = β k: ζ = β ω / 2
    let modes = found(folder.path(), CARTS, &["--set", "d=4"]);
    for mode in &modes {
        let omega = TAU * number(&mode["frequency_Hz"]);
        near(number(&mode["damping"]), 0.004 * omega / 2.0, 1e-10);
    }
    // overdamped: no frequencies, and everything decays
    let modes = found(folder.path(), CARTS, &["--set", "d=10000"]);
    assert_eq!(modes.len(), 6);
    for mode in &modes {
        assert!(mode["frequency_Hz"].is_null(), "{mode}");
        assert!(number(&mode["rate_per_s"]["re"]) < 0.0, "{mode}");
    }
}

#[test]
fn a_rod_swings_both_ways_and_falls_from_above() {
    let folder = tempdir().unwrap();
    let omega = (2.0_f64 * 9.81 * 0.5 / (0.1 + 2.0 * 0.25)).sqrt();
    let modes = found(folder.path(), ROD, &[]);
    let swings: Vec<&Value> = modes.iter().filter(|mode| mode["free"] == false).collect();
    assert_eq!(swings.len(), 2, "{modes:#?}");
    for mode in &swings {
        near(number(&mode["frequency_Hz"]), omega / TAU, 1e-9);
    }
    // two directions, not one twice: a determinant of complex numbers
    let direction = |mode: &Value| {
        let entry = |n: usize| ["re", "im"].map(|part| number(&mode["shape"][n][part]));
        [entry(0), entry(1)]
    };
    let [a, b] = [direction(swings[0]), direction(swings[1])];
    let product = |p: [f64; 2], q: [f64; 2]| [p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]];
    let (one, other) = (product(a[0], b[1]), product(a[1], b[0]));
    let apart = (one[0] - other[0]).hypot(one[1] - other[1]);
    assert!(apart > 1e-6, "{a:?} {b:?}");
    // the third motion is about the rod itself
    assert!(modes.iter().any(|mode| mode["free"] == true));
    // upside down
    let above = ROD.replace("-0.5]", "0.5]");
    let modes = found(folder.path(), &above, &[]);
    let rates = modes.iter().map(|mode| number(&mode["rate_per_s"]["re"]));
    let growing: Vec<f64> = rates.filter(|rate| *rate > 1.0).collect();
    assert_eq!(growing.len(), 2);
    for rate in growing {
        near(rate, omega, 1e-9);
    }
    let (_, said) = call(folder.path(), &["modes", "model.yaml"], 0);
    assert!(said.contains("unstable"), "{said}");
}

#[test]
fn a_body_in_free_flight_has_free_modes_alone() {
    let folder = tempdir().unwrap();
    let text = "\
model: stone
dimension: 2
systems: [{ name: s, elements: [{ name: stone, mass: 2, cg: [0, 0], inertia: 1 }], start: { velocity: [3, 0] } }]
run: { duration: 1, every: 0.1 }
";
    let modes = found(folder.path(), text, &[]);
    assert_eq!(modes.len(), 6);
    assert!(modes.iter().all(|mode| mode["free"] == true), "{modes:#?}");
    let (table, said) = call(folder.path(), &["modes", "model.yaml"], 0);
    assert!(
        table.contains("1 to 6") && !said.contains("unstable"),
        "{table}{said}"
    );
    assert!(said.contains("moves at up to 3.00 m/s"), "{said}");
}

/// Laws that cannot be differentiated in symbols can by dual numbers: an ellipsoid lies on another, m g/k deep.
#[test]
fn ellipsoids_that_push_each_other_ring() {
    let folder = tempdir().unwrap();
    let text = "\
model: eggs
dimension: 3
systems:
  - name: s
    reference: fixed
    elements: [{ name: upper, joint: { slider: z }, mass: 2, cg: [0, 0, 0], inertia: [1, 1, 1] }]
forces:
  - { field: gravity, acceleration: [0, 0, -9.81] }
  - { contact: eggs, ellipsoid: { on: s/upper, center: [0, 0, 0], semi_axes: [0.1, 0.12, 0.05] }, with: { on: frame, center: [0, 0, -0.12019], semi_axes: [0.2, 0.1, 0.08] }, stiffness: 2000, damping: 4 }
run: { duration: 1, every: 0.1 }
";
    let modes = found(folder.path(), text, &[]);
    assert_eq!(modes.len(), 1);
    near(
        number(&modes[0]["frequency_Hz"]),
        1000.0_f64.sqrt() / TAU,
        1e-9,
    );
    // d/(2 √(k m))
    near(
        number(&modes[0]["damping"]),
        4.0 / (2.0 * 4000.0_f64.sqrt()),
        1e-8,
    );
}

#[test]
fn memory_of_an_output_is_no_part_of_the_modes() {
    let folder = tempdir().unwrap();
    // the output alone keeps the switch
    let text = CARTS.replace(
        "run: {",
        "switches: [{ switch: far, when: { of: s/a, what: displacement, component: x, above: 1 m } }]\noutputs: [{ name: far, of: switch far, what: time }]\nrun: {",
    );
    assert_eq!(found(folder.path(), &text, &[]).len(), 3);
}

#[test]
fn a_load_that_begins_later_ends_the_rest() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let text = CARTS.replace(
        "run: {",
        "  - { load: push, on: s/c, force: [{ points: [[0, 0], [0.1, 0], [0.2, 50]] }, 0] }\nrun: {",
    );
    assert_eq!(found(folder, &text, &[]).len(), 3);
    // the same state, at the time of the load
    let run = [
        "run",
        "model.yaml",
        "--no-files",
        "--duration",
        "0.1 s",
        "--final-state",
        "s.json",
    ];
    call(folder, &run, 0);
    let state = std::fs::read_to_string(folder.join("s.json")).unwrap();
    let later = state.replace("\"time\": 0.1", "\"time\": 0.2");
    assert_ne!(later, state);
    std::fs::write(folder.join("s.json"), later).unwrap();
    let (_, said) = call(folder, &["modes", "model.yaml", "--start", "s.json"], 2);
    assert!(said.contains("no state of rest"), "{said}");
}

#[test]
fn what_cannot_move_has_no_modes() {
    let folder = tempdir().unwrap();
    let text = CARTS.replace("joint: { slider: x }", "joint: weld");
    let text = text.replace("forces:\n  - { joint: s/a, stiffness: k, damping: d }\n  - { joint: s/b, stiffness: k, damping: d }\n  - { joint: s/c, stiffness: k, damping: d }\n", "");
    let text = text.replace(
        "parameters: { k: { value: 1000 N/m, min: 0 }, d: { value: 0, min: 0 } }\n",
        "",
    );
    std::fs::write(folder.path().join("model.yaml"), text).unwrap();
    let (_, said) = call(folder.path(), &["modes", "model.yaml"], 2);
    assert!(said.contains("nothing in the model can move"), "{said}");
}

#[test]
fn what_does_not_rest_has_no_modes() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let aside = ROD.replace("cg: [0, 0, -0.5]", "cg: [0.5, 0, 0]");
    std::fs::write(folder.join("model.yaml"), aside).unwrap();
    let (_, said) = call(folder, &["modes", "model.yaml"], 2);
    assert!(said.contains("no state of rest"), "{said}");
    assert!(said.contains("bryant settle model.yaml"), "{said}");
    // by the way that the message names
    let settle = [
        "settle",
        "model.yaml",
        "-o",
        "rest.json",
        "--distance",
        "off",
    ];
    call(folder, &settle, 0);
    let (table, _) = call(folder, &["modes", "model.yaml", "--start", "rest.json"], 0);
    // √(m g s / (J + m s²)) / 2π; J is another one about the lying rod
    assert!(table.contains("0.6"), "{table}");
    // a body that turns about its centre of gravity
    let turning = ROD.replace("cg: [0, 0, -0.5]", "cg: [0, 0, 0]").replace(
        "inertia: [0.1, 0.1, 0.02] }]",
        "inertia: [0.1, 0.1, 0.02] }]\n    start: { rates: { rod: [0, 0, 3] } }",
    );
    std::fs::write(folder.join("model.yaml"), turning).unwrap();
    let (_, said) = call(folder, &["modes", "model.yaml"], 2);
    assert!(said.contains("rad/s"), "{said}");
    // a force whose derivative nobody knows
    let (_, said) = call(folder, &["modes", "skydiver"], 2);
    assert!(said.contains("help:"), "{said}");
}

/// A body in space on a bushing that resists each of its motions by another stiffness.
const MOUNTED: &str = "\
model: mounted
dimension: 3
coordinates: quaternion
systems:
  - name: s
    elements: [{ name: block, mass: 2, cg: [0, 0, 0], inertia: [0.1, 0.2, 0.3] }]
    start: { position: [1, 2, 3] }
forces:
  - bushing: mount
    from: { on: frame, at: [1, 2, 3] }
    to: { on: s/block, at: [0, 0, 0] }
    along: { x: { stiffness: 100 }, y: { stiffness: 300 }, z: { stiffness: 700 } }
    about: { x: { stiffness: 2 }, y: { stiffness: 3 }, z: { stiffness: 5 } }
run: { duration: 1 s, every: 10 ms }
";

/// The poses of a mode: by pose and body, its position and its quaternion. The state of rest is before them.
fn poses(data: &Value, mode: usize) -> (Vec<[f64; 7]>, Vec<Vec<[f64; 7]>>) {
    let frames = data["scene"]["frames"].as_array().unwrap();
    let count = data["scene"]["times"].as_array().unwrap().len();
    assert_eq!(
        frames.len(),
        1 + count * data["modes"].as_array().unwrap().len()
    );
    let read = |frame: &Value| -> Vec<[f64; 7]> {
        let numbers: Vec<f64> = frame.as_array().unwrap().iter().map(number).collect();
        numbers.as_chunks::<7>().0.to_vec()
    };
    let first = 1 + count * mode;
    let all = frames[first..first + count].iter().map(read).collect();
    (read(&frames[0]), all)
}

/// The page of modes of a text.
fn drawn(folder: &Path, text: &str) -> Value {
    std::fs::write(folder.join("model.yaml"), text).unwrap();
    call(
        folder,
        &["modes", "model.yaml", "--report", "modes.html"],
        0,
    );
    page(&folder.join("modes.html")).1
}

/// The page writes numbers with six digits.
const DIGITS: f64 = 5e-6;

#[test]
fn carts_are_drawn_in_the_shapes_of_a_chain() {
    let folder = tempdir().unwrap();
    let data = drawn(folder.path(), CARTS);
    for mode in 0..3 {
        let angle = (2 * mode + 1) as f64 * PI / 14.0;
        let place = |n: usize| (2.0 * n as f64 * angle).sin();
        let (rest, poses) = poses(&data, mode);
        let steps = poses.len() - 1;
        let moved = |pose: usize, n: usize| poses[pose][n][0] - rest[n][0];
        let largest = (0..3).map(|n| moved(0, n).abs()).fold(0.0, f64::max);
        assert!(largest > 0.05, "{largest}");
        for n in 0..3 {
            for pose in 0..=steps {
                // all in phase, by the cosine
                let expected = moved(0, 0) * place(n + 1) / place(1);
                let expected = expected * (TAU * pose as f64 / steps as f64).cos();
                let error = (moved(pose, n) - expected).abs();
                // both are differences of numbers up to 3 with six digits, and one is multiplied by up to 2.3
                assert!(
                    error < 20.0 * DIGITS,
                    "mode {mode}, cart {n}, pose {pose}: {error}"
                );
            }
        }
        let farthest = number(&data["modes"][mode]["farthest"]);
        assert!(
            (farthest - largest).abs() < 4.0 * DIGITS,
            "{farthest} {largest}"
        );
        // as the drawing's size has it: a tenth
        near(farthest, 0.1 * number(&data["size"]), 1e-4);
        // which way each goes
        let signs: Vec<bool> = (0..3).map(|n| moved(0, n) * moved(0, 0) > 0.0).collect();
        match mode {
            0 => assert_eq!(signs, [true, true, true]),
            2 => assert_eq!(signs, [true, false, true]),
            _ => {}
        }
    }
}

/// The end of a rod stays at its distance from the joint, where a straight line would lead away from it.
#[test]
fn the_end_of_a_pendulum_is_drawn_on_an_arc() {
    let folder = tempdir().unwrap();
    let text = "\
model: pendulum
dimension: 2
systems:
  - name: s
    reference: fixed
    elements:
      - { name: rod, mass: 1, cg: [0, -0.5], inertia: 0.1 }
      - { name: bob, on: rod, at: [0, -1], joint: weld, mass: 1, cg: [0, 0], inertia: 0.01 }
forces: [{ field: gravity, acceleration: [0, -9.81] }]
run: { duration: 1, every: 0.1 }
";
    let data = drawn(folder.path(), text);
    let (rest, poses) = poses(&data, 0);
    near(rest[1][2], -1.0, DIGITS);
    let mut widest: f64 = 0.0;
    for pose in &poses {
        let [x, _, z, ..] = pose[1];
        assert!((x.hypot(z) - 1.0).abs() < 2.0 * DIGITS, "{x} {z}");
        // the angle of the rod is that of its end
        let angle = 2.0 * pose[0][5].atan2(pose[0][3]);
        assert!((x + angle.sin()).abs() < 4.0 * DIGITS, "{x} {angle}");
        widest = widest.max(x.abs());
    }
    assert!(widest > 0.05, "{widest}");
}

/// A body turns about the axes of its bushing by a rotation vector, in both kinds of coordinates.
#[test]
fn a_mounted_body_is_drawn_turning_about_an_axis() {
    let folder = tempdir().unwrap();
    for coordinates in ["quaternion", "bryant"] {
        let text = MOUNTED.replace("quaternion", coordinates);
        let data = drawn(folder.path(), &text);
        let modes = data["modes"].as_array().unwrap();
        // √(k/m), √(k/J)
        let mut rates = [
            (100.0_f64 / 2.0, None),
            (300.0 / 2.0, None),
            (700.0 / 2.0, None),
            (2.0 / 0.1, Some(0)),
            (3.0 / 0.2, Some(1)),
            (5.0 / 0.3, Some(2)),
        ];
        rates.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(modes.len(), 6);
        for (mode, (squared, axis)) in rates.into_iter().enumerate() {
            near(number(&modes[mode]["lasts"]), TAU / squared.sqrt(), 1e-9);
            let Some(axis) = axis else { continue };
            let (_, poses) = poses(&data, mode);
            let steps = poses.len() - 1;
            let coordinate = &modes[mode]["coordinates"][0];
            let angle = number(&coordinate["amplitude"]).to_radians();
            assert!(angle > 0.1, "{angle}");
            for (k, pose) in poses.iter().enumerate() {
                let [x, y, z, w, turn @ ..] = pose[0];
                assert!((x - 1.0).abs() + (y - 2.0).abs() + (z - 3.0).abs() < DIGITS);
                let found = 2.0 * turn[axis].atan2(w);
                let expected = angle * (TAU * k as f64 / steps as f64).cos();
                assert!(
                    (found - expected).abs() < 4.0 * DIGITS,
                    "{found} {expected}"
                );
                let across = (0..3).filter(|i| *i != axis).map(|i| turn[i].abs());
                assert!(across.sum::<f64>() < DIGITS, "{turn:?}");
            }
        }
    }
}

/// The poses are those of the model at the state that the shape leads to, as a run from this state begins.
#[test]
fn poses_of_a_mode_are_those_of_the_model_beside_the_state() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    call(folder, &["settle", "robot-arm", "-o", "rest.json"], 0);
    let modes = [
        "modes",
        "robot-arm",
        "--start",
        "rest.json",
        "--report",
        "modes.html",
    ];
    call(folder, &modes, 0);
    let (_, data) = page(&folder.join("modes.html"));
    let all = data["modes"].as_array().unwrap();
    let swings = all.iter().position(|mode| mode["course"] == "oscillates");
    let swings = swings.unwrap();
    let (rest, poses) = poses(&data, swings);
    let steps = poses.len() - 1;
    let state = std::fs::read_to_string(folder.join("rest.json")).unwrap();
    let state: Value = serde_json::from_str(&state).unwrap();
    let mut phases = Vec::new();
    for k in [0, 5, 16] {
        let mut moved = state.clone();
        for one in all[swings]["coordinates"].as_array().unwrap() {
            let [amplitude, phase] =
                ["amplitude", "phase"].map(|key| number(&one[key]).to_radians());
            assert_eq!(one["unit"], "deg");
            let name = one["name"].as_str().unwrap().strip_suffix("-rate").unwrap();
            let at = &mut moved["coordinates"][name];
            *at = (number(at) + amplitude * (phase + TAU * k as f64 / steps as f64).cos()).into();
            phases.push(phase);
        }
        std::fs::write(folder.join("moved.json"), moved.to_string()).unwrap();
        let run = "run robot-arm --start moved.json --duration 1us --every 1us --no-files --no-verify --report run.html";
        call(folder, &run.split(' ').collect::<Vec<_>>(), 0);
        let (_, run) = page(&folder.join("run.html"));
        let found = run["scene"]["frames"][0].as_array().unwrap();
        let found: Vec<f64> = found.iter().map(number).collect();
        let mut far: f64 = 0.0;
        for (at, (found, pose)) in found.iter().zip(poses[k].as_flattened()).enumerate() {
            assert!(
                (found - pose).abs() < 2.0 * DIGITS,
                "pose {k}, number {at}: {found} {pose}"
            );
            far = far.max((pose - rest.as_flattened()[at]).abs());
        }
        assert!(far > 0.01, "{far}");
    }
    // friction and damping: not all are in phase
    assert!(
        phases.iter().any(|phase| phase.sin().abs() > 0.5),
        "{phases:?}"
    );
}

/// What decays is drawn as it decays, and what grows as it grows; a body that flies on is drawn about where it is.
#[test]
fn modes_without_oscillation_are_drawn_in_their_course() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let data = drawn(folder, &ROD.replace("-0.5]", "0.5]"));
    let modes = data["modes"].as_array().unwrap();
    for (course, first, last) in [
        ("grows", (-3.0_f64).exp(), 1.0),
        ("decays", 1.0, (-3.0_f64).exp()),
    ] {
        let of = |mode: &&Value| mode["course"] == course;
        assert_eq!(modes.iter().filter(of).count(), 2, "{modes:#?}");
        let index = modes.iter().position(|mode| of(&mode)).unwrap();
        let (_, poses) = poses(&data, index);
        let angle =
            |k: usize| 2.0 * f64::hypot(poses[k][0][4], poses[k][0][5]).atan2(poses[k][0][3]);
        let largest = angle(0).max(angle(poses.len() - 1));
        assert!(largest > 0.1);
        for (k, share) in [(0, first), (poses.len() - 1, last)] {
            assert!(
                (angle(k) - share * largest).abs() < 8.0 * DIGITS,
                "{course}: {}",
                angle(k)
            );
        }
    }
    assert_eq!(data["unstable"], true);
    let stone = "\
model: stone
dimension: 2
systems: [{ name: s, elements: [{ name: stone, mass: 2, cg: [0, 0], inertia: 1 }], start: { position: [5, 7], velocity: [3, 0] } }]
run: { duration: 1, every: 0.1 }
";
    let data = drawn(folder, stone);
    assert_eq!(data["unstable"], false);
    for mode in 0..6 {
        assert_eq!(data["modes"][mode]["course"], "free");
        let (rest, poses) = poses(&data, mode);
        assert_eq!(rest[0][..3], [5.0, 0.0, 7.0]);
        // to and fro
        let half = poses.len() / 2;
        for i in 0..3 {
            let middle = 0.5 * (poses[0][0][i] + poses[half][0][i]);
            assert!((middle - rest[0][i]).abs() < 2.0 * DIGITS * 7.0, "{middle}");
        }
    }
    // each of the three motions, alone
    let first = |mode: usize| data["modes"][mode]["coordinates"][0].clone();
    let mut names: Vec<String> = (0..6).map(|mode| first(mode)["name"].to_string()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 3, "{names:?}");
    assert!((0..6).all(|mode| number(&first(mode)["share"]) > 1.0 - 1e-5));
}

/// As the other reports, the page replaces no file that is not ours, and is not printed.
#[test]
fn a_page_of_modes_goes_where_it_may() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("model.yaml"), CARTS).unwrap();
    std::fs::write(folder.join("mine.html"), "my own page").unwrap();
    for (path, said) in [
        ("mine.html", "--force"),
        ("-", "is not printed"),
        ("model.yaml", "is read"),
    ] {
        let (_, wrong) = call(folder, &["modes", "model.yaml", "--report", path], 2);
        assert!(wrong.contains(said), "{path}: {wrong}");
    }
    assert_eq!(
        std::fs::read(folder.join("mine.html")).unwrap(),
        b"my own page"
    );
    call(
        folder,
        &["modes", "model.yaml", "--report", "mine.html", "--force"],
        0,
    );
    // one that is ours is replaced
    let two = [
        "modes",
        "model.yaml",
        "--report",
        "mine.html",
        "--most",
        "2",
        "--json",
    ];
    let (json, _) = call(folder, &two, 0);
    assert!(serde_json::from_str::<Value>(&json).is_ok());
    let (text, data) = page(&folder.join("mine.html"));
    assert_eq!(data["modes"].as_array().unwrap().len(), 2);
    assert!(text.contains("prefers-reduced-motion"));
    assert!(!text.contains("http:") && !text.contains("https:") && !text.contains("src="));
}
