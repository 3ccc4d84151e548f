//! Runs of compiled models, recorded.

use bryant_runtime::program::{Entry, Job};
use bryant_runtime::{Formula, Integrator, Tolerances};
use std::ops::ControlFlow;

/// Times, states and outputs of the samples of a run.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// \[s\]
    pub times: Vec<f64>,
    /// Coordinates, then velocities.
    pub states: Vec<Vec<f64>>,
    /// In the order of the model.
    pub outputs: Vec<Vec<f64>>,
    /// Names of the outputs.
    pub names: Vec<&'static str>,
    /// Accepted steps.
    pub steps: f64,
}

impl Recording {
    /// An output at all samples.
    ///
    /// # Panics
    /// If there is no output of this name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let index = self.names.iter().position(|n| *n == name);
        let index = index.unwrap_or_else(|| panic!("no output {name:?}"));
        self.outputs.iter().map(|row| row[index]).collect()
    }

    /// Index of the sample at a time.
    ///
    /// # Panics
    /// If there is no sample at this time.
    pub fn at(&self, t: f64) -> usize {
        let index = self.times.iter().position(|x| (x - t).abs() < 1e-9);
        index.unwrap_or_else(|| panic!("no sample at {t} s"))
    }
}

/// A run with the settings of the model but with these parameters, by the adaptive method, with one tolerance for all
/// variables.
///
/// # Panics
/// If the run fails.
pub fn run(entry: &Entry, parameters: &[(&str, f64)], tolerance: f64) -> Recording {
    run_for(entry, parameters, tolerance, None)
}

/// As [`run`], with another duration and a hundred samples.
///
/// # Panics
/// If the run fails.
pub fn run_for(
    entry: &Entry,
    parameters: &[(&str, f64)],
    tolerance: f64,
    duration: Option<f64>,
) -> Recording {
    let method = Integrator::adaptive(Formula::Dopri5, Tolerances::uniform(tolerance));
    let job = Job {
        method: Some(method),
        duration,
        every: duration.map(|duration| duration / 100.0),
        parameters: parameters
            .iter()
            .map(|(name, value)| (name.to_string(), *value))
            .collect(),
        ..Job::default()
    };
    let mut recording = Recording {
        names: entry.info.outputs.iter().map(|o| o.name).collect(),
        ..Recording::default()
    };
    let report = entry
        .run(&job, &mut |t, state, outputs| {
            recording.times.push(t);
            recording.states.push(state.to_vec());
            recording.outputs.push(outputs.to_vec());
            ControlFlow::Continue(())
        })
        .unwrap_or_else(|error| panic!("{}: {}", entry.info.name, error.message));
    recording.steps = report.steps as f64;
    recording
}
