//! Finds where in a step an event function or a kink changes its sign.
//!
//! A step is searched for the first time at which one of several functions, in any lane, has another sign than at the
//! start of the step: the root of φ(θ) = max −sign(g(0)) g(θ), negative before the root, on the step's interpolant. A
//! function that changes its sign twice within one step shows no change at the end; [`Within::excursion`] looks for
//! event functions that do so, [`Within::hidden`] for kinks.

use super::excursion::Excursion;
use crate::integrate::Stepper;
use crate::real::{Mask, Number, mapped};
use crate::{Dynamics, Real};

/// Limit of iterations; bisection alone needs 44 for a width of 10⁻¹³.
const ITERATIONS: u32 = 100;
/// Width of a bracket, as a part of the step. The time of an event then errs by less than the step does.
pub(crate) const WIDTH: f64 = 1e-13;

/// The kind of functions to examine.
#[derive(Clone, Copy)]
pub(super) enum Which {
    EventFunctions,
    Kinks,
}

impl Which {
    /// The meaning of a function value of 0.
    pub const fn zero(self) -> Zero {
        match self {
            Which::EventFunctions => Zero::Positive,
            Which::Kinks => Zero::Neither,
        }
    }
}

/// The functions of a model within a step, which [`Stepper::complete`] has completed.
pub(super) struct Within<'s, T: Real> {
    pub model: &'s dyn Dynamics<T>,
    pub step: &'s dyn Stepper<T>,
    pub which: Which,
    /// The functions at the start of the step.
    pub before: &'s [T],
    /// Place for a state.
    pub state: &'s mut [T],
    /// Place for their values at [`PLACES`] places.
    pub values: &'s mut [T],
}

/// Number of places at which values are kept at the same time: four fixed ones, and a vertex.
pub(super) const PLACES: usize = 5;

impl<T: Real> Within<'_, T> {
    /// Evaluates the functions at t + θh, and keeps them as the values of a place.
    fn at(&mut self, theta: f64, place: usize) -> &[T] {
        let count = self.before.len();
        inside(self.model, self.step, theta, self.state);
        let span = self.step.span();
        let t = T::from_f64(span.t + theta * span.h);
        let values = &mut self.values[place * count..][..count];
        match self.which {
            Which::EventFunctions => self.model.event_functions(t, self.state, values),
            Which::Kinks => self.model.kinks(t, self.state, values),
        }
        values
    }

    /// The largest value on the other side of zero, over all functions, at t + θh.
    fn change(&mut self, theta: f64) -> f64 {
        let (zero, before) = (self.which.zero(), self.before);
        change(zero, before, self.at(theta, 0)).to_f64()
    }

    /// The fraction of the step, in 0..=`end`, just behind the first sign change of any function, to within `width`. At
    /// `end` at least one function must have changed its sign.
    pub fn first_change(&mut self, end: f64, width: f64) -> f64 {
        let below = change(self.which.zero(), self.before, self.before);
        let mut bracket = Bracket::new([below.to_f64(), self.change(end)], end, width);
        while bracket.open() {
            let theta = bracket.next(true);
            bracket.tell(self.change(theta), true);
        }
        bracket.other
    }

    /// The first function whose sign changes within the step and is back at the end, where the values are `after`, and
    /// a fraction of the step at which the sign is changed.
    pub fn excursion(&mut self, after: &[T]) -> Option<(usize, f64)> {
        let (zero, count) = (self.which.zero(), self.before.len());
        for (place, theta) in [0.25, 0.5, 0.75].into_iter().enumerate() {
            self.at(theta, place);
        }
        let mut first: Option<(usize, f64)> = None;
        let ends = self.before.iter().zip(after);
        for (i, (&before, &after)) in ends.enumerate() {
            let at_place = |k: usize| match k {
                0 => opposite(zero, before, before),
                4 => opposite(zero, before, after),
                k => opposite(zero, before, self.values[(k - 1) * count + i]),
            };
            let at_place = |k| at_place(k).to_f64();
            let mut search = Excursion::new(mapped([0, 1, 2, 3, 4], at_place));
            while let Some(theta) = search.next() {
                let value = self.at(theta, PLACES - 1)[i];
                search.tell(opposite(zero, before, value).to_f64());
            }
            if let Some(theta) = search.found()
                && first.is_none_or(|(_, earlier)| theta < earlier)
            {
                first = Some((i, theta));
            }
        }
        first
    }

    /// A fraction of the step at which one of the functions is on the other side of zero, though its end does not show
    /// this: a ball in free flight, whose parabola is integrated without error in steps of any length, would fly into a
    /// wall and out again in one step. If a function is on the other side at the end, a place where it was far deeper
    /// on this side than at the start ([`DEEPER`]). The functions are evaluated at three places within the step, and at
    /// the vertices of parabolas through neighbouring values.
    pub fn hidden(&mut self) -> Option<f64> {
        for (place, theta) in [0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
            self.at(theta, place);
        }
        (0..self.before.len()).find_map(|i| self.hidden_of(i))
    }

    /// [`Within::hidden`] for one function, whose values at the places are known.
    fn hidden_of(&mut self, i: usize) -> Option<f64> {
        let (zero, before, count) = (self.which.zero(), self.before[i], self.before.len());
        let at_place = |k: usize| match k {
            0 => opposite(zero, before, before),
            k => opposite(zero, before, self.values[(k - 1) * count + i]),
        };
        let course = StepValues(mapped([0, 1, 2, 3, 4], |k| at_place(k).to_f64()));
        for k in 1..4 {
            let theta = 0.25 * k as f64;
            if course.matters(course.0[k]) {
                return Some(theta);
            }
            let (at_stake, way) = course.vertex(k);
            if at_stake {
                let vertex = theta + 0.25 * way;
                let value = opposite(zero, before, self.at(vertex, PLACES - 1)[i]);
                if course.matters(value.to_f64()) {
                    return Some(vertex);
                }
            }
        }
        None
    }
}

