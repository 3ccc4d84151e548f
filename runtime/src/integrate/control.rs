//! Control of the step: h⁺ = h · s · (err₋/err³)^(1/25), the controller PI.4.2 (Söderlind 2003) at order 5.
//!
//! err is the largest ratio of estimated error to tolerance, err₋ that of the step before. The proportional part keeps
//! steps from oscillating where stability and not accuracy bounds them, as in stiff contacts. Only basic arithmetic is
//! used, so a run takes the same steps on every machine as long as the model gives the same derivatives.

use super::{Evaluator, combine};
use crate::{Model, Real, Vector};

/// Error allowed in one step: absolute + relative · |y|, for each entry of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Relative part.
    pub relative: f64,
    /// Absolute part of coordinates \[m\], \[rad\], or components of a quaternion.
    pub coordinates: f64,
    /// Absolute part of velocities \[m/s\], \[rad/s\].
    pub velocities: f64,
}

impl Default for Tolerances {
    /// Relative 10⁻⁶; absolute 10⁻⁸ (10 nm, 0.002 arc seconds) for coordinates and 10⁻⁶ for velocities,
    /// which in impacts are a hundred times as large.
    fn default() -> Self {
        Tolerances {
            relative: 1e-6,
            coordinates: 1e-8,
            velocities: 1e-6,
        }
    }
}

impl Tolerances {
    /// Error allowed in an entry of the given magnitude.
    #[inline(always)]
    pub(crate) fn scale<T: Real>(&self, is_coordinate: bool, magnitude: T) -> T {
        let absolute = if is_coordinate {
            self.coordinates
        } else {
            self.velocities
        };
        T::from_f64(self.relative).mul_add(magnitude, T::from_f64(absolute))
    }
}

/// Aim a little below the tolerance.
const SAFETY: f64 = 0.95;
/// Largest change of the step in one go, either way.
const LIMIT: f64 = 5.0;
/// Errors below are taken as this: they say no more than that the step may grow.
const SMALLEST_ERROR: f64 = 1e-10;

/// The memory of the controller.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Controller {
    previous_error: f64,
    just_rejected: bool,
}

impl Controller {
    /// At the start, and wherever the derivative jumps.
    pub fn new() -> Self {
        Controller {
            previous_error: 1.0,
            just_rejected: false,
        }
    }

    /// Factor on the step after one with `error` ≤ 1 was accepted.
    pub fn accepted(&mut self, error: f64) -> f64 {
        let error = error.max(SMALLEST_ERROR);
        let quotient = self.previous_error / (error * error * error);
        let largest = if self.just_rejected { 1.0 } else { LIMIT };
        *self = Controller {
            previous_error: error,
            just_rejected: false,
        };
        (SAFETY * fifth_root(fifth_root(quotient))).clamp(1.0 / LIMIT, largest)
    }

    /// Factor on the step after one with `error` > 1 was rejected, or one that led nowhere finite (`None`).
    pub fn rejected(&mut self, error: Option<f64>) -> f64 {
        self.just_rejected = true;
        match error {
            Some(error) => (SAFETY / fifth_root(error)).clamp(1.0 / LIMIT, 0.9),
            None => 1.0 / LIMIT,
        }
    }
}

/// A first step from (`t`, `y`) where the derivative is `k1`, by comparison of y, ẏ and ÿ (Hairer, Nørsett & Wanner,
/// *Solving ODEs I*, II.4); one evaluation. Positive and at most `largest`.
#[inline(always)]
pub(crate) fn first_step<T: Real, M: Model<T>>(
    f: &mut Evaluator<'_, M>,
    t: f64,
    y: &M::State,
    k1: &M::State,
    tolerances: &Tolerances,
    largest: f64,
) -> f64 {
    let norm = |v: &M::State| -> f64 {
        let mut worst = T::from_f64(0.0);
        for i in 0..M::State::LEN {
            let scale = tolerances.scale(i < M::INFO.coordinates.len(), y[i].abs());
            worst = worst.max(v[i].abs() / scale);
        }
        worst.to_f64()
    };
    let (d0, d1) = (norm(y), norm(k1));
    let guess = if d0 < 1e-5 || d1 < 1e-5 {
        1e-6
    } else {
        0.01 * d0 / d1
    };
    let guess = guess.min(largest);

    // an Euler step shows the second derivative
    let k2 = f.at(t + guess, &combine(y, guess, [1.0], [k1]));
    let mut change = k2;
    for i in 0..M::State::LEN {
        change[i] = k2[i] - k1[i];
    }
    let steepest = d1.max(norm(&change) / guess);
    let by_curvature = if steepest <= 1e-15 {
        (1e-3 * guess).max(1e-6)
    } else {
        fifth_root(0.01 / steepest)
    };
    let h = (100.0 * guess).min(by_curvature).min(largest);
    // numbers near the ends of the range: begin small, the controller will find its way
    if h > 0.0 { h } else { largest.min(1e-6) }
}

/// x^(1/5) of a positive finite number to a few rounding errors, by basic arithmetic alone; 0 of what is not positive.
pub(crate) fn fifth_root(x: f64) -> f64 {
    if x.is_nan() || x < f64::MIN_POSITIVE {
        return 0.0;
    }
    if x == f64::INFINITY {
        return x;
    }
    // a fifth of the exponent, then Newton's iteration for y⁵ = x
    let mut y = f64::from_bits(x.to_bits() / 5 + ONE_BITS / 5 * 4);
    for _ in 0..6 {
        let y2 = y * y;
        y -= 0.2 * (y - x / (y2 * y2));
    }
    y
}

const ONE_BITS: u64 = 1.0_f64.to_bits();

#[cfg(test)]
mod tests {
    use super::{Controller, fifth_root};

    #[test]
    fn fifth_root_to_the_fifth_is_the_number() {
        for exponent in -300..300 {
            let x = 10.0_f64.powi(exponent) * 1.7;
            let y = fifth_root(x);
            assert!((y.powi(5) / x - 1.0).abs() < 16.0 * f64::EPSILON, "{x}");
        }
        assert_eq!(fifth_root(32.0), 2.0);
        assert_eq!(fifth_root(0.0), 0.0);
        assert_eq!(fifth_root(f64::INFINITY), f64::INFINITY);
    }

    #[test]
    fn steps_settle_where_the_error_is_a_little_below_tolerance() {
        // a problem whose error is (h/0.01)⁵ tolerances
        let mut controller = Controller::new();
        let mut h = 1e-3;
        for _ in 0..100 {
            h *= controller.accepted((h / 0.01_f64).powi(5));
        }
        // at rest s · err^(−2/25) = 1: err = 0.95^12.5
        let error = (h / 0.01_f64).powi(5);
        assert!((error / 0.95_f64.powf(12.5) - 1.0).abs() < 1e-3, "{error}");
    }

    #[test]
    fn a_rejected_step_shrinks_and_the_next_does_not_grow() {
        let mut controller = Controller::new();
        assert!(controller.rejected(Some(1.0001)) <= 0.9);
        assert_eq!(controller.rejected(None), 0.2);
        assert_eq!(controller.accepted(0.0), 1.0);
        assert_eq!(controller.accepted(0.0), 5.0);
    }
}
