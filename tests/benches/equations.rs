//! Time of deriving and of evaluating, with operation counts beside it.

use bryant_generator::Config;
use bryant_generator::emit;
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

/// The state that a mechanism is timed at: off the special values of the start, where the processor might be faster.
fn state<M: Model<f64>>(mechanism: &M) -> M::State {
    let mut y = mechanism.initial_state();
    for i in 0..M::State::LEN {
        y[i] += 0.1 * ((i * 7 % 11) as f64 - 5.0) / 5.0;
    }
    mechanism.normalize(&mut y);
    y
}

/// Accelerations alone, and the derivative of the state (accelerations and q̇), with the operations of the former.
macro_rules! evaluation {
    ($c:expr, $name:literal, $path:literal, $($module:ident)::+) => {{
        use $($module)::+ as module;
        let model = model($path);
        let options = Options { matrices: false, ..Options::default() };
        let emitted = emit::Options { matrices: false, ..emit::Options::default() };
        for (method, table) in emit::costs(&model, &derive_with(&model, options), &emitted) {
            if method == "accelerations" {
                println!("accelerations of {}: {}", $name, table.total);
            }
        }
        let mechanism = module::Mechanism::<f64>::new(module::Parameters::defaults());
        let y = state(&mechanism);
        let mut q = [0.0; module::COORDINATES];
        let mut v = [0.0; module::VELOCITIES];
        q.copy_from_slice(&y[..module::COORDINATES]);
        v.copy_from_slice(&y[module::COORDINATES..]);
        $c.bench_function(concat!("accelerations of ", $name, ", f64"), |b| {
            b.iter(|| mechanism.accelerations(black_box(0.0), black_box(&q), black_box(&v)));
        });
        $c.bench_function(concat!("derivative of ", $name, ", f64"), |b| {
            b.iter(|| mechanism.derivative(black_box(0.0), black_box(&y)));
        });
    }};
}

fn evaluations(c: &mut Criterion) {
    evaluation!(
        c,
        "pendulum",
        "models/pendulum.yaml",
        bryant_tests::models::pendulum
    );
    evaluation!(
        c,
        "child-seat",
        "../models/child-seat.yaml",
        bryant_generated::child_seat
    );
    evaluation!(
        c,
        "dummy15",
        "../models/dummy15.yaml",
        bryant_generated::dummy15
    );
    evaluation!(
        c,
        "chain of 100",
        "models/large/chain100.yaml",
        bryant_tests::models::chain100
    );
}

criterion_group!(benches, generation, evaluations);
criterion_main!(benches);
