//! What an output can be known to: how much it changes when a state changes by about its rounding errors.
//!
//! An output that is 0 in truth, as the acceleration of the centre of a free rod, consists of rounding errors: two runs never agree on it, however
//! sharp they are. It differs from a wrong output in its condition: changes of the state by some rounding errors change it by a large part of its
//! own size.

use super::target::largest;
use crate::simulation::{Recording, Runs};
use bryant_runtime::Method;
use bryant_runtime::program::{Job, Reading, Start};
use std::ops::ControlFlow;

/// Share of itself by which each entry of the state is changed.
const CHANGE: f64 = 1e-14;
/// An entry is taken to be at least this share of the largest of its kind: one that is 0 changes by a rounding error of the largest.
const LEAST: f64 = 1e-2;
/// An output is known only beyond so many times what these changes make of it.
const MARGIN: f64 = 100.0;
/// Patterns of changes: rounding errors of a few states alone may be 0 by chance.
const PATTERNS: usize = 8;

/// The size below which an output may consist of rounding errors, in its unit, by the last state of a run. Zeros where the run has none.
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
    // up and down in turn, in several ways: changes of all entries alike may cancel
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

/// The outputs of a state; `None` where they cannot be computed.
fn outputs(model: &dyn Runs, job: &Job, t: f64, state: &[f64]) -> Option<Vec<f64>> {
    let job = Job {
        start: Some(Start {
            t,
            state: state.to_vec(),
        }),
        // of which nothing but its start is computed, by a method that goes with any length
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
