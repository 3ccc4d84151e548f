//! Generated Rust and machine code.

use super::common::{Bits, InLanes, Single, check, compare, engine};
use bryant_engine::Engine;
use bryant_generated::{MODELS, sled_pendulum};
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{Dynamics, Several, Width};

#[test]
fn generated_rust_of_every_bundled_model_has_the_bits_of_machine_code() {
    assert!(!MODELS.is_empty());
    for bundled in MODELS {
        let name = bundled.entry.info.name;
        let made = || bundled.entry.model(&[]).expect("no parameters are given");
        let engine = engine(name, true);
        compare::<f64, Single>(&mut *made(), &mut Engine::over::<f64>(&engine));
        // starts again from the default parameters
        compare::<f64, Single>(&mut *made(), &mut engine.interpreted::<f64>());
        jacobian(name, &*made(), &Engine::over::<f64>(&engine));
    }
}

/// Compares the Jacobians at the start.
fn jacobian(name: &str, expected: &dyn Dynamics<f64>, found: &dyn Dynamics<f64>) {
    let length = expected.info().state_length();
    let mut y = vec![0.0; length];
    found.initial_state(&mut y);
    let mut both = [(); 2].map(|()| (vec![0.5; length * length], vec![0.5; length]));
    for (model, (by_state, by_time)) in [expected, found].into_iter().zip(&mut both) {
        assert!(model.jacobian(0.05, &y, by_state, by_time));
    }
    let bits = |values: &[f64]| values.iter().map(Bits::bits).collect::<Vec<_>>();
    assert_eq!(bits(&both[0].0), bits(&both[1].0), "{name}");
    assert_eq!(bits(&both[0].1), bits(&both[1].1), "{name}");
}

/// Compares one model over lanes.
struct OfLanes;

impl OfAnyWidth for OfLanes {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        check::<sled_pendulum::Mechanism<f64>, T, InLanes>("sled-pendulum");
    }
}

#[test]
fn generated_rust_over_lanes_has_the_bits_of_machine_code() {
    with_width(Width::widest(), OfLanes).expect("registers of the widest kind");
}
