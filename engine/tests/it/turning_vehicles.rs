//! Systems whose roots are on joints of their own, on vehicles that turn. They are compared with closed forms, and with
//! the same systems on bodies that turn freely and that nothing brakes.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::{Dynamics, Formula, Integrator, Settings, Tolerances, simulate};
use std::ops::ControlFlow;

const TOLERANCE: f64 = 1e-10;

/// Times and outputs of a run.
fn run(text: &str) -> Vec<(f64, Vec<f64>)> {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("scene.yaml", text, &none)
        .unwrap_or_else(|problems| panic!("{problems}\n{text}"));
    let engine = Engine::new(Config::new().lists(&model)).expect("no functions");
    let machine = engine.over::<f64>();
    let settings = Settings {
        method: Integrator::adaptive(Formula::Dop853, Tolerances::of(TOLERANCE)),
        ..Settings::of(machine.info())
    };
    let mut state = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut state);
    let mut rows = Vec::new();
    simulate::run(&machine, &state, &settings, None, &mut |sample| {
        rows.push((sample.t, sample.outputs.to_vec()));
        ControlFlow::Continue(())
    })
    .expect("it runs");
    assert!(rows.len() > 10, "rows");
    rows
}

/// The angle of a table about an axis, at a constant rate.
fn table(angles: &str) -> String {
    format!(
        "curves: {{ turn: {{ points: [[0, 0], [1, 5]], interpolate: cubic, extrapolate: linear }} }}\n\
         vehicles: [{{ name: table, angles: {angles} }}]\n"
    )
}

/// The error of a motion that amplifies errors by `growth`, after some hundred steps, each with an error of the
/// tolerance.
fn bound(growth: f64) -> f64 {
    300.0 * TOLERANCE * growth
}

#[test]
fn a_bead_on_a_turning_rod_moves_as_a_hyperbolic_cosine() {
    // r̈ = ω² r
    let scene = format!(
        "model: bead\ndimension: 3\n{}systems:\n  - name: s\n    reference: {{ on: table, at: [0, 0, 0.3] }}\n    \
         start: {{ joints: {{ bead: 0.1 }} }}\n    elements: [{{ name: bead, joint: {{ slider: x }}, mass: 1, cg: [0, 0, 0], inertia: [0.1, 0.2, 0.25] }}]\n\
         outputs:\n  - {{ name: r, of: joint s/bead, what: position }}\n  - {{ name: force, of: joint s/bead, what: force, component: y, axes: table }}\n\
         run: {{ duration: 1 s, every: 0.05 s }}\n",
        table("[0, 0, turn]")
    );
    for (t, outputs) in run(&scene) {
        let r = 0.1 * (5.0 * t).cosh();
        // Coriolis: 2 ω ṙ, pushed by the rod
        let force = 2.0 * 5.0 * 0.1 * 5.0 * (5.0 * t).sinh();
        let bound = bound((5.0 * t).exp());
        assert!(
            (outputs[0] - r).abs() <= bound,
            "r at {t}: {} {r}",
            outputs[0]
        );
        assert!(
            (outputs[1] - force).abs() <= 50.0 * bound,
            "force at {t}: {} {force}",
            outputs[1]
        );
    }
}

/// A pendulum of length l on a hinge at the axis of a turntable about z. Its mass is nearly a point: the moments of
/// inertia are negligible.
fn pendulum(angle: f64) -> String {
    format!(
        "model: pendulum\ndimension: 3\n{}systems:\n  - name: s\n    reference: {{ on: table, at: [0, 0, 0] }}\n    \
         start: {{ joints: {{ bob: {angle} }} }}\n    elements: [{{ name: bob, joint: {{ hinge: y }}, mass: 2, cg: [0, 0, -0.8], inertia: [1e-9, 1e-9, 1e-9] }}]\n\
         forces: [{{ field: gravity, acceleration: [0, 0, -9.81] }}]\n\
         outputs: [{{ name: angle, of: joint s/bob, what: angle }}]\nrun: {{ duration: 2 s, every: 0.1 s }}\n",
        table("[0, 0, turn]")
    )
}

#[test]
fn a_pendulum_on_a_turntable_swings_about_its_balance() {
    // θ̈ = ω² sin θ cos θ − (g/l) sin θ: at rest if cos θ = g/(ω² l); small oscillations with ω sin θ
    let (omega, ratio) = (5.0f64, 9.81 / 0.8);
    let rest = (ratio / (omega * omega)).acos();
    for (t, outputs) in run(&pendulum(rest)) {
        // the moments of inertia, 1e-9 compared with 2 · 0.8², move it by less than that
        assert!((outputs[0] - rest).abs() <= 2e-9 + bound(1.0), "{t}");
    }
    let (small, rate) = (1e-4, omega * rest.sin());
    let mut moved = 0.0f64;
    for (t, outputs) in run(&pendulum(rest + small)) {
        let expected = rest + small * (rate * t).cos();
        moved = moved.max((outputs[0] - rest - small).abs());
        // a second harmonic of the order of the square, and a frequency error of the same order, over ten radians
        assert!(
            (outputs[0] - expected).abs() <= 10.0 * small * small + 2e-9,
            "{t}: {} {expected}",
            outputs[0]
        );
    }
    assert!(moved > small, "it swings");
}

