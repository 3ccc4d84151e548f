//! How far the next step of each lane goes: as far as its pace says, cut to meet the next kink in time.

use super::run::{Run, SMALLEST, each};
use super::settings::Pace;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::{Model, Real};

impl<T: Several, M: Model<T>> Run<'_, T, M> {
    /// Time at which each lane must stop next \[s\].
    #[inline(always)]
    pub(super) fn stops(&self) -> T {
        let mut stops = [T::One::from_f64(self.settings.duration); MOST_LANES];
        for (stop, lane) in stops.iter_mut().zip(&self.lanes) {
            *stop = T::One::from_f64(lane.stop);
        }
        T::of_lanes(&stops)
    }

    /// The latest time that the equations are evaluated at before it \[s\].
    #[inline(always)]
    pub(super) fn latest(&self) -> T {
        let mut latest = [T::One::from_f64(self.settings.duration); MOST_LANES];
        // x (1 − ε/2) is rounded to the last number before x
        let before = T::One::from_f64(1.0 - 0.5 * T::EPSILON);
        for (latest, lane) in latest.iter_mut().zip(&self.lanes) {
            *latest = T::One::from_f64(lane.stop) * before;
        }
        T::of_lanes(&latest)
    }

    /// Of fixed steps: how many go from here to the next stop, in these lanes.
    #[inline(always)]
    pub(super) fn count_steps(&mut self, lanes: T::Mask) {
        if let Pace::Fixed(length) = self.settings.pace {
            let span = self.stops() - self.step.t;
            let mut number = self.grid[1];
            for i in each(lanes.lanes()) {
                let span = span.lane(i).to_f64();
                let length = length * T::of_part(self.level).lane(i).to_f64();
                // times are rounded
                let trifle = (T::EPSILON * self.lanes[i].stop / length).max(1e-9);
                let steps = ((span / length - trifle).max(0.0)).floor() + 1.0;
                number = number.with_lane(i, T::One::from_f64(steps));
            }
            let nought = T::from_f64(0.0);
            self.grid = [
                T::select(lanes, self.step.t, self.grid[0]),
                number,
                T::select(lanes, nought, self.grid[2]),
            ];
        }
    }

    /// Where the next step of each lane ends \[s\], and whether that is where it must stop.
    #[inline(always)]
    pub(super) fn reach(&mut self, stops: T) -> (T::Mask, T) {
        let t = self.step.t;
        let span = stops - t;
        match self.settings.pace {
            Pace::Fixed(_) => {
                let [start, number, taken] = self.grid;
                let one = T::from_f64(1.0);
                let length = (stops - start) / number;
                let last = (taken + one).part(0).lt(number.part(0)).not();
                let there = (taken + one).mul_add(length, start);
                (last, T::select(last, stops, there))
            }
            Pace::Adaptive(_) => {
                let c = T::Part::from_f64;
                self.h = self.h.max(c(SMALLEST));
                // never a tiny rest: as in a single run
                let (left, h) = (span.part(0), self.h);
                let lands = (c(1.05) * h).lt(left).not();
                let half = left.lt(c(2.0) * h);
                let length = T::select(half, T::from_f64(0.5) * span, T::of_part(h));
                (lands, T::select(lands, stops, t + length))
            }
        }
    }
}
