//! Counts what decided the length of steps.

use super::{Landing, TimeLoop};
use crate::Real;
use crate::integrate::Stepper;
use crate::simulate::{Cause, Pace};

/// The last steps before the limit on their number whose causes are counted.
const VOTERS: u64 = 1000;

/// A running majority vote over causes (Boyer & Moore), without storing them.
#[derive(Clone, Copy)]
pub(super) struct Vote {
    /// The leading cause.
    pub cause: Cause,
    /// Its lead.
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

impl<T: Real> TimeLoop<'_, '_, T> {
    /// Counts an accepted step in the report.
    pub(super) fn accept(&mut self, step: &mut dyn Stepper<T>, landing: &Landing) {
        let taken = self.report.steps + self.report.rejected;
        let last = self.settings.max_steps - taken.min(self.settings.max_steps) <= VOTERS;
        let length = landing.length;
        if last || length < self.report.smallest_step {
            let cause = self.cause(step, landing);
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
        report.stiff += u64::from(step.switched());
        report.largest_step = report.largest_step.max(length);
    }

    /// The cause of the length of a step.
    #[cold]
    fn cause(&mut self, step: &mut dyn Stepper<T>, landing: &Landing) -> Cause {
        match (landing.forced, self.settings.method.pace) {
            (Some(cause), _) => cause,
            (None, Pace::Fixed(_)) => Cause::Fixed,
            (None, Pace::Adaptive(_)) if self.report.steps == 0 => Cause::First,
            (None, Pace::Adaptive(adaptive)) if landing.length >= adaptive.largest_step => {
                Cause::Largest
            }
            (None, Pace::Adaptive(_)) => Cause::Tolerance(self.worst(step)),
        }
    }
}
