//! Piecewise linear functions: y(x) = y_k + s_k (x − x_k) for x_k ≤ x < x_{k+1}. Smooth ones are [`Cubic`].
//!
//! "The elastic force is dependent on a tabular function representing any continuous curve" (MADYMO 1980). A choice
//! of segment is a chain of selects, so lanes in different segments never diverge.
//!
//! Slopes and coefficients are doubles whatever the scalar: one of more digits evaluates the very function that `f64` does, with
//! less rounding on the way. That function may jump by some ε of its ordinates at a point.

mod cubic;
mod kink;
mod lines;
mod stop;
#[cfg(feature = "std")]
mod table;
mod zigzag;

pub use cubic::Cubic;
#[cfg(feature = "std")]
pub use table::Table;

use crate::real::{Mask, Real};
use lines::Lines;

/// What a curve is beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extrapolate {
    /// The outermost segment goes on.
    Linear,
    /// The outermost value stays.
    Hold,
    /// NaN, which stops the run: the curve was never meant to be left.
    Error,
}

/// A piecewise linear function through `N` points, with its slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve<const N: usize> {
    /// Abscissae and ordinates.
    points: [[f64; 2]; N],
    /// Slope to the right of each point; the last one is that of the extrapolation.
    slopes: [f64; N],
    /// Slope to the left of the first point.
    slope_before: f64,
    /// At each point, ∫ and ∬ of the curve from the first one.
    integrals: [[f64; 2]; N],
    /// The abscissae at which the curve is not smooth: the first so many.
    kinks: ([f64; N], usize),
    extrapolate: Extrapolate,
}

/// Curves of more points are narrowed by bisection before the chain of selects.
const CHAIN: usize = 8;

impl<const N: usize> Curve<N> {
    /// The curve through points (x, y) of increasing x.
    ///
    /// # Panics
    /// With fewer than two points, a number that is not finite, or abscissae that do not increase. In a `const`, where
    /// generated code keeps its curves, that is an error of compilation.
    pub const fn new(points: [[f64; 2]; N], extrapolate: Extrapolate) -> Self {
        let (mut slopes, mut kinks) = ([0.0; N], [0.0; N]);
        let mut integrals = [[0.0; 2]; N];
        let (slope_before, count) = lines::fill(
            &points,
            extrapolate,
            &mut slopes,
            &mut integrals,
            &mut kinks,
        );
        Curve {
            points,
            slopes,
            slope_before,
            integrals,
            kinks: (kinks, count),
            extrapolate,
        }
    }

    #[inline(always)]
    fn lines(&self) -> Lines<'_> {
        Lines {
            points: &self.points,
            slopes: &self.slopes,
            slope_before: self.slope_before,
            integrals: &self.integrals,
            kinks: &self.kinks.0[..self.kinks.1],
            extrapolate: self.extrapolate,
        }
    }

    /// Ordinate at `x`: exact at the points, NaN for NaN.
    #[inline(always)]
    pub fn value<T: Real>(&self, x: T) -> T {
        self.lines().value(x)
    }

    /// Slope at `x`: at a point that of the segment to the right, at the last point of a curve that must not be left
    /// that of the last segment; NaN for NaN.
    #[inline(always)]
    pub fn slope<T: Real>(&self, x: T) -> T {
        self.lines().slope(x)
    }

    /// The second derivative, 0 wherever it exists; NaN for NaN and outside a curve that must not be left.
    #[inline(always)]
    pub fn second_derivative<T: Real>(&self, x: T) -> T {
        self.lines().second_derivative(x)
    }

    /// ∫ of the curve from 0 to `x`: the velocity gained under an acceleration that is this curve of time.
    #[inline(always)]
    pub fn integral<T: Real>(&self, x: T) -> T {
        self.lines().integral(x)
    }

    /// ∬ of the curve from 0 to `x`: the way gained under an acceleration that is this curve of time.
    #[inline(always)]
    pub fn double_integral<T: Real>(&self, x: T) -> T {
        self.lines().double_integral(x)
    }

    /// The smallest x on a rising segment with value(x) = `y`, NaN where there is none.
    ///
    /// Gives the relative elongation at which a belt has its pretension.
    #[inline(always)]
    pub fn inverse<T: Real>(&self, y: T) -> T {
        self.lines().inverse(y)
    }

    /// The first x > 0 at which velocity + factor · ∫₀ˣ of the curve reaches 0, with its derivatives; 0 where it never does. A velocity of 0
    /// counts from where it is not 0.
    ///
    /// Gives the time at which what a curve of time brakes comes to rest.
    #[inline(always)]
    pub fn stop<T: Real>(&self, velocity: T, factor: T) -> T {
        self.lines().stop(velocity, factor)
    }

    /// A function whose sign changes where the curve is not smooth: of slope ±1, its magnitude the distance to the nearest
    /// such point, and 1 where there is none. NaN for NaN alone.
    #[inline(always)]
    pub fn zigzag<T: Real>(&self, x: T) -> T {
        zigzag::zigzag(self.lines().kinks, x)
    }

    /// The first time after `t` at which `rate` · time passes a point of the curve, in any lane, for all of them, with its derivatives;
    /// +∞ where none is left.
    pub fn kink_after<T: Real>(&self, rate: T, t: f64) -> T {
        kink::after(&self.points, |point| point[0], rate, t)
    }
}

/// First and last piece between so many abscissae that a lane of `x` may lie in: all of them for a short curve; for a long one bisection goes
/// on while the lanes agree, as they do for a curve of time.
#[inline(always)]
fn candidates<T: Real>(count: usize, abscissa: impl Fn(usize) -> f64, x: T) -> (usize, usize) {
    let (mut first, mut last) = (0, count);
    while last - first > CHAIN {
        let middle = (first + last) / 2;
        let left = x.lt(T::from_f64(abscissa(middle)));
        if left.all() {
            last = middle;
        } else if !left.any() {
            first = middle + 1;
        } else {
            break;
        }
    }
    (first, last)
}

/// NaN outside a curve that must not be left.
#[inline(always)]
fn guard<T: Real>(points: &[[f64; 2]], extrapolate: Extrapolate, x: T, y: T) -> T {
    if let Extrapolate::Error = extrapolate {
        let outside = T::from_f64(f64::NAN);
        let y = T::select(x.lt(T::from_f64(points[0][0])), outside, y);
        T::select(T::from_f64(points[points.len() - 1][0]).lt(x), outside, y)
    } else {
        y
    }
}

#[cfg(test)]
mod tests {
    use super::{Curve, Extrapolate};
    use crate::test_scalars::Pair;
    use crate::{DoubleDouble, Dual, Real};

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
            // lanes that disagree take the long way to the same value
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
        // the falling segment does not count, the flat one neither
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
}
