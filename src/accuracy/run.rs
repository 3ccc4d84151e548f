//! One run of a study of accuracy, with all its samples.

use super::trajectory::Trajectory;
use crate::equations::Engine;
use crate::interrupt;
use crate::orientation::WithoutCharts;
use bryant_runtime::Report;
use bryant_runtime::program::{Energy, Finding, Header, Job, RunError};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// What came out of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Names and units.
    pub header: Header,
    /// Its samples; none of a silent run.
    pub trajectory: Trajectory,
    /// What it took, or why it failed.
    pub result: Result<Report, RunError>,
    /// Where the energy went.
    pub energy: Option<Energy>,
    /// Why it cannot be trusted.
    pub doubts: Vec<Finding>,
    /// Time that the computation took.
    pub took: Duration,
}

/// Runs a job, until it is [interrupted](interrupt) at most.
pub fn run(engine: &Engine, job: &Job) -> Outcome {
    let header = Header::of(engine.info());
    let mut trajectory = Trajectory::default();
    // angles of different charts cannot be compared
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

/// How long a run may take, of seconds; none where a `Duration` cannot hold them.
pub fn limit(seconds: f64) -> Option<Duration> {
    Duration::try_from_secs_f64(seconds).ok()
}
