//! How far fixed steps err, estimated along with them, the same for a single run and for a lane.
//!
//! Beside the run u goes a second solution w, by the same method in steps half as long. It begins as the run did, and each of its pairs of steps covers
//! one step of the run. Where the motion is smooth, a method of order p errs like the power p of the step, and
//!
//! e = (u − w) 2^p/(2^p − 1)
//!
//! is the error of the run, up to terms of the next order (Richardson's extrapolation of the whole run: E. Hairer, S. P. Nørsett & G. Wanner, *Solving
//! ODEs I*, II.4 and II.8). Where it is not smooth, or the steps are long, w is still the better solution of both, and e is as large as the error. A motion
//! that dies out in the run dies out in w, too. A step that is above the limit of stability is less so at half its length.
//!
//! The interpolant of the step takes no part in it. Of a method of order 5 or more it errs in the same power of the step as its end, so that the integral
//! of the rates on it does not tell the error: on an oscillator that integral is the step of `tsit5` itself, but for rounding.
//!
//! It takes the evaluations of two steps. Each switch, stop or turn of a hysteresis is taken at the time at which the run met it.

use super::account::Gap;
use crate::integrate::control::Tolerances;
use crate::{Info, StateKind};

/// How far an entry of the state may be off, over the share of energy that may be missing: 5 % where that is 2 %. That is half of what the check of a
/// run with a step of one's own lets pass, so that an estimate that is right within a factor of two tells whatever is beyond.
const OFF: f64 = 2.5;

/// What the error of a method of this order is over the difference of its results in steps of some length and of half of it: 2^p/(2^p − 1).
pub(crate) fn over_halves(order: u32) -> f64 {
    let power = f64::from(1_u32 << order);
    power / (power - 1.0)
}

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
