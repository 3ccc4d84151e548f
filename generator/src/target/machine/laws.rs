//! Choices and piecewise linear curves, written out as steps in place of calls.
//!
//! The steps follow the runtime (`runtime/src/force`, `runtime/src/curve/{lines,breakpoint_indicator}.rs`) operation by
//! operation, so they give the same bits. A call stores all values that are in registers and loads them again, which
//! takes longer than most laws.

use super::steps::Lowering;
use super::terms::Term;
use crate::expression::Function;
use crate::model::Extrapolate;
use crate::program::Curve;

/// Curves with more points are not written out: the runtime is called, which searches for the piece.
const MOST_POINTS: usize = 8;

impl Lowering<'_> {
    /// The result of a function as steps; `None` if the function must be called.
    pub fn law(&mut self, function: Function, a: &[Term]) -> Option<Term> {
        match function {
            Function::Choose => Some(self.choose(a[0], a[1], a[2], a[3])),
            Function::Curve(index) => Some(self.ordinate(self.lines(index)?, a[0])),
            Function::CurveSlope(index) => Some(self.slope(self.lines(index)?, a[0])),
            Function::CurveBreakpoints(index) => {
                Some(self.breakpoint_indicator(&self.lines(index)?.kinks(), a[0]))
            }
            _ => None,
        }
    }

    /// `then` where a < b, `otherwise` elsewhere. NaN where the comparison fails because a or b is not finite.
    fn choose(&mut self, a: Term, b: Term, then: Term, otherwise: Term) -> Term {
        // What the runtime adds to `otherwise` is +0 or NaN. To add it to a constant +0, or the +0 of a constant to it,
        // changes no bit. A constant that is too large for single precision becomes infinite there.
        let [of_a, of_b, given] =
            [a, b, otherwise].map(|term| self.numbers.constant_of(term.value));
        let most = f64::from(f32::MAX);
        let finite = |number: Option<f64>| number.is_some_and(|number| number.abs() <= most);
        let of_both = match (finite(of_a), finite(of_b)) {
            (true, _) => self.taint(b),
            (_, true) => self.taint(a),
            _ => {
                let (of_a, of_b) = (self.taint(a), self.taint(b));
                self.sum(of_a, of_b)
            }
        };
        let is_zero = given.is_some_and(|number| number.to_bits() == 0);
        let otherwise = match is_zero {
            true => of_both,
            false => self.sum(otherwise, of_both),
        };
        self.select(a, b, then, otherwise)
    }

    /// 0, or NaN where `x` is not finite.
    fn taint(&mut self, x: Term) -> Term {
        self.sum(x, x.negated())
    }

    /// A piecewise linear curve with few points; `None` for any other curve.
    fn lines(&self, index: u32) -> Option<Lines> {
        let curve = self.curves.get(index as usize)?;
        let few = curve.points.len() <= MOST_POINTS;
        (few && curve.tangents.is_none()).then(|| Lines::of(curve))
    }

    /// The ordinate at `x`.
    fn ordinate(&mut self, lines: Lines, x: Term) -> Term {
        let mut y = self.line(&lines, 0, x);
        for (k, [abscissa, _]) in lines.points.iter().enumerate() {
            // left of the first point, the line is often the same as the first piece
            if k == 0 && lines.slope_of(0).to_bits() == lines.slope_of(1).to_bits() {
                continue;
            }
            let next = self.line(&lines, k + 1, x);
            let abscissa = self.number(*abscissa);
            y = self.select(x, abscissa, y, next);
        }
        self.guarded(&lines, x, y)
    }

    /// The slope at `x`.
    fn slope(&mut self, lines: Lines, x: Term) -> Term {
        let mut slope = self.number(lines.slope_of(0));
        for (k, [abscissa, _]) in lines.points.iter().enumerate() {
            let next = self.number(lines.slope_of(k + 1));
            let abscissa = self.number(*abscissa);
            slope = self.select(x, abscissa, slope, next);
        }
        let last = lines.points.len() - 1;
        if lines.extrapolate == Extrapolate::Error {
            let inside = self.number(lines.slope_of(last));
            let abscissa = self.number(lines.points[last][0]);
            slope = self.select(x, abscissa, slope, inside);
        }
        let taint = self.taint(x);
        let slope = self.sum(slope, taint);
        self.guarded(&lines, x, slope)
    }

    /// The breakpoint indicator: the distance to the nearest kink, with a sign that changes at each kink; 1 if there is
    /// no kink.
    fn breakpoint_indicator(&mut self, kinks: &[f64], x: Term) -> Term {
        if kinks.is_empty() {
            let (one, taint) = (self.number(1.0), self.taint(x));
            return self.sum(one, taint);
        }
        let ways: Vec<Term> = (kinks.iter())
            .map(|kink| {
                let kink = self.number(*kink);
                self.sum(kink, x.negated())
            })
            .collect();
        let mut y = ways[0];
        for (k, kink) in kinks.iter().enumerate() {
            let behind = ways[k].negated();
            let distance = match ways.get(k + 1) {
                Some(ahead) => self.smaller(behind, *ahead),
                None => behind,
            };
            let next = match k % 2 {
                0 => distance.negated(),
                _ => distance,
            };
            let kink = self.number(*kink);
            y = self.select(x, kink, y, next);
        }
        y
    }

    /// The ordinate of one piece: piece 0 lies left of the first point, piece k + 1 right of point k.
    fn line(&mut self, lines: &Lines, piece: usize, x: Term) -> Term {
        let [abscissa, ordinate] = lines.points[piece.saturating_sub(1)];
        let (slope, abscissa) = (self.number(lines.slope_of(piece)), self.number(abscissa));
        let ordinate = self.number(ordinate);
        let way = self.sum(x, abscissa.negated());
        self.mul_add(slope, way, ordinate)
    }

    /// The value `y`; NaN if `x` is outside a curve that must not be left (`Extrapolate::Error`).
    fn guarded(&mut self, lines: &Lines, x: Term, y: Term) -> Term {
        if lines.extrapolate != Extrapolate::Error {
            return y;
        }
        let outside = self.number(f64::NAN);
        let [first, last] = [0, lines.points.len() - 1].map(|k| lines.points[k][0]);
        let (first, last) = (self.number(first), self.number(last));
        let y = self.select(x, first, outside, y);
        self.select(last, x, outside, y)
    }
}

