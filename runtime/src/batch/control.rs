//! Control of the step in each lane: the same law as for a single run ([`crate::integrate::control`]), with the roots that a
//! register can take.

use super::tolerance::Allowed;
use crate::integrate::control::{LIMIT, SAFETY, SMALLEST_ERROR};
use crate::real::{Mask, Several};
use crate::{Dynamics, Real};

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

/// A first step of each lane from `y` at `t`, where the derivative is `k1`, at most `largest` \[s\]: as that of a single run. It leaves
/// nothing of use in `there` and `change`, which are as long as a state.
#[inline(always)]
pub fn first_step<T: Several>(
    model: &dyn Dynamics<T>,
    t: T,
    (y, k1): (&[T], &[T]),
    allowed: &[Allowed<T::Part>],
    largest: T::Part,
    (there, change): (&mut [T], &mut [T]),
) -> T::Part {
    let c = T::Part::from_f64;
    let d0 = norm::<T>(allowed, y, y);
    let d1 = norm::<T>(allowed, y, k1);
    let few = d0.lt(c(1e-5)).or(d1.lt(c(1e-5)));
    let quotient = c(0.01) * d0 / d1.max(c(1e-5));
    let guess = T::Part::select(few, c(1e-6), quotient).min(largest);

    // an Euler step shows the second derivative
    let step = T::of_part(guess);
    for ((there, y), k1) in there.iter_mut().zip(y).zip(k1) {
        *there = step.mul_add(*k1, *y);
    }
    model.derivative(t + step, there, change);
    for (change, k1) in change.iter_mut().zip(k1) {
        *change = *change - *k1;
    }
    let steepest = d1.max(norm::<T>(allowed, y, change) / guess);
    let flat = (c(1e-3) * guess).max(c(1e-6));
    let by_curvature = (c(0.01) / steepest.max(c(1e-15))).powf(c(1.0 / ESTIMATE));
    let by_curvature = T::Part::select(c(1e-15).lt(steepest), by_curvature, flat);
    let h = (c(100.0) * guess).min(by_curvature).min(largest);
    // numbers near the ends of the range: begin small, the controller will find its way
    T::Part::select(c(0.0).lt(h), h, largest.min(c(1e-6)))
}

/// The largest ratio of an entry of `v` to the tolerance of that of `y`.
#[inline(always)]
fn norm<T: Several>(allowed: &[Allowed<T::Part>], y: &[T], v: &[T]) -> T::Part {
    let mut worst = T::Part::from_f64(0.0);
    for ((allowed, y), v) in allowed.iter().zip(y).zip(v) {
        for part in 0..T::PARTS {
            let scale = allowed.scale(y.part(part).abs());
            worst = worst.max(v.part(part).abs() / scale);
        }
    }
    worst
}
