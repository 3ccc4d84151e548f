//! The time loop of all methods.
//!
//! ```text
//! length of the step ← pace (fixed, or the controller's), cut to meet the next kink in time, or a kink of a force law
//! take it
//!   error too large, or a kink crossed that matters   → again, shorter
//!   else an event function changed its sign                     → ends there
//! work, samples, memory of force laws; the next step begins
//! ```
//!
//! | file | what |
//! |---|---|
//! | `search` | kinks and event functions within a step |
//! | `onset` | what begins and ends within a step |
//! | `sample` | the samples in it |
//! | `count` | what decided its length |
//! | `fail` | why there is no next one |

mod count;
mod fail;
mod onset;
mod sample;
mod search;

use super::driven_model::Driven;
use super::event::{PLACES, WIDTH, inside};
use super::schedule::{Grid, Schedule, to_meet};
use super::stuck_events::Standing;
use super::watch::Watch;
use super::{Cause, Observer, Pace, Receiver, Report, Settings};
use crate::failure::Reason;
use crate::integrate::acceleration::{
    Accelerations, EndDifference, Fastest, effect_accelerations, kind,
};
use crate::integrate::control::{Allowed, Basic, Controller, Tolerances, first_step};
use crate::integrate::workspace::Workspace;
use crate::integrate::{Evaluator, Stepper, first_non_finite};
use crate::real::mapped;
use crate::{Dynamics, Info, Real, Section};
use count::Vote;
use onset::{KEPT, Onsets, STORED_END};
use search::{Approach, HOP, HOP_OF_FEW_DIGITS, RESTLESS, matters};
#[cfg(feature = "std")]
pub(crate) use search::{EASY, SEARCHES};

/// Limit of tries of an implicit method, and the h|λ| of the fastest motion, until whatever the explicit method has let
/// grow is damped. That is an oscillation within the tolerated share of accelerations, or one that is lost in the
/// rounding of coordinates, or one that the tolerances do not resolve.
const SETTLES: u32 = 20;
const SETTLED: f64 = 1e3;
/// Ratio of the first step tried by an implicit method to the last one of the explicit method. Where h|λ| is about 1,
/// the fast motion that the explicit method has let grow is as large as the allowed error, and is damped slowly. In a
/// far longer step its error falls like 1/(h|λ|), so it vanishes.
const LEAP: f64 = 1e5;

/// Why the time loop is left before the end of the run.
pub(crate) enum End {
    /// The receiver of the samples or the observer asked to stop. The run can go on.
    Stopped,
    Failed(Reason),
}

/// The end and length of a step to be taken.
struct Reach {
    /// The next time that a step must end at \[s\].
    stop: f64,
    /// The time at which this step ends \[s\].
    reached: f64,
    /// Length of the step \[s\]: the difference of the rounded times at its ends.
    length: f64,
    /// True if the step ends at `stop`.
    lands: bool,
    /// The smallest step \[s\]; a shorter one is a failure.
    smallest: f64,
}

/// An accepted step, with all that the next step needs of it.
struct Landed {
    reach: Reach,
    landing: Landing,
    /// The time at which the step ended \[s\].
    end: f64,
    /// If the run is watched: the kinetic energy before the step, and the energy exchanged in it \[J\].
    energy: Option<[f64; 2]>,
}

/// What renewing the memory of force laws changed.
#[derive(Clone, Copy, PartialEq)]
enum Renewed {
    /// Nothing.
    No,
    /// Memory, but neither event functions nor onsets changed.
    Alike,
    /// Memory, and also event functions or onsets.
    Other,
}

/// Selects one of two states.
#[derive(Clone, Copy)]
enum State {
    /// The state at the end of the step being tried (`ahead`).
    Ahead,
    /// The state reached (`y`).
    Reached,
}

/// How an accepted step ended.
struct Landing {
    /// The time at which the step began \[s\].
    begin: f64,
    /// Length of the step \[s\].
    length: f64,
    /// True if the step went its full length; false if it was cut at a sign change of an event function.
    whole: bool,
    /// What forced the length of the step, if not its error.
    forced: Option<Cause>,
}

/// The smallest difference of times at `t` that exceeds rounding.
pub(crate) fn finest(t: f64) -> f64 {
    16.0 * (t.next_up() - t)
}

/// [`finest`] in the resolution of a scalar type: 2²⁹ times as long for single precision. Equations that are evaluated
/// at two closer times are evaluated at the same rounded time.
fn finest_of<T: Real>(t: f64) -> f64 {
    epsilon_of::<T>() / f64::EPSILON * finest(t)
}

