//! Controls the errors of accelerations, for single runs and lanes alike.
//!
//! A tolerance of positions does not limit errors of forces: 10 nm on a stiffness of 10⁸ N/m are 1 N. Where stability
//! limits the steps, an explicit method lets a fast oscillation grow until its error in the state is as large as
//! allowed. Without further control, its size in the accelerations would be left to chance.
//!
//! **What is compared.** Two stages of a step are at its end: its result y⁺, and a state g that is less exact. With d =
//! y⁺ − g and D = f(y⁺) − f(g), the rate of the fastest motion is λ, with λ⁴ = ‖D_q‖²‖D_v‖²/(‖d_q‖²‖d_v‖²) over
//! coordinates q and velocities v. This is exact for an oscillation, whatever its phase. An oscillation whose
//! acceleration has the amplitude A makes D_v = P(h|λ|) A, where P is a polynomial of the method.
//!
//! **What is controlled.** Let η be the h|λ| at which an undamped oscillation begins to grow by 10⁻⁵ in a step, but at
//! most π, half a period: a faster oscillation cannot be recognized from the ends of the step. Below η an oscillation
//! is a part of the motion, and is resolved as the tolerances ask. From η on it must stay below the share s of the
//! largest acceleration so far:
//!
//! x = √(|D_v|² + λ²|d_v|²) (h|λ|/η)⁸ / (P(η) s · largest) ≤ 1
//!
//! The root is the amplitude of D_v, whatever the phase. The power makes x small below η, and makes x fall like the
//! eleventh power of the step for methods of order 5. So √x is given to the controller like an error.
//!
//! **The largest acceleration.** At rest accelerations are 0, but the forces that cancel are not. So the largest
//! acceleration so far, for velocities and for angular velocities each, includes that of each effect alone. With
//! velocities ±w, all of one kind, effect i has the powers ±Q_i·w plus a part that is even in the velocities, so
//! |Q_i·w|/(w·S w) is an acceleration that the effect causes. The effects are evaluated only when a step is to be
//! rejected because of x for the first, second, fourth, eighth, … time.
//!
//! **Implicit steps** damp motions that are too fast for them, and have no two stages at their end. Instead, the slope
//! of their interpolant is compared with the derivative ([`Accelerations::share`]): the two differ by the acceleration
//! of a decay or an oscillation that is still present.
//!
//! **When shorter steps do not help.** If x is due to rounding, or to a force that jumps, shorter steps do not make it
//! smaller. If x is still more than half of its former value when the step is at most half as long, the step is
//! accepted, and accelerations are not controlled for [`ASLEEP`] steps. If the allowed error is not above [`RESOLVED`]
//! roundings of the coordinates, it cannot be guaranteed, and accelerations are not controlled.

use super::Formula;
use super::control::Roots;
use crate::real::{Mask, Number};
use crate::{Dynamics, Info, Real, StateKind};
use core::f64::consts::PI;

/// Steps for which accelerations are not controlled after a shorter step did not help.
const ASLEEP: f64 = 32.0;
/// Roundings of a state by which two results must differ, for the difference to be more than rounding.
const ROUNDINGS: f64 = 16.0;
/// Least allowed error, in roundings of the coordinates: below it the error cannot be guaranteed, and a motion that is
/// half controlled would look correct.
const RESOLVED: f64 = 300.0;

/// The h|λ| below which an implicit step resolves the fastest motion.
const RESOLVED_REACH: f64 = 0.5;
/// Factor between the allowed share and the share that the control of explicit steps reaches (see
/// [`Tolerances`](crate::Tolerances)).
const AIM: f64 = 3.0;
/// The largest share of accelerations that implicit steps may lose, whatever the tolerances: the accuracy promised for
/// outputs.
const LOST: f64 = 1e-3;

/// η and P(η) of a method; `None` for a method that has no two stages at the end of a step, or takes fixed steps only.
pub(crate) const fn limits(formula: Formula) -> Option<[f64; 2]> {
    match formula {
        Formula::Heun => Some([0.0946, 0.00447]),
        Formula::Merson => Some([PI, 2.125]),
        Formula::Dopri5 => Some([1.016, 0.241]),
        Formula::Tsit5 => Some([0.746, 0.0998]),
        Formula::Dop853 => Some([PI, 0.08283]),
        Formula::SemiImplicitEuler | Formula::Rk4 | Formula::Rodas5 => None,
    }
}

