//! Switches: events that happen at most once in a run, and the forces that wait for them.

use super::number::Number;
use super::quantity::Quantity;
use serde::Serialize;

/// An event that fires at most once in a run, and has fired from then on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Switch {
    /// Name, unique among the switches.
    pub name: String,
    /// The condition that makes the switch fire.
    pub trigger: Trigger,
    /// Time between firing and taking effect \[s\], not negative; `None` for 0.
    pub after: Option<Number>,
    /// The unit in which the threshold is written, and the SI value of this unit.
    #[serde(skip)]
    pub shown: (String, f64),
}

/// The condition that makes a switch fire.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Trigger {
    /// A time is reached \[s\].
    Time(Number),
    /// A quantity is larger than this, at the start or later.
    Above(Quantity, Number),
    /// A quantity is smaller than this, at the start or later.
    Below(Quantity, Number),
}

/// The time during which a force acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Active {
    /// The force acts from this switch on: index into [`Model::switches`](super::Model::switches).
    pub since: Option<usize>,
    /// The force acts up to this switch: index as above.
    pub until: Option<usize>,
}

impl Trigger {
    /// The quantity that the trigger observes.
    pub fn quantity(&self) -> Option<&Quantity> {
        match self {
            Trigger::Time(_) => None,
            Trigger::Above(quantity, _) | Trigger::Below(quantity, _) => Some(quantity),
        }
    }

    /// Like [`quantity`](Self::quantity), mutable: to renumber what the quantity refers to.
    pub fn quantity_mut(&mut self) -> Option<&mut Quantity> {
        match self {
            Trigger::Time(_) => None,
            Trigger::Above(quantity, _) | Trigger::Below(quantity, _) => Some(quantity),
        }
    }
}
