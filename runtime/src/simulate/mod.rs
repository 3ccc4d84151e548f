//! A run: integrates a model from its initial state to the duration. It delivers samples at the start, at every
//! multiple of `every`, and at the duration.
//!
//! Steps end on every kink of a curve of time ([`Info::breakpoints`](crate::Info::breakpoints)), because an error
//! estimate assumes a smooth derivative. Fixed steps also end on every sample. Steps under error control are chosen
//! freely, and samples are interpolated. A step also ends where an event function of the model changes its sign
//! ([`Model::event_functions`]), and, if the settings ask for it, on kinks of force laws ([`Model::kinks`]). After each
//! accepted step the memory of force laws is renewed.
//!
//! **Two time loops.** A batch (`crate::batch`) has a time loop of its own. Both loops share the parts that decide
//! something: the controller and the first step (`integrate::control`), how a step meets a time (`schedule`), where an
//! event function changes its sign and what hides within a step (`event`, `excursion`), which contacts a step may pass
//! over (`onset`), when a balance does not close (`watch::account`), and what is evaluated where a step ends
//! ([`Dynamics::sections`]). The shared parts either compute with a number type, which is `f64` here and a register in
//! a batch, or they ask for values and are told them. The loops around them differ. In a batch, lanes use selection
//! where a run branches; they take scenarios one after the other, pack places of several lanes into one register, and
//! carry derivatives of event times. A run takes any scalar, implicit steppers and up to sixteen stages; it approaches
//! kinks, reports what decided the length of its steps, can be left and entered again, and needs no allocator. A common
//! loop would have to do all of this with masks, also for scalars that are no lanes.

pub(crate) mod balance;
mod diagnostic;
mod driven_model;
mod event;
pub(crate) mod excursion;
pub(crate) mod onset;
mod run;
mod schedule;
mod settings;
pub(crate) mod stuck_events;
mod time_loop;
pub(crate) mod watch;

pub use crate::integrate::workspace::Buffer;
pub use balance::{Balance, Momentum};
pub(crate) use diagnostic::OutOfRange;
#[cfg(feature = "std")]
pub(crate) use diagnostic::Time;
pub use diagnostic::{Diagnostic, Problem};
pub use settings::{Adaptive, Integrator, Pace, Settings};
pub(crate) use time_loop::epsilon_of;
#[cfg(feature = "std")]
pub use watch::History;
pub use watch::{ENERGY_LIMIT, Left, Watch};

use crate::failure::Failure;
#[cfg(feature = "std")]
use crate::{Differentiable, Direct, Model};
use crate::{Dynamics, Info, Real};
use core::ops::ControlFlow;
pub use driven_model::Driven;
#[cfg(feature = "std")]
pub(crate) use event::{Bracket, StepValues, WIDTH, Zero, change, opposite};
pub use run::Run;
#[cfg(feature = "std")]
pub(crate) use schedule::{count_steps, to_meet};
#[cfg(feature = "std")]
pub(crate) use time_loop::{EASY, SEARCHES, finest};

/// The state at a sampling time.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a, T> {
    /// Time \[s\]: exactly i · every, and exactly the duration for the last.
    pub t: f64,
    /// The state, on its manifold: q, v, z, m, named by [`Info::state_name`].
    pub state: &'a [T],
    /// The outputs, in the order and units of [`Info::outputs`].
    pub outputs: &'a [T],
    /// The purpose of the sample.
    pub kind: SampleKind,
}

/// The purpose of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleKind {
    /// A row: at the start, at a multiple of [`Settings::every`], or at the end. All its numbers are finite.
    Row,
    /// A sample at the end of a [part](Settings::parts), or at the start. Its outputs may be NaN or infinite.
    Part,
}

/// Receives the samples of a run, and may break the run off.
pub type Receiver<'a, T> = dyn FnMut(Sample<'_, T>) -> ControlFlow<()> + 'a;

