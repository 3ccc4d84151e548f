//! Finds out how precisely an output can be known: how much it changes when the state changes by about its rounding
//! errors.
//!
//! An output that is exactly 0 consists of rounding errors, for example the acceleration of the centre of a free rod,
//! or the moment of a free hinge about its axis. Two runs never agree on such an output, however sharp they are. Its
//! condition distinguishes it from a wrong output: a change of the state by a few rounding errors changes it by a large
//! part of its own size, because the terms that cancel in it are rounded differently. Rounding errors are as large as
//! these terms, so they are evaluated where the output itself is largest: the moment of a hinge has larger rounding
//! errors in an impact than at rest.

use super::difference::largest;
use crate::interrupt;
use crate::simulation::{Recording, Runs};
use bryant_runtime::Integrator;
use bryant_runtime::program::{Job, Reading, Start};
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// The share by which each entry of the state is changed.
const CHANGE: f64 = 1e-14;
/// Least size of an entry for its change, as a share of the largest entry of its kind: an entry that is 0 changes by a
/// rounding error of the largest.
const LEAST: f64 = 1e-2;
/// An output is known only if it is at least this many times larger than its changes.
const MARGIN: f64 = 100.0;
/// Number of patterns of changes; with few patterns, changes of an output could be 0 by chance.
const PATTERNS: usize = 8;

/// Number of states of a run at which outputs are evaluated, besides the last.
const PLACES: usize = 16;

/// For each output the size, in its unit, below which it may consist of rounding errors; 0 if the run has no state. It
/// is evaluated at the last state of a run, and at states at which outputs are largest that differ between two runs.
/// `job` is the job of the run, `errors` are the differences of the outputs.
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

/// The indices of the samples at which outputs are largest, for the outputs that differ most.
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

/// Times and states of a run at these samples; fewer if the run is interrupted.
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

/// The largest change of each output when a state of the run changes by its rounding errors.
fn changes(model: &dyn Runs, job: &Job, run: &Recording, t: f64, state: &[f64]) -> Vec<f64> {
    let at = |state: &[f64]| outputs(model, job, t, state);
    let Some(here) = at(state) else {
        return Vec::new();
    };
    let [coordinates, velocities] = [run.header.coordinates.len(), run.header.velocities.len()];
    let kinds = [0..coordinates, coordinates..coordinates + velocities];
    // signs alternate with several periods, because equal changes of all entries could cancel
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
        // computes only the start of a run, by a method that accepts any length
        duration: Some(t + 1e-3),
        every: Some(1e-3),
        method: Some(Integrator::default()),
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
