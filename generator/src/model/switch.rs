//! Switches: what happens once in a run, and what waits for it.

use super::{Number, Quantity};
use serde::Serialize;

/// Something that fires once in a run and from then on has fired.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Switch {
    /// Name, unique among the switches.
    pub name: String,
    /// What makes it fire.
    pub trigger: Trigger,
    /// Time between its firing and its effect \[s\], not negative; none is 0.
    pub after: Option<Number>,
    /// The unit in which its threshold is written, and its SI value.
    #[serde(skip)]
    pub shown: (String, f64),
}

/// What makes a switch fire.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Trigger {
    /// A time is reached \[s\].
    Time(Number),
    /// A quantity is larger than this, at the start or later.
    Above(Quantity, Number),
    /// A quantity is smaller than this.
    Below(Quantity, Number),
}

/// When a force acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Active {
    /// From this switch on: index into [`Model::switches`](super::Model::switches).
    pub since: Option<usize>,
    /// Up to this one.
    pub until: Option<usize>,
}

/// Of a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
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