/// The search for the first sign change between the start of a step, or of the step of each lane, and a place where it
/// has happened.
///
/// Regula falsi with the Illinois modification (Dowell & Jarratt, BIT 11, 1971), and a bisection wherever two
/// iterations have not halved the bracket. The search asks for values and is told them.
#[derive(Clone, Copy)]
pub(crate) struct Bracket<P: Number> {
    /// The ends of the bracket before and behind the sign change, as parts of the step.
    pub same: P,
    pub other: P,
    /// The values at these ends, as modified by the Illinois rule.
    below: P,
    above: P,
    /// The side of the change on which the last place was.
    was_above: P::Mask,
    was_below: P::Mask,
    /// Width of the bracket two iterations before.
    apart: P,
    taken: u32,
    /// The place whose value is asked for.
    theta: P,
    /// Width at which the search ends.
    width: f64,
}

impl<P: Number> Bracket<P> {
    /// A search with the values at the start of the step and at `end`.
    #[inline(always)]
    pub fn new([below, above]: [P; 2], end: P, width: f64) -> Self {
        let none = P::Mask::of_lanes(0);
        Bracket {
            same: P::from_f64(0.0),
            other: end,
            below,
            above: above.max(P::from_f64(f64::MIN_POSITIVE)),
            was_above: none,
            was_below: none,
            apart: end,
            taken: 0,
            theta: end,
            width,
        }
    }

    /// The lanes in which the search is to go on.
    #[inline(always)]
    pub fn open(&self) -> P::Mask {
        let wide = P::from_f64(self.width).lt(self.other - self.same);
        let patient = match self.taken < ITERATIONS {
            true => u32::MAX,
            false => 0,
        };
        wide.and(P::Mask::of_lanes(patient))
    }

    /// The next place to evaluate, in the lanes that are `open`.
    #[inline(always)]
    pub fn next(&mut self, open: P::Mask) -> P {
        let half = P::from_f64(0.5);
        let apart = self.other - self.same;
        let mut slow = P::Mask::of_lanes(0);
        if self.taken % 2 == 1 {
            slow = (half * self.apart).lt(apart);
            self.apart = P::select(open, apart, self.apart);
        }
        let guess = self.same + apart * (self.below / (self.below - self.above));
        let within = self.same.lt(guess).and(guess.lt(self.other));
        self.theta = P::select(
            within.and(slow.not()),
            guess,
            half * (self.same + self.other),
        );
        self.taken += 1;
        self.theta
    }

