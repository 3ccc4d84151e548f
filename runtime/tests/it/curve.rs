//! Curves of straight lines.

mod breakpoint_indicator;
mod cubic;
mod kink;
mod stop;
mod table;

use crate::scalars::Pair;
use bryant_runtime::curve::{Curve, Extrapolate};
use bryant_runtime::{DoubleDouble, Dual, Real};

const POINTS: [[f64; 2]; 4] = [[-1.0, 2.0], [0.0, 0.0], [0.5, 0.0], [2.5, 6.0]];
const LINEAR: Curve<4> = Curve::new(POINTS, Extrapolate::Linear);
const HOLD: Curve<4> = Curve::new(POINTS, Extrapolate::Hold);
const ERROR: Curve<4> = Curve::new(POINTS, Extrapolate::Error);

/// The same curves by case distinction.
fn closed_form(x: f64) -> (f64, f64) {
    match x {
        x if x < 0.0 => (-2.0 * x, -2.0),
        x if x < 0.5 => (0.0, 0.0),
        x => (3.0 * (x - 0.5), 3.0),
    }
}

#[test]
fn value_and_slope_are_the_closed_form() {
    for i in -32..=80 {
        // binary fractions: every operation is exact
        let x = f64::from(i) / 16.0;
        let (value, slope) = closed_form(x);
        assert_eq!(LINEAR.value(x), value, "at {x}");
        assert_eq!(LINEAR.slope(x), slope, "at {x}");
        let held = closed_form(x.clamp(-1.0, 2.5)).0;
        assert_eq!(HOLD.value(x), held, "at {x}");
        let outside = !(-1.0..=2.5).contains(&x);
        let right_of_all = x >= 2.5;
        let slope_held = if outside || right_of_all { 0.0 } else { slope };
        assert_eq!(HOLD.slope(x), slope_held, "at {x}");
        if outside {
            assert!(ERROR.value(x).is_nan() && ERROR.slope(x).is_nan(), "at {x}");
        } else {
            assert_eq!(ERROR.value(x), value, "at {x}");
            assert_eq!(ERROR.slope(x), slope, "at {x}");
        }
    }
}

#[test]
fn integrals_are_the_closed_form() {
    // ∫₀ˣ: x² left of 0, 0 up to 0.5, (3/2)(x − 0.5)² beyond; ∬₀ˣ: x³/3 … with signs, (1/2)(x − 0.5)³ beyond
    for i in -48..=80 {
        let x = f64::from(i) / 16.0;
        let beyond = (x - 0.5).max(0.0);
        let (once, twice) = if x < 0.0 {
            (-x * x, -x * x * x / 3.0)
        } else {
            (1.5 * beyond.powi(2), 0.5 * beyond.powi(3))
        };
        // a few products of numbers below 30
        let bound = 30.0 * 8.0 * f64::EPSILON;
        assert!((LINEAR.integral(x) - once).abs() <= bound, "at {x}");
        assert!((LINEAR.double_integral(x) - twice).abs() <= bound, "at {x}");
    }
    // held at 6 beyond 2.5
    assert_eq!(HOLD.integral(3.5) - HOLD.integral(2.5), 6.0);
    assert!(ERROR.integral(3.0f64).is_nan());
}

#[test]
fn nan_stays_nan() {
    for curve in [LINEAR, HOLD, ERROR] {
        assert!(curve.integral(f64::NAN).is_nan() && curve.double_integral(f64::NAN).is_nan());
        assert!(curve.value(f64::NAN).is_nan());
        assert!(curve.slope(f64::NAN).is_nan());
        assert!(curve.inverse(f64::NAN).is_nan());
    }
}