/// The machine epsilon of a scalar type: that of `f64`, or of `f32` for scalars with few digits.
pub(crate) fn epsilon_of<T: Real>() -> f64 {
    match T::from_f64(1.0 + 1e-10).to_f64() == 1.0 {
        true => f64::from(f32::EPSILON),
        false => f64::EPSILON,
    }
}

/// The time loop of a run; the time reached is `report.t`. The loop can be left at a sample and entered again without
/// changing a bit of the results.
pub(crate) struct TimeLoop<'a, 'w, T: Real> {
    model: &'a dyn Dynamics<T>,
    /// The model again, where its inputs may change; and the next time at which they may \[s\].
    driven: Option<&'a Driven<'a, T>>,
    control: f64,
    info: &'a Info<'a>,
    f: Evaluator<'a, T>,
    settings: Settings,
    pub schedule: Schedule,
    watch: Option<&'a mut Watch<'w, T>>,
    report: Report,
    /// The most frequent cause of step lengths among the last steps before the limit on their number.
    vote: Vote,
    /// True once [`TimeLoop::open`] has prepared the first step.
    opened: bool,
    /// The last accepted step, until all samples within it are delivered.
    landed: Option<Landed>,

    /// The state reached, and its derivative for the next step.
    y: &'a mut [T],
    rate: &'a mut [T],
    /// The state at the end of the step being tried; a second state for renewing memory.
    ahead: &'a mut [T],
    renewed: &'a mut [T],
    /// The event functions at the start of the previous step, at the start of this one, and at its end.
    event_functions_past: &'a mut [T],
    event_functions: &'a mut [T],
    event_functions_ahead: &'a mut [T],
    /// Length of the previous step \[s\]; 0 if the motion does not continue smoothly from it.
    past: f64,
    /// True if something other than accuracy decides the length of this step (`search::EASY`).
    easy: bool,
    /// The kink functions at the start of this step, valid if `kinks_known`.
    kinks: &'a mut [T],
    kinks_known: bool,
    onsets: Onsets<'a, T>,
    /// Errors allowed; used for adaptive steps only.
    allowed: Allowed<'a, T>,
    accelerations: Accelerations<f64>,
    /// (h|λ|)⁴ of the last try by an explicit method that may switch to the implicit one; and the number of rejected
    /// tries of this step.
    h_lambda_fourth: f64,
    retries: u64,
    /// Tries left in which an implicit method may damp what the explicit one has let grow.
    settles: u32,
    /// Workspace for the powers of all effects, twice.
    powers: [&'a mut [T]; 2],

    /// Length that the controller wants for the next step \[s\].
    h: f64,
    controller: Controller<f64>,
    /// The grid of fixed steps.
    grid: Option<Grid>,
    /// The next kink of a curve of time, or the end of the run \[s\].
    breakpoint: f64,
    approach: Option<Approach>,
    /// `restless`: kinks approached in a row. `searches`: tries in a row repeated because of a kink hidden in the step.
    restless: u32,
    standing: Standing,
    searches: u32,

    /// Workspaces: a state within a step; another state; values of event functions or kinks at [`PLACES`] places;
    /// outputs; arguments of curves.
    inside: &'a mut [T],
    spare: &'a mut [T],
    values: &'a mut [T],
    outputs: &'a mut [T],
    curves: &'a mut [T],
}

/// Number of scalars in the workspace of the time loop, without that of its stepper.
pub(super) const fn length(info: &Info) -> usize {
    let (event_functions, kinks) = (info.event_functions.len(), info.kinks.len());
    let state = info.state_length();
    let states = 7 * state + Allowed::<()>::length(state);
    states
        + 3 * event_functions
        + kinks
        + 2 * KEPT * info.onsets.len()
        + values(info)
        + info.outputs.len()
        + info.curves.len()
        + 2 * info.powers.len()
}

/// Number of values of event functions or kinks that are kept at the same time.
const fn values(info: &Info) -> usize {
    let (event_functions, kinks) = (info.event_functions.len(), info.kinks.len());
    PLACES
        * if event_functions > kinks {
            event_functions
        } else {
            kinks
        }
}

impl<'a, 'w, T: Real> TimeLoop<'a, 'w, T> {
    pub fn new(
        model: &'a dyn Dynamics<T>,
        initial: &[T],
        settings: &Settings,
        watch: Option<&'a mut Watch<'w, T>>,
        workspace: &mut Workspace<'a, T>,
    ) -> Self {
        let info = model.info();
        let state = info.state_length();
        let y = workspace.part(state);
        y.copy_from_slice(initial);
        let tolerances = match settings.method.pace {
            Pace::Fixed(_) => Tolerances::default(),
            Pace::Adaptive(adaptive) => adaptive.tolerances,
        };
        TimeLoop {
            model,
            driven: None,
            control: f64::INFINITY,
            info,
            f: Evaluator::new(model, workspace.part(state)),
            settings: *settings,
            schedule: Schedule::new(settings),
            watch,
            report: Report {
                t: settings.start,
                steps: 0,
                rejected: 0,
                events: 0,
                evaluations: 0,
                jacobians: 0,
                stiff: 0,
                samples: 0,
                smallest_step: f64::INFINITY,
                smallest_step_at: 0.0,
                smallest_step_for: Cause::End,
                largest_step: 0.0,
            },
            vote: Vote {
                cause: Cause::First,
                lead: 0,
            },
            opened: false,
            landed: None,
            y,
            rate: workspace.part(state),
            ahead: workspace.part(state),
            renewed: workspace.part(state),
            event_functions_past: workspace.part(info.event_functions.len()),
            event_functions: workspace.part(info.event_functions.len()),
            event_functions_ahead: workspace.part(info.event_functions.len()),
            past: 0.0,
            easy: true,
            kinks: workspace.part(info.kinks.len()),
            kinks_known: false,
            onsets: Onsets::new(
                info.onsets.len(),
                info.corners,
                workspace.part(2 * KEPT * info.onsets.len()),
            ),
            allowed: Allowed::new(&tolerances, info, workspace),
            accelerations: Accelerations::new(settings.method.formula, tolerances.accelerations),
            h_lambda_fourth: 0.0,
            retries: 0,
            settles: 0,
            powers: [
                workspace.part(info.powers.len()),
                workspace.part(info.powers.len()),
            ],
            h: 0.0,
            controller: Controller::new(0),
            grid: None,
            breakpoint: 0.0,
            approach: None,
            restless: 0,
            standing: Standing::default(),
            searches: 0,
            inside: workspace.part(state),
            spare: workspace.part(state),
            values: workspace.part(values(info)),
            outputs: workspace.part(info.outputs.len()),
            curves: workspace.part(info.curves.len()),
        }
    }

