//! Switches: what happens once in a run, and what waits for it.

use super::{Digested, Number, Quantity};
use std::fmt;

/// Something that fires once in a run and from then on has fired.
#[derive(Clone, PartialEq)]
pub struct Switch {
    /// Name, unique among the switches.
    pub name: String,
    /// What makes it fire.
    pub trigger: Trigger,
    /// Time between its firing and its effect \[s\], not negative; none is 0.
    pub after: Option<Number>,
    /// The unit in which its threshold is written, and its SI value.
    pub shown: (String, f64),
}

/// The digest of a model is made of this, in which a unit leaves no trace.
impl fmt::Debug for Switch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Switch")
            .field("name", &self.name)
            .field("trigger", &self.trigger)
            .field("after", &self.after)
            .finish()
    }
}

/// What makes a switch fire.
#[derive(Clone, PartialEq)]
pub enum Trigger {
    /// A time is reached \[s\].
    Time(Number),
    /// A quantity is larger than this, at the start or later.
    Above(Quantity, Number),
    /// A quantity is smaller than this.
    Below(Quantity, Number),
}

/// The digest of a model is made of this.
impl fmt::Debug for Trigger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, quantity, threshold) = match self {
            Trigger::Time(time) => return f.debug_tuple("Time").field(time).finish(),
            Trigger::Above(quantity, threshold) => ("Above", quantity, threshold),
            Trigger::Below(quantity, threshold) => ("Below", quantity, threshold),
        };
        let mut text = f.debug_tuple(name);
        text.field(&Digested(quantity)).field(threshold).finish()
    }
}

/// When a force acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Active {
    /// From this switch on: index into [`Model::switches`](super::Model::switches).
    pub since: Option<usize>,
    /// Up to this one.
    pub until: Option<usize>,
}

/// Of a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SwitchQuantity {
    /// 1 once it acts, 0 before.
    Acts,
    /// The time from which on it acts \[s\], −1 before.
    Time,
}

impl Trigger {
    /// The quantity that it looks at.
    pub fn quantity(&self) -> Option<&Quantity> {
        match self {
            Trigger::Time(_) => None,
            Trigger::Above(quantity, _) | Trigger::Below(quantity, _) => Some(quantity),
        }
    }

    /// The quantity that it looks at, to renumber what it belongs to.
    pub fn quantity_mut(&mut self) -> Option<&mut Quantity> {
        match self {
            Trigger::Time(_) => None,
            Trigger::Above(quantity, _) | Trigger::Below(quantity, _) => Some(quantity),
        }
    }
}