/// 0 for a velocity, 1 for an angular velocity.
#[inline(always)]
pub(crate) fn kind(info: &Info, index: usize) -> usize {
    usize::from(info.kind(index) == StateKind::AngularVelocity)
}

/// The differences of two results of a step.
pub(crate) struct EndDifference<P> {
    /// Σ d², Σ D², Σ y², of coordinates and of velocities.
    sums: [[P; 3]; 2],
    /// The largest |D_v|, the largest |d_v|, and the largest acceleration at the ends of the step, for each kind.
    accelerations: [[P; 3]; 2],
}

impl<P: Number> EndDifference<P> {
    /// No entries yet.
    #[inline(always)]
    pub fn new() -> Self {
        let nought = P::from_f64(0.0);
        EndDifference {
            sums: [[nought; 3]; 2],
            accelerations: [[nought; 3]; 2],
        }
    }

    /// Adds a coordinate, with d and D.
    #[inline(always)]
    pub fn coordinate(&mut self, y: P, [d, rate]: [P; 2]) {
        self.add(0, y, [d, rate]);
    }

    /// Adds a velocity, with d and D, and the accelerations at both ends.
    #[inline(always)]
    pub fn velocity(&mut self, kind: usize, y: P, [d, rate]: [P; 2], ends: [P; 2]) {
        self.add(1, y, [d, rate]);
        let [of_accelerations, of_velocities, largest] = &mut self.accelerations[kind];
        *of_accelerations = (*of_accelerations).max(rate.abs());
        *of_velocities = (*of_velocities).max(d.abs());
        *largest = (*largest).max(ends[0].abs()).max(ends[1].abs());
    }

    #[inline(always)]
    fn add(&mut self, of: usize, y: P, [d, rate]: [P; 2]) {
        let [apart, rates, size] = &mut self.sums[of];
        *apart = *apart + d * d;
        *rates = *rates + rate * rate;
        *size = *size + y * y;
    }

    /// (h|λ|)⁴ of a step of length `h`; 0 where the results differ by rounding alone.
    #[inline(always)]
    pub fn h_lambda_fourth(&self, h: P, epsilon: f64) -> P {
        let c = P::from_f64;
        let least = c(ROUNDINGS * ROUNDINGS * epsilon * epsilon);
        let mut product = (h * h) * (h * h);
        let mut tells = P::Mask::of_lanes(0).not();
        for [apart, rates, size] in self.sums {
            // squares of smaller differences would underflow
            tells = tells.and((least * size + c(1e-250)).lt(apart));
            product = product * (rates / P::select(tells, apart, c(1.0)));
        }
        P::select(tells.and(product.lt(c(f64::INFINITY))), product, c(0.0))
    }
}

/// The differences of two results of a step, without rounding: Σ d² and Σ D² over the entries that differ by more than
/// rounding, for coordinates, for velocities, and for continuous states of laws, which follow a first-order equation. A
/// light part has a small fast motion beside the large slow motion of its carrier, so rounding of a large entry must
/// not hide a small one.
#[derive(Default)]
pub(crate) struct Fastest([[f64; 2]; 3]);

impl Fastest {
    /// Adds an entry of size `y` of coordinates (0), velocities (1) or states of laws (2), with d and D.
    pub fn add(&mut self, group: usize, y: f64, [d, rate]: [f64; 2], epsilon: f64) {
        if d > ROUNDINGS * epsilon * y && d > 1e-125 {
            let [apart, rates] = &mut self.0[group];
            *apart += d * d;
            *rates += rate * rate;
        }
    }

    /// (h|λ|)⁴ of a step of length `h`, with |λ|² = ‖D_q‖‖D_v‖/(‖d_q‖‖d_v‖), or |λ| = ‖D‖/‖d‖ of states of laws,
    /// whichever is more; 0 where the results differ by rounding alone.
    pub fn h_lambda_fourth(&self, h: f64) -> f64 {
        let [coordinates, velocities, laws] = self.0.map(|[apart, rates]| {
            let squared = h * h * rates / apart;
            if squared.is_finite() { squared } else { 0.0 }
        });
        (coordinates * velocities).max(laws * laws)
    }
}

