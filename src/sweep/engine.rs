//! Runs the rows of a study: in lanes, in this process, on any number of threads.

use super::stiff_row::Alone;
use crate::accuracy::conclusion::percent;
use crate::accuracy::fastest_motion::fastest;
use crate::accuracy::setting::time;
use crate::equations::Engine as Equations;
use crate::interrupt;
use bryant_runtime::batch::Pace;
use bryant_runtime::batch::Status as Ended;
use bryant_runtime::batch::rows::{Job, Lingers, Results, Row};
use bryant_runtime::program::Job as Single;
use bryant_runtime::response::Channel;
use bryant_study::engine::{Engine, EngineError, Outcome, Outcomes, Series, Status, Worker};
use bryant_study::facts::OutputFact;
use bryant_study::response::channel_of;
use bryant_study::study::Precision;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Largest number of steps of a run in lanes at first. A row that needs more is run alone by a method that can become
/// implicit, if its scene is stiff; else it is run in lanes again, without this limit. The heaviest bundled scene takes
/// 16 000 steps.
pub const FEW: u32 = 50_000;
/// Largest factor by which sharper runs of a row take more steps: 10^(5/5) at a hundred-thousandth of the tolerances.
const SHARPER: u32 = 10;
/// Number of rows at a standstill for which the fastest motion is searched, and the time limit of each search \[s\].
const LOOKED_INTO: usize = 3;
const LOOKING: f64 = 3.0;

/// A model that runs in lanes.
pub struct Lanes<'a> {
    equations: &'a Equations,
    job: Job,
    precision: Precision,
    refused: Mutex<BTreeMap<String, u64>>,
    /// Called with messages about rows whose computation takes long.
    tell: Option<&'a (dyn Fn(&str) + Sync)>,
    /// Number of rows that exceeded their time limit.
    slow: AtomicU64,
    /// The channels of outputs that have a filter, with the indices of the outputs.
    filtered: Vec<(usize, Channel)>,
    /// Some rows that took too many or too small steps, with their results.
    stalled: Mutex<Vec<(Vec<f64>, Row)>>,
}

impl<'a> Lanes<'a> {
    /// Runs rows of `job` in this precision, for a model with these outputs.
    pub fn new(
        equations: &'a Equations,
        job: Job,
        precision: Precision,
        outputs: &[OutputFact],
    ) -> Self {
        let filtered = outputs.iter().enumerate();
        let filtered = filtered.filter(|(_, output)| output.filter.is_some());
        Lanes {
            filtered: filtered
                .map(|(index, output)| (index, channel_of(index, output.filter.as_deref())))
                .collect(),
            equations,
            job,
            precision,
            refused: Mutex::default(),
            stalled: Mutex::default(),
            tell: None,
            slow: AtomicU64::new(0),
        }
    }

    /// Number of rows that exceeded their time limit.
    pub fn given_up(&self) -> u64 {
        self.slow.load(Ordering::Relaxed)
    }

    /// Adds a function that gets a line every ten seconds about each row whose computation takes long.
    pub fn telling(self, tell: &'a (dyn Fn(&str) + Sync)) -> Self {
        Lanes {
            tell: Some(tell),
            ..self
        }
    }

    /// A row in words, by its varied parameters: "the run with friction = 0.3".
    fn named(&self, given: &[f64]) -> String {
        let info = self.equations.info();
        let varied = self.job.varied.iter().zip(given);
        let varied = varied.map(|(index, value)| {
            let parameter = info.parameters.get(*index);
            let name = parameter.map_or("?", |parameter| parameter.name);
            format!("{name} = {value}")
        });
        let varied: Vec<String> = varied.collect();
        match varied.is_empty() {
            true => "the run".to_owned(),
            false => format!("the run with {}", varied.join(", ")),
        }
    }

    /// Reports a row whose computation takes long.
    fn linger(&self, given: &[f64], lingers: Lingers) {
        if let Some(tell) = self.tell {
            tell(&format!(
                "{} has come to {} of {} in {:.0} s",
                self.named(given),
                time(lingers.t),
                time(self.job.settings.duration),
                lingers.seconds
            ));
        }
    }

