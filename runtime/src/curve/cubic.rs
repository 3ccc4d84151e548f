//! Smooth functions through points. Each piece is a cubic with given slopes m at both ends (Hermite):
//!
//! y(x) = y_k + m_k s + c₂ s² + c₃ s³,   s = x − x_k,   h c₂ = 3Δ − 2 m_k − m_{k+1},   h² c₃ = m_k + m_{k+1} − 2Δ
//!
//! where h is the length and Δ the secant of the piece. The slopes are given with the points. The caller chooses them
//! such that the curve is monotone where the points are (Fritsch and Carlson 1980).

use super::breakpoint_indicator::{breakpoint_indicator, rounding};
use super::integral::Integrable;
use super::stop::{Searched, stop};
use super::{Extrapolate, candidates, guard, kink};
use crate::real::Real;
use crate::real::mapped;

/// A piecewise cubic function through `N` points, continuous together with its slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic<const N: usize> {
    /// Abscissae and ordinates.
    points: [[f64; 2]; N],
    /// m, c₂, c₃ of the piece to the right of each point. The last entry is that of the extrapolation.
    coefficients: [[f64; 3]; N],
    /// Slope to the left of the first point.
    slope_before: f64,
    /// ∫ and ∬ of the curve from the first point to each point.
    integrals: [[f64; 2]; N],
    /// The abscissae at which the curve is not smooth, and how many of the entries are used.
    kinks: ([f64; N], usize),
    extrapolate: Extrapolate,
}

/// Number of halvings that find a root to the last digit of a piece.
const HALVINGS: usize = 54;

impl<const N: usize> Cubic<N> {
    /// Makes the curve through points (x, y), x increasing, with the slope m at each: `[x, y, m]`.
    ///
    /// # Panics
    /// With fewer than two points, with a number that is not finite, or with abscissae that do not increase. Generated
    /// code keeps its curves in `const`s, where this is an error of compilation.
    pub const fn new(given: [[f64; 3]; N], extrapolate: Extrapolate) -> Self {
        let (mut points, mut integrals) = ([[0.0; 2]; N], [[0.0; 2]; N]);
        let (mut coefficients, mut kinks) = ([[0.0; 3]; N], [0.0; N]);
        let (slope_before, count) = fill(
            &given,
            extrapolate,
            &mut points,
            &mut coefficients,
            &mut integrals,
            &mut kinks,
        );
        Cubic {
            points,
            coefficients,
            slope_before,
            integrals,
            kinks: (kinks, count),
            extrapolate,
        }
    }

    #[inline(always)]
    fn cubics(&self) -> Cubics<'_> {
        Cubics {
            points: &self.points,
            coefficients: &self.coefficients,
            slope_before: self.slope_before,
            integrals: &self.integrals,
            kinks: &self.kinks.0[..self.kinks.1],
            extrapolate: self.extrapolate,
        }
    }

    /// Ordinate at `x`: exact at the points; NaN where `x` is NaN.
    #[inline(always)]
    pub fn value<T: Real>(&self, x: T) -> T {
        self.cubics().value(x)
    }

    /// Slope at `x`; NaN where `x` is NaN.
    #[inline(always)]
    pub fn slope<T: Real>(&self, x: T) -> T {
        self.cubics().slope(x)
    }

    /// Second derivative at `x`. At a point it is that of the piece to the right; at the last point of a curve that
    /// must not be left, that of the last piece. NaN where `x` is NaN.
    #[inline(always)]
    pub fn second_derivative<T: Real>(&self, x: T) -> T {
        self.cubics().second_derivative(x)
    }

    /// ∫ of the curve from 0 to `x`.
    #[inline(always)]
    pub fn integral<T: Real>(&self, x: T) -> T {
        self.cubics().integral(x)
    }

    /// ∬ of the curve from 0 to `x`.
    #[inline(always)]
    pub fn double_integral<T: Real>(&self, x: T) -> T {
        self.cubics().double_integral(x)
    }

    /// The smallest x on a rising piece with value(x) = `y`; NaN where there is none. The curve must be monotone
    /// between its points. Bisection finds all digits of a double, then two Newton steps find those of other scalars
    /// and the derivatives.
    #[inline(always)]
    pub fn inverse<T: Real>(&self, y: T) -> T {
        self.cubics().inverse(y)
    }

    /// The first x > 0 at which velocity + factor · ∫₀ˣ of the curve reaches 0, with its derivatives; 0 where it never
    /// does. Where the velocity is 0 at first, the search begins where it no longer is. The curve must be monotone
    /// between its points.
    #[inline(always)]
    pub fn stop<T: Real>(&self, velocity: T, factor: T) -> T {
        self.cubics().stop(velocity, factor)
    }

    /// The breakpoint indicator: a function whose sign changes where the curve is not smooth. Its slope is ±1 and its
    /// magnitude is the distance to the nearest such point; it is 1 where there is none. NaN only where `x` is NaN.
    #[inline(always)]
    pub fn breakpoint_indicator<T: Real>(&self, x: T) -> T {
        breakpoint_indicator(self.cubics().kinks, x)
    }

    /// The first time after `t` at which `rate` · time passes a point of the curve, in any lane. All lanes get this
    /// time, each with its own derivatives. +∞ where no point is left.
    pub fn kink_after<T: Real>(&self, rate: T, t: f64) -> T {
        kink::after(&self.points, |point| point[0], rate, t)
    }
}

