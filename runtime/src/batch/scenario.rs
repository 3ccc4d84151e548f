//! What runs, and what became of it.

/// Scenarios to run, and who hears of them.
pub trait Scenarios<S> {
    /// How many there are.
    fn count(&self) -> usize;
    /// A parameter of a scenario, by its index in [`Info::parameters`](crate::Info::parameters).
    fn parameter(&self, scenario: usize, index: usize) -> S;
    /// What the tolerances, or the length of fixed steps, are multiplied by in a scenario.
    fn level(&self, scenario: usize) -> f64;
    /// Which outputs are sampled, by their index in [`Info::outputs`](crate::Info::outputs).
    fn outputs(&self) -> &[usize];
    /// A scenario came to its end.
    fn ended(&mut self, scenario: usize, ended: &Ended, series: &Series<S>);
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// Whether it reached its end.
    pub status: Status,
    /// Time reached \[s\].
    pub t: f64,
    /// Steps accepted.
    pub steps: u32,
    /// Steps rejected.
    pub rejected: u32,
}

/// Whether a run reached its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It did.
    Done,
    /// The state, its derivative or an output is not finite.
    NonFinite,
    /// The error asks for a step below the smallest.
    StepTooSmall,
    /// The limit on steps was reached.
    TooManySteps,
    /// Its parameters make something of the model that cannot be.
    Refused,
}

/// What was sampled of a run: the samples of each output, those after a failure NaN.
#[derive(Clone, Debug)]
pub struct Series<S> {
    pub(super) samples: usize,
    pub(super) values: Vec<S>,
}

impl<S> Series<S> {
    /// Those of an output, by its place in [`Scenarios::outputs`].
    pub fn of(&self, output: usize) -> &[S] {
        let start = output * self.samples;
        self.values.get(start..start + self.samples).unwrap_or(&[])
    }
}
