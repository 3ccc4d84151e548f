//! The head injury criterion: HIC = max L (V/(g L))^2.5, over windows of a length L of at most 15 or 36 ms in which the
//! acceleration adds up to the velocity V \[SAE J1727\].
//!
//! The search compares the square of L (V/(g L))^2.5, which is L² a⁵ with the mean acceleration a = V/(g L). The root
//! is taken once, at the end. Among the windows of one length only the largest V counts: one difference and one
//! comparison per window.

use super::whole_and_rest;
use crate::{Mask, Real};

/// Standard acceleration of gravity \[m/s²\].
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// The number of windows that are compared at once. Their maxima are independent, so they fill vector registers.
const ABREAST: usize = 8;

/// HIC of `samples` \[m/s²\], which are `every` \[s\] apart; 0 where no window gains velocity. `None` with fewer than
/// two samples, or if `window` \[s\] is not positive and finite.
#[inline(always)]
pub(super) fn hic<T: Real>(samples: &[T], every: f64, window: f64, scratch: &mut [T]) -> Option<T> {
    let last = samples.len().checked_sub(1).filter(|last| *last > 0)?;
    if window.is_nan() || window <= 0.0 {
        return None;
    }
    let velocity = accumulate(samples, scratch);
    // no window is longer than the signal
    let (longest, rest) = whole_and_rest(window / every, last).unwrap_or((last, 0.0));

    // L in intervals
    let squared = |gain: T, length: f64| {
        let mean = gain * T::from_f64(1.0 / (STANDARD_GRAVITY * length));
        let square = mean * mean;
        square * square * mean * T::from_f64(length * length)
    };
    let mut largest = T::from_f64(0.0);
    if longest > 0 {
        largest = squared(largest_gain(velocity, longest), longest as f64);
    }
    if rest > 0.0 {
        let gain = largest_gain_of_rest(samples, velocity, longest, rest);
        largest = largest.max(squared(gain, longest as f64 + rest));
    }
    // A window gains at most as much as a shorter one plus the highest sample over the rest. So most windows need not
    // be checked.
    let highest = samples
        .iter()
        .fold(T::from_f64(0.0), |most, a| most.max(*a));
    let (mut looked_at, mut gain) = (0, T::from_f64(0.0));
    for length in 1..longest {
        let most = highest.mul_add(T::from_f64((length - looked_at) as f64), gain);
        if largest
            .lt(squared(most, length as f64) * T::from_f64(ROUNDED))
            .any()
        {
            (looked_at, gain) = (length, largest_gain(velocity, length));
            largest = largest.max(squared(gain, length as f64));
        }
    }
    Some(largest.sqrt() * T::from_f64(every))
}

/// Factor on a bound that allows for its rounding, also in single precision.
const ROUNDED: f64 = 1.01;

/// The integral from the first sample to each, in intervals.
#[inline(always)]
fn accumulate<'a, T: Real>(samples: &[T], scratch: &'a mut [T]) -> &'a [T] {
    let mut sum = T::from_f64(0.0);
    let mut previous = None;
    for (place, sample) in scratch.iter_mut().zip(samples) {
        if let Some(previous) = previous {
            sum = (*sample + previous).mul_add(T::from_f64(0.5), sum);
        }
        previous = Some(*sample);
        *place = sum;
    }
    scratch
}

/// The largest gain of velocity in `length` whole intervals.
#[inline(always)]
fn largest_gain<T: Real>(velocity: &[T], length: usize) -> T {
    let zero = T::from_f64(0.0);
    let mut gains = [zero; ABREAST];
    let (ends, starts) = (&velocity[length..], &velocity[..velocity.len() - length]);
    let (ends, end_rest) = ends.as_chunks::<ABREAST>();
    let (starts, start_rest) = starts.as_chunks::<ABREAST>();
    for (end, start) in ends.iter().zip(starts) {
        for i in 0..ABREAST {
            gains[i] = gains[i].max(end[i] - start[i]);
        }
    }
    for (gain, (end, start)) in gains.iter_mut().zip(end_rest.iter().zip(start_rest)) {
        *gain = gain.max(*end - *start);
    }
    gains.into_iter().fold(zero, T::max)
}

/// The largest gain of velocity in `whole` + `rest` intervals that begin or end on a sample.
#[inline(always)]
fn largest_gain_of_rest<T: Real>(samples: &[T], velocity: &[T], whole: usize, rest: f64) -> T {
    let mut gain = T::from_f64(0.0);
    // the integral over the part next to a of the interval from a to b: rest · a + rest²/2 · (b − a)
    let part = |a: T, b: T| T::from_f64(rest) * (b - a).mul_add(T::from_f64(0.5 * rest), a);
    for first in 0..samples.len() - whole - 1 {
        let end = first + whole;
        let behind = velocity[end] - velocity[first] + part(samples[end], samples[end + 1]);
        let ahead =
            velocity[end + 1] - velocity[first + 1] + part(samples[first + 1], samples[first]);
        gain = gain.max(behind).max(ahead);
    }
    gain
}
