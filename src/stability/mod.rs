//! Runs the hard cases, and reports whether they keep their bounds.
//!
//! The crate `bryant-hard` has the cases; each runs its scenes in the same way as a user's model.

mod engine;
pub mod report;

pub use engine::Scenes;

use crate::parallel;
use bryant_hard::{Bench, Case, Check, Engine, Trouble};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The outcome of a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The case.
    pub case: Case,
    /// Its checks; only the first ones if the case ended early.
    pub checks: Vec<Check>,
    /// The reason why the case ended early.
    pub trouble: Option<Trouble>,
}

impl Outcome {
    /// True if the case did not end early, has checks, and all of them hold.
    pub fn holds(&self) -> bool {
        self.trouble.is_none() && !self.checks.is_empty() && self.checks.iter().all(Check::holds)
    }
}

/// The cases whose group or name contains one of the words, whose case does not matter; all cases if there are no
/// words.
pub fn select(words: &[String]) -> Vec<Case> {
    let wanted = |case: &Case| {
        let text = format!("{}: {}", case.group.title(), case.name).to_lowercase();
        words.is_empty() || words.iter().any(|word| text.contains(&word.to_lowercase()))
    };
    bryant_hard::cases().into_iter().filter(wanted).collect()
}

/// Runs one case. A panic in it becomes its trouble, and does not affect other cases.
pub fn run_case(case: &Case, engine: &dyn Engine, full: bool) -> Outcome {
    let mut bench = Bench::new(engine, full);
    // a check is always added completely, so the checks before a panic are valid
    let trouble = match catch_unwind(AssertUnwindSafe(|| (case.run)(&mut bench))) {
        Ok(result) => result.err(),
        Err(payload) => Some(Trouble::Panicked(message(payload.as_ref()))),
    };
    Outcome {
        case: *case,
        checks: bench.into_checks(),
        trouble,
    }
}

/// The message of a panic; "without a message" if its payload is not text.
fn message(payload: &(dyn Any + Send)) -> String {
    let plain = payload
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned());
    let text = plain.or_else(|| payload.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "without a message".into())
}

/// Runs the cases on all processors. Returns the outcomes in the order of the cases, without cases that an interruption
/// left out. `progress` is called with the number of finished cases.
pub fn run(
    cases: &[Case],
    engine: &dyn Engine,
    full: bool,
    progress: &mut dyn FnMut(usize),
) -> Vec<Outcome> {
    let outcomes = parallel::map(cases, |case| run_case(case, engine, full), progress);
    outcomes.into_iter().flatten().collect()
}
