//! Why a run cannot go on.

use super::{End, TimeLoop};
use crate::failure::{Culprit, Quantity, Reason};
use crate::integrate::{NotFinite, Stepper, first_non_finite};
use crate::simulate::Pace;
use crate::{Dynamics, Extrapolate, Real};

/// Relative pivot below which half of the digits of accelerations are lost: a pivot over the diagonal element before
/// the elimination.
const VANISHES: f64 = 1e-8;

impl<T: Real> TimeLoop<'_, '_, T> {
    /// Fails if the derivative at the state reached is not finite.
    pub(super) fn check_rate(&mut self) -> Result<(), End> {
        let Some(index) = first_non_finite(self.rate) else {
            return Ok(());
        };
        self.f.found_at.copy_from_slice(self.y);
        let stage = NotFinite {
            t: self.report.t,
            index,
            in_derivative: true,
        };
        Err(self.not_finite_at(stage))
    }

    /// The failure at a stage whose state is `f.found_at`, naming the first output that is not finite there.
    #[cold]
    fn not_finite_at(&mut self, stage: NotFinite) -> End {
        let NotFinite {
            t,
            index,
            in_derivative,
        } = stage;
        if !in_derivative {
            return self.not_finite_here(index);
        }
        let y = &*self.f.found_at;
        self.model.outputs(T::from_f64(t), y, self.outputs);
        End::Failed(Reason::NonFinite {
            index,
            of: Quantity::Derivative,
            output: first_non_finite(self.outputs),
            culprit: culprit(self.model, t, y, self.curves),
        })
    }

    /// The failure of a step from the state reached that makes an entry of the state not finite.
    #[cold]
    fn not_finite_here(&mut self, index: usize) -> End {
        End::Failed(Reason::NonFinite {
            index,
            of: Quantity::State,
            output: None,
            culprit: self.culprit(),
        })
    }

    /// The likely cause of a failure at the state reached.
    #[cold]
    pub(super) fn culprit(&mut self) -> Culprit {
        culprit(self.model, self.report.t, self.y, self.curves)
    }

    /// The failure of a step that would have to be shorter than allowed, or of a fixed step.
    #[cold]
    pub(super) fn too_small(
        &mut self,
        step: &mut dyn Stepper<T>,
        error: Option<f64>,
        length: f64,
    ) -> End {
        if error.is_none() {
            if let Some(watch) = &mut self.watch {
                watch.fail();
            }
            if let Some(end) = self.look_again(step) {
                return end;
            }
        }
        End::Failed(Reason::StepTooSmall {
            step: length,
            index: self.worst(step),
            culprit: self.culprit(),
        })
    }

    /// Takes the failed step again to find the stage at which numbers cease to be finite.
    #[cold]
    fn look_again(&mut self, step: &mut dyn Stepper<T>) -> Option<End> {
        let (t, h) = (step.span().t, step.span().h);
        self.inside.copy_from_slice(step.span().y);
        self.f.searching = true;
        self.f.at(t, self.inside, self.rate);
        step.begin(t, self.inside, self.rate);
        let taken = step.take(&mut self.f, h);
        self.f.searching = false;
        if let Err(reason) = taken {
            return Some(End::Failed(reason));
        }
        if let Some(stage) = self.f.found {
            return Some(self.not_finite_at(stage));
        }
        let index = first_non_finite(step.span().end)?;
        Some(self.not_finite_here(index))
    }

    /// The entry of the state with the largest error over tolerance; 0 if steps are fixed.
    #[cold]
    pub(super) fn worst(&mut self, step: &mut dyn Stepper<T>) -> usize {
        match self.settings.method.pace {
            Pace::Fixed(_) => 0,
            Pace::Adaptive(_) => {
                step.estimate(self.spare);
                let span = step.span();
                self.allowed.worst(span.y, span.end, self.spare)
            }
        }
    }
}

/// The likely cause of a failure at a state: a curve outside of its points, or a vanishing pivot. Arguments of curves
/// are written to `arguments`.
#[cold]
fn culprit<T: Real>(model: &dyn Dynamics<T>, t: f64, y: &[T], arguments: &mut [T]) -> Culprit {
    let t = T::from_f64(t);
    model.curves(t, y, arguments);
    for (curve, info) in model.info().curves.iter().enumerate() {
        let argument = arguments[curve].to_f64();
        if info.extrapolate == Extrapolate::Error && info.beyond(argument) > 0.0 {
            return Culprit::Curve { curve, argument };
        }
    }
    match model.smallest_pivot(t, y) {
        Some((pivot, share)) if share.to_f64() < VANISHES => {
            let share = share.to_f64();
            Culprit::Inertia { pivot, share }
        }
        _ => Culprit::Unknown,
    }
}
