//! The breakpoint indicator of a curve: a continuous function of slope ±1 whose sign changes where the curve is not
//! smooth. Its magnitude is the distance to the nearest such point.
//!
//! A point counts where the slope changes, for cubics also where the second derivative changes. The outermost points
//! count where the extrapolation changes them. Changes that are due to rounding alone do not count.

use super::candidates;
use crate::real::Real;

/// The indicator of a curve that is not smooth at `kinks`, which increase. It is positive left of the first one, and 1
/// everywhere where there is none. NaN only where `x` is NaN.
#[inline(always)]
pub(super) fn breakpoint_indicator<T: Real>(kinks: &[f64], x: T) -> T {
    if kinks.is_empty() {
        return T::from_f64(1.0) + x.taint();
    }
    let (first, last) = candidates(kinks.len(), |k| kinks[k], x);
    let mut y = piece(kinks, first, x);
    for k in first..last {
        y = T::select(x.lt(T::from_f64(kinks[k])), y, piece(kinks, k + 1, x));
    }
    y
}

/// The value on one piece: piece 0 lies left of the first kink, piece k + 1 right of kink k.
#[inline(always)]
fn piece<T: Real>(kinks: &[f64], piece: usize, x: T) -> T {
    let distance = if piece == 0 {
        before(kinks[0], x)
    } else if piece == kinks.len() {
        -before(kinks[piece - 1], x)
    } else {
        (-before(kinks[piece - 1], x)).min(before(kinks[piece], x))
    };
    if piece.is_multiple_of(2) {
        distance
    } else {
        -distance
    }
}

#[inline(always)]
fn before<T: Real>(kink: f64, x: T) -> T {
    T::from_f64(kink) - x
}

/// A bound of the error in the slope of a line through two points, due to the rounding of their coordinates.
pub(super) const fn rounding([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
    let run = x1 - x0;
    let slope = ((y1 - y0) / run).abs();
    4.0 * f64::EPSILON * (y0.abs() + y1.abs() + slope * (x0.abs() + x1.abs())) / run
}
