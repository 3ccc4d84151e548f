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
