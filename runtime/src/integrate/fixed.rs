//! One step of the classical method of order 4.

use super::tableau::kutta::{A, B, C};
use super::{Evaluator, NotFinite, combine, first_non_finite};
use crate::{Model, Real};

/// The state a step `h` after (`t`, `y`): four evaluations, local error O(h⁵).
#[inline(always)]
pub(crate) fn step<T: Real, M: Model<T>>(
    f: &mut Evaluator<'_, M>,
    t: f64,
    y: &M::State,
    h: f64,
) -> M::State {
    let k1 = f.at(t, y);
    let k2 = f.at(t + C[1] * h, &combine(y, h, [A[0][0]], [&k1]));
    let k3 = f.at(t + C[2] * h, &combine(y, h, [A[1][1]], [&k2]));
    let k4 = f.at(t + C[3] * h, &combine(y, h, [A[2][2]], [&k3]));
    combine(y, h, B, [&k1, &k2, &k3, &k4])
}

/// The state a step `h` after (`t`, `y`), for a caller with a time loop of its own; put it back on its manifold with
/// [`Model::normalize`].
#[inline(always)]
pub fn kutta_step<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State, h: f64) -> M::State {
    step(&mut Evaluator::new(model), t, y, h)
}

/// The first stage of that step that is not finite.
#[cold]
pub(crate) fn not_finite<T: Real, M: Model<T>>(
    f: &mut Evaluator<'_, M>,
    t: f64,
    y: &M::State,
    h: f64,
) -> Option<NotFinite<M::State>> {
    let mut stage_state = *y;
    for stage in 0..4 {
        let t = t + C[stage] * h;
        let y_stage = stage_state;
        let found = |index, in_derivative| NotFinite {
            t,
            y: y_stage,
            index,
            in_derivative,
        };
        if let Some(index) = first_non_finite(&y_stage) {
            return Some(found(index, false));
        }
        let k = f.at(t, &y_stage);
        if let Some(index) = first_non_finite(&k) {
            return Some(found(index, true));
        }
        if stage < 3 {
            stage_state = combine(y, h, [A[stage][stage]], [&k]);
        }
    }
    None
}
