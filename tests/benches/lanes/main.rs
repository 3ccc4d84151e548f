//! The cost of evaluations and runs over one double and over wide registers, in three tables.
//!
//! 1. The time of one derivative of the state for each state, and its share of the processor's peak of fused
//!    multiply-adds: share = operations · lanes / (time · peak). A fused multiply-add counts as two operations, and the
//!    peak is that of twelve independent chains of them in registers of the same width. Sums and products that are not
//!    fused keep the share below 1. All models and the peaks take turns, [`ROUNDS`] times, so that a disturbance of the
//!    processor slows all of them down; the table has medians.
//! 2. The compile time of the module, and the length of its machine code.
//! 3. The number of runs of child-seat in a second, as in a study.
//!
//! `cargo bench -p bryant-tests --bench lanes`; words behind `--` choose tables: evaluations, compilation, runs.

mod compilation;
mod machine_code;
mod runs;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::read;

use bryant_generator::program;
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{Model, ParameterSet, Real, Several, Task, Vector, Width};
use std::hint::black_box;
use std::marker::PhantomData;
use std::path::Path;
use std::time::Instant;

mod chain5 {
    bryant_runtime::include_model!("chain5");
}
mod chain30 {
    bryant_runtime::include_model!("chain30");
}

/// A model over any scalar.
trait ModelFamily {
    type Over<T: Real>: Model<T>;
}

macro_rules! scenes {
    ($($scene:ident: $($module:ident)::+,)*) => {$(
        struct $scene;
        impl ModelFamily for $scene {
            type Over<T: Real> = $($module)::+::Mechanism<T>;
        }
    )*};
}

scenes! {
    Pendulum: bryant_tests::models::pendulum,
    ChildSeat: bryant_generated::child_seat,
    Dummy15: bryant_generated::dummy15,
    Chain5: chain5,
    Chain30: chain30,
    Chain100: bryant_tests::models::chain100,
}

/// One evaluation.
struct Derivative<'a, T: Real, M: Model<T>> {
    model: &'a M,
    t: T,
    y: &'a M::State,
    rate: &'a mut M::State,
}

impl<T: Real, M: Model<T>> Task for Derivative<'_, T, M> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.model.each_rate(self.t, self.y, self.rate);
    }
}

/// Number of repetitions of every measurement.
const ROUNDS: usize = 9;

/// The median of at least one value; the upper one of two.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The median of five measurements of about a millisecond each \[s\].
fn measured(mut work: impl FnMut()) -> f64 {
    let mut measure = |repetitions: u32| {
        let start = Instant::now();
        for _ in 0..repetitions {
            work();
        }
        start.elapsed().as_secs_f64() / f64::from(repetitions)
    };
    let once = measure(100);
    let repetitions = (1e-3 / once).clamp(10.0, 1e6) as u32;
    median((0..5).map(|_| measure(repetitions)).collect())
}

/// Time of one evaluation \[s\], at a state that avoids the special values of the start, which may be faster to
/// evaluate.
fn time<T: Real, M: Model<T>>() -> f64 {
    let model = M::new(M::Parameters::defaults());
    let mut y = model.initial_state();
    for i in 0..M::State::LEN {
        y[i] += T::from_f64(0.1 * ((i * 7 % 11) as f64 - 5.0) / 5.0);
    }
    model.normalize(&mut y);
    let t = T::from_f64(0.0);
    let mut rate = y;
    measured(|| {
        let (model, y) = (black_box(&model), black_box(&y));
        let rate = black_box(&mut rate);
        T::dispatch(Derivative { model, t, y, rate });
    })
}

/// Time for one state \[s\].
struct PerState<S>(PhantomData<S>);

impl<S: ModelFamily> OfAnyWidth for PerState<S> {
    type Output = f64;

    fn run<T: Several<One = f64>>(self) -> f64 {
        time::<T, S::Over<T>>() / T::LANES as f64
    }
}

/// Number of independent chains of fused multiply-adds: their latency of four cycles times two in a cycle, with some
/// reserve.
const CHAINS: usize = 12;
const LENGTH: usize = 1000;

struct Chains<T>(T);

impl<T: Real> Task for Chains<T> {
    type Output = T;

    #[inline(always)]
    fn run(self) -> T {
        let mut chains = [self.0; CHAINS];
        let (factor, addend) = (T::from_f64(0.999), T::from_f64(0.001));
        for _ in 0..LENGTH {
            for value in &mut chains {
                *value = value.mul_add(factor, addend);
            }
        }
        chains.into_iter().fold(self.0, |sum, value| sum + value)
    }
}

/// Operations per second of one core in registers of a width.
struct Peak;

impl OfAnyWidth for Peak {
    type Output = f64;

