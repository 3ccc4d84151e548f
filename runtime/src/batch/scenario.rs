//! The scenarios of a batch, and how each run ended.

use crate::Real;
use crate::response::Jump;

/// The scenarios of a batch, and the receiver of their results.
pub trait Scenarios<S> {
    /// The number of scenarios.
    fn count(&self) -> usize;
    /// A parameter of a scenario, by its index in [`Info::parameters`](crate::Info::parameters).
    fn parameter(&self, scenario: usize, index: usize) -> S;
    /// The factor on the tolerances of a scenario, or on the length of its fixed steps.
    fn level(&self, scenario: usize) -> f64;
    /// Whether the errors of accelerations are controlled in a scenario
    /// ([`Tolerances::accelerations`](crate::Tolerances::accelerations)). Without this control a run takes about a
    /// tenth less time if forces are stiff.
    fn controls_accelerations(&self, scenario: usize) -> bool {
        let _ = scenario;
        true
    }
    /// The outputs to sample, by their index in [`Info::outputs`](crate::Info::outputs).
    fn outputs(&self) -> &[usize];
    /// Whether the outputs are requested on both sides of each event, where they may jump, for [`Series::jumps_of`].
    /// This takes two evaluations of the outputs for each event.
    fn wants_jumps(&self) -> bool {
        false
    }
    /// Whether to give up a scenario after this number of steps, with rejected ones. This is called once every
    /// [`STEPS_BETWEEN`](super::STEPS_BETWEEN) steps. A scenario that is given up ends as [`Status::TooManySteps`].
    fn gives_up(&self, _scenario: usize, _steps: u64) -> bool {
        false
    }
    /// Is called every ten seconds while a scenario is computed, with the seconds that this has taken and the time `t`
    /// of its run \[s\].
    fn lingers(&mut self, _scenario: usize, _seconds: f64, _t: f64) {}
    /// Is called when a scenario has ended.
    fn ended(&mut self, scenario: usize, ended: &Ended, series: &Series<S>);
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// How the run ended.
    pub status: Status,
    /// Time reached \[s\].
    pub t: f64,
    /// Steps accepted.
    pub steps: u32,
    /// Steps rejected.
    pub rejected: u32,
    /// The length of the next step, had the run gone on \[s\].
    pub step: f64,
    /// Why a run that reached its end cannot be trusted. In a run that did not, [`Doubt::Unstable`] if its steps were
    /// unstable.
    pub doubt: Option<Doubt>,
}

/// Why a run that reached its end cannot be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// A joint was bent through 180°, where flexion has no direction, or a bushing or a joint with laws about x, y and
    /// z turned through ±90° about y: its bearing, an index in [`Info::curves`](crate::Info::curves).
    Bent(usize),
    /// Two ellipsoids sank into each other until the direction of their force jumped: this direction, an index in
    /// [`Info::curves`](crate::Info::curves).
    Sunk(usize),
    /// A fixed step passed over an event that begins and ends within the step: an index in
    /// [`Info::onsets`](crate::Info::onsets).
    Missed(usize),
    /// The argument of a curve was so far outside of its points, while its force acted, that the value of the curve is
    /// made up: an index in [`Info::curves`](crate::Info::curves).
    Left(usize),
    /// Fixed steps are above the limit of stability: the entry of the state that the fastest motion moves most.
    Unstable(usize),
    /// The gap in the balance of energy is above the [limit](super::Settings::energy_limit), with fixed steps: the
    /// effect whose power was largest when the gap began, an index in [`Info::powers`](crate::Info::powers).
    Energy(Option<usize>),
    /// The gap in the balance of momentum of freely moving bodies is above the limit, with fixed steps.
    Momentum,
    /// The estimated error of fixed steps is too large: the entry of the state whose error was largest when this began.
    Error(usize),
    /// Several events happened at the same time, but depend differently on parameters: derivatives are unknown there,
    /// though the values are known.
    Tied,
}

/// Whether a run reached its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The run reached its end.
    Done,
    /// The state, its derivative or an output is not finite.
    NonFinite,
    /// The tolerance asks for a step below the smallest allowed.
    StepTooSmall,
    /// The limit on the number of steps was reached.
    TooManySteps,
    /// The run reached its end, but cannot be trusted: see [`Ended::doubt`].
    Doubtful,
    /// The model does not allow its parameters.
    Refused,
    /// The computation took too long, or would have taken too long at its rate:
    /// [`Settings::time_limit`](super::Settings::time_limit).
    Slow,
}

/// The samples of each output of a run, NaN after a failure, and the events of the run.
#[derive(Clone, Debug)]
pub struct Series<S> {
    pub(super) samples: usize,
    pub(super) values: Vec<S>,
    /// The time of each event \[s\].
    pub(super) events: Vec<S>,
    /// Event by event, each output just before and just after it.
    pub(super) sides: Vec<[S; 2]>,
}

impl<S> Series<S> {
    /// The samples of an output, by its place in [`Scenarios::outputs`].
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
    /// An output, by its place in [`Scenarios::outputs`], on both sides of each event. Events are kinks of curves of
    /// time, zeros of event functions, and kinks of force laws if these are [located](super::Settings::locate). There
    /// are none unless the scenarios [request](Scenarios::wants_jumps) them. An event is left out where the output or
    /// its derivative is not finite: the derivative of a root is infinite where the root begins.
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
