//! Time of deriving and of evaluating, with operation counts beside it.

use bryant_generator::Config;
use bryant_generator::equations::Route;
use bryant_generator::expression::count::Count;
use bryant_generator::formalism::{Options, derive_with};
use bryant_generator::model::read;
use bryant_runtime::{Model, ParameterSet, Vector};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;

fn model(path: &str) -> bryant_generator::model::Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    read(&path)
        .unwrap_or_else(|problems| panic!("{problems}"))
        .0
}

/// From YAML text to Rust text.
fn generation(c: &mut Criterion) {
    for (name, path) in [
        ("dummy15", "../models/dummy15.yaml"),
        ("child-seat", "../models/child-seat.yaml"),
    ] {
        c.bench_function(&format!("generate {name}"), |b| {
            b.iter(|| Config::new().matrices(false).source(&model(path)).len());
        });
    }
}

fn evaluation<M: Model<f64>>(c: &mut Criterion, name: &str, path: &str) {
    let options = Options {
        matrices: false,
        route: Some(Route::Elimination),
    };
    let equations = derive_with(&model(path), options);
    println!(
        "accelerations of {name}: {}",
        Count::of(&equations.graph, &equations.accelerations)
    );
    let mechanism = M::new(M::Parameters::defaults());
    let mut y = mechanism.initial_state();
    // off the special values of the start, where the processor might be faster
    for i in 0..M::State::LEN {
        y[i] += 0.1 * ((i * 7 % 11) as f64 - 5.0) / 5.0;
    }
    mechanism.normalize(&mut y);
    c.bench_function(&format!("derivative of {name}, f64"), |b| {
        b.iter(|| mechanism.derivative(black_box(0.0), black_box(&y)));
    });
}

fn evaluations(c: &mut Criterion) {
    use bryant_generated as bundled;
    use bryant_tests::models;
    evaluation::<models::pendulum::Mechanism<f64>>(c, "pendulum", "models/pendulum.yaml");
    evaluation::<bundled::child_seat::Mechanism<f64>>(c, "child-seat", "../models/child-seat.yaml");
    evaluation::<bundled::dummy15::Mechanism<f64>>(c, "dummy15", "../models/dummy15.yaml");
    evaluation::<models::chain100::Mechanism<f64>>(c, "chain of 100", "models/large/chain100.yaml");
}

criterion_group!(benches, generation, evaluations);
criterion_main!(benches);
