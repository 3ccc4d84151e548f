//! Integral and mean of a signal that is linear between its samples.

use crate::Real;

/// The integral by the trapezium rule, in intervals.
#[inline(always)]
pub(super) fn integral<T: Real>(samples: &[T]) -> T {
    let half = T::from_f64(0.5);
    samples.windows(2).fold(T::from_f64(0.0), |sum, pair| {
        (pair[0] + pair[1]).mul_add(half, sum)
    })
}

/// The integral divided by the length. For a single sample it is that sample.
#[inline(always)]
pub(super) fn mean<T: Real>(samples: &[T]) -> T {
    match samples {
        [only] => *only,
        _ => integral(samples) * T::from_f64(1.0 / (samples.len() as f64 - 1.0)),
    }
}
