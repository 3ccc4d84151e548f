//! How precisely an output can be known: how much it changes when the state changes by about its rounding errors.
//!
//! An output that is exactly 0, such as the acceleration of the centre of a free rod, consists of rounding errors: two runs never agree on
//! it, however sharp they are. Its condition tells it from a wrong output: if the state changes by a few rounding errors, such an output
//! changes by a large part of its own size.

use super::target::largest;
use crate::simulation::{Recording, Runs};
use bryant_runtime::Method;
use bryant_runtime::program::{Job, Reading, Start};
use std::ops::ControlFlow;

/// Each entry of the state is changed by this share of itself.
const CHANGE: f64 = 1e-14;
/// An entry counts as at least this share of the largest entry of its kind: an entry that is 0 changes by a rounding error of the largest.
const LEAST: f64 = 1e-2;
/// An output is known only if it is this many times larger than the changes that these disturbances make.
const MARGIN: f64 = 100.0;
/// Number of patterns of changes: the rounding errors of a few states may be 0 by chance.
const PATTERNS: usize = 8;

/// For each output the size, in its unit, below which it may consist of rounding errors, evaluated at the last state of a run. All are 0 if
/// the run has no state.
pub fn reach(model: &dyn Runs, job: &Job, run: &Recording) -> Vec<f64> {
    let sizes = run.table.columns.iter().skip(1);
    let none: Vec<f64> = sizes.map(|_| 0.0).collect();
    if run.last_state.is_empty() {
        return none;
    }
    let at = |state: &[f64]| outputs(model, job, run.last_time(), state);
    let Some(here) = at(&run.last_state) else {
        return none;
    };
    let [coordinates, velocities] = [run.header.coordinates.len(), run.header.velocities.len()];
    let kinds = [0..coordinates, coordinates..coordinates + velocities];
    // signs alternate with several periods: equal changes of all entries could cancel
    let patterns = (1..=PATTERNS).map(|period| {
        move |i: usize| [1.0, -1.0][i / period % 2] * period as f64 / PATTERNS as f64
    });
    let largest_change = patterns.fold(none, |reach, change| {
        let mut state = run.last_state.clone();
        for kind in kinds.clone() {
            let most = largest(&run.last_state[kind.clone()]);
            for i in kind {
                let size = state[i].abs().max(LEAST * most);
                state[i] += CHANGE * change(i) * size;
            }
        }
        let there = at(&state).unwrap_or_else(|| here.clone());
        let changes = here.iter().zip(&there).map(|(a, b)| (a - b).abs());
        reach.iter().zip(changes).map(|(a, b)| a.max(b)).collect()
    });
    largest_change.iter().map(|x| MARGIN * x).collect()
}

/// The outputs at a state; `None` if they cannot be computed.
fn outputs(model: &dyn Runs, job: &Job, t: f64, state: &[f64]) -> Option<Vec<f64>> {
    let job = Job {
        start: Some(Start {
            t,
            state: state.to_vec(),
        }),
        // only the start of this run is computed, by a method that accepts any length
        duration: Some(t + 1e-3),
        every: Some(1e-3),
        method: Some(Method::default()),
        reading: Reading::default(),
        ..job.clone()
    };
    let mut first = None;
    model.run(
        &job,
        &mut |_, _, outputs| {
            first.get_or_insert_with(|| outputs.to_vec());
            ControlFlow::Break(())
        },
        &mut |_| ControlFlow::Continue(()),
    );
    first
}
