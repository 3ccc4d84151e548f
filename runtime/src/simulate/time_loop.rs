//! The time loop of all methods.
//!
//! ```text
//! length of the step ← pace (fixed, or the controller's), cut to meet the next kink in time, or the way to a kink of a force law
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

use super::event::{PLACES, WIDTH, inside};
use super::schedule::{Grid, Schedule, to_meet};
use super::standing::Standing;
use super::watch::Watch;
use super::{Cause, Observer, Pace, Receiver, Report, Settings};
use crate::failure::Reason;
use crate::integrate::acceleration::{
    Accelerations, EndDifference, Fastest, effect_accelerations, kind,
};
use crate::integrate::control::{Allowed, Basic, Controller, Tolerances, first_step};
use crate::integrate::workspace::Workspace;
use crate::integrate::{Evaluator, Stepper, first_non_finite};
use crate::{Arrival, Dynamics, Info, Real};
use count::Vote;
use onset::{END, KEPT, Onsets};
use search::{Approach, HOP, HOP_OF_FEW_DIGITS, RESTLESS, matters};
#[cfg(feature = "std")]
pub(crate) use search::{EASY, SEARCHES};

/// Tries of an implicit method, and the h|λ| of the fastest motion, until what the explicit method has let grow is damped. That is an oscillation within the
/// share of accelerations that is allowed, or one that is lost in roundings of the coordinates, or of which nobody can say more than the tolerances do.
const SETTLES: u32 = 20;
const SETTLED: f64 = 1e3;
/// The first step that is tried of an implicit method, over the last one of the explicit method. Where h|λ| is about 1, what the explicit method has let grow
/// is an error as large as is allowed, and is damped slowly; in a step that is far longer it makes an error that falls like 1/(h|λ|), and is gone.
const LEAP: f64 = 1e5;

/// Why the time loop is left before the end of the run.
pub(crate) enum End {
    /// The receiver of the samples or the observer asked for it. It can go on.
    Stopped,
    Failed(Reason),
}

/// How far a step goes.
struct Reach {
    /// The next time that a step must end at \[s\].
    stop: f64,
    /// Where this one ends \[s\].
    reached: f64,
    /// How long it is \[s\]: what the clock says but for its rounding.
    length: f64,
    /// Whether that is there.
    lands: bool,
    /// A shorter step is a failure \[s\].
    smallest: f64,
}

/// A step that was accepted, and all that the next one needs of it.
struct Landed {
    reach: Reach,
    landing: Landing,
    /// The time where it ended \[s\].
    end: f64,
    /// Where it is watched: the kinetic energy before it, and what was exchanged in it \[J\].
    energy: Option<[f64; 2]>,
}

/// What renewing memory changed.
#[derive(Clone, Copy, PartialEq)]
enum Renewed {
    /// Nothing.
    No,
    /// Memory, but neither event functions nor onsets.
    Alike,
    /// More than that.
    Other,
}

/// Which state something is wanted of.
#[derive(Clone, Copy)]
enum State {
    /// That where a step leads.
    Ahead,
    /// That which is reached.
    Reached,
}

/// Where a step that was accepted ended.
struct Landing {
    /// Where it began \[s\].
    begin: f64,
    /// How long it is \[s\].
    length: f64,
    /// Whether it went all the way; otherwise an event function changed its sign in it.
    whole: bool,
    /// What forced its length, if not its error.
    forced: Option<Cause>,
}

/// A length of time that is more than rounding at `t`.
pub(crate) fn finest(t: f64) -> f64 {
    16.0 * (t.next_up() - t)
}

/// The same as a scalar tells the time, at which it evaluates the equations: of singles 2²⁹ times as long. Over less, nothing that it computes is
/// of another time.
fn finest_of<T: Real>(t: f64) -> f64 {
    epsilon_of::<T>() / f64::EPSILON * finest(t)
}

/// The distance from 1 to the next number of a scalar: of doubles, or of singles.
pub(crate) fn epsilon_of<T: Real>() -> f64 {
    match T::from_f64(1.0 + 1e-10).to_f64() == 1.0 {
        true => f64::from(f32::EPSILON),
        false => f64::EPSILON,
    }
}

/// The time loop of a run; the time reached is `report.t`. It can be left at a sample and entered again, which changes no bit of what follows.
pub(crate) struct TimeLoop<'a, 'w, T: Real> {
    model: &'a dyn Dynamics<T>,
    info: &'static Info,
    f: Evaluator<'a, T>,
    settings: Settings,
    pub schedule: Schedule,
    watch: Option<&'a mut Watch<'w, T>>,
    report: Report,
    /// What forced most of the last steps before there are too many.
    vote: Vote,
    /// Whether the first step may be taken.
    opened: bool,
    /// The last step, as long as samples in it may be delivered.
    landed: Option<Landed>,

