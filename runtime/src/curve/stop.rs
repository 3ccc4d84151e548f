//! Finds when a body that a curve of time accelerates comes to rest: the first x > 0 at which v(x) = velocity + factor
//! · ∫₀ˣ of the curve is 0.
//!
//! The search goes from piece to piece and divides each piece where the curve changes its sign. The curve is monotone
//! in a piece, so there is at most one such place. On either side of it v is monotone and has at most one root, which
//! bisection finds. The search uses doubles, lane by lane, and rounds each addition and product, so every scalar gets
//! the same bits on every machine. Two Newton steps then find the digits and the derivatives that the scalar has.
//!
//! If v turns back within rounding of 0 without crossing it, v counts as having reached 0. The curve is 0 there, so the
//! place depends on neither velocity nor factor and has no derivatives. A velocity that is 0 at the beginning does not
//! count: the search starts where v is no longer 0.

use super::Extrapolate;
use crate::real::{Mask, Real};

/// Largest distance of v from 0, where v turns back, that counts as 0. It is relative to the magnitudes that v was
/// summed from: a few roundings in each of some pieces.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The largest relative correction by Newton's steps, which only remove rounding. If v is so flat that they would be
/// longer, the place is not known more precisely.
const FAR: f64 = 1e-3;

/// The place where v reaches 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stop {
    x: f64,
    /// Whether v goes through 0. Otherwise v turns back there, or stays at 0.
    crosses: bool,
}

/// The curve, as the search needs it.
pub(super) struct Searched<'a> {
    pub points: &'a [[f64; 2]],
    pub extrapolate: Extrapolate,
    /// Slope and higher coefficients of a piece, about its point: piece 0 lies left of the first point, piece k + 1
    /// right of point k.
    pub coefficients: &'a dyn Fn(usize) -> [f64; 3],
}

/// The stop in each lane, 0 where there is none.
#[inline(always)]
pub(super) fn stop<T: Real>(
    searched: &Searched<'_>,
    velocity: T,
    factor: T,
    value: impl Fn(T) -> T,
    integral: impl Fn(T) -> T,
) -> T {
    let number = T::from_f64;
    let (mut x, mut crossing) = (number(0.0), 0);
    let mut left = T::Mask::of_lanes(u32::MAX).lanes();
    while left != 0 {
        let lane = left & left.wrapping_neg();
        left &= !lane;
        let mask = T::Mask::of_lanes(lane);
        // `to_f64` returns the largest lane
        let far = number(f64::NEG_INFINITY);
        let of_lane = |all: T| T::select(mask, all, far).to_f64();
        if let Some(found) = searched.first(of_lane(velocity), of_lane(factor)) {
            x = T::select(mask, number(found.x), x);
            crossing |= if found.crosses { lane } else { 0 };
        }
    }
    let crossing = T::Mask::of_lanes(crossing);
    let (zero, one) = (number(0.0), number(1.0));
    for _ in 0..2 {
        let slope = factor * value(x);
        let steep = zero.lt(slope.abs());
        let step = factor.mul_add(integral(x), velocity) / T::select(steep, slope, one);
        let near = step.abs().lt(number(FAR) * x);
        x = x - T::select(steep.and(near).and(crossing), step, zero);
        if let Extrapolate::Error = searched.extrapolate {
            let last = number(searched.points[searched.points.len() - 1][0]);
            x = T::select(last.lt(x), last.moving_as(x), x);
        }
    }
    x + velocity.taint() + factor.taint()
}

impl Searched<'_> {
    /// The first stop, in doubles; `None` where v never reaches 0, or where the argument leaves the curve before.
    #[inline(never)]
    fn first(&self, velocity: f64, factor: f64) -> Option<Stop> {
        if !velocity.is_finite() || !factor.is_finite() || factor == 0.0 {
            return None;
        }
        let count = self.points.len();
        let ends = matches!(self.extrapolate, Extrapolate::Error);
        let mut walk = Walk {
            velocity,
            sign: sign(velocity),
            size: velocity.abs(),
            near: false,
        };
        for piece in 0..=count {
            let from = match piece {
                0 => 0.0,
                _ => self.points[piece - 1][0].max(0.0),
            };
            let to = match piece < count {
                true => self.points[piece][0],
                false => f64::INFINITY,
            };
            if to <= from {
                continue;
            }
            if ends && piece == 0 {
                return None;
            }
            if ends && piece == count {
                let reached = Stop {
                    x: from,
                    crosses: true,
                };
                return walk.near.then_some(reached);
            }
            let [x, y] = self.points[piece.saturating_sub(1)];
            let piece = Piece {
                x,
                y,
                coefficients: (self.coefficients)(piece),
                factor,
            };
            let turn = piece.turn(from, to);
            for (from, to) in [(from, turn), (turn, to)] {
                let found = match to {
                    _ if to <= from => None,
                    f64::INFINITY => return walk.for_ever(&piece, from),
                    _ => walk.over(&piece, from, to),
                };
                if found.is_some() {
                    return found;
                }
            }
        }
        None
    }
}

