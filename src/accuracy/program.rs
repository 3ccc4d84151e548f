//! A model's program for every scalar: what it is made of, how it is run.

use super::trajectory::Trajectory;
use crate::orientation::WithoutCharts;
use crate::simulation::{ProgramError, outcome, read_from};
use bryant_runtime::Report;
use bryant_runtime::program::{Energy, Finding, Header, Job, RunError};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

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

/// Runs a job in a process of its own.
///
/// # Errors
/// The program does not start, or what it writes makes no sense; a failed run is no error.
pub fn run(program: &Path, job: &Job) -> Result<Outcome, ProgramError> {
    read_from(program, job, |mut reader| {
        let mut trajectory = Trajectory::default();
        // angles of different charts cannot be compared
        let without_charts = WithoutCharts::of(reader.header());
        let result = reader.read(&mut |t, state, outputs| {
            trajectory.times.push(t);
            trajectory.states.push(without_charts.state(state));
            trajectory.outputs.push(outputs.to_vec());
            ControlFlow::Continue(())
        });
        Ok(Outcome {
            result: outcome(result)?,
            header: reader.header().clone(),
            trajectory,
            energy: reader.energy().cloned(),
            doubts: reader.doubts().to_vec(),
            took: reader.took(),
        })
    })
}
