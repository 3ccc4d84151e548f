//! What every scalar has.

mod array;
mod dual;
mod fast_scalar;
mod lanes;
mod layout;

use bryant_runtime::Real;

#[test]
fn nan_on_the_left_survives_max_and_min() {
    assert!(Real::max(f64::NAN, 1.0).is_nan());
    assert!(Real::min(f64::NAN, 1.0).is_nan());
    assert_eq!(Real::max(1.0, f64::NAN), 1.0);
    assert_eq!(Real::max(1.0, 2.0), 2.0);
    assert_eq!(Real::min(1.0_f32, 2.0), 1.0);
}

#[test]
fn products_and_sums_are_rounded_one_after_the_other_on_every_processor() {
    // 1/3 · 3 − 1: exactly 0 rounded twice, −2⁻⁵⁴ fused
    assert_eq!(Real::mul_add(1.0 / 3.0, 3.0, -1.0_f64), 0.0);
    assert_eq!(Real::mul_add(1.0 / 3.0, 3.0, -1.0_f32), 0.0);
}

#[test]
fn the_exponential_of_arithmetic_is_that_of_the_library() {
    use crate::scalars::Pair;
    for i in -700..=700 {
        let x = f64::from(i) + 0.37 * f64::from(i % 3);
        let Pair([one, other]) = Real::exp(Pair([x, -x]));
        let bound = (4.0 + 20.0 * x.abs()) * f64::EPSILON;
        assert!((one / x.exp() - 1.0).abs() < bound, "{x}: {one:e}");
        assert!((other / (-x).exp() - 1.0).abs() < bound, "{x}: {other:e}");
    }
    let Pair([zero, nan]) = Real::exp(Pair([0.0, f64::NAN]));
    assert!(zero == 1.0 && nan.is_nan());
}

#[test]
fn the_logarithm_of_arithmetic_is_that_of_the_library() {
    use crate::scalars::Pair;
    for i in -700..=700 {
        let x = (f64::from(i) + 0.37 * f64::from(i % 3)).exp();
        let near = 1.0 + 1e-3 * f64::from(i);
        let Pair([one, other]) = Real::ln(Pair([x, near]));
        let bound = |x: f64| (8.0 + 40.0 * x.ln().abs()) * f64::EPSILON;
        assert!((one - x.ln()).abs() <= bound(x), "{x}: {one:e}");
        assert!(
            (other - near.ln()).abs() <= bound(near),
            "{near}: {other:e}"
        );
    }
    let Pair([zero, one]) = Real::ln(Pair([0.0, 1.0]));
    assert_eq!([zero, one], [f64::NEG_INFINITY, 0.0]);
    let Pair([infinite, nan]) = Real::ln(Pair([f64::INFINITY, f64::NAN]));
    assert!(infinite == f64::INFINITY && nan.is_nan());
    assert!(Real::ln(Pair([-1.0; 2])).0[0].is_nan());
}

#[test]
fn both_primitives_agree_on_the_elementary_functions() {
    for i in -20..20 {
        let x = 0.37 * f64::from(i);
        let (s, c) = Real::sin_cos(x);
        assert!((s * s + c * c - 1.0).abs() < 4.0 * f64::EPSILON);
        // the angle comes back modulo a turn
        let turns = (x - Real::atan2(s, c)) / core::f64::consts::TAU;
        assert!((turns - turns.round()).abs() < 1e-15);
        let (s32, c32) = Real::sin_cos(x as f32);
        assert!((f64::from(s32) - s).abs() < 1e-6 && (f64::from(c32) - c).abs() < 1e-6);
    }
    assert_eq!(Real::sqrt(2.25_f64), 1.5);
    assert_eq!(Real::sqrt(2.25_f32), 1.5);
    assert_eq!(Real::powf(6.25_f64, 1.5), 15.625);
    assert_eq!(Real::powf(6.25_f32, 1.5), 15.625);
}
