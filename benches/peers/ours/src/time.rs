//! How everything here is timed, as the other engines' programs do it (`common.h`).
//!
//! A batch is as many passes over all states as last [`LEAST`]; the median over the batches is taken by who compares.

use std::time::{Duration, Instant};

/// Batches of a measurement.
const BATCHES: usize = 31;
/// What a batch lasts at least.
const LEAST: Duration = Duration::from_millis(2);
/// Runs of a measurement.
const RUNS: usize = 11;

/// Times per evaluation \[ns\] in each batch; a pass evaluates all of `count` states once.
pub fn batches(count: usize, mut pass: impl FnMut()) -> Vec<f64> {
    let mut passes = 1;
    while elapsed(passes, &mut pass) < LEAST {
        passes *= 2;
    }
    (0..BATCHES)
        .map(|_| nanoseconds(elapsed(passes, &mut pass)) / (passes * count) as f64)
        .collect()
}

/// Times of single runs \[ns\], after one that is not counted.
pub fn runs(mut run: impl FnMut()) -> Vec<f64> {
    run();
    (0..RUNS)
        .map(|_| nanoseconds(elapsed(1, &mut run)))
        .collect()
}

fn elapsed(times: usize, action: &mut impl FnMut()) -> Duration {
    let start = Instant::now();
    for _ in 0..times {
        action();
    }
    start.elapsed()
}

fn nanoseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e9
}
