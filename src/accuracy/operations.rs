//! Counts the operations of an evaluation, as `bryant check` does.

use bryant_generator::model::Model;
use bryant_generator::{dynamics, program};
use bryant_runtime::Report;

/// The cost of one evaluation of the derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions, multiplications, divisions and roots; a sine, a cosine or a call of a law counts as one.
    pub evaluation: u64,
    /// Sines and cosines among them.
    pub sines: u64,
}

/// Operations over dual numbers per operation over numbers: for example, a product becomes three products and a sum.
const DUAL: u64 = 3;

impl Operations {
    /// The operations of a model.
    pub fn of(model: &Model) -> Operations {
        let options = dynamics::Options {
            matrices: false,
            ..dynamics::Options::default()
        };
        let equations = dynamics::derive_with(model, options);
        let emitted = program::Options {
            matrices: false,
            ..program::Options::default()
        };
        let costs = program::costs(model, &equations, &emitted);
        let Some((_, table)) = costs.iter().find(|(name, _)| *name == "accelerations") else {
            return Operations::default();
        };
        let count = &table.total;
        let sines = count.sin + count.cos;
        let calls: usize = count.calls.values().sum();
        Operations {
            evaluation: (count.total() + sines + count.atan2 + calls) as u64,
            sines: sines as u64,
        }
    }

    /// The operations of a run whose state has `entries` entries. A Jacobian takes one evaluation over dual numbers for
    /// each entry, and one for the time.
    pub fn of_run(&self, report: &Report, entries: usize) -> u64 {
        let duals = DUAL * (entries as u64 + 1) * report.jacobians;
        self.evaluation * (report.evaluations + duals)
    }
}
