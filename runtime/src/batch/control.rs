//! Step-size control in each lane, by the formulas of [`crate::integrate::control`], with roots that registers can
//! compute.

use super::tolerance::Allowed;
use crate::integrate::control::{Roots, first_guess, first_length};
use crate::real::Several;
use crate::{Dynamics, Real};

/// The order of the error estimate: it falls like this power of the step.
pub const ESTIMATE: u32 = 5;

/// Roots computed as powers, which registers can do.
pub struct Power;

impl<P: Real> Roots<P> for Power {
    #[inline(always)]
    fn root(x: P, [a, b]: [u32; 2]) -> P {
        match a * b {
            2 => x.sqrt(),
            parts => x.powf(P::from_f64(1.0 / f64::from(parts))),
        }
    }
}

/// The first step of each lane from `y` at `t`, where the derivative is `k1`, at most `largest` \[s\]: by the formula
/// of a single run. `there` and `change` are workspaces as long as a state.
#[inline(always)]
pub fn first_step<T: Several>(
    model: &dyn Dynamics<T>,
    t: T,
    (y, k1): (&[T], &[T]),
    allowed: &[Allowed<T::Part>],
    largest: T::Part,
    (there, change): (&mut [T], &mut [T]),
) -> T::Part {
    let d1 = norm::<T>(allowed, y, k1);
    let guess = first_guess([norm::<T>(allowed, y, y), d1], largest);
    // an Euler step estimates the second derivative
    let step = T::of_part(guess);
    for ((there, y), k1) in there.iter_mut().zip(y).zip(k1) {
        *there = step.mul_add(*k1, *y);
    }
    model.derivative(t + step, there, change);
    for (change, k1) in change.iter_mut().zip(k1) {
        *change = *change - *k1;
    }
    let change = norm::<T>(allowed, y, change);
    first_length::<_, Power>(guess, [d1, change], largest, ESTIMATE - 1)
}

/// The largest ratio of an entry of `v` to the tolerance of that of `y`.
#[inline(always)]
pub fn norm<T: Several>(allowed: &[Allowed<T::Part>], y: &[T], v: &[T]) -> T::Part {
    let mut worst = T::Part::from_f64(0.0);
    for ((allowed, y), v) in allowed.iter().zip(y).zip(v) {
        for part in 0..T::PARTS {
            let scale = allowed.scale(y.part(part).abs());
            worst = worst.max(v.part(part).abs() / scale);
        }
    }
    worst
}
