//! Measures the time of one evaluation of several models, which are compared with each other.
//!
//! All models run in this process in turn, round after round, so that a disturbance of the machine slows down all of
//! them. Several states are used, which avoid the special values of the start.

use crate::equations::Engine;
use bryant_runtime::Adjustable;
use std::hint::black_box;
use std::time::Instant;

/// The method that is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TimedMethod {
    /// The rates of the state, which are mainly accelerations.
    Accelerations,
    /// The outputs, including the accelerations if they need them.
    Outputs,
}

impl TimedMethod {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            TimedMethod::Accelerations => "accelerations",
            TimedMethod::Outputs => "outputs",
        }
    }
}

/// The measurements of one method of one model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Median time of one evaluation \[s\].
    pub time: f64,
    /// Length of its machine code; `None` if it is interpreted.
    pub bytes: Option<u64>,
}

/// Number of rounds; each model has one turn in each round.
const ROUNDS: usize = 51;
/// Approximate length of a turn \[s\].
const TURN: f64 = 5e-5;
/// Number of states that are evaluated in turn.
const STATES: usize = 8;

/// Measures one method of each model.
pub fn time(models: &[(&Engine, TimedMethod)]) -> Vec<Measured> {
    let mut all: Vec<Evaluations<'_>> = models
        .iter()
        .map(|(engine, method)| Evaluations::new(engine, *method))
        .collect();
    let counts: Vec<u64> = all.iter_mut().map(Evaluations::in_a_turn).collect();
    let mut times = vec![Vec::with_capacity(ROUNDS); all.len()];
    for _ in 0..ROUNDS {
        for ((evaluations, times), &count) in all.iter_mut().zip(&mut times).zip(&counts) {
            // first some evaluations that are not measured, because other models have displaced this one from the
            // caches
            evaluations.take(count / 8);
            times.push(evaluations.take(count) / count as f64);
        }
    }
    let median = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let times = times.into_iter().map(median).zip(models);
    times
        .map(|(time, (engine, method))| Measured {
            time,
            bytes: bytes(engine, *method),
        })
        .collect()
}

/// Length of the machine code.
fn bytes(engine: &Engine, method: TimedMethod) -> Option<u64> {
    use bryant_generator::program::Method;
    let method = match method {
        TimedMethod::Accelerations => Method::Derivative,
        TimedMethod::Outputs => Method::Outputs,
    };
    engine.code_bytes(method).map(|bytes| bytes as u64)
}

/// Evaluates a model repeatedly.
struct Evaluations<'a> {
    model: Box<dyn Adjustable<f64> + 'a>,
    method: TimedMethod,
    t: f64,
    states: Vec<Vec<f64>>,
    results: Vec<f64>,
}

impl<'a> Evaluations<'a> {
    fn new(engine: &'a Engine, method: TimedMethod) -> Self {
        let model = engine.in_double();
        let info = engine.info();
        let mut start = vec![0.0; info.state_length()];
        model.initial_state(&mut start);
        let states = (0..STATES).map(|k| {
            let mut y = start.clone();
            for (i, entry) in y.iter_mut().enumerate() {
                *entry += 0.02 * ((i * 7 + k * 3) % 11) as f64 - 0.1;
            }
            model.normalize(&mut y);
            y
        });
        Evaluations {
            states: states.collect(),
            results: vec![0.0; info.state_length().max(info.outputs.len())],
            t: 0.3 * info.duration,
            model,
            method,
        }
    }

    /// Number of evaluations in a turn.
    fn in_a_turn(&mut self) -> u64 {
        let once = (0..5)
            .map(|_| self.take(20) / 20.0)
            .fold(f64::MAX, f64::min);
        (TURN / once).clamp(16.0, 1e6) as u64
    }

    /// Time of this many evaluations \[s\].
    fn take(&mut self, count: u64) -> f64 {
        let info = self.model.info();
        let length = match self.method {
            TimedMethod::Accelerations => info.state_length(),
            TimedMethod::Outputs => info.outputs.len(),
        };
        let results = &mut self.results[..length];
        let begin = Instant::now();
        for i in 0..count {
            let y = black_box(&self.states[i as usize % STATES]);
            match self.method {
                TimedMethod::Accelerations => self.model.derivative(black_box(self.t), y, results),
                TimedMethod::Outputs => self.model.outputs(black_box(self.t), y, results),
            }
            black_box(&*results);
        }
        begin.elapsed().as_secs_f64()
    }
}
