//! The derivative of the state by the engine's machine code and by the generated Rust that rustc compiled: for one
//! state and for eight lanes.
//!
//! `cd benches/beside-rustc && cargo run --release`. Both take turns, so that a disturbance of the processor slows
//! both; the table has medians. The states are near those at the start, with small random changes, and the results of
//! both have the same bits.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{
    Dynamics, Model, ParameterSet, Real, Several, StateKind, Task, Vector, Width,
};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// A model over any scalar.
trait Compiled {
    type Over<T: Real>: Model<T>;
}

macro_rules! models {
    ($($module:ident $name:literal $path:literal;)*) => {
        $(
            mod $module {
                bryant_runtime::include_model!($name);
                pub struct Rustc;
                impl super::Compiled for Rustc {
                    type Over<T: bryant_runtime::Real> = Mechanism<T>;
                }
            }
        )*

        fn main() {
            println!("| model | one state: rustc | engine | ratio | eight lanes: rustc | engine | ratio |");
            println!("|---|---:|---:|---:|---:|---:|---:|");
            $(compare::<$module::Rustc>($name, $path);)*
        }
    };
}

models! {
    child_seat "child-seat" "../../models/child-seat.yaml";
    dummy15 "dummy15" "../../models/dummy15.yaml";
    chain100 "chain100" "../../tests/models/large/chain100.yaml";
    occupant "occupant" "../scenes/occupant.yaml";
    pedestrian "pedestrian" "../scenes/pedestrian.yaml";
}

/// One evaluation by the code of rustc, compiled for the instructions of the scalar.
struct Derivative<'a, T: Real, M: Model<T>> {
    model: &'a M,
    y: &'a M::State,
    rate: &'a mut M::State,
}

impl<T: Real, M: Model<T>> Task for Derivative<'_, T, M> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.model.each_rate(T::from_f64(TIME), self.y, self.rate);
    }
}

/// The time of the evaluation \[s\].
const TIME: f64 = 0.01;
/// Number of measurements, and number of evaluations in each.
const ROUNDS: usize = 301;
const REPETITIONS: u32 = 20;

/// A line of the table.
fn compare<C: Compiled>(name: &str, path: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let (model, _) = bryant_generator::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let lists = Config::new().matrices(false).lists(&model);
    let engine = Engine::new(lists).unwrap_or_else(|e| panic!("{e}"));
    let one = times::<C, f64>(&engine);
    let eight = with_width(
        Width::Eight,
        InLanes::<C>(&engine, std::marker::PhantomData),
    );
    let columns = |[rustc, engine]: [f64; 2]| {
        format!("{rustc:.3} µs | {engine:.3} µs | {:.2}", engine / rustc)
    };
    let eight = eight.map_or("– | – | –".to_owned(), columns);
    println!("| {name} | {} | {eight} |", columns(one));
}

struct InLanes<'a, C>(&'a Engine, std::marker::PhantomData<C>);

impl<C: Compiled> OfAnyWidth for InLanes<'_, C> {
    type Output = [f64; 2];
    fn run<T: Several<One = f64>>(self) -> [f64; 2] {
        times::<C, T>(self.0)
    }
}

/// The medians of rustc and of the engine \[µs\].
fn times<C: Compiled, T: Real>(engine: &Engine) -> [f64; 2] {
    let model = C::Over::<T>::new(ParameterSet::defaults());
    let machine = engine.over::<T>();
    let mut y = model.initial_state();
    let mut seed = 1_u64;
    for (entry, kind) in y.as_mut().iter_mut().zip(engine.info().kinds) {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let random = (seed >> 40) as f64 / f64::from(1 << 24) - 0.5;
        if *kind != StateKind::Memory {
            *entry += T::from_f64(0.01 * random);
        }
    }
    let zeros = || <C::Over<T> as Model<T>>::State::splat(T::from_f64(0.0));
    let (mut by_rustc, mut by_engine) = (zeros(), zeros());
    let mut took = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        took[0].push(measured(|| {
            let (y, rate) = (black_box(&y), &mut by_rustc);
            T::dispatch_apart(Derivative {
                model: &model,
                y,
                rate,
            });
        }));
        took[1].push(measured(|| {
            let y = black_box(&y).as_ref();
            machine.derivative(T::from_f64(TIME), y, by_engine.as_mut());
        }));
    }
    assert!(by_rustc.as_ref() == by_engine.as_ref(), "other rates");
    took.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}

/// The time of one evaluation, from several in a row \[µs\].
fn measured(mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    for _ in 0..REPETITIONS {
        work();
    }
    1e6 * start.elapsed().as_secs_f64() / f64::from(REPETITIONS)
}
