//! Where in a step a guard or a kink changes its sign, in each lane: as [`crate::simulate`] looks for it in a single run, with
//! selections in place of branches.

use super::step::Step;
use crate::real::{Mask, Several};
use crate::simulate::Zero;
use crate::simulate::excursion::Excursion;
use crate::simulate::standing::WIDTH;
use crate::{Dynamics, Real};

/// Iterations at most; bisection alone needs 44 for the width.
const ITERATIONS: u32 = 100;
/// The fraction of a step within which an event is found.
pub const fn width<T: Several>() -> f64 {
    if T::EPSILON > WIDTH {
        T::EPSILON
    } else {
        WIDTH
    }
}

/// Half of the distance over which the rate of a guard is taken, as a part of the step: the error is of its square, and of rounding
/// over it.
const APART: f64 = 1e-4;

/// Positive where a function has not the sign that it had.
#[inline(always)]
pub fn opposite<T: Real>(zero: Zero, before: T, after: T) -> T {
    let nought = T::from_f64(0.0);
    let otherwise = match zero {
        Zero::Positive => -after,
        Zero::Neither => T::select(nought.lt(before), -after, after.abs()),
    };
    T::select(before.lt(nought), after, otherwise)
}

/// The largest of [`opposite`] over all functions, positive where one of them has changed its sign.
#[inline(always)]
fn change<T: Several>(zero: Zero, before: &[T], after: &[T]) -> T {
    let mut worst = T::from_f64(f64::NEG_INFINITY);
    for (before, after) in before.iter().zip(after) {
        worst = worst.max(opposite(zero, *before, *after));
    }
    worst
}

/// Where one of the functions has changed its sign.
#[inline(always)]
pub fn changed<T: Several>(zero: Zero, before: &[T], after: &[T]) -> T::Mask {
    T::from_f64(0.0).lt(change(zero, before, after))
}

/// The functions of a model whose signs matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Functions {
    /// [`Dynamics::guards`]
    Guards,
    /// [`Dynamics::kinks`]
    Kinks,
}

impl Functions {
    /// Their values at a time \[s\] and a state.
    #[inline(always)]
    pub fn evaluate<T: Real>(self, model: &dyn Dynamics<T>, t: T, y: &[T], values: &mut [T]) {
        match self {
            Functions::Guards => model.guards(t, y, values),
            Functions::Kinks => model.kinks(t, y, values),
        }
    }

    /// The sign of a zero of theirs.
    pub const fn zero(self) -> Zero {
        match self {
            Functions::Guards => Zero::Positive,
            Functions::Kinks => Zero::Neither,
        }
    }
}

/// Evaluates functions of a model within a step.
pub struct Probe<'a, T> {
    pub model: &'a dyn Dynamics<T>,
    pub step: &'a Step<T>,
    pub functions: Functions,
    /// Room for a state.
    pub state: &'a mut [T],
    /// Room for the values, as many as there are functions.
    pub values: &'a mut [T],
}

impl<T: Several> Probe<'_, T> {
    /// The values at t + θh.
    #[inline(always)]
    fn at(&mut self, theta: T) {
        self.step.inside(self.model, theta, self.state);
        let t = theta * self.step.h + self.step.t;
        self.functions
            .evaluate(self.model, t, self.state, self.values);
    }

    /// [`change`] at t + θh.
    #[inline(always)]
    fn change(&mut self, before: &[T], theta: T) -> T {
        self.at(theta);
        change(self.functions.zero(), before, self.values)
    }
}

/// Fractions of a step on both sides of a change of sign, no further apart than can be told, with the derivative of when that is.
#[derive(Clone, Copy)]
pub struct Sides<T> {
    pub ahead: T,
    pub behind: T,
}

