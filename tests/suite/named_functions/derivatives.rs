//! The derivatives that are asked for by name are those of dual numbers, and a law that has none is named.

use super::{engine, values};
use bryant_generator::Config;
use bryant_runtime::{Dual, Dynamics};
use bryant_tests::trees::Random;
use std::path::Path;

fn model(file: &str) -> bryant_generator::model::Model {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    bryant_generator::read(&file).expect("a model").0
}

fn read(text: &str) -> bryant_generator::model::Model {
    let nothing = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    bryant_generator::read_str("scene.yaml", text, &nothing)
        .expect("a model")
        .0
}

/// The machine has a free base, whose columns are turns, hinges and a slider.
#[test]
fn derivatives_along_motions_are_those_of_dual_numbers() {
    let names = [
        "inverse_dynamics",
        "inverse_dynamics_derivatives",
        "acceleration_derivatives",
        "linearisation",
    ];
    let engine = engine(
        &model("models/functions/machine.yaml"),
        &names.map(String::from),
    );
    let info = engine.info();
    let (nq, n) = (info.coordinates.len(), info.velocities.len());
    let (machine, duals) = (engine.over::<f64>(), engine.over::<Dual<f64>>());
    let mut random = Random::new(5);
    let mut y = vec![0.0; info.state_length()];
    machine.initial_state(&mut y);
    y.iter_mut().for_each(|y| *y += random.uniform(-0.5, 0.5));
    machine.normalize(&mut y);
    let a: Vec<f64> = (0..n).map(|_| random.uniform(-3.0, 3.0)).collect();
    let of = |name: &str| values(&engine, &machine, name, (0.0, &y), &a);
    let (torques, free, linear) = (of(names[1]), of(names[2]), of(names[3]));
    let mut rate = vec![0.0; y.len()];
    machine.derivative(0.0, &y, &mut rate);
    let near = |found: f64, expected: f64| {
        // sums of some hundred terms up to some hundred
        assert!((found - expected).abs() < 1e-9, "{found}, {expected}");
    };
    let constant = |values: &[f64]| {
        values
            .iter()
            .map(|v| Dual::constant(*v))
            .collect::<Vec<_>>()
    };
    for j in 0..n {
        near(free[j * (3 * n + 1)], rate[nq + j]);
        let mut unit = y.clone();
        unit[nq..].fill(0.0);
        unit[nq + j] = 1.0;
        let mut along = vec![0.0; y.len()];
        machine.coordinate_rates(&unit, &mut along);
        let mut by = vec![0.0; y.len()];
        by[nq + j] = 1.0;
        for (slopes, column) in [(&along, j), (&by, n + j)] {
            let mut state = constant(&y);
            for (entry, slope) in state.iter_mut().zip(slopes) {
                entry.slope = *slope;
            }
            let at = (Dual::constant(0.0), &state[..]);
            let found = values(&engine, &duals, names[0], at, &constant(&a));
            let mut rates = constant(&y);
            duals.derivative(at.0, at.1, &mut rates);
            for i in 0..n {
                near(torques[i * 2 * n + column], found[i].slope);
                near(linear[(n + i) * 2 * n + column], rates[nq + i].slope);
            }
        }
    }
}

#[test]
fn a_law_without_derivatives_is_named_with_a_remedy() {
    let mut config = Config::new();
    config.functions(["linearisation", "inverse_dynamics_derivatives"]);
    let found = config.requests(&model("../models/skydiver.yaml"), "skydiver.yaml");
    let problems = found
        .expect_err("a force is a function of the user")
        .to_string();
    assert!(
        problems.contains("linearisation is not possible"),
        "{problems}"
    );
    assert!(problems.contains("dual numbers"), "{problems}");
    assert_eq!(problems.matches("is not possible").count(), 1, "{problems}");
}

