//! Takes samples of the outputs within the steps just taken: packs places of all lanes into registers, and stores the
//! values found in the series of their lanes.

use super::place::Places;
use super::run::{Run, Work, each};
use super::scenario::Series;
use super::settings::Pace;
use crate::Real;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::simulate::finest;

/// A sample that is due.
#[derive(Clone, Copy)]
pub(super) struct Due {
    /// Index of the sample.
    index: usize,
    /// Time of the sample \[s\].
    t: f64,
    /// True if the sample is at the end of its step.
    ends: bool,
}

impl Due {
    const NONE: Due = Due {
        index: 0,
        t: 0.0,
        ends: false,
    };
}

/// [`Run::sample`]
struct Take<'a>(&'a mut Places<Due>);

impl<T: Several> Work<T> for Take<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.sample(self.0);
    }
}

impl<T: Several> Run<'_, T> {
    /// Takes the samples in the steps just accepted, up to the times `reached` \[s\]; `whole` are the lanes whose steps
    /// were not cut.
    #[inline(always)]
    pub(super) fn deliver(&mut self, accepted: T::Mask, whole: T::Mask, reached: T) {
        let (reached, whole) = (reached.lanes(), whole.lanes());
        let fixed = matches!(self.settings.pace, Pace::Fixed(_));
        let last = self.settings.samples - 1;
        let every = self.settings.duration / last as f64;
        let mut places = Places::new(Due::NONE);
        for i in each(accepted.lanes()) {
            let reached = reached[i].to_f64();
            // Times of samples and of fixed steps are both computed by multiplication, and may differ by rounding where
            // they should be equal.
            let trifle = match fixed && whole >> i & 1 != 0 {
                true => T::EPSILON / f64::EPSILON * finest(reached),
                false => 0.0,
            };
            loop {
                let index = self.lanes[i].sample;
                let t = match index == last {
                    true => self.settings.duration,
                    false => index as f64 * every,
                };
                // rounded to the scalar of the lane
                let t = T::One::from_f64(t).to_f64();
                if index > last || t > reached + trifle {
                    break;
                }
                // with derivatives, the end of a step may move with a parameter, but a sample does not
                let ends = fixed && T::PARTS == 1 && t >= reached - trifle && whole >> i & 1 != 0;
                if !ends {
                    self.step.complete(&*self.models.all);
                }
                self.lanes[i].sample += 1;
                places.push(i, Due { index, t, ends });
                if places.full(T::LANES) {
                    self.apart(Take(&mut places));
                }
            }
        }
        if !places.is_empty() {
            self.apart(Take(&mut places));
        }
    }

    /// Takes samples at packed places, which are cleared afterwards.
    #[inline(always)]
    fn sample(&mut self, places: &mut Places<Due>) {
        let order = self.pack(places);
        let step = &self.step;
        let mut times = [T::One::from_f64(0.0); MOST_LANES];
        let mut ends = 0;
        for (i, (t, due)) in times.iter_mut().zip(places.wanted()).enumerate() {
            *t = T::One::from_f64(due.t);
            ends |= u32::from(due.ends) << i;
        }
        let times = T::of_lanes(&times);
        let mut theta = (times - step.t.ordered(order)) / step.h.ordered(order);
        if T::PARTS > 1 {
            // just within the step: at its end, the state has the derivatives of the end
            let inside = T::from_f64(1.0 - T::EPSILON);
            theta = theta + (theta.frozen().min(inside) - theta.frozen());
        }
        let theta = T::select(T::Mask::of_lanes(ends), T::from_f64(1.0), theta);
        let model = &*self.models.packed;
        step.inside_in_order(model, theta, order, &mut self.state);
        model.outputs(times, &self.state, &mut self.of_model);
        for (found, output) in self.found.iter_mut().zip(&self.outputs) {
            *found = self.of_model[*output].lanes();
        }
        for (position, (lane, due)) in places.each().enumerate() {
            let Series {
                samples, values, ..
            } = &mut self.series[lane];
            for (samples, found) in values.chunks_exact_mut(*samples).zip(&self.found) {
                samples[due.index] = found[position];
            }
        }
        places.clear();
    }
}
