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

/// Ellipsoids that push each other or the ground, with outputs that need the nearest points of bodies that are apart.
const PUSHES: [&str; 3] = [
    // two stones in space, with friction
    "model: stones
dimension: 3
systems:
  - name: flint
    elements: [{ name: body, mass: 2 kg, cg: [0.01, 0, -0.02], inertia: [0.02, 0.03, 0.025] }]
    start: { position: [-0.15, 0.02, 0.01], velocity: [1, 0.1, 0], angles: { body: [20 deg, 30 deg, 10 deg] }, rates: { body: [1, -3, 2] } }
  - name: basalt
    elements: [{ name: body, mass: 3 kg, cg: [0, 0.01, 0], inertia: [0.05, 0.04, 0.03] }]
    start: { angles: { body: [-50 deg, 10 deg, 70 deg] }, rates: { body: [0.5, 1, 0] } }
forces:
  - contact: hit
    ellipsoid: { on: flint/body, center: [0.02, -0.01, 0.01], semi_axes: [0.12, 0.07, 0.09], axes: [10 deg, 40 deg, -20 deg] }
    with: { on: basalt/body, center: [0, 0.02, 0], semi_axes: [0.15, 0.08, 0.1] }
    elastic: { points: [[0, 0], [1 cm, 100], [2 cm, 1000]], extrapolate: linear }
    damping: 20 N*s/m
    friction: 0.4
    friction_speed: 0.5 m/s
outputs:
  - { name: hit, of: contact hit, what: penetration }
  - { name: force, of: contact hit, what: force }
run: { duration: 0.4 s, every: 1 ms }
",
    // two ellipses in the plane
    "model: ellipses
dimension: 2
systems:
  - name: left
    elements: [{ name: body, mass: 1 kg, cg: [0.01, 0.02], inertia: 0.005 }]
    start: { position: [0, 0], velocity: [0.6, 0.8], rates: { body: 3 } }
  - name: right
    elements: [{ name: body, mass: 3 kg, cg: [0, 0], inertia: 0.02 }]
    start: { position: [0.3, 0.15], angles: { body: 0.4 }, velocity: [-0.6, -0.8] }
forces:
  - contact: hit
    ellipsoid: { on: left/body, center: [0.02, 0], semi_axes: [0.2, 0.1], axes: 10 deg }
    with: { on: right/body, center: [0, 0.01], semi_axes: [0.25, 0.15], axes: -30 deg }
    elastic: { points: [[0, 0], [1, 1e3]], extrapolate: linear }
    damping: 20 N*s/m
    friction: 0.4
    friction_speed: 0.5 m/s
outputs:
  - { name: hit, of: contact hit, what: penetration }
  - { name: force, of: contact hit, what: force }
run: { duration: 0.4 s, every: 1 ms }
",
    // a rounded box on the ground
    "model: rounded
dimension: 3
systems:
  - name: chest
    elements: [{ name: body, mass: 2 kg, cg: [0, 0, 0], inertia: [0.02, 0.03, 0.025] }]
    start: { position: [0.3, 0, 0.1], velocity: [-1, 0.2, 0], angles: { body: [20 deg, 30 deg, 10 deg] }, rates: { body: [1, -3, 2] } }
forces:
  - contact: floor
    ellipsoid: { on: chest/body, center: [0.01, 0, 0], semi_axes: [0.15, 0.1, 0.12], axes: [10 deg, 0, 5 deg], degree: 4 }
    plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }
    elastic: { points: [[0, 0], [1, 2e3]], extrapolate: linear }
    damping: 20 N*s/m
    friction: 0.4
    friction_speed: 0.5 m/s
outputs:
  - { name: floor, of: contact floor, what: penetration }
  - { name: force, of: contact floor, what: force }
run: { duration: 1 s, every: 2 ms }
",
];

/// A body that touches and one that does not are both met, and both are differentiated.
#[test]
fn pushes_of_ellipsoids_are_differentiated_as_by_dual_numbers() {
    for text in PUSHES {
        let model = read(text);
        let engine = engine(&model, &["linearisation".to_owned()]);
        let info = engine.info();
        let (nq, n) = (info.coordinates.len(), info.velocities.len());
        let (machine, duals) = (engine.over::<f64>(), engine.over::<Dual<f64>>());
        let mut random = Random::new(7);
        let mut touching = [0; 2];
        for _ in 0..60 {
            let mut y = vec![0.0; info.state_length()];
            machine.initial_state(&mut y);
            for y in &mut y {
                *y += random.uniform(-0.1, 0.1);
            }
            machine.normalize(&mut y);
            let linear = values(&engine, &machine, "linearisation", (0.0, &y), &vec![0.0; n]);
            let mut outputs = vec![0.0; info.outputs.len()];
            machine.outputs(0.0, &y, &mut outputs);
            touching[usize::from(outputs[0] > 0.0)] += 1;
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
                let expected = rates[nq..nq + n].iter().chain(&outputs);
                for (i, expected) in expected.enumerate() {
                    let found = linear[(n + i) * 2 * n + column];
                    // slopes up to 1e5, by two formulas; curvatures of bodies magnify rounding up to 1e2 times
                    let error = (found - expected.slope).abs() / (1.0 + expected.slope.abs());
                    assert!(
                        error < 1e-8,
                        "row {i}, column {column}: {found}, {}\n{text}",
                        expected.slope
                    );
                }
            }
        }
        assert!(touching.iter().all(|count| *count > 5), "{touching:?}");
    }
}