    /// Lets the inputs of the model change between steps.
    pub fn drive(&mut self, driven: &'a Driven<'a, T>) {
        self.driven = Some(driven);
    }

    /// If inputs may change: the next step ends at this time at the latest, where they do.
    pub fn control_at(&mut self, t: f64) {
        if self.driven.is_none() {
            return;
        }
        self.control = t;
        // the first step is ready, and knows of no change yet
        if self.opened && self.landed.is_none() {
            self.breakpoint = self.breakpoint_after(self.report.t);
            self.f.latest = self.breakpoint.next_down();
        }
    }

    /// The next kink in time after `t`, change of inputs, or end of the run.
    fn breakpoint_after(&self, t: f64) -> f64 {
        let kink = self.schedule.kink_after(self.model, t);
        match self.control > t {
            true => kink.min(self.control),
            false => kink,
        }
    }

    /// True if inputs have changed since the last call.
    fn inputs_changed(&self) -> bool {
        self.driven.is_some_and(Driven::take_change)
    }

    /// The statistics of the run so far.
    pub fn report(&self) -> Report {
        Report {
            evaluations: self.f.count,
            jacobians: self.f.jacobians,
            ..self.report
        }
    }

    /// Continues the run from where it was left, until its end or until it is stopped.
    pub fn go(
        &mut self,
        step: &mut dyn Stepper<T>,
        sink: &mut Receiver<'_, T>,
        mut observer: Option<&mut Observer<'_>>,
    ) -> Result<(), End> {
        if !self.opened {
            self.open(step)?;
        }
        loop {
            self.deliver_within(step, sink)?;
            match self.landed.take() {
                Some(landed) => self.leave(step, landed)?,
                // nothing has moved yet
                None if self.inputs_changed() => self.open(step)?,
                None => {}
            }
            if self.report.t >= self.settings.duration {
                return Ok(());
            }
            self.landed = Some(self.step(step, &mut observer)?);
        }
    }

