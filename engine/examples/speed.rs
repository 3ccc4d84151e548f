//! The time from YAML to the first evaluation of a model, and the time of each further evaluation, with and without
//! derivatives.
//!
//! `cargo run --release -p bryant-engine --example speed MODEL.yaml…`

use bryant_engine::Engine;
use bryant_generator::program::Method;
use bryant_generator::{Config, model};
use bryant_runtime::real::Array8;
use bryant_runtime::real::lanes::{OfAnyWidth, Width, with_width};
use bryant_runtime::{Dual, Dynamics, Real, Several};
use std::path::Path;
use std::time::{Duration, Instant};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for path in std::env::args().skip(1) {
        let start = Instant::now();
        let (model, _) = model::read(Path::new(&path))?;
        let read = start.elapsed();
        let lists = Config::new().matrices(false).lists(&model);
        let listed = start.elapsed();
        let operations = lists.list(Method::Derivative).operations.len();
        let engine = Engine::new(lists)?;
        let machine = engine.over::<f64>();
        let mut y = vec![0.0; machine.info().state_length()];
        machine.initial_state(&mut y);
        let mut rate = y.clone();
        machine.derivative(0.0, &y, &mut rate);
        let first = start.elapsed();
        println!(
            "{path}: {operations} operations; read {read:.1?}, lists {listed:.1?}, first rates {first:.1?}"
        );
        let interpreted = measure(&engine.interpreted::<f64>(), &y);
        let time = measure(&machine, &y);
        println!("  f64: {time:.3} µs, interpreted {interpreted:.3} µs");
        derivatives(&engine, &y);
        for width in Width::ALL {
            let time = with_width(width, Rates(&engine));
            if let Some([time, interpreted]) = time {
                println!(
                    "  lanes of width {}: {time:.3} µs for all lanes, interpreted {interpreted:.3} µs",
                    width.name()
                );
            }
        }
    }
    Ok(())
}

/// Times of evaluations with derivatives, at one state.
fn derivatives(engine: &Engine, y: &[f64]) {
    let one = y.iter().map(|value| Dual::variable(*value));
    let one: Vec<Dual<f64>> = one.collect();
    let eight = y.iter().map(|value| Dual {
        value: Array8([*value; 8]),
        slope: Array8(std::array::from_fn(|lane| lane as f64)),
    });
    let eight: Vec<Dual<Array8>> = eight.collect();
    let start = Instant::now();
    let machine = engine.over::<Dual<Array8>>();
    let mut rate = eight.clone();
    machine.derivative(Dual::from_f64(0.0), &eight, &mut rate);
    let first = start.elapsed();
    println!(
        "  with a slope: {:.3} µs, interpreted {:.3} µs; with eight: {:.3} µs, interpreted {:.3} µs, the first {first:.1?}",
        measure(&engine.over::<Dual<f64>>(), &one),
        measure(&engine.interpreted::<Dual<f64>>(), &one),
        measure(&machine, &eight),
        measure(&engine.interpreted::<Dual<Array8>>(), &eight),
    );
    let machine = engine.over::<f64>();
    let mut by_state = vec![0.0; y.len() * y.len()];
    let mut by_time = vec![0.0; y.len()];
    let jacobian = least_of(5, || {
        machine.jacobian(0.01, std::hint::black_box(y), &mut by_state, &mut by_time);
    });
    println!(
        "  Jacobian, {} columns: {jacobian:.1} µs",
        1 + machine.info().varying_length()
    );
}

/// The evaluation rates of one engine over lanes.
struct Rates<'a>(&'a Engine);

impl OfAnyWidth for Rates<'_> {
    type Output = [f64; 2];
    fn run<T: Several<One = f64>>(self) -> [f64; 2] {
        let machine = self.0.over::<T>();
        let mut y = vec![T::from_f64(0.0); machine.info().state_length()];
        machine.initial_state(&mut y);
        [
            measure(&machine, &y),
            measure(&self.0.interpreted::<T>(), &y),
        ]
    }
}

/// The least time of an evaluation \[µs\].
fn measure<T: Real>(machine: &impl Dynamics<T>, y: &[T]) -> f64 {
    let mut rate = y.to_vec();
    least_of(20, || {
        machine.derivative(T::from_f64(0.01), std::hint::black_box(y), &mut rate);
        std::hint::black_box(&rate);
    })
}

/// The least time of one call, from `times` calls in a row \[µs\].
fn least_of(times: u32, mut task: impl FnMut()) -> f64 {
    let mut least = Duration::MAX;
    for _ in 0..200 {
        let start = Instant::now();
        for _ in 0..times {
            task();
        }
        least = least.min(start.elapsed() / times);
    }
    least.as_secs_f64() * 1e6
}