/// The state of the search, up to the current place.
struct Walk {
    velocity: f64,
    /// The sign that the velocity has had since it was not 0; 0 before.
    sign: f64,
    /// The sum of the magnitudes of all terms of the velocity.
    size: f64,
    /// Whether the velocity is 0 within rounding at the current place, and was not 0 before.
    near: bool,
}

impl Walk {
    /// Passes a part of a piece in which v is monotone.
    fn over(&mut self, piece: &Piece, from: f64, to: f64) -> Option<Stop> {
        let (begin, end) = (piece.integral(from), piece.integral(to));
        let gain = end - begin;
        self.size += begin.abs() + end.abs();
        if self.sign == 0.0 {
            self.sign = sign(gain);
            self.velocity += gain;
            return None;
        }
        if let Some(stop) = self.reached(gain, from) {
            return Some(stop);
        }
        let reached = self.sign * (self.velocity + gain);
        let rounding = ROUNDING * self.size;
        if reached < -rounding {
            return Some(self.crossed(piece, from, to));
        }
        self.velocity += gain;
        self.near = reached <= rounding;
        None
    }

    /// Passes the last part, which goes to infinity and in which v is monotone.
    fn for_ever(&self, piece: &Piece, from: f64) -> Option<Stop> {
        // far away, the sign of a line is that of its slope, since its zero lies behind; without a slope it is that of
        // its value
        let ahead = match piece.factor * piece.coefficients[0] {
            0.0 => piece.acceleration(from),
            slope => slope,
        };
        if self.sign == 0.0 {
            return None;
        }
        if let Some(stop) = self.reached(ahead, from) {
            return Some(stop);
        }
        if self.sign * ahead >= 0.0 {
            return None;
        }
        let begin = piece.integral(from);
        let mut length = 1.0;
        while length < f64::MAX {
            let gain = piece.integral(from + length) - begin;
            if self.sign * (self.velocity + gain) <= 0.0 {
                return Some(self.crossed(piece, from, from + length));
            }
            length *= 2.0;
        }
        None
    }

    /// The stop at the beginning of a part, if the velocity was 0 there. The sign of `gain` tells to which side the
    /// velocity changes in this part.
    fn reached(&self, gain: f64, from: f64) -> Option<Stop> {
        let turns_back = self.sign * gain >= 0.0;
        let is_there = turns_back || self.sign * self.velocity <= 0.0;
        (self.near && is_there).then_some(Stop {
            x: from,
            crosses: !turns_back,
        })
    }

    /// The place where v goes through 0 between `from` and `to`.
    fn crossed(&self, piece: &Piece, from: f64, to: f64) -> Stop {
        let begin = piece.integral(from);
        let moves = |x: f64| self.sign * (self.velocity + (piece.integral(x) - begin)) > 0.0;
        Stop {
            x: halve(from, to, moves),
            crosses: true,
        }
    }
}

/// A polynomial piece of the curve, times the factor: an acceleration.
struct Piece {
    x: f64,
    y: f64,
    coefficients: [f64; 3],
    factor: f64,
}

impl Piece {
    fn acceleration(&self, x: f64) -> f64 {
        let ([m, c2, c3], s) = (self.coefficients, x - self.x);
        self.factor * (((c3 * s + c2) * s + m) * s + self.y)
    }

    /// ∫ of the acceleration from the point of the piece to `x`.
    fn integral(&self, x: f64) -> f64 {
        let ([m, c2, c3], s) = (self.coefficients, x - self.x);
        self.factor * (s * (self.y + s * (m / 2.0 + s * (c2 / 3.0 + s * c3 / 4.0))))
    }

    /// The place where the acceleration changes its sign between `from` and `to`; `to` if it does not. Beyond the
    /// outermost points the acceleration is a line.
    fn turn(&self, from: f64, to: f64) -> f64 {
        let begin = self.acceleration(from);
        if to == f64::INFINITY {
            let turn = from - begin / (self.factor * self.coefficients[0]);
            return match turn > from && turn.is_finite() {
                true => turn,
                false => to,
            };
        }
        if sign(begin) * sign(self.acceleration(to)) >= 0.0 {
            return to;
        }
        halve(from, to, |x| sign(self.acceleration(x)) == sign(begin))
    }
}

/// The smallest number in `low` … `high` at which a condition fails that holds at `low` and fails at `high`, by
/// bisection until no number is left between.
fn halve(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return high;
        }
        match holds(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
}

/// −1, 0 or 1.
fn sign(x: f64) -> f64 {
    match x {
        x if x > 0.0 => 1.0,
        x if x < 0.0 => -1.0,
        _ => 0.0,
    }
}