    /// The reasons why rows were refused, with the number of rows for each.
    pub fn refused(&self) -> BTreeMap<String, u64> {
        let refused = self.refused.lock();
        refused.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The reason why a row is refused, which is also recorded; `None` if it is not refused.
    fn refuse(&self, row: &[f64]) -> Option<String> {
        let reason = super::refusal(self.equations, &self.job, row)?;
        let refused = self.refused.lock();
        let mut refused = refused.unwrap_or_else(PoisonError::into_inner);
        *refused.entry(reason.clone()).or_default() += 1;
        Some(reason)
    }

    /// The reason why a row came to a standstill; the row is also recorded. The text has only the order of magnitude of
    /// the step, so that similar rows have equal reasons; the table has the time.
    fn stall(&self, row: &Row, given: &[f64]) -> String {
        let stalled = self.stalled.lock();
        let mut stalled = stalled.unwrap_or_else(PoisonError::into_inner);
        if stalled.len() < LOOKED_INTO {
            stalled.push((given.to_vec(), *row));
        }
        if row.status == Ended::Slow {
            self.slow.fetch_add(1, Ordering::Relaxed);
        }
        let order = bryant_picture::chart::power_of_ten(libm::log10(row.step).floor() as i32);
        match row.status {
            Ended::TooManySteps => format!(
                "the limit of {} steps is reached, with steps of some {} at the time reached",
                self.job.settings.max_steps,
                time(order)
            ),
            Ended::Slow => match self.job.settings.time_limit {
                Some(limit) => format!(
                    "its computation takes longer than {}, or would take ten times as long at its present rate",
                    time(limit.as_secs_f64())
                ),
                None => "its computation takes too long".to_owned(),
            },
            _ => format!(
                "steps below {} are asked for at the time reached",
                time(10.0 * order)
            ),
        }
    }

    /// A line for each of the first few rows at a standstill, about the motion that limits its steps. To find this
    /// motion, each is run again alone, for a few seconds at most.
    pub fn standstills(&self) -> Vec<String> {
        let stalled = self.stalled.lock();
        let stalled = stalled.unwrap_or_else(PoisonError::into_inner);
        let info = self.equations.info();
        let line = |(given, row): &(Vec<f64>, Row)| {
            let values = super::refusal::parameters(self.equations, &self.job, given);
            let names = info.parameters.iter().map(|parameter| parameter.name);
            let single = Single {
                // only up to the time that the row reached
                duration: (row.t > 0.0).then_some(row.t),
                parameters: names
                    .zip(&values)
                    .map(|(name, value)| (name.to_owned(), *value))
                    .collect(),
                ..Single::default()
            };
            let why = fastest(self.equations, &single, &values, LOOKING)
                .map(|fastest| format!("; {}", fastest.text()));
            format!(
                "{} is at t = {} after {} steps and {} rejected ones, and its next step is {}{}",
                self.named(given),
                time(row.t),
                row.steps,
                row.rejected,
                time(row.step),
                why.unwrap_or_default()
            )
        };
        stalled.iter().map(line).collect()
    }

    /// A remark on the error of a row that reached its end; `None` if there is nothing to say.
    fn remark(&self, row: &Row) -> Option<String> {
        let wanted = percent(self.job.wanted);
        let often = row.sharpened;
        match (row.error <= self.job.wanted, often) {
            (true, 0) => None,
            (true, _) => Some(format!(
                "its estimated error was above {wanted}: this is the result at 1e-{often} of the tolerance"
            )),
            (false, _) if row.error.is_nan() => Some(
                "its error is not known: the run that it is compared with failed or cannot be trusted".to_owned(),
            ),
            (false, 0) => Some(format!("its estimated error is above {wanted}")),
            (false, _) => Some(format!(
                "its estimated error is above {wanted}, even at 1e-{often} of the tolerance"
            )),
        }
    }

    /// The reason for the status of a row, or for doubts about its result, or a remark on how its result was computed;
    /// `None` if its status says enough.
    fn reason(&self, row: &Row, given: &[f64]) -> Option<String> {
        match row.status {
            Ended::Refused => self.refuse(given),
            Ended::TooManySteps | Ended::StepTooSmall | Ended::Slow => Some(self.stall(row, given)),
            Ended::Done if self.job.estimate => self.remark(row),
            _ => super::doubt(self.equations, row.doubt),
        }
    }
}

impl Lanes<'_> {
    /// Runs rows in lanes.
    fn in_lanes(
        &self,
        job: &Job,
        rows: &[f64],
        hear: &dyn Fn(Lingers),
    ) -> Result<Results, EngineError> {
        let results = match self.precision {
            Precision::Double => self.equations.rows_heard(job, rows, hear),
            Precision::Single => self.equations.rows_of_singles_heard(job, rows, hear),
        };
        results.map_err(|error| EngineError(error.to_string()))
    }

