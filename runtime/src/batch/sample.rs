//! Samples of the outputs within the steps just taken: places of all lanes packed into registers, and what is found there handed to the
//! series of the lane that it belongs to.

use super::enabled;
use super::place::Places;
use super::run::{Run, each};
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::{Model, Real};

impl<T: Several, M: Model<T>> Run<'_, T, M> {
    /// The samples in the steps just accepted, up to where they end \[s\].
    #[inline(always)]
    pub(super) fn deliver(&mut self, accepted: T::Mask, reached: T) {
        let reached = reached.lanes();
        let last = self.settings.samples - 1;
        let every = self.settings.duration / last as f64;
        let mut places = Places::new((0, 0.0));
        for i in each(accepted.lanes()) {
            let reached = reached[i].to_f64();
            loop {
                let sample = self.lanes[i].sample;
                let t = match sample == last {
                    true => self.settings.duration,
                    false => sample as f64 * every,
                };
                // as the lane tells the time
                let t = T::One::from_f64(t).to_f64();
                if sample > last || t > reached {
                    break;
                }
                self.lanes[i].sample += 1;
                places.push(i, (sample, t));
                if places.full(T::LANES) {
                    self.sample(&places);
                    places = Places::new((0, 0.0));
                }
            }
        }
        if !places.is_empty() {
            self.sample(&places);
        }
    }

    /// Samples with these indices at these times.
    #[inline(always)]
    pub(super) fn sample(&mut self, places: &Places<(usize, f64)>) {
        let model = places.pack::<T, M>(&self.parameters, &self.step, &mut self.packed);
        let step = &self.packed;
        let mut times = [T::One::from_f64(0.0); MOST_LANES];
        for (t, wanted) in times.iter_mut().zip(places.wanted()) {
            *t = T::One::from_f64(wanted.1);
        }
        let times = T::of_lanes(&times);
        let y = step.inside(&model, (times - step.t) / step.h);
        let outputs = enabled::outputs(&model, times, &y);
        for (place, output) in self.outputs.iter().enumerate() {
            let values = outputs[*output].lanes();
            for ((lane, (sample, _)), value) in places.each().zip(&values) {
                let series = &mut self.series[lane];
                series.values[place * series.samples + sample] = *value;
            }
        }
    }
}