    /// Prepares the first step: initial memory, watch, derivative, first step length.
    fn open(&mut self, step: &mut dyn Stepper<T>) -> Result<(), End> {
        let start = self.report.t;
        self.arrive_at(start, State::Reached, false);
        self.renew(false);
        self.onsets.advance();
        self.event_functions
            .copy_from_slice(self.event_functions_ahead);
        if let Some(watch) = &mut self.watch {
            watch.look_at_event_functions(self.event_functions_ahead);
            let spare = [&mut *self.inside, &mut *self.spare];
            watch.open(self.model, self.y, &self.settings, spare);
        }
        self.f.at(start, self.y, self.rate);
        self.check_rate()?;

        self.breakpoint = self.breakpoint_after(start);
        self.f.latest = self.breakpoint.next_down();
        self.h = match self.settings.method.pace {
            Pace::Fixed(step) => step,
            Pace::Adaptive(adaptive) => adaptive.first_step.unwrap_or_else(|| {
                first_step(
                    &mut self.f,
                    start,
                    [self.y, self.rate],
                    &self.allowed,
                    adaptive
                        .largest_step
                        .min(self.info.longest_step)
                        .min(self.breakpoint - start),
                    step.order_of_estimate() - 1,
                    [self.inside, self.spare],
                )
            }),
        };
        self.controller = Controller::new(step.order_of_estimate());
        step.begin(start, self.y, self.rate);
        self.opened = true;
        Ok(())
    }

    /// Tries steps until one is accepted.
    fn step(
        &mut self,
        step: &mut dyn Stepper<T>,
        observer: &mut Option<&mut Observer<'_>>,
    ) -> Result<Landed, End> {
        let few_digits = T::from_f64(1.0 + 1e-10).to_f64() == 1.0;
        let hop = if few_digits { HOP_OF_FEW_DIGITS } else { HOP };
        let limit = self.settings.max_steps;
        loop {
            if self.report.steps + self.report.rejected >= limit {
                return Err(End::Failed(Reason::TooManySteps {
                    limit,
                    cause: self.vote.cause,
                    step: step.span().h,
                }));
            }
            if let Some(observer) = observer
                && observer(self.report.t).is_break()
            {
                return Err(End::Stopped);
            }
            let reach = self.reach()?;
            step.take(&mut self.f, reach.length).map_err(End::Failed)?;
            if !self.good(step, &reach, hop)? {
                self.report.rejected += 1;
                self.retries += 1;
                continue;
            }
            let landing = self.land(step, &reach);
            let energy = self.watch.as_mut().map(|watch| {
                step.complete(&mut self.f);
                watch.add_work(self.model, step, landing.length, self.inside)
            });
            self.accept(step, &landing);
            return Ok(Landed {
                reach,
                landing,
                end: self.report.t,
                energy,
            });
        }
    }

    /// Finishes an accepted step and prepares the next one.
    fn leave(&mut self, step: &mut dyn Stepper<T>, landed: Landed) -> Result<(), End> {
        let Landed {
            reach,
            landing,
            energy,
            ..
        } = landed;
        self.leave_kink(step, &landing);
        if let (Some(watch), Some(energy)) = (&mut self.watch, energy) {
            watch.close(landing.begin, self.y, energy);
        }
        let mut renewed = self.renew(true);
        if self.inputs_changed() {
            // what depends on inputs has jumped
            self.arrive_at(self.report.t, State::Reached, true);
            self.renew(true);
            renewed = Renewed::Other;
        }
        self.onsets.advance();
        if let (Some(watch), true) = (&mut self.watch, renewed != Renewed::No) {
            watch.renew(landing.begin);
        }
        core::mem::swap(&mut self.event_functions_past, &mut self.event_functions);
        self.event_functions
            .copy_from_slice(self.event_functions_ahead);
        if let Some(watch) = &mut self.watch {
            watch.look_at_event_functions(self.event_functions_ahead);
        }
        let latest = self.f.latest;
        let goes_on = self.begin(step, &reach, &landing, renewed)?;
        if let (Some(watch), Pace::Fixed(_)) = (&mut self.watch, self.settings.method.pace) {
            let next = core::mem::replace(&mut self.f.latest, latest);
            watch.estimate_error(step, &mut self.f, landing.length, self.y, self.inside);
            self.f.latest = next;
        }
        if goes_on {
            self.turn(step, &landing);
            step.begin(self.report.t, self.y, self.rate);
        }
        Ok(())
    }

