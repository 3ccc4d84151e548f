//! A run: from the initial state to the duration, sampled at 0, every, 2·every … duration.
//!
//! Steps end on every kink of a curve of time ([`Info::breakpoints`]), for an error estimate assumes a smooth
//! derivative. The fixed-step method also ends on every sample; the adaptive one chooses its steps freely and
//! interpolates.

use crate::failure::{Failure, Quantity, Reason, Setting};
use crate::integrate::control::{Controller, Tolerances, first_step};
use crate::integrate::embedded::{Trial, attempt};
use crate::integrate::{Evaluator, NotFinite, first_non_finite, fixed};
use crate::{Info, Model, Real};
use core::ops::ControlFlow;

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Length of the run \[s\], positive.
    pub duration: f64,
    /// Time between samples \[s\], positive. Where the duration is no multiple of it, the last sample comes early.
    pub every: f64,
    /// Which integrator.
    pub method: Method,
    /// Limit on the number of steps, accepted and rejected.
    pub max_steps: u64,
}

/// Which integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The classical method of order 4 with fixed steps.
    Rk4 {
        /// Largest step \[s\]; shortened evenly so that samples and kinks are met.
        step: f64,
    },
    /// Dormand & Prince's pair 5(4) with control of the step and an interpolant of order 4.
    Dopri5(Adaptive),
}

/// Settings of an adaptive method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// Error allowed in a step.
    pub tolerances: Tolerances,
    /// First step \[s\]; `None`: found from the first derivatives.
    pub first_step: Option<f64>,
    /// Largest step \[s\]; +∞ for none.
    pub largest_step: f64,
    /// Smallest step \[s\]: a run that needs a smaller one fails. Never less than 16 units in the last place of time.
    pub smallest_step: f64,
}

impl Default for Adaptive {
    /// [`Tolerances::default`], steps from 10⁻¹⁴ s upwards.
    fn default() -> Self {
        Adaptive {
            tolerances: Tolerances::default(),
            first_step: None,
            largest_step: f64::INFINITY,
            smallest_step: 1e-14,
        }
    }
}

impl Default for Method {
    fn default() -> Self {
        Method::Dopri5(Adaptive::default())
    }
}

impl Settings {
    /// Duration and sampling as the model says, the adaptive method at its default tolerances, ten million steps.
    pub const fn of(info: &Info) -> Settings {
        Settings {
            duration: info.duration,
            every: info.every,
            method: Method::Dopri5(Adaptive {
                tolerances: Tolerances {
                    relative: 1e-6,
                    coordinates: 1e-8,
                    velocities: 1e-6,
                },
                first_step: None,
                largest_step: f64::INFINITY,
                smallest_step: 1e-14,
            }),
            max_steps: 10_000_000,
        }
    }
}

/// The state at a sampling time.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a, S, O> {
    /// Time \[s\]: exactly i · every, and exactly the duration for the last.
    pub t: f64,
    /// The state, on its manifold.
    pub state: &'a S,
    /// The outputs, in the order and units of [`Info::outputs`].
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
    /// Samples delivered.
    pub samples: u64,
    /// Smallest step accepted \[s\].
    pub smallest_step: f64,
    /// Largest step accepted \[s\].
    pub largest_step: f64,
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
    let fail = |reason| Failure {
        t: 0.0,
        reason,
        info: M::INFO,
    };
    check(settings).map_err(|setting| fail(Reason::InvalidSettings(setting)))?;
    if let Some(index) = first_non_finite(&initial) {
        let of = Quantity::InitialState;
        return Err(fail(Reason::NonFinite {
            index,
            of,
            output: None,
        }));
    }
    let mut run = Run {
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
            evaluations: 0,
            samples: 0,
            smallest_step: f64::INFINITY,
            largest_step: 0.0,
        },
    };
    let end = match settings.method {
        Method::Rk4 { step } => run.fixed(step),
        Method::Dopri5(adaptive) => run.adaptive(&adaptive),
    };
    run.report.evaluations = run.f.count;
    match end {
        Ok(()) | Err(End::Stopped) => Ok(run.report),
        Err(End::Failed(reason)) => Err(Failure {
            t: run.report.t,
            reason,
            info: M::INFO,
        }),
    }
}

