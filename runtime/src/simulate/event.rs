//! Where in a step a guard changes its sign: by bisection of the step's interpolant.
//!
//! A step that was accepted is searched for the first time at which any guard has another sign than at its beginning. The step
//! then ends there, just behind the change, so that the next one begins on the other side and does not find the same
//! change again. A guard that changes its sign twice within one step is not seen.

use crate::integrate::embedded::Step;
use crate::{Mask, Model, Real, Vector};

/// Halvings of a step: its start and end are then as close as rounding lets them be told apart.
const HALVINGS: u32 = 48;

/// The fraction of a step, in 0..=1, at which the first guard changed its sign, and the index of that guard; `None` where
/// all guards at its end have the signs of its beginning. `before` are the guards there.
#[inline(always)]
pub fn first_change<T: Real, M: Model<T>>(
    model: &M,
    step: &Step<M::State>,
    before: &M::Guards,
) -> Option<(f64, usize)> {
    let at = |theta: f64| {
        let mut y = step.interpolate(theta);
        model.normalize(&mut y);
        model.guards(T::from_f64(step.t + theta * step.h), &y)
    };
    changed(before, &at(1.0))?;
    let (mut same, mut other) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (same + other);
        if changed(before, &at(middle)).is_some() {
            other = middle;
        } else {
            same = middle;
        }
    }
    changed(before, &at(other)).map(|guard| (other, guard))
}

/// The first guard of which any lane has changed its sign; 0 has the sign of what is positive.
#[inline(always)]
fn changed<T: Real, G: Vector<T>>(before: &G, after: &G) -> Option<usize> {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let sign = |x: T| T::select(x.lt(zero), -one, one);
    (0..G::LEN).find(|&i| (sign(before[i]) * sign(after[i])).lt(zero).any())
}
