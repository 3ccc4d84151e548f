//! Samples, handed to who asked for them.

use super::{End, Run};
use crate::failure::{Quantity, Reason};
use crate::integrate::{Stepper, first_non_finite};
use crate::simulate::{Sample, once};
use crate::{Model, Real};
use core::ops::ControlFlow;

impl<T, M, F> Run<'_, M, T, F>
where
    T: Real,
    M: Model<T>,
    F: FnMut(Sample<'_, M::State, M::Outputs>) -> ControlFlow<()>,
{
    /// The samples in a step just accepted.
    #[inline(always)]
    pub(super) fn deliver_within<S: Stepper<T, M>>(&mut self, step: &mut S) -> Result<(), End> {
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
    pub(super) fn deliver(&mut self) -> Result<(), End> {
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
}
