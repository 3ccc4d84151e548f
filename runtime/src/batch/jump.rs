//! Records outputs on both sides of events: they may jump there, and a parameter moves the time of the jump.

use super::run::{Run, each};
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};

/// The requested outputs in each lane, just ahead of and just behind an event.
pub(super) struct Sided<S> {
    pub(super) ahead: Box<[[S; MOST_LANES]]>,
    pub(super) behind: Box<[[S; MOST_LANES]]>,
}

impl<T: Several> Run<'_, T> {
    /// Stores the outputs ahead of an event, at a time \[s\] and the state in `state`.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self, t: T) {
        self.models.all.outputs(t, &self.state, &mut self.of_model);
        for (found, output) in self.sided.ahead.iter_mut().zip(&self.outputs) {
            *found = self.of_model[*output].lanes();
        }
    }

    /// Records an event in these lanes, with the outputs ahead of it and those now, after the memory of switches has
    /// been renewed.
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
