//! Where in a step a guard or a kink changes its sign.
//!
//! A step is searched for the first time at which one of some functions, in any lane, has another sign than at its beginning:
//! the root of φ(θ) = max −sign(g(0)) g(θ), negative before it, on the step's interpolant. A function that changes its sign
//! twice within one step shows nothing of it at the end; [`hidden`] looks for such.

use super::once;
use crate::integrate::Stepper;
use crate::{Model, Real, Vector};

/// Iterations at most; bisection alone needs 44 for a width of 10⁻¹³.
const ITERATIONS: u32 = 100;

/// The fraction of a step, in 0..=1, just behind the first change of sign of what `functions` gives at a time and a state, to
/// within `width`. At least one of them has changed the sign at its end that it had at its beginning, which is that of `before`.
/// After [`Stepper::complete`].
///
/// Regula falsi with the Illinois modification (Dowell & Jarratt, BIT 11, 1971), and a bisection wherever two
/// iterations have not halved the bracket.
#[inline(always)]
pub(super) fn first_change<T: Real, M: Model<T>, S: Stepper<T, M>, G: Vector<T>>(
    model: &M,
    step: &S,
    functions: impl Fn(f64, &M::State) -> G,
    before: &G,
    zero: Zero,
    width: f64,
) -> f64 {
    let span = step.span();
    let at = |theta: f64| {
        let y = once::inside(model, step, theta);
        change(zero, before, &functions(span.t + theta * span.h, &y))
    };
    let (mut same, mut other) = (0.0, 1.0);
    let (mut below, mut above) = (change(zero, before, before), at(1.0).max(f64::MIN_POSITIVE));
    let (mut last_above, mut bracket) = (None, 1.0);
    for i in 0..ITERATIONS {
        if other - same <= width {
            break;
        }
        let slow = i % 2 == 1 && {
            let slow = other - same > 0.5 * bracket;
            bracket = other - same;
            slow
        };
        let guess = same + (other - same) * (below / (below - above));
        let theta = if slow || !(same < guess && guess < other) {
            0.5 * (same + other)
        } else {
            guess
        };
        let value = at(theta);
        if value > 0.0 {
            (other, above) = (theta, value);
            if last_above == Some(true) {
                below *= 0.5;
            }
            last_above = Some(true);
        } else {
            (same, below) = (theta, value.min(0.0));
            if last_above == Some(false) {
                above *= 0.5;
            }
            last_above = Some(false);
        }
    }
    other
}

/// What begins a trifle inside a contact, goes at least so many times deeper, and leaves it within one step, is looked at.
const DEEPER: f64 = 4.0;

/// The fraction of a step at which a function is farthest on the other side of zero, though at the end it has the sign of the
/// beginning: a ball in free flight, whose parabola is integrated without error in steps of any length, would fly into a wall and out
/// again in one of them. The functions are looked at in three places within the step, and where parabolas through
/// neighbouring values have their vertex. After [`Stepper::complete`].
#[inline(always)]
pub(super) fn hidden<T: Real, M: Model<T>, S: Stepper<T, M>, G: Vector<T>>(
    model: &M,
    step: &S,
    functions: impl Fn(f64, &M::State) -> G,
    before: &G,
    zero: Zero,
) -> Option<f64> {
    let span = step.span();
    let at = |theta: f64| {
        let y = once::inside(model, step, theta);
        functions(span.t + theta * span.h, &y)
    };
    let places = [0.25, 0.5, 0.75, 1.0].map(at);
    for i in 0..G::LEN {
        let at_place = |k: usize| match k {
            0 => opposite(zero, before[i], before[i]),
            k => opposite(zero, before[i], places[k - 1][i]),
        };
        let values = [0, 1, 2, 3, 4].map(at_place);
        // What is on the other side in the end is seen there, but not how deep it was on this one.
        let seen = values[4] > 0.0;
        let matters = |value: f64| match seen {
            true => values[0] < 0.0 && value < DEEPER * values[0],
            false => value > 0.0,
        };
        for k in 1..4 {
            let theta = 0.25 * k as f64;
            let (left, middle, right) = (values[k - 1], values[k], values[k + 1]);
            if matters(middle) {
                return Some(theta);
            }
            let bend = left - 2.0 * middle + right;
            let slope = 0.5 * (right - left);
            let turns = if seen { bend > 0.0 } else { bend < 0.0 };
            // an extremum between the neighbours of the middle
            if turns && slope.abs() <= bend.abs() && matters(middle - 0.5 * slope * slope / bend) {
                let vertex = theta - 0.25 * slope / bend;
                if matters(opposite(zero, before[i], at(vertex)[i])) {
                    return Some(vertex);
                }
            }
        }
    }
    None
}

/// What 0 at the beginning of a step means; at its end it is always no change yet.
#[derive(Clone, Copy)]
pub(crate) enum Zero {
    /// Positive: a guard may rest there, and what comes of it is decided by what it becomes.
    Positive,
    /// Neither: a step that begins on a kink and leaves it has a first stage on one side and the others on the other.
    Neither,
}

/// Positive where a function has changed its sign in any lane.
#[inline(always)]
fn change<T: Real, G: Vector<T>>(zero: Zero, before: &G, after: &G) -> f64 {
    (0..G::LEN).fold(f64::NEG_INFINITY, |worst, i| {
        worst.max(opposite(zero, before[i], after[i]))
    })
}

#[inline(always)]
fn opposite<T: Real>(zero: Zero, before: T, after: T) -> f64 {
    let nought = T::from_f64(0.0);
    let otherwise = match zero {
        Zero::Positive => -after,
        Zero::Neither => T::select(nought.lt(before), -after, after.abs()),
    };
    T::select(before.lt(nought), after, otherwise).to_f64()
}

/// The first function that has changed its sign in any lane.
#[inline(always)]
pub(super) fn changed<T: Real, G: Vector<T>>(zero: Zero, before: &G, after: &G) -> Option<usize> {
    (0..G::LEN).find(|&i| opposite(zero, before[i], after[i]) > 0.0)
}
