//! Curves evaluated at plain numbers: y(x) = y_k + m s + c₂ s² + c₃ s³, s = x − x_k, for x_k ≤ x < x_{k+1}; with slope,
//! inverse and integrals.
//!
//! A compiled model has its curves as constants of fixed length (`bryant_runtime::curve`); here they come from the
//! model as read, with the same rules at the points and beyond the outermost ones. Lines have c₂ = c₃ = 0. The slope m
//! of a cubic at a point follows from the secants Δ of the pieces on both sides of the point, so that the curve is
//! monotone wherever its points are: m is 0 if the secants differ in sign, otherwise their weighted harmonic mean
//! (Fritsch and Butland 1984), which keeps m ≤ 3Δ on either side (Fritsch and Carlson 1980).

use super::number::Number;
use serde::{Deserialize, Serialize};

/// A function through points (SI).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// Name in the YAML, or a name made from the force in which the curve is written ("belt chest force").
    pub name: String,
    /// (abscissa, ordinate), abscissae strictly increasing, at least two points.
    pub points: Vec<[f64; 2]>,
    /// Interpolation between the points.
    pub interpolate: Interpolate,
    /// Extrapolation beyond the points.
    pub extrapolate: Extrapolate,
    /// True if the description states the extrapolation. Otherwise a run that leaves the curve raises a doubt.
    #[serde(rename = "told")]
    pub states_extrapolation: bool,
    /// Points of the curve's file that were left out; `None` if there are none.
    #[serde(skip)]
    pub thinned: Option<Thinned>,
}

/// Facts about the points that were left out of a curve, because its file has too many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinned {
    /// Number of points in the file.
    pub points: usize,
    /// Largest distance between the curve and the points that were left out, in the SI unit of its ordinate.
    pub error: f64,
}

/// Interpolation of a curve between its points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum Interpolate {
    /// Straight lines.
    #[default]
    Linear,
    /// Cubics with a common slope at each point ([`Curve::tangent`](super::Curve::tangent)), monotone wherever the
    /// points are.
    Cubic,
}

/// Extrapolation of a curve beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Extrapolate {
    /// The outermost segment continues; for cubics, its tangent at the outermost point.
    Linear,
    /// The outermost value is held.
    Hold,
    /// The curve is NaN there, so that a run that leaves the range fails.
    Error,
}

/// A scaled curve: `times · curve(argument / stretch)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScaledCurve {
    /// Index into [`Model::curves`](super::Model::curves).
    pub curve: usize,
    /// Factor on the ordinate.
    pub times: Number,
    /// Factor on the abscissa, positive.
    pub stretch: Number,
    /// True if the curve is a line through 0 that is written as its slope, `stiffness`: `times` must then not be
    /// negative.
    pub stiffness: bool,
}

impl Curve {
    /// True if the curve is one straight line through 0, up to rounding of its points.
    pub fn is_proportional(&self) -> bool {
        let size = |axis: usize| {
            self.points
                .iter()
                .fold(0.0, |m: f64, p| m.max(p[axis].abs()))
        };
        let rounding = 4.0 * f64::EPSILON * size(0) * size(1);
        let [x0, y0] = self.points[0];
        let [x1, y1] = self.points[self.points.len() - 1];
        let (run, rise) = (x1 - x0, y1 - y0);
        let off = |[x, y]: [f64; 2]| (y * run - x * rise).abs();
        self.extrapolate == Extrapolate::Linear && self.points.iter().all(|p| off(*p) <= rounding)
    }

    /// Value at `x`; NaN if `x` is outside a curve that must not be left.
    pub fn value(&self, x: f64) -> f64 {
        let Some((s, y, [m, c2, c3])) = self.at(x) else {
            return f64::NAN;
        };
        ((c3 * s + c2) * s + m) * s + y
    }

    /// Slope at `x`, at a point that of the piece to its right; NaN if `x` is outside a curve that must not be left.
    pub fn slope(&self, x: f64) -> f64 {
        let Some((s, _, [m, c2, c3])) = self.at(x) else {
            return f64::NAN;
        };
        (3.0 * c3 * s + 2.0 * c2) * s + m
    }

    /// Second derivative at `x`, with the same rules as the slope.
    pub fn second_derivative(&self, x: f64) -> f64 {
        let Some((s, _, [_, c2, c3])) = self.at(x) else {
            return f64::NAN;
        };
        6.0 * c3 * s + 2.0 * c2
    }

