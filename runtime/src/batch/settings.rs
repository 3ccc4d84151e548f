//! The settings of a batch.

use crate::Formula;
use crate::integrate::control::Tolerances;
use std::time::Duration;

/// Settings for all scenarios of a batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Length of a run \[s\].
    pub duration: f64,
    /// Number of samples of a run, the first at its start and the last at its end: at least two.
    pub samples: usize,
    /// The length of steps.
    pub pace: Pace,
    /// Whether steps end where force laws have kinks.
    pub locate: bool,
    /// Limit on the steps of a run, accepted and rejected.
    pub max_steps: u32,
    /// Limit on the computing time of a run, whichever lane it is in. A run that would take ten times as long at its
    /// current rate is given up earlier.
    pub time_limit: Option<Duration>,
    /// Share of energy and of momentum that may be missing where steps are fixed
    /// ([`ENERGY_LIMIT`](crate::simulate::ENERGY_LIMIT)); +∞ for any.
    pub energy_limit: f64,
}

/// The length of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// Steps of equal length between two kinks in time.
    Fixed(Fixed),
    /// Steps as long as the tolerances allow, by Dormand & Prince's pair 5(4).
    Adaptive(Tolerances),
}

/// Steps of one length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed {
    /// The formula of a step.
    pub method: LaneFormula,
    /// Largest length \[s\]: steps are shortened evenly so that they end on kinks in time. Samples lie within steps.
    pub step: f64,
}

/// The formulas for the steps of lanes: explicit ones with at most seven stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneFormula {
    /// [`Formula::Heun`]
    Heun,
    /// [`Formula::Rk4`]
    Rk4,
    /// [`Formula::Merson`]
    Merson,
    /// [`Formula::Dopri5`]
    Dopri5,
}

impl LaneFormula {
    /// All of them, by order.
    pub const ALL: [LaneFormula; 4] = [
        LaneFormula::Heun,
        LaneFormula::Rk4,
        LaneFormula::Merson,
        LaneFormula::Dopri5,
    ];

    /// The same formula in single runs.
    pub const fn formula(self) -> Formula {
        match self {
            LaneFormula::Heun => Formula::Heun,
            LaneFormula::Rk4 => Formula::Rk4,
            LaneFormula::Merson => Formula::Merson,
            LaneFormula::Dopri5 => Formula::Dopri5,
        }
    }

    /// The formula of this name.
    pub fn named(name: &str) -> Option<LaneFormula> {
        let mut all = Self::ALL.into_iter();
        all.find(|method| method.formula().name() == name)
    }

    /// Whether the derivative at the end of a step is its last stage.
    pub(super) const fn ends_with_its_rate(self) -> bool {
        matches!(self, LaneFormula::Dopri5)
    }
}

impl Pace {
    /// The formula of its steps.
    pub const fn method(&self) -> LaneFormula {
        match self {
            Pace::Fixed(fixed) => fixed.method,
            Pace::Adaptive(_) => LaneFormula::Dopri5,
        }
    }
}