/// The parts of a piecewise cubic function, wherever they are stored. Each part has one entry for each point.
#[derive(Clone, Copy)]
pub(super) struct Cubics<'a> {
    pub points: &'a [[f64; 2]],
    /// m, c₂, c₃ of the piece to the right of each point. The last entry is that of the extrapolation.
    pub coefficients: &'a [[f64; 3]],
    /// Slope to the left of the first point.
    pub slope_before: f64,
    /// ∫ and ∬ from the first point to each point.
    pub integrals: &'a [[f64; 2]],
    /// The abscissae at which the function is not smooth, increasing.
    pub kinks: &'a [f64],
    pub extrapolate: Extrapolate,
}

/// Computes the parts that follow from points and slopes, `[x, y, m]`. Returns the slope before the first point and the
/// number of kinks.
///
/// # Panics
/// With fewer than two points, a number that is not finite, or abscissae that do not increase.
pub(super) const fn fill(
    given: &[[f64; 3]],
    extrapolate: Extrapolate,
    points: &mut [[f64; 2]],
    coefficients: &mut [[f64; 3]],
    integrals: &mut [[f64; 2]],
    kinks: &mut [f64],
) -> (f64, usize) {
    let count = given.len();
    assert!(count >= 2, "a curve has at least two points");
    let mut k = 0;
    while k < count {
        let [x, y, m] = given[k];
        assert!(
            x.is_finite() && y.is_finite() && m.is_finite(),
            "the points of a curve are finite"
        );
        points[k] = [x, y];
        if k + 1 < count {
            let [next_x, next_y, next_m] = given[k + 1];
            let h = next_x - x;
            assert!(h > 0.0, "the abscissae of a curve increase");
            let secant = (next_y - y) / h;
            let c2 = (3.0 * secant - 2.0 * m - next_m) / h;
            let c3 = (m + next_m - 2.0 * secant) / (h * h);
            coefficients[k] = [m, c2, c3];
            let [once, twice] = integrals[k];
            integrals[k + 1] = [
                once + h * (y + h * (m / 2.0 + h * (c2 / 3.0 + h * c3 / 4.0))),
                twice
                    + h * (once + h * (y / 2.0 + h * (m / 6.0 + h * (c2 / 12.0 + h * c3 / 20.0)))),
            ];
        }
        k += 1;
    }
    let [x, _, m] = given[count - 2];
    let [_, c2, c3] = coefficients[count - 2];
    coefficients[count - 1] = match extrapolate {
        Extrapolate::Linear => [given[count - 1][2], 0.0, 0.0],
        Extrapolate::Hold => [0.0; 3],
        // the last point still belongs to the curve: it keeps slope and second derivative of the last piece
        Extrapolate::Error => {
            let h = given[count - 1][0] - x;
            let end = m + h * (2.0 * c2 + 3.0 * h * c3);
            [end, c2 + 3.0 * h * c3, 0.0]
        }
    };
    let slope_before = match extrapolate {
        Extrapolate::Linear => given[0][2],
        Extrapolate::Hold | Extrapolate::Error => 0.0,
    };
    (
        slope_before,
        find_kinks(given, points, coefficients, extrapolate, kinks),
    )
}

