//! Runs described by a few words and delivered as rows of numbers: what a program needs around models, however they
//! were made.
//!
//! [`run_job`] runs a model of any [`Family`] with the arithmetic that a [`Job`] asks for. An [`Entry`] is one
//! generated model of a table of models.

mod error;
mod finding;
mod header;
mod job;
mod reading;

pub use crate::simulate::History;
pub use error::{ErrorKind, RunError};
pub use finding::Finding;
pub use header::{Header, OutputHeader, ParameterHeader};
pub use job::{Job, JobError, Scalar, Start};
pub use reading::{Kept, Reading};

use crate::dynamics::{made, made_differentiable};
use crate::patience::Patience;
use crate::response::Answer;
use crate::simulate::{self, Balance, ENERGY_LIMIT, Sample, SampleKind, Watch};
use crate::{Adjustable, DoubleDouble, Family, Fast, Info, Model, Real, Report, Section};
use reading::Signals;
use std::ops::ControlFlow;

/// Receives time, state and outputs of each sample. It may stop the run.
pub type SampleWriter<'a> = dyn FnMut(f64, &[f64], &[f64]) -> ControlFlow<()> + 'a;

/// Is called from time to time with the time that a run has reached \[s\], also between samples. It may stop the run,
/// which then ends with [`ErrorKind::Stopped`].
pub type Observer<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// A parameter: name and value (SI).
pub type Named = (String, f64);

/// Makes a model with the default values of all parameters.
pub type Make<T> = fn() -> Box<dyn Adjustable<T>>;

/// A model of a program, as an entry of a table of many.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Names, units, sizes.
    pub info: &'static Info<'static>,
    make: Make<f64>,
}

