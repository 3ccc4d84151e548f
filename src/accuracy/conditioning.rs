//! How precisely an output can be known: how much it changes when the state changes by about its rounding errors.
//!
//! An output that is exactly 0, such as the acceleration of the centre of a free rod, or the moment of a free hinge about its axis, consists
//! of rounding errors: two runs never agree on it, however sharp they are. Its condition tells it from a wrong output: if the state changes
//! by a few rounding errors, such an output changes by a large part of its own size, because the terms that cancel in it are rounded
//! otherwise. Rounding errors are as large as these terms, so they are looked at where the output itself is largest: the moment of a hinge in
//! an impact is rounded by more than that at rest.

use super::target::largest;
use crate::interrupt;
use crate::simulation::{Recording, Runs};
use bryant_runtime::Method;
use bryant_runtime::program::{Job, Reading, Start};
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// Each entry of the state is changed by this share of itself.
const CHANGE: f64 = 1e-14;
/// An entry counts as at least this share of the largest entry of its kind: an entry that is 0 changes by a rounding error of the largest.
const LEAST: f64 = 1e-2;
/// An output is known only if it is this many times larger than the changes that these disturbances make.
const MARGIN: f64 = 100.0;
/// Number of patterns of changes: the rounding errors of a few states may be 0 by chance.
const PATTERNS: usize = 8;

/// States of a run that are looked at, besides the last.
const PLACES: usize = 16;

/// For each output the size, in its unit, below which it may consist of rounding errors, evaluated at the last state of a run and at the states
/// where outputs that do not agree between two runs are largest. `job` is what made the run, `errors` say by how much each output disagrees. All
/// are 0 if the run has no state.
pub fn reach(model: &dyn Runs, job: &Job, run: &Recording, errors: &[f64]) -> Vec<f64> {
    let mut reach = vec![0.0; run.table.columns.len().saturating_sub(1)];
    if run.last_state.is_empty() {
        return reach;
    }
    let mut states = states_at(model, job, &largest_at(run, errors));
    states.push((run.last_time(), run.last_state.clone()));
    for (t, state) in &states {
        let changes = changes(model, job, run, *t, state);
        for (reach, change) in reach.iter_mut().zip(changes) {
            *reach = f64::max(*reach, MARGIN * change);
        }
    }
    reach
}

/// The samples at which the outputs of a run that disagree most are largest, by index.
fn largest_at(run: &Recording, errors: &[f64]) -> BTreeSet<usize> {
    let mut disagree: Vec<usize> = (0..errors.len()).filter(|i| errors[*i] > 0.0).collect();
    disagree.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
    let columns = disagree.iter().filter_map(|i| run.table.columns.get(1 + i));
    let place = |values: &[f64]| {
        let sizes = values.iter().map(|value| value.abs()).enumerate();
        sizes.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    };
    columns
        .take(PLACES)
        .filter_map(|column| place(&column.values))
        .collect()
}

/// Times and states of a run at these of its samples; as many as there are before it is interrupted.
fn states_at(model: &dyn Runs, job: &Job, samples: &BTreeSet<usize>) -> Vec<(f64, Vec<f64>)> {
    let Some(last) = samples.last() else {
        return Vec::new();
    };
    let job = Job {
        reading: Reading::default(),
        ..job.clone()
    };
    let (mut states, mut index) = (Vec::new(), 0);
    model.run(
        &job,
        &mut |t, state, _| {
            if samples.contains(&index) {
                states.push((t, state.to_vec()));
            }
            index += 1;
            match index > *last {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        },
        &mut |_| interrupt::unless_asked(),
    );
    states
}

/// By how much each output changes at most when a state of the run changes by its rounding errors.
fn changes(model: &dyn Runs, job: &Job, run: &Recording, t: f64, state: &[f64]) -> Vec<f64> {
    let at = |state: &[f64]| outputs(model, job, t, state);
    let Some(here) = at(state) else {
        return Vec::new();
    };
    let [coordinates, velocities] = [run.header.coordinates.len(), run.header.velocities.len()];
    let kinds = [0..coordinates, coordinates..coordinates + velocities];
    // signs alternate with several periods: equal changes of all entries could cancel
    let patterns = (1..=PATTERNS).map(|period| {
        move |i: usize| [1.0, -1.0][i / period % 2] * period as f64 / PATTERNS as f64
    });
    let mut most = vec![0.0; here.len()];
    for change in patterns {
        let mut changed = state.to_vec();
        for kind in kinds.clone() {
            let largest = largest(&state[kind.clone()]);
            for i in kind {
                let size = state[i].abs().max(LEAST * largest);
                changed[i] += CHANGE * change(i) * size;
            }
        }
        let Some(there) = at(&changed) else { continue };
        for ((most, a), b) in most.iter_mut().zip(&here).zip(&there) {
            *most = f64::max(*most, (a - b).abs());
        }
    }
    most
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
