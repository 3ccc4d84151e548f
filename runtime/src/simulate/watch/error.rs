//! How far fixed steps err, estimated along with them, the same for a single run and for a lane.
//!
//! Let u be the interpolant of a run. What a step leaves unexplained, its *defect*
//!
//! d = u(t + h) − u(t) − ∫ f(s, u(s)) ds,
//!
//! is its own error, but for terms of the next order. Errors of earlier steps are carried on by the motion: from a solution w that began as
//! the run did, a step ψ of the same method leads to
//!
//! w⁺ = ψ(w) − d
//!
//! and e = u − w is the error of the run (Zadunaisky's idea, as *solving for the correction*: R. D. Skeel, Thirteen ways to estimate global error, Numer.
//! Math. 48, 1986). Where ψ is stable at u, it is so at w, and what dies out in the run dies out in its estimate.
//!
//! It takes the evaluations of a step once more, and three for the integral. Each switch, stop or turn of a hysteresis is taken at the time at which
//! the run met it.

use super::account::Gap;
use crate::integrate::control::Tolerances;
use crate::{Info, StateKind};

/// Places in a step, and their weights, at which rates are summed up: Gauss's rule of three points, exact for a polynomial of degree 5. It errs by
/// (h λ)⁷/2 016 000 of a motion e^(λt), less than a step of any method here but `dop853`.
pub(crate) const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How far an entry of the state may be off, over the share of energy that may be missing: 5 % where that is 2 %. That is half of what the check of a
/// run with a step of one's own lets pass, so that an estimate that is right within a factor of two, as of the methods up to order 4, tells whatever is
/// beyond.
const OFF: f64 = 2.5;

/// An entry of the state at the end of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimated {
    /// Of a velocity its value, of a coordinate its way from the start.
    pub size: f64,
    /// How far it is off.
    pub error: f64,
}

/// Errors of velocities, angular velocities, and of the coordinates of either, beside the largest of their kind so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Errors {
    /// Share of the energy that may be missing; +∞ for any.
    limit: f64,
    gaps: [Gap; 4],
    largest: [f64; 4],
    /// The entry of the state that was farthest off when one began to be too far.
    worst: usize,
}

impl Errors {
    /// Before a run, with the share of energy that may be missing.
    pub fn new(limit: f64) -> Self {
        // what is smaller than it is tolerated to err by is not judged
        let Tolerances {
            velocities,
            angular_velocities,
            positions,
            angles,
            ..
        } = Tolerances::default();
        Errors {
            limit,
            gaps: [Gap::NONE; 4],
            largest: [velocities, angular_velocities, positions, angles],
            worst: 0,
        }
    }

    /// The end of a step that began at `t`, with the estimate for each coordinate and velocity of the model.
    pub fn observe(&mut self, t: f64, info: &Info, entry: impl Fn(usize) -> Estimated) {
        let coordinates = info.coordinates.len();
        let mut worst = [(0.0, 0); 4];
        for i in 0..coordinates + info.velocities.len() {
            let Estimated { size, error } = entry(i);
            let turns = match info.kind(i) {
                StateKind::Velocity | StateKind::Position => 0,
                _ => 1,
            };
            let kind = turns + 2 * usize::from(i < coordinates);
            self.largest[kind] = self.largest[kind].max(size.abs());
            let error = error.abs();
            let error = if error.is_nan() { f64::INFINITY } else { error };
            if error > worst[kind].0 {
                worst[kind] = (error, i);
            }
        }
        for ((gap, largest), (error, index)) in self.gaps.iter_mut().zip(self.largest).zip(worst) {
            if gap.observe(t, error, OFF * self.limit * largest) {
                self.worst = index;
            }
        }
    }

    /// Since when an entry of the state is too far off \[s\], and which it was then.
    pub fn found(&self) -> Option<(f64, usize)> {
        let since = self.gaps.iter().filter_map(|gap| gap.since);
        let since = since.min_by(f64::total_cmp)?;
        Some((since, self.worst))
    }
}
