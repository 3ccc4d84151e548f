//! A run that its caller advances in portions.

use super::driven_model::Driven;
use super::time_loop::{End, TimeLoop};
use super::watch::Watch;
use super::{Observer, Receiver, Report, Sample, Settings, workspace_length};
use crate::failure::{Culprit, Failure, Quantity, Reason, Refusal, Setting};
use crate::integrate::workspace::Workspace;
use crate::integrate::{AnyStepper, first_non_finite};
use crate::{Dynamics, Info, Real};
use core::ops::ControlFlow;

/// A run that advances only as far as it is asked to: for a caller that does something of its own in between.
///
/// Between calls it keeps the whole state of the run: the length of the next step and the error control, events and
/// memory of force laws, charts. Its samples are equal, bit for bit, to those of [`run_in`](super::run_in) with the
/// same settings and sampling times. Steps under error control do not end at samples, so asking for a sample costs no
/// step.
///
/// ```
/// # use bryant_runtime::{Direct, Failure, Model, Settings, simulate::{Run, workspace_length}};
/// fn positions<M: Model<f64>>(model: &M) -> Result<Vec<f64>, Failure<'static>> {
///     let settings = Settings::of(M::INFO);
///     let mut memory = vec![0.0; workspace_length(M::INFO, &settings)];
///     let (model, start) = (Direct(model), model.initial_state());
///     // a failure of the run borrows its model, which ends here
///     let of_model = |failure: Failure<'_>| failure.with_info(M::INFO);
///     let run = Run::new(&mut memory, &model, start.as_ref(), &settings, None);
///     let mut run = run.map_err(of_model)?;
///     let mut positions = Vec::new();
///     for hundredth in 0..=100 {
///         // rounding may take a product beyond the end
///         let t = (0.01 * settings.duration * f64::from(hundredth)).min(settings.duration);
///         let sample = run.advance_to(t).map_err(of_model)?;
///         positions.push(sample.state[0]);
///     }
///     Ok(positions)
/// }
/// ```
pub struct Run<'a, 'w, T: Real> {
    time_loop: TimeLoop<'a, 'w, T>,
    step: AnyStepper<'a, T>,
    info: &'a Info<'a>,
    /// The failure, if the run has failed.
    failed: Option<Failure<'a>>,
    duration: f64,
}

