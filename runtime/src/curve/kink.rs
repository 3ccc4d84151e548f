//! Computes when a curve of time passes its points: t_k = x_k / rate, where the abscissa of the curve is `rate` · t and
//! rate > 0.
//!
//! A kink is the smallest representable time at which the computed rate · t is ≥ x_k. So a step that ends on it has
//! its last stage on the left of the point, and the next step has its first stage on the right.

use crate::real::{Mask, Real};

/// The first kink after `t` in any lane. All lanes get this time, each with its own derivatives; +∞ where no kink is
/// left.
pub(super) fn after<T: Real, P>(points: &[P], abscissa: impl Fn(&P) -> f64, rate: T, t: f64) -> T {
    let mut next = f64::INFINITY;
    for point in points {
        let x = T::from_f64(abscissa(point));
        let before = |t: f64| (T::from_f64(t) * rate).lt(x);
        let ahead = before(t);
        if !ahead.any() {
            continue;
        }
        // the earliest time of all lanes that have the point ahead; times are negated because `to_f64` returns the
        // largest lane
        let far = T::from_f64(f64::NEG_INFINITY);
        let mut time = -T::select(ahead, -(x / rate), far).to_f64();
        // division and multiplication may differ by one or two roundings
        let (one, none) = (T::from_f64(1.0), T::from_f64(0.0));
        let reached = |time: f64| {
            let there = T::select(before(time), none, one);
            none.lt(T::select(ahead, there, none)).any()
        };
        for _ in 0..4 {
            if !reached(time) {
                time = time.next_up();
            } else if reached(time.next_down()) {
                time = time.next_down();
            }
        }
        if time > t && time < next {
            next = time;
        }
    }
    if next == f64::INFINITY {
        return T::from_f64(next);
    }
    // d(x_k / rate) = −t_k d(rate) / rate; the value itself does not change
    let (nought, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let moves = nought.lt(rate);
    let part = rate.frozen() / T::select(moves, rate, one);
    T::from_f64(next) * T::select(moves, part, one)
}
