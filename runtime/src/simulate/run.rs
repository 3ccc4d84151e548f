//! A run in progress: the time loops of the two methods.

use super::balance::{self, Balance};
use super::event;
use super::schedule::{Schedule, to_meet};
use super::{Adaptive, Report, Sample, Settings};
use crate::failure::{Quantity, Reason};
use crate::integrate::control::{Controller, Tolerances, first_step};
use crate::integrate::embedded::Step;
use crate::integrate::{Evaluator, NotFinite, combine, first_non_finite, fixed};
use crate::{Model, Real, Vector};
use core::ops::ControlFlow;

/// Why a run ends before its duration.
pub(super) enum End {
    /// The receiver of the samples asked for it.
    Stopped,
    Failed(Reason),
}

/// A run in progress; the time reached is `report.t`.
pub(super) struct Run<'a, M: Model<T>, T: Real, F> {
    model: &'a M,
    f: Evaluator<'a, M>,
    y: M::State,
    schedule: Schedule,
    settings: &'a Settings,
    sink: &'a mut F,
    report: Report,
    balance: Option<&'a mut Balance<T, M::Powers>>,
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
        balance: Option<&'a mut Balance<T, M::Powers>>,
        sink: &'a mut F,
    ) -> Self {
        Run {
            balance,
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
                samples: 0,
                smallest_step: f64::INFINITY,
                largest_step: 0.0,
            },
        }
    }

    /// What the run took so far.
    #[inline(always)]
    pub fn report(&self) -> Report {
        Report {
            evaluations: self.f.count,
            ..self.report
        }
    }

    /// Equal steps from each sample or kink to the next.
    #[inline(always)]
    pub fn fixed(&mut self, step: f64) -> Result<(), End> {
        self.renew();
        self.open_balance();
        let rate = self.f.at(0.0, &self.y);
        self.check_rate(&rate)?;
        self.deliver()?;
        while self.report.t < self.settings.duration {
            let start = self.report.t;
            let stop = self
                .schedule
                .kink_after::<T, M>(self.model, start)
                .min(self.schedule.next_sample());
            // rounding may leave a hair more than a whole number of steps
            let steps = (((stop - start) / step - 1e-9).max(0.0) as u64).saturating_add(1);
            let h = (stop - start) / steps as f64;
            let limit = self.settings.max_steps;
            if steps > limit - self.report.steps {
                return Err(End::Failed(Reason::TooManySteps { limit }));
            }
            self.f.latest = stop.next_down();
            for i in 0..steps {
                let t = start + i as f64 * h;
                let mut y = fixed::step(&mut self.f, t, &self.y, h);
                self.model.normalize(&mut y);
                if let Some(index) = first_non_finite(&y) {
                    let stage = fixed::not_finite(&mut self.f, t, &self.y, h);
                    return Err(self.not_finite_at(stage, Quantity::State, index));
                }
                if self.balance.is_some() {
                    self.balance_fixed_step(t, h, &y);
                }
                self.y = y;
                self.report.t = if i + 1 == steps {
                    stop
                } else {
                    start + (i + 1) as f64 * h
                };
                self.renew();
                self.close_balance();
                self.accept(h);
            }
            if self.schedule.next_sample() == self.report.t {
                self.deliver()?;
            }
        }
        Ok(())
    }

    /// Steps as the tolerance allows, samples by interpolation.
    #[inline(always)]
    pub fn adaptive(&mut self, adaptive: &Adaptive) -> Result<(), End> {
        let tolerances = &adaptive.tolerances;
        let coordinates = M::INFO.coordinates.len();
        self.renew();
        self.open_balance();
        let rate = self.f.at(0.0, &self.y);
        self.check_rate(&rate)?;
        self.deliver()?;

        let mut kink = self.schedule.kink_after::<T, M>(self.model, 0.0);
        self.f.latest = kink.next_down();
        let largest = adaptive.largest_step.min(kink);
        let mut h = match adaptive.first_step {
            Some(step) => step,
            None => first_step(&mut self.f, 0.0, &self.y, &rate, tolerances, largest),
        };
        let mut controller = Controller::new();
        let mut step = Step::new(0.0, self.y, rate);
        let mut guards = self.model.guards(T::from_f64(0.0), &self.y);

        while self.report.t < self.settings.duration {
            let limit = self.settings.max_steps;
            if self.report.steps + self.report.rejected >= limit {
                return Err(End::Failed(Reason::TooManySteps { limit }));
            }
            let t = self.report.t;
            let smallest = adaptive.smallest_step.max(16.0 * (t.next_up() - t));
            h = h.min(adaptive.largest_step).max(smallest);
            let (length, lands) = to_meet(kink - t, h);
            step.take(&mut self.f, length);
            let error = step.error(tolerances, coordinates);
            let Some(accepted) = error.filter(|error| *error <= 1.0) else {
                self.report.rejected += 1;
                h = length * controller.rejected(error);
                if h < smallest {
                    return Err(self.too_small(&step, error, h, tolerances));
                }
                continue;
            };

            let grown = length * controller.accepted(accepted);
            // a step cut short to meet a kink says little of the next
            h = if length < h { h.max(grown) } else { grown };
            let event = match M::Guards::LEN {
                0 => None,
                _ => event::first_change(self.model, &step, &guards),
            };
            let (reached, length, lands) = match event {
                Some(theta) if theta < 1.0 => {
                    self.y = step.interpolate(theta);
                    (t + theta * length, theta * length, false)
                }
                _ => {
                    self.y = step.end;
                    (if lands { kink } else { t + length }, length, lands)
                }
            };
            if self.balance.is_some() {
                let part = length / step.h;
                self.balance_step(t, length, |x| step.interpolate(x * part));
            }
            self.report.t = reached;
            self.report.events += u64::from(event.is_some());
            self.model.normalize(&mut self.y);
            self.accept(length);
            self.deliver_within(&step)?;
            self.renew();
            self.close_balance();
            if M::Guards::LEN > 0 {
                guards = self.model.guards(T::from_f64(reached), &self.y);
            }

            // the next step begins where this one ended
            step.t = self.report.t;
            step.y = self.y;
            if lands {
                if kink >= self.settings.duration {
                    break;
                }
                // beyond the kink the derivative is another one
                kink = self.schedule.kink_after::<T, M>(self.model, self.report.t);
                self.f.latest = kink.next_down();
                controller = Controller::new();
                step.k[0] = self.f.at(step.t, &step.y);
                self.check_rate(&step.k[0])?;
            } else if event.is_none() && step.y.as_ref() == step.end.as_ref() {
                step.k[0] = step.k[6];
            } else {
                step.k[0] = self.f.at(step.t, &step.y);
            }
        }
        Ok(())
    }

    /// The kinetic energy at the start.
    #[inline(always)]
    fn open_balance(&mut self) {
        if let Some(balance) = &mut self.balance {
            balance.start = self.model.kinetic_energy(T::from_f64(0.0), &self.y);
            balance.end = balance.start;
        }
    }

    /// The kinetic energy at the time reached.
    #[inline(always)]
    fn close_balance(&mut self) {
        if let Some(balance) = &mut self.balance {
            let t = T::from_f64(self.report.t);
            balance.end = self.model.kinetic_energy(t, &self.y);
        }
    }

    /// Adds the work of a step from `t`, whose states at fractions of its length are given.
    #[inline(always)]
    fn balance_step(&mut self, t: f64, length: f64, state: impl Fn(f64) -> M::State) {
        if let Some(balance) = &mut self.balance {
            let powers = balance::NODES.map(|x| {
                let mut y = state(x);
                self.model.normalize(&mut y);
                self.model.powers(T::from_f64(t + x * length), &y)
            });
            balance.add(length, &powers);
        }
    }

    /// The same for a step of the method without an interpolant: Hermite's cubic through both ends.
    #[inline(always)]
    fn balance_fixed_step(&mut self, t: f64, h: f64, end: &M::State) {
        let start = self.y;
        let (first, last) = (self.f.at(t, &start), self.f.at(t + h, end));
        let end = *end;
        self.balance_step(t, h, |x| {
            let rest = 1.0 - x;
            let [from, to] = [rest * rest * (1.0 + 2.0 * x), x * x * (3.0 - 2.0 * x)];
            let [leave, arrive] = [h * x * rest * rest, -h * x * x * rest];
            let mut y = combine(&start, from - 1.0, [1.0], [&start]);
            y = combine(&y, to, [1.0], [&end]);
            combine(&y, 1.0, [leave, arrive], [&first, &last])
        });
    }

    /// Renews the memory of force laws from the state reached, until that changes nothing: what one switch does may be
    /// what another waits for. Each guard stands for at most one link of such a chain.
    #[inline(always)]
    fn renew(&mut self) {
        for _ in 0..=M::Guards::LEN {
            let before = self.y;
            self.model.renew(T::from_f64(self.report.t), &mut self.y);
            if self.y.as_ref() == before.as_ref() {
                break;
            }
        }
    }

    #[inline(always)]
    fn accept(&mut self, step: f64) {
        self.report.steps += 1;
        self.report.smallest_step = self.report.smallest_step.min(step);
        self.report.largest_step = self.report.largest_step.max(step);
    }

    /// The samples in a step just accepted.
    #[inline(always)]
    fn deliver_within(&mut self, step: &Step<M::State>) -> Result<(), End> {
        let (end, y) = (self.report.t, self.y);
        while self.schedule.next_sample() < end {
            self.report.t = self.schedule.next_sample();
            self.y = step.interpolate((self.report.t - step.t) / step.h);
            self.model.normalize(&mut self.y);
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
        let outputs = self.model.outputs(T::from_f64(t), &self.y);
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
                let outputs = self.model.outputs(T::from_f64(t), &y);
                let output = first_non_finite(&outputs);
                Reason::NonFinite {
                    index,
                    of: Quantity::Derivative,
                    output,
                }
            }
            Some(NotFinite { index, .. }) => Reason::NonFinite {
                index,
                of: Quantity::State,
                output: None,
            },
            None => Reason::NonFinite {
                index,
                of,
                output: None,
            },
        };
        End::Failed(reason)
    }

    /// The failure of a step that cannot be made small enough.
    #[cold]
    fn too_small(
        &self,
        step: &Step<M::State>,
        error: Option<f64>,
        length: f64,
        tolerances: &Tolerances,
    ) -> End {
        let stage = if error.is_none() {
            step.not_finite()
        } else {
            None
        };
        if stage.is_some() {
            return self.not_finite_at(stage, Quantity::State, 0);
        }
        let index = step.worst(tolerances, M::INFO.coordinates.len());
        End::Failed(Reason::StepTooSmall {
            step: length,
            index,
        })
    }
}
