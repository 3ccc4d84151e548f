//! What runs the rows of a study: a model in lanes, in this process, on as many threads as ask.

use crate::equations::Engine as Equations;
use crate::interrupt;
use bryant_runtime::batch::Status as Ended;
use bryant_runtime::batch::rows::{Job, Row};
use bryant_study::engine::{Engine, EngineError, Outcome, Outcomes, Series, Status, Worker};
use bryant_study::study::Precision;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A model that runs in lanes.
pub struct Lanes<'a> {
    equations: &'a Equations,
    job: Job,
    precision: Precision,
    refused: Mutex<BTreeMap<String, u64>>,
}

impl<'a> Lanes<'a> {
    /// Rows of a job, in this precision.
    pub fn new(equations: &'a Equations, job: Job, precision: Precision) -> Self {
        Lanes {
            equations,
            job,
            precision,
            refused: Mutex::default(),
        }
    }

    /// Why rows that it was given are refused: what they do not keep, and how many.
    pub fn refused(&self) -> BTreeMap<String, u64> {
        let refused = self.refused.lock();
        refused.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Why a row is refused, which is remembered.
    fn refuse(&self, row: &[f64]) -> Option<String> {
        let reason = super::refusal(self.equations, &self.job, row)?;
        let refused = self.refused.lock();
        let mut refused = refused.unwrap_or_else(PoisonError::into_inner);
        *refused.entry(reason.clone()).or_default() += 1;
        Some(reason)
    }

    /// Why a row has no result, or none to be trusted, where its status does not say all.
    fn reason(&self, row: &Row, given: &[f64]) -> Option<String> {
        match row.status {
            Ended::Refused => self.refuse(given),
            _ => super::doubt(self.equations, row.doubt),
        }
    }
}

impl Engine for Lanes<'_> {
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError> {
        Ok(Box::new(self))
    }

    fn stops(&self) -> bool {
        interrupt::asked()
    }
}

fn outcome(row: &Row) -> Outcome {
    Outcome {
        status: match row.status {
            Ended::Done => Status::Done,
            Ended::NonFinite => Status::NonFinite,
            Ended::StepTooSmall => Status::StepTooSmall,
            Ended::TooManySteps => Status::TooManySteps,
            Ended::Doubtful => Status::Doubtful,
            Ended::Refused => Status::Refused,
        },
        reached: row.t,
        steps: row.steps,
        error: row.error,
    }
}

/// Times and outputs of a run: samples output by output.
fn series(job: &Job, samples: &[f64]) -> Series {
    let count = job.settings.samples;
    let every = job.settings.duration / (count - 1) as f64;
    Series {
        times: (0..count).map(|i| i as f64 * every).collect(),
        outputs: samples.chunks(count).map(<[f64]>::to_vec).collect(),
    }
}

impl Worker for &Lanes<'_> {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        let results = match self.precision {
            Precision::Double => self.equations.rows(&self.job, rows),
            Precision::Single => self.equations.rows_of_singles(&self.job, rows),
        };
        let results = results.map_err(|error| EngineError(error.to_string()))?;
        let width = self.job.responses.len();
        let varied = self.job.varied.len();
        for (index, row) in results.rows.iter().enumerate() {
            let reason = self.reason(row, &rows[index * varied..][..varied]);
            outcomes.push_because(
                outcome(row),
                &results.responses[index * width..][..width],
                reason.map(Into::into),
            );
        }
        Ok(())
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        let all: Vec<usize> = (0..self.equations.info().outputs.len()).collect();
        let result = match self.precision {
            Precision::Double => self.equations.series(&self.job, row, &all),
            Precision::Single => self.equations.series_of_singles(&self.job, row, &all),
        };
        let (_, samples) = result.map_err(|error| EngineError(error.to_string()))?;
        Ok(series(&self.job, &samples))
    }
}