impl Entry {
    /// The entry of a generated model, for all methods.
    pub const fn of<M: Model<f64> + 'static>() -> Entry {
        Entry {
            info: M::INFO,
            make: made_differentiable::<f64, M>,
        }
    }

    /// The entry of a generated model without its Jacobian, for all methods but the Rosenbrock method. It saves the
    /// compilation of the equations over dual numbers.
    pub const fn without_jacobian<M: Model<f64> + 'static>() -> Entry {
        Entry {
            info: M::INFO,
            make: made::<f64, M>,
        }
    }

    /// Runs the model as the job says, in double precision, and passes every sample to `writer`.
    ///
    /// # Errors
    /// A job that does not fit the model; a run that fails ([`crate::Failure`]). All samples before the failure were
    /// delivered.
    pub fn run(&self, job: &Job, writer: &mut SampleWriter<'_>) -> Result<Report, RunError> {
        execute_in_double((self.make)(), job, false, writer, &mut going_on).result
    }

    /// [`Entry::run`] with a watch: where the energy went, and whether the run can be trusted.
    pub fn run_balanced(&self, job: &Job, writer: &mut SampleWriter<'_>) -> Outcome {
        execute_in_double((self.make)(), job, true, writer, &mut going_on)
    }

    /// The model with these parameters.
    ///
    /// # Errors
    /// Parameters that the model does not have, or values that it does not allow.
    pub fn model(&self, parameters: &[Named]) -> Result<Box<dyn Adjustable<f64>>, RunError> {
        let mut model = (self.make)();
        job::adjust(&mut *model, parameters)?;
        Ok(model)
    }

    /// The state at which a run with these parameters starts: coordinates, velocities, and the states of force laws.
    ///
    /// # Errors
    /// Those of [`Entry::model`].
    pub fn initial_state(&self, parameters: &[Named]) -> Result<Vec<f64>, RunError> {
        let mut state = vec![0.0; self.info.state_length()];
        self.model(parameters)?.initial_state(&mut state);
        Ok(state)
    }

    /// ẏ at time `t` \[s\], with as many numbers as the state has.
    ///
    /// # Errors
    /// Those of [`Entry::model`]; slices of the wrong length.
    pub fn derivative(
        &self,
        parameters: &[Named],
        t: f64,
        y: &[f64],
        rate: &mut [f64],
    ) -> Result<(), RunError> {
        let lengths = [("derivative", rate.len(), self.info.state_length())];
        let model = self.at(parameters, y, &lengths)?;
        model.derivative(t, y, rate);
        Ok(())
    }

    /// The results of a section; none if the model does not have it.
    ///
    /// # Errors
    /// Those of [`Entry::derivative`].
    pub fn section(
        &self,
        section: Section,
        parameters: &[Named],
        t: f64,
        y: &[f64],
    ) -> Result<Vec<f64>, RunError> {
        let model = self.at(parameters, y, &[])?;
        let mut results = vec![0.0; self.info.length(section)];
        model.sections(t, y, &mut [(section, &mut results)]);
        Ok(results)
    }

    /// The first time after `t` at which a curve of time has a kink that depends on parameters
    /// ([`Dynamics::kink_after`](crate::Dynamics::kink_after)) \[s\].
    ///
    /// # Errors
    /// Those of [`Entry::model`].
    pub fn kink_after(&self, parameters: &[Named], t: f64) -> Result<f64, RunError> {
        Ok(self.model(parameters)?.kink_after(t))
    }

    /// The model, after checks of the lengths of the state and of other slices, which are given as (what, given,
    /// expected).
    fn at(
        &self,
        parameters: &[Named],
        y: &[f64],
        lengths: &[(&'static str, usize, usize)],
    ) -> Result<Box<dyn Adjustable<f64>>, RunError> {
        let model = self.model(parameters)?;
        let state = ("state", y.len(), self.info.state_length());
        for &(what, given, expected) in std::iter::once(&state).chain(lengths) {
            if given != expected {
                return Err(JobError::Size {
                    what,
                    given,
                    expected,
                }
                .into());
            }
        }
        Ok(model)
    }
}

/// Runs a model of a family as the job says, with the arithmetic that it asks for, and passes every sample to `writer`.
/// Unless the job is silent, the run is watched: the outcome says where the energy went and whether the run can be
/// trusted.
pub fn run_job(family: &impl Family, job: &Job, writer: &mut SampleWriter<'_>) -> Outcome {
    run_job_observed(family, job, writer, &mut going_on)
}

/// [`run_job`] with an observer, who hears how far the run is and may stop it.
pub fn run_job_observed(
    family: &impl Family,
    job: &Job,
    writer: &mut SampleWriter<'_>,
    observer: &mut Observer<'_>,
) -> Outcome {
    let balanced = !job.silent;
    match job.scalar {
        Scalar::F64 => execute_in_double(family.over(), job, balanced, writer, observer),
        Scalar::F32 => execute(family.over::<f32>(), job, balanced, writer, observer),
        Scalar::Fast => execute(family.over::<Fast>(), job, balanced, writer, observer),
        Scalar::DoubleDouble => execute(
            family.over::<DoubleDouble>(),
            job,
            balanced,
            writer,
            observer,
        ),
    }
}

/// [`run_job_observed`] for one model in double precision, with the default values of its parameters, whatever
/// arithmetic the job asks for.
pub fn run_model_observed(
    model: Box<dyn Adjustable<f64> + '_>,
    job: &Job,
    writer: &mut SampleWriter<'_>,
    observer: &mut Observer<'_>,
) -> Outcome {
    execute_in_double(model, job, !job.silent, writer, observer)
}

/// An [`Observer`] that never stops a run.
fn going_on(_: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Runs a generated model as the job says. The arithmetic is that of `T`, whatever the job asks for.
///
/// # Errors
/// A job that does not fit the model; a run that fails ([`crate::Failure`]). All samples before the failure were
/// delivered.
pub fn run<T: Real, M: Model<T> + 'static>(
    job: &Job,
    writer: &mut SampleWriter<'_>,
) -> Result<Report, RunError> {
    execute(
        made_differentiable::<T, M>(),
        job,
        false,
        writer,
        &mut going_on,
    )
    .result
}

/// [`run`] with a watch: where the energy went, and whether the run can be trusted.
pub fn run_balanced<T: Real, M: Model<T> + 'static>(
    job: &Job,
    writer: &mut SampleWriter<'_>,
) -> Outcome {
    execute(
        made_differentiable::<T, M>(),
        job,
        true,
        writer,
        &mut going_on,
    )
}

/// [`execute`] in double precision, so that it is compiled in this crate.
#[inline(never)]
fn execute_in_double(
    model: Box<dyn Adjustable<f64> + '_>,
    job: &Job,
    balanced: bool,
    writer: &mut SampleWriter<'_>,
    observer: &mut Observer<'_>,
) -> Outcome {
    execute(model, job, balanced, writer, observer)
}

