//! Hard cases, run: what each measured, and whether it kept its bounds.
//!
//! The cases are those of the crate `bryant-hard`; each runs its scenes as a user's model is run, compiled on demand.

mod engine;
pub mod report;

pub use engine::Compiler;

use crate::parallel;
use bryant_hard::{Bench, Case, Check, Engine, Trouble};

/// What came out of a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Which.
    pub case: Case,
    /// What it found, up to where it broke off.
    pub checks: Vec<Check>,
    /// Why it broke off.
    pub trouble: Option<Trouble>,
}

impl Outcome {
    /// Whether all that the case asks for holds, and it asks for something.
    pub fn holds(&self) -> bool {
        self.trouble.is_none() && !self.checks.is_empty() && self.checks.iter().all(Check::holds)
    }
}

/// Cases whose group or name contains one of the words, whatever its case; all where there are none.
pub fn select(words: &[String]) -> Vec<Case> {
    let wanted = |case: &Case| {
        let text = format!("{}: {}", case.group.title(), case.name).to_lowercase();
        words.is_empty() || words.iter().any(|word| text.contains(&word.to_lowercase()))
    };
    bryant_hard::cases().into_iter().filter(wanted).collect()
}

/// One case.
pub fn run_case(case: &Case, engine: &dyn Engine, full: bool) -> Outcome {
    let mut bench = Bench::new(engine, full);
    let trouble = (case.run)(&mut bench).err();
    Outcome {
        case: *case,
        checks: bench.into_checks(),
        trouble,
    }
}

/// Cases on all processors; what came out is in their order. `progress` hears of the part that is done.
pub fn run(
    cases: &[Case],
    engine: &dyn Engine,
    full: bool,
    progress: &mut dyn FnMut(f64),
) -> Vec<Outcome> {
    parallel::map(cases, |case| run_case(case, engine, full), progress)
}