/// The control of accelerations in a single run or in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accelerations<P: Number> {
    /// The share of the largest acceleration by which accelerations may be wrong.
    share: f64,
    limits: Option<[f64; 2]>,
    /// The largest acceleration so far, of either kind.
    largest: [P; 2],
    /// x of the last try of this step.
    x: P,
    /// x and the length of the first try of this step that was rejected for x; of length 0 if there was none.
    before: [P; 2],
    /// Steps left for which accelerations are not controlled.
    asleep: P,
    /// How often a step was to be rejected because of x, and the count at which effects are evaluated again.
    due: P,
    next: P,
}

impl<P: Number> Accelerations<P> {
    /// The control before a run by this method, with the share of the largest acceleration that is allowed.
    pub fn new(formula: Formula, share: f64) -> Self {
        let c = P::from_f64;
        Accelerations {
            share,
            limits: limits(formula),
            largest: [c(0.0); 2],
            x: c(0.0),
            before: [c(0.0); 2],
            asleep: c(0.0),
            due: c(0.0),
            next: c(1.0),
        }
    }

    /// True if accelerations are controlled: not if they may be wrong by as much as their size.
    pub fn controlled(&self) -> bool {
        self.limits.is_some() && self.share < 1.0
    }

    /// Resets these lanes for new runs.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn reset(&mut self, lanes: P::Mask) {
        let c = P::from_f64;
        let put = |value: f64, to: &mut P| *to = P::select(lanes, c(value), *to);
        self.largest
            .iter_mut()
            .for_each(|largest| put(0.0, largest));
        put(0.0, &mut self.x);
        self.before.iter_mut().for_each(|before| put(0.0, before));
        put(0.0, &mut self.asleep);
        put(0.0, &mut self.due);
        put(1.0, &mut self.next);
    }

    /// The error of the accelerations of a step of length `h`, over what is allowed; a good step has at most 1. `level`
    /// is the factor on the tolerances.
    #[inline(always)]
    pub fn error<R: Roots<P>>(
        &mut self,
        difference: &EndDifference<P>,
        [h, level]: [P; 2],
        epsilon: f64,
    ) -> P {
        let c = P::from_f64;
        let Some([limit, polynomial]) = self.limits else {
            return c(0.0);
        };
        let fourth = c(limit * limit * limit * limit);
        let h_lambda_fourth = difference.h_lambda_fourth(h, epsilon);
        let rate_squared = R::root(h_lambda_fourth, [2, 1]) / (h * h);
        let rounding =
            c(RESOLVED * epsilon) * rate_squared * R::root(difference.sums[0][2], [2, 1]);
        let allowed = c(polynomial * self.share) * level;
        // before effects have been evaluated, the largest acceleration known may be far too small
        let unknown = self.next.lt(c(1.5));
        let mut share_squared = c(0.0);
        for (so_far, of_kind) in self.largest.iter().zip(difference.accelerations) {
            let [of_accelerations, of_velocities, here] = of_kind;
            let amplitude_squared = of_accelerations * of_accelerations
                + rate_squared * (of_velocities * of_velocities);
            let largest = so_far.max(here);
            let largest = P::select(c(0.0).lt(largest), largest, c(1.0));
            let of_kind = amplitude_squared / (largest * largest);
            let resolved = rounding.lt(allowed * largest).or(unknown);
            share_squared = share_squared.max(P::select(resolved, of_kind, c(0.0)));
        }
        let power = h_lambda_fourth / fourth;
        let share = R::root(share_squared, [2, 1]);
        let x = share * (power * power) / allowed;
        self.x = P::select(x.lt(c(f64::INFINITY)), x, c(0.0));
        let awake = c(0.0).lt(self.asleep).not();
        let counts = self.helps(h).and(awake);
        P::select(counts, R::root(self.x, [2, 1]), c(0.0))
    }

    /// True where a step of half the length made x smaller, or was not tried.
    #[inline(always)]
    fn helps(&self, h: P) -> P::Mask {
        let half = P::from_f64(0.5);
        let [x, length] = self.before;
        self.x.lt(half * x).or((half * length).lt(h))
    }

    /// The lanes, among these whose steps are to be rejected, in which the effects must be evaluated first.
    #[inline(always)]
    pub fn asks(&mut self, rejected: P::Mask) -> P::Mask {
        let c = P::from_f64;
        self.due = P::select(rejected, self.due + c(1.0), self.due);
        let asks = rejected.and(self.due.lt(self.next).not());
        self.next = P::select(asks, c(2.0) * self.next, self.next);
        asks
    }

    /// Notes the largest accelerations that effects cause in these lanes.
    #[inline(always)]
    pub fn learn(&mut self, lanes: P::Mask, found: [P; 2]) {
        for (largest, part) in self.largest.iter_mut().zip(found) {
            let more = lanes
                .and(largest.lt(part))
                .and(part.lt(P::from_f64(f64::INFINITY)));
            *largest = P::select(more, part, *largest);
        }
    }

    /// Forgets the largest accelerations.
    pub fn forget(&mut self) {
        let c = P::from_f64;
        (self.largest, self.next) = ([c(0.0); 2], c(1.0));
        self.due = c(0.0);
    }

    /// Notes accelerations that occurred.
    pub fn see(&mut self, found: [P; 2]) {
        self.learn(P::Mask::of_lanes(0).not(), found);
    }

    /// Finishes a try of a step of length `h`: where it was `accepted`, and where it was `rejected` because of x.
    #[inline(always)]
    pub fn leave(
        &mut self,
        difference: &EndDifference<P>,
        h: P,
        accepted: P::Mask,
        rejected: P::Mask,
    ) {
        let c = P::from_f64;
        for (largest, [_, _, here]) in self.largest.iter_mut().zip(difference.accelerations) {
            *largest = P::select(accepted, largest.max(here), *largest);
        }
        let less = (self.asleep - c(1.0)).max(c(0.0));
        let asleep = P::select(self.helps(h), less, c(ASLEEP));
        self.asleep = P::select(accepted, asleep, self.asleep);
        let first = rejected.and(c(0.0).lt(self.before[1]).not());
        for (before, now) in self.before.iter_mut().zip([self.x, h]) {
            *before = P::select(first, now, *before);
            *before = P::select(accepted, c(0.0), *before);
        }
    }
}

