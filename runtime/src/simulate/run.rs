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
//! | file | what |
//! |---|---|
//! | `search` | kinks and guards within a step |
//! | `sample` | the samples in it |
//! | `count` | what decided its length |
//! | `fail` | why there is no next one |

mod count;
mod fail;
mod sample;
mod search;

use super::balance;
use super::event::{self, Zero};
use super::schedule::{Grid, Schedule, to_meet};
use super::watch::Watch;
use super::{Cause, Pace, Report, Sample, Settings, once};
use crate::failure::Reason;
use crate::integrate::control::{self, Controller, first_step};
use crate::integrate::{Evaluator, Stepper, first_non_finite};
use crate::{Model, Real, Vector};
use core::ops::ControlFlow;
use count::Vote;
use search::{Approach, HOP, HOP_OF_FEW_DIGITS, RESTLESS, matters};
pub(crate) use search::{EASY, SEARCHES};

/// Why a run ends before its duration.
pub(crate) enum End {
    /// The receiver of the samples asked for it.
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

/// A length of time that is more than rounding at `t`.
pub(crate) fn finest(t: f64) -> f64 {
    16.0 * (t.next_up() - t)
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
}
