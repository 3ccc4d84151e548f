//! Why two runs do not agree, by what is measured: rounding, or the growth of errors.
//!
//! **Rounding.** A state that changes by a few of its rounding errors changes an output by [`conditioning`](super::conditioning::reach); if the runs are no
//! further apart than that, rounding explains it. A large coordinate does this: 100 km from the origin, a double tells 0.01 nm apart.
//!
//! **Growth.** The run is repeated from a start that differs by a share `MOVED` of each entry. What the outputs differ by, over that share, is the factor
//! by which an error grows.

use super::target::{Difference, largest};
use crate::simulation::{self, Recording, Runs};
use bryant_runtime::StateKind;
use bryant_runtime::program::{Job, Start};
use std::ops::ControlFlow;
use std::time::Duration;

/// Why two runs do not agree.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// Rounding of this position \[m\], whose size is the largest.
    Rounding {
        /// Its name.
        coordinate: String,
        /// Its largest size.
        size: f64,
    },
    /// Errors grow by this factor: the motion is chaotic, or about to tip over.
    Growth(f64),
    /// Errors do not grow, but the run changed its method because the scene is stiff.
    Stiff,
    /// None of these.
    Unknown,
}

/// The share by which each entry of the start is changed, and the least size that an entry counts as.
const MOVED: f64 = 1e-9;
const LEAST: f64 = 1e-3;
/// From this factor on, errors grow: a motion that goes on evenly amplifies a change of its start by the number of times that it repeats itself.
const GROWS: f64 = 1e4;
/// Positions further from the origin are large \[m\].
const FAR: f64 = 1e3;

/// Finds the cause of a difference of the outputs of a run from those of another one. `rounding` has the reach of rounding errors for each output. The run
/// is repeated, for at most `patience`.
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

/// Rounding of a large position, if it explains the difference.
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

/// The factor by which a change of the start grows in the outputs; `None` if that is not known in time.
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
