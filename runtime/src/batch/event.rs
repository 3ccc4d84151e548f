//! Where in a step a guard or a kink changes its sign, in each lane: as [`crate::simulate`] looks for it in a single run, with
//! selections in place of branches.

use super::step::Step;
use crate::real::{Mask, Several};
use crate::simulate::Zero;
use crate::{Model, Real, Vector};

/// Iterations at most; bisection alone needs 44 for the width.
const ITERATIONS: u32 = 100;
/// The time of an event errs by less than the step does.
const WIDTH: f64 = 1e-13;
/// Half of the distance over which the rate of a guard is taken, as a part of the step: the error is of its square, and of rounding
/// over it.
const APART: f64 = 1e-4;

/// Positive where a function has not the sign that it had.
#[inline(always)]
fn opposite<T: Real>(zero: Zero, before: T, after: T) -> T {
    let nought = T::from_f64(0.0);
    let otherwise = match zero {
        Zero::Positive => -after,
        Zero::Neither => T::select(nought.lt(before), -after, after.abs()),
    };
    T::select(before.lt(nought), after, otherwise)
}

/// The largest of [`opposite`] over all functions, positive where one of them has changed its sign.
#[inline(always)]
fn change<T: Several, G: Vector<T>>(zero: Zero, before: &G, after: &G) -> T {
    let mut worst = T::from_f64(f64::NEG_INFINITY);
    for i in 0..G::LEN {
        worst = worst.max(opposite(zero, before[i], after[i]));
    }
    worst
}

/// Where one of the functions has changed its sign.
#[inline(always)]
pub fn changed<T: Several, G: Vector<T>>(zero: Zero, before: &G, after: &G) -> T::Mask {
    T::from_f64(0.0).lt(change(zero, before, after))
}

/// The fraction of the step, in 0..=1, just behind the first change of sign of the functions in the lanes `wanted`, with the
/// derivative of that fraction; 1 in the others. It iterates as `first_change` of a single run does.
#[inline(always)]
pub fn first_change<T: Several, M: Model<T>, G: Vector<T>>(
    model: &M,
    step: &Step<T, M::State>,
    functions: impl Fn(T, &M::State) -> G,
    before: &G,
    zero: Zero,
    wanted: T::Mask,
) -> T {
    let c = T::Part::from_f64;
    let (nought, one) = (c(0.0), c(1.0));
    let at = |theta: T| {
        let y = step.inside(model, theta);
        change(zero, before, &functions(theta.mul_add(step.h, step.t), &y))
    };
    let (mut same, mut other) = (nought, one);
    let mut below: T::Part = change(zero, before, before).part(0);
    let mut above = at(T::of_part(one)).part(0).max(c(f64::MIN_POSITIVE));
    let none = T::Mask::of_lanes(0);
    let (mut was_above, mut was_below) = (none, none);
    let mut bracket = one;
    for i in 0..ITERATIONS {
        let open = wanted.and(c(WIDTH).lt(other - same));
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
        let value = at(T::of_part(theta)).part(0);

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
    if T::PARTS == 1 {
        return T::of_part(found);
    }
    // g(θ, p) = 0 on the way: dθ/dp = −∂g/∂p / ∂g/∂θ
    let there = at(T::of_part(found));
    let (left, right) = ((found - c(APART)).max(nought), (found + c(APART)).min(one));
    let rise = at(T::of_part(right)).part(0) - at(T::of_part(left)).part(0);
    let rate = rise / (right - left);
    let moves = wanted.and(nought.lt(rate.abs()));
    let rate = T::Part::select(moves, rate, one);
    let shift = (there - there.frozen()) / T::of_part(rate);
    T::select(moves, T::of_part(found) - shift, T::of_part(found))
}

/// What begins a trifle inside a contact, goes at least so many times deeper, and leaves it within one step, is looked at.
const DEEPER: f64 = 4.0;

/// The fraction of a step at which a function is farthest on the other side of zero, though at its end nothing shows of it; +∞ where
/// there is none. It looks where `hidden` of a single run does.
#[inline(always)]
pub fn hidden<T: Several, M: Model<T>, G: Vector<T>>(
    model: &M,
    step: &Step<T, M::State>,
    functions: impl Fn(T, &M::State) -> G,
    before: &G,
    zero: Zero,
) -> T::Part {
    let c = T::Part::from_f64;
    let (nought, never) = (c(0.0), c(f64::INFINITY));
    let at = |theta: T| {
        let y = step.inside(model, theta);
        functions(theta.mul_add(step.h, step.t), &y)
    };
    let places = [0.25, 0.5, 0.75, 1.0].map(|theta| at(T::from_f64(theta)));
    let mut result = never;
    for i in 0..G::LEN {
        let value = |after: T| opposite(zero, before[i].part(0), after.part(0));
        let values = [
            value(before[i]),
            value(places[0][i]),
            value(places[1][i]),
            value(places[2][i]),
            value(places[3][i]),
        ];
        let seen = nought.lt(values[4]);
        let matters = |value: T::Part| {
            let deep = values[0].lt(nought).and(value.lt(c(DEEPER) * values[0]));
            seen.and(deep).or(seen.not().and(nought.lt(value)))
        };
        // the first that is found counts, of this function
        let mut mine = never;
        for k in 1..4 {
            let theta = c(0.25 * k as f64);
            let (left, middle, right) = (values[k - 1], values[k], values[k + 1]);
            let open = never.lt(mine).or(mine.lt(never)).not();
            let deep = open.and(matters(middle));
            mine = T::Part::select(deep, theta, mine);

            let open = open.and(deep.not());
            let bend = left - c(2.0) * middle + right;
            let slope = c(0.5) * (right - left);
            let turns = seen
                .and(nought.lt(bend))
                .or(seen.not().and(bend.lt(nought)));
            let within = bend.abs().lt(slope.abs()).not();
            let safe = T::Part::select(turns, bend, c(1.0));
            let peak = matters(middle - c(0.5) * slope * slope / safe);
            let likely = open.and(turns).and(within).and(peak);
            if likely.any() {
                let vertex = theta - c(0.25) * slope / safe;
                let vertex = T::Part::select(likely, vertex, theta);
                let there = at(T::of_part(vertex));
                let sure = likely.and(matters(value(there[i])));
                mine = T::Part::select(sure, vertex, mine);
            }
        }
        result = result.min(mine);
    }
    result
}
