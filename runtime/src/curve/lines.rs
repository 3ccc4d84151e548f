//! Piecewise linear functions. Curves with a fixed number of points and tables of any length both evaluate these.

use super::breakpoint_indicator::rounding;
use super::integral::Integrable;
use super::stop::{Searched, stop};
use super::{Extrapolate, candidates, guard};
use crate::real::Real;

/// The parts of a piecewise linear function, wherever they are stored. Each part has one entry for each point.
#[derive(Clone, Copy)]
pub(super) struct Lines<'a> {
    pub points: &'a [[f64; 2]],
    /// Slope to the right of each point. The last one is the slope of the extrapolation.
    pub slopes: &'a [f64],
    /// Slope to the left of the first point.
    pub slope_before: f64,
    /// ∫ and ∬ from the first point to each point.
    pub integrals: &'a [[f64; 2]],
    /// The abscissae at which the function is not smooth, increasing.
    pub kinks: &'a [f64],
    pub extrapolate: Extrapolate,
}

/// Computes the parts that follow from the points. Returns the slope before the first point and the number of kinks.
///
/// # Panics
/// With fewer than two points, a number that is not finite, or abscissae that do not increase.
pub(super) const fn fill(
    points: &[[f64; 2]],
    extrapolate: Extrapolate,
    slopes: &mut [f64],
    integrals: &mut [[f64; 2]],
    kinks: &mut [f64],
) -> (f64, usize) {
    let count = points.len();
    assert!(count >= 2, "a curve has at least two points");
    let mut k = 0;
    while k < count {
        assert!(
            points[k][0].is_finite() && points[k][1].is_finite(),
            "the points of a curve are finite"
        );
        if k + 1 < count {
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
    slopes[count - 1] = if goes_on { slopes[count - 2] } else { 0.0 };
    let slope_before = if goes_on { slopes[0] } else { 0.0 };
    (slope_before, find_kinks(points, extrapolate, slopes, kinks))
}

/// Finds the points where the slope changes, and the ends of a held curve. Returns their number.
const fn find_kinks(
    points: &[[f64; 2]],
    extrapolate: Extrapolate,
    slopes: &[f64],
    kinks: &mut [f64],
) -> usize {
    let last = points.len() - 1;
    let held = matches!(extrapolate, Extrapolate::Hold);
    let (mut found, mut k) = (0, 0);
    while k <= last {
        let kinked = if k == 0 {
            held && slopes[0] != 0.0
        } else if k == last {
            held && slopes[last - 1] != 0.0
        } else {
            let rounding = rounding(points[k - 1], points[k]) + rounding(points[k], points[k + 1]);
            (slopes[k] - slopes[k - 1]).abs() > rounding
        };
        if kinked {
            kinks[found] = points[k][0];
            found += 1;
        }
        k += 1;
    }
    found
}

impl Lines<'_> {
    /// Ordinate: [`Curve::value`](super::Curve::value).
    #[inline(always)]
    pub fn value<T: Real>(&self, x: T) -> T {
        let (first, last) = self.candidates(x);
        let mut y = self.piece(first, x);
        for k in first..last {
            y = T::select(x.lt(self.abscissa(k)), y, self.piece(k + 1, x));
        }
        self.guard(x, y)
    }

    /// Slope: [`Curve::slope`](super::Curve::slope).
    #[inline(always)]
    pub fn slope<T: Real>(&self, x: T) -> T {
        let (first, last) = self.candidates(x);
        let mut slope = T::from_f64(self.slope_of(first));
        for k in first..last {
            let next = T::from_f64(self.slope_of(k + 1));
            slope = T::select(x.lt(self.abscissa(k)), slope, next);
        }
        if let Extrapolate::Error = self.extrapolate {
            let inside = T::from_f64(self.slopes[self.points.len() - 2]);
            slope = T::select(x.lt(self.abscissa(self.points.len() - 1)), slope, inside);
        }
        self.guard(x, slope + x.taint())
    }

    /// The time of rest: [`Curve::stop`](super::Curve::stop).
    #[inline(always)]
    pub fn stop<T: Real>(&self, velocity: T, factor: T) -> T {
        let searched = Searched {
            points: self.points,
            extrapolate: self.extrapolate,
            coefficients: &|piece| [self.slope_of(piece), 0.0, 0.0],
        };
        stop(
            &searched,
            velocity,
            factor,
            |x| self.value(x),
            |x| self.integral(x),
        )
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

    /// The inverse: [`Curve::inverse`](super::Curve::inverse).
    #[inline(always)]
    pub fn inverse<T: Real>(&self, y: T) -> T {
        let nowhere = T::from_f64(f64::NAN);
        let goes_on = matches!(self.extrapolate, Extrapolate::Linear);

        // from right to left, so that the leftmost solution is kept
        let mut x = nowhere;
        if self.slopes[self.points.len() - 2] > 0.0 {
            let [x_last, y_last] = self.points[self.points.len() - 1];
            let top = T::from_f64(y_last);
            let from_top = if goes_on {
                self.solve(self.points.len() - 1, y)
            } else {
                T::select(top.lt(y), nowhere, T::from_f64(x_last) + y.taint())
            };
            x = T::select(y.lt(top), nowhere, from_top);
        }
        for k in (0..self.points.len() - 1).rev() {
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
        candidates(self.points.len(), |k| self.points[k][0], x)
    }

    /// The value on one piece: piece 0 lies left of the first point, piece k + 1 right of point k.
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

    /// The abscissa at which the line of segment `k` has the ordinate `y`.
    #[inline(always)]
    fn solve<T: Real>(&self, k: usize, y: T) -> T {
        let [x_k, y_k] = self.points[k];
        T::from_f64(x_k) + (y - T::from_f64(y_k)) / T::from_f64(self.slopes[k])
    }

    /// The second derivative: [`Curve::second_derivative`](super::Curve::second_derivative).
    #[inline(always)]
    pub fn second_derivative<T: Real>(&self, x: T) -> T {
        self.guard(x, x.taint())
    }

    /// The value `y`, but NaN outside a curve that must not be left.
    #[inline(always)]
    fn guard<T: Real>(&self, x: T, y: T) -> T {
        guard(self.points, self.extrapolate, x, y)
    }
}

impl Integrable for Lines<'_> {
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
}
