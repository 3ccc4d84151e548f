//! Curves of cubic pieces.

use crate::scalars::Pair;
use bryant_runtime::curve::{Cubic, Extrapolate};
use bryant_runtime::{DoubleDouble, Dual, Real};

/// x³ − 3x + 1 with its exact slopes: each piece is the polynomial itself.
const POINTS: [[f64; 3]; 4] = [
    [-2.0, -1.0, 9.0],
    [-1.0, 3.0, 0.0],
    [1.0, -1.0, 0.0],
    [2.5, 9.125, 15.75],
];
const LINEAR: Cubic<4> = Cubic::new(POINTS, Extrapolate::Linear);
const HOLD: Cubic<4> = Cubic::new(POINTS, Extrapolate::Hold);
const ERROR: Cubic<4> = Cubic::new(POINTS, Extrapolate::Error);

#[test]
fn a_cubic_is_reproduced_with_derivatives_and_integrals() {
    for i in -32..=40 {
        let x = f64::from(i) / 16.0;
        let expected = [
            x * x * x - 3.0 * x + 1.0,
            3.0 * x * x - 3.0,
            6.0 * x,
            x * (x * x * x / 4.0 - 1.5 * x + 1.0),
            x * x * (x * x * x / 20.0 - 0.5 * x + 0.5),
        ];
        for curve in [LINEAR, HOLD, ERROR] {
            let last = x == 2.5;
            let ours = [
                curve.value(x),
                curve.slope(x),
                curve.second_derivative(x),
                curve.integral(x),
                curve.double_integral(x),
            ];
            for (what, (ours, expected)) in ours.iter().zip(expected).enumerate() {
                // another law holds to the right of the last point, except where leaving the curve is an error
                if last && curve != ERROR && (1..=2).contains(&what) {
                    continue;
                }
                // a dozen products of numbers below 40
                let bound = 12.0 * 40.0 * f64::EPSILON;
                assert!((ours - expected).abs() <= bound, "{what} at {x}: {ours}");
            }
        }
    }
}

#[test]
fn points_are_exact() {
    for [x, y, m] in &POINTS[..3] {
        assert_eq!([LINEAR.value(*x), LINEAR.slope(*x)], [*y, *m]);
    }
    assert_eq!(HOLD.value(2.5), 9.125);
}

#[test]
fn beyond_the_points_as_told() {
    assert_eq!(LINEAR.value(-3.0), -10.0);
    assert_eq!(LINEAR.value(3.5), 9.125 + 15.75);
    assert_eq!([LINEAR.slope(-3.0), LINEAR.slope(3.5)], [9.0, 15.75]);
    assert_eq!([HOLD.value(-3.0), HOLD.value(9.0)], [-1.0, 9.125]);
    assert_eq!([HOLD.slope(-3.0), HOLD.slope(9.0)], [0.0, 0.0]);
    for x in [-3.0f64, 4.0] {
        assert_eq!(LINEAR.second_derivative(x), 0.0);
        assert!(ERROR.value(x).is_nan() && ERROR.slope(x).is_nan());
        assert!(ERROR.second_derivative(x).is_nan() && ERROR.integral(x).is_nan());
    }
    // the line continues with slope 15.75 from 9.125
    let gained: f64 = LINEAR.integral(3.5) - LINEAR.integral(2.5);
    assert!((gained - (9.125 + 15.75 / 2.0)).abs() <= 1e-13, "{gained}");
}

#[test]
fn inverse_is_the_leftmost_rising_solution() {
    // rising pieces: −2 … −1 with −1 … 3, and 1 … 2.5 with −1 … 9.125
    for y in [-0.9f64, 0.0, 1.0, 2.99] {
        let x = LINEAR.inverse(y);
        assert!((-2.0..=-1.0).contains(&x), "{x}");
        assert!((LINEAR.value(x) - y).abs() <= 16.0 * f64::EPSILON);
    }
    for y in [3.5f64, 7.0, 9.125] {
        let x = HOLD.inverse(y);
        assert!((1.0..=2.5).contains(&x), "{x}");
        assert!((HOLD.value(x) - y).abs() <= 64.0 * f64::EPSILON);
    }
    assert_eq!(LINEAR.inverse(9.125 + 31.5), 4.5);
    assert_eq!(LINEAR.inverse(-10.0), -3.0);
    assert!(HOLD.inverse(9.2_f64).is_nan() && HOLD.inverse(-1.1_f64).is_nan());
    let pair = LINEAR.inverse(Pair([0.0, 7.0]));
    assert_eq!(pair, Pair([LINEAR.inverse(0.0), LINEAR.inverse(7.0)]));
    let dual = LINEAR.inverse(Dual::variable(7.0_f64));
    let slope = 1.0 / LINEAR.slope(dual.value);
    assert!((dual.slope - slope).abs() <= 8.0 * f64::EPSILON * slope);
}

