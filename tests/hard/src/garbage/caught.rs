//! Tries inputs, and keeps those that broke something.

use crate::bench::Bench;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What came of many inputs.
#[derive(Debug, Default)]
pub struct Tried {
    /// Inputs.
    pub count: usize,
    /// Panics, each with its input.
    panics: Vec<String>,
    /// Whatever else must not be, each with its input.
    faults: Vec<String>,
}

/// Most of an input that is shown \[characters\].
const SHOWN: usize = 2000;

impl Tried {
    /// Tries one input; what `check` returns as an error is a fault. `None` after a panic.
    pub fn input<T>(
        &mut self,
        input: &dyn Fn() -> String,
        check: impl FnOnce() -> Result<T, String>,
    ) -> Option<T> {
        self.count += 1;
        match catch_unwind(AssertUnwindSafe(check)) {
            Ok(Ok(value)) => Some(value),
            Ok(Err(fault)) => {
                self.faults
                    .push(format!("{fault}; input: {}", shown(input)));
                None
            }
            Err(_) => {
                self.panics.push(shown(input));
                None
            }
        }
    }

    /// Notes what was found: how many inputs there were, panics and faults, of which there is none.
    pub fn note(&self, bench: &mut Bench<'_>, least: usize, fault: &str, because: &str) {
        bench.at_least(
            "inputs tried",
            self.count as f64,
            least as f64,
            "",
            "the time allowed for the case",
        );
        let seen = |all: &[String]| match all.first() {
            None => format!("none of {}", self.count),
            Some(first) => format!("{} of {}: {first}", all.len(), self.count),
        };
        bench.states(
            "no panic",
            self.panics.is_empty(),
            seen(&self.panics),
            "no panic is reachable from input",
        );
        bench.states(fault, self.faults.is_empty(), seen(&self.faults), because);
    }
}

fn shown(input: &dyn Fn() -> String) -> String {
    input().chars().take(SHOWN).collect()
}