    /// Takes the value at that place, in the lanes that are `open`.
    #[inline(always)]
    pub fn tell(&mut self, value: P, open: P::Mask) {
        let (nought, half) = (P::from_f64(0.0), P::from_f64(0.5));
        let behind = open.and(nought.lt(value));
        let ahead = open.and(nought.lt(value).not());
        self.other = P::select(behind, self.theta, self.other);
        self.above = P::select(behind, value, self.above);
        self.below = P::select(behind.and(self.was_above), half * self.below, self.below);
        self.same = P::select(ahead, self.theta, self.same);
        self.below = P::select(ahead, value.min(nought), self.below);
        self.above = P::select(ahead.and(self.was_below), half * self.above, self.above);
        self.was_above = self.was_above.and(open.not()).or(behind);
        self.was_below = self.was_below.and(open.not()).or(ahead);
    }
}

/// The values of a function at five places of a step, positive on the other side of zero than at the start.
#[derive(Clone, Copy)]
pub(crate) struct StepValues<P>(pub [P; 5]);

impl<P: Number> StepValues<P> {
    /// True where the function is on the other side at the end: the change is noticed there, but not how deep the
    /// function was on this side before.
    #[inline(always)]
    fn seen(&self) -> P::Mask {
        P::from_f64(0.0).lt(self.0[4])
    }

    /// True where a value of this size within the step is to be searched for: it is on the other side, and the end is
    /// not; or the end is on the other side, and the value is [`DEEPER`] times deeper on this side than the start.
    #[inline(always)]
    pub fn matters(&self, value: P) -> P::Mask {
        let nought = P::from_f64(0.0);
        let deep = self.0[0]
            .lt(nought)
            .and(value.lt(P::from_f64(DEEPER) * self.0[0]));
        let seen = self.seen();
        seen.and(deep).or(seen.not().and(nought.lt(value)))
    }

    /// True where a vertex may matter, by a quick test: no vertex between the neighbours of a place is farther from the
    /// value there than half of the second difference.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn likely(&self) -> P::Mask {
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

    /// For the parabola through an inner place and its neighbours: true where its vertex may matter, and the distance
    /// of the vertex from the place, as a part of the distance between places.
    #[inline(always)]
    pub fn vertex(&self, k: usize) -> (P::Mask, P) {
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

/// The state at t + θh within a step that [`Stepper::complete`] has completed, normalized to its manifold.
pub(super) fn inside<T: Real>(
    model: &dyn Dynamics<T>,
    step: &dyn Stepper<T>,
    theta: f64,
    state: &mut [T],
) {
    step.interpolate(theta, state);
    model.normalize(state);
}

/// A visit that begins slightly inside a contact is searched for if it gets at least this many times deeper and ends
/// within the same step.
const DEEPER: f64 = 4.0;

/// The meaning of a value of 0 at the start of a step. At the end of a step, 0 is never a change of sign yet.
#[derive(Clone, Copy)]
pub(crate) enum Zero {
    /// 0 counts as positive: an event function may rest at 0, and has changed once it is negative.
    Positive,
    /// 0 has no sign, and any other value is a change: a step that begins on a kink and leaves it has its first stage
    /// on one side and the others on the other.
    Neither,
}

/// Positive if the sign of a function differs from that before.
#[inline(always)]
pub(crate) fn opposite<T: Real>(zero: Zero, before: T, after: T) -> T {
    let nought = T::from_f64(0.0);
    let otherwise = match zero {
        Zero::Positive => -after,
        Zero::Neither => T::select(nought.lt(before), -after, after.abs()),
    };
    T::select(before.lt(nought), after, otherwise)
}

/// The largest of [`opposite`] over all functions, positive if one of them has changed its sign.
#[inline(always)]
pub(crate) fn change<T: Real>(zero: Zero, before: &[T], after: &[T]) -> T {
    let mut worst = T::from_f64(f64::NEG_INFINITY);
    for (before, after) in before.iter().zip(after) {
        worst = worst.max(opposite(zero, *before, *after));
    }
    worst
}

/// The first function that has changed its sign in any lane.
pub(super) fn changed<T: Real>(zero: Zero, before: &[T], after: &[T]) -> Option<usize> {
    let mut pairs = before.iter().zip(after);
    pairs.position(|(before, after)| opposite(zero, *before, *after).to_f64() > 0.0)
}
