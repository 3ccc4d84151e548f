//! Finds out why two runs do not agree: because of rounding, or because errors grow.
//!
//! **Rounding.** A change of a state by a few of its rounding errors changes an output by
//! [`conditioning`](super::conditioning::reach). If the runs differ by less, rounding explains the difference. Large
//! coordinates cause this: at 100 km from the origin, doubles are 0.01 nm apart.
//!
//! **Growth.** The run is repeated from a start in which each entry is changed by the share `MOVED`. The difference of
//! the outputs over that share is the factor by which an error grows.

use super::difference::{Difference, largest};
use crate::simulation::{self, Recording, Runs};
use bryant_runtime::StateKind;
use bryant_runtime::program::{Job, Start};
use std::ops::ControlFlow;
use std::time::Duration;

/// Why two runs do not agree.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// Rounding of a position \[m\]: the one with the largest size.
    Rounding {
        /// The name of the position.
        coordinate: String,
        /// Its largest magnitude.
        size: f64,
    },
    /// Errors grow by this factor, because the motion is chaotic or near an unstable position.
    Growth(f64),
    /// Errors do not grow, but the run changed its method because the scene is stiff.
    Stiff,
    /// None of the other causes.
    Unknown,
}

/// The share by which each entry of the start is changed; smaller entries are changed as if they had the size `LEAST`.
const MOVED: f64 = 1e-9;
const LEAST: f64 = 1e-3;
/// Least factor that counts as growth. A regular motion amplifies a change of its start, too: by about the number of
/// its periods.
const GROWS: f64 = 1e4;
/// Distance from the origin above which a position counts as large \[m\].
const FAR: f64 = 1e3;

/// Finds the cause of a difference between the outputs of a run and those of another run. `rounding` has the reach of
/// rounding errors for each output. The run is repeated, which takes at most `patience`.
pub fn find(
    model: &dyn Runs,
    job: &Job,
    (run, difference): (&Recording, &Difference),
    rounding: &[f64],
    patience: Duration,
) -> Cause {
    if let Some(rounded) = by_rounding(model, run, difference, rounding) {
        return rounded;
    }
    match growth(model, job, run, patience) {
        Some(factor) if factor >= GROWS => Cause::Growth(factor),
        _ if matches!(&run.result, Ok(report) if report.stiff > 0) => Cause::Stiff,
        _ => Cause::Unknown,
    }
}

/// The cause "rounding of a large position"; `None` if it does not explain the difference.
fn by_rounding(
    model: &dyn Runs,
    run: &Recording,
    difference: &Difference,
    rounding: &[f64],
) -> Option<Cause> {
    let columns = run.table.columns.iter().skip(1);
    let apart = columns.zip(&difference.outputs).zip(rounding);
    let mut beyond = apart.filter(|((_, share), _)| **share == difference.worst);
    let ((column, share), reach) = beyond.next()?;
    if share * largest(&column.values) > *reach {
        return None;
    }
    let info = model.info();
    let positions = info.kinds.iter().zip(&run.last_state).enumerate();
    let positions = positions.filter(|(_, (kind, _))| **kind == StateKind::Position);
    let (index, size) = positions
        .map(|(index, (_, value))| (index, value.abs()))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    (size >= FAR).then(|| Cause::Rounding {
        coordinate: info.state_name(index).unwrap_or("?").to_owned(),
        size,
    })
}

/// The factor by which a change of the start grows in the outputs; `None` if the repeated run does not end in time.
fn growth(model: &dyn Runs, job: &Job, run: &Recording, patience: Duration) -> Option<f64> {
    let mut start = job.start.clone();
    let first = Job {
        silent: false,
        ..job.clone()
    };
    model.run(
        &first,
        &mut |t, state, _| {
            start.get_or_insert_with(|| Start {
                t,
                state: state.to_vec(),
            });
            ControlFlow::Break(())
        },
        &mut |_| ControlFlow::Continue(()),
    );
    let mut start = start?;
    let kinds = model.info().kinds;
    for (i, (entry, kind)) in start.state.iter_mut().zip(kinds).enumerate() {
        if !matches!(kind, StateKind::Memory | StateKind::Law) {
            let sign = [1.0, -1.0][i / 2 % 2];
            *entry += sign * MOVED * entry.abs().max(LEAST);
        }
    }
    let moved = Job {
        start: Some(start),
        time_limit: Some(patience),
        ..job.clone()
    };
    let moved = simulation::run(model, &moved, &mut |_| {});
    moved.result.as_ref().ok()?;
    Some(Difference::of(&run.table, &moved.table).worst / MOVED)
}
