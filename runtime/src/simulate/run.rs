//! A run in progress: the time loop of all methods.
//!
//! ```text
//! length of the step ← pace (fixed, or the controller's), cut to meet the next kink in time, or the way to a kink of a force law
//! take it
//!   error too large, or a kink crossed that matters   → again, shorter
//!   else a guard changed its sign                     → ends there
//! work, samples, memory of force laws; the next step begins
//! ```
//!
//! **Kinks.** A step that crosses a kink has stages on both sides of it, and whatever is made of them, its result and its
//! interpolant alike, is of order 1 or 2 only. It is taken again so that it ends a little before the place where the
//! interpolant has the kink, and the next goes over it: as the rest of the way shrinks by a large factor each time, so does the error of crossing,
//! until it no longer matters: against the tolerance where there is one, in length where steps are fixed.

use super::balance;
use super::event::{self, Zero};
use super::schedule::{Grid, Schedule, to_meet};
use super::watch::Watch;
use super::{Cause, Pace, Report, Sample, Settings, once};
use crate::failure::{Culprit, Quantity, Reason};
use crate::integrate::control::{self, Controller, Tolerances, first_step};
use crate::integrate::{Evaluator, NotFinite, Stepper, first_non_finite};
use crate::{Extrapolate, Model, Real, Vector};
use core::ops::ControlFlow;

/// Why a run ends before its duration.
pub(crate) enum End {
    /// The receiver of the samples asked for it.
    Stopped,
    Failed(Reason),
}

/// Steps before the last that is allowed among which it is counted what forces them.
const VOTERS: u64 = 1000;
/// A pivot below this share of what stands in its place before has lost half of its digits, and accelerations have with it.
const VANISHES: f64 = 1e-8;

/// The majority of what is counted (Boyer & Moore), without keeping it.
#[derive(Clone, Copy)]
struct Vote {
    cause: Cause,
    lead: u32,
}

impl Vote {
    fn count(&mut self, cause: Cause) {
        if cause == self.cause {
            self.lead += 1;
        } else if self.lead > 0 {
            self.lead -= 1;
        } else {
            (self.cause, self.lead) = (cause, 1);
        }
    }
}

/// Share of a fixed step that may cross a kink, and that of a scalar with few digits, whose state a shorter step does not move.
const HOP: f64 = 1e-9;
const HOP_OF_FEW_DIGITS: f64 = 1e-4;
/// How far before a kink a step ends, as a share of the way to it: little enough that it is worth it, and more than what the
/// interpolant errs by, which is less each time.
const MARGINS: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Tries to come near a kink before it is crossed all the same.
const ROUNDS: usize = 12;
/// Kinks in a row, with no whole step between them, before they are left to the control of the error: a motion that
/// rests on a kink would never get on.
const RESTLESS: u32 = 50;

/// Where the estimated error is as much smaller than the tolerance, it is not accuracy that decides the length of steps: they
/// may grow over whatever they do not meet, and what lies within them is looked for. So it is within steps longer than the time
/// between samples, whatever their error: Dormand & Prince 5(4), for one, does not see at all what its second stage meets alone,
/// since that stage and all it leads to have weight 0.
pub(crate) const EASY: f64 = 1e-2;
/// Times in a row that a step is taken again because of something within it.
pub(crate) const SEARCHES: u32 = 8;