/// Why a run ends before its duration.
enum End {
    /// The receiver of the samples asked for it.
    Stopped,
    Failed(Reason),
}

/// A run in progress; the time reached is `report.t`.
struct Run<'a, M: Model<T>, T: Real, F> {
    model: &'a M,
    f: Evaluator<'a, M>,
    y: M::State,
    schedule: Schedule,
    settings: &'a Settings,
    sink: &'a mut F,
    report: Report,
}

impl<T, M, F> Run<'_, M, T, F>
where
    T: Real,
    M: Model<T>,
    F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
{
    /// Equal steps from each sample or kink to the next.
    #[inline(always)]
    fn fixed(&mut self, step: f64) -> Result<(), End> {
        let rate = self.f.at(0.0, &self.y);
        self.check_rate(&rate)?;
        self.deliver()?;
        while self.report.t < self.settings.duration {
            let start = self.report.t;
            let stop = self
                .schedule
                .kink_after::<T, M>(start)
                .min(self.schedule.next_sample());
            // rounding may leave a hair more than a whole number of steps
            let steps = ((stop - start) / step - 1e-9).max(0.0) as u64 + 1;
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
                self.y = y;
                self.report.t = if i + 1 == steps {
                    stop
                } else {
                    start + (i + 1) as f64 * h
                };
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
    fn adaptive(&mut self, adaptive: &Adaptive) -> Result<(), End> {
        let tolerances = &adaptive.tolerances;
        let coordinates = M::INFO.coordinates.len();
        let mut rate = self.f.at(0.0, &self.y);
        self.check_rate(&rate)?;
        self.deliver()?;

        let mut kink = self.schedule.kink_after::<T, M>(0.0);
        self.f.latest = kink.next_down();
        let largest = adaptive.largest_step.min(kink);
        let mut h = match adaptive.first_step {
            Some(step) => step,
            None => first_step(&mut self.f, 0.0, &self.y, &rate, tolerances, largest),
        };
        let mut controller = Controller::new();

        while self.report.t < self.settings.duration {
            let limit = self.settings.max_steps;
            if self.report.steps + self.report.rejected >= limit {
                return Err(End::Failed(Reason::TooManySteps { limit }));
            }
            let t = self.report.t;
            let smallest = adaptive.smallest_step.max(16.0 * (t.next_up() - t));
            h = h.min(adaptive.largest_step).max(smallest);
            let (step, lands) = to_meet(kink - t, h);
            let trial = attempt(&mut self.f, t, &self.y, rate, step);
            let error = trial.error(tolerances, coordinates);
            let Some(accepted) = error.filter(|error| *error <= 1.0) else {
                self.report.rejected += 1;
                h = step * controller.rejected(error);
                if h < smallest {
                    return Err(self.too_small(&trial, error, h, tolerances));
                }
                continue;
            };

            let growth = controller.accepted(accepted);
            // a step cut short to meet a kink says little of the next
            h = if step < h {
                h.max(step * growth)
            } else {
                step * growth
            };
            self.report.t = if lands { kink } else { t + step };
            let mut end = trial.end;
            self.model.normalize(&mut end);
            self.y = end;
            self.accept(step);
            self.deliver_within(&trial)?;

            if lands {
                if kink >= self.settings.duration {
                    break;
                }
                // beyond the kink the derivative is another one
                kink = self.schedule.kink_after::<T, M>(self.report.t);
                self.f.latest = kink.next_down();
                controller = Controller::new();
                rate = self.f.at(self.report.t, &self.y);
                self.check_rate(&rate)?;
            } else if end.as_ref() == trial.end.as_ref() {
                rate = trial.k[6];
            } else {
                rate = self.f.at(self.report.t, &self.y);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn accept(&mut self, step: f64) {
        self.report.steps += 1;
        self.report.smallest_step = self.report.smallest_step.min(step);
        self.report.largest_step = self.report.largest_step.max(step);
    }

    /// The samples in a step just accepted.
    #[inline(always)]
    fn deliver_within(&mut self, trial: &Trial<M::State>) -> Result<(), End> {
        let (end, y) = (self.report.t, self.y);
        while self.schedule.next_sample() < end {
            self.report.t = self.schedule.next_sample();
            self.y = trial.interpolate((self.report.t - trial.t) / trial.h);
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
        trial: &Trial<M::State>,
        error: Option<f64>,
        step: f64,
        tolerances: &Tolerances,
    ) -> End {
        let stage = if error.is_none() {
            trial.not_finite()
        } else {
            None
        };
        if stage.is_some() {
            return self.not_finite_at(stage, Quantity::State, 0);
        }
        let index = trial.worst(tolerances, M::INFO.coordinates.len());
        End::Failed(Reason::StepTooSmall { step, index })
    }
}

/// The step that goes `span` or fairly towards it when `h` is wanted, and whether it arrives: never a tiny rest.
fn to_meet(span: f64, h: f64) -> (f64, bool) {
    if span <= 1.05 * h {
        (span, true)
    } else if span < 2.0 * h {
        (0.5 * span, false)
    } else {
        (h, false)
    }
}

/// When to sample and where to stop.
struct Schedule {
    duration: f64,
    every: f64,
    /// Index of the last sample, which is due at the duration.
    last: u64,
    /// Index of the next sample.
    next: u64,
}

impl Schedule {
    fn new(settings: &Settings) -> Self {
        let Settings {
            duration, every, ..
        } = *settings;
        // a duration within rounding of a multiple is one
        let last = (duration / every * (1.0 - 1e-14) - 1e-9).max(0.0) as u64 + 1;
        Schedule {
            duration,
            every,
            last,
            next: 0,
        }
    }

    /// Time of the next sample, +∞ after the last.
    fn next_sample(&self) -> f64 {
        match self.next {
            next if next > self.last => f64::INFINITY,
            next if next == self.last => self.duration,
            next => next as f64 * self.every,
        }
    }

    fn advance(&mut self) {
        self.next += 1;
    }

    /// The first kink after `t`, at most the duration.
    fn kink_after<T: Real, M: Model<T>>(&self, t: f64) -> f64 {
        let passed = M::INFO.breakpoints.partition_point(|kink| *kink <= t);
        let kink = M::INFO.breakpoints.get(passed).copied();
        kink.map_or(self.duration, |kink| kink.min(self.duration))
    }
}

/// More samples than this are a mistake in `every`, not a wish.
const MAX_SAMPLES: f64 = 1e9;

fn check(settings: &Settings) -> Result<(), Setting> {
    let positive = |name, value: f64| {
        let good = value > 0.0 && value.is_finite();
        if good {
            Ok(())
        } else {
            Err(Setting {
                name,
                value,
                must: "positive and finite",
            })
        }
    };
    positive("duration", settings.duration)?;
    positive("every", settings.every)?;
    if settings.duration / settings.every > MAX_SAMPLES {
        let must = "at least a billionth of the duration";
        return Err(Setting {
            name: "every",
            value: settings.every,
            must,
        });
    }
    if settings.max_steps == 0 {
        return Err(Setting {
            name: "limit on steps",
            value: 0.0,
            must: "positive",
        });
    }
    match settings.method {
        Method::Rk4 { step } => positive("step", step),
        Method::Dopri5(adaptive) => {
            positive("relative tolerance", adaptive.tolerances.relative)?;
            positive(
                "absolute tolerance of coordinates",
                adaptive.tolerances.coordinates,
            )?;
            positive(
                "absolute tolerance of velocities",
                adaptive.tolerances.velocities,
            )?;
            positive("smallest step", adaptive.smallest_step)?;
            if let Some(step) = adaptive.first_step {
                positive("first step", step)?;
            }
            let largest = adaptive.largest_step;
            if largest.is_nan() || largest < adaptive.smallest_step {
                let must = "no smaller than the smallest step";
                return Err(Setting {
                    name: "largest step",
                    value: largest,
                    must,
                });
            }
            Ok(())
        }
    }
}
