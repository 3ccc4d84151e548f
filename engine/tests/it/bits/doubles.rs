//! Over doubles, every method of every bundled model has the bits of the generated Rust.

use super::common::{self, Bits, Single, engine};
use bryant_engine::Engine;
use bryant_runtime::{Differentiable, Dynamics, Model, ParameterSet};

/// Compares all methods of one model, and its Jacobian where it starts.
fn check<M: Model<f64>>(name: &str) {
    common::check::<M, f64, Single>(name);
    let engine = engine(name, true);
    let model = M::new(M::Parameters::defaults());
    let (expected, found) = (Differentiable(&model), Engine::over::<f64>(&engine));
    let length = M::INFO.state_length();
    let mut y = vec![0.0; length];
    found.initial_state(&mut y);
    let mut both = [(); 2].map(|()| (vec![0.5; length * length], vec![0.5; length]));
    let models: [&dyn Dynamics<f64>; 2] = [&expected, &found];
    for (model, (by_state, by_time)) in models.into_iter().zip(&mut both) {
        assert!(model.jacobian(0.05, &y, by_state, by_time));
    }
    let bits = |values: &[f64]| values.iter().map(Bits::bits).collect::<Vec<_>>();
    assert_eq!(bits(&both[0].0), bits(&both[1].0), "{name}");
    assert_eq!(bits(&both[0].1), bits(&both[1].1), "{name}");
}

models!(check);