    /// The smallest abscissa on a rising piece at which the value is `y`; NaN if there is none.
    pub fn inverse(&self, y: f64) -> f64 {
        let points = &self.points;
        let last = points.len() - 1;
        let goes_on = self.extrapolate == Extrapolate::Linear;
        let beyond = |k: usize| {
            let [x_k, y_k] = points[k];
            x_k + (y - y_k) / self.tangent(k)
        };
        if goes_on && y < points[0][1] && points[1][1] > points[0][1] && self.tangent(0) > 0.0 {
            return beyond(0);
        }
        for k in 0..last {
            let [low, high] = [points[k][1], points[k + 1][1]];
            let cubic = self.interpolate == Interpolate::Cubic;
            if low <= y && (y < high || cubic && y == high && low < high) {
                return points[k][0] + self.solve(k, y - low);
            }
        }
        let rises = points[last][1] > points[last - 1][1];
        match rises {
            true if y == points[last][1] => points[last][0],
            true if goes_on && y > points[last][1] && self.tangent(last) > 0.0 => beyond(last),
            _ => f64::NAN,
        }
    }

    /// The abscissae at which the curve is not smooth, in increasing order: where its slope changes or, for cubics, its
    /// second derivative. At the outermost points, the extrapolation counts. Differences due to rounding do not count.
    pub fn kinks(&self) -> Vec<f64> {
        let last = self.points.len() - 1;
        // bound of the rounding error in the slope of a piece
        let off = |k: usize| {
            let ([x0, y0], [x1, y1]) = (self.points[k], self.points[k + 1]);
            let [x, y] = [x0.abs() + x1.abs(), y0.abs() + y1.abs()];
            4.0 * f64::EPSILON * (y + self.secant(k).abs() * x) / (x1 - x0)
        };
        let bend_off = |k: usize| {
            let slopes = self.tangent(k).abs() + self.tangent(k + 1).abs();
            16.0 * (off(k) + f64::EPSILON * slopes) / self.length(k)
        };
        let kinked = |k: &usize| {
            let end = *k == 0 || *k == last;
            if end && self.extrapolate == Extrapolate::Error {
                return false;
            }
            // slope and second derivative on both sides of the point
            let (before, after) = (self.coefficients(*k), self.coefficients(k + 1));
            let h = if *k == 0 { 0.0 } else { self.length(k - 1) };
            let [slope, bend] = [
                (3.0 * before[2] * h + 2.0 * before[1]) * h + before[0],
                6.0 * before[2] * h + 2.0 * before[1],
            ];
            let beside = (k.saturating_sub(1)..=*k).filter(|piece| *piece < last);
            let (slope_off, bend_off) = beside.fold((0.0, 0.0), |(s, b), piece| {
                (s + off(piece), b + bend_off(piece))
            });
            match self.interpolate {
                Interpolate::Linear => (after[0] - slope).abs() > slope_off,
                // the slope of a cubic is continuous, except at the end of a held curve
                Interpolate::Cubic => {
                    let left = end && self.extrapolate == Extrapolate::Hold;
                    (2.0 * after[1] - bend).abs() > bend_off || left && self.tangent(*k) != 0.0
                }
            }
        };
        let kinked = (0..=last).filter(kinked);
        kinked.map(|k| self.points[k][0]).collect()
    }

    /// The longest intervals on which the curve is 0, in increasing order; an end is ±∞ if the curve remains 0 beyond
    /// its points.
    pub fn idle(&self) -> Vec<[f64; 2]> {
        let last = self.points.len() - 1;
        let mut idle: Vec<[f64; 2]> = Vec::new();
        for (k, pair) in self.points.windows(2).enumerate() {
            let [[from, start], [to, end]] = [pair[0], pair[1]];
            let flat = self.tangent(k) == 0.0 && self.tangent(k + 1) == 0.0;
            let cubic = self.interpolate == Interpolate::Cubic;
            if start != 0.0 || end != 0.0 || (cubic && !flat) {
                continue;
            }
            match idle.last_mut() {
                Some(before) if before[1] == from => before[1] = to,
                _ => idle.push([from, to]),
            }
        }
        let holds = self.extrapolate == Extrapolate::Hold;
        if holds && self.points[0][1] == 0.0 {
            match idle.first_mut() {
                Some(first) if first[0] == self.points[0][0] => first[0] = f64::NEG_INFINITY,
                _ => idle.insert(0, [f64::NEG_INFINITY, self.points[0][0]]),
            }
        }
        if holds && self.points[last][1] == 0.0 {
            match idle.last_mut() {
                Some(end) if end[1] == self.points[last][0] => end[1] = f64::INFINITY,
                _ => idle.push([self.points[last][0], f64::INFINITY]),
            }
        }
        // straight continuation beyond the outermost points
        if self.extrapolate == Extrapolate::Linear {
            for interval in &mut idle {
                if interval[0] == self.points[0][0] {
                    interval[0] = f64::NEG_INFINITY;
                }
                if interval[1] == self.points[last][0] {
                    interval[1] = f64::INFINITY;
                }
            }
        }
        idle
    }