/// On the way to a kink.
#[derive(Clone, Copy)]
struct Approach {
    /// Which.
    kink: usize,
    /// Where it is expected \[s\].
    at: f64,
    /// Length of the next step \[s\].
    length: f64,
    /// Tries so far.
    round: usize,
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

/// A length of time that is more than rounding at `t`.
pub(crate) fn finest(t: f64) -> f64 {
    16.0 * (t.next_up() - t)
}

/// Whether crossing a kink in a step of this length and error would matter.
fn matters(pace: Pace, error: Option<f64>, length: f64, hop: f64) -> bool {
    match (pace, error) {
        (_, None) => false,
        (Pace::Fixed(step), Some(_)) => length > hop * step,
        (Pace::Adaptive(_), Some(error)) => error > 1.0,
    }
}

/// A run in progress; the time reached is `report.t`.
pub(crate) struct Run<'a, M: Model<T>, T: Real, F> {
    model: &'a M,
    f: Evaluator<'a, T, M>,
    y: M::State,
    schedule: Schedule,
    settings: &'a Settings,
    sink: &'a mut F,
    report: Report,
    grid: Option<Grid>,
    watch: Option<&'a mut Watch<T, M>>,
    /// What forced most of the last steps before there are too many.
    vote: Vote,
}

impl<'a, T, M, F> Run<'a, M, T, F>
where
    T: Real,
    M: Model<T>,
    F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
{
    #[inline(always)]
    pub fn new(
        model: &'a M,
        initial: M::State,
        settings: &'a Settings,
        watch: Option<&'a mut Watch<T, M>>,
        sink: &'a mut F,
    ) -> Self {
        Run {
            grid: None,
            watch,
            vote: Vote {
                cause: Cause::First,
                lead: 0,
            },
            model,
            f: Evaluator::new(model),
            y: initial,
            schedule: Schedule::new(settings),
            settings,
            sink,
            report: Report {
                t: 0.0,
                steps: 0,
                rejected: 0,
                events: 0,
                evaluations: 0,
                jacobians: 0,
                samples: 0,
                smallest_step: f64::INFINITY,
                smallest_step_at: 0.0,
                smallest_step_for: Cause::End,
                largest_step: 0.0,
            },
        }
    }

    /// What was asked for.
    #[inline(always)]
    pub fn settings(&self) -> &Settings {
        self.settings
    }

    /// What the run took so far.
    #[inline(always)]
    pub fn report(&self) -> Report {
        Report {
            evaluations: self.f.count,
            jacobians: self.f.jacobians,
            ..self.report
        }
    }

    /// To the end, by one method. Each has a frame of its own, for that of the Rosenbrock method holds two matrices.
    #[inline(never)]
    pub fn go<S: Stepper<T, M>>(&mut self) -> Result<(), End> {
        let pace = self.settings.method.pace;
        let limit = self.settings.max_steps;
        let locate = self.settings.locate && M::Kinks::LEN > 0;
        let few_digits = T::from_f64(1.0 + 1e-10).to_f64() == 1.0;
        let hop = if few_digits { HOP_OF_FEW_DIGITS } else { HOP };
        self.renew();
        if let Some(watch) = &mut self.watch {
            watch.open(self.model, &self.y, self.settings);
        }
        let rate = self.f.at(0.0, &self.y);
        self.check_rate(&rate)?;
        self.deliver()?;

        let mut breakpoint = self.schedule.kink_after::<T, M>(self.model, 0.0);
        self.f.latest = breakpoint.next_down();
        // what the controller asks for next
        let mut h = match pace {
            Pace::Fixed(step) => step,
            Pace::Adaptive(adaptive) => adaptive.first_step.unwrap_or_else(|| {
                let (order, largest) = (S::ESTIMATE - 1, adaptive.largest_step.min(breakpoint));
                let tolerances = &adaptive.tolerances;
                first_step(&mut self.f, &self.y, &rate, tolerances, largest, order)
            }),
        };
        let mut controller = Controller::new(S::ESTIMATE);
        let mut step = S::new(self.model, 0.0, self.y, rate);
        let mut guards = self.guards();
        // where this step begins, once asked for
        let mut kinks: Option<M::Kinks> = None;
        let mut approach: Option<Approach> = None;
        let mut restless = 0;
        let mut searches = 0;

        while self.report.t < self.settings.duration {
            if self.report.steps + self.report.rejected >= limit {
                return Err(End::Failed(Reason::TooManySteps {
                    limit,
                    cause: self.vote.cause,
                    step: self.latest(&step),
                }));
            }
            let t = self.report.t;
            let Reach {
                stop,
                reached,
                length,
                lands,
                smallest,
            } = self.reach(pace, breakpoint, approach.as_ref(), &mut h)?;
            step.take(&mut self.f, length);
            let error = self.error(&step, pace);

            if locate && restless < RESTLESS && matters(pace, error, length, hop) {
                let before = *kinks.get_or_insert_with(|| once::kinks(self.model, t, &self.y));
                let round = approach.map_or(0, |approach| approach.round);
                let nearer = self.approach(&mut step, &before, round, error);
                if nearer.is_some() {
                    self.report.rejected += 1;
                    approach = nearer;
                    continue;
                }
            }

            let blind = match error {
                Some(error) => error < EASY || (error <= 1.0 && length > self.settings.every),
                None => false,
            };
            if blind && searches < SEARCHES {
                let adaptive = matches!(pace, Pace::Adaptive(_));
                if let Some(part) = adaptive.then(|| self.hidden(&mut step, &guards)).flatten() {
                    self.report.rejected += 1;
                    searches += 1;
                    h = part * length;
                    approach = None;
                    continue;
                }
            }
            searches = 0;

            if let Some(error) = error.filter(|error| *error <= 1.0) {
                if let (Pace::Adaptive(_), None) = (pace, approach) {
                    let grown = length * controller.accepted(error);
                    // a step cut short to meet a kink says little of the next
                    h = if length < h { h.max(grown) } else { grown };
                }
            } else {
                // the fixed step that is not finite, too
                let factor = controller.rejected(error);
                self.report.rejected += 1;
                let shorter = length * factor;
                if matches!(pace, Pace::Fixed(_)) || shorter < smallest {
                    return Err(self.too_small(&mut step, error, shorter));
                }
                match &mut approach {
                    Some(approach) => approach.length = shorter,
                    None => h = shorter,
                }
                continue;
            }

            // a step ends where a guard changes its sign
            let mut forced = match (approach, lands) {
                (Some(Approach { kink, .. }), _) => Some(Cause::Kink(kink)),
                (None, true) if stop >= self.settings.duration => Some(Cause::End),
                (None, true) if stop < breakpoint => Some(Cause::Sample),
                (None, true) => Some(Cause::Breakpoint),
                (None, false) => None,
            };
            let mut ends = Some((reached, length));
            if M::Guards::LEN > 0 {
                let mut end = step.span().end;
                self.model.normalize(&mut end);
                let there = once::guards(self.model, reached, &end);
                if let Some(guard) = event::changed(Zero::Positive, &guards, &there) {
                    let theta = self.way_to_guard(&mut step, &guards);
                    if theta < 1.0 {
                        ends = None;
                        self.y = once::inside(self.model, &step, theta);
                        self.report.t = t + theta * length;
                    }
                    self.report.events += 1;
                    forced = Some(Cause::Guard(guard));
                }
            }
            let whole = ends.is_some();
            let length = match ends {
                Some((reached, length)) => {
                    self.y = step.span().end;
                    self.model.normalize(&mut self.y);
                    self.report.t = reached;
                    length
                }
                None => self.report.t - t,
            };
            let exchanged = match self.watch {
                Some(_) => self.add_work(&mut step, length),
                None => 0.0,
            };
            self.accept(&step, length, forced);
            self.deliver_within(&mut step)?;
            if let Some(near) = &mut approach {
                let before = kinks.unwrap_or(M::Kinks::splat(T::from_f64(0.0)));
                let crossed = self.kink_within(&step, &before).is_some();
                let left = near.at - self.report.t;
                near.length = match left > 0.0 {
                    true => 1.5 * left,
                    false => 4.0 * length,
                };
                let passed = match pace {
                    Pace::Fixed(step) => near.length >= step,
                    Pace::Adaptive(_) => near.length >= h,
                };
                if crossed || !whole || passed {
                    self.report.events += u64::from(crossed);
                    approach = None;
                    restless += 1;
                    controller = Controller::new(S::ESTIMATE);
                }
            } else {
                restless = 0;
            }
            kinks = approach.map(|_| once::kinks(self.model, self.report.t, &self.y));
            let renewed = self.renew();
            if let Some(watch) = &mut self.watch {
                watch.close(self.model, t, self.report.t, &self.y, exchanged);
            }
            guards = self.guards();

            // the next step begins where this one ended
            let arrived = whole && lands && stop >= breakpoint;
            if arrived {
                if breakpoint >= self.settings.duration {
                    break;
                }
                // beyond the kink the derivative is another one
                let t = self.report.t;
                breakpoint = self.schedule.kink_after::<T, M>(self.model, t);
                self.f.latest = breakpoint.next_down();
                controller = Controller::new(S::ESTIMATE);
                approach = None;
            }
            let known = step.end_rate().filter(|_| whole && !arrived && !renewed);
            let rate = match known {
                // putting a state back on its manifold moves it by no more than the error of the step
                Some(rate) => *rate,
                None => self.f.at(self.report.t, &self.y),
            };
            if arrived {
                self.check_rate(&rate)?;
            }
            if let (Some(watch), Pace::Fixed(_), true) = (&mut self.watch, pace, whole) {
                // beyond a kink the derivative is another one
                if !arrived && !renewed {
                    watch.compare::<S>(&step, &self.y, &rate);
                }
            }
            step.begin(self.report.t, self.y, rate);
        }
        Ok(())
    }

    /// How far the next step goes.
    #[inline(always)]
    fn reach(
        &mut self,
        pace: Pace,
        breakpoint: f64,
        approach: Option<&Approach>,
        h: &mut f64,
    ) -> Result<Reach, End> {
        let t = self.report.t;
        let finest = finest(t);
        let (stop, wanted, smallest) = match pace {
            Pace::Fixed(step) => {
                let stop = breakpoint.min(self.schedule.next_sample());
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
                if approach.is_none() {
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
                *h = h.min(adaptive.largest_step).max(smallest);
                (breakpoint, *h, smallest)
            }
        };
        let wanted = match approach {
            Some(approach) => approach.length.min(wanted).max(finest),
            None => wanted,
        };
        let (length, lands) = match pace {
            Pace::Fixed(_) => (wanted.min(stop - t), wanted >= stop - t),
            Pace::Adaptive(_) => to_meet(stop - t, wanted),
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

    /// What to do instead of a step that crosses a kink that matters; `None` where it crosses none, or has to.
    #[inline(never)]
    fn approach<S: Stepper<T, M>>(
        &mut self,
        step: &mut S,
        before: &M::Kinks,
        round: usize,
        error: Option<f64>,
    ) -> Option<Approach> {
        if round >= ROUNDS {
            return None;
        }
        let kink = self.kink_within(step, before)?;
        let (t, length) = (step.span().t, step.span().h);
        let margin = MARGINS[round.min(MARGINS.len() - 1)];
        let way = length * self.way_to_kink(step, before, 0.3 * margin);
        // what is left to cross in: as short as makes the error of crossing, which falls with it at least linearly, a third
        // of the tolerance
        let left = match (self.settings.method.pace, error) {
            (Pace::Adaptive(_), Some(error)) => 0.2 * length / error,
            _ => 0.0,
        };
        let left = left.max(margin * way).min(0.25 * way);
        // where the kink is at hand, over it: one that matters is not crossed by a step that begins there
        let to = match way - left > finest(t) {
            true => way - left,
            false => 2.0 * way.max(finest(t)),
        };
        (to < length).then_some(Approach {
            kink,
            at: t + way,
            length: to,
            round: round + 1,
        })
    }

    /// Estimated error over tolerance; 0 of a fixed step; `None` where something is not finite.
    #[inline(always)]
    fn error<S: Stepper<T, M>>(&self, step: &S, pace: Pace) -> Option<f64> {
        let span = step.span();
        match pace {
            Pace::Fixed(_) => first_non_finite(&span.end).is_none().then_some(0.0),
            Pace::Adaptive(adaptive) => {
                let tolerances = &adaptive.tolerances;
                control::error::<T, M>(tolerances, &span.y, &span.end, &step.estimate())
            }
        }
    }

    #[inline(always)]
    fn guards(&self) -> M::Guards {
        match M::Guards::LEN {
            0 => M::Guards::splat(T::from_f64(0.0)),
            _ => once::guards(self.model, self.report.t, &self.y),
        }
    }

    /// The first of the kinks that a step has crossed when it arrives, or would have, had it gone a trifle further: its last
    /// stages are at its end, but not quite where it leads, and may be beyond.
    #[inline(never)]
    fn kink_within<S: Stepper<T, M>>(&self, step: &S, before: &M::Kinks) -> Option<usize> {
        // less than any margin
        const FURTHER: f64 = 1e-5;
        let span = step.span();
        let mut end = span.end;
        self.model.normalize(&mut end);
        let mut there = once::kinks(self.model, span.t + span.h, &end);
        for i in 0..M::Kinks::LEN {
            there[i] = T::from_f64(FURTHER).mul_add(there[i] - before[i], there[i]);
        }
        event::changed(Zero::Neither, before, &there)
    }

    /// The part of a step after which something is seen that is not seen at its end.
    #[inline(never)]
    fn hidden<S: Stepper<T, M>>(&mut self, step: &mut S, guards: &M::Guards) -> Option<f64> {
        if M::Kinks::LEN + M::Guards::LEN == 0 {
            return None;
        }
        step.complete(&mut self.f);
        let model = self.model;
        let (t, y) = (step.span().t, step.span().y);
        let guards_at = |t, y: &M::State| once::guards(model, t, y);
        let guard = event::hidden(model, step, guards_at, guards, Zero::Positive);
        let kinks_at = |t, y: &M::State| once::kinks(model, t, y);
        let kink = match M::Kinks::LEN {
            0 => None,
            _ => event::hidden(
                model,
                step,
                kinks_at,
                &once::kinks(model, t, &y),
                Zero::Neither,
            ),
        };
        match (guard, kink) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        }
    }

    /// The part of a step that lies before the first kink in it, to within `width`.
    #[inline(never)]
    fn way_to_kink<S: Stepper<T, M>>(&mut self, step: &mut S, kinks: &M::Kinks, width: f64) -> f64 {
        step.complete(&mut self.f);
        let model = self.model;
        let kinks_at = |t, y: &M::State| once::kinks(model, t, y);
        event::first_change(model, step, kinks_at, kinks, Zero::Neither, width)
    }

    /// The part of a step that lies before the first change of a guard, and a trifle.
    #[inline(never)]
    fn way_to_guard<S: Stepper<T, M>>(&mut self, step: &mut S, guards: &M::Guards) -> f64 {
        // the time of an event then errs by less than the step does
        const WIDTH: f64 = 1e-13;
        step.complete(&mut self.f);
        let model = self.model;
        let at = |t, y: &M::State| once::guards(model, t, y);
        event::first_change(model, step, at, guards, Zero::Positive, WIDTH)
    }

    /// Adds the work of a step, or of its first part of this length; what was exchanged in it \[J\].
    #[inline(never)]
    fn add_work<S: Stepper<T, M>>(&mut self, step: &mut S, length: f64) -> f64 {
        let Some(watch) = &mut self.watch else {
            return 0.0;
        };
        let balance = &mut watch.balance;
        let before = balance.exchanged;
        step.complete(&mut self.f);
        let (t, part) = (step.span().t, length / step.span().h);
        let states = balance::NODES.map(|x| once::inside(self.model, step, x * part));
        let times = balance::NODES.map(|x| t + x * length);
        let powers = [0, 1, 2].map(|i| once::powers(self.model, times[i], &states[i]));
        if M::INFO.free {
            let thrusts = [0, 1, 2].map(|i| once::thrust(self.model, times[i], &states[i]));
            balance.push(length, &thrusts);
        }
        balance.add(length, &powers);
        (balance.exchanged - before).to_f64()
    }

    /// Renews the memory of force laws, and the charts of Bryant angles with their coordinates, from the state reached, until that
    /// changes nothing: what one switch does may be what another waits for. Each guard stands for at most one link of such a chain. Says whether anything changed.
    #[inline(always)]
    fn renew(&mut self) -> bool {
        let mut renewed = false;
        if M::INFO.memory.is_empty() {
            return renewed;
        }
        for _ in 0..=M::Guards::LEN {
            let before = self.y;
            once::renew(self.model, self.report.t, &mut self.y);
            if self.y.as_ref() == before.as_ref() {
                break;
            }
            renewed = true;
        }
        renewed
    }

    /// Counts a step of this length, `forced` to it by something, or by the pace.
    #[inline(always)]
    fn accept<S: Stepper<T, M>>(&mut self, step: &S, length: f64, forced: Option<Cause>) {
        let taken = self.report.steps + self.report.rejected;
        let last = self.settings.max_steps - taken.min(self.settings.max_steps) <= VOTERS;
        if last || length < self.report.smallest_step {
            let cause = self.cause(step, length, forced);
            let report = &mut self.report;
            if length < report.smallest_step {
                report.smallest_step = length;
                report.smallest_step_at = step.span().t;
                report.smallest_step_for = cause;
            }
            self.vote.count(cause);
        }
        let report = &mut self.report;
        report.steps += 1;
        report.largest_step = report.largest_step.max(length);
    }

    /// What decided the length of a step.
    #[cold]
    fn cause<S: Stepper<T, M>>(&self, step: &S, length: f64, forced: Option<Cause>) -> Cause {
        match (forced, self.settings.method.pace) {
            (Some(cause), _) => cause,
            (None, Pace::Fixed(_)) => Cause::Fixed,
            (None, Pace::Adaptive(_)) if self.report.steps == 0 => Cause::First,
            (None, Pace::Adaptive(adaptive)) if length >= adaptive.largest_step => Cause::Largest,
            (None, Pace::Adaptive(adaptive)) => {
                Cause::Tolerance(worst::<T, M, S>(&adaptive.tolerances, step))
            }
        }
    }

    /// Length of the step taken last \[s\], accepted or not.
    #[cold]
    fn latest<S: Stepper<T, M>>(&self, step: &S) -> f64 {
        step.span().h
    }

    /// The samples in a step just accepted.
    #[inline(always)]
    fn deliver_within<S: Stepper<T, M>>(&mut self, step: &mut S) -> Result<(), End> {
        let (end, y) = (self.report.t, self.y);
        if self.schedule.next_sample() < end {
            step.complete(&mut self.f);
        }
        while self.schedule.next_sample() < end {
            self.report.t = self.schedule.next_sample();
            let span = step.span();
            let theta = (self.report.t - span.t) / span.h;
            self.y = once::inside(self.model, step, theta);
            self.deliver()?;
        }
        (self.report.t, self.y) = (end, y);
        if self.schedule.next_sample() == end {
            self.deliver()
        } else {
            Ok(())
        }
    }

    /// The sample that is due, from the time and state reached.
    #[inline(always)]
    fn deliver(&mut self) -> Result<(), End> {
        let t = self.report.t;
        let outputs = once::outputs(self.model, t, &self.y);
        // nothing but the outputs themselves may be too large, or come from a curve that only they look up
        if let Some(index) = first_non_finite(&outputs) {
            return Err(End::Failed(Reason::NonFinite {
                index,
                of: Quantity::Output,
                output: Some(index),
                culprit: self.culprit(t, &self.y),
            }));
        }
        self.schedule.advance();
        self.report.samples += 1;
        match (self.sink)(Sample {
            t,
            state: &self.y,
            outputs: &outputs,
        }) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(End::Stopped),
        }
    }

    #[inline(always)]
    fn check_rate(&self, rate: &M::State) -> Result<(), End> {
        let Some(index) = first_non_finite(rate) else {
            return Ok(());
        };
        let stage = NotFinite {
            t: self.report.t,
            y: self.y,
            index,
            in_derivative: true,
        };
        Err(self.not_finite_at(Some(stage), Quantity::Derivative, index))
    }

    /// The failure at a stage, with the first output that is not finite there; or just of an index.
    #[cold]
    fn not_finite_at(&self, stage: Option<NotFinite<M::State>>, of: Quantity, index: usize) -> End {
        let reason = match stage {
            Some(NotFinite {
                t,
                y,
                index,
                in_derivative: true,
            }) => {
                let outputs = once::outputs(self.model, t, &y);
                let output = first_non_finite(&outputs);
                Reason::NonFinite {
                    index,
                    of: Quantity::Derivative,
                    output,
                    culprit: self.culprit(t, &y),
                }
            }
            Some(NotFinite { index, .. }) => Reason::NonFinite {
                index,
                of: Quantity::State,
                output: None,
                culprit: self.culprit(self.report.t, &self.y),
            },
            None => Reason::NonFinite {
                index,
                of,
                output: None,
                culprit: self.culprit(self.report.t, &self.y),
            },
        };
        End::Failed(reason)
    }

    /// What is known to be wrong at a state where something is.
    #[cold]
    fn culprit(&self, t: f64, y: &M::State) -> Culprit {
        let arguments = once::curves(self.model, t, y);
        for (curve, info) in M::INFO.curves.iter().enumerate().take(M::Curves::LEN) {
            let argument = arguments[curve].to_f64();
            if info.extrapolate == Extrapolate::Error && info.beyond(argument) > 0.0 {
                return Culprit::Curve { curve, argument };
            }
        }
        match self.model.smallest_pivot(T::from_f64(t), y) {
            Some((pivot, share)) if share.to_f64() < VANISHES => {
                let share = share.to_f64();
                Culprit::Inertia { pivot, share }
            }
            _ => Culprit::Unknown,
        }
    }

    /// The failure of a step that cannot be made small enough, or that is fixed.
    #[cold]
    fn too_small<S: Stepper<T, M>>(
        &mut self,
        step: &mut S,
        error: Option<f64>,
        length: f64,
    ) -> End {
        if error.is_none() {
            if let Some(watch) = &mut self.watch {
                watch.fail();
            }
            // again, to see where it breaks
            let span = *step.span();
            self.f.search = Some(first_non_finite(&span.y).map(|index| NotFinite {
                t: span.t,
                y: span.y,
                index,
                in_derivative: false,
            }));
            let rate = self.f.at(span.t, &span.y);
            step.begin(span.t, span.y, rate);
            step.take(&mut self.f, span.h);
            let stage = self.f.search.take().flatten();
            let index = first_non_finite(&step.span().end);
            if stage.is_some() || index.is_some() {
                return self.not_finite_at(stage, Quantity::State, index.unwrap_or(0));
            }
        }
        let index = match self.settings.method.pace {
            Pace::Adaptive(adaptive) => worst::<T, M, S>(&adaptive.tolerances, step),
            Pace::Fixed(_) => 0,
        };
        let step = length;
        let culprit = self.culprit(self.report.t, &self.y);
        End::Failed(Reason::StepTooSmall {
            step,
            index,
            culprit,
        })
    }
}

/// The entry of the state that errs most.
#[cold]
fn worst<T: Real, M: Model<T>, S: Stepper<T, M>>(tolerances: &Tolerances, step: &S) -> usize {
    let span = step.span();
    control::worst::<T, M>(tolerances, &span.y, &span.end, &step.estimate())
}
