//! The states of laws besides q and v: continuous states z, the memory m, which is renewed after each accepted step,
//! and the switches.

use super::AppliedForces;
use super::switch::Remembered;
use crate::expression::{Expr, Symbol};

/// A time that is never reached \[s\]. It is finite, because every memory must be.
pub const NEVER: f64 = 1e30;

/// The states of all laws.
pub struct States<'g> {
    /// States z of force laws, integrated with q and v.
    pub auxiliaries: Vec<LawState<'g>>,
    /// The charts of Bryant angles, and the memory m of force laws, renewed when a step is accepted.
    pub memory: Vec<LawState<'g>>,
    /// By switch of the model: its memory.
    pub switches: Vec<Remembered<'g>>,
}

/// A state that a force law keeps besides q and v.
pub struct LawState<'g> {
    /// Name for people, which begins with that of the force: "contact seat: permanent set".
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// Value at the start of a run.
    pub initial: Expr<'g>,
    /// For an auxiliary state its rate, for a memory its value after the next accepted step. Until a law sets it, the
    /// state keeps its value.
    pub next: Expr<'g>,
}

impl<'g> AppliedForces<'g> {
    /// Adds a state z of a force law. Returns its index, with which the law sets the rate, and its symbol.
    pub fn auxiliary(
        &mut self,
        name: impl Into<String>,
        unit: &'static str,
        initial: Expr<'g>,
    ) -> (usize, Expr<'g>) {
        let (graph, index) = (initial.graph(), self.states.auxiliaries.len());
        self.states.auxiliaries.push(LawState {
            name: name.into(),
            unit,
            initial,
            next: graph.constant(0.0),
        });
        (index, graph.symbol(Symbol::Auxiliary(index as u32)))
    }

    /// Adds a memory m of a force law. Returns its index, with which the law sets the value after an accepted step, and
    /// its symbol.
    ///
    /// The value must always be finite: the time of an event that has not happened yet is [`NEVER`].
    pub fn memory(
        &mut self,
        name: impl Into<String>,
        unit: &'static str,
        initial: Expr<'g>,
    ) -> (usize, Expr<'g>) {
        let (graph, index) = (initial.graph(), self.states.memory.len());
        let value = graph.symbol(Symbol::Memory(index as u32));
        self.states.memory.push(LawState {
            name: name.into(),
            unit,
            initial,
            next: value,
        });
        (index, value)
    }
}
