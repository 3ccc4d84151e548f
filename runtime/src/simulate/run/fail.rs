//! Why a run cannot go on.

use super::{End, Run};
use crate::failure::{Culprit, Quantity, Reason};
use crate::integrate::control::{self, Tolerances};
use crate::integrate::{NotFinite, Stepper, first_non_finite};
use crate::simulate::{Pace, Sample, once};
use crate::{Extrapolate, Model, Real, Vector};
use core::ops::ControlFlow;

/// A pivot below this share of what stands in its place before has lost half of its digits, and accelerations have with it.
const VANISHES: f64 = 1e-8;

impl<T, M, F> Run<'_, M, T, F>
where
    T: Real,
    M: Model<T>,
    F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
{
    #[inline(always)]
    pub(super) fn check_rate(&self, rate: &M::State) -> Result<(), End> {
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
    pub(super) fn culprit(&self, t: f64, y: &M::State) -> Culprit {
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
    pub(super) fn too_small<S: Stepper<T, M>>(
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
pub(super) fn worst<T: Real, M: Model<T>, S: Stepper<T, M>>(
    tolerances: &Tolerances,
    step: &S,
) -> usize {
    let span = step.span();
    control::worst::<T, M>(tolerances, &span.y, &span.end, &step.estimate())
}
