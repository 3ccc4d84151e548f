//! Runs one setting of a study and keeps all samples.

use crate::equations::Engine;
use crate::orientation::WithoutCharts;
use crate::simulation::{Recording, run_with_poses};
use bryant_runtime::program::Job;
use std::time::Duration;

/// Runs a job until its end, or until an [interrupt](crate::interrupt).
pub fn run(engine: &Engine, job: &Job) -> Recording {
    run_with_poses(engine, job, usize::MAX, &mut |_| {})
}

/// The states of all samples of a run. Orientations in space are quaternions, because angles in different charts cannot
/// be compared.
pub fn states(recording: &Recording) -> Vec<Vec<f64>> {
    let without_charts = WithoutCharts::of(&recording.header);
    let state = |instant: &crate::picture::Instant| without_charts.state(&instant.state);
    recording.instants.iter().map(state).collect()
}

/// Converts a time limit from seconds; `None` if it is too long for a `Duration`.
pub fn limit(seconds: f64) -> Option<Duration> {
    Duration::try_from_secs_f64(seconds).ok()
}
