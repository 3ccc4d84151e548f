//! What laws keep besides q and v: continuous states z, memory m that is renewed when a step is accepted, and what has fired.

use super::AppliedForces;
use super::switch::Remembered;
use crate::expression::{Expr, Symbol};

/// A time that is never reached, finite as every memory must be \[s\].
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
    /// Of an auxiliary its rate, of a memory its value after an accepted step. Before a law says otherwise an auxiliary
    /// stays, and so does a memory.
    pub next: Expr<'g>,
}

impl<'g> AppliedForces<'g> {
    /// A new state z of a force law, and its index, by which the law sets the rate.
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

    /// A new memory m of a force law, and its index, by which the law sets what it becomes after an accepted step.
    ///
    /// Its value must always be finite: what has not happened yet happens at [`NEVER`].
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