#[test]
fn points_are_exact_and_bisection_finds_the_segment() {
    const MANY: Curve<40> = {
        let mut points = [[0.0; 2]; 40];
        let mut k = 0;
        while k < 40 {
            let x = k as f64 * 0.1;
            points[k] = [x, 1.0 / (1.0 + x)];
            k += 1;
        }
        Curve::new(points, Extrapolate::Hold)
    };
    for k in 0..40 {
        let x = f64::from(k) * 0.1;
        assert_eq!(MANY.value(x), 1.0 / (1.0 + x));
    }
    // a linear interpolant is within h²/8 max|f″| = 0.01/8 · 2 of the function
    for i in 0..390 {
        let x = f64::from(i) * 0.01;
        let miss = MANY.value(x) - 1.0 / (1.0 + x);
        assert!(
            (0.0..0.0025 + 1e-15).contains(&(miss + 1e-15)),
            "{miss} at {x}"
        );
        // lanes that disagree find the same value without bisection
        let there = Pair([x, 3.9 - x]);
        assert_eq!(
            MANY.value(there),
            Pair([MANY.value(x), MANY.value(3.9 - x)])
        );
        assert_eq!(
            MANY.slope(there),
            Pair([MANY.slope(x), MANY.slope(3.9 - x)])
        );
    }
}

#[test]
fn derivative_of_a_dual_is_the_slope() {
    for x in [-3.0, -0.5, 0.25, 0.5, 1.0, 9.0] {
        let y = LINEAR.value(Dual::variable(x));
        assert_eq!(
            y,
            Dual {
                value: LINEAR.value(x),
                slope: LINEAR.slope(x)
            }
        );
    }
}

#[test]
fn more_digits_than_a_double_s_stay() {
    let c = DoubleDouble::from_f64;
    let u2 = 0.25 * f64::EPSILON * f64::EPSILON;
    for i in -20..=40 {
        // thirds of sevenths, with digits to the last
        let x = c(f64::from(i)) / c(21.0);
        let (_, slope) = closed_form(x.to_f64());
        let from = c(if slope > 0.0 { 0.5 } else { 0.0 });
        let expected = c(slope) * (x - from);
        let ours = LINEAR.value(x);
        // two ways to write a product and a sum of numbers below 6
        assert!(
            (ours - expected).to_f64().abs() <= 20.0 * 6.0 * u2,
            "{x:?}: {ours:?}"
        );
        assert_eq!(LINEAR.slope(x), c(slope));
        let there = LINEAR.value(Dual::variable(x));
        assert_eq!([there.value, there.slope], [ours, c(slope)]);
        if slope > 0.0 {
            let back = LINEAR.inverse(ours);
            assert!(
                (back - x).to_f64().abs() <= 40.0 * 6.0 * u2,
                "{x:?}: {back:?}"
            );
        }
    }
    // the slope is the double nearest to a third, for every scalar
    let third = Curve::new([[0.0, 0.0], [3.0, 1.0]], Extrapolate::Linear);
    let [slope, y] = [third.slope(c(2.0)), third.value(c(2.0))];
    assert_eq!(slope, c(1.0 / 3.0));
    assert_eq!(y, c(2.0) * slope);
}

#[test]
fn inverse_is_the_leftmost_rising_solution() {
    // only rising segments count: neither the falling nor the flat one
    assert_eq!(LINEAR.inverse(0.0), 0.5);
    assert_eq!(LINEAR.inverse(3.0), 1.5);
    assert_eq!(LINEAR.inverse(6.0), 2.5);
    assert_eq!(LINEAR.inverse(9.0), 3.5);
    assert_eq!(HOLD.inverse(6.0), 2.5);
    assert!(HOLD.inverse(6.5_f64).is_nan() && ERROR.inverse(6.5_f64).is_nan());
    assert!(LINEAR.inverse(-1.0_f64).is_nan());

    let steps = Curve::new(
        [[0.0, 0.0], [1.0, 2.0], [2.0, 1.0], [3.0, 3.0]],
        Extrapolate::Linear,
    );
    assert_eq!(steps.inverse(1.5), 0.75);
    assert_eq!(steps.inverse(2.5), 2.75);
    assert_eq!(steps.inverse(-4.0), -2.0);
    let both = steps.inverse(Pair([1.5, 2.5]));
    assert_eq!(both, Pair([0.75, 2.75]));
}

#[test]
#[should_panic(expected = "increase")]
fn a_curve_running_backwards_is_refused() {
    Curve::new([[0.0, 0.0], [0.0, 1.0]], Extrapolate::Hold);
}
