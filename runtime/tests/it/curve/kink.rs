//! When the abscissa of a curve reaches a point.

use crate::scalars::Pair;
use bryant_runtime::real::Dual;
use bryant_runtime::{Curve, Extrapolate};

const POINTS: [f64; 4] = [-0.1, 0.1, 0.3, 0.7];

const CURVE: Curve<4> = Curve::new(
    [
        [POINTS[0], 0.0],
        [POINTS[1], 1.0],
        [POINTS[2], -1.0],
        [POINTS[3], 2.0],
    ],
    Extrapolate::Hold,
);

fn next(rate: f64, t: f64) -> f64 {
    CURVE.kink_after(rate, t)
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
            let kink = CURVE.kink_after(rate, t);
            t = next(value, t);
            assert_eq!(kink.value, t);
            let exact = -2.0 * x / (value * value);
            assert!((kink.slope - exact).abs() <= 8.0 * f64::EPSILON * exact.abs());
        }
        let none = CURVE.kink_after(rate, t);
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
        let Pair(both) = CURVE.kink_after(Pair([1.0, 0.5]), t);
        assert_eq!(both[0], both[1]);
        t = both[0];
        *seen = t;
    }
    for (seen, expected) in seen.iter().zip([0.1, 0.2, 0.3, 0.6, 0.7, 1.4]) {
        assert!((seen - expected).abs() <= 2.0 * f64::EPSILON, "{seen}");
    }
}