    /// Lets the stepper change its formula if the scene has become stiff or ceased to be so.
    fn turn(&mut self, step: &mut dyn Stepper<T>, landing: &Landing) {
        let retries = core::mem::take(&mut self.retries);
        let Some(turn) = step.turn(landing.length, retries, self.h_lambda_fourth) else {
            return;
        };
        self.h = self.h.min(turn.longest);
        if turn.leaps {
            self.h *= LEAP;
            self.settles = SETTLES;
            self.accelerations.forget();
        }
        self.controller = Controller::new(step.order_of_estimate());
        // the new formula does not have the derivative at the end of the last step
        self.past = 0.0;
    }

    /// The end and length of the next step to try.
    fn reach(&mut self) -> Result<Reach, End> {
        let t = self.report.t;
        let finest = finest_of::<T>(t);
        let pace = self.settings.method.pace;
        let (stop, wanted, smallest) = match pace {
            Pace::Fixed(step) => {
                let stop = self.breakpoint.min(self.schedule.next_row());
                let grid = match self.grid.and_then(|grid| grid.at(t, stop)) {
                    Some(grid) => grid,
                    None => Grid::new(t, stop, step),
                };
                let limit = self.settings.max_steps;
                if grid.left() > limit - self.report.steps {
                    return Err(End::Failed(Reason::TooManySteps {
                        limit,
                        cause: Cause::Fixed,
                        step,
                    }));
                }
                self.grid = Some(grid);
                if self.approach.is_none() {
                    let (reached, lands) = grid.next();
                    return Ok(Reach {
                        stop,
                        reached,
                        length: grid.length,
                        lands,
                        smallest: finest,
                    });
                }
                (stop, grid.length, finest)
            }
            Pace::Adaptive(adaptive) => {
                let smallest = adaptive.smallest_step.max(finest);
                let largest = adaptive.largest_step.min(self.info.longest_step);
                self.h = self.h.min(largest).max(smallest);
                // A user force must be evaluated once per sample at least, so steps end on rows. While an implicit
                // method settles, the interpolant still contains the fast motion that the explicit method let grow, so
                // rows are taken at ends of steps.
                let stop = match self.info.longest_step.is_finite() || self.settles > 0 {
                    true => self.breakpoint.min(self.schedule.next_row()),
                    false => self.breakpoint,
                };
                (stop, self.h, smallest)
            }
        };
        let wanted = match self.approach {
            Some(approach) => approach.length.min(wanted).max(finest),
            None => wanted,
        };
        let (length, lands) = match pace {
            Pace::Fixed(_) => (wanted.min(stop - t), wanted >= stop - t),
            Pace::Adaptive(_) => match to_meet(stop - t, wanted) {
                [true, _] => (stop - t, true),
                [false, true] => (0.5 * (stop - t), false),
                [false, false] => (wanted, false),
            },
        };
        // the length is the difference of rounded times: adding up a million rounded lengths would accumulate as many
        // roundings
        let reached = if lands { stop } else { t + length };
        Ok(Reach {
            stop,
            reached,
            length: reached - t,
            lands,
            smallest,
        })
    }

    /// True if the step just tried is to be accepted; otherwise sets the length of the next try. `hop` is the share of
    /// a fixed step that may cross a kink.
    fn good(&mut self, step: &mut dyn Stepper<T>, reach: &Reach, hop: f64) -> Result<bool, End> {
        let pace = self.settings.method.pace;
        let length = reach.length;
        let error = self.error(step);
        let locate = self.settings.locate && !self.kinks.is_empty();
        if locate && self.restless < RESTLESS && matters(pace, error, length, hop) {
            let nearer = self.approach(step, error);
            if nearer.is_some() {
                self.approach = nearer;
                return Ok(false);
            }
        }

        self.easy = self.is_easy(error, length);
        if self.may_hide()
            && let Some(part) = self.hidden(step)
        {
            self.searches += 1;
            self.h = part * length;
            self.approach = None;
            return Ok(false);
        }
        self.searches = 0;

        if let Some(error) = error.filter(|error| *error <= 1.0) {
            self.ahead.copy_from_slice(step.span().end);
            self.model.normalize(self.ahead);
            self.arrive(reach.reached);
            if let Some(found) = self.stepped_over(step)
                && self.turns_back(step, found)
            {
                return Ok(false);
            }
            if let (Pace::Adaptive(_), None) = (pace, self.approach) {
                let grown = length * self.controller.accepted(error);
                // the length of a step cut short to meet a kink says little about the next one
                self.h = if length < self.h {
                    self.h.max(grown)
                } else {
                    grown
                };
            }
            return Ok(true);
        }
        // a fixed step gets here only if its result is not finite
        let shorter = length * self.controller.rejected(error);
        if matches!(pace, Pace::Fixed(_)) || shorter < reach.smallest {
            self.report.rejected += 1;
            return Err(self.too_small(step, error, shorter));
        }
        match &mut self.approach {
            Some(approach) => approach.length = shorter,
            None => self.h = shorter,
        }
        Ok(false)
    }

