//! Outputs on both sides of events: they may jump there, and a parameter moves when they do.

use super::enabled;
use super::run::{Run, each};
use crate::Model;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};

impl<T: Several, M: Model<T>> Run<'_, T, M> {
    /// The outputs that are wanted, in each lane.
    #[inline(always)]
    pub(super) fn outputs_at(&self, t: T, y: &M::State) -> Vec<[T::One; MOST_LANES]> {
        let outputs = enabled::outputs(&self.model, t, y);
        let wanted = self.outputs.iter();
        wanted.map(|output| outputs[*output].lanes()).collect()
    }

    /// An event happened in these lanes: what the outputs were ahead of it, and are now that the memory of switches is renewed.
    #[inline(always)]
    pub(super) fn note_jumps(&mut self, lanes: T::Mask, before: &[[T::One; MOST_LANES]]) {
        let after = self.outputs_at(self.step.t, &self.step.y);
        let times = self.step.t.lanes();
        for i in each(lanes.lanes()) {
            let series = &mut self.series[i];
            series.events.push(times[i]);
            let sides = before.iter().zip(&after);
            let sides = sides.map(|(before, after)| [before[i], after[i]]);
            series.sides.extend(sides);
        }
    }
}