/// Is called before every try of a step with the time reached \[s\], and may stop the run.
pub type Observer<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// Statistics of a run.
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
    /// Jacobians evaluated for the Rosenbrock method. Each takes one evaluation over dual numbers per entry of the
    /// state, and one more.
    pub jacobians: u64,
    /// Events: steps that ended at a sign change of an event function, and kinks that were approached and crossed.
    pub events: u64,
    /// Samples delivered, without those at the ends of [parts](Settings::parts).
    pub samples: u64,
    /// Steps accepted with the Rosenbrock method after the run changed to it because the scene is stiff.
    pub stiff: u64,
    /// Smallest step accepted \[s\].
    pub smallest_step: f64,
    /// Time at which the smallest step begins \[s\].
    pub smallest_step_at: f64,
    /// What forced the smallest step.
    pub smallest_step_for: Cause,
    /// Largest step accepted \[s\].
    pub largest_step: f64,
}

/// What decided the length of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The step is the first one; its length is a guess.
    First,
    /// The error tolerance; the entry of the state with this index had the largest error.
    Tolerance(usize),
    /// The largest step allowed.
    Largest,
    /// Steps are fixed.
    Fixed,
    /// A kink of a curve of time.
    Breakpoint,
    /// A sample; fixed steps end on samples.
    Sample,
    /// A kink of a force law, by its index in [`Info::kinks`](crate::Info::kinks).
    Kink(usize),
    /// An event function, by its index in [`Info::event_functions`](crate::Info::event_functions).
    EventFunction(usize),
    /// The end of the run.
    End,
}

/// Runs a model from its initial state.
///
/// The method may be any but [`Formula::Rodas5`](crate::Formula::Rodas5): see [`simulate_stiff`].
///
/// # Errors
/// Invalid settings; a state that ceases to be finite; a step below the smallest; too many steps. All samples before
/// the failure have been delivered.
#[cfg(feature = "std")]
pub fn simulate<T: Real, M: Model<T>>(
    model: &M,
    settings: &Settings,
    sink: &mut impl FnMut(Sample<'_, T>),
) -> Result<Report, Failure<'static>> {
    let start = model.initial_state();
    let mut sink = to_the_end(sink);
    let model = Direct(model);
    let run = run(&model, start.as_ref(), settings, None, &mut sink);
    run.map_err(|failure| failure.with_info(M::INFO))
}

