//! A run: from the initial state to the duration, sampled at 0, every, 2·every … duration.
//!
//! Steps end on every kink of a curve of time ([`Info::breakpoints`](crate::Info::breakpoints)), for an error estimate assumes a smooth
//! derivative. Fixed steps also end on every sample; steps under control of their error are chosen freely, and samples are
//! interpolated. A step ends where a guard of the model changes its sign ([`Model::guards`]), and, where asked to, on kinks of
//! force laws ([`Model::kinks`]). After each accepted step the memory of force laws is renewed.

mod balance;
mod event;
mod methods;
mod once;
#[cfg(test)]
mod orders;
mod run;
mod schedule;
mod settings;
#[cfg(test)]
mod tests;
mod watch;

pub use balance::{Balance, Momentum};
#[cfg(feature = "std")]
pub(crate) use methods::UsualMethods;
pub(crate) use methods::{AllMethods, Methods};
pub use settings::{Adaptive, Method, Pace, Settings};
pub(crate) use watch::Beyond;
#[cfg(feature = "std")]
pub(crate) use watch::Time;
pub use watch::{Doubt, ENERGY_LIMIT, Left, Suspicion, Watch};

use crate::failure::{Culprit, Failure, Quantity, Reason};
use crate::integrate::first_non_finite;
use crate::{Model, Real};
use core::ops::ControlFlow;
#[cfg(feature = "std")]
pub(crate) use event::Zero;
#[cfg(feature = "std")]
pub(crate) use run::{EASY, SEARCHES, finest};
use run::{End, Run};

/// The state at a sampling time.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a, S, O> {
    /// Time \[s\]: exactly i · every, and exactly the duration for the last.
    pub t: f64,
    /// The state, on its manifold.
    pub state: &'a S,
    /// The outputs, in the order and units of [`Info::outputs`](crate::Info::outputs).
    pub outputs: &'a O,
}

/// What a run took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Time reached \[s\]: the duration, unless the receiver of the samples asked to stop.
    pub t: f64,
    /// Steps accepted.
    pub steps: u64,
    /// Steps rejected.
    pub rejected: u64,
    /// Evaluations of the derivative.
    pub evaluations: u64,
    /// Jacobians of the Rosenbrock method, each as many evaluations over dual numbers as the state has entries, and one.
    pub jacobians: u64,
    /// Changes of sign of guards at which a step ended, and kinks that were approached and crossed.
    pub events: u64,
    /// Samples delivered.
    pub samples: u64,
    /// Smallest step accepted \[s\].
    pub smallest_step: f64,
    /// Where it begins \[s\].
    pub smallest_step_at: f64,
    /// What forced it.
    pub smallest_step_for: Cause,
    /// Largest step accepted \[s\].
    pub largest_step: f64,
}

/// What decided the length of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// It is the first, whose length is a guess.
    First,
    /// The tolerance, most of all that of this entry of the state.
    Tolerance(usize),
    /// The largest step allowed.
    Largest,
    /// Steps are fixed.
    Fixed,
    /// A kink of a curve of time.
    Breakpoint,
    /// A sample, on which fixed steps end.
    Sample,
    /// A kink of a force law, by its index in [`Info::kinks`](crate::Info::kinks).
    Kink(usize),
    /// A guard, by its index in [`Info::guards`](crate::Info::guards).
    Guard(usize),
    /// The end of the run.
    End,
}

/// Runs a model from its initial state.
///
/// # Errors
/// Settings that make no sense; a state that ceases to be finite; a step below the smallest; too many steps. All samples
/// before have been delivered.
#[inline(always)]
pub fn simulate<T: Real, M: Model<T>>(
    model: &M,
    settings: &Settings,
    sink: &mut impl FnMut(Sample<'_, M::State, M::Outputs>),
) -> Result<Report, Failure> {
    simulate_from(model, model.initial_state(), settings, &mut |sample| {
        sink(sample);
        ControlFlow::Continue(())
    })
}

/// Runs a model from any state, until the end or until the receiver of the samples breaks off.
///
/// # Errors
/// As [`simulate`].
#[inline(always)]
pub fn simulate_from<T: Real, M: Model<T>>(
    model: &M,
    initial: M::State,
    settings: &Settings,
    sink: &mut impl FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
) -> Result<Report, Failure> {
    run_from::<AllMethods, T, M>(model, initial, settings, None, sink)
}

/// [`simulate_from`], watched: where the energy went and whether the run can be trusted. It takes three evaluations of the powers
/// more for each step. What is found is that of the time reached, of a failed run too.
///
/// # Errors
/// As [`simulate`].
#[inline(always)]
pub fn simulate_watched<T: Real, M: Model<T>>(
    model: &M,
    initial: M::State,
    settings: &Settings,
    watch: &mut Watch<T, M>,
    sink: &mut impl FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
) -> Result<Report, Failure> {
    run_from::<AllMethods, T, M>(model, initial, settings, Some(watch), sink)
}

/// Any of them.
#[inline(always)]
pub(crate) fn run_from<C: Methods, T: Real, M: Model<T>>(
    model: &M,
    initial: M::State,
    settings: &Settings,
    watch: Option<&mut Watch<T, M>>,
    sink: &mut impl FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
) -> Result<Report, Failure> {
    let fail = |reason| Failure {
        t: 0.0,
        reason,
        info: M::INFO,
    };
    settings
        .check()
        .map_err(|setting| fail(Reason::InvalidSettings(setting)))?;
    if let Some(index) = first_non_finite(&initial) {
        let of = Quantity::InitialState;
        return Err(fail(Reason::NonFinite {
            index,
            of,
            output: None,
            culprit: Culprit::Unknown,
        }));
    }
    let mut run = Run::new(model, initial, settings, watch, sink);
    let end = C::go(&mut run);
    let report = run.report();
    match end {
        Ok(()) | Err(End::Stopped) => Ok(report),
        Err(End::Failed(reason)) => Err(Failure {
            t: report.t,
            reason,
            info: M::INFO,
        }),
    }
}
