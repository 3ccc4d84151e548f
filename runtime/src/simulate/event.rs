//! Where in a step a guard changes its sign.
//!
//! A step that was accepted is searched for the first time at which a guard, in any lane, has another sign than at its
//! beginning: the root of φ(θ) = max −sign(g(0)) g(θ), negative before it, on the step's interpolant. The step then ends there,
//! just behind the change, so that the next one begins on the other side and does not find the same change again. A guard
//! that changes its sign twice within one step is not seen.

use crate::integrate::embedded::Step;
use crate::{Model, Real, Vector};

/// Width of the bracket, in steps, at which the root is found: the time of an event then errs by less than the step does.
const WIDTH: f64 = 1e-13;
/// Iterations at most; bisection alone needs 44 for that width.
const ITERATIONS: u32 = 100;

/// The fraction of a step, in 0..=1, just behind the first change of sign; `None` where all guards at its end have the
/// signs of its beginning. `before` are the guards there.
///
/// Regula falsi with the Illinois modification (Dowell & Jarratt, BIT 11, 1971), and a bisection wherever two
/// iterations have not halved the bracket.
#[inline(always)]
pub fn first_change<T: Real, M: Model<T>>(
    model: &M,
    step: &Step<M::State>,
    before: &M::Guards,
) -> Option<f64> {
    let at = |theta: f64| {
        let mut y = step.interpolate(theta);
        model.normalize(&mut y);
        change(
            before,
            &model.guards(T::from_f64(step.t + theta * step.h), &y),
        )
    };
    let (mut same, mut other) = (0.0, 1.0);
    let (mut below, mut above) = (change(before, before), at(1.0));
    if above.is_nan() || above <= 0.0 {
        return None;
    }
    let (mut last_above, mut width) = (None, 1.0);
    for i in 0..ITERATIONS {
        if other - same <= WIDTH {
            break;
        }
        let slow = i % 2 == 1 && {
            let slow = other - same > 0.5 * width;
            width = other - same;
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
    Some(other)
}

/// Positive where a guard has changed its sign in any lane; 0 counts as positive before, as unchanged after.
#[inline(always)]
fn change<T: Real, G: Vector<T>>(before: &G, after: &G) -> f64 {
    let zero = T::from_f64(0.0);
    (0..G::LEN).fold(f64::NEG_INFINITY, |worst, i| {
        let opposite = T::select(before[i].lt(zero), after[i], -after[i]);
        worst.max(opposite.to_f64())
    })
}