    /// The state reached, and its derivative as far as the next step needs it.
    y: &'a mut [T],
    rate: &'a mut [T],
    /// Where a step leads, and what renewing memory makes of that.
    ahead: &'a mut [T],
    renewed: &'a mut [T],
    /// The event functions where the step before began, where this one begins, and where it ends.
    event_functions_past: &'a mut [T],
    event_functions: &'a mut [T],
    event_functions_ahead: &'a mut [T],
    /// Length of the step before \[s\]; 0 where this one goes on otherwise than it ended.
    past: f64,
    /// Whether it is not accuracy that decides the length of this step.
    easy: bool,
    /// The kinks where this step begins, once they are asked for.
    kinks: &'a mut [T],
    kinks_known: bool,
    onsets: Onsets<'a, T>,
    /// Errors allowed, which count where steps are chosen by them.
    allowed: Allowed<'a, T>,
    accelerations: Accelerations<f64>,
    /// (h|λ|)⁴ of the last try by an explicit method that may be changed, and tries of this step that were rejected.
    fastness: f64,
    retries: u64,
    /// Tries left in which an implicit method may damp what the explicit one has let grow.
    settles: u32,
    /// Room for the powers of all effects, twice.
    powers: [&'a mut [T]; 2],

    /// What the controller asks for next \[s\].
    h: f64,
    controller: Controller<f64>,
    /// Fixed steps.
    grid: Option<Grid>,
    /// The next kink of a curve of time, or the end of the run \[s\].
    breakpoint: f64,
    approach: Option<Approach>,
    /// Kinks in a row that were approached, and steps in a row that were taken again because of something hidden in them.
    restless: u32,
    standing: Standing,
    searches: u32,

    /// A state within a step; another one; values of event functions or kinks at [`PLACES`] places; outputs; arguments of curves.
    inside: &'a mut [T],
    spare: &'a mut [T],
    values: &'a mut [T],
    outputs: &'a mut [T],
    curves: &'a mut [T],
}

/// Scalars of workspace that a run takes, but for those of its step.
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

/// How many values of event functions or kinks are kept at the same time.
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
            fastness: 0.0,
            retries: 0,
            settles: 0,
            powers: [(); 2].map(|()| workspace.part(info.powers.len())),
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

    /// What the run took so far.
    pub fn report(&self) -> Report {
        Report {
            evaluations: self.f.count,
            jacobians: self.f.jacobians,
            ..self.report
        }
    }

