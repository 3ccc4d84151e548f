//! Switches: each remembers two times, the one at which it fired and the one from which on it acts.
//!
//! fired ← t where the trigger's event function G < 0 after an accepted step,   acts ← t where t ≥ fired + delay
//!
//! G is positive until the quantity passes its threshold. The change of its sign ends a step, so a step ends at the
//! crossing. Both times are constant during a step, so a force that waits for a switch never jumps inside a step. For
//! the same reason the quantity may itself depend on the switch, as an acceleration does, without a circular
//! definition. A switch fires only once; afterwards its event function stays at 1.

use super::onset::{FAR, Onset};
use super::{AppliedForces, NEVER};
use crate::expression::choose;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph, Symbol};
use crate::model::{Active, Model, Trigger};
use crate::motion::numbers::number;
use crate::motion::numbers::time;

/// The border between times that have come and [`NEVER`] \[s\].
const EVER: f64 = 0.5 * NEVER;

/// The memory of one switch.
#[derive(Clone, Copy)]
pub struct Remembered<'g> {
    /// Index in m of the time at which the switch fired.
    fired: usize,
    /// Index in m of the time from which on the switch acts; equal to `fired` if there is no delay.
    acts: usize,
    /// The time from which on the switch acts, [`NEVER`] before \[s\].
    pub since: Expr<'g>,
}

impl<'g> Remembered<'g> {
    /// `then` while the switch acts, `otherwise` before.
    pub fn once(self, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
        let ever = then.graph().constant(EVER);
        choose(self.since, ever, then, otherwise)
    }
}

/// The switches that begin and end the action of a force.
#[derive(Clone, Copy, Default)]
pub struct Gate<'g> {
    since: Option<Remembered<'g>>,
    until: Option<Remembered<'g>>,
}

impl<'g> Gate<'g> {
    /// The value while the force acts, else 0.
    pub fn of(self, value: Expr<'g>) -> Expr<'g> {
        self.either(value, value.graph().constant(0.0))
    }

    /// The value while the force acts, else another one.
    pub fn either(self, value: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
        let value = self
            .since
            .map_or(value, |switch| switch.once(value, otherwise));
        self.until
            .map_or(value, |switch| switch.once(otherwise, value))
    }

    /// The onset of a law, with the gap [`FAR`] while the force does not act.
    pub fn of_onset(self, onset: Onset<'g>) -> Onset<'g> {
        let graph = onset.gap.graph();
        let far = graph.constant(FAR);
        Onset {
            gap: self.either(onset.gap, far),
            speed: self.of(onset.speed),
        }
    }

    /// True if the force waits for a switch, or ends with one.
    pub fn waits(self) -> bool {
        self.since.is_some() || self.until.is_some()
    }

    /// The vector while the force acts, else 0.
    pub fn of_vector(self, vector: Vec3<'g>) -> Vec3<'g> {
        Vec3(vector.0.map(|component| self.of(component)))
    }
}

impl<'g> AppliedForces<'g> {
    /// Adds the memory of all switches. [`complete`] sets how the memory changes, once the quantities that trigger the
    /// switches are derived.
    pub(crate) fn declare_switches(&mut self, graph: &'g Graph, model: &Model) {
        for switch in &model.switches {
            let never = graph.constant(NEVER);
            let (fired, since) = self.memory(format!("switch {}: fired", switch.name), "s", never);
            let (acts, since) = match &switch.after {
                Some(_) => self.memory(format!("switch {}: acts", switch.name), "s", never),
                None => (fired, since),
            };
            self.states.switches.push(Remembered { fired, acts, since });
        }
    }

    /// The gate of a force that is active only between given switches.
    pub(crate) fn gate(&self, active: Active) -> Gate<'g> {
        let switch = |index: Option<usize>| index.map(|index| self.states.switches[index]);
        Gate {
            since: switch(active.since),
            until: switch(active.until),
        }
    }
}

/// Sets how the memory of the switches changes. `quantities` are the trigger quantities, by switch; a switch at a time
/// needs none.
pub fn complete<'g>(
    graph: &'g Graph,
    model: &Model,
    applied: &mut AppliedForces<'g>,
    quantities: &[Option<Expr<'g>>],
) {
    let (zero, one, ever) = (
        graph.constant(0.0),
        graph.constant(1.0),
        graph.constant(EVER),
    );
    let now = time(graph);
    for (index, switch) in model.switches.iter().enumerate() {
        graph.section(format!("switch {}", switch.name));
        let Remembered { fired, acts, .. } = applied.states.switches[index];
        let memory = |index: usize| graph.symbol(Symbol::Memory(index as u32));
        // an event function stays at 1 once its time has come
        let waiting = |index: usize, event_function: Expr<'g>| {
            choose(memory(index), ever, one, event_function)
        };
        let above = |threshold, quantity: Option<Expr<'g>>| {
            number(graph, threshold) - quantity.unwrap_or(zero)
        };
        // a time fires when it is reached, a threshold only when it is exceeded
        let (event_function, inclusive) = match &switch.trigger {
            Trigger::Time(time) => (number(graph, time) - now, true),
            Trigger::Above(_, threshold) => (above(threshold, quantities[index]), false),
            Trigger::Below(_, threshold) => (-above(threshold, quantities[index]), false),
        };
        let event_function = waiting(fired, event_function);
        applied.states.memory[fired].next = match inclusive {
            true => choose(zero, event_function, memory(fired), now),
            false => choose(event_function, zero, now, memory(fired)),
        };
        applied.event_function(format!("switch {}: fires", switch.name), event_function);
        if let Some(after) = &switch.after {
            let event_function = waiting(acts, memory(fired) + number(graph, after) - now);
            applied.states.memory[acts].next = choose(zero, event_function, memory(acts), now);
            applied.event_function(format!("switch {}: acts", switch.name), event_function);
        }
    }
}