impl Cubics<'_> {
    /// Ordinate: [`Cubic::value`].
    #[inline(always)]
    pub fn value<T: Real>(&self, x: T) -> T {
        self.choose(x, |piece| {
            let (s, y, [m, c2, c3]) = self.piece(piece, x);
            c::<T>(c3)
                .mul_add(s, c(c2))
                .mul_add(s, c(m))
                .mul_add(s, c(y))
        })
    }

    /// Slope: [`Cubic::slope`].
    #[inline(always)]
    pub fn slope<T: Real>(&self, x: T) -> T {
        self.choose(x, |piece| {
            let (s, _, [m, c2, c3]) = self.piece(piece, x);
            c::<T>(3.0 * c3).mul_add(s, c(2.0 * c2)).mul_add(s, c(m))
        })
    }

    /// Second derivative: [`Cubic::second_derivative`].
    #[inline(always)]
    pub fn second_derivative<T: Real>(&self, x: T) -> T {
        self.choose(x, |piece| {
            let (s, _, [_, c2, c3]) = self.piece(piece, x);
            c::<T>(6.0 * c3).mul_add(s, c(2.0 * c2))
        })
    }

    /// The inverse: [`Cubic::inverse`].
    #[inline(always)]
    pub fn inverse<T: Real>(&self, y: T) -> T {
        let goes_on = matches!(self.extrapolate, Extrapolate::Linear);
        let beyond = |k: usize, slope: f64| {
            let [x_k, y_k] = self.points[k];
            c::<T>(x_k) + (y - c(y_k)) / c(slope)
        };
        let nowhere = T::from_f64(f64::NAN);
        let mut x = nowhere;
        let after = self.coefficients[self.points.len() - 1][0];
        if goes_on && after > 0.0 {
            x = T::select(
                c::<T>(self.points[self.points.len() - 1][1]).lt(y),
                beyond(self.points.len() - 1, after),
                x,
            );
        }
        // from right to left, so that the leftmost piece is kept
        let mut chosen = [nowhere; 6];
        for k in (0..self.points.len() - 1).rev() {
            let ([x_k, y_k], [x_next, y_next]) = (self.points[k], self.points[k + 1]);
            if y_next > y_k {
                let [m, c2, c3] = self.coefficients[k];
                let piece = mapped([x_k, y_k, m, c2, c3, x_next - x_k], c::<T>);
                for (old, new) in chosen.iter_mut().zip(piece) {
                    let kept = T::select(y.lt(c(y_k)), *old, new);
                    *old = T::select(c::<T>(y_next).lt(y), *old, kept);
                }
            }
        }
        let inside = solve(chosen, y);
        x = T::select(inside.lt(c(f64::INFINITY)), inside, x);
        if goes_on && self.slope_before > 0.0 {
            x = T::select(y.lt(c(self.points[0][1])), beyond(0, self.slope_before), x);
        }
        x + y.taint()
    }

    /// The time of rest: [`Cubic::stop`].
    #[inline(always)]
    pub fn stop<T: Real>(&self, velocity: T, factor: T) -> T {
        let searched = Searched {
            points: self.points,
            extrapolate: self.extrapolate,
            coefficients: &|piece| match piece {
                0 => [self.slope_before, 0.0, 0.0],
                _ => self.coefficients[piece - 1],
            },
        };
        stop(
            &searched,
            velocity,
            factor,
            |x| self.value(x),
            |x| self.integral(x),
        )
    }

    /// Chooses among the results of all pieces the one that holds at `x`.
    #[inline(always)]
    fn choose<T: Real>(&self, x: T, of: impl Fn(usize) -> T) -> T {
        let (first, last) = candidates(self.points.len(), |k| self.points[k][0], x);
        let mut y = of(first);
        for k in first..last {
            y = T::select(x.lt(c(self.points[k][0])), y, of(k + 1));
        }
        guard(self.points, self.extrapolate, x, y)
    }

    /// s = x − x_k, y_k and the coefficients of a piece. Piece 0 lies left of the first point, piece k + 1 right of
    /// point k.
    #[inline(always)]
    fn piece<T: Real>(&self, piece: usize, x: T) -> (T, f64, [f64; 3]) {
        let [x_k, y_k] = self.points[piece.saturating_sub(1)];
        let coefficients = match piece {
            0 => [self.slope_before, 0.0, 0.0],
            _ => self.coefficients[piece - 1],
        };
        (x - c(x_k), y_k, coefficients)
    }
}

