//! The check of every run: outputs that are not as accurate as promised are computed sharper, or reported.

use super::command_call::call;
use super::json;
use serde_json::Value;
use std::path::Path;

/// 1 kg at rest on 10⁸ N/m: 9.81 N press it in by 9.81e-8 m.
const REST: &str = "\
model: rest
dimension: 2
parameters: { lift: 0 m }
systems:
  - name: ball
    elements: [{ name: body, mass: 1 kg, cg: [0, 0], inertia: 1e-4 }]
    start: { position: [0, lift + 0.01 - 9.81e-8] }
forces:
  - { field: gravity, acceleration: [0, -9.81] }
  - contact: floor
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [10 mm, 10 mm] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { points: [[0, 0], [1 mm, 100 kN]], extrapolate: linear }
outputs:
  - { name: force, of: contact floor, what: force }
  - { name: speed, of: ball/body, what: velocity, component: z }
run: { duration: 0.2 s, every: 5 ms }
";

/// φ̈ = −φ from φ₀: φ = φ₀ cos t.
const SMALL: &str = "\
model: small
dimension: 2
parameters: { start: 1e-6 rad }
systems:
  - name: swing
    reference: fixed
    elements: [{ name: body, mass: 1 kg, cg: [0, 0], inertia: 1 }]
    start: { angles: { body: start } }
forces: [{ joint: swing/body, elastic: { points: [[-1, -1], [1, 1]], extrapolate: linear } }]
outputs: [{ name: angle, of: swing/body, what: angle }]
run: { duration: 20 s, every: 0.1 s }
";

/// Two rods that fall from near the top: chaotic.
const CHAOS: &str = "\
model: chaos
dimension: 2
systems:
  - name: arm
    reference: fixed
    elements:
      - { name: upper, mass: 1, cg: [0, -0.5], inertia: 0.08 }
      - { name: lower, on: upper, at: [0, -1], mass: 1, cg: [0, -0.5], inertia: 0.08 }
    start: { angles: { upper: 3, lower: 3 } }
forces: [{ field: gravity, acceleration: [0, -9.81] }]
outputs: [{ name: angle, of: arm/lower, what: angle }]
run: { duration: 100 s, every: 1 s }
";

/// Runs a scene with these arguments, and its JSON.
fn run(here: &Path, scene: &str, arguments: &[&str], code: i32) -> (Value, String) {
    std::fs::write(here.join("scene.yaml"), scene).unwrap();
    let all = ["run", "scene.yaml", "--no-files", "--json"];
    let all: Vec<&str> = all.iter().chain(arguments).copied().collect();
    let (stdout, stderr) = call(here, &all, code);
    (json(&stdout), stderr)
}

/// The values of an output.
fn output(run: &Value, name: &str) -> Vec<f64> {
    let columns = run["columns"].as_array().unwrap();
    let place = columns.iter().position(|column| column["name"] == name);
    let place = place.unwrap_or_else(|| panic!("no {name}: {run}"));
    let rows = run["rows"].as_array().unwrap();
    rows.iter()
        .map(|row| row[place].as_f64().unwrap())
        .collect()
}

/// A free rod whose centre of gravity moves along a straight line: the acceleration of this point is 0, that of the end
/// is not.
const ROD: &str = "\
model: rod
title: a free rod
dimension: 2
systems:
  - name: rod
    reference: free
    elements: [{ name: bar, mass: 1, cg: [0.5, 0], inertia: 0.0833 }]
    start: { angles: { bar: 0.3 rad }, velocity: [0, -0.5], rates: { bar: 1 } }
forces: [{ joint: rod/bar, stiffness: 10 }]
outputs: [{ name: a, of: rod/bar, what: acceleration, component: z, at: [PLACE, 0] }]
run: { duration: 1 s }
";

