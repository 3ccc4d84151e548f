//! Switches whose quantity exceeds its threshold for a moment within a step: each fires, in single runs and in lanes.

use super::command_call::call;
use super::json;
use std::path::Path;

/// φ = A cos(10 t + p). From the time when φ passes `level` upwards, a moment of 5 N·m acts: φ then swings about 0.05
/// instead of 0.
const SWING: &str = "\
model: swing
dimension: 2
parameters: { start: 1 rad, speed: 0 rad/s, level: 0.99 rad }
systems:
  - name: swing
    reference: fixed
    elements: [{ name: body, mass: 1 kg, cg: [0, 0], inertia: 1 }]
    start: { angles: { body: start }, rates: { body: speed } }
forces:
  - { joint: swing/body, elastic: { points: [[-1, -100], [1, 100]], extrapolate: linear } }
  - { load: push, on: swing/body, moment: 5, since: high }
switches:
  - { switch: high, when: { of: swing/body, what: angle, above: level } }
outputs: [{ name: angle, of: swing/body, what: angle }]
run: { duration: 1 s, every: 0.1 s }
";

/// Rows that exceed their level by 1e-2 to 1e-4, at all phases: [start, speed, level].
fn rows() -> Vec<[f64; 3]> {
    let mut rows = Vec::new();
    for over in [1e-2, 1e-3, 1e-4] {
        for k in 1..=9 {
            let phase = 0.63 * f64::from(k) + 0.11;
            if phase.cos() < 1.0 - 2.0 * over {
                rows.push([phase.cos(), -10.0 * phase.sin(), 1.0 - over]);
            }
        }
    }
    rows
}

/// The angle after 1 s.
fn expected([start, speed, level]: [f64; 3]) -> f64 {
    let (amplitude, phase) = (start.hypot(0.1 * speed), (-0.1 * speed).atan2(start));
    // upwards, where the cosine is level / amplitude and the sine is negative
    let there = -(level / amplitude).acos();
    let at = 0.1 * (there - phase).rem_euclid(2.0 * std::f64::consts::PI);
    let left = 10.0 * (1.0 - at);
    0.05 + (level - 0.05) * left.cos() - amplitude * there.sin() * left.sin()
}

#[test]
fn every_method_feels_a_threshold_that_is_passed_for_a_moment() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("swing.yaml"), SWING).unwrap();
    let rows = rows();
    assert!(rows.len() > 20);
    for method in [
        &["--method", "dopri5"][..],
        &["--method", "tsit5"],
        &["--method", "dop853"],
        &["--method", "merson"],
        &["--method", "rodas5"],
        &["--tolerance", "1e-10"],
        &["--method", "rk4", "--step", "5 ms"],
        &["--method", "dopri5", "--step", "20 ms"],
    ] {
        for row in &rows {
            let set = ["start", "speed", "level"].iter().zip(row);
            let set = set.map(|(name, value)| format!("--set={name}={value}"));
            let set: Vec<String> = set.collect();
            let fixed = ["run", "swing.yaml", "--no-files", "--no-verify", "--json"];
            let all = fixed.iter().chain(method).copied();
            let all: Vec<&str> = all.chain(set.iter().map(String::as_str)).collect();
            let run = json(&call(here, &all, 0).0);
            let last = run["rows"].as_array().unwrap().last().unwrap();
            let angle = last[1].as_f64().unwrap();
            let error = (angle - expected(*row)).abs();
            // a missed switch changes the angle by 0.1; the promised error is 1e-3
            assert!(error < 1e-3, "{method:?} {row:?}: {angle}, {error}");
        }
    }
}

/// The last angles of a study in lanes.
fn study(here: &Path, run: &str) -> Vec<f64> {
    let rows = rows();
    let text = |[start, speed, level]: &[f64; 3]| {
        format!("{{ start: {start}, speed: {speed}, level: {level} }}")
    };
    let rows: Vec<String> = rows.iter().map(text).collect();
    let study = format!(
        "model: swing.yaml\ndesign: list\nrows: [{}]\nrun: {run}\nresponses: [{{ of: angle, what: final }}]\ntables: [csv]\n",
        rows.join(", ")
    );
    std::fs::write(here.join("study.yaml"), study).unwrap();
    let out = tempfile::tempdir_in(here).unwrap();
    let folder = out.path().to_str().unwrap();
    call(here, &["sweep", "study.yaml", "--out", folder], 0);
    let table = std::fs::read_to_string(out.path().join("results.csv")).unwrap();
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = names
        .iter()
        .position(|name| name.starts_with("final of angle"));
    let column = column.unwrap();
    let value = |line: &str| line.split(',').nth(column).unwrap().parse().unwrap();
    lines.map(value).collect()
}

#[test]
fn lanes_feel_a_threshold_that_is_passed_for_a_moment() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("swing.yaml"), SWING).unwrap();
    for run in [
        "{ duration: 1 s }",
        "{ duration: 1 s, accuracy: 1e-6 }",
        "{ duration: 1 s, step: 5 ms }",
        "{ duration: 1 s, step: 20 ms, method: dopri5 }",
    ] {
        let found = study(here, run);
        let rows = rows();
        assert_eq!(found.len(), rows.len());
        for (angle, row) in found.iter().zip(&rows) {
            let error = (angle - expected(*row)).abs();
            assert!(error < 1e-3, "{run} {row:?}: {angle}, {error}");
        }
    }
}
