//! Sine and cosine.

use super::super::sin_cos;
use super::{Fused, Random, Unfused, Worst, around, of, points, ulps};
use crate::real::lanes::register::{Doubles, Register};
use crate::{DoubleDouble, Real};

/// The larger of the errors of both functions.
fn error<R: Doubles>(x: f64) -> f64 {
    let (sine, cosine) = Real::sin_cos(DoubleDouble::from_f64(x));
    let found = sin_cos(R::splat(x));
    ulps(found.0.lane(0), sine).max(ulps(found.1.lane(0), cosine))
}

/// The largest error over random angles, uniform up to `reach`.
fn worst<R: Doubles>(reach: f64, seed: u64) -> Worst {
    let mut random = Random::new(seed);
    let mut worst = Worst::default();
    for _ in 0..points() {
        let x = random.even() * reach;
        worst.consider(error::<R>(x), [x, reach]);
    }
    worst
}

/// The largest error next to multiples of an eighth of a turn, with some multiples of each power of two.
fn worst_at_multiples<R: Doubles>() -> Worst {
    let mut worst = Worst::default();
    let mut random = Random::new(5);
    for power in 0..45 {
        for _ in 0..points() / 500 {
            let count = (random.even().abs() * (1_u64 << power) as f64).ceil();
            let multiple = DoubleDouble::from_f64(count)
                * Real::atan2(DoubleDouble::from_f64(1.0), DoubleDouble::from_f64(1.0));
            for x in around(multiple.to_f64()) {
                worst.consider(error::<R>(x), [x, count]);
            }
        }
    }
    worst
}

#[test]
fn sine_and_cosine_are_within_one_ulp() {
    // angles of machines and bodies, angles of the short reduction, and angles beyond it
    for (seed, reach) in [0.8, 7.0, 100.0, 65_536.0, 1e15].into_iter().enumerate() {
        worst::<Fused>(reach, seed as u64).is_at_most(1.0);
    }
    worst_at_multiples::<Fused>().is_at_most(1.0);
}

#[test]
fn small_angles_of_all_sizes_are_within_one_ulp() {
    let mut random = Random::new(7);
    let mut worst = Worst::default();
    for _ in 0..points() {
        // the reference needs room for the square of its last digits
        let x = random.any();
        if (1e-140..1e14).contains(&x.abs()) {
            worst.consider(error::<Fused>(x), [x, 0.0]);
        } else if x.abs() < 1e-140 {
            assert_eq!(sin_cos(Fused::splat(x)).0.lane(0), x);
            assert_eq!(sin_cos(Fused::splat(x)).1.lane(0), 1.0);
        }
    }
    worst.is_at_most(1.0);
}

#[test]
fn without_fused_steps_they_are_within_one_ulp_too() {
    for (seed, reach) in [0.8, 7.0, 100.0, 65_536.0, 1e15].into_iter().enumerate() {
        worst::<Unfused>(reach, seed as u64).is_at_most(1.0);
    }
    worst_at_multiples::<Unfused>().is_at_most(1.0);
}

#[test]
fn the_hardest_angles_are_right() {
    // sine and cosine in 60 digits by mpmath 1.3; the first is the double nearest to a multiple of π/2 (Muller 2016,
    // table 11.1)
    let known = [
        (5.319_372_648_326_541e+255, 1.0, -4.687_165_924_254_628e-19),
        (
            1.797_693_134_862_315_7e+308,
            0.004_961_954_789_184_062,
            -0.999_987_689_426_559_9,
        ),
        (1e+22, -0.852_200_849_767_188_8, 0.523_214_785_395_139),
        (
            1.071_508_607_186_267_4e+301,
            -0.159_201_703_086_242_43,
            0.987_246_077_598_913_5,
        ),
        (65536.0, 0.692_065_453_822_723_2, -0.721_834_750_912_664_2),
        (
            65_535.999_999_999_99,
            0.692_065_453_827_975_2,
            -0.721_834_750_907_628_8,
        ),
        (-1e+300, 0.817_881_912_115_908_5, -0.575_386_111_957_549_1),
        (core::f64::consts::PI, 1.224_646_799_147_353_2e-16, -1.0),
    ];
    for (x, sine, cosine) in known {
        let found = sin_cos(Fused::splat(x));
        let exact = DoubleDouble::from_f64;
        // the given numbers are rounded themselves
        assert!(ulps(found.0.lane(0), exact(sine)) <= 1.0, "sin {x:e}");
        assert!(ulps(found.1.lane(0), exact(cosine)) <= 1.0, "cos {x:e}");
    }
}

#[test]
fn sine_is_odd_and_cosine_even() {
    let mut random = Random::new(9);
    for _ in 0..points() / 10 {
        let x = random.any();
        let (there, opposite) = (sin_cos(Fused::splat(x)), sin_cos(Fused::splat(-x)));
        assert_eq!(there.0.lane(0), -opposite.0.lane(0), "sin {x:e}");
        assert_eq!(there.1.lane(0), opposite.1.lane(0), "cos {x:e}");
    }
}

#[test]
fn the_sine_of_zero_keeps_its_sign() {
    for zero in [0.0, -0.0_f64] {
        assert_eq!(
            of::<Fused>(|x| sin_cos(x).0, zero).to_bits(),
            zero.to_bits()
        );
        assert_eq!(
            of::<Unfused>(|x| sin_cos(x).0, zero).to_bits(),
            zero.to_bits()
        );
        assert_eq!(of::<Fused>(|x| sin_cos(x).1, zero), 1.0);
    }
}

#[test]
fn what_is_no_angle_has_no_sine() {
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (sine, cosine) = sin_cos(Fused::splat(x));
        assert!(sine.lane(0).is_nan() && cosine.lane(0).is_nan(), "{x}");
    }
}
