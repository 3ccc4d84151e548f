//! Piecewise linear functions: y(x) = y_k + s_k (x − x_k) for x_k ≤ x < x_{k+1}. Smooth ones are [`Cubic`].
//!
//! "The elastic force is dependent on a tabular function representing any continuous curve" (MADYMO 1980). The segment
//! is chosen by a chain of selects, so lanes in different segments never diverge.
//!
//! Slopes and coefficients are doubles, for every scalar. So a scalar of more digits evaluates the same function as
//! `f64`, only with less rounding on the way. At a point that function may jump by a few ε of its ordinates.

mod breakpoint_indicator;
mod cubic;
mod integral;
mod kink;
mod lines;
mod stop;
#[cfg(feature = "std")]
mod table;

pub use cubic::Cubic;
#[cfg(feature = "std")]
pub use table::Table;

use crate::real::{Mask, Real};
use integral::Integrable as _;
use lines::Lines;

/// The continuation of a curve beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extrapolate {
    /// The outermost segment continues as a straight line.
    Linear,
    /// The outermost value is held.
    Hold,
    /// NaN, which stops the run: the argument must never leave the curve.
    Error,
}

/// A piecewise linear function through `N` points, with its slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve<const N: usize> {
    /// Abscissae and ordinates.
    points: [[f64; 2]; N],
    /// Slope to the right of each point. The last one is the slope of the extrapolation.
    slopes: [f64; N],
    /// Slope to the left of the first point.
    slope_before: f64,
    /// ∫ and ∬ of the curve from the first point to each point.
    integrals: [[f64; 2]; N],
    /// The abscissae at which the curve is not smooth, and how many of the entries are used.
    kinks: ([f64; N], usize),
    extrapolate: Extrapolate,
}

/// Curves with more points are first narrowed by bisection, then by the chain of selects.
const CHAIN: usize = 8;

impl<const N: usize> Curve<N> {
    /// Makes the curve through the points (x, y), x increasing.
    ///
    /// # Panics
    /// With fewer than two points, with a number that is not finite, or with abscissae that do not increase. Generated
    /// code keeps its curves in `const`s, where this is an error of compilation.
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

    /// Ordinate at `x`: exact at the points; NaN where `x` is NaN.
    #[inline(always)]
    pub fn value<T: Real>(&self, x: T) -> T {
        self.lines().value(x)
    }

    /// Slope at `x`. At a point it is the slope of the segment to the right; at the last point of a curve that must not
    /// be left, that of the last segment. NaN where `x` is NaN.
    #[inline(always)]
    pub fn slope<T: Real>(&self, x: T) -> T {
        self.lines().slope(x)
    }

    /// The second derivative: 0 wherever it exists. NaN where `x` is NaN, and outside a curve that must not be left.
    #[inline(always)]
    pub fn second_derivative<T: Real>(&self, x: T) -> T {
        self.lines().second_derivative(x)
    }

    /// ∫₀ˣ of the curve: the velocity gained, where the curve is an acceleration over time.
    #[inline(always)]
    pub fn integral<T: Real>(&self, x: T) -> T {
        self.lines().integral(x)
    }

    /// ∬₀ˣ of the curve: the distance gained, where the curve is an acceleration over time.
    #[inline(always)]
    pub fn double_integral<T: Real>(&self, x: T) -> T {
        self.lines().double_integral(x)
    }

    /// The smallest x on a rising segment with value(x) = `y`; NaN where there is none.
    ///
    /// The generator uses it for the relative elongation at which a belt has its pretension.
    #[inline(always)]
    pub fn inverse<T: Real>(&self, y: T) -> T {
        self.lines().inverse(y)
    }

    /// The first x > 0 at which velocity + factor · ∫₀ˣ of the curve reaches 0, with its derivatives; 0 where it never
    /// does. Where the velocity is 0 at first, the search begins where it no longer is.
    ///
    /// The generator uses it for the time at which a body that is braked by a curve of time comes to rest.
    #[inline(always)]
    pub fn stop<T: Real>(&self, velocity: T, factor: T) -> T {
        self.lines().stop(velocity, factor)
    }

    /// The breakpoint indicator: a function whose sign changes where the curve is not smooth. Its slope is ±1 and its
    /// magnitude is the distance to the nearest such point; it is 1 where there is none. NaN only where `x` is NaN.
    #[inline(always)]
    pub fn breakpoint_indicator<T: Real>(&self, x: T) -> T {
        breakpoint_indicator::breakpoint_indicator(self.lines().kinks, x)
    }

    /// The first time after `t` at which `rate` · time passes a point of the curve, in any lane. All lanes get this
    /// time, each with its own derivatives. +∞ where no point is left.
    pub fn kink_after<T: Real>(&self, rate: T, t: f64) -> T {
        kink::after(&self.points, |point| point[0], rate, t)
    }
}

/// First and last of the pieces between `count` abscissae that a lane of `x` may lie in. For a short curve these are
/// all pieces. For a long curve bisection goes on while all lanes agree, as they do for a curve of time.
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

/// The value `y`, but NaN outside a curve that must not be left.
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
}
