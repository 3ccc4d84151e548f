//! Samples, handed to who asked for them.

use super::{End, TimeLoop};
use crate::Real;
use crate::failure::{Quantity, Reason};
use crate::integrate::{Stepper, first_non_finite};
use crate::simulate::event::inside;
use crate::simulate::{Receiver, Sample};
use core::ops::ControlFlow;

impl<T: Real> TimeLoop<'_, '_, T> {
    /// The samples up to the end of the last step.
    pub(super) fn deliver_within(
        &mut self,
        step: &mut dyn Stepper<T>,
        sink: &mut Receiver<'_, T>,
    ) -> Result<(), End> {
        let end = self
            .landed
            .as_ref()
            .map_or(self.report.t, |landed| landed.end);
        if self.schedule.next_sample() < end {
            step.complete(&mut self.f);
        }
        while self.schedule.next_sample() < end {
            self.report.t = self.schedule.next_sample();
            let span = step.span();
            let theta = (self.report.t - span.t) / span.h;
            inside(self.model, step, theta, self.inside);
            // for as long as the sample is delivered, the state reached is this one
            core::mem::swap(&mut self.y, &mut self.inside);
            let delivered = self.deliver(sink);
            core::mem::swap(&mut self.y, &mut self.inside);
            delivered?;
        }
        self.report.t = end;
        if self.schedule.next_sample() == end {
            self.deliver(sink)
        } else {
            Ok(())
        }
    }

    /// The sample that is due, from the time and state reached.
    fn deliver(&mut self, sink: &mut Receiver<'_, T>) -> Result<(), End> {
        let t = self.report.t;
        self.model.outputs(T::from_f64(t), self.y, self.outputs);
        // nothing but the outputs themselves may be too large, or come from a curve that only they look up
        if let Some(index) = first_non_finite(self.outputs) {
            return Err(End::Failed(Reason::NonFinite {
                index,
                of: Quantity::Output,
                output: Some(index),
                culprit: self.culprit(),
            }));
        }
        self.schedule.advance();
        self.report.samples += 1;
        match sink(Sample {
            t,
            state: self.y,
            outputs: self.outputs,
        }) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(End::Stopped),
        }
    }

    /// The sample that was delivered last, where the loop was left at it.
    pub(in crate::simulate) fn last_sample(&self) -> Sample<'_, T> {
        let end = self
            .landed
            .as_ref()
            .map_or(self.report.t, |landed| landed.end);
        Sample {
            t: self.report.t,
            state: match self.report.t < end {
                true => self.inside,
                false => self.y,
            },
            outputs: self.outputs,
        }
    }
}