    /// The estimated error over the tolerance; 0 for a fixed step; `None` if a value is not finite.
    fn error(&mut self, step: &mut dyn Stepper<T>) -> Option<f64> {
        match self.settings.method.pace {
            Pace::Fixed(_) => first_non_finite(step.span().end).is_none().then_some(0.0),
            Pace::Adaptive(adaptive) => {
                step.estimate(self.spare);
                let span = step.span();
                let error = self.allowed.error(span.y, span.end, self.spare)?;
                let controlled = self.accelerations.controlled() || adaptive.switches;
                Some(match error <= 1.0 && controlled {
                    true => error.max(self.error_of_accelerations(step)),
                    false => error,
                })
            }
        }
    }

    /// The error of the accelerations at the end of a step, over what is allowed. Only for a step whose other errors
    /// are within tolerance.
    fn error_of_accelerations(&mut self, step: &mut dyn Stepper<T>) -> f64 {
        if step.switched() {
            return self.error_of_slopes(step);
        }
        self.h_lambda_fourth = 0.0;
        step.finish(&mut self.f);
        let (Some(near), Some(last)) = (step.neighbour(self.inside), step.end_rate()) else {
            return 0.0;
        };
        let span = step.span();
        let coordinates = self.info.coordinates.len();
        let size = |value: T| value.abs().to_f64();
        let mut difference = EndDifference::new();
        for i in 0..coordinates + self.info.velocities.len() {
            let between = [size(span.end[i] - self.inside[i]), size(last[i] - near[i])];
            let y = size(span.end[i]);
            match i < coordinates {
                true => difference.coordinate(y, between),
                false => {
                    let ends = [size(self.rate[i]), size(last[i])];
                    difference.velocity(kind(self.info, i), y, between, ends);
                }
            }
        }
        let of = [span.h, 1.0];
        let epsilon = epsilon_of::<T>();
        // states of force laws do not contribute to accelerations, but may be what limits stable steps
        let mut fastest = Fastest::default();
        for i in 0..self.info.varying_length() {
            let group = usize::from(i >= coordinates)
                + usize::from(i >= coordinates + self.info.velocities.len());
            let between = [size(span.end[i] - self.inside[i]), size(last[i] - near[i])];
            fastest.add(group, size(span.end[i]), between, epsilon);
        }
        self.h_lambda_fourth = fastest.h_lambda_fourth(span.h);
        if !self.accelerations.controlled() {
            return 0.0;
        }
        let mut error = self.accelerations.error::<Basic>(&difference, of, epsilon);
        if error > 1.0 && self.accelerations.asks(true) {
            let t = T::from_f64(self.f.time(span.t));
            let [one, other] = &mut self.powers;
            let found = effect_accelerations(self.model, t, span.y, self.inside, [one, other]);
            self.accelerations.learn(true, mapped(found, T::to_f64));
            error = self.accelerations.error::<Basic>(&difference, of, epsilon);
        }
        self.accelerations
            .leave(&difference, span.h, error <= 1.0, error > 1.0);
        error
    }

    /// [`TimeLoop::error_of_accelerations`] for an implicit step, which damps motions that are too fast for it.
    /// Compares the slope of the interpolant with the derivative at the start, in the middle and at the end of the
    /// step. At the start the two differ as long as a decay or an oscillation goes on that is faster than the step.
    fn error_of_slopes(&mut self, step: &mut dyn Stepper<T>) -> f64 {
        step.finish(&mut self.f);
        if self.settles > 0 {
            let settled = step.noise(self.spare) >= SETTLED;
            self.settles = if settled { 0 } else { self.settles - 1 };
            return 0.0;
        }
        let (t, h) = (step.span().t, step.span().h);
        let first = self.info.coordinates.len();
        let velocities = first..first + self.info.velocities.len();
        let size = |value: T| value.abs().to_f64();
        let mut largest = [0.0f64; 2];
        // both states are free until the step is accepted
        let (apart, between) = (&mut *self.renewed, &mut *self.ahead);
        apart.fill(T::from_f64(0.0));
        for theta in [0.0, 0.5, 1.0] {
            step.slope(theta, self.spare);
            let rate = match (theta, step.end_rate()) {
                (0.0, _) => &*self.rate,
                (1.0, Some(rate)) => rate,
                _ => {
                    step.interpolate(theta, self.inside);
                    self.f.at(t + theta * h, self.inside, between);
                    &*between
                }
            };
            for i in velocities.clone() {
                let largest = &mut largest[kind(self.info, i)];
                *largest = largest.max(size(rate[i]));
                apart[i] = apart[i].max((self.spare[i] - rate[i]).abs());
            }
        }
        let reach = step.noise(self.spare);
        self.accelerations.see(largest);
        let [apart, noise] = [&*self.renewed, &*self.spare];
        let share = |accelerations: &Accelerations<f64>| {
            velocities.clone().fold(0.0f64, |worst, i| {
                let of = [size(apart[i]), size(noise[i])];
                worst.max(accelerations.share(kind(self.info, i), of, reach))
            })
        };
        let mut error = share(&self.accelerations);
        if error > 1.0 && self.accelerations.asks(true) {
            let [one, other] = &mut self.powers;
            let y = &*step.span().y;
            let at = T::from_f64(self.f.time(t));
            let found = effect_accelerations(self.model, at, y, self.inside, [one, other]);
            self.accelerations.learn(true, mapped(found, T::to_f64));
            error = share(&self.accelerations);
        }
        error
    }