/// A rounded box that lies flat on the ground: two components of the direction in which it reaches farthest are 0.
const FLAT: &str = "model: flat
dimension: 3
systems:
  - name: chest
    elements: [{ name: body, mass: 2 kg, cg: [0, 0, 0], inertia: [0.02, 0.03, 0.025] }]
    start: { position: [0, 0, 0.11], velocity: [0.3, 0.2, -0.1], rates: { body: [1, -3, 2] } }
forces:
  - contact: floor
    ellipsoid: { on: chest/body, center: [0, 0, 0], semi_axes: [0.15, 0.1, 0.12], degree: 4 }
    plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }
    elastic: { points: [[0, 0], [1, 2e3]], extrapolate: linear }
    friction: 0.4
outputs: [{ name: floor, of: contact floor, what: penetration }]
run: { duration: 1 s, every: 2 ms }
";

/// Compares the linearisation with dual numbers at states that differ from the start by up to `change`; returns the
/// number of states in which the output `touch` is above 0, and of all others.
fn compared(model: &bryant_generator::model::Model, touch: &str, change: f64) -> [u32; 2] {
    let engine = engine(model, &["linearisation".to_owned()]);
    let across = engine.functions()[0].columns.len();
    let info = engine.info();
    let touch = info.outputs.iter().position(|of| of.name == touch).unwrap();
    let (nq, n) = (info.coordinates.len(), info.velocities.len());
    let (machine, duals) = (engine.over::<f64>(), engine.over::<Dual<f64>>());
    let mut random = Random::new(7);
    let mut touching = [0; 2];
    for _ in 0..200 {
        let mut y = vec![0.0; info.state_length()];
        machine.initial_state(&mut y);
        for y in &mut y[..nq + n] {
            *y += random.uniform(-change, change);
        }
        machine.normalize(&mut y);
        let linear = values(&engine, &machine, "linearisation", (0.0, &y), &vec![0.0; n]);
        let mut outputs = vec![0.0; info.outputs.len()];
        machine.outputs(0.0, &y, &mut outputs);
        touching[usize::from(outputs[touch] <= 0.0)] += 1;
        for column in 0..2 * n {
            let mut unit = y.clone();
            unit[nq..].fill(0.0);
            unit[nq + column % n] = 1.0;
            let mut along = vec![0.0; y.len()];
            match column < n {
                true => machine.coordinate_rates(&unit, &mut along),
                false => along[nq + column - n] = 1.0,
            }
            let entries = y.iter().zip(&along);
            let state: Vec<Dual<f64>> = entries
                .map(|(&value, &slope)| Dual { value, slope })
                .collect();
            let mut rates = vec![Dual::constant(0.0); y.len()];
            duals.derivative(Dual::constant(0.0), &state, &mut rates);
            let mut outputs = vec![Dual::constant(0.0); info.outputs.len()];
            duals.outputs(Dual::constant(0.0), &state, &mut outputs);
            // v̇ and ż, then the outputs
            let rates = &rates[nq..nq + n + info.auxiliaries.len()];
            for (i, expected) in rates.iter().chain(&outputs).enumerate() {
                let found = linear[(n + i) * across + column];
                // two formulas; the curvatures of bodies magnify rounding
                let error = (found - expected.slope).abs() / (1.0 + expected.slope.abs());
                let name = &info.name;
                assert!(
                    error < 1e-8,
                    "{name}: row {i}, column {column}: {found}, {}",
                    expected.slope
                );
            }
        }
    }
    touching
}

/// Stones in space with friction, ellipses in the plane, a rounded box: apart and touching.
#[test]
fn pushes_of_ellipsoids_are_differentiated_as_by_dual_numbers() {
    for (file, touch, change) in [
        ("stones", "hit", 0.3),
        ("discs", "planet", 0.1),
        ("chest-drop", "floor", 0.4),
    ] {
        let model = model(&format!("models/{file}.yaml"));
        let touching = compared(&model, touch, change);
        assert!(
            touching.iter().all(|count| *count > 5),
            "{file}: {touching:?}"
        );
    }
    assert_eq!(compared(&read(FLAT), "floor", 0.0), [200, 0]);
}
