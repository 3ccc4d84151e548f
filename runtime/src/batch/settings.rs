//! How to run.

use crate::integrate::control::Tolerances;

/// How to run, the same for every scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Length of a run \[s\].
    pub duration: f64,
    /// Samples of a run, the first at its beginning and the last at its end: two at least.
    pub samples: usize,
    /// How long steps are.
    pub pace: Pace,
    /// Whether steps end where force laws have kinks.
    pub locate: bool,
    /// Limit on the steps of a run, accepted and rejected.
    pub max_steps: u32,
}

/// How long steps are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// At most so long \[s\].
    Fixed(f64),
    /// As the tolerances allow.
    Adaptive(Tolerances),
}
