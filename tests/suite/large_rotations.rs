//! Bushings and joints in space that turn far: the law of the whole rotation against its closed form, and the jump at
//! ±180°, which is said.

use super::command_call::call;
use super::{directory, json};
use serde_json::Value;
use std::path::Path;

/// A ball of 0.01 kg m² that spins at RATES against a mount of 2 N m/rad.
const MOUNT: &str = "\
model: mount
dimension: 3
parameters: { spring: 2 N*m, weight: { value: 1 kg, min: 0.1 kg } }
systems:
  - name: b
    elements: [{ name: body, mass: weight, cg: [0, 0, 0], inertia: [0.01, 0.01, 0.01] }]
    start: { rates: { body: RATES } }
forces:
  - bushing: m
    from: { on: frame, at: [0, 0, 0] }
    to: { on: b/body, at: [0, 0, 0] }
    about: { LAW }
outputs:
  - { name: w, of: b/body, what: angular_velocity, component: resultant }
  - { name: turn, of: bushing m, what: angle, component: COMPONENT }
run: { duration: 0.3 s, every: 2 ms }
";

fn mount(rates: &str, law: &str, component: &str) -> String {
    MOUNT
        .replace("RATES", rates)
        .replace("LAW", law)
        .replace("COMPONENT", component)
}

fn run(here: &Path, scene: &str, code: i32) -> (Value, String) {
    std::fs::write(here.join("scene.yaml"), scene).unwrap();
    let (stdout, stderr) = call(here, &["run", "scene.yaml", "--no-files", "--json"], code);
    (json(&stdout), stderr)
}

/// J φ̈ = −k φ with J = 0.01 kg m² and k = 2 N m/rad: φ = 30/√200 sin √200 t rad, up to 121.5°. By symmetry it is so
/// about any axis.
#[test]
fn the_whole_rotation_swings_about_any_axis_alike() {
    let directory = directory();
    let omega = 200.0_f64.sqrt();
    for rates in [
        "30, 0, 0",
        "0, 30, 0",
        "0, 0, -30",
        "18, -24, 0",
        "10, 20, 20",
    ] {
        let scene = mount(
            &format!("[{rates}]"),
            "turn: { stiffness: spring }",
            "resultant",
        );
        let (found, _) = run(directory.path(), &scene, 0);
        let mut largest: f64 = 0.0;
        for row in found["rows"].as_array().unwrap() {
            let [t, turn] = [0, 2].map(|i| row[i].as_f64().unwrap());
            let expected = 30.0 / omega * (omega * t).sin().abs();
            // as promised: 0.1 % of the largest
            assert!(
                (turn - expected).abs() < 1e-3 * 2.1213,
                "{rates} at {t}: {turn}"
            );
            largest = largest.max(turn);
        }
        assert!(
            (largest.to_degrees() - 121.5).abs() < 0.5,
            "{rates}: {largest}"
        );
        // ½ k φ² is stored and given back
        let energy = &found["energy"];
        let missing = energy["not_accounted_for"].as_f64().unwrap();
        assert!(missing.abs() < 1e-3 * 4.5, "{energy}");
    }
    // about a single axis it is the law by angles; components are those of the rotation vector
    let by_angle = mount("[0, 0, 10]", "z: { stiffness: spring, damping: 0.05 }", "z");
    let whole = mount(
        "[0, 0, 10]",
        "turn: { stiffness: spring, damping: 0.05 }",
        "z",
    );
    let rows = [by_angle, whole].map(|scene| run(directory.path(), &scene, 0).0["rows"].clone());
    let pairs = rows[0]
        .as_array()
        .unwrap()
        .iter()
        .zip(rows[1].as_array().unwrap());
    for (a, b) in pairs {
        let [a, b] = [a, b].map(|row| row[2].as_f64().unwrap());
        assert!((a - b).abs() < 2e-3 * 0.6, "{a} {b}");
    }
}

/// An elastic torque jumps where its angle goes through ±180°. A run says so, and so do its derivatives.
#[test]
fn a_torque_that_jumps_at_half_a_turn_is_no_result() {
    let directory = directory();
    let here = directory.path();
    // ½ J ω² = 12.5 J of rotation against ½ k π² = 9.9 J: over the top
    let over = |law: &str, axis: &str| mount(&axis.replace('W', "50"), law, "x");
    for (law, axis) in [
        ("z: { stiffness: spring }", "[0, 0, W]"),
        ("x: { stiffness: spring }", "[-W, 0, 0]"),
        ("turn: { stiffness: spring }", "[0, W, 0]"),
        (
            "turn: { stiffness: spring }",
            "[0.6 * W rad/s, 0, -0.8 * W rad/s]",
        ),
    ] {
        let scene = over(law, axis);
        let (_, said) = run(here, &scene, 3);
        assert!(said.contains("180°") && said.contains("help: "), "{said}");
        let gradient = [
            "gradient",
            "scene.yaml",
            "--of",
            "final of w",
            "--wrt",
            "spring",
        ];
        let (_, said) = call(here, &gradient, 3);
        assert!(said.contains("180°"), "{said}");
    }
    // it turns back before; or nothing is elastic
    for (rates, law) in [
        ("[0, 0, 40]", "z: { stiffness: spring }"),
        ("[0, 0, 50]", "z: { damping: 0.001 }"),
        ("[30, 30, 0]", "turn: { damping: 0.001 }"),
    ] {
        run(here, &mount(rates, law, "x"), 0);
    }
}