    fn run<T: Several<One = f64>>(self) -> f64 {
        let time = measured(|| {
            black_box(T::dispatch(Chains(black_box(T::from_f64(1.0)))));
        });
        (2 * CHAINS * LENGTH * T::LANES) as f64 / time
    }
}

/// Operations of a derivative of the state.
fn operations(path: &str) -> usize {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let (model, _) = read(&path).unwrap_or_else(|problems| panic!("{problems}"));
    let options = Options {
        matrices: false,
        ..Options::default()
    };
    let emitted = program::Options {
        matrices: false,
        ..program::Options::default()
    };
    let costs = program::costs(&model, &derive_with(&model, options), &emitted);
    let part = ["accelerations", "coordinate_rates"];
    let parts = costs.iter().filter(|(method, _)| part.contains(&&**method));
    parts.map(|(_, table)| table.total.total()).sum()
}

/// A model of the tables.
struct Entry {
    name: &'static str,
    path: &'static str,
    elements: usize,
    /// Time for one state over a register of a width, or over `f64` \[s\].
    time: fn(Option<Width>) -> Option<f64>,
}

const MODELS: [Entry; 6] = [
    Entry {
        name: "pendulum",
        path: "models/pendulum.yaml",
        elements: 1,
        time: time_of::<Pendulum>,
    },
    Entry {
        name: "child-seat",
        path: "../models/child-seat.yaml",
        elements: 7,
        time: time_of::<ChildSeat>,
    },
    Entry {
        name: "dummy15",
        path: "../models/dummy15.yaml",
        elements: 15,
        time: time_of::<Dummy15>,
    },
    Entry {
        name: "chain of 5",
        path: "models/chains/chain5.yaml",
        elements: 5,
        time: time_of::<Chain5>,
    },
    Entry {
        name: "chain of 30",
        path: "models/chains/chain30.yaml",
        elements: 30,
        time: time_of::<Chain30>,
    },
    Entry {
        name: "chain of 100",
        path: "models/large/chain100.yaml",
        elements: 100,
        time: time_of::<Chain100>,
    },
];

fn time_of<S: ModelFamily>(width: Option<Width>) -> Option<f64> {
    match width {
        Some(width) => with_width(width, PerState::<S>(PhantomData)),
        None => Some(time::<f64, S::Over<f64>>()),
    }
}

/// The widths of this processor's registers.
fn widths() -> impl Iterator<Item = Width> {
    Width::ALL.into_iter().filter(|width| width.is_available())
}

fn evaluations() {
    let widths: Vec<Width> = widths().collect();
    let ways: Vec<Option<Width>> = std::iter::once(None)
        .chain(widths.iter().copied().map(Some))
        .collect();
    let mut peaks = vec![Vec::new(); widths.len()];
    let mut times = vec![vec![Vec::new(); ways.len()]; MODELS.len()];
    for round in 1..=ROUNDS {
        eprint!("\rround {round} of {ROUNDS}");
        for (peaks, &width) in peaks.iter_mut().zip(&widths) {
            peaks.extend(with_width(width, Peak));
        }
        for (times, entry) in times.iter_mut().zip(&MODELS) {
            for (times, &way) in times.iter_mut().zip(&ways) {
                times.extend((entry.time)(way));
            }
        }
    }
    eprintln!();
    let peaks: Vec<f64> = peaks.into_iter().map(median).collect();
    println!("## Derivatives of the state\n");
    println!("Nanoseconds per state (per element, share of the peak of fused multiply-adds).\n");
    print!("| model | operations | f64, not fused");
    for (width, peak) in widths.iter().zip(&peaks) {
        print!(" | lanes {}, peak {:.0} GFLOP/s", width.name(), 1e-9 * peak);
    }
    println!(" |\n|{}", "---|".repeat(3 + widths.len()));
    for (entry, times) in MODELS.iter().zip(times) {
        let operations = operations(entry.path);
        let times: Vec<f64> = times.into_iter().map(median).collect();
        print!("| {} | {operations} | {:.0}", entry.name, 1e9 * times[0]);
        for (time, peak) in times[1..].iter().zip(&peaks) {
            let share = operations as f64 / (time * peak);
            let element = 1e9 * time / entry.elements as f64;
            print!(
                " | {:.1} ({element:.1}, {:.0} %)",
                1e9 * time,
                100.0 * share
            );
        }
        println!(" |");
    }
}

fn main() {
    // cargo passes --bench, which is not a table
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"))
        .collect();
    let tables: [(&str, fn()); 3] = [
        ("evaluations", evaluations),
        ("compilation", || {
            compilation::table(MODELS.map(|entry| (entry.name, entry.path)))
        }),
        ("runs", runs::table),
    ];
    for (name, table) in tables {
        if words.is_empty() || words.iter().any(|word| word == name) {
            table();
            println!();
        }
    }
}
