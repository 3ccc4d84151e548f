//! Computes how far the next step of each lane goes: as far as its pace says, cut to end on the next kink in time.

use super::run::{Run, SMALLEST, each};
use super::settings::{Fixed, Pace};
use crate::Real;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::simulate::{count_steps, to_meet};

/// Equal fixed steps from one time that a step must end at to the next. Times between are computed by multiplication,
/// as in a single run.
#[derive(Clone, Copy)]
pub(super) struct Grid<T> {
    /// The time at which the grid begins \[s\].
    start: T,
    /// Number of steps up to the stop.
    number: T,
    /// Length of every step \[s\].
    length: T,
    /// Number of steps taken.
    taken: T,
}

impl<T: Real> Grid<T> {
    /// The grid of a lane that has not begun.
    #[inline(always)]
    pub(super) fn new() -> Self {
        let nought = T::from_f64(0.0);
        Grid {
            start: nought,
            number: nought,
            length: nought,
            taken: nought,
        }
    }

    /// Counts a step in these lanes.
    #[inline(always)]
    pub(super) fn advance(&mut self, lanes: T::Mask) {
        self.taken = T::select(lanes, self.taken + T::from_f64(1.0), self.taken);
    }
}

/// The end and length of a step in each lane.
pub(super) struct Reach<T: Real> {
    /// True in lanes whose step ends at the next stop.
    pub(super) lands: T::Mask,
    /// The time at which the step ends \[s\], without derivatives: steps do not move with parameters.
    pub(super) reached: T,
    /// The derivatives of the time of the next stop, with the value 0 \[s\].
    pub(super) shift: T,
    /// Length of the step \[s\]: the difference of the times at its ends; for fixed steps, that difference but for
    /// rounding.
    pub(super) length: T,
}

impl<T: Several> Run<'_, T> {
    /// Time at which each lane must stop next \[s\].
    #[inline(always)]
    pub(super) fn stops(&self) -> T {
        let mut stops = [T::One::from_f64(self.settings.duration); MOST_LANES];
        for (stop, lane) in stops.iter_mut().zip(&self.lanes) {
            *stop = lane.stops_at;
        }
        T::of_lanes(&stops)
    }

    /// The latest time before the next stop at which the equations are evaluated, without derivatives \[s\].
    #[inline(always)]
    pub(super) fn latest(&self) -> T {
        let mut latest = [T::One::from_f64(self.settings.duration); MOST_LANES];
        // x (1 − ε/2) is rounded to the last number before x
        let before = T::One::from_f64(1.0 - 0.5 * T::EPSILON);
        for (latest, lane) in latest.iter_mut().zip(&self.lanes) {
            *latest = lane.stops_at * before;
        }
        T::of_lanes(&latest).frozen()
    }

    /// Counts the fixed steps from here to the next stop, in these lanes.
    #[inline(always)]
    pub(super) fn count_steps(&mut self, lanes: T::Mask) {
        let Pace::Fixed(Fixed { step, .. }) = self.settings.pace else {
            return;
        };
        let stops = self.stops().frozen();
        let span = stops - self.step.t;
        let mut number = self.grid.number;
        for i in each(lanes.lanes()) {
            let span = span.lane(i).to_f64();
            let step = step * T::of_part(self.level).lane(i).to_f64();
            // allows for the rounding of times
            let trifle = (T::EPSILON * self.lanes[i].stop / step).max(1e-9);
            let steps = count_steps(span, step, trifle) as f64;
            number = number.with_lane(i, T::One::from_f64(steps));
        }
        let grid = &mut self.grid;
        grid.start = T::select(lanes, self.step.t, grid.start);
        grid.number = number;
        grid.length = T::select(lanes, span / number, grid.length);
        grid.taken = T::select(lanes, T::from_f64(0.0), grid.taken);
    }

    /// The end and length of the next step of each lane.
    #[inline(always)]
    pub(super) fn reach(&mut self, stops: T) -> Reach<T> {
        let t = self.step.t;
        let shift = stops - stops.frozen();
        let stops = stops.frozen();
        match self.settings.pace {
            Pace::Fixed(_) => {
                let Grid {
                    start,
                    number,
                    length,
                    taken,
                } = self.grid;
                let next = taken + T::from_f64(1.0);
                let lands = next.part(0).lt(number.part(0)).not();
                Reach {
                    lands,
                    reached: T::select(lands, stops, next * length + start),
                    shift,
                    length,
                }
            }
            Pace::Adaptive(_) => {
                let c = T::Part::from_f64;
                let span = stops - t;
                self.h = self.h.min(c(self.info.longest_step)).max(c(SMALLEST));
                let [lands, half] = to_meet(span.part(0), self.h);
                let length = T::select(half, T::from_f64(0.5) * span, T::of_part(self.h));
                let reached = T::select(lands, stops, t + length);
                Reach {
                    lands,
                    reached,
                    shift,
                    length: reached - t,
                }
            }
        }
    }
}
