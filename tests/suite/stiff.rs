//! Stiff scenes are simulated by themselves: the run changes its method, is checked, and is right. Each value follows
//! from a formula.

use super::command_call::call;
use super::json;
use serde_json::Value;

/// Steps that a stiff scene may take, rejected ones with it: a fixed explicit method takes millions.
const FEW: f64 = 2e4;
/// What every run promises, relative to the largest value of an output.
const PROMISED: f64 = 1e-3;

/// Runs a scene with these arguments.
fn run(scene: &str, arguments: &[&str], code: i32) -> (Value, String) {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("scene.yaml"), scene).unwrap();
    let all = ["run", "scene.yaml", "--no-files", "--json"];
    let all: Vec<&str> = all.iter().chain(arguments).copied().collect();
    let (stdout, stderr) = call(here.path(), &all, code);
    (json(&stdout), stderr)
}

/// A run that changed its method, and was checked by one that did.
fn stiff(scene: &str) -> Value {
    let (run, _) = run(scene, &[], 0);
    let report = &run["report"];
    let steps = report["steps"].as_f64().unwrap() + report["rejected"].as_f64().unwrap();
    assert!(report["stiff"].as_f64().unwrap() > 0.0, "{report}");
    assert!(steps < FEW, "{report}");
    let by = run["accuracy"]["verified"]["by"]
        .as_str()
        .unwrap_or_default();
    assert!(by.contains("rodas5"), "{}", run["accuracy"]);
    run
}

/// The values of an output.
fn output(run: &Value, name: &str) -> Vec<f64> {
    let columns = run["columns"].as_array().unwrap();
    let place = columns.iter().position(|column| column["name"] == name);
    let place = place.unwrap_or_else(|| panic!("no {name}"));
    let rows = run["rows"].as_array().unwrap();
    rows.iter()
        .map(|row| row[place].as_f64().unwrap())
        .collect()
}

/// Asserts that a value is as accurate as promised, of an output of this size.
fn near(found: f64, expected: f64, size: f64) {
    assert!(
        (found - expected).abs() <= PROMISED * size,
        "{found} {expected}"
    );
}

/// 45 g between two pads with friction that holds: the bristles bend by weight over the friction that both pads
/// have, 0.45 N of 16.8 N, times 0.05 mm, and by what slips while the pads close in. Then nothing creeps.
#[test]
fn what_is_held_by_friction_does_not_creep() {
    let z = output(&stiff(include_str!("stiff/pinch.yaml")), "z");
    let (middle, last) = (z[z.len() / 2], z[z.len() - 1]);
    let bent = 0.045 * 9.81 / (2.0 * 0.7 * 12.0) * 0.05e-3;
    assert!(last < -bent && last > -1.2 * bent, "{last} {bent}");
    near(middle, last, bent);
}