#[test]
fn an_output_of_rounding_errors_alone_is_no_alarm() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let chosen = ["--method", "rk4", "--step", "1 ms"];
    for arguments in [&[][..], &["--verify"], &chosen] {
        let (run, _) = run(here, &ROD.replace("PLACE", "0.5"), arguments, 0);
        let vanishing = &run["accuracy"]["verified"]["difference"]["vanishing"]["a"];
        // |ω|² L is some m/s²
        let bound = vanishing["bound"].as_f64().unwrap();
        assert!(bound > 0.0 && bound < 1e-13, "{arguments:?}: {bound}");
    }
    run(
        here,
        &ROD.replace("PLACE", "0.5"),
        &["--accuracy", "1e-6"],
        0,
    );
    // a point beside it has an acceleration, and steps that are too long cause an error
    let (beside, _) = run(here, &ROD.replace("PLACE", "0.500001"), &[], 0);
    let known = &beside["accuracy"]["verified"]["difference"];
    assert!(
        known["vanishing"].as_object().unwrap().is_empty(),
        "{known}"
    );
    assert!(known["worst"].as_f64().unwrap() < 1e-3, "{known}");
    let coarse = ["--method", "heun", "--step", "10 ms"];
    let stiff = ROD
        .replace("PLACE", "0.500001")
        .replace("stiffness: 10", "stiffness: 1000");
    run(here, &stiff, &coarse, 3);
}

#[test]
fn the_force_below_a_ball_at_rest_is_its_weight() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (checked, _) = run(here, REST, &[], 0);
    let wrong = |force: &f64| (force / 9.81 - 1.0).abs() > 1e-3;
    assert!(!output(&checked, "force").iter().any(wrong), "{checked}");
    // the speed is exactly 0 and never agrees: a bound is reported, not an alarm
    let difference = &checked["accuracy"]["verified"]["difference"];
    assert!(
        difference["vanishing"]["speed"]["bound"].as_f64().unwrap() < 1e-6,
        "{difference}"
    );
    // the control of accelerations alone keeps the promise
    let (unchecked, _) = run(here, REST, &["--no-verify"], 0);
    assert!(
        !output(&unchecked, "force").iter().any(wrong),
        "{unchecked}"
    );
}

#[test]
fn a_small_oscillation_is_as_accurate_as_a_large_one() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for start in ["1 rad", "1e-6 rad"] {
        let set = format!("start={start}");
        let (checked, _) = run(here, SMALL, &["--set", &set], 0);
        let angle = output(&checked, "angle");
        for (row, angle) in angle.iter().enumerate() {
            let t = 0.1 * row as f64;
            let size = if start == "1 rad" { 1.0 } else { 1e-6 };
            assert!(
                (angle / size - t.cos()).abs() <= 1e-3,
                "{start} at {t}: {angle}"
            );
        }
    }
}

#[test]
fn a_motion_that_makes_every_error_large_is_said_to_do_so() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    std::fs::write(here.join("scene.yaml"), CHAOS).unwrap();
    let (stdout, stderr) = call(here, &["run", "scene.yaml", "--no-files"], 3);
    assert!(
        stdout.lines().count() > 100,
        "the table is there all the same"
    );
    assert!(stderr.contains("not as accurate as 0.1 %"), "{stderr}");
    assert!(stderr.contains("grows by a factor of"), "{stderr}");
    // while the motion is still regular, nothing is wrong
    call(
        here,
        &["run", "scene.yaml", "--no-files", "--duration", "2 s"],
        0,
    );
}

#[test]
fn a_method_of_ones_own_is_checked_and_not_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // a difference of 0.2 %: more than the default promise, but nothing was promised
    let coarse = ["--method", "dopri5", "--tolerance", "1e-5"];
    let (checked, _) = run(here, SMALL, &coarse, 0);
    let worst = checked["accuracy"]["verified"]["difference"]["worst"]
        .as_f64()
        .unwrap();
    assert!(
        worst > 1e-3 && checked["accuracy"]["runs"] == 2,
        "{checked}"
    );
    // a step of a third of the period is completely wrong
    let absurd = ["--method", "rk4", "--step", "2 s", "--every", "2 s"];
    let absurd: Vec<&str> = absurd
        .into_iter()
        .chain(["--energy-limit", "off"])
        .collect();
    let (_, stderr) = run(here, SMALL, &absurd, 3);
    assert!(stderr.contains("not as accurate as 10 %"), "{stderr}");
    let (unchecked, _) = run(here, SMALL, &[&absurd[..], &["--no-verify"]].concat(), 0);
    assert!(unchecked["accuracy"]["verified"].is_null(), "{unchecked}");
}

