//! Estimates the error of fixed steps along with a run, the same for a single run and for a lane.
//!
//! Along with the run u, a second solution w is integrated by the same method in steps half as long. It begins as the
//! run does, and each pair of its steps covers one step of the run. Where the motion is smooth, the error of a method
//! of order p is proportional to the power p of the step, and
//!
//! e = (u − w) 2^p/(2^p − 1)
//!
//! is the error of the run, up to terms of the next order (Richardson's extrapolation of the whole run: E. Hairer, S.
//! P. Nørsett & G. Wanner, *Solving ODEs I*, II.4 and II.8). Where the motion is not smooth, or the steps are long, w
//! is still the better of both solutions, and e has the size of the error. A motion that dies out in the run dies out
//! in w, too. A step above the limit of stability exceeds it less, or not at all, at half its length.
//!
//! The estimate does not use the interpolant of the step: for methods of order 5 or more, the interpolant has an error
//! of the same power of the step as the end of the step, so the integral of the rates over it does not reveal the
//! error. On an oscillator that integral equals the step of `tsit5` itself, but for rounding.
//!
//! The estimate takes the evaluations of two steps. Each switch, stop or turn of a hysteresis in w is taken at the time
//! at which the run met it.

use super::account::Gap;
use crate::integrate::control::Tolerances;
use crate::{Info, StateKind};

/// Allowed error of an entry of the state, over the share of energy that may be missing: 5 % if that share is 2 %. This
/// is half of what the check of a run with a user's own step accepts, so an estimate that is right within a factor of
/// two reports all that is beyond.
const OFF: f64 = 2.5;

/// The error of a method of this order over the difference of its results in full and half steps: 2^p/(2^p − 1).
pub(crate) fn over_halves(order: u32) -> f64 {
    let power = f64::from(1_u32 << order);
    power / (power - 1.0)
}

/// An entry of the state at the end of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimated {
    /// The value of a velocity; the distance of a coordinate from its start.
    pub size: f64,
    /// The estimated error.
    pub error: f64,
}

/// Errors of velocities, angular velocities, positions and angles, beside the largest value of each kind so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Errors {
    /// Share of the energy that may be missing; +∞ for any.
    limit: f64,
    gaps: [Gap; 4],
    largest: [f64; 4],
    /// The entry of the state with the largest error when an error began to be too large.
    worst: usize,
}

impl Errors {
    /// Errors before a run, with the share of energy that may be missing.
    pub fn new(limit: f64) -> Self {
        // values below their absolute tolerance are not judged
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

    /// Takes the estimates for all coordinates and velocities at the end of a step that began at `t`.
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

    /// The time since which an entry of the state has too large an error \[s\], and the entry with the largest error at
    /// that time.
    pub fn found(&self) -> Option<(f64, usize)> {
        let since = self.gaps.iter().filter_map(|gap| gap.since);
        let since = since.min_by(f64::total_cmp)?;
        Some((since, self.worst))
    }
}