#[test]
fn derivative_of_a_dual_is_the_slope() {
    for x in [-3.0_f64, -1.5, 0.25, 1.75, 9.0] {
        let there = Dual::variable(x);
        let [value, slope] = [LINEAR.value(there), LINEAR.slope(there)];
        assert!((value.slope - LINEAR.slope(x)).abs() <= 64.0 * f64::EPSILON);
        assert!((slope.slope - LINEAR.second_derivative(x)).abs() <= 64.0 * f64::EPSILON);
    }
}

#[test]
fn more_digits_than_a_double_s_stay() {
    let c = DoubleDouble::from_f64;
    let u2 = 0.25 * f64::EPSILON * f64::EPSILON;
    // as for doubles: a dozen products of numbers below 40
    let bound = 12.0 * 40.0 * 7.0 * u2;
    let near = |a: DoubleDouble, b: DoubleDouble, bound: f64| {
        let off = (a - b).to_f64().abs();
        assert!(off <= bound, "{a:?} instead of {b:?}: {off:e} > {bound:e}");
    };
    for i in -41..=52 {
        // within −2 … 2.5, where the curve is x³ − 3x + 1
        let x = c(f64::from(i)) / c(21.0);
        let there = Dual::variable(x);
        let [value, slope] = [LINEAR.value(there), LINEAR.slope(there)];
        near(value.value, x * x * x - c(3.0) * x + c(1.0), bound);
        near(value.slope, c(3.0) * x * x - c(3.0), bound);
        near(slope.value, value.slope, bound);
        near(slope.slope, c(6.0) * x, bound);
        near(LINEAR.second_derivative(x), c(6.0) * x, bound);
    }
    // bisection ends at 2⁻⁵⁴ of a piece, and each Newton step squares that error (of the derivative a step later),
    // where the curve is not about to turn (at y = 3)
    for i in 1..=30 {
        let y = c(f64::from(i)) * c(0.3) - c(0.1) / c(3.0);
        let x = LINEAR.inverse(Dual::variable(y));
        let slope = LINEAR.slope(x.value);
        near(LINEAR.value(x.value), y, bound);
        near(x.slope * slope, c(1.0), bound);
    }
}

#[test]
fn nan_stays_nan() {
    for curve in [LINEAR, HOLD, ERROR] {
        assert!(curve.value(f64::NAN).is_nan() && curve.slope(f64::NAN).is_nan());
        assert!(curve.second_derivative(f64::NAN).is_nan() && curve.inverse(f64::NAN).is_nan());
        assert!(curve.integral(f64::NAN).is_nan() && curve.double_integral(f64::NAN).is_nan());
    }
}

#[test]
fn lanes_apart_find_their_own_pieces_of_a_long_curve() {
    const MANY: Cubic<40> = {
        let mut points = [[0.0; 3]; 40];
        let mut k = 0;
        while k < 40 {
            let x = k as f64 * 0.1;
            points[k] = [x, 1.0 / (1.0 + x), -1.0 / ((1.0 + x) * (1.0 + x))];
            k += 1;
        }
        Cubic::new(points, Extrapolate::Hold)
    };
    for i in 0..390 {
        let x = f64::from(i) * 0.01;
        // Hermite's remainder: h⁴/384 max|f⁗| = 1e-4/384 · 24
        let miss = MANY.value(x) - 1.0 / (1.0 + x);
        assert!(miss.abs() <= 1e-4 / 16.0, "{miss} at {x}");
        let pair = MANY.value(Pair([x, 3.9 - x]));
        assert_eq!(pair, Pair([MANY.value(x), MANY.value(3.9 - x)]));
    }
}