/// Where the angle about y goes through ±90°, those about x and z leap by half a turn: that is one thing, not three.
/// The same at the middle angle of another order, and an angle about x alone still goes through ±180° by itself.
#[test]
fn what_leaps_with_the_middle_angle_is_told_once() {
    let directory = directory();
    let here = directory.path();
    let law = "x: { stiffness: 0.001 }, y: { damping: 0.001 }, z: { stiffness: 0.001 }";
    let joint = |rates: &str, law: &str| {
        format!(
            "model: joint\ndimension: 3\nsystems:\n  - name: top\n    reference: fixed\n    elements: [{{ name: body, mass: 1, cg: [0, 0, 0], \
             inertia: [0.01, 0.01, 0.01] }}]\n    start: {{ rates: {{ body: {rates} }} }}\nforces: [{{ joint: top/body, about: {{ {law} }} }}]\n\
             outputs: [{{ name: w, of: top/body, what: angular_velocity, component: z }}]\nrun: {{ duration: 0.2 s, every: 10 ms }}\n"
        )
    };
    for (scene, told) in [
        (
            mount("[0, 10, 0]", law, "x"),
            "\"bushing m\" is turned through ±90° about y",
        ),
        (
            mount("[0, -10, 0]", law, "x"),
            "\"bushing m\" is turned through ±90° about y",
        ),
        (
            mount("[20, 0, 0]", law, "x"),
            "\"bushing m about x\" is turned through ±180°",
        ),
        (
            joint("[0, 10, 0]", law),
            "\"joint top/body about x, y and z\" is turned through ±90° about y",
        ),
        (
            joint("[0, 0, 20]", law),
            "\"joint top/body about z\" is turned through ±180°",
        ),
    ] {
        let (_, said) = run(here, &scene, 3);
        assert!(said.contains(told), "{told}: {said}");
        assert_eq!(said.matches("is turned through").count(), 1, "{said}");
    }
}

/// A joint with coordinates of its own counts turns, a ball joint does not.
#[test]
fn joints_that_wrap_say_so() {
    let directory = directory();
    let here = directory.path();
    let scene = |joint: &str, law: &str| {
        format!(
            "model: joint\ndimension: 3\nsystems:\n  - name: top\n    reference: fixed\n    elements: [{{ name: body, {joint} mass: 1, cg: [0, 0, 0], \
             inertia: [0.01, 0.01, 0.01] }}]\n    start: {{ START }}\nforces: [{{ joint: top/body, {law} }}]\noutputs: [{{ name: w, of: top/body, \
             what: angular_velocity, component: z }}]\nrun: {{ duration: 0.3 s, every: 10 ms }}\n"
        )
    };
    for law in [
        "about: { z: { stiffness: 0.1 } }",
        "about: { z: { stop: { to: 3, stiffness: 1 } } }",
        "about: { z: { drive: { to: 0, stiffness: 0.1 } } }",
        "axis: z, torsion: { stiffness: 0.1 }",
    ] {
        let ball = scene("", law).replace("START", "rates: { body: [0, 0, 20] }");
        let (_, said) = run(here, &ball, 3);
        assert!(said.contains("is turned through ±180°"), "{law}: {said}");
    }
    for law in [
        "about: { z: { damping: 1e-4, friction: 1e-3 } }",
        "axis: z, torsion: { damping: 1e-4 }",
    ] {
        run(
            here,
            &scene("", law).replace("START", "rates: { body: [0, 0, 20] }"),
            0,
        );
    }
    let hinge = scene("joint: { hinge: z },", "stiffness: 0.1")
        .replace("START", "joint_rates: { body: 20 }");
    run(here, &hinge, 0);
}

#[test]
fn the_law_of_the_whole_rotation_stands_alone_and_in_space() {
    let directory = directory();
    let here = directory.path();
    for (law, said) in [
        (
            "turn: { stiffness: spring }, y: { damping: 1 }",
            "laws about single axes",
        ),
        ("turn: { elastic: { points: [[0, 0], [1, 1]] } }", "elastic"),
        ("turn: { stiffness: -1 }", "negative"),
    ] {
        std::fs::write(here.join("scene.yaml"), mount("[0, 0, 1]", law, "x")).unwrap();
        let (_, error) = call(here, &["check", "scene.yaml"], 2);
        assert!(
            error.contains(said) && error.contains("scene.yaml:"),
            "{law}: {error}"
        );
    }
}
