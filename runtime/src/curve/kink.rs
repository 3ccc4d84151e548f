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

#[cfg(test)]
mod tests {
    use super::after;
    use crate::real::Dual;
    use crate::test_scalars::Pair;

    const POINTS: [f64; 4] = [-0.1, 0.1, 0.3, 0.7];

    fn next(rate: f64, t: f64) -> f64 {
        after(&POINTS, |x| *x, rate, t)
    }

    #[test]
    fn kinks_are_where_the_abscissa_reaches_a_point() {
        for rate in [0.1, 0.3, 1.0 / 3.0, 1.0, 1.0 / 0.7, 7.3] {
            let mut t = 0.0;
            for x in &POINTS[1..] {
                t = next(rate, t);
                assert!(t * rate >= *x, "at rate {rate}: {t}");
                assert!(t.next_down() * rate < *x, "at rate {rate}: {t}");
            }
            assert_eq!(next(rate, t), f64::INFINITY);
        }
    }

    #[test]
    fn derivatives_are_those_of_a_point_over_the_rate() {
        for value in [0.3, 1.0 / 0.7, 7.3] {
            let rate = Dual { value, slope: 2.0 };
            let mut t = 0.0;
            for x in &POINTS[1..] {
                let kink = after(&POINTS, |x| *x, rate, t);
                t = next(value, t);
                assert_eq!(kink.value, t);
                let exact = -2.0 * x / (value * value);
                assert!((kink.slope - exact).abs() <= 8.0 * f64::EPSILON * exact.abs());
            }
            let none = after(&POINTS, |x| *x, rate, t);
            assert_eq!((none.value, none.slope), (f64::INFINITY, 0.0));
        }
    }

    #[test]
    fn no_kink_is_ahead_where_time_stands_still() {
        assert_eq!(next(0.0, 0.0), f64::INFINITY);
        assert_eq!(next(f64::NAN, 0.0), f64::INFINITY);
        assert_eq!(next(-1.0, 0.0), f64::INFINITY);
    }

    #[test]
    fn of_lanes_the_first_kink_counts() {
        let mut t = 0.0;
        let mut seen = [0.0; 6];
        for seen in &mut seen {
            let Pair(both) = after(&POINTS, |x| *x, Pair([1.0, 0.5]), t);
            assert_eq!(both[0], both[1]);
            t = both[0];
            *seen = t;
        }
        for (seen, expected) in seen.iter().zip([0.1, 0.2, 0.3, 0.6, 0.7, 1.4]) {
            assert!((seen - expected).abs() <= 2.0 * f64::EPSILON, "{seen}");
        }
    }
}
