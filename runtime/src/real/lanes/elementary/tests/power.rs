//! Powers.

use super::super::powf;
use super::{Fused, Random, Unfused, Worst, points, ulps};
use crate::real::lanes::register::Doubles;
use crate::{DoubleDouble, Real};

fn power<R: Doubles>(x: f64, y: f64) -> f64 {
    powf(R::splat(x), R::splat(y)).lane(0)
}

fn error<R: Doubles>(x: f64, y: f64) -> f64 {
    let exact = Real::powf(DoubleDouble::from_f64(x), DoubleDouble::from_f64(y));
    ulps(power::<R>(x, y), exact)
}

/// Over bases of all exponents, near 1 and between, with small exponents and exponents that use the whole range of
/// results.
fn worst<R: Doubles>() -> Worst {
    let (mut random, mut worst) = (Random::new(1), Worst::default());
    for i in 0..points() / 4 {
        let bases = [
            random.any().abs(),
            1.0 + random.even() * 0.5_f64.powi(i as i32 % 45 + 1),
            0.7 + random.even().abs() * 0.8,
        ];
        for x in bases {
            // beyond 10²⁵⁰ the reference loses digits
            if x != 1.0 {
                let y = random.even() * 575.0 / x.ln();
                worst.consider(error::<R>(x, y), [x, y]);
            }
        }
        let (x, y) = (random.even().abs() * 10.0, 4.0 * random.even());
        worst.consider(error::<R>(x, y), [x, y]);
    }
    worst
}

#[test]
fn powers_are_within_one_ulp() {
    worst::<Fused>().is_at_most(1.0);
}

#[test]
fn powers_are_within_one_ulp_without_fused_steps_too() {
    worst::<Unfused>().is_at_most(1.0);
}

#[test]
fn whole_powers_of_two_are_exact() {
    for k in -1074..=1023 {
        assert_eq!(
            power::<Fused>(2.0, f64::from(k)),
            (f64::from(k)).exp2(),
            "{k}"
        );
    }
    assert_eq!(power::<Fused>(6.25, 1.5), 15.625);
}

#[test]
fn zeros_infinities_and_signs_are_those_of_the_standard() {
    let inf = f64::INFINITY;
    let bases = [
        0.0,
        -0.0,
        0.5,
        -0.5,
        1.0,
        -1.0,
        2.0,
        -2.0,
        1e300,
        -1e300,
        inf,
        -inf,
        f64::NAN,
        5e-324,
        -5e-324,
    ];
    let powers = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        2.0,
        -2.0,
        3.0,
        0.5,
        -0.5,
        2.5,
        1e9,
        1e300,
        -1e300,
        9_007_199_254_740_991.0,
        inf,
        -inf,
        f64::NAN,
    ];
    for x in bases {
        for y in powers {
            let (found, expected) = (power::<Fused>(x, y), x.powf(y));
            let same = match expected.is_nan() {
                true => found.is_nan(),
                // normal results within the bound, everything else exactly, with its sign
                false => {
                    found.to_bits() == expected.to_bits()
                        || (found / expected - 1.0).abs() <= 4.0 * f64::EPSILON
                }
            };
            assert!(
                same,
                "{x:e} to the power {y:e}: {found:e}, not {expected:e}"
            );
        }
    }
}
