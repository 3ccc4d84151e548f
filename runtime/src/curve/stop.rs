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

#[cfg(test)]
mod tests {
    use crate::curve::{Cubic, Curve, Extrapolate};
    use crate::test_scalars::Pair;
    use crate::{DoubleDouble, Dual, Real};

    const fn lines<const N: usize>(points: [[f64; 2]; N], beyond: Extrapolate) -> Curve<N> {
        Curve::new(points, beyond)
    }

    const CONSTANT: Curve<2> = lines([[0.0, 1.0], [1.0, 1.0]], Extrapolate::Hold);
    /// From 0 up to 4 in 1, there for 2, down to 0 in 1: an area of 12.
    const TRAPEZOID: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 4.0], [3.0, 4.0], [4.0, 0.0]];

    #[test]
    fn constant_braking_stops_at_the_speed_over_it() {
        for (v, a) in [
            (10.0, 5.0),
            (13.9, 8.3),
            (1e-9, 1e3),
            (1e6, 1e-3),
            (3.0, 3.0),
        ] {
            let exact = v / a;
            for sign in [1.0, -1.0] {
                let x = CONSTANT.stop(sign * v, -sign * a);
                assert!(
                    (x / exact - 1.0).abs() <= 4.0 * f64::EPSILON,
                    "{v}, {a}: {x}"
                );
            }
            // faster and faster
            assert_eq!(CONSTANT.stop(v, a), 0.0);
        }
        assert_eq!(CONSTANT.stop(3.0, 0.0), 0.0);
        assert_eq!(CONSTANT.stop(0.0, -2.0), 0.0);
        assert_eq!(CONSTANT.stop(0.0, 0.0), 0.0);
        assert!(CONSTANT.stop(f64::NAN, -1.0).is_nan());
        assert!(CONSTANT.stop(1.0, f64::INFINITY).is_nan());
    }

    #[test]
    fn a_trapezoid_is_integrated() {
        for beyond in [Extrapolate::Hold, Extrapolate::Linear, Extrapolate::Error] {
            let pulse = lines(TRAPEZOID, beyond);
            // on the ramp 2x², on the top 2 + 4 (x − 1), on the way down 12 − 2 (4 − x)²
            for (v, exact) in [
                (1.28, 0.8),
                (2.0, 1.0),
                (6.0, 2.0),
                (10.0, 3.0),
                (11.5, 3.5),
            ] {
                let x = pulse.stop(v, -1.0);
                assert!((x - exact).abs() <= 8.0 * f64::EPSILON * exact, "{v}: {x}");
            }
            // more than the whole area
            assert_eq!(pulse.stop(12.5, -1.0), 0.0);
            // exactly the whole area: it stops at the last point, where the pulse ends
            assert_eq!(pulse.stop(12.0, -1.0), 4.0);
            assert_eq!(pulse.stop(12.0 * (1.0 + f64::EPSILON), -1.0), 4.0);
            assert_eq!(pulse.stop(1.2, -0.1), 4.0);
        }
        // Beyond the last point the line goes on below 0, so v rises again: nothing stops
        let goes_on = lines(TRAPEZOID, Extrapolate::Linear);
        assert_eq!(goes_on.stop(13.0, -1.0), 0.0);
        // and in the other direction: from −13 it goes up to −1, and then down
        assert_eq!(goes_on.stop(-13.0, 1.0), 0.0);
        // a push forward, and the line beyond brakes: 12 + 1 = 2 (x − 4)²
        let x = goes_on.stop(1.0, 1.0);
        assert!(
            (x - 4.0 - 6.5f64.sqrt()).abs() <= 8.0 * f64::EPSILON * x,
            "{x}"
        );
    }

    #[test]
    fn what_touches_0_stops_there() {
        // brakes until 1, where the acceleration changes its sign inside a piece
        let turns = lines([[0.0, -1.0], [2.0, 1.0]], Extrapolate::Hold);
        // v = v₀ − x + x²/2, lowest at 1 with v₀ − 1/2
        assert_eq!(turns.stop(0.5, 1.0), 1.0);
        assert_eq!(turns.stop(0.5 * (1.0 + 4.0 * f64::EPSILON), 1.0), 1.0);
        assert_eq!(turns.stop(0.51, 1.0), 0.0);
        let x = turns.stop(0.48, 1.0);
        assert!((x - 0.8).abs() <= 1e-15, "{x}");
        // a place of turning back has no derivatives
        let x = turns.stop(Dual::variable(0.5), Dual::constant(1.0));
        assert_eq!((x.value, x.slope), (1.0, 0.0));
        // at a point of the curve
        let at_point = lines([[0.0, -1.0], [1.0, 0.0], [2.0, 3.0]], Extrapolate::Hold);
        assert_eq!(at_point.stop(0.5, 1.0), 1.0);
        assert_eq!(at_point.stop(0.5 - 1e-16, 1.0), 1.0);
    }

    #[test]
    fn what_starts_at_rest_stops_when_it_comes_back_to_it() {
        // 0 until 1, then up and down by an area of 1 each, and once more
        let there_and_back = lines(
            [
                [0.0, 0.0],
                [1.0, 0.0],
                [2.0, 1.0],
                [4.0, -1.0],
                [5.0, 0.0],
                [6.0, 1.0],
            ],
            Extrapolate::Hold,
        );
        assert_eq!(there_and_back.stop(0.0, 1.0), 5.0);
        assert_eq!(there_and_back.stop(0.0, -0.3), 5.0);
        // slightly faster: never, until the line beyond would have braked it
        assert_eq!(there_and_back.stop(0.1, 1.0), 0.0);
        // slightly the other way: on the ramp, x − 1 = √0.2
        let x = there_and_back.stop(-0.1, 1.0);
        assert!((x - 1.0 - 0.2f64.sqrt()).abs() <= 1e-15, "{x}");
    }

    #[test]
    fn curves_that_begin_before_or_after_the_start_count_from_0() {
        let early = lines(
            [[-10.0, 3.0], [-1.0, -2.0], [9.0, -2.0]],
            Extrapolate::Error,
        );
        let x = early.stop(5.0, 1.0);
        assert!((x - 2.5).abs() <= 64.0 * f64::EPSILON, "{x}");
        assert_eq!(early.stop(50.0, 1.0), 0.0);
        let late = [[1.0, -2.0], [2.0, -4.0]];
        // held: 2 x; as a line −2 x: v₀ − x²
        let x = lines(late, Extrapolate::Hold).stop(1.0, 1.0);
        assert!((x - 0.5).abs() <= 4.0 * f64::EPSILON, "{x}");
        let x = lines(late, Extrapolate::Linear).stop(0.25, 1.0);
        assert!((x - 0.5).abs() <= 4.0 * f64::EPSILON, "{x}");
        let x = lines(late, Extrapolate::Linear).stop(9.0, 1.0);
        assert!((x - 3.0).abs() <= 16.0 * f64::EPSILON, "{x}");
        assert_eq!(lines(late, Extrapolate::Error).stop(1.0, 1.0), 0.0);
    }

    #[test]
    fn cubics_are_solved_as_quartics() {
        // −4 x³ + 3 x² … by its Hermite form: y = x² (3 − 2x), slope 0 at both ends, then held at 1
        let smooth = Cubic::new([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], Extrapolate::Hold);
        // ∫ = x³ − x⁴/2
        for x in [0.1f64, 0.4, 0.9, 1.0] {
            let v = x * x * x * (1.0 - x / 2.0);
            let found = smooth.stop(2.0 * v, -2.0);
            assert!((found - x).abs() <= 64.0 * f64::EPSILON, "{x}: {found}");
        }
        let found = smooth.stop(2.5, -1.0);
        assert!((found - 3.0).abs() <= 8.0 * f64::EPSILON, "{found}");
    }

    #[test]
    fn derivatives_are_those_of_the_root() {
        // v₀ = a x²/2 on a ramp: x = √(2 v₀/a), dx/dv₀ = x/2v₀, dx/da = −x/2a
        let ramp = lines([[0.0, 0.0], [9.0, 9.0]], Extrapolate::Linear);
        for (v, a) in [(2.0, 1.0), (3.0, 0.7), (70.0, 0.3f64)] {
            let exact = (2.0 * v / a).sqrt();
            let by_speed = ramp.stop(Dual::variable(v), Dual::constant(-a));
            let by_braking = ramp.stop(Dual::constant(v), -Dual::variable(a));
            for (found, slope) in [
                (by_speed, exact / (2.0 * v)),
                (by_braking, -exact / (2.0 * a)),
            ] {
                assert!((found.value / exact - 1.0).abs() <= 8.0 * f64::EPSILON);
                assert!((found.slope / slope - 1.0).abs() <= 16.0 * f64::EPSILON);
            }
            // the second derivative by v₀: −x/4v₀²
            let twice = Dual {
                value: Dual::variable(v),
                slope: Dual::constant(1.0),
            };
            let found = ramp.stop(twice, Dual::constant(Dual::constant(-a)));
            let bend = -exact / (4.0 * v * v);
            assert!((found.slope.slope / bend - 1.0).abs() <= 64.0 * f64::EPSILON);
        }
        let never = CONSTANT.stop(Dual::variable(1.0), Dual::constant(1.0));
        assert_eq!((never.value, never.slope), (0.0, 0.0));
    }

    #[test]
    fn more_digits_than_a_double_s_are_found() {
        let c = DoubleDouble::from_f64;
        let x = CONSTANT.stop(c(1.0), c(-3.0));
        assert!((c(3.0) * x - c(1.0)).to_f64().abs() <= f64::EPSILON * f64::EPSILON);
        let ramp = lines([[0.0, 0.0], [9.0, 9.0]], Extrapolate::Linear);
        let x = ramp.stop(c(3.0), c(-1.0));
        assert!((x * x - c(6.0)).to_f64().abs() <= 16.0 * f64::EPSILON * f64::EPSILON);
    }

    #[test]
    fn each_lane_has_its_own() {
        let pulse = lines(TRAPEZOID, Extrapolate::Error);
        let found = pulse.stop(Pair([6.0, 20.0]), Pair([-1.0; 2]));
        assert_eq!(found, Pair([pulse.stop(6.0, -1.0), 0.0]));
        let found = pulse.stop(Pair([12.0, 1.28]), Pair([-1.0; 2]));
        assert_eq!(found, Pair([4.0, pulse.stop(1.28, -1.0)]));
        let found = pulse.stop(Pair([f64::NAN, 1.28]), Pair([-1.0; 2]));
        assert!(found.0[0].is_nan() && found.0[1] == pulse.stop(1.28, -1.0));
    }

    /// Random curves against a scan: nothing is 0 before, and it is 0 there.
    #[test]
    fn random_curves_reach_0_there_and_not_before() {
        let mut seed = 1u64;
        let mut random = |low: f64, high: f64| {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut stopped = 0;
        for round in 0..3000 {
            let mut points = [[random(-1.0, 1.0), random(-2.0, 2.0)]; 6];
            for k in 1..6 {
                points[k] = [points[k - 1][0] + random(0.05, 1.0), random(-2.0, 2.0)];
            }
            let beyond = [Extrapolate::Hold, Extrapolate::Linear, Extrapolate::Error][round % 3];
            let velocity = random(-1.5, 1.5);
            let factor = random(-2.0, 2.0);
            // slopes of 0 keep cubics monotone
            let flat = points.map(|[x, y]| [x, y, 0.0]);
            let (curve, cubic) = (Curve::new(points, beyond), Cubic::new(flat, beyond));
            let smooth = round % 2 == 1;
            let at = |x: f64| {
                let integral = if smooth {
                    cubic.integral(x)
                } else {
                    curve.integral(x)
                };
                velocity + factor * integral
            };
            let x = match smooth {
                true => cubic.stop(velocity, factor),
                false => curve.stop(velocity, factor),
            };
            assert!(x >= 0.0 && x.is_finite(), "{round}: {x}");
            stopped += usize::from(x > 0.0);
            let until = if x > 0.0 { x } else { 8.0 };
            for i in 0..4000 {
                let before = until * f64::from(i) / 4000.0;
                let v = at(before);
                let same = v * velocity > 0.0 || v.is_nan() || v.abs() < 1e-13;
                assert!(same, "{round}: {v} at {before} before {x}");
            }
            if x > 0.0 {
                assert!(at(x).abs() <= 1e-13, "{round}: {} at {x}", at(x));
            }
        }
        assert!((1000..2900).contains(&stopped), "{stopped}");
    }
}
