//! The scalar with a fast sine.

use bryant_runtime::Real;
use bryant_runtime::real::Fast;

/// The largest difference of sine and cosine from those of the library, over ±`reach`, in steps that are no part of a
/// turn.
fn worst(reach: f64) -> f64 {
    let steps = 200_000;
    (-steps..=steps)
        .map(|i| reach * f64::from(i) / f64::from(steps))
        .map(|x| {
            let (sine, cosine) = Fast(x).sin_cos();
            (sine.0 - x.sin()).abs().max((cosine.0 - x.cos()).abs())
        })
        .fold(0.0, f64::max)
}

#[test]
fn sine_and_cosine_are_as_good_as_said() {
    for reach in [0.8, 3.2, 10.0, 100.0, 1e4] {
        let worst = worst(reach);
        assert!(worst <= 1e-10, "{reach}: {worst:e}");
        // it is another function than that of the library: the error of the polynomial is visible
        assert!(worst >= 1e-11, "{reach}: {worst:e}");
    }
    assert!(worst(9e8) <= 1e-10 + 9e8 * f64::EPSILON);
}

#[test]
fn signs_and_quadrants_are_those_of_the_library() {
    assert_eq!(Fast(0.0).sin_cos(), (Fast(0.0), Fast(1.0)));
    for i in -40..=40 {
        // the middle of each eighth of a turn
        let x = core::f64::consts::FRAC_PI_4 * (f64::from(i) + 0.5);
        let (sine, cosine) = Fast(x).sin_cos();
        assert_eq!(
            [sine.0 > 0.0, cosine.0 > 0.0],
            [x.sin() > 0.0, x.cos() > 0.0]
        );
        let (back, forth) = Fast(-x).sin_cos();
        assert_eq!([-back, forth], [sine, cosine]);
    }
}

#[test]
fn a_small_angle_is_its_own_sine() {
    for x in [1e-300, 1e-20, 1e-9, 1e-6] {
        let (sine, cosine) = Fast(x).sin_cos();
        // x³/6 is below ε x up to 10⁻⁸, and the polynomial is good to a relative 10⁻⁹ r² beyond
        assert!((sine.0 / x - x.sin() / x).abs() <= f64::EPSILON);
        assert!((cosine.0 - x.cos()).abs() <= f64::EPSILON);
    }
}

#[test]
fn all_else_is_that_of_a_double() {
    let (a, b) = (2.7_f64, -1.3_f64);
    let pairs = [
        (Fast(a) + Fast(b), a + b),
        (Fast(a) - Fast(b), a - b),
        (Fast(a) * Fast(b), a * b),
        (Fast(a) / Fast(b), a / b),
        (Fast(a).sqrt(), Real::sqrt(a)),
        (Fast(b).abs(), b.abs()),
        (Fast(a).atan2(Fast(b)), Real::atan2(a, b)),
        (Fast(b).exp(), Real::exp(b)),
        (Fast(a).ln(), Real::ln(a)),
        (Fast(a).powf(Fast(b)), Real::powf(a, b)),
        (Fast(a).mul_add(Fast(b), Fast(a)), Real::mul_add(a, b, a)),
        (-Fast(a), -a),
        (Fast(a).max(Fast(b)), a),
    ];
    for (fast, double) in pairs {
        assert_eq!(fast.0, double);
    }
}

#[test]
fn what_is_no_number_shows() {
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 2e9] {
        let (sine, cosine) = Fast(x).sin_cos();
        assert!(sine.0.is_nan() && cosine.0.is_nan(), "{x}");
    }
    assert!(!Fast(f64::NAN).is_finite() && Fast(f64::NAN).taint().0.is_nan());
}
