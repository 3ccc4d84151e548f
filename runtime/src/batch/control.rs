//! Control of the step in each lane: the same law as for a single run ([`crate::integrate::control`]), with the roots that a
//! register can take.

use super::enabled;
use crate::integrate::control::{LIMIT, SAFETY, SMALLEST_ERROR, Tolerances, kind_of};
use crate::real::{Mask, Several};
use crate::{Model, Real, Vector};

/// The estimate falls like this power of the step.
const ESTIMATE: f64 = 5.0;

/// The memory of the controllers.
#[derive(Clone, Copy, Debug)]
pub struct Controllers<P: Real> {
    previous_error: P,
    just_rejected: P::Mask,
}

impl<P: Real> Controllers<P> {
    /// At the start.
    #[inline(always)]
    pub fn new() -> Self {
        Controllers {
            previous_error: P::from_f64(1.0),
            just_rejected: P::Mask::of_lanes(0),
        }
    }

    /// As at the start, where the mask says so: where a run begins, and where the derivative jumps.
    #[inline(always)]
    pub fn reset(&mut self, lanes: P::Mask) {
        self.previous_error = P::select(lanes, P::from_f64(1.0), self.previous_error);
        self.just_rejected = self.just_rejected.and(lanes.not());
    }

    /// Factor on the step after one with these errors was accepted, where `accepted` says so, and rejected elsewhere among
    /// `taken`; whatever was not taken leaves no trace.
    #[inline(always)]
    pub fn factor(&mut self, error: P, accepted: P::Mask, taken: P::Mask) -> P {
        let c = P::from_f64;
        let finite = error.lt(c(f64::INFINITY));
        let number = P::select(finite, error, c(1.0));
        let small = number.max(c(SMALLEST_ERROR));

        let quotient = self.previous_error / (small * small * small);
        let grown = c(SAFETY) * quotient.powf(c(1.0 / (5.0 * ESTIMATE)));
        let largest = P::select(self.just_rejected, c(1.0), c(LIMIT));
        let grown = grown.max(c(1.0 / LIMIT)).min(largest);

        let shrunk = c(SAFETY) / number.max(c(1.0)).powf(c(1.0 / ESTIMATE));
        let shrunk = shrunk.max(c(1.0 / LIMIT)).min(c(0.9));
        let shrunk = P::select(finite, shrunk, c(1.0 / LIMIT));

        let good = accepted.and(taken);
        self.previous_error = P::select(good, small, self.previous_error);
        let untouched = self.just_rejected.and(taken.not());
        self.just_rejected = untouched.or(taken.and(accepted.not()));
        P::select(accepted, grown, shrunk)
    }
}

/// A first step of each lane from `y` at `t`, where the derivative is `k1`, at most `largest` \[s\]: as that of a single run.
#[inline(always)]
pub fn first_step<T: Several, M: Model<T>>(
    model: &M,
    t: T,
    y: &M::State,
    k1: &M::State,
    tolerances: &Tolerances,
    largest: T::Part,
) -> T::Part {
    let c = T::Part::from_f64;
    let d0 = norm::<T, M>(tolerances, y, y);
    let d1 = norm::<T, M>(tolerances, y, k1);
    let few = d0.lt(c(1e-5)).or(d1.lt(c(1e-5)));
    let quotient = c(0.01) * d0 / d1.max(c(1e-5));
    let guess = T::Part::select(few, c(1e-6), quotient).min(largest);

    // an Euler step shows the second derivative
    let step = T::of_part(guess);
    let mut there = *y;
    for i in 0..M::State::LEN {
        there[i] = step.mul_add(k1[i], y[i]);
    }
    let mut change = *y;
    enabled::rate(model, t + step, &there, &mut change);
    for i in 0..M::State::LEN {
        change[i] = change[i] - k1[i];
    }
    let steepest = d1.max(norm::<T, M>(tolerances, y, &change) / guess);
    let flat = (c(1e-3) * guess).max(c(1e-6));
    let by_curvature = (c(0.01) / steepest.max(c(1e-15))).powf(c(1.0 / ESTIMATE));
    let by_curvature = T::Part::select(c(1e-15).lt(steepest), by_curvature, flat);
    let h = (c(100.0) * guess).min(by_curvature).min(largest);
    // numbers near the ends of the range: begin small, the controller will find its way
    T::Part::select(c(0.0).lt(h), h, largest.min(c(1e-6)))
}

/// The largest ratio of an entry of `v` to the tolerance of that of `y`.
#[inline(always)]
fn norm<T: Several, M: Model<T>>(tolerances: &Tolerances, y: &M::State, v: &M::State) -> T::Part {
    let mut worst = T::Part::from_f64(0.0);
    for i in 0..M::State::LEN {
        for part in 0..T::PARTS {
            let scale = tolerances.scale(kind_of::<T, M>(i), y[i].part(part).abs());
            worst = worst.max(v[i].part(part).abs() / scale);
        }
    }
    worst
}