#[test]
fn a_slow_run_names_the_force_that_bounds_its_steps() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let long = ["--duration", "1000 s", "--every", "10 s", "--no-verify"];
    // the explicit method alone: by itself a run changes to one that takes long steps here
    let explicit = ["--method", "dopri5", "--time-limit", "0.3 s"];
    let limited: Vec<&str> = long.into_iter().chain(explicit).collect();
    let (run, stderr) = run(here, REST, &limited, 3);
    for part in [
        "was stopped at t = ",
        "contact floor",
        "ball",
        "--time-limit",
    ] {
        assert!(stderr.contains(part), "{part}: {stderr}");
    }
    // the computed results are written
    assert!(!run["rows"].as_array().unwrap().is_empty(), "{run}");
}

#[test]
fn a_verification_that_fails_is_an_error() {
    let directory = tempfile::tempdir().unwrap();
    let (_, stderr) = run(directory.path(), CHAOS, &["--verify"], 3);
    assert!(stderr.contains("not as accurate as"), "{stderr}");
}

/// Two links, thrown to the floor: their hinge is free, so its moment about its own axis is 0, but for the rounding of
/// the moments of the impact, which are gone at the end. The peg hangs on a spring of 1 kN/m and swings by 1 µm: its
/// force is 1 mN.
const HINGE: &str = "\
model: hinge
dimension: 3
systems:
  - name: arm
    elements:
      - { name: a, mass: 2, cg: [0.3, 0.1, -0.2], inertia: [0.1, 0.2, 0.15] }
      - { name: b, on: a, at: [0.6, 0, 0], joint: { hinge: y }, mass: 1, cg: [0.2, 0, -0.1], inertia: [0.02, 0.05, 0.04] }
    start: { position: [0, 0, 1], velocity: [1, 0, -3] }
  - name: peg
    elements: [{ name: p, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
    start: { position: [0, 0, 5 + 1e-6] }
forces:
  - { field: gravity, acceleration: [0, 0, -9.81], on: [arm] }
  - { contact: near, ellipsoid: { on: arm/a, semi_axes: [0.1, 0.1, 0.1], center: [0, 0, 0] }, plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }, stiffness: 1e6, damping: 100 }
  - { contact: far, ellipsoid: { on: arm/b, semi_axes: [0.1, 0.1, 0.1], center: [0.3, 0, 0] }, plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }, stiffness: 1e6, damping: 100 }
  - { bushing: hanger, from: { on: frame, at: [0, 0, 5] }, to: { on: peg/p, at: [0, 0, 0] }, along: { z: { stiffness: 1000 } } }
outputs:
  - { name: M, of: joint arm/b, what: moment, component: y, axes: arm/b }
  - { name: F, of: bushing hanger, what: force, on: peg/p, component: z }
run: { duration: 0.5 s, every: 1 ms }
";

#[test]
fn the_moment_of_a_free_hinge_is_no_alarm_and_a_small_force_is_judged() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (found, _) = run(here, HINGE, &[], 0);
    let difference = &found["accuracy"]["verified"]["difference"];
    // about 5 kN at 1 m, so 1e-12 of rounding
    let bound = difference["vanishing"]["M"]["bound"].as_f64().unwrap();
    assert!(bound > 0.0 && bound < 1e-10, "{bound}");
    let vanishing = difference["vanishing"].as_object().unwrap();
    assert!(!vanishing.contains_key("F"), "{difference}");
    for (row, force) in output(&found, "F").iter().enumerate() {
        let expected = -1e-3 * (1000.0_f64.sqrt() * 1e-3 * row as f64).cos();
        assert!(
            (force - expected).abs() < 1e-3 * 1e-3,
            "{row}: {force} {expected}"
        );
    }
    // steps that are too long for 1 mN are found out, not taken for rounding
    run(here, HINGE, &["--method", "heun", "--step", "4 ms"], 3);
}