/// The same two elements on a turning table: a vehicle, or a wheel on a hinge whose moment of inertia is so large that
/// nothing here can change its speed.
fn on_table(wheel: bool, dimension: u32, [first, second]: [&str; 2]) -> String {
    let vector = |x: f64, y: f64, z: f64| match dimension {
        2 => format!("[{x}, {z}]"),
        _ => format!("[{x}, {y}, {z}]"),
    };
    let (inertia, axis, angles) = match dimension {
        2 => ("0.3", "y", "turn"),
        _ => ("[0.3, 0.25, 0.2]", "z", "[0, 0, turn]"),
    };
    let huge = if dimension == 2 {
        "1e14"
    } else {
        "[1e14, 1e14, 1e14]"
    };
    let (before, on, at, vehicle) = match wheel {
        true => (
            format!(
                "    reference: fixed\n    start: {{ joint_rates: {{ wheel: 5 }} }}\n    elements:\n      \
                 - {{ name: wheel, joint: {{ hinge: {axis} }}, mass: 1, cg: {}, inertia: {huge} }}\n",
                vector(0.0, 0.0, 0.0)
            ),
            "on: wheel, ",
            format!("at: {}, ", vector(0.4, -0.1, 0.2)),
            String::new(),
        ),
        false => (
            format!(
                "    reference: {{ on: table, at: {} }}\n    elements:\n",
                vector(0.4, -0.1, 0.2)
            ),
            "",
            String::new(),
            table(angles),
        ),
    };
    format!(
        "model: rider\ndimension: {dimension}\n{vehicle}systems:\n  - name: s\n{before}      \
         - {{ name: first, {on}{at}joint: {first}, mass: 2, cg: {}, inertia: {inertia} }}\n      \
         - {{ name: second, on: first, at: {}, joint: {second}, mass: 0.7, cg: {}, inertia: {inertia} }}\n\
         forces: [{{ field: gravity, acceleration: {} }}]\n\
         outputs:\n  - {{ name: x, of: s/second, what: position }}\n  - {{ name: z, of: s/second, what: position, component: z }}\n  \
         - {{ name: acceleration, of: s/second, what: acceleration, component: x }}\n  \
         - {{ name: force, of: joint s/first, what: force, component: z }}\n  \
         - {{ name: moment, of: joint s/first, what: moment, component: {} }}\n\
         run: {{ duration: 0.4 s, every: 0.02 s }}\n",
        vector(0.1, -0.05, 0.2),
        vector(0.2, 0.1, 0.4),
        vector(-0.1, 0.15, 0.3),
        vector(1.0, 2.0, -9.81),
        if dimension == 2 { "y" } else { "x" },
    )
    .replace("what: position }", "what: position, component: x }")
}

#[test]
fn a_turning_vehicle_carries_as_a_body_without_resistance() {
    let in_space = [
        ["{ hinge: y }", "ball"],
        ["{ hinge: [1, -2, 0.5], zero: 30 deg }", "{ hinge: x }"],
        ["{ slider: [0.3, 1, -1] }", "{ cylinder: z }"],
        ["{ screw: y, pitch: 0.4 }", "{ hinge: z }"],
        ["{ universal: [x, y] }", "{ slider: x }"],
        ["{ planar: y }", "weld"],
        ["free", "{ hinge: y }"],
        ["weld", "{ universal: [y, z] }"],
    ];
    let in_plane = [
        ["{ hinge: -y, zero: 0.3 }", "hinge"],
        ["{ slider: [1, 2] }", "{ hinge: y }"],
        ["{ planar: y }", "hinge"],
    ];
    let cases = in_space.map(|joints| (3, joints)).into_iter();
    for (dimension, joints) in cases.chain(in_plane.map(|joints| (2, joints))) {
        let [vehicle, wheel] = [false, true].map(|wheel| run(&on_table(wheel, dimension, joints)));
        let mut moved = 0.0f64;
        for ((t, a), (_, b)) in vehicle.iter().zip(&wheel) {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                // some hundred newton and metres per second squared; falls of a second amplify errors little
                let scale = if i < 2 { 1.0 } else { 1e3 };
                assert!(
                    (a - b).abs() <= 2.0 * bound(10.0) * scale,
                    "{joints:?}, output {i} at {t}: {a} {b}"
                );
            }
            moved = moved.max((a[0] - vehicle[0].1[0]).abs());
        }
        assert!(moved > 0.1, "{joints:?} moves");
    }
}
