//! Runs one setting of a study and keeps all samples.

use super::trajectory::Trajectory;
use crate::equations::Engine;
use crate::interrupt;
use crate::orientation::WithoutCharts;
use bryant_runtime::Report;
use bryant_runtime::program::{Energy, Finding, Header, Job, RunError};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// The outcome of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Names and units.
    pub header: Header,
    /// Its samples; empty for a run without samples.
    pub trajectory: Trajectory,
    /// The cost of the run, or its failure.
    pub result: Result<Report, RunError>,
    /// The balance of energy.
    pub energy: Option<Energy>,
    /// The reasons why the run cannot be trusted.
    pub doubts: Vec<Finding>,
    /// Time of the computation.
    pub took: Duration,
}

/// Runs a job until its end, or until an [interrupt].
pub fn run(engine: &Engine, job: &Job) -> Outcome {
    let header = Header::of(engine.info());
    let mut trajectory = Trajectory::default();
    // without charts, because angles in different charts cannot be compared
    let without_charts = WithoutCharts::of(&header);
    let start = Instant::now();
    let ended = engine.run(
        job,
        &mut |t, state, outputs| {
            trajectory.times.push(t);
            trajectory.states.push(without_charts.state(state));
            trajectory.outputs.push(outputs.to_vec());
            ControlFlow::Continue(())
        },
        &mut |_| interrupt::unless_asked(),
    );
    let took = start.elapsed();
    Outcome {
        result: ended.result,
        header,
        trajectory,
        energy: ended.energy,
        doubts: ended.doubts,
        took,
    }
}

/// Converts a time limit from seconds; `None` if it is too long for a `Duration`.
pub fn limit(seconds: f64) -> Option<Duration> {
    Duration::try_from_secs_f64(seconds).ok()
}
