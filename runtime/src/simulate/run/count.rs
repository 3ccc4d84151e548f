//! What decided the length of steps, counted.

use super::{Run, fail};
use crate::integrate::Stepper;
use crate::simulate::{Cause, Pace, Sample};
use crate::{Model, Real};
use core::ops::ControlFlow;

/// Steps before the last that is allowed among which it is counted what forces them.
const VOTERS: u64 = 1000;

/// The majority of what is counted (Boyer & Moore), without keeping it.
#[derive(Clone, Copy)]
pub(super) struct Vote {
    /// What leads.
    pub cause: Cause,
    /// By how much.
    pub lead: u32,
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

impl<T, M, F> Run<'_, M, T, F>
where
    T: Real,
    M: Model<T>,
    F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
{
    /// Counts a step of this length, `forced` to it by something, or by the pace.
    #[inline(always)]
    pub(super) fn accept<S: Stepper<T, M>>(
        &mut self,
        step: &S,
        length: f64,
        forced: Option<Cause>,
    ) {
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
                Cause::Tolerance(fail::worst::<T, M, S>(&adaptive.tolerances, step))
            }
        }
    }

    /// Length of the step taken last \[s\], accepted or not.
    #[cold]
    pub(super) fn latest<S: Stepper<T, M>>(&self, step: &S) -> f64 {
        step.span().h
    }
}