impl Accelerations<f64> {
    /// The error of the slope of an implicit step in a velocity, over what is allowed. `reach` is h|λ| of the step:
    /// below [`RESOLVED_REACH`] the fastest motion is resolved as the tolerances ask. `noise` is the effect of rounding
    /// on the acceleration.
    pub fn share(&self, kind: usize, [apart, noise]: [f64; 2], reach: f64) -> f64 {
        let largest = match self.largest[kind] {
            none if none <= 0.0 => 1.0,
            largest => largest,
        };
        let allowed = (self.share / AIM).min(LOST) * largest;
        match reach < RESOLVED_REACH {
            true => 0.0,
            false => apart / (allowed + RESOLVED * noise),
        }
    }
}

/// The largest acceleration that an effect causes by itself at (`t`, `y`), for velocities and angular velocities.
/// `state` is room for a state, and each of `powers` for the powers of all effects.
pub(crate) fn effect_accelerations<T: Real>(
    model: &dyn Dynamics<T>,
    t: T,
    y: &[T],
    state: &mut [T],
    powers: [&mut [T]; 2],
) -> [T; 2] {
    let info = model.info();
    let velocities = info.coordinates.len()..info.coordinates.len() + info.velocities.len();
    let nought = T::from_f64(0.0);
    let [forwards, backwards] = powers;
    let mut found = [nought; 2];
    state.copy_from_slice(y);
    for (which, found) in found.iter_mut().enumerate() {
        if !velocities.clone().any(|i| kind(info, i) == which) {
            continue;
        }
        let mut at = |sign: f64, powers: Option<&mut [T]>| {
            let mut share = 0.0;
            for i in velocities.clone() {
                // all velocities differ, so that the power of a force between two bodies is not 0
                share += GOLDEN;
                let w = sign * (0.5 + share % 1.0);
                state[i] = T::from_f64(if kind(info, i) == which { w } else { 0.0 });
            }
            if let Some(powers) = powers {
                model.powers(t, state, powers);
            }
            model.kinetic_energy(t, state)
        };
        let moving = at(1.0, Some(&mut *forwards)) + at(-1.0, Some(&mut *backwards));
        let rest = at(0.0, None);
        let twice = moving - (rest + rest);
        for (one, other) in forwards.iter().zip(&*backwards) {
            let power = (*one - *other).abs() * T::from_f64(0.5);
            let part = T::select(nought.lt(twice), power / twice, nought);
            *found = found.max(part);
        }
    }
    found
}

/// The golden ratio less 1: its multiples are spread evenly over the unit interval.
const GOLDEN: f64 = 0.618_033_988_749_895;