/// Eight links of a microgram carry a tonne on a straight line: a pendulum of 0.8 m, θ'' = −g/L sin θ, by the classical
/// Runge–Kutta method.
#[test]
fn light_links_with_a_heavy_bob_swing_like_one_rod() {
    let run = stiff(include_str!("stiff/chain.yaml"));
    let (x, force) = (output(&run, "bob x"), output(&run, "F"));
    let (length, gravity, mass) = (0.8, 9.81, 1000.0);
    let rate = |[angle, omega]: [f64; 2]| [omega, -gravity / length * f64::sin(angle)];
    let (mut y, h) = ([0.3f64, 0.0], 1e-4);
    for (row, (x, force)) in x.iter().zip(&force).enumerate() {
        for _ in 0..if row == 0 { 0 } else { 100 } {
            let at = |k: [f64; 2], by: f64| [y[0] + by * k[0], y[1] + by * k[1]];
            let k1 = rate(y);
            let k2 = rate(at(k1, 0.5 * h));
            let k3 = rate(at(k2, 0.5 * h));
            let k4 = rate(at(k3, h));
            for i in 0..2 {
                y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        // positive about +y is from z to x, so the bob of an angle θ is at −L sin θ
        near(x.abs(), (length * y[0].sin()).abs(), 0.3 * length);
        near(
            *force,
            mass * (gravity * y[0].cos() + length * y[1] * y[1]),
            1.2e4,
        );
    }
}

/// Euler and Eytelwein: the tensions on both sides of the drum are in the ratio E = e^(μ π), and 10 kg pull 2 kg up
/// with g (10 − 2E)/(10 + 2E).
#[test]
fn a_rope_over_a_drum_keeps_the_ratio_of_its_friction() {
    let run = stiff(include_str!("stiff/capstan.yaml"));
    let [one, other, height] = ["T1", "T2", "za"].map(|name| *output(&run, name).last().unwrap());
    let ratio = (0.2 * std::f64::consts::PI).exp();
    near(one / other, ratio, ratio);
    let acceleration = 9.81 * (10.0 - 2.0 * ratio) / (10.0 + 2.0 * ratio);
    // the rope gives by its tension over its stiffness per length, twice with its oscillation
    let stretch = 2.0 * 60.0 / 20e3;
    assert!(
        (height + 1.0 + 0.5 * acceleration * 0.25).abs() < stretch,
        "{height}"
    );
}

/// A kilogram on a stiff mount with a strong damper, without inertia: z = −m g/k (1 − exp(−k t/c)).
#[test]
fn a_damped_mount_carries_the_weight() {
    let run = stiff(include_str!("stiff/mount.yaml"));
    let (z, force) = (output(&run, "z"), output(&run, "F"));
    for (row, (z, force)) in z.iter().zip(&force).enumerate().skip(1) {
        let t = 0.02 * row as f64;
        near(*z, -9.81e-8 * (1.0 - (-10.0 * t).exp()), 9.81e-8);
        near(force.abs(), 9.81, 9.81);
    }
}

/// The same on a plate, whose force jittered by 10 % of the weight.
#[test]
fn a_damped_plate_pushes_evenly() {
    let run = stiff(include_str!("stiff/plate.yaml"));
    let (z, force) = (output(&run, "z"), output(&run, "N"));
    for (row, (z, force)) in z.iter().zip(&force).enumerate().skip(1) {
        let t = 0.02 * row as f64;
        near(*z, -9.81e-6 * (1.0 - (-0.1 * t).exp()), 1.78e-6);
        near(*force, 9.81, 9.81);
    }
}

/// The same run by one formula takes millions of steps.
#[test]
fn a_method_turns_the_change_off() {
    let arguments = ["--method", "dopri5", "--no-verify", "--max-steps", "20000"];
    let (_, said) = run(include_str!("stiff/mount.yaml"), &arguments, 3);
    assert!(
        said.contains("limit of 20000 steps") && said.contains("rodas5"),
        "{said}"
    );
}

/// Two bodies at 7.8 km/s with an amplitude of a micrometre: a double tells 3e-11 m apart at 156 km.
#[test]
fn rounding_of_a_large_coordinate_is_named() {
    let (_, said) = run(include_str!("stiff/orbit.yaml"), &[], 3);
    assert!(
        said.contains("rounding") && said.contains("moving origin"),
        "{said}"
    );
    assert!(!said.contains("chaotic"), "{said}");
}

/// The default resistance of a ring rules a light rope, and the run says so.
#[test]
fn a_ring_with_the_default_resistance_is_told_of() {
    let written = include_str!("stiff/capstan.yaml");
    let default = written.replace(", resistance: 0.001", "");
    assert_ne!(written, default);
    let notes = |scene: &str| run(scene, &[], 0).0["notes"].to_string();
    let note = notes(&default);
    assert!(
        note.contains("ring drum") && note.contains("resistance:"),
        "{note}"
    );
    assert!(!notes(written).contains("resistance"));
}
