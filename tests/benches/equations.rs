//! Times of derivation and evaluation, with operation counts. `cargo bench` measures; `cargo test --bench equations`
//! does each once, to see that it works.

use bryant_generator::Config;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::read;

use bryant_generator::program;
use bryant_runtime::{Model, ParameterSet, Vector};
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

/// Number of measurements of each work, and the least time of one.
const MEASUREMENTS: usize = 25;
const LEAST: Duration = Duration::from_millis(20);

/// Repeats a work many times and prints its time: the median, and the quartiles.
fn time<T>(name: &str, mut work: impl FnMut() -> T) {
    let mut duration = |count: u64| {
        let start = Instant::now();
        for _ in 0..count {
            black_box(work());
        }
        start.elapsed()
    };
    if !std::env::args().any(|argument| argument == "--bench") {
        duration(1);
        println!("{name}: done");
        return;
    }
    let mut count = 1;
    while duration(count) < LEAST {
        count *= 2;
    }
    let mut times: Vec<f64> = (0..MEASUREMENTS)
        .map(|_| duration(count).as_secs_f64() / count as f64)
        .collect();
    times.sort_by(f64::total_cmp);
    let [low, middle, high] = [1, 2, 3].map(|quarter| 1e9 * times[MEASUREMENTS * quarter / 4]);
    println!("{name}: {middle:.1} ns ({low:.1} to {high:.1})");
}

fn model(path: &str) -> bryant_generator::model::Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    read(&path)
        .unwrap_or_else(|problems| panic!("{problems}"))
        .0
}

/// From YAML text to Rust text.
fn generation() {
    for (name, path) in [
        ("dummy15", "../models/dummy15.yaml"),
        ("child-seat", "../models/child-seat.yaml"),
    ] {
        time(&format!("generate {name}"), || {
            Config::new().matrices(false).source(&model(path)).len()
        });
    }
}

/// The state for the timing of a mechanism: it avoids the special values of the start, which may be faster to evaluate.
fn state<M: Model<f64>>(mechanism: &M) -> M::State {
    let mut y = mechanism.initial_state();
    for i in 0..M::State::LEN {
        y[i] += 0.1 * ((i * 7 % 11) as f64 - 5.0) / 5.0;
    }
    mechanism.normalize(&mut y);
    y
}

/// Accelerations alone, and the derivative of the state (accelerations and q̇), with the operation count of the
/// accelerations.
macro_rules! evaluation {
    ($name:literal, $path:literal, $($module:ident)::+) => {{
        use $($module)::+ as module;
        let model = model($path);
        let options = Options { matrices: false, ..Options::default() };
        let emitted = program::Options { matrices: false, ..program::Options::default() };
        for (method, table) in program::costs(&model, &derive_with(&model, options), &emitted) {
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
        time(concat!("accelerations of ", $name, ", f64"), || {
            mechanism.accelerations(black_box(0.0), black_box(&q), black_box(&v))
        });
        time(concat!("derivative of ", $name, ", f64"), || {
            mechanism.derivative(black_box(0.0), black_box(&y))
        });
    }};
}

fn evaluations() {
    evaluation!(
        "pendulum",
        "models/pendulum.yaml",
        bryant_tests::models::pendulum
    );
    evaluation!(
        "child-seat",
        "../models/child-seat.yaml",
        bryant_generated::child_seat
    );
    evaluation!(
        "dummy15",
        "../models/dummy15.yaml",
        bryant_generated::dummy15
    );
    evaluation!(
        "chain of 100",
        "models/large/chain100.yaml",
        bryant_tests::models::chain100
    );
}

fn main() {
    generation();
    evaluations();
}