impl<'a, 'w, T: Real> Run<'a, 'w, T> {
    /// A run from a state at [`Settings::start`], in the given memory, of at least [`workspace_length`] scalars with
    /// any values. Nothing is evaluated yet.
    ///
    /// # Errors
    /// Invalid settings; parameters that the model refuses; a state that is not finite.
    ///
    /// # Panics
    /// Where the memory is too short; where `initial` is not as long as a state of the model; with a watch for another
    /// model.
    pub fn new(
        workspace: &'a mut [T],
        model: &'a dyn Dynamics<T>,
        initial: &[T],
        settings: &Settings,
        watch: Option<&'a mut Watch<'w, T>>,
    ) -> Result<Self, Failure<'a>> {
        let info = model.info();
        let fail = |reason| Failure {
            t: settings.start,
            reason,
            info,
        };
        settings
            .check()
            .map_err(|setting| fail(Reason::InvalidSettings(setting)))?;
        if let Some(refusal) = Refusal::of(model) {
            return Err(fail(Reason::Refused(refusal)));
        }
        assert_eq!(
            initial.len(),
            info.state_length(),
            "the initial state is not as long as one of {}",
            info.name
        );
        let length = workspace_length(info, settings);
        assert!(
            workspace.len() >= length,
            "the workspace is too short for a run of {}: see workspace_length",
            info.name
        );
        assert!(
            watch.as_ref().is_none_or(|watch| watch.fits(info)),
            "the watch is not one for {}",
            info.name
        );
        if let Some(index) = first_non_finite(initial) {
            return Err(fail(Reason::NonFinite {
                index,
                of: Quantity::InitialState,
                output: None,
                culprit: Culprit::Unknown,
            }));
        }
        let mut workspace = Workspace::new(&mut workspace[..length]);
        let time_loop = TimeLoop::new(model, initial, settings, watch, &mut workspace);
        let step = AnyStepper::new(&settings.method, info, &mut workspace);
        debug_assert_eq!(workspace.left(), 0, "of the workspace of {}", info.name);
        Ok(Run {
            time_loop,
            step,
            info,
            failed: None,
            duration: settings.duration,
        })
    }

    /// A run whose inputs change: as [`Run::new`], of a model that [`Driven::set_inputs`] may change between two calls
    /// of [`advance_to`](Self::advance_to). Each call ends a step at its time, so that inputs are held from one call to
    /// the next. A sample is that just before its inputs change.
    ///
    /// ```
    /// # use bryant_runtime::{Adjustable, Failure, Info, Settings, simulate::{Driven, Run, workspace_length}};
    /// /// Holds the first coordinate at 0 by the only input, at 1 kHz.
    /// fn hold<'i>(model: &mut dyn Adjustable<f64>, info: &'i Info<'i>) -> Result<(), Failure<'i>> {
    ///     let settings = Settings::of(info);
    ///     let mut start = vec![0.0; info.state_length()];
    ///     model.initial_state(&mut start);
    ///     let mut memory = vec![0.0; workspace_length(info, &settings)];
    ///     let mut parameters = vec![0.0; Driven::<f64>::length(info)];
    ///     let model = Driven::new(model, info, &mut parameters);
    ///     let of_model = |failure: Failure<'_>| failure.with_info(info);
    ///     let run = Run::driven(&mut memory, &model, &start, &settings, None);
    ///     let mut run = run.map_err(of_model)?;
    ///     for millisecond in 0..1000 {
    ///         let sample = run.advance_to(1e-3 * f64::from(millisecond)).map_err(of_model)?;
    ///         let state = sample.state;
    ///         let torque = -80.0 * state[0] - 4.0 * state[info.coordinates.len()];
    ///         model.set_inputs(&[torque.clamp(-12.0, 12.0)]).expect("within its limits");
    ///     }
    ///     Ok(())
    /// }
    /// ```
    ///
    /// # Errors
    /// As [`Run::new`].
    ///
    /// # Panics
    /// As [`Run::new`].
    pub fn driven(
        workspace: &'a mut [T],
        model: &'a Driven<'a, T>,
        initial: &[T],
        settings: &Settings,
        watch: Option<&'a mut Watch<'w, T>>,
    ) -> Result<Self, Failure<'a>> {
        let mut run = Run::new(workspace, model, initial, settings, watch)?;
        run.time_loop.drive(model);
        Ok(run)
    }

    /// Advances the run to a time \[s\] from the start to the duration, and samples it there. The same time may be
    /// asked for again.
    ///
    /// # Errors
    /// A time before that of the last sample or after the duration, which leaves the run as it is; and as
    /// [`simulate`](super::simulate()). After a failure, each further call returns the same failure.
    pub fn advance_to(&mut self, t: f64) -> Result<Sample<'_, T>, Failure<'a>> {
        let reached = self.report().t;
        if !(reached..=self.duration).contains(&t) {
            return Err(Failure {
                t: reached,
                reason: Reason::InvalidSettings(Setting {
                    name: "time to advance to",
                    value: t,
                    must: "no earlier than the time reached, no later than the duration",
                }),
                info: self.info,
            });
        }
        self.time_loop.schedule.ask_for(t);
        self.time_loop.control_at(t);
        T::march(self, &mut |_| ControlFlow::Break(()), None)?;
        Ok(self.time_loop.last_sample())
    }

    /// The statistics of the run so far; its time is that of the last sample.
    pub fn report(&self) -> Report {
        self.time_loop.report()
    }

    /// Advances the run to its end, or until the receiver of samples or the observer stops it.
    pub(crate) fn go(
        &mut self,
        sink: &mut Receiver<'_, T>,
        observer: Option<&mut Observer<'_>>,
    ) -> Result<Report, Failure<'a>> {
        if let Some(failure) = &self.failed {
            return Err(*failure);
        }
        let end = self.time_loop.go(self.step.stepper(), sink, observer);
        let report = self.report();
        match end {
            Ok(()) | Err(End::Stopped) => Ok(report),
            Err(End::Failed(reason)) => {
                let failure = Failure {
                    t: report.t,
                    reason,
                    info: self.info,
                };
                self.failed = Some(failure);
                Err(failure)
            }
        }
    }
}
