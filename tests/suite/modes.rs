//! `bryant modes`: frequencies, damping and shapes where they have closed forms.

use crate::called::call;
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
