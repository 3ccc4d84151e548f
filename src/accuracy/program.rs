//! A model's program for every scalar: what it is made of, how it is run.

use super::trajectory::Trajectory;
use crate::simulation::ProgramError;
use bryant_runtime::Report;
use bryant_runtime::program::{Energy, Header, Job, RunError, StreamError, StreamReader};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::{Command, Stdio};
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
    /// Time that the computation took.
    pub took: Duration,
}

/// Runs a job in a process of its own.
///
/// # Errors
/// The program does not start, or what it writes makes no sense; a failed run is no error.
pub fn run(program: &Path, job: &Job) -> Result<Outcome, ProgramError> {
    let started = |source| ProgramError::Start {
        path: program.to_owned(),
        source,
    };
    let foreign = |source| ProgramError::Stream {
        path: program.to_owned(),
        source,
    };
    let mut child = Command::new(program)
        .args(job.to_words())
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(started)?;
    let Some(output) = child.stdout.take() else {
        return Err(foreign(StreamError::Torn));
    };
    let outcome = StreamReader::new(output).and_then(|mut reader| {
        let mut trajectory = Trajectory::default();
        let result = reader.read(&mut |t, state, outputs| {
            trajectory.times.push(t);
            trajectory.states.push(state.to_vec());
            trajectory.outputs.push(outputs.to_vec());
            ControlFlow::Continue(())
        });
        let result = match result {
            Ok(report) => Ok(report),
            Err(StreamError::Run(error)) => Err(error),
            Err(error) => return Err(error),
        };
        Ok(Outcome {
            header: reader.header().clone(),
            trajectory,
            result,
            energy: reader.energy().cloned(),
            took: reader.took(),
        })
    });
    // Whatever was read, the child is not left behind.
    if outcome.is_err() {
        let _ = child.kill();
    }
    let _ = child.wait();
    outcome.map_err(foreign)
}
