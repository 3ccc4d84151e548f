//! Delivers the samples of a run.

use super::{End, TimeLoop};
use crate::Real;
use crate::failure::{Quantity, Reason};
use crate::integrate::{Stepper, first_non_finite};
use crate::simulate::event::inside;
use crate::simulate::{Receiver, Sample, SampleKind};
use core::ops::ControlFlow;

impl<T: Real> TimeLoop<'_, '_, T> {
    /// Delivers the samples up to the end of the last step.
    pub(super) fn deliver_within(
        &mut self,
        step: &mut dyn Stepper<T>,
        sink: &mut Receiver<'_, T>,
    ) -> Result<(), End> {
        let end = self
            .landed
            .as_ref()
            .map_or(self.report.t, |landed| landed.end);
        if self.schedule.next_sample().0 < end {
            step.complete(&mut self.f);
        }
        loop {
            let (t, kind) = self.schedule.next_sample();
            if t >= end {
                break;
            }
            self.report.t = t;
            let span = step.span();
            let theta = (self.report.t - span.t) / span.h;
            inside(self.model, step, theta, self.inside);
            // during delivery, the sample's state takes the place of the state reached
            core::mem::swap(&mut self.y, &mut self.inside);
            let delivered = self.deliver(kind, sink);
            core::mem::swap(&mut self.y, &mut self.inside);
            delivered?;
        }
        self.report.t = end;
        loop {
            match self.schedule.next_sample() {
                (t, kind) if t == end => self.deliver(kind, sink)?,
                _ => return Ok(()),
            }
        }
    }

    /// Delivers the sample that is due, at the time and state reached.
    fn deliver(&mut self, kind: SampleKind, sink: &mut Receiver<'_, T>) -> Result<(), End> {
        let t = self.report.t;
        self.model.outputs(T::from_f64(t), self.y, self.outputs);
        // the state is finite, so only an output itself may overflow, or a curve that only outputs evaluate
        if kind == SampleKind::Row
            && let Some(index) = first_non_finite(self.outputs)
        {
            return Err(End::Failed(Reason::NonFinite {
                index,
                of: Quantity::Output,
                output: Some(index),
                culprit: self.culprit(),
            }));
        }
        self.schedule.advance(kind);
        self.report.samples += u64::from(kind == SampleKind::Row);
        match sink(Sample {
            t,
            state: self.y,
            outputs: self.outputs,
            kind,
        }) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(End::Stopped),
        }
    }

    /// The sample delivered last, when the loop was left at a sample.
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
            kind: SampleKind::Row,
        }
    }
}
