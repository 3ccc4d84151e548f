//! Curves whose number of points is known only at run time.

use super::cubic::{self, Cubics};
use super::integral::Integrable as _;
use super::lines::{self, Lines};
use super::{Extrapolate, breakpoint_indicator, kink};
use crate::real::Real;
use std::vec::Vec;

/// A curve of any number of points, with the same results as a [`Curve`](super::Curve) or a [`Cubic`](super::Cubic) to
/// the last bit.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    points: Vec<[f64; 2]>,
    pieces: Pieces,
    slope_before: f64,
    integrals: Vec<[f64; 2]>,
    kinks: Vec<f64>,
    extrapolate: Extrapolate,
}

/// The pieces between the points.
#[derive(Clone, Debug, PartialEq)]
enum Pieces {
    /// Lines, with their slopes.
    Lines(Vec<f64>),
    /// Cubics, with m, c₂, c₃.
    Cubics(Vec<[f64; 3]>),
}

/// Functions that both kinds of curves have.
macro_rules! functions {
    ($($(#[$text:meta])* $name:ident;)*) => {
        $(
            $(#[$text])*
            #[inline(always)]
            pub fn $name<T: Real>(&self, x: T) -> T {
                match &self.pieces {
                    Pieces::Lines(slopes) => self.lines(slopes).$name(x),
                    Pieces::Cubics(coefficients) => self.cubics(coefficients).$name(x),
                }
            }
        )*
    };
}

impl Table {
    /// Makes straight lines through points (x, y), x increasing: [`Curve::new`](super::Curve::new).
    ///
    /// # Panics
    /// With fewer than two points, with a number that is not finite, or with abscissae that do not increase.
    pub fn of_lines(points: &[[f64; 2]], extrapolate: Extrapolate) -> Self {
        let count = points.len();
        let (mut slopes, mut kinks) = (vec![0.0; count], vec![0.0; count]);
        let mut integrals = vec![[0.0; 2]; count];
        let (slope_before, found) =
            lines::fill(points, extrapolate, &mut slopes, &mut integrals, &mut kinks);
        kinks.truncate(found);
        Table {
            points: points.to_vec(),
            pieces: Pieces::Lines(slopes),
            slope_before,
            integrals,
            kinks,
            extrapolate,
        }
    }

    /// Makes cubics through points (x, y), x increasing, with the slope m at each, `[x, y, m]`:
    /// [`Cubic::new`](super::Cubic::new).
    ///
    /// # Panics
    /// With fewer than two points, with a number that is not finite, or with abscissae that do not increase.
    pub fn of_cubics(given: &[[f64; 3]], extrapolate: Extrapolate) -> Self {
        let count = given.len();
        let (mut points, mut integrals) = (vec![[0.0; 2]; count], vec![[0.0; 2]; count]);
        let (mut coefficients, mut kinks) = (vec![[0.0; 3]; count], vec![0.0; count]);
        let (slope_before, found) = cubic::fill(
            given,
            extrapolate,
            &mut points,
            &mut coefficients,
            &mut integrals,
            &mut kinks,
        );
        kinks.truncate(found);
        Table {
            points,
            pieces: Pieces::Cubics(coefficients),
            slope_before,
            integrals,
            kinks,
            extrapolate,
        }
    }

    #[inline(always)]
    fn lines<'a>(&'a self, slopes: &'a [f64]) -> Lines<'a> {
        Lines {
            points: &self.points,
            slopes,
            slope_before: self.slope_before,
            integrals: &self.integrals,
            kinks: &self.kinks,
            extrapolate: self.extrapolate,
        }
    }

    #[inline(always)]
    fn cubics<'a>(&'a self, coefficients: &'a [[f64; 3]]) -> Cubics<'a> {
        Cubics {
            points: &self.points,
            coefficients,
            slope_before: self.slope_before,
            integrals: &self.integrals,
            kinks: &self.kinks,
            extrapolate: self.extrapolate,
        }
    }

    functions! {
        /// Ordinate at `x`: exact at the points; NaN where `x` is NaN.
        value;
        /// Slope at `x`; NaN where `x` is NaN.
        slope;
        /// Second derivative at `x`; NaN where `x` is NaN.
        second_derivative;
        /// ∫ of the curve from 0 to `x`.
        integral;
        /// ∬ of the curve from 0 to `x`.
        double_integral;
        /// The smallest x on a rising piece with value(x) = the argument; NaN where there is none.
        inverse;
    }

    /// The first x > 0 at which velocity + factor · ∫₀ˣ of the curve reaches 0, with its derivatives; 0 where it never
    /// does.
    #[inline(always)]
    pub fn stop<T: Real>(&self, velocity: T, factor: T) -> T {
        match &self.pieces {
            Pieces::Lines(slopes) => self.lines(slopes).stop(velocity, factor),
            Pieces::Cubics(coefficients) => self.cubics(coefficients).stop(velocity, factor),
        }
    }

    /// The breakpoint indicator: a function whose sign changes where the curve is not smooth.
    #[inline(always)]
    pub fn breakpoint_indicator<T: Real>(&self, x: T) -> T {
        breakpoint_indicator::breakpoint_indicator(&self.kinks, x)
    }

    /// The first time after `t` at which `rate` · time passes a point of the curve, in any lane. All lanes get this
    /// time, each with its own derivatives. +∞ where no point is left.
    pub fn kink_after<T: Real>(&self, rate: T, t: f64) -> T {
        kink::after(&self.points, |point| point[0], rate, t)
    }
}