    /// By one method to the end of the run, or until it is to stop; from where it was left before.
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
            if let Some(landed) = self.landed.take() {
                self.leave(step, landed)?;
            }
            if self.report.t >= self.settings.duration {
                return Ok(());
            }
            self.landed = Some(self.step(step, &mut observer)?);
        }
    }

    /// Everything before the first step.
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

        self.breakpoint = self.schedule.kink_after(self.model, start);
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

    /// Takes a step, as often as it needs to be accepted.
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

    /// Leaves a step that was accepted, for the next one.
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
        let renewed = self.renew(true);
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

    /// Lets a step change its formula, where the scene has become stiff or is no longer.
    fn turn(&mut self, step: &mut dyn Stepper<T>, landing: &Landing) {
        let retries = core::mem::take(&mut self.retries);
        let Some(turn) = step.turn(landing.length, retries, self.fastness) else {
            return;
        };
        self.h = self.h.min(turn.longest);
        if turn.leaps {
            self.h *= LEAP;
            self.settles = SETTLES;
            self.accelerations.forget();
        }
        self.controller = Controller::new(step.order_of_estimate());
        // the derivative at the end of the last step is no longer at hand
        self.past = 0.0;
    }

    /// How far the next step goes.
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
                // a user force is looked at in each sample at least; and within a step that damps what the explicit method has let grow, the interpolant
                // still has its share of that, so a row is at its end
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
        // the step is as long as the clock will say: a million rounded additions would put it off by as many roundings
        let reached = if lands { stop } else { t + length };
        Ok(Reach {
            stop,
            reached,
            length: reached - t,
            lands,
            smallest,
        })
    }

    /// Whether a step is to be accepted; otherwise it is known how long the next try is. `hop` is the share of a fixed step that may cross a
    /// kink.
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
                // a step cut short to meet a kink says little of the next
                self.h = if length < self.h {
                    self.h.max(grown)
                } else {
                    grown
                };
            }
            return Ok(true);
        }
        // the fixed step that is not finite, too
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

    /// Estimated error over tolerance; 0 of a fixed step; `None` where something is not finite.
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

    /// Of a step that is good otherwise: the error of the accelerations at its end over what is allowed.
    fn error_of_accelerations(&mut self, step: &mut dyn Stepper<T>) -> f64 {
        if step.switched() {
            return self.error_of_slopes(step);
        }
        self.fastness = 0.0;
        step.finish(&mut self.f);
        let (Some(near), Some(last)) = (step.neighbour(self.inside), step.end_rate()) else {
            return 0.0;
        };
        let span = step.span();
        let coordinates = self.info.coordinates.len();
        let size = |value: T| value.abs().to_f64();
        let mut difference = EndDifference::new();
        for i in 0..coordinates + self.info.velocities.len() {
            let between = [span.end[i] - self.inside[i], last[i] - near[i]].map(size);
            let y = size(span.end[i]);
            match i < coordinates {
                true => difference.coordinate(y, between),
                false => {
                    let ends = [self.rate[i], last[i]].map(size);
                    difference.velocity(kind(self.info, i), y, between, ends);
                }
            }
        }
        let of = [span.h, 1.0];
        let epsilon = epsilon_of::<T>();
        // states of laws have no share in accelerations, but may be what bounds the steps
        let mut fastest = Fastest::default();
        for i in 0..self.info.varying_length() {
            let group = usize::from(i >= coordinates)
                + usize::from(i >= coordinates + self.info.velocities.len());
            let between = [span.end[i] - self.inside[i], last[i] - near[i]].map(size);
            fastest.add(group, size(span.end[i]), between, epsilon);
        }
        self.fastness = fastest.reach(span.h);
        if !self.accelerations.controlled() {
            return 0.0;
        }
        let mut error = self.accelerations.error::<Basic>(&difference, of, epsilon);
        if error > 1.0 && self.accelerations.asks(true) {
            let t = T::from_f64(self.f.time(span.t));
            let [one, other] = &mut self.powers;
            let found = effect_accelerations(self.model, t, span.y, self.inside, [one, other]);
            self.accelerations.learn(true, found.map(T::to_f64));
            error = self.accelerations.error::<Basic>(&difference, of, epsilon);
        }
        self.accelerations
            .leave(&difference, span.h, error <= 1.0, error > 1.0);
        error
    }

    /// The same of an implicit step, which damps what is too fast for it: the slope of its interpolant is compared with the derivative there, where the step
    /// begins, in its middle and where it ends. The slope at the beginning is not the derivative for as long as a decay or an oscillation goes on that
    /// is faster than the step.
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
        // neither state is needed before the step is accepted
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
            self.accelerations.learn(true, found.map(T::to_f64));
            error = share(&self.accelerations);
        }
        error
    }

    /// Takes over the end of a step that is accepted. It is cut short where an event function changes its sign.
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

    /// Whether the kink that was approached is behind the step just accepted.
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
            // before memory is renewed
            self.know_kinks();
        }
    }

    /// The next step begins where this one ended, unless that is the end of the run. Whether there is one.
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
            // beyond the kink the derivative is another one
            self.breakpoint = self.schedule.kink_after(self.model, self.report.t);
            self.f.latest = self.breakpoint.next_down();
            self.controller = Controller::new(step.order_of_estimate());
            self.approach = None;
        }
        let whole = landing.whole && !arrived;
        let smooth = whole && renewed == Renewed::No;
        match step.end_rate().filter(|_| smooth) {
            // putting a state back on its manifold moves it by no more than the error of the step
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

    /// Evaluates what is wanted of the state ahead, at this time: the end of a step, or of the first part of one.
    fn arrive(&mut self, t: f64) {
        // balances are closed just before a kink of a curve of time
        let closed = self.f.time(t);
        let watched = self.watch.is_some();
        if watched && closed != t {
            self.arrive_at(closed, State::Ahead, true);
        }
        self.arrive_at(t, State::Ahead, watched && closed == t);
    }

    /// The same of one of two states, with what the watch wants or without.
    fn arrive_at(&mut self, t: f64, of: State, watched: bool) {
        let (curves, account) = match self.watch.as_mut().filter(|_| watched) {
            Some(watch) => {
                let (curves, account) = watch.arrival();
                (curves, Some(account))
            }
            None => (&mut [][..], None),
        };
        let mut arrival = Arrival {
            event_functions: self.event_functions_ahead,
            onsets: self.onsets.at(END),
            renewed: self.renewed,
            curves,
            account,
        };
        let state = match of {
            State::Ahead => &*self.ahead,
            State::Reached => &*self.y,
        };
        self.model.arrive(T::from_f64(t), state, &mut arrival);
    }

    /// Evaluates the kinks where the next step begins, unless they are known.
    fn know_kinks(&mut self) {
        if !self.kinks_known {
            let t = T::from_f64(self.report.t);
            self.model.kinks(t, self.y, self.kinks);
            self.kinks_known = true;
        }
    }

    /// Renews the memory of force laws, and the charts of Bryant angles with their coordinates, from the state reached, until that
    /// changes nothing: what one switch does may be what another waits for. Each event function stands for at most one link of such a chain.
    /// What is wanted of that state is known before and after; `watched` says whether with what the watch wants.
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

    /// Whether the motion goes on as it did in a step of this length, although memory was renewed: over such a step, the change of the derivative,
    /// which is known, makes no more than the error allowed. So it is of a hysteresis under load, whose memory goes along with the state. Never of
    /// fixed steps, for which no error is allowed.
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