/// A piecewise linear curve with the slopes of its pieces.
struct Lines {
    points: Vec<[f64; 2]>,
    /// The slopes of all pieces; piece 0 lies left of the first point.
    slopes: Vec<f64>,
    extrapolate: Extrapolate,
}

impl Lines {
    fn of(curve: &Curve) -> Self {
        let pairs = curve.points.windows(2);
        let mut slopes: Vec<f64> = pairs
            .map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]))
            .collect();
        let goes_on = curve.extrapolate == Extrapolate::Linear;
        let beyond = |slope: Option<&f64>| match slope {
            Some(slope) if goes_on => *slope,
            _ => 0.0,
        };
        let (before, behind) = (beyond(slopes.first()), beyond(slopes.last()));
        slopes.insert(0, before);
        slopes.push(behind);
        Lines {
            points: curve.points.clone(),
            slopes,
            extrapolate: curve.extrapolate,
        }
    }

    fn slope_of(&self, piece: usize) -> f64 {
        self.slopes[piece]
    }

    /// The abscissae at which the curve is not smooth: where the slope changes by more than rounding, and the ends of a
    /// held curve.
    fn kinks(&self) -> Vec<f64> {
        let last = self.points.len() - 1;
        let held = self.extrapolate == Extrapolate::Hold;
        let is_kink = |k: &usize| {
            let (before, behind) = (self.slope_of(*k), self.slope_of(*k + 1));
            match *k {
                0 => held && behind != 0.0,
                k if k == last => held && before != 0.0,
                k => (behind - before).abs() > self.rounding(k - 1) + self.rounding(k),
            }
        };
        let kinks = (0..=last).filter(is_kink);
        kinks.map(|k| self.points[k][0]).collect()
    }

    /// A bound of the error in the slope right of point `k`, due to the rounding of coordinates.
    fn rounding(&self, k: usize) -> f64 {
        let ([x0, y0], [x1, y1]) = (self.points[k], self.points[k + 1]);
        let run = x1 - x0;
        let slope = ((y1 - y0) / run).abs();
        4.0 * f64::EPSILON * (y0.abs() + y1.abs() + slope * (x0.abs() + x1.abs())) / run
    }
}