/// Number of steps between two checks of the clock; the observer is called as often.
const STEPS_BETWEEN_LOOKS: u32 = 16;

/// Runs a model that has the default values of its parameters, as the job says.
fn execute<T: Real>(
    mut model: Box<dyn Adjustable<T> + '_>,
    job: &Job,
    balanced: bool,
    writer: &mut SampleWriter<'_>,
    observer: &mut Observer<'_>,
) -> Outcome {
    if let Err(error) = job::adjust(&mut *model, &job.parameters) {
        return Outcome::refused(error);
    }
    let info = model.info();
    let initial = match initial_state(&*model, job) {
        Ok(initial) => initial,
        Err(error) => return Outcome::refused(error),
    };
    let settings = job.settings(info);
    let mut watch = balanced.then(|| watch_for(info, job));
    let mut numbers = Numbers::default();
    let mut signals = Signals::of(&job.reading);
    let mut patience = Patience::new(job.time_limit, [settings.start, settings.duration]);
    let (mut steps, mut late, mut stopped) = (0u32, false, false);
    let mut in_time = |t: f64| {
        steps = steps.wrapping_add(1);
        if steps.is_multiple_of(STEPS_BETWEEN_LOOKS) {
            late = patience.ends_at(t);
            stopped = observer(t).is_break();
        }
        match late || stopped {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let result = simulate::run_observed(
        &*model,
        &initial,
        &settings,
        watch.as_mut(),
        &mut |sample| match sample.kind {
            SampleKind::Part => {
                signals.add(sample.outputs);
                ControlFlow::Continue(())
            }
            SampleKind::Row if job.silent => ControlFlow::Continue(()),
            SampleKind::Row => numbers.send(sample, writer),
        },
        &mut in_time,
    );
    let doubts = watch.iter().flat_map(Watch::diagnostics);
    let doubts: Vec<Finding> = doubts.map(Finding::from).collect();
    let notes = watch.as_ref().map(finding::notes).unwrap_or_default();
    let nearest = watch
        .iter()
        .flat_map(|watch| (0..info.event_functions.len()).filter_map(|index| watch.nearest(index)));
    let nearest = nearest.collect();
    let result = match result {
        Ok(report) if stopped => Err(RunError::stopped(&report)),
        Ok(report) if late => Err(RunError::out_of_time(&report, patience.late())),
        Ok(report) => Ok(report),
        Err(failure) => Err(RunError::from(failure).explained(&doubts)),
    };
    let answers = match result.is_ok() && doubts.is_empty() {
        true => signals.answers([settings.start, settings.duration]),
        false => Vec::new(),
    };
    let kept = match result.is_ok() {
        true => signals.kept([settings.start, settings.duration]),
        false => Vec::new(),
    };
    Outcome {
        result,
        answers,
        kept,
        doubts,
        notes,
        nearest,
        history: watch.as_mut().and_then(|watch| watch.history.take()),
        energy: watch.map(|watch| Energy::of(&watch.balance, info)),
    }
}

/// The watch that a job asks for.
fn watch_for<'a, T: Real>(info: &'a Info<'a>, job: &Job) -> Watch<'a, T> {
    let mut watch = Watch::new(info, job.energy_limit.unwrap_or(ENERGY_LIMIT));
    watch.history = job.reading.works_every.map(|every| History {
        every,
        ..History::default()
    });
    watch
}

/// The state at which the job starts: the one that it gives, or that of the model.
fn initial_state<T: Real>(model: &dyn Adjustable<T>, job: &Job) -> Result<Vec<T>, JobError> {
    let mut initial = vec![T::from_f64(0.0); model.info().state_length()];
    match &job.start {
        None => model.initial_state(&mut initial),
        Some(start) => place(model, &start.state, &mut initial)?,
    }
    Ok(initial)
}

/// Largest relative difference between a given state and its normalized form. More than that is no rounding but a wrong
/// state.
const OFF_MANIFOLD: f64 = 1e-6;

/// Copies a given state into place and checks that it is on the manifold.
fn place<T: Real>(
    model: &dyn Adjustable<T>,
    given: &[f64],
    state: &mut [T],
) -> Result<(), JobError> {
    if given.len() != state.len() {
        return Err(JobError::Size {
            what: "initial state",
            given: given.len(),
            expected: state.len(),
        });
    }
    for (entry, value) in state.iter_mut().zip(given) {
        *entry = T::from_f64(*value);
    }
    model.normalize(state);
    for (index, (entry, value)) in state.iter().zip(given).enumerate() {
        let normalized = entry.to_f64();
        // values that are not finite are reported later, as for any initial state
        if (normalized - value).abs() > OFF_MANIFOLD * value.abs().max(1.0) {
            return Err(JobError::State {
                name: model
                    .info()
                    .state_name(index)
                    .unwrap_or_default()
                    .to_owned(),
                value: *value,
                normalized,
            });
        }
    }
    Ok(())
}

/// State and outputs of a sample, in double precision.
#[derive(Default)]
struct Numbers {
    state: Vec<f64>,
    outputs: Vec<f64>,
}

impl Numbers {
    /// Passes a sample to `writer`, which may stop the run.
    fn send<T: Real>(
        &mut self,
        sample: Sample<'_, T>,
        writer: &mut SampleWriter<'_>,
    ) -> ControlFlow<()> {
        for (numbers, scalars) in [
            (&mut self.state, sample.state),
            (&mut self.outputs, sample.outputs),
        ] {
            numbers.clear();
            numbers.extend(scalars.iter().map(|scalar| scalar.to_f64()));
        }
        writer(sample.t, &self.state, &self.outputs)
    }
}

/// How a run ended, and where the energy went.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The report of the run, or why it failed.
    pub result: Result<Report, RunError>,
    /// Answers to [the questions](Job::reading), in their order; empty where the run did not reach its end or cannot be
    /// trusted.
    pub answers: Vec<Answer>,
    /// Samples of [the kept channels](reading::Reading::kept), in their order; empty where the run did not reach its
    /// end.
    pub kept: Vec<Vec<f64>>,
    /// The work of each effect over time, if the job [requests it](Reading::works_every).
    pub history: Option<History>,
    /// The balance of energy up to the time reached; `None` where nothing ran.
    pub energy: Option<Energy>,
    /// Reasons not to trust the run, causes first.
    pub doubts: Vec<Finding>,
    /// Notes that are no reason for doubt: curves that were left as far as they may be.
    pub notes: Vec<String>,
    /// The smallest value of each event function, in the order of [`Info::event_functions`]; empty where nothing ran.
    pub nearest: Vec<f64>,
}

/// The balance of energy of a run, in J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy at the start.
    pub start: f64,
    /// Kinetic energy at the time reached.
    pub end: f64,
    /// Work of each effect, in the order of [`Info::powers`].
    pub works: Vec<f64>,
    /// Σ ∫ |P| dt: the energy exchanged in either direction.
    pub exchanged: f64,
    /// The share of the momentum of free systems that no force explains; `None` where no system is free.
    pub momentum_gap: Option<f64>,
}

impl Energy {
    fn of<T: Real>(balance: &Balance<'_, T>, info: &Info) -> Energy {
        Energy {
            start: balance.start.to_f64(),
            end: balance.end.to_f64(),
            works: balance.works.iter().map(|work| work.to_f64()).collect(),
            exchanged: balance.exchanged.to_f64(),
            momentum_gap: info.free.then(|| balance.momentum.relative_gap()),
        }
    }

    /// What is missing in the balance: end − start − Σ works.
    pub fn gap(&self) -> f64 {
        self.end - self.start - self.works.iter().sum::<f64>()
    }

    /// The gap as a share of the largest energy that could be lost: the exchanged energy or the kinetic energy.
    pub fn relative_gap(&self) -> f64 {
        let scale = self.exchanged.max(self.start).max(self.end);
        if scale > 0.0 {
            self.gap().abs() / scale
        } else {
            0.0
        }
    }
}

impl Outcome {
    fn refused(error: JobError) -> Outcome {
        Outcome {
            result: Err(error.into()),
            energy: None,
            answers: Vec::new(),
            kept: Vec::new(),
            history: None,
            doubts: Vec::new(),
            notes: Vec::new(),
            nearest: Vec::new(),
        }
    }
}
