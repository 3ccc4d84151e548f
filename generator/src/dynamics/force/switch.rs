//! Switches: two times that are remembered, that at which a switch fired and that from which on it acts.
//!
//! fired ← t where the trigger's event function G < 0 after an accepted step,   acts ← t where t ≥ fired + delay
//!
//! G is positive until the quantity passes its threshold: the change of its sign ends a step, which so ends at the crossing.
//! Both times are held during a step, and a force that waits for a switch never jumps inside of one. A quantity that
//! itself depends on the switch, such as an acceleration, is therefore no circle. What has happened has happened: a switch
//! does not fire again, and its event function rests at 1.

use super::onset::{FAR, Onset};
use super::{AppliedForces, NEVER, choose};
use crate::dynamics::numbers::number;
use crate::dynamics::time;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph, Symbol};
use crate::model::{Active, Model, Trigger};

/// Times before this have come, those beyond are [`NEVER`] \[s\].
const EVER: f64 = 0.5 * NEVER;

/// The memory of one switch.
#[derive(Clone, Copy)]
pub struct Remembered<'g> {
    /// Index of the time at which it fired.
    fired: usize,
    /// Index of the time from which on it acts: the same without a delay.
    acts: usize,
    /// The time from which on it acts, [`NEVER`] before \[s\].
    pub since: Expr<'g>,
}

impl<'g> Remembered<'g> {
    /// `then` once it acts, `otherwise` before.
    pub fn once(self, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
        let ever = then.graph().constant(EVER);
        choose(self.since, ever, then, otherwise)
    }
}

/// Whether a force acts.
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

    /// The onset of a law while the force acts; else nothing begins.
    pub fn of_onset(self, onset: Onset<'g>) -> Onset<'g> {
        let graph = onset.gap.graph();
        let far = graph.constant(FAR);
        Onset {
            gap: self.either(onset.gap, far),
            speed: self.of(onset.speed),
        }
    }

    /// Whether it waits for a switch, or ends with one.
    pub fn waits(self) -> bool {
        self.since.is_some() || self.until.is_some()
    }

    /// The vector while the force acts, else 0.
    pub fn of_vector(self, vector: Vec3<'g>) -> Vec3<'g> {
        Vec3(vector.0.map(|component| self.of(component)))
    }
}

impl<'g> AppliedForces<'g> {
    /// Makes room for the memory of all switches; what it becomes is said by [`complete`], once the quantities are known
    /// that they wait for.
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

    /// Whether what acts only at certain times acts.
    pub(crate) fn gate(&self, active: Active) -> Gate<'g> {
        let switch = |index: Option<usize>| index.map(|index| self.states.switches[index]);
        Gate {
            since: switch(active.since),
            until: switch(active.until),
        }
    }
}

/// Says when switches fire. `quantities` are those that their triggers look at, by switch; anything for a time.
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
        // rests at 1 once it has come
        let waiting = |index: usize, event_function: Expr<'g>| {
            choose(memory(index), ever, one, event_function)
        };
        let above = |threshold, quantity: Option<Expr<'g>>| {
            number(graph, threshold) - quantity.unwrap_or(zero)
        };
        // a time has come where it is reached, a threshold is passed where it is left behind
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
