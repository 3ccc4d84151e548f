//! Where in a step a guard or a kink changes its sign.
//!
//! A step is searched for the first time at which one of some functions, in any lane, has another sign than at its beginning:
//! the root of φ(θ) = max −sign(g(0)) g(θ), negative before it, on the step's interpolant. A function that changes its sign
//! twice within one step shows nothing of it at the end; [`Within::excursion`] looks for guards that do, [`Within::hidden`] for kinks.

use super::excursion::Excursion;
use crate::integrate::Stepper;
use crate::{Dynamics, Real};

/// Iterations at most; bisection alone needs 44 for a width of 10⁻¹³.
const ITERATIONS: u32 = 100;

/// Which functions of a model are looked at.
#[derive(Clone, Copy)]
pub(super) enum Which {
    Guards,
    Kinks,
}

impl Which {
    /// What 0 means.
    pub const fn zero(self) -> Zero {
        match self {
            Which::Guards => Zero::Positive,
            Which::Kinks => Zero::Neither,
        }
    }
}

/// The functions of a model within a step. After [`Stepper::complete`].
pub(super) struct Within<'s, T: Real> {
    pub model: &'s dyn Dynamics<T>,
    pub step: &'s dyn Stepper<T>,
    pub which: Which,
    /// What they are at the beginning.
    pub before: &'s [T],
    /// Place for a state.
    pub state: &'s mut [T],
    /// Place for their values at [`PLACES`] places.
    pub values: &'s mut [T],
}

/// Places at which values are kept at the same time: four to look at, and a vertex.
pub(super) const PLACES: usize = 5;

impl<T: Real> Within<'_, T> {
    /// What they are at t + θh, kept as the values of a place.
    fn at(&mut self, theta: f64, place: usize) -> &[T] {
        let count = self.before.len();
        inside(self.model, self.step, theta, self.state);
        let span = self.step.span();
        let t = T::from_f64(span.t + theta * span.h);
        let values = &mut self.values[place * count..][..count];
        match self.which {
            Which::Guards => self.model.guards(t, self.state, values),
            Which::Kinks => self.model.kinks(t, self.state, values),
        }
        values
    }

    /// How far any of them is on the other side at t + θh.
    fn change(&mut self, theta: f64) -> f64 {
        let (zero, before) = (self.which.zero(), self.before);
        change(zero, before, self.at(theta, 0))
    }

    /// The fraction of the step, in 0..=`end`, just behind the first change of sign of any of them, to within `width`. At least one has changed
    /// at `end` the sign that it had at the beginning.
    ///
    /// Regula falsi with the Illinois modification (Dowell & Jarratt, BIT 11, 1971), and a bisection wherever two
    /// iterations have not halved the bracket.
    pub fn first_change(&mut self, end: f64, width: f64) -> f64 {
        let (mut same, mut other) = (0.0, end);
        let mut below = change(self.which.zero(), self.before, self.before);
        let mut above = self.change(end).max(f64::MIN_POSITIVE);
        let (mut last_above, mut bracket) = (None, end);
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
            let value = self.change(theta);
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

    /// The first of them that has another sign within the step than at its ends, where they are `after`, and a fraction of the step at which it
    /// has.
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
            let mut search = Excursion::new([0, 1, 2, 3, 4].map(at_place));
            while let Some(theta) = search.next() {
                let value = self.at(theta, PLACES - 1)[i];
                search.tell(opposite(zero, before, value));
            }
            if let Some(theta) = search.found()
                && first.is_none_or(|(_, earlier)| theta < earlier)
            {
                first = Some((i, theta));
            }
        }
        first
    }

    /// The fraction of the step at which one of them is farthest on the other side of zero, though at the end it has the sign of the
    /// beginning: a ball in free flight, whose parabola is integrated without error in steps of any length, would fly into a wall and out
    /// again in one of them. They are looked at in three places within the step, and where parabolas through
    /// neighbouring values have their vertex.
    pub fn hidden(&mut self) -> Option<f64> {
        for (place, theta) in [0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
            self.at(theta, place);
        }
        (0..self.before.len()).find_map(|i| self.hidden_of(i))
    }

    /// [`Within::hidden`] of one of them, whose values at the places are known.
    fn hidden_of(&mut self, i: usize) -> Option<f64> {
        let (zero, before, count) = (self.which.zero(), self.before[i], self.before.len());
        let at_place = |k: usize| match k {
            0 => opposite(zero, before, before),
            k => opposite(zero, before, self.values[(k - 1) * count + i]),
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
                if matters(opposite(zero, before, self.at(vertex, PLACES - 1)[i])) {
                    return Some(vertex);
                }
            }
        }
        None
    }
}

/// The state at t + θh inside a step, on its manifold. After [`Stepper::complete`].
pub(super) fn inside<T: Real>(
    model: &dyn Dynamics<T>,
    step: &dyn Stepper<T>,
    theta: f64,
    state: &mut [T],
) {
    step.interpolate(theta, state);
    model.normalize(state);
}

/// What begins a trifle inside a contact, goes at least so many times deeper, and leaves it within one step, is looked at.
const DEEPER: f64 = 4.0;

/// What 0 at the beginning of a step means; at its end it is always no change yet.
#[derive(Clone, Copy)]
pub(crate) enum Zero {
    /// Positive: a guard may rest there, and what comes of it is decided by what it becomes.
    Positive,
    /// Neither: a step that begins on a kink and leaves it has a first stage on one side and the others on the other.
    Neither,
}

/// Positive where a function has changed its sign in any lane.
fn change<T: Real>(zero: Zero, before: &[T], after: &[T]) -> f64 {
    let pairs = before.iter().zip(after);
    pairs.fold(f64::NEG_INFINITY, |worst, (before, after)| {
        worst.max(opposite(zero, *before, *after))
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
pub(super) fn changed<T: Real>(zero: Zero, before: &[T], after: &[T]) -> Option<usize> {
    let mut pairs = before.iter().zip(after);
    pairs.position(|(before, after)| opposite(zero, *before, *after) > 0.0)
}
