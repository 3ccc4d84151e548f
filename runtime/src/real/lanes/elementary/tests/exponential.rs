//! Exponential and logarithm.

use super::super::{exp, ln};
use super::{Fused, Random, Unfused, Worst, around, of, points, ulps};
use crate::real::lanes::register::Doubles;
use crate::{DoubleDouble, Real};

fn error_of_exp<R: Doubles>(x: f64) -> f64 {
    ulps(of::<R>(exp, x), Real::exp(DoubleDouble::from_f64(x)))
}

fn error_of_ln<R: Doubles>(x: f64) -> f64 {
    ulps(of::<R>(ln, x), Real::ln(DoubleDouble::from_f64(x)))
}

/// Over arguments for which the result and its tail are normal in the reference, and over small arguments.
fn worst_exp<R: Doubles>() -> Worst {
    let (mut random, mut worst) = (Random::new(1), Worst::default());
    for _ in 0..points() / 2 {
        for reach in [660.0, 1.0] {
            let x = random.even() * reach;
            worst.consider(error_of_exp::<R>(x), [x, reach]);
        }
    }
    worst
}

/// Over all positive numbers, and next to 1, where the logarithm vanishes.
fn worst_ln<R: Doubles>() -> Worst {
    let (mut random, mut worst) = (Random::new(2), Worst::default());
    for i in 0..points() / 2 {
        let x = random.any().abs();
        worst.consider(error_of_ln::<R>(x), [x, 0.0]);
        let x = 1.0 + random.even() * 0.5_f64.powi((i % 50) as i32 + 1);
        worst.consider(error_of_ln::<R>(x), [x, 1.0]);
    }
    for x in around(1.0)
        .chain(around(0.5_f64.sqrt()))
        .chain(around(2.0_f64.sqrt()))
    {
        worst.consider(error_of_ln::<R>(x), [x, 2.0]);
    }
    worst
}

#[test]
fn the_exponential_is_within_one_ulp() {
    worst_exp::<Fused>().is_at_most(1.0);
}

#[test]
fn the_exponential_is_within_one_ulp_without_fused_steps_too() {
    worst_exp::<Unfused>().is_at_most(1.0);
}

#[test]
fn subnormal_exponentials_are_within_one_ulp() {
    let mut random = Random::new(3);
    // 2¹⁰⁰ e^x is normal, where the reference has its digits
    let up = 2.0_f64.powi(100);
    let logarithm = Real::ln(DoubleDouble::from_f64(up));
    for _ in 0..points() / 10 {
        let x = -726.0 + 18.0 * random.even();
        let exact = Real::exp(DoubleDouble::from_f64(x) + logarithm).to_f64();
        let found = of::<Fused>(exp, x) * up;
        let unit = (f64::from_bits(1) * up).max(exact * f64::EPSILON);
        assert!(
            (found - exact).abs() <= unit,
            "{x}: {found:e}, not {exact:e}"
        );
    }
}

#[test]
fn the_exponential_ends_where_doubles_do() {
    // ln of the largest double, and of half of the smallest one, rounded inwards and outwards
    let (most, least) = (709.782_712_893_384, -745.133_219_101_941_1);
    assert!(of::<Fused>(exp, most).is_finite());
    assert_eq!(of::<Fused>(exp, most.next_up()), f64::INFINITY);
    assert_eq!(of::<Fused>(exp, least), f64::from_bits(1));
    assert_eq!(of::<Fused>(exp, least.next_down()), 0.0);
    let known = [
        (0.0, 1.0),
        (-0.0, 1.0),
        (1e-300, 1.0),
        (1e4, f64::INFINITY),
        (f64::INFINITY, f64::INFINITY),
        (-1e300, 0.0),
        (f64::NEG_INFINITY, 0.0),
    ];
    for (x, result) in known {
        assert_eq!(of::<Fused>(exp, x), result, "{x:e}");
    }
    assert!(of::<Fused>(exp, f64::NAN).is_nan());
}

#[test]
fn the_logarithm_is_within_one_ulp() {
    worst_ln::<Fused>().is_at_most(1.0);
}

#[test]
fn the_logarithm_is_within_one_ulp_without_fused_steps_too() {
    worst_ln::<Unfused>().is_at_most(1.0);
}

#[test]
fn the_logarithm_ends_where_doubles_do() {
    let known = [
        (0.0, f64::NEG_INFINITY),
        (-0.0, f64::NEG_INFINITY),
        (1.0, 0.0),
        (f64::INFINITY, f64::INFINITY),
        (f64::from_bits(1), f64::from_bits(1).ln()),
        (f64::MAX, f64::MAX.ln()),
    ];
    for (x, result) in known {
        assert_eq!(of::<Fused>(ln, x), result, "{x:e}");
    }
    for x in [-1.0, -f64::from_bits(1), f64::NEG_INFINITY, f64::NAN] {
        assert!(of::<Fused>(ln, x).is_nan(), "{x:e}");
    }
}