    /// The breakpoint indicator: the distance to the nearest kink, with a sign that changes at each kink; 1 if there is
    /// no kink.
    pub fn breakpoint_indicator(&self, x: f64) -> f64 {
        let kinks = self.kinks();
        if x.is_nan() {
            return x;
        }
        let passed = kinks.partition_point(|kink| *kink <= x);
        let distances = kinks.iter().map(|kink| (x - kink).abs());
        let distance = match kinks.is_empty() {
            true => 1.0,
            false => distances.fold(f64::INFINITY, f64::min),
        };
        if passed.is_multiple_of(2) {
            distance
        } else {
            -distance
        }
    }

    /// ∫ y dx from 0 to `x`.
    pub fn integral(&self, x: f64) -> f64 {
        self.integrals(x)[0]
    }

    /// ∬ y dx dx from 0 to `x`: for a curve that is an acceleration, the displacement from rest.
    pub fn double_integral(&self, x: f64) -> f64 {
        self.integrals(x)[1]
    }

    /// Slope at point `k`: for a cubic its slope there, for lines the slope of the piece to the right.
    ///
    /// # Panics
    /// If there is no point `k`.
    pub fn tangent(&self, k: usize) -> f64 {
        let last = self.points.len() - 1;
        if self.interpolate == Interpolate::Linear {
            return self.secant(k.min(last - 1));
        }
        let end = k == 0 || k == last;
        match self.extrapolate {
            // avoids a jump of the slope at the end of the curve
            Extrapolate::Hold if end => 0.0,
            _ if last == 1 => self.secant(0),
            _ if k == 0 => self.end_tangent([0, 1]),
            _ if k == last => self.end_tangent([last - 1, last - 2]),
            _ => {
                let [before, after] = [self.secant(k - 1), self.secant(k)];
                if before * after > 0.0 {
                    let [h, next] = [self.length(k - 1), self.length(k)];
                    let [a, b] = [2.0 * next + h, next + 2.0 * h];
                    (a + b) / (a / before + b / after)
                } else {
                    0.0
                }
            }
        }
    }

    /// True if all slopes and coefficients of the curve are finite.
    pub fn is_finite(&self) -> bool {
        let pieces = 0..=self.points.len();
        pieces
            .flat_map(|piece| self.coefficients(piece))
            .all(f64::is_finite)
    }

    /// True if every piece ends where the next begins. Otherwise lengths or slopes overflow, or have lost their digits
    /// by underflow.
    pub fn is_joined(&self) -> bool {
        // far above rounding, which is a few units in the last place of the ordinates
        const TOLERANCE: f64 = 1e-9;
        self.points.windows(2).enumerate().all(|(k, pair)| {
            let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
            let (h, [m, c2, c3]) = (x1 - x0, self.coefficients(k + 1));
            let end = ((c3 * h + c2) * h + m) * h + y0;
            (end - y1).abs() <= TOLERANCE * (y0.abs() + y1.abs())
        })
    }

    /// Slope at an end, by the parabola through three points, limited so that the piece stays monotone. `outer` is the
    /// piece at the end, `inner` the piece beside it.
    fn end_tangent(&self, [outer, inner]: [usize; 2]) -> f64 {
        let [h, next] = [self.length(outer), self.length(inner)];
        let [secant, beside] = [self.secant(outer), self.secant(inner)];
        let slope = ((2.0 * h + next) * secant - h * beside) / (h + next);
        if slope * secant <= 0.0 {
            0.0
        } else if secant * beside <= 0.0 && slope.abs() > 3.0 * secant.abs() {
            3.0 * secant
        } else {
            slope
        }
    }

