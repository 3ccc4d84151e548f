//! Controls the errors of accelerations in the steps of lanes, as [`crate::integrate::acceleration`] does.

use super::control::Power;
use super::run::{Run, Work};
use super::step::Step;
use crate::Real;
use crate::integrate::acceleration::effect_accelerations;
use crate::real::{Mask, Several, mapped};

/// The largest accelerations that single effects cause at the starts of steps.
struct EffectAccelerations;

impl<T: Several> Work<T> for EffectAccelerations {
    type Output = [T::Part; 2];
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> Self::Output {
        let Step { t, y, .. } = &run.step;
        let [one, other] = &mut run.powers;
        let found = effect_accelerations(&*run.models.all, *t, y, &mut run.state, [one, other]);
        mapped(found, |found| found.part(0))
    }
}

impl<T: Several> Run<'_, T> {
    /// The error of the step; in the lanes `good` it includes the error of the accelerations at the end of the step.
    #[inline(always)]
    pub(super) fn with_accelerations(&mut self, error: T::Part, good: T::Mask) -> T::Part {
        let one = T::Part::from_f64(1.0);
        let difference = self.step.end_difference(self.info);
        let of = [self.step.h.part(0), self.level];
        let mut found = self
            .accelerations
            .error::<Power>(&difference, of, T::EPSILON);
        let mut rejected = good.and(one.lt(found));
        if rejected.any() {
            let asking = self.accelerations.asks(rejected);
            if asking.any() {
                let largest = self.apart(EffectAccelerations);
                self.accelerations.learn(asking, largest);
                found = self
                    .accelerations
                    .error::<Power>(&difference, of, T::EPSILON);
                rejected = good.and(one.lt(found));
            }
        }
        let accepted = good.and(rejected.not());
        self.accelerations
            .leave(&difference, of[0], accepted, rejected);
        T::Part::select(good, error.max(found), error)
    }
}