/// The fractions of the step around the first change of sign of the functions in the lanes `wanted`, where it has happened at `end`; 1 in the
/// others. It iterates as `first_change` of a single run does.
#[inline(always)]
pub fn first_change<T: Several>(
    probe: &mut Probe<'_, T>,
    before: &[T],
    wanted: T::Mask,
    end: T::Part,
) -> Sides<T> {
    let c = T::Part::from_f64;
    let (nought, one) = (c(0.0), c(1.0));
    let (mut same, mut other) = (nought, end);
    let mut below: T::Part = change(probe.functions.zero(), before, before).part(0);
    let mut above = probe.change(before, T::of_part(end)).part(0);
    above = above.max(c(f64::MIN_POSITIVE));
    let none = T::Mask::of_lanes(0);
    let (mut was_above, mut was_below) = (none, none);
    let mut bracket = end;
    for i in 0..ITERATIONS {
        let open = wanted.and(c(width::<T>()).lt(other - same));
        if !open.any() {
            break;
        }
        let odd = i % 2 == 1;
        let slow = match odd {
            true => (c(0.5) * bracket).lt(other - same),
            false => none,
        };
        if odd {
            bracket = T::Part::select(open, other - same, bracket);
        }
        let guess = same + (other - same) * (below / (below - above));
        let good = same.lt(guess).and(guess.lt(other)).and(slow.not());
        let theta = T::Part::select(good, guess, c(0.5) * (same + other));
        let value = probe.change(before, T::of_part(theta)).part(0);

        let behind = open.and(nought.lt(value));
        let ahead = open.and(nought.lt(value).not());
        other = T::Part::select(behind, theta, other);
        above = T::Part::select(behind, value, above);
        below = T::Part::select(behind.and(was_above), c(0.5) * below, below);
        same = T::Part::select(ahead, theta, same);
        let again = ahead.and(was_below);
        below = T::Part::select(ahead, value.min(nought), below);
        above = T::Part::select(again, c(0.5) * above, above);
        was_above = was_above.and(open.not()).or(behind);
        was_below = was_below.and(open.not()).or(ahead);
    }
    let found = T::Part::select(wanted, other, one);
    let between = T::of_part(T::Part::select(wanted, other - same, nought));
    if T::PARTS == 1 {
        let behind = T::of_part(found);
        return Sides {
            ahead: behind - between,
            behind,
        };
    }
    // g(θ, p) = 0 on the way: dθ/dp = −∂g/∂p / ∂g/∂θ
    let there = probe.change(before, T::of_part(found));
    let (left, right) = ((found - c(APART)).max(nought), (found + c(APART)).min(one));
    let to_the_right = probe.change(before, T::of_part(right)).part(0);
    let to_the_left = probe.change(before, T::of_part(left)).part(0);
    let rate = (to_the_right - to_the_left) / (right - left);
    let moves = wanted.and(nought.lt(rate.abs()));
    let rate = T::Part::select(moves, rate, one);
    let shift = (there - there.frozen()) / T::of_part(rate);
    let behind = T::select(moves, T::of_part(found) - shift, T::of_part(found));
    Sides {
        ahead: behind - between,
        behind,
    }
}

/// What begins a trifle inside a contact, goes at least so many times deeper, and leaves it within one step, is looked at.
const DEEPER: f64 = 4.0;

/// How far a function is on the other side of zero, at five places of a step.
#[derive(Clone, Copy)]
struct Course<P>([P; 5]);

impl<P: Real> Course<P> {
    /// Where it is on the other side at the end: it is seen there, but not how deep it was on this one.
    #[inline(always)]
    fn seen(&self) -> P::Mask {
        P::from_f64(0.0).lt(self.0[4])
    }

    /// Where such a value would be worth a look.
    #[inline(always)]
    fn matters(&self, value: P) -> P::Mask {
        let nought = P::from_f64(0.0);
        let deep = self.0[0]
            .lt(nought)
            .and(value.lt(P::from_f64(DEEPER) * self.0[0]));
        let seen = self.seen();
        seen.and(deep).or(seen.not().and(nought.lt(value)))
    }

    /// Where it may be worth a look at all, told by few operations: no vertex between the neighbours of a place is farther from its value
    /// than half of what the parabola bends by.
    #[inline(always)]
    fn likely(&self) -> P::Mask {
        let half = P::from_f64(0.5);
        let (mut highest, mut lowest) = (self.0[2], self.0[2]);
        for k in 1..4 {
            let (left, middle, right) = (self.0[k - 1], self.0[k], self.0[k + 1]);
            let most = half * (left + right - (middle + middle)).abs();
            highest = highest.max(middle + most);
            lowest = lowest.min(middle - most);
        }
        let nought = P::from_f64(0.0);
        let deep = lowest.lt(P::from_f64(DEEPER) * self.0[0]);
        let deep = self.0[0].lt(nought).and(deep);
        let seen = self.seen();
        seen.and(deep).or(seen.not().and(nought.lt(highest)))
    }

