//! What runs: a model, whoever made it, behind two traits. The study knows no equations and no integrator.

use serde::Serialize;
use std::sync::Arc;

/// Something that runs rows, on as many threads as ask for a worker.
pub trait Engine: Sync {
    /// A worker for one thread.
    ///
    /// # Errors
    /// What keeps it from working.
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError>;

    /// Rows that a worker should be given at once to be fast, where it can have so many: it gets whole blocks, at least one. With
    /// more than one block, what becomes of a row must depend on that row alone.
    fn rows_at_once(&self) -> u64 {
        1
    }

    /// Whether no further block of rows is to begin: somebody asked the program to end.
    fn stops(&self) -> bool {
        false
    }
}

/// Runs rows on one thread. What it answers depends on the rows it is given alone, in their order.
pub trait Worker {
    /// Runs rows: row-major, as many numbers each as parameters are varied, SI. One outcome per row is pushed, in their order.
    ///
    /// # Errors
    /// What keeps all of them from running; a row that fails is an outcome.
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError>;

    /// Runs one row, for its time series of all outputs.
    ///
    /// # Errors
    /// What keeps it from running.
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
    /// As asked for.
    Done = 0,
    /// A number was no longer finite.
    NonFinite = 1,
    /// The accuracy would have needed a step below what time can tell apart.
    StepTooSmall = 2,
    /// It took more steps than are allowed.
    TooManySteps = 3,
    /// To its end, but the numbers are not to be trusted.
    Doubtful = 4,
    /// The parameters make no sense to the model.
    Refused = 5,
    /// Computing it took too long. This alone may be otherwise on another machine: a study that goes on runs such a row again.
    Slow = 6,
}

impl Status {
    /// All, in the order of their numbers.
    pub const ALL: [Status; 7] = [
        Status::Done,
        Status::NonFinite,
        Status::StepTooSmall,
        Status::TooManySteps,
        Status::Doubtful,
        Status::Refused,
        Status::Slow,
    ];

    /// The word for it in tables.
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

    /// By its number.
    pub fn of(number: u8) -> Option<Status> {
        Status::ALL.get(usize::from(number)).copied()
    }
}

/// How one run went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub status: Status,
    /// When it ended \[s\].
    pub reached: f64,
    /// Steps it took.
    pub steps: u32,
    /// Estimated relative error of the responses, NaN where it is not known.
    pub error: f64,
}

/// How several runs went, with their responses.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcomes {
    /// One per run.
    pub runs: Vec<Outcome>,
    /// Why each run has no result, or none to be trusted, in words; `None` where its status says all.
    pub reasons: Vec<Option<Arc<str>>>,
    /// Row-major, `width` per run; NaN where there is none.
    pub responses: Vec<f64>,
    /// Responses per run.
    pub width: usize,
}

impl Outcomes {
    /// None yet, of so many responses each.
    pub fn new(width: usize) -> Outcomes {
        Outcomes {
            runs: Vec::new(),
            reasons: Vec::new(),
            responses: Vec::new(),
            width,
        }
    }

    /// Adds a run. Of its responses, those beyond `width` are dropped and those missing are NaN.
    pub fn push(&mut self, outcome: Outcome, responses: &[f64]) {
        self.push_because(outcome, responses, None);
    }

    /// The same with the reason why it has no result, or none to be trusted.
    pub fn push_because(&mut self, outcome: Outcome, responses: &[f64], reason: Option<Arc<str>>) {
        self.runs.push(outcome);
        self.reasons.push(reason);
        let known = responses.iter().copied().chain(std::iter::repeat(f64::NAN));
        self.responses.extend(known.take(self.width));
    }

    /// The first runs, which are no longer here then.
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

    /// The reason of a run, "" where there is none.
    pub fn reason(&self, run: usize) -> &str {
        self.reasons[run].as_deref().unwrap_or_default()
    }

    /// Whether computing one of them took too long.
    pub fn any_slow(&self) -> bool {
        self.runs.iter().any(|run| run.status == Status::Slow)
    }

    /// Responses of a run.
    pub fn of(&self, run: usize) -> &[f64] {
        &self.responses[run * self.width..(run + 1) * self.width]
    }
}

/// Outputs of a model over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// \[s\]
    pub times: Vec<f64>,
    /// One per output of the model, in its order, each with a value per time, SI.
    pub outputs: Vec<Vec<f64>>,
}
