//! Piecewise linear functions: y(x) = y_k + s_k (x − x_k) for x_k ≤ x < x_{k+1}. Smooth ones are [`Cubic`].
//!
//! "The elastic force is dependent on a tabular function representing any continuous curve" (MADYMO 1980). A choice
//! of segment is a chain of selects, so lanes in different segments never diverge.
//!
//! Slopes and coefficients are doubles whatever the scalar: one of more digits evaluates the very function that `f64` does, with
//! less rounding on the way. That function may jump by some ε of its ordinates at a point.

mod cubic;
mod kink;
mod zigzag;

pub use cubic::Cubic;

use crate::real::{Mask, Real};
use zigzag::{Kinks, rounding};

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
    kinks: Kinks<N>,
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
        assert!(N >= 2, "a curve has at least two points");
        let mut slopes = [0.0; N];
        let mut integrals = [[0.0; 2]; N];
        let mut k = 0;
        while k < N {
            assert!(
                points[k][0].is_finite() && points[k][1].is_finite(),
                "the points of a curve are finite"
            );
            if k + 1 < N {
                let run = points[k + 1][0] - points[k][0];
                assert!(run > 0.0, "the abscissae of a curve increase");
                let [y, next] = [points[k][1], points[k + 1][1]];
                slopes[k] = (next - y) / run;
                let [once, twice] = integrals[k];
                integrals[k + 1] = [
                    once + run * (y + next) / 2.0,
                    twice + run * (once + run * (2.0 * y + next) / 6.0),
                ];
            }
            k += 1;
        }
        let goes_on = matches!(extrapolate, Extrapolate::Linear);
        slopes[N - 1] = if goes_on { slopes[N - 2] } else { 0.0 };
        let slope_before = if goes_on { slopes[0] } else { 0.0 };
        let held = matches!(extrapolate, Extrapolate::Hold);
        let mut kinks = Kinks::none();
        let mut k = 0;
        while k < N {
            let kinked = if k == 0 {
                held && slopes[0] != 0.0
            } else if k == N - 1 {
                held && slopes[N - 2] != 0.0
            } else {
                let rounding =
                    rounding(points[k - 1], points[k]) + rounding(points[k], points[k + 1]);
                (slopes[k] - slopes[k - 1]).abs() > rounding
            };
            if kinked {
                kinks = kinks.with(points[k][0]);
            }
            k += 1;
        }
        Curve {
            points,
            slopes,
            slope_before,
            integrals,
            kinks,
            extrapolate,
        }
    }

    /// Ordinate at `x`: exact at the points, NaN for NaN.
    #[inline(always)]
    pub fn value<T: Real>(&self, x: T) -> T {
        let (first, last) = self.candidates(x);
        let mut y = self.piece(first, x);
        for k in first..last {
            y = T::select(x.lt(self.abscissa(k)), y, self.piece(k + 1, x));
        }
        self.guard(x, y)
    }

    /// Slope at `x`: at a point that of the segment to the right, at the last point of a curve that must not be left
    /// that of the last segment; NaN for NaN.
    #[inline(always)]
    pub fn slope<T: Real>(&self, x: T) -> T {
        let (first, last) = self.candidates(x);
        let mut slope = T::from_f64(self.slope_of(first));
        for k in first..last {
            let next = T::from_f64(self.slope_of(k + 1));
            slope = T::select(x.lt(self.abscissa(k)), slope, next);
        }
        if let Extrapolate::Error = self.extrapolate {
            let inside = T::from_f64(self.slopes[N - 2]);
            slope = T::select(x.lt(self.abscissa(N - 1)), slope, inside);
        }
        self.guard(x, slope + x.taint())
    }

    /// ∫ of the curve from 0 to `x`: the velocity gained under an acceleration that is this curve of time.
    #[inline(always)]
    pub fn integral<T: Real>(&self, x: T) -> T {
        let [from, _] = self.antiderivatives(T::from_f64(0.0));
        let [to, _] = self.antiderivatives(x);
        to - from
    }

    /// ∬ of the curve from 0 to `x`: the way gained under an acceleration that is this curve of time.
    #[inline(always)]
    pub fn double_integral<T: Real>(&self, x: T) -> T {
        let [slope, from] = self.antiderivatives(T::from_f64(0.0));
        let [_, to] = self.antiderivatives(x);
        to - from - slope * x
    }

    /// F with F' = the curve and G with G' = F, both 0 at the first point.
    #[inline(always)]
    fn antiderivatives<T: Real>(&self, x: T) -> [T; 2] {
        let (first, last) = self.candidates(x);
        let mut both = self.piece_antiderivatives(first, x);
        for k in first..last {
            let left = x.lt(self.abscissa(k));
            let next = self.piece_antiderivatives(k + 1, x);
            both = [
                T::select(left, both[0], next[0]),
                T::select(left, both[1], next[1]),
            ];
        }
        [self.guard(x, both[0]), self.guard(x, both[1])]
    }

    #[inline(always)]
    fn piece_antiderivatives<T: Real>(&self, piece: usize, x: T) -> [T; 2] {
        let k = piece.saturating_sub(1);
        let ([x_k, y_k], [once, twice], slope) =
            (self.points[k], self.integrals[k], self.slope_of(piece));
        let c = T::from_f64;
        let d = x - c(x_k);
        [
            c(slope / 2.0).mul_add(d, c(y_k)).mul_add(d, c(once)),
            c(slope / 6.0)
                .mul_add(d, c(y_k / 2.0))
                .mul_add(d, c(once))
                .mul_add(d, c(twice)),
        ]
    }

    /// The smallest x on a rising segment with value(x) = `y`, NaN where there is none.
    ///
    /// Gives the relative elongation at which a belt has its pretension.
    #[inline(always)]
    pub fn inverse<T: Real>(&self, y: T) -> T {
        let nowhere = T::from_f64(f64::NAN);
        let goes_on = matches!(self.extrapolate, Extrapolate::Linear);

        // from the right, so that the leftmost solution is the one that stays
        let mut x = nowhere;
        if self.slopes[N - 2] > 0.0 {
            let [x_last, y_last] = self.points[N - 1];
            let top = T::from_f64(y_last);
            let from_top = if goes_on {
                self.solve(N - 1, y)
            } else {
                T::select(top.lt(y), nowhere, T::from_f64(x_last) + y.taint())
            };
            x = T::select(y.lt(top), nowhere, from_top);
        }
        for k in (0..N - 1).rev() {
            if self.slopes[k] > 0.0 {
                let below_next = y.lt(T::from_f64(self.points[k + 1][1]));
                let inside = T::select(below_next, self.solve(k, y), x);
                let below = if k == 0 && goes_on {
                    self.solve(0, y)
                } else {
                    x
                };
                x = T::select(y.lt(T::from_f64(self.points[k][1])), below, inside);
            }
        }
        x
    }

    #[inline(always)]
    fn candidates<T: Real>(&self, x: T) -> (usize, usize) {
        candidates(N, |k| self.points[k][0], x)
    }

    /// Piece 0 lies left of the first point, piece k + 1 right of point k.
    #[inline(always)]
    fn piece<T: Real>(&self, piece: usize, x: T) -> T {
        let [x_k, y_k] = self.points[piece.saturating_sub(1)];
        T::from_f64(self.slope_of(piece)).mul_add(x - T::from_f64(x_k), T::from_f64(y_k))
    }

    #[inline(always)]
    fn slope_of(&self, piece: usize) -> f64 {
        if piece == 0 {
            self.slope_before
        } else {
            self.slopes[piece - 1]
        }
    }

    #[inline(always)]
    fn abscissa<T: Real>(&self, k: usize) -> T {
        T::from_f64(self.points[k][0])
    }

    /// Where the line of segment `k` has the ordinate `y`.
    #[inline(always)]
    fn solve<T: Real>(&self, k: usize, y: T) -> T {
        let [x_k, y_k] = self.points[k];
        T::from_f64(x_k) + (y - T::from_f64(y_k)) / T::from_f64(self.slopes[k])
    }

    /// The second derivative, 0 wherever it exists; NaN for NaN and outside a curve that must not be left.
    #[inline(always)]
    pub fn second_derivative<T: Real>(&self, x: T) -> T {
        self.guard(x, x.taint())
    }

    /// A function whose sign changes where the curve is not smooth: of slope ±1, its magnitude the distance to the nearest
    /// such point, and 1 where there is none. NaN for NaN alone.
    #[inline(always)]
    pub fn zigzag<T: Real>(&self, x: T) -> T {
        self.kinks.zigzag(x)
    }

    /// The first time after `t` at which `rate` · time passes a point of the curve, in any lane, for all of them, with its derivatives;
    /// +∞ where none is left.
    pub fn kink_after<T: Real>(&self, rate: T, t: f64) -> T {
        kink::after(&self.points, |point| point[0], rate, t)
    }

    /// NaN outside a curve that must not be left.
    #[inline(always)]
    fn guard<T: Real>(&self, x: T, y: T) -> T {
        guard(&self.points, self.extrapolate, x, y)
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
fn guard<T: Real, const N: usize>(
    points: &[[f64; 2]; N],
    extrapolate: Extrapolate,
    x: T,
    y: T,
) -> T {
    if let Extrapolate::Error = extrapolate {
        let outside = T::from_f64(f64::NAN);
        let y = T::select(x.lt(T::from_f64(points[0][0])), outside, y);
        T::select(T::from_f64(points[N - 1][0]).lt(x), outside, y)
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