    /// Of the parabola through a place within and its neighbours: where its vertex is at stake, how far that is from the middle,
    /// as a part of the distance of places.
    #[inline(always)]
    fn vertex(&self, k: usize) -> (P::Mask, P) {
        let (half, nought) = (P::from_f64(0.5), P::from_f64(0.0));
        let (left, middle, right) = (self.0[k - 1], self.0[k], self.0[k + 1]);
        let bend = left - P::from_f64(2.0) * middle + right;
        let slope = half * (right - left);
        let seen = self.seen();
        let down = seen.not().and(bend.lt(nought));
        let turns = seen.and(nought.lt(bend)).or(down);
        let within = bend.abs().lt(slope.abs()).not();
        let safe = P::select(turns, bend, P::from_f64(1.0));
        let height = middle - half * slope * slope / safe;
        (turns.and(within).and(self.matters(height)), -(slope / safe))
    }
}

/// In which of these lanes a function may have another sign within the step than at its ends, by its values at five places: all lanes in which an
/// [`Excursion`] finds anything or asks for more are among them.
#[inline(always)]
pub fn may_stray<T: Several>(zero: Zero, values: &Values<T>, lanes: u32) -> u32 {
    // searches are in doubles, and other numbers may tell otherwise
    if T::EPSILON > 1e-10 {
        return lanes;
    }
    let half = T::Part::from_f64(0.5);
    let nought = T::Part::from_f64(0.0);
    let before = values[0].part(0);
    let mut course = [nought; 5];
    for (value, place) in course.iter_mut().zip(values) {
        *value = opposite(zero, before, place.part(0));
    }
    let mut may = nought.lt(course[0]);
    for k in 1..4 {
        let (left, middle, right) = (course[k - 1], course[k], course[k + 1]);
        let bend = (right - middle) - (middle - left);
        let highest = left.max(middle).max(right);
        let low = (highest - half * bend).lt(nought);
        may = may.or(nought.lt(middle)).or(bend.lt(nought).and(low.not()));
    }
    may.lanes() & lanes
}

/// The search for a place in the step of a lane at which a function has another sign than at its ends, by its values at five places.
#[inline(always)]
pub fn excursion<T: Several>(zero: Zero, values: &Values<T>, lane: usize) -> Excursion {
    let before = values[0].lane(lane);
    let mut course = [0.0; 5];
    for (place, value) in course.iter_mut().zip(values) {
        *place = opposite(zero, before, value.lane(lane)).to_f64();
    }
    Excursion::new(course)
}

/// What one function has in five places of a step, its beginning, the ends of its quarters, and its end.
pub type Values<T> = [T; 5];

/// Where in a step the places of [`Values`] are.
pub const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// The fraction of a step at which a function is farthest on the other side of zero, though at its end nothing shows of it; +∞ where
/// there is none, and anything in lanes that are not `wanted`. It looks where `hidden` of a single run does.
#[inline(always)]
pub fn hidden<T: Several>(
    probe: &mut Probe<'_, T>,
    values: &[Values<T>],
    wanted: T::Mask,
) -> T::Part {
    let c = T::Part::from_f64;
    let zero = probe.functions.zero();
    let never = c(f64::INFINITY);
    let mut result = never;
    for (i, values) in values.iter().enumerate() {
        let before = values[0].part(0);
        let mut course = Course([never; 5]);
        for (value, place) in course.0.iter_mut().zip(values) {
            *value = opposite(zero, before, place.part(0));
        }
        if !course.likely().and(wanted).any() {
            continue;
        }
        // the first that is found counts, of this function
        let mut mine = never;
        for (k, theta) in PLACES.into_iter().enumerate().take(4).skip(1) {
            let theta = c(theta);
            let open = mine.lt(never).not();
            let deep = open.and(course.matters(course.0[k]));
            mine = T::Part::select(deep, theta, mine);
            let (at_stake, way) = course.vertex(k);
            let likely = open.and(deep.not()).and(at_stake).and(wanted);
            if likely.any() {
                let vertex = T::Part::select(likely, c(0.25).mul_add(way, theta), theta);
                probe.at(T::of_part(vertex));
                let value = opposite(zero, before, probe.values[i].part(0));
                let sure = likely.and(course.matters(value));
                mine = T::Part::select(sure, vertex, mine);
            }
        }
        result = result.min(mine);
    }
    result
}
