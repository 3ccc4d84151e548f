//! Tries inputs, and collects those that cause a panic or a fault.

use crate::bench::Bench;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The results of many inputs.
#[derive(Debug, Default)]
pub struct Tried {
    /// Number of inputs.
    pub count: usize,
    /// Panics, each with its input.
    panics: Vec<String>,
    /// Other faults, each with its input.
    faults: Vec<String>,
}

/// Largest part of an input that is shown \[characters\].
const SHOWN: usize = 2000;

impl Tried {
    /// Tries one input: `check` returns an error for a fault, and may panic. `None` after a fault or a panic.
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

    /// Records checks: the number of inputs is at least `least`, and there were no panics and no faults.
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