impl Integrable for Cubics<'_> {
    #[inline(always)]
    fn antiderivatives<T: Real>(&self, x: T) -> [T; 2] {
        let integrals = |piece: usize| self.integrals[piece.saturating_sub(1)];
        let once = self.choose(x, |piece| {
            let (s, y, [m, c2, c3]) = self.piece(piece, x);
            let [once, _] = integrals(piece);
            c::<T>(c3 / 4.0)
                .mul_add(s, c(c2 / 3.0))
                .mul_add(s, c(m / 2.0))
                .mul_add(s, c(y))
                .mul_add(s, c(once))
        });
        let twice = self.choose(x, |piece| {
            let (s, y, [m, c2, c3]) = self.piece(piece, x);
            let [once, twice] = integrals(piece);
            c::<T>(c3 / 20.0)
                .mul_add(s, c(c2 / 12.0))
                .mul_add(s, c(m / 6.0))
                .mul_add(s, c(y / 2.0))
                .mul_add(s, c(once))
                .mul_add(s, c(twice))
        });
        [once, twice]
    }
}

/// Finds the points at which the second derivative changes, and the ends of a held curve where the slope changes.
/// Returns their number.
const fn find_kinks(
    given: &[[f64; 3]],
    points: &[[f64; 2]],
    coefficients: &[[f64; 3]],
    extrapolate: Extrapolate,
    kinks: &mut [f64],
) -> usize {
    let mut found = 0;
    // for the piece to the left of each point: the second derivative at its end, and a bound of its rounding error
    let (mut bend, mut off) = (0.0, 0.0);
    let mut k = 0;
    while k < given.len() {
        let [x, _, m] = given[k];
        let (mut next, mut next_off) = (0.0, 0.0);
        let (mut next_bend, mut end) = (0.0, true);
        if k + 1 < given.len() {
            let h = given[k + 1][0] - x;
            let [_, c2, c3] = coefficients[k];
            next = 2.0 * c2;
            next_bend = next + 6.0 * c3 * h;
            // 2 c₂ h = 6Δ − 4 m − 2 m', each rounded
            let slopes = m.abs() + given[k + 1][2].abs();
            next_off =
                (16.0 * rounding(points[k], points[k + 1]) + 16.0 * f64::EPSILON * slopes) / h;
            end = k == 0;
        }
        let jumps = (next - bend).abs() > off + next_off;
        let kinked = match extrapolate {
            Extrapolate::Error => jumps && !end,
            Extrapolate::Linear => jumps,
            Extrapolate::Hold => jumps || (end && m != 0.0),
        };
        if kinked {
            kinks[found] = x;
            found += 1;
        }
        (bend, off) = (next_bend, next_off);
        k += 1;
    }
    found
}

/// The abscissa at which a rising piece `[x_k, y_k, m, c₂, c₃, h]` has the ordinate `y`.
#[inline(always)]
fn solve<T: Real>([x_k, y_k, m, c2, c3, h]: [T; 6], y: T) -> T {
    let value = |s: T| c3.mul_add(s, c2).mul_add(s, m).mul_add(s, y_k);
    let (mut low, mut high) = (T::from_f64(0.0), h);
    for _ in 0..HALVINGS {
        let middle = c::<T>(0.5) * (low + high);
        let below = value(middle).lt(y);
        low = T::select(below, middle, low);
        high = T::select(below, high, middle);
    }
    // after the first step s has the accuracy of a double, after the second the square of that; so has its derivative
    let mut s = high;
    for _ in 0..2 {
        let slope = c::<T>(3.0).mul_add(c3 * s, c::<T>(2.0) * c2).mul_add(s, m);
        let rises = c::<T>(0.0).lt(slope);
        let step = (value(s) - y) / T::select(rises, slope, c(1.0));
        s = s - T::select(rises, step, c(0.0));
    }
    let s = T::select(s.lt(c(0.0)), c(0.0), s);
    x_k + T::select(h.lt(s), h, s)
}

#[inline(always)]
fn c<T: Real>(value: f64) -> T {
    T::from_f64(value)
}
