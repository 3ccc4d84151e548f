//! The traits of an engine that runs a model. The rest of the crate knows no equations and no integrator.

use crate::response::Response;
use serde::Serialize;
use std::sync::Arc;

/// Runs rows of a study, on any number of threads.
pub trait Engine: Sync {
    /// A worker for one thread.
    ///
    /// # Errors
    /// The engine cannot work.
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError>;

    /// The number of rows that a worker should get in one call to be fast. It gets whole blocks, at least one, and
    /// fewer rows if fewer are left. If a call may have more than one block, the result of a row must depend on that
    /// row alone.
    fn rows_at_once(&self) -> u64 {
        1
    }

    /// True if no further block of rows should begin, because the user asked the program to end.
    fn stops(&self) -> bool {
        false
    }
}

/// Runs rows on one thread. The results depend only on the rows of the call, in their order.
pub trait Worker {
    /// Runs rows and appends one outcome for each, in their order. The rows are given row-major in SI, with one number
    /// for each varied parameter.
    ///
    /// # Errors
    /// No row can be run. If only single rows fail, this is part of their outcomes.
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError>;

    /// Runs one row and returns the time series of all outputs.
    ///
    /// # Errors
    /// The row cannot be run.
    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError>;
}

/// An engine cannot work.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct EngineError(pub String);

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u8)]
pub enum Status {
    /// The run ended as requested.
    Done = 0,
    /// A number was no longer finite.
    NonFinite = 1,
    /// The accuracy would need steps that are too short for the resolution of time.
    StepTooSmall = 2,
    /// The run took more steps than allowed.
    TooManySteps = 3,
    /// The run reached its end, but its numbers cannot be trusted.
    Doubtful = 4,
    /// The model refuses the parameters.
    Refused = 5,
    /// The computation exceeded its time limit. Only this status may differ between machines: a study that continues
    /// runs such a row again.
    Slow = 6,
}

impl Status {
    /// All statuses, in the order of their numbers.
    pub const ALL: [Status; 7] = [
        Status::Done,
        Status::NonFinite,
        Status::StepTooSmall,
        Status::TooManySteps,
        Status::Doubtful,
        Status::Refused,
        Status::Slow,
    ];

    /// Its word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Status::Done => "done",
            Status::NonFinite => "non-finite",
            Status::StepTooSmall => "step-too-small",
            Status::TooManySteps => "too-many-steps",
            Status::Doubtful => "doubtful",
            Status::Refused => "refused",
            Status::Slow => "slow",
        }
    }

    /// The status with this number.
    pub fn of(number: u8) -> Option<Status> {
        Status::ALL.get(usize::from(number)).copied()
    }
}

/// The outcome of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub status: Status,
    /// The time reached \[s\].
    pub reached: f64,
    /// Number of steps.
    pub steps: u32,
    /// Estimated relative error of the responses, NaN if it is not known.
    pub error: f64,
}

/// The outcomes of several runs, with their responses.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcomes {
    /// One outcome for each run.
    pub runs: Vec<Outcome>,
    /// The reason why a run has no result or cannot be trusted, in words; `None` if its status says enough.
    pub reasons: Vec<Option<Arc<str>>>,
    /// Responses, row-major, `width` for each run; NaN for a missing one.
    pub responses: Vec<f64>,
    /// Number of responses for each run.
    pub width: usize,
}

impl Outcomes {
    /// An empty list for runs with this many responses each.
    pub fn new(width: usize) -> Outcomes {
        Outcomes {
            runs: Vec::new(),
            reasons: Vec::new(),
            responses: Vec::new(),
            width,
        }
    }

    /// Adds a run. Responses beyond `width` are dropped, and missing ones are NaN.
    pub fn push(&mut self, outcome: Outcome, responses: &[f64]) {
        self.push_because(outcome, responses, None);
    }

    /// Adds a run as [`Outcomes::push`] does, with the reason why it has no result or cannot be trusted.
    pub fn push_because(&mut self, outcome: Outcome, responses: &[f64], reason: Option<Arc<str>>) {
        self.runs.push(outcome);
        self.reasons.push(reason);
        let known = responses.iter().copied().chain(std::iter::repeat(f64::NAN));
        self.responses.extend(known.take(self.width));
    }

    /// Converts all responses from SI to the units in which they are shown.
    pub fn show_in_units_of(&mut self, responses: &[Response]) {
        for row in self.responses.chunks_mut(self.width.max(1)) {
            for (value, response) in row.iter_mut().zip(responses) {
                *value = response.unit.of_si(*value);
            }
        }
    }

    /// Removes the first `count` runs and returns them.
    pub fn take(&mut self, count: usize) -> Outcomes {
        let count = count.min(self.runs.len());
        let runs = self.runs.split_off(count);
        let reasons = self.reasons.split_off(count);
        let responses = self.responses.split_off(count * self.width);
        let rest = Outcomes {
            runs,
            reasons,
            responses,
            width: self.width,
        };
        std::mem::replace(self, rest)
    }

    /// The reason of a run, "" if there is none.
    pub fn reason(&self, run: usize) -> &str {
        self.reasons[run].as_deref().unwrap_or_default()
    }

    /// True if the computation of one of the runs took too long.
    pub fn any_slow(&self) -> bool {
        self.runs.iter().any(|run| run.status == Status::Slow)
    }

    /// Responses of a run.
    pub fn of(&self, run: usize) -> &[f64] {
        &self.responses[run * self.width..(run + 1) * self.width]
    }
}

/// Time series of the outputs of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Times \[s\].
    pub times: Vec<f64>,
    /// One series for each output, in the model's order, with a value for each time, SI.
    pub outputs: Vec<Vec<f64>>,
}