/// A receiver of samples that never breaks off.
#[cfg(feature = "std")]
fn to_the_end<T: Real>(
    sink: &mut impl FnMut(Sample<'_, T>),
) -> impl FnMut(Sample<'_, T>) -> ControlFlow<()> {
    |sample| {
        sink(sample);
        ControlFlow::Continue(())
    }
}

/// [`simulate`] by any method, the Rosenbrock method for stiff models included.
///
/// The Rosenbrock method needs the Jacobian of the model, so the equations are compiled a second time, over dual
/// numbers.
///
/// # Errors
/// As [`simulate`].
#[cfg(feature = "std")]
pub fn simulate_stiff<T: Real, M: Model<T>>(
    model: &M,
    settings: &Settings,
    sink: &mut impl FnMut(Sample<'_, T>),
) -> Result<Report, Failure<'static>> {
    let start = model.initial_state();
    let mut sink = to_the_end(sink);
    let model = Differentiable(model);
    let run = run(&model, start.as_ref(), settings, None, &mut sink);
    run.map_err(|failure| failure.with_info(M::INFO))
}

/// Runs a model from any state, until the end or until the receiver of the samples breaks off.
///
/// # Errors
/// As [`simulate`].
#[cfg(feature = "std")]
pub fn simulate_from<T: Real, M: Model<T>>(
    model: &M,
    initial: M::State,
    settings: &Settings,
    sink: &mut impl FnMut(Sample<'_, T>) -> ControlFlow<()>,
) -> Result<Report, Failure<'static>> {
    let model = Direct(model);
    let run = run(&model, initial.as_ref(), settings, None, sink);
    run.map_err(|failure| failure.with_info(M::INFO))
}

/// [`simulate_from`] with a watch, which records where the energy went and whether the run can be trusted. The watch
/// takes two more evaluations of the powers per step, three with methods of higher order and with fixed steps. Its
/// findings hold up to the time reached, for a failed run too.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// With a watch for another model.
#[cfg(feature = "std")]
pub fn simulate_watched<T: Real, M: Model<T>>(
    model: &M,
    initial: M::State,
    settings: &Settings,
    watch: &mut Watch<'_, T>,
    sink: &mut impl FnMut(Sample<'_, T>) -> ControlFlow<()>,
) -> Result<Report, Failure<'static>> {
    let (model, watch) = (Direct(model), Some(watch));
    let run = run(&model, initial.as_ref(), settings, watch, sink);
    run.map_err(|failure| failure.with_info(M::INFO))
}

/// Runs any model from any state, watched or not. All functions above call this one. It allocates its memory once,
/// before the run begins.
///
/// A generated model is given as [`Direct`], or as [`Differentiable`] where the method needs its Jacobian.
///
/// ```
/// # use bryant_runtime::{Differentiable, Failure, Formula, Integrator, Model, Report, Settings, Tolerances};
/// # use bryant_runtime::simulate::run;
/// # use std::ops::ControlFlow;
/// fn end<M: Model<f64>>(model: &M) -> Result<Vec<f64>, Failure<'static>> {
///     let settings = Settings {
///         method: Integrator::adaptive(Formula::Rodas5, Tolerances::default()),
///         ..Settings::of(M::INFO)
///     };
///     let mut end = Vec::new();
///     let (model, start) = (Differentiable(model), model.initial_state());
///     let report = run(&model, start.as_ref(), &settings, None, &mut |sample| {
///         end = sample.state.to_vec();
///         ControlFlow::Continue(())
///     });
///     // a failure of the run borrows its model, which ends here
///     report.map_err(|failure| failure.with_info(M::INFO))?;
///     Ok(end)
/// }
/// ```
///
/// # Errors
/// As [`simulate`]. The failure borrows the model; [`Failure::with_info`] makes it last longer.
///
/// # Panics
/// Where `initial` is not as long as a state of the model; with a watch for another model.
#[cfg(feature = "std")]
pub fn run<'m, T: Real>(
    model: &'m dyn Dynamics<T>,
    initial: &[T],
    settings: &Settings,
    watch: Option<&mut Watch<'_, T>>,
    sink: &mut Receiver<'_, T>,
) -> Result<Report, Failure<'m>> {
    let length = workspace_length(model.info(), settings);
    let mut workspace = std::vec![T::from_f64(0.0); length];
    run_in(&mut workspace, model, initial, settings, watch, sink)
}

/// [`run`] with an observer, which is called before every try of a step with the time reached \[s\] and may stop the
/// run: to show progress, or to keep a time limit.
///
/// # Errors
/// As [`simulate`]. A stopped run is no error: its report has the time reached.
///
/// # Panics
/// As [`run`].
#[cfg(feature = "std")]
pub fn run_observed<'m, T: Real>(
    model: &'m dyn Dynamics<T>,
    initial: &[T],
    settings: &Settings,
    watch: Option<&mut Watch<'_, T>>,
    sink: &mut Receiver<'_, T>,
    observer: &mut Observer<'_>,
) -> Result<Report, Failure<'m>> {
    let length = workspace_length(model.info(), settings);
    let workspace = &mut std::vec![T::from_f64(0.0); length];
    let run = Run::new(workspace, model, initial, settings, watch);
    let end = run.and_then(|mut run| T::march(&mut run, sink, Some(observer)));
    end.map_err(|failure| failure.with_info(model.info()))
}

/// [`run`] in the given memory, of at least [`workspace_length`] scalars with any values: for targets without an
/// allocator, and for many runs one after the other.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// Where the memory is too short; where `initial` is not as long as a state of the model; with a watch for another
/// model.
pub fn run_in<'m, T: Real>(
    workspace: &mut [T],
    model: &'m dyn Dynamics<T>,
    initial: &[T],
    settings: &Settings,
    watch: Option<&mut Watch<'_, T>>,
    sink: &mut Receiver<'_, T>,
) -> Result<Report, Failure<'m>> {
    let run = Run::new(workspace, model, initial, settings, watch);
    let end = run.and_then(|mut run| T::march(&mut run, sink, None));
    end.map_err(|failure| failure.with_info(model.info()))
}

/// The number of scalars that a run of this model needs as its workspace.
pub const fn workspace_length(info: &Info, settings: &Settings) -> usize {
    time_loop::length(info) + crate::integrate::step_length(&settings.method, info)
}