    /// Moves the run to the end of an accepted step, or to the first sign change of an event function within it.
    fn land(&mut self, step: &mut dyn Stepper<T>, reach: &Reach) -> Landing {
        let begin = self.report.t;
        let mut landing = Landing {
            begin,
            length: reach.length,
            whole: true,
            forced: match (self.approach, reach.lands) {
                (Some(Approach { kink, .. }), _) => Some(Cause::Kink(kink)),
                (None, true) if reach.stop >= self.settings.duration => Some(Cause::End),
                (None, true) if reach.stop < self.breakpoint => Some(Cause::Sample),
                (None, true) => Some(Cause::Breakpoint),
                (None, false) => None,
            },
        };
        let mut t = reach.reached;
        if let Some((event_function, end)) = self.event_function_within(step) {
            let theta = self.way_to_event_function(step, end);
            let ends = begin + theta * reach.length;
            let lengths = [ends - begin, reach.length];
            let finest = finest_of::<T>(begin);
            let goes_on = self.standing.goes_on(lengths, finest, WIDTH);
            if theta < 1.0 && !goes_on {
                inside(self.model, step, theta, self.ahead);
                self.arrive(ends);
                t = ends;
                landing.whole = false;
                landing.length = ends - begin;
            }
            self.report.events += 1;
            landing.forced = Some(Cause::EventFunction(event_function));
        }
        if landing.whole {
            self.standing.forget();
        }
        core::mem::swap(&mut self.y, &mut self.ahead);
        self.report.t = t;
        landing
    }

    /// Ends the approach to a kink if the accepted step has passed it; else sets the length of the next step towards
    /// it.
    fn leave_kink(&mut self, step: &dyn Stepper<T>, landing: &Landing) {
        if let Some(approach) = self.approach {
            let crossed = self.kink_within(step).is_some();
            let left = approach.at - self.report.t;
            let length = match left > 0.0 {
                true => 1.5 * left,
                false => 4.0 * landing.length,
            };
            let passed = match self.settings.method.pace {
                Pace::Fixed(step) => length >= step,
                Pace::Adaptive(_) => length >= self.h,
            };
            self.approach = Some(Approach { length, ..approach });
            if crossed || !landing.whole || passed {
                self.report.events += u64::from(crossed);
                self.approach = None;
                self.restless += 1;
                self.controller = Controller::new(step.order_of_estimate());
            }
        } else {
            self.restless = 0;
        }
        self.kinks_known = false;
        if self.approach.is_some() {
            // the kinks must be evaluated before memory is renewed
            self.know_kinks();
        }
    }

