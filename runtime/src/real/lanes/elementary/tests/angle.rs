//! The angle of a point.

use super::super::atan2;
use super::{Fused, Random, Unfused, Worst, around, points, ulps};
use crate::real::lanes::register::Doubles;
use crate::{DoubleDouble, Real};

fn angle<R: Doubles>(y: f64, x: f64) -> f64 {
    atan2(R::splat(y), R::splat(x)).lane(0)
}

fn error<R: Doubles>(y: f64, x: f64) -> f64 {
    let exact = Real::atan2(DoubleDouble::from_f64(y), DoubleDouble::from_f64(x));
    ulps(angle::<R>(y, x), exact)
}

/// Over points in a square, points whose coordinates differ in size, and points near the rays where the formula
/// changes.
fn worst<R: Doubles>() -> Worst {
    let (mut random, mut worst) = (Random::new(1), Worst::default());
    for i in 0..points() / 2 {
        let (y, x) = (random.even(), random.even());
        worst.consider(error::<R>(y, x), [y, x]);
        let y = y * 0.5_f64.powi(i as i32 % 120);
        worst.consider(error::<R>(y, x), [y, x]);
        worst.consider(error::<R>(x, y), [x, y]);
    }
    for _ in 0..points() / 100 {
        let x = random.even();
        for ratio in [0.5, 1.0, 2.0] {
            for y in around(ratio * x) {
                worst.consider(error::<R>(y, x), [y, x]);
            }
        }
    }
    worst
}

#[test]
fn angles_are_within_one_ulp() {
    worst::<Fused>().is_at_most(1.0);
}

#[test]
fn angles_are_within_two_ulp_without_fused_steps() {
    worst::<Unfused>().is_at_most(2.0);
}

#[test]
fn points_of_all_sizes_have_angles() {
    let mut random = Random::new(2);
    for _ in 0..points() / 10 {
        let (y, x) = (random.any(), random.any());
        let (found, expected) = (angle::<Fused>(y, x), y.atan2(x));
        // the error of the library itself is up to 1 ulp, and a subnormal angle is exact to the last bit
        let bound = (2.0 * f64::EPSILON * expected.abs()).max(2.0 * f64::from_bits(1));
        assert!(
            (found - expected).abs() <= bound,
            "({x:e}, {y:e}): {found:e}, not {expected:e}"
        );
    }
    // a common factor changes nothing, near both ends of the range
    for power in [-1020, -950, -880, 880, 950, 1020] {
        let factor = 2.0_f64.powi(power);
        for (y, x) in [(0.3, 0.7), (0.7, 0.3), (-0.6, 0.65), (0.9, -0.4)] {
            assert_eq!(
                angle::<Fused>(y * factor, x * factor),
                angle::<Fused>(y, x),
                "{power}"
            );
        }
    }
}

#[test]
fn zeros_and_infinities_are_those_of_the_standard() {
    let values = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        5e-324,
        -5e-324,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];
    for y in values {
        for x in values {
            let (found, expected) = (angle::<Fused>(y, x), y.atan2(x));
            let same = match expected.is_nan() {
                true => found.is_nan(),
                false => found.to_bits() == expected.to_bits(),
            };
            assert!(same, "({x:e}, {y:e}): {found:e}, not {expected:e}");
        }
    }
}
