//! What runs, and what became of it.

use crate::Real;
use crate::response::Jump;

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
    /// Whether outputs are wanted on both sides of each event, where they may jump: what [`Series::jumps_of`] has. It takes two
    /// evaluations of the outputs for each.
    fn wants_jumps(&self) -> bool {
        false
    }
    /// Whether a scenario that has taken so many steps, rejected ones too, is given up. It is asked once every
    /// [`STEPS_BETWEEN`](super::STEPS_BETWEEN) steps, and ends as [`Status::TooManySteps`].
    fn gives_up(&self, _scenario: usize, _steps: u64) -> bool {
        false
    }
    /// The computation of a scenario has taken some seconds, and its run has come to the time `t` \[s\]: it is told every ten seconds.
    fn lingers(&mut self, _scenario: usize, _seconds: f64, _t: f64) {}
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
    /// The step that would have come next \[s\].
    pub step: f64,
    /// Why a run that reached its end cannot be trusted; or of one that did not, that its steps were unstable.
    pub doubt: Option<Doubt>,
}

/// Why a run that reached its end cannot be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// A joint was bent through 180°, where flexion has no direction: its bearing, an index in [`Info::curves`](crate::Info::curves).
    Bent(usize),
    /// Two ellipsoids sank into each other until the direction of their force leapt: that direction, an index in
    /// [`Info::curves`](crate::Info::curves).
    Sunk(usize),
    /// A fixed step went over what begins and ends within it: a law, by its index in [`Info::onsets`](crate::Info::onsets).
    Missed(usize),
    /// A curve was left so far, while its force acted, that what it gives is made up: an index in [`Info::curves`](crate::Info::curves).
    Left(usize),
    /// Fixed steps are above the limit of stability: the entry of the state that moves most.
    Unstable(usize),
    /// More energy is missing in its balance than [may](super::Settings::energy_limit), where steps are fixed: the effect whose power was largest
    /// when that began, an index in [`Info::powers`](crate::Info::powers).
    Energy(Option<usize>),
    /// The same of the momentum of what moves freely.
    Momentum,
    /// Fixed steps err by too much, as estimated along with them: the entry of the state that was farthest off when this began.
    Error(usize),
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
    /// To its end, but not to be trusted: see [`Ended::doubt`].
    Doubtful,
    /// Its parameters make something of the model that cannot be.
    Refused,
    /// Computing it took too long, or would have at its rate: [`Settings::time_limit`](super::Settings::time_limit).
    Slow,
}

/// What was sampled of a run: the samples of each output, those after a failure NaN, and its events.
#[derive(Clone, Debug)]
pub struct Series<S> {
    pub(super) samples: usize,
    pub(super) values: Vec<S>,
    /// When each event was \[s\].
    pub(super) events: Vec<S>,
    /// Event by event, each output ahead of it and behind.
    pub(super) sides: Vec<[S; 2]>,
}

impl<S> Series<S> {
    /// Those of an output, by its place in [`Scenarios::outputs`].
    pub fn of(&self, output: usize) -> &[S] {
        let start = output * self.samples;
        self.values.get(start..start + self.samples).unwrap_or(&[])
    }

    pub(super) fn forget_jumps(&mut self) {
        self.events.clear();
        self.sides.clear();
    }
}

impl<S: Real> Series<S> {
    /// An output, by its place in [`Scenarios::outputs`], on both sides of each event: where a curve of time has a kink, a guard changed
    /// its sign, or a kink of a force law where such are [located](super::Settings::locate). None unless the scenarios [want](Scenarios::wants_jumps)
    /// them, and not where an output or its derivative is not finite just there, as that of a root is where it begins.
    pub fn jumps_of(&self, output: usize) -> impl Iterator<Item = Jump<S>> {
        let outputs = self.sides.len() / self.events.len().max(1);
        let sides = self.sides.iter().skip(output).step_by(outputs.max(1));
        let events = self.events.iter().zip(sides);
        let jumps = events.map(|(t, [before, after])| Jump {
            t: *t,
            before: *before,
            after: *after,
        });
        jumps.filter(|Jump { t, before, after }| [t, before, after].iter().all(|x| x.is_finite()))
    }
}
