//! Outputs on both sides of events: they may jump there, and a parameter moves when they do.

use super::run::{Run, each};
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};

/// The outputs that are wanted, in each lane, on both sides of an event.
pub(super) struct Sided<S> {
    pub(super) ahead: Box<[[S; MOST_LANES]]>,
    pub(super) behind: Box<[[S; MOST_LANES]]>,
}

impl<T: Several> Run<'_, T> {
    /// Keeps the outputs ahead of an event, at a time \[s\] and the state in `state`.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self, t: T) {
        self.models.all.outputs(t, &self.state, &mut self.of_model);
        for (found, output) in self.sided.ahead.iter_mut().zip(&self.outputs) {
            *found = self.of_model[*output].lanes();
        }
    }

    /// An event happened in these lanes: what the outputs were ahead of it, and are now that the memory of switches is renewed.
    #[inline(always)]
    pub(super) fn note_jumps(&mut self, lanes: T::Mask) {
        let (t, y) = (self.step.t, &self.step.y);
        self.models.all.outputs(t, y, &mut self.of_model);
        for (found, output) in self.sided.behind.iter_mut().zip(&self.outputs) {
            *found = self.of_model[*output].lanes();
        }
        let times = t.lanes();
        for i in each(lanes.lanes()) {
            let series = &mut self.series[i];
            series.events.push(times[i]);
            for (ahead, behind) in self.sided.ahead.iter().zip(&self.sided.behind) {
                series.sides.push([ahead[i], behind[i]]);
            }
        }
    }
}