    /// s, y_k and (m, c₂, c₃) at `x`; `None` if the curve has no value there, and for NaN.
    fn at(&self, x: f64) -> Option<(f64, f64, [f64; 3])> {
        let last = self.points.len() - 1;
        if x.is_nan() || self.forbidden(x) {
            return None;
        }
        // piece 0 lies left of the first point, piece k + 1 right of point k
        let mut piece = self.points.partition_point(|point| point[0] <= x);
        // the last point still belongs to a curve that must not be left; an abscissa to the right of it does not
        if self.extrapolate == Extrapolate::Error {
            piece = piece.min(last);
        }
        let [x_k, y_k] = self.points[piece.saturating_sub(1)];
        Some((x - x_k, y_k, self.coefficients(piece)))
    }

    /// The coefficients m, c₂, c₃ of a piece.
    fn coefficients(&self, piece: usize) -> [f64; 3] {
        let last = self.points.len() - 1;
        if piece == 0 || piece > last {
            let slope = match self.extrapolate {
                Extrapolate::Linear => self.tangent(piece.saturating_sub(1)),
                Extrapolate::Hold | Extrapolate::Error => 0.0,
            };
            return [slope, 0.0, 0.0];
        }
        let (h, secant) = (self.length(piece - 1), self.secant(piece - 1));
        match self.interpolate {
            Interpolate::Linear => [secant, 0.0, 0.0],
            Interpolate::Cubic => {
                let [m, next] = [self.tangent(piece - 1), self.tangent(piece)];
                let c2 = (3.0 * secant - 2.0 * m - next) / h;
                [m, c2, (m + next - 2.0 * secant) / (h * h)]
            }
        }
    }

    /// s in the rising piece from point `k` at which the curve is `y` above that point.
    fn solve(&self, k: usize, y: f64) -> f64 {
        let [m, c2, c3] = self.coefficients(k + 1);
        if self.interpolate == Interpolate::Linear {
            return y / m;
        }
        let (mut low, mut high) = (0.0, self.length(k));
        // bisection until no number lies between the bounds
        while low < 0.5 * (low + high) && 0.5 * (low + high) < high {
            let s = 0.5 * (low + high);
            if ((c3 * s + c2) * s + m) * s < y {
                low = s;
            } else {
                high = s;
            }
        }
        if y > 0.0 { high } else { 0.0 }
    }

    /// First and second integral from 0 to `x`, exact for each piece.
    fn integrals(&self, x: f64) -> [f64; 2] {
        if x.is_nan() {
            return [f64::NAN; 2];
        }
        let between = |point: &f64| *point > x.min(0.0) && *point < x.max(0.0);
        let mut ends: Vec<f64> = self.points.iter().map(|p| p[0]).filter(between).collect();
        if x < 0.0 {
            ends.reverse();
        }
        ends.push(x);
        let (mut a, mut first, mut second) = (0.0, 0.0, 0.0);
        for b in ends {
            let (h, middle) = (b - a, 0.5 * (a + b));
            let Some((from, y_k, [m, c2, c3])) = self.at(middle) else {
                return [f64::NAN; 2];
            };
            // expands the polynomial of the piece about the middle of the interval
            let s = from - 0.5 * h;
            let y = ((c3 * s + c2) * s + m) * s + y_k;
            let slope = (3.0 * c3 * s + 2.0 * c2) * s + m;
            let bend = 3.0 * c3 * s + c2;
            second +=
                h * (first + h * (y / 2.0 + h * (slope / 6.0 + h * (bend / 12.0 + h * c3 / 20.0))));
            first += h * (y + h * (slope / 2.0 + h * (bend / 3.0 + h * c3 / 4.0)));
            a = b;
        }
        [first, second]
    }

    /// True if `x` is outside a curve that must not be left.
    fn forbidden(&self, x: f64) -> bool {
        let outside = x < self.points[0][0] || x > self.points[self.points.len() - 1][0];
        self.extrapolate == Extrapolate::Error && outside
    }

    fn length(&self, k: usize) -> f64 {
        self.points[k + 1][0] - self.points[k][0]
    }

    /// Slope of the line from point `k` to the next point.
    fn secant(&self, k: usize) -> f64 {
        let [[x0, y0], [x1, y1]] = [self.points[k], self.points[k + 1]];
        (y1 - y0) / (x1 - x0)
    }
}