    /// Prepares the next step to begin where this one ended. Returns false at the end of the run.
    fn begin(
        &mut self,
        step: &dyn Stepper<T>,
        reach: &Reach,
        landing: &Landing,
        renewed: Renewed,
    ) -> Result<bool, End> {
        let arrived = landing.whole && reach.lands && reach.stop >= self.breakpoint;
        self.past = 0.0;
        if arrived {
            if self.breakpoint >= self.settings.duration {
                return Ok(false);
            }
            // the derivative changes at the kink
            self.breakpoint = self.breakpoint_after(self.report.t);
            self.f.latest = self.breakpoint.next_down();
            self.controller = Controller::new(step.order_of_estimate());
            self.approach = None;
        }
        let whole = landing.whole && !arrived;
        let smooth = whole && renewed == Renewed::No;
        match step.end_rate().filter(|_| smooth) {
            // normalizing a state moves it by no more than the error of the step
            Some(rate) => self.rate.copy_from_slice(rate),
            None => self.f.at(self.report.t, self.y, self.rate),
        }
        if smooth || (whole && renewed == Renewed::Alike && self.moves_alike(step, landing.length))
        {
            self.past = landing.length;
        }
        if arrived {
            self.check_rate()?;
            if let Some(watch) = &mut self.watch {
                watch.begin(self.model, self.report.t, self.y);
            }
        }
        if let (Some(watch), Pace::Fixed(_), true) =
            (&mut self.watch, self.settings.method.pace, smooth)
        {
            watch.compare(step, self.y, self.rate, self.spare);
        }
        Ok(true)
    }

    /// Evaluates event functions, onsets, memory and what the watch needs at the state ahead and this time, which ends
    /// a step or the first part of one.
    fn arrive(&mut self, t: f64) {
        // the watch closes its balances just before a kink of a curve of time
        let closed = self.f.time(t);
        let watched = self.watch.is_some();
        if watched && closed != t {
            self.arrive_at(closed, State::Ahead, true);
        }
        self.arrive_at(t, State::Ahead, watched && closed == t);
    }

    /// [`TimeLoop::arrive`] for either state; `watched` says whether to evaluate what the watch needs.
    fn arrive_at(&mut self, t: f64, of: State, watched: bool) {
        let renewed = self.info.length(Section::Renewed);
        let mut wanted = [
            (Section::EventFunctions, &mut *self.event_functions_ahead),
            (Section::Onsets, self.onsets.at(STORED_END)),
            (Section::Renewed, &mut self.renewed[..renewed]),
            // what a watch needs, if there is one
            (Section::Curves, &mut []),
            (Section::KineticEnergy, &mut []),
            (Section::Powers, &mut []),
            (Section::Momentum, &mut []),
            (Section::ExternalWrench, &mut []),
        ];
        let state = match of {
            State::Ahead => &*self.ahead,
            State::Reached => &*self.y,
        };
        if let Some(watch) = self.watch.as_mut().filter(|_| watched) {
            for (place, needed) in wanted[3..].iter_mut().zip(watch.arrival()) {
                *place = needed;
            }
        }
        self.model.sections(T::from_f64(t), state, &mut wanted);
    }

    /// Evaluates the kink functions at the start of the next step, unless they are known.
    fn know_kinks(&mut self) {
        if !self.kinks_known {
            let t = T::from_f64(self.report.t);
            self.model.kinks(t, self.y, self.kinks);
            self.kinks_known = true;
        }
    }

    /// Renews the memory of force laws, and the charts of Bryant angles with their coordinates, at the state reached.
    /// Repeats this until nothing changes, because one switch may trigger another. Each event function stands for at
    /// most one link of such a chain. Afterwards event functions and onsets are those of the renewed state; `watched`
    /// says whether to evaluate what the watch needs, too.
    fn renew(&mut self, watched: bool) -> Renewed {
        if self.info.memory.is_empty() || self.y == self.renewed {
            return Renewed::No;
        }
        let before = &mut self.values[..self.event_functions.len()];
        before.copy_from_slice(self.event_functions_ahead);
        self.onsets.keep();
        for _ in 0..=self.event_functions.len() {
            core::mem::swap(&mut self.y, &mut self.renewed);
            self.arrive_at(self.report.t, State::Reached, watched);
            if self.y == self.renewed {
                break;
            }
        }
        let before = &self.values[..self.event_functions.len()];
        match before == self.event_functions_ahead && self.onsets.as_kept() {
            true => Renewed::Alike,
            false => Renewed::Other,
        }
    }

    /// True if the motion goes on as before although memory was renewed: the change of the derivative, over a step of
    /// this length, makes no more than the allowed error. This holds for a hysteresis under load, whose memory follows
    /// the state. Always false for fixed steps, for which no error is allowed.
    fn moves_alike(&mut self, step: &dyn Stepper<T>, length: f64) -> bool {
        let (Pace::Adaptive(_), Some(before)) = (self.settings.method.pace, step.end_rate()) else {
            return false;
        };
        for (change, (rate, before)) in self.spare.iter_mut().zip(self.rate.iter().zip(before)) {
            *change = T::from_f64(length) * (*rate - *before);
        }
        self.allowed.norm(self.spare, self.y) <= 1.0
    }
}