    /// True if a row, or a sharper or coarser run of it, may have reached the limit of [`FEW`] steps.
    fn takes_many(&self, row: &Row) -> bool {
        let adaptive = matches!(self.job.settings.pace, Pace::Adaptive(_));
        let good = !self.job.estimate || row.error <= self.job.wanted;
        adaptive
            && match row.status {
                Ended::TooManySteps => true,
                Ended::Done => !good && row.steps >= FEW / SHARPER,
                _ => false,
            }
    }

    /// Adds the outcome of a row that was run alone.
    fn push_alone(&self, alone: Alone, outcomes: &mut Outcomes) {
        let trusted = alone.doubt.is_none();
        let row = Row {
            status: if trusted {
                Ended::Done
            } else {
                Ended::Doubtful
            },
            t: self.job.settings.duration,
            steps: u32::try_from(alone.steps).unwrap_or(u32::MAX),
            rejected: 0,
            step: f64::NAN,
            error: alone.error,
            sharpened: alone.sharpened,
            doubt: None,
        };
        let remark = self.job.estimate.then(|| self.remark(&row)).flatten();
        let reason = alone.doubt.or(remark);
        outcomes.push_because(outcome(&row), &alone.responses, reason.map(Into::into));
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
            Ended::Slow => Status::Slow,
        },
        reached: row.t,
        steps: row.steps,
        error: row.error,
    }
}

/// Times and outputs of a run, from its samples, which are output by output.
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
        let varied = self.job.varied.len();
        let hear = |lingers: Lingers| self.linger(&rows[lingers.row * varied..][..varied], lingers);
        let mut first = self.job.clone();
        first.settings.max_steps = first.settings.max_steps.min(FEW);
        let mut results = self.in_lanes(&first, rows, &hear)?;
        let width = self.job.responses.len();
        let many: Vec<usize> = (0..results.rows.len())
            .filter(|index| self.takes_many(&results.rows[*index]))
            .collect();
        let mut alone: BTreeMap<usize, Alone> = BTreeMap::new();
        for &index in &many {
            let given = &rows[index * varied..][..varied];
            if results.rows[index].status == Ended::TooManySteps
                && !interrupt::asked()
                && let Some(found) = super::alone(self.equations, &self.job, given)
            {
                alone.insert(index, found);
            }
        }
        let again: Vec<usize> = many
            .into_iter()
            .filter(|i| !alone.contains_key(i))
            .collect();
        if !again.is_empty() && self.job.settings.max_steps > FEW {
            let given = again
                .iter()
                .flat_map(|index| &rows[index * varied..][..varied]);
            let given: Vec<f64> = given.copied().collect();
            let hear =
                |lingers: Lingers| self.linger(&given[lingers.row * varied..][..varied], lingers);
            let found = self.in_lanes(&self.job, &given, &hear)?;
            for (place, &index) in again.iter().enumerate() {
                results.rows[index] = found.rows[place];
                results.responses[index * width..][..width]
                    .copy_from_slice(&found.responses[place * width..][..width]);
            }
        }
        for (index, row) in results.rows.iter().enumerate() {
            if let Some(alone) = alone.remove(&index) {
                self.push_alone(alone, outcomes);
                continue;
            }
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
        let mut series = series(&self.job, &samples);
        let every = self.job.settings.duration / (self.job.settings.samples - 1) as f64;
        for (index, output) in self.filtered.iter() {
            // if the samples are too far apart for the filter, the study does not keep this series
            let formed = output.form(|output| series.outputs[output].clone(), every);
            if let Some(samples) = formed {
                series.outputs[*index] = samples;
            }
        }
        Ok(series)
    }
}
