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
