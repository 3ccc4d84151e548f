//! Finds where in a step an event function or a kink changes its sign, in each lane: as [`crate::simulate`] does for a
//! single run, with selections in place of branches.

use super::step::Step;
use crate::real::{Mask, Several};
use crate::simulate::excursion::Excursion;
use crate::simulate::{Bracket, StepValues, WIDTH, Zero, change, opposite};
use crate::{Dynamics, Real};

/// The accuracy of an event's place, as a fraction of the step: never finer than the resolution of the scalar.
pub const fn width<T: Several>() -> f64 {
    if T::EPSILON > WIDTH {
        T::EPSILON
    } else {
        WIDTH
    }
}

/// A function jumps if it changes over the share FAR of a step by less than MORE times its change over the bracket
/// around its zero. The bracket is [`width`] wide there: at most a millionth of that share, or rounding.
const FAR: f64 = 1e-6;
const MORE: f64 = 3.0;

/// The lanes in which one of the functions has changed its sign.
#[inline(always)]
pub fn changed<T: Several>(zero: Zero, before: &[T], after: &[T]) -> T::Mask {
    T::from_f64(0.0).lt(change(zero, before, after))
}

/// The lanes in which a sign change has a time of its own. If the step begins on the zero of a kink, the kink is left
/// at once, or when another function changes its sign: rounding decides when this shows, so its time means nothing.
#[inline(always)]
fn begins_apart<T: Several>(zero: Zero, before: T) -> T::Mask {
    match zero {
        // a zero counts as positive, so a change from it is a proper one
        Zero::Positive => T::Mask::of_lanes(u32::MAX),
        Zero::Neither => T::Part::from_f64(0.0).lt(before.part(0).abs()),
    }
}

/// The functions of a model whose signs matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Functions {
    /// [`Dynamics::event_functions`]
    EventFunctions,
    /// [`Dynamics::kinks`]
    Kinks,
}

impl Functions {
    /// The values of the functions at a time \[s\] and a state.
    #[inline(always)]
    pub fn evaluate<T: Real>(self, model: &dyn Dynamics<T>, t: T, y: &[T], values: &mut [T]) {
        match self {
            Functions::EventFunctions => model.event_functions(t, y, values),
            Functions::Kinks => model.kinks(t, y, values),
        }
    }

    /// The sign that a value of 0 counts as.
    pub const fn zero(self) -> Zero {
        match self {
            Functions::EventFunctions => Zero::Positive,
            Functions::Kinks => Zero::Neither,
        }
    }
}

/// Evaluates functions of a model within a step.
pub struct Probe<'a, T> {
    pub model: &'a dyn Dynamics<T>,
    pub step: &'a Step<T>,
    pub functions: Functions,
    /// Room for a state.
    pub state: &'a mut [T],
    /// Room for the values, as many as there are functions.
    pub values: &'a mut [T],
}

impl<T: Several> Probe<'_, T> {
    /// The values at t + θh.
    #[inline(always)]
    fn at(&mut self, theta: T) {
        self.step.inside(self.model, theta, self.state);
        let t = theta * self.step.h + self.step.t;
        self.functions
            .evaluate(self.model, t, self.state, self.values);
    }

    /// [`change`] at t + θh.
    #[inline(always)]
    fn change(&mut self, before: &[T], theta: T) -> T {
        self.at(theta);
        change(self.functions.zero(), before, self.values)
    }

    /// [`opposite`] of one function in each lane, chosen by `index`, at t + θh.
    #[inline(always)]
    fn opposite(&mut self, before: &[T], index: T::Part, theta: T) -> T {
        self.at(theta);
        let zero = self.functions.zero();
        let mut of_index = T::from_f64(0.0);
        for (i, (before, value)) in before.iter().zip(&*self.values).enumerate() {
            let apart = (index - T::Part::from_f64(i as f64)).abs();
            let chosen = apart.lt(T::Part::from_f64(0.5));
            of_index = T::select(chosen, opposite(zero, *before, *value), of_index);
        }
        of_index
    }

    /// The time at which the function `index` changes its sign in each lane, as a part of the step with its
    /// derivatives; its value is `there` at the part `found`. The zero of g(θ, p) moves by dθ/dp = −(∂g/∂p)/(∂g/∂θ). If
    /// instead dθ/dp = −(∂g/∂p)/r is tried, with any r, g changes by ρ = ∂g/∂p − (∂g/∂θ)(∂g/∂p)/r, and so ∂g/∂θ = r (1
    /// − ρ/(∂g/∂p)) up to rounding. A difference quotient over a short step would consist of rounding only.
    #[inline(always)]
    fn time(&mut self, before: &[T], index: T::Part, found: T::Part, there: T) -> T {
        let (nought, one) = (T::Part::from_f64(0.0), T::Part::from_f64(1.0));
        // r is the mean rate since the start of the step, which has the size of ∂g/∂θ
        let mut beginning = nought;
        for (i, before) in before.iter().enumerate() {
            let apart = (index - T::Part::from_f64(i as f64)).abs();
            let chosen = apart.lt(T::Part::from_f64(0.5));
            beginning = T::Part::select(chosen, before.part(0).abs(), beginning);
        }
        let mean = (there.part(0).abs() + beginning) / found;
        let mean = T::Part::select(nought.lt(mean), mean, one);
        let trial = (there.frozen() - there) / T::of_part(mean);
        let left = self.opposite(before, index, T::of_part(found) + trial);
        // from the derivative with the largest magnitude
        let (mut largest, mut share) = (nought, nought);
        for part in 1..T::PARTS {
            let by = there.part(part);
            let tells = largest.lt(by.abs());
            let by = T::Part::select(tells, by, one);
            share = T::Part::select(tells, one - left.part(part) / by, share);
            largest = largest.max(there.part(part).abs());
        }
        let moves = nought.lt(share.abs());
        let share = T::Part::select(moves, share, one);
        let found = T::of_part(found);
        T::select(moves, trial / T::of_part(share) + found, found)
    }

    /// The lanes in which the function `index` changes its sign by a jump between the parts `same` and `other` of the
    /// step: over a far longer part it changes hardly more. Its value is `there` at `other`.
    #[inline(always)]
    fn jumps(
        &mut self,
        before: &[T],
        index: T::Part,
        [other, same]: [T::Part; 2],
        there: T,
    ) -> T::Mask {
        let nought = T::Part::from_f64(0.0);
        let far = (other - T::Part::from_f64(FAR)).max(nought).min(same);
        let near = self.change_from(before, index, same, there);
        let far = self.change_from(before, index, far, there);
        far.lt(T::Part::from_f64(MORE) * near)
    }

    /// How much the function `index` changes from a part of the step to where its value is `there`.
    #[inline(always)]
    fn change_from(&mut self, before: &[T], index: T::Part, part: T::Part, there: T) -> T::Part {
        let value = self.opposite(before, index, T::of_part(part));
        there.part(0) - value.part(0)
    }
}

/// Fractions of a step just ahead of and just behind a sign change, as close as can be told, with the derivatives of
/// its time.
#[derive(Clone, Copy)]
pub struct Sides<T: Real> {
    pub ahead: T,
    pub behind: T,
    /// The lanes in which several functions change their signs there, at times that depend differently on parameters.
    pub at_odds: T::Mask,
    /// The lanes in which the time is not that of the function itself: either the function jumps, and the time is that
    /// of the cause of the jump; or the zero was [left at once](begins_apart).
    pub jumps: T::Mask,
}

/// Two times depend alike on a parameter if their derivatives differ by less than this share of a step per change of
/// the parameter by its size, or by less than this share of themselves.
const ALIKE: [f64; 2] = [1e-9, 1e-6];

impl<T: Several> Sides<T> {
    /// The lanes in which two times depend differently on parameters.
    #[inline(always)]
    pub fn differ(a: T, b: T) -> T::Mask {
        let mut differ = T::Mask::of_lanes(0);
        for part in 1..T::PARTS {
            let [a, b] = [a.part(part), b.part(part)];
            let [least, share] = ALIKE.map(T::Part::from_f64);
            let alike = share.mul_add(a.abs().max(b.abs()), least);
            differ = differ.or(alike.lt((a - b).abs()));
        }
        differ
    }
}

/// The fractions of the step around the first sign change of the functions, in the lanes `wanted`, where a sign is
/// changed at `end`; 1 in the other lanes.
#[inline(always)]
pub fn first_change<T: Several>(
    probe: &mut Probe<'_, T>,
    before: &[T],
    wanted: T::Mask,
    end: T::Part,
) -> Sides<T> {
    let c = T::Part::from_f64;
    let (nought, one) = (c(0.0), c(1.0));
    let below: T::Part = change(probe.functions.zero(), before, before).part(0);
    let above = probe.change(before, T::of_part(end)).part(0);
    let mut bracket = Bracket::new([below, above], end, width::<T>());
    loop {
        let open = wanted.and(bracket.open());
        if !open.any() {
            break;
        }
        let theta = bracket.next(open);
        let value = probe.change(before, T::of_part(theta)).part(0);
        bracket.tell(value, open);
    }
    let Bracket { same, other, .. } = bracket;
    let found = T::Part::select(wanted, other, one);
    let between = T::of_part(T::Part::select(wanted, other - same, nought));
    let none = T::Mask::of_lanes(0);
    if T::PARTS == 1 {
        let behind = T::of_part(found);
        return Sides {
            ahead: behind - between,
            behind,
            at_odds: none,
            jumps: none,
        };
    }
    let zero = probe.functions.zero();
    probe.at(T::of_part(found));
    // the function that is farthest on the other side, the lanes that have one, and the lanes that have several
    let (mut index, mut there, mut alone, mut several) = (nought, T::from_f64(0.0), none, none);
    for (i, (before, value)) in before.iter().zip(&*probe.values).enumerate() {
        let value = opposite(zero, *before, *value);
        let changed = nought.lt(value.part(0)).and(wanted);
        let changed = changed.and(begins_apart(zero, *before));
        let farthest = changed.and(there.part(0).lt(value.part(0)));
        index = T::Part::select(farthest, c(i as f64), index);
        there = T::select(farthest, value, there);
        several = several.or(alone.and(changed));
        alone = alone.or(changed);
    }
    let mut behind = T::of_part(found);
    let (mut jumps, mut at_odds) = (none, none);
    let same = found - between.part(0);
    if alone.any() {
        let time = probe.time(before, index, found, there);
        behind = T::select(alone, time, behind);
        jumps = probe.jumps(before, index, [found, same], there).and(alone);
    }
    if several.any() {
        let mut odd = none;
        for (i, before_of) in before.iter().enumerate() {
            let index = c(i as f64);
            let there = probe.opposite(before, index, T::of_part(found));
            let counts = several.and(nought.lt(there.part(0)));
            let counts = counts.and(begins_apart(zero, *before_of));
            if !counts.any() {
                continue;
            }
            let time = probe.time(before, index, found, there);
            let by_itself = probe.jumps(before, index, [found, same], there).not();
            // the first function that does not jump gives the time for all that do
            let first = counts.and(by_itself).and(jumps);
            behind = T::select(first, time, behind);
            jumps = jumps.and(first.not());
            let differ = Sides::differ(time, behind).and(counts);
            at_odds = at_odds.or(differ.and(by_itself));
            odd = odd.or(differ);
        }
        at_odds = at_odds.or(odd.and(jumps));
    }
    let jumps = jumps.or(wanted.and(alone.not()));
    Sides {
        ahead: behind - between,
        behind,
        at_odds,
        jumps,
    }
}

/// The lanes, among these, in which a function may have another sign within the step than at its ends, by its values at
/// five places. They include all lanes in which an [`Excursion`] finds a change or asks for values.
#[inline(always)]
pub fn may_stray<T: Several>(zero: Zero, values: &Values<T>, lanes: u32) -> u32 {
    // searches use doubles, and values of a coarser scalar may lead to another answer
    if T::EPSILON > 1e-10 {
        return lanes;
    }
    let half = T::Part::from_f64(0.5);
    let nought = T::Part::from_f64(0.0);
    let before = values[0].part(0);
    let mut course = [nought; 5];
    for (value, place) in course.iter_mut().zip(values) {
        *value = opposite(zero, before, place.part(0));
    }
    let mut may = nought.lt(course[0]);
    for k in 1..4 {
        let (left, middle, right) = (course[k - 1], course[k], course[k + 1]);
        let bend = (right - middle) - (middle - left);
        let highest = left.max(middle).max(right);
        let low = (highest - half * bend).lt(nought);
        may = may.or(nought.lt(middle)).or(bend.lt(nought).and(low.not()));
    }
    may.lanes() & lanes
}

/// The search for a place in a lane's step at which a function has another sign than at its ends, from its values at
/// five places.
#[inline(always)]
pub fn excursion<T: Several>(zero: Zero, values: &Values<T>, lane: usize) -> Excursion {
    let before = values[0].lane(lane);
    let mut course = [0.0; 5];
    for (place, value) in course.iter_mut().zip(values) {
        *place = opposite(zero, before, value.lane(lane)).to_f64();
    }
    Excursion::new(course)
}

/// The values of one function at five places of a step: its start, the ends of its quarters, and its end.
pub type Values<T> = [T; 5];

/// The places of [`Values`], as parts of the step.
pub const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// The first fraction of a step at which a function has a value that [matters](Course::matters); +∞ if there is none,
/// and undefined in lanes that are not `wanted`. The rule is that of `hidden` in a single run.
#[inline(always)]
pub fn hidden<T: Several>(
    probe: &mut Probe<'_, T>,
    values: &[Values<T>],
    wanted: T::Mask,
) -> T::Part {
    let c = T::Part::from_f64;
    let zero = probe.functions.zero();
    let never = c(f64::INFINITY);
    let mut result = never;
    for (i, values) in values.iter().enumerate() {
        let before = values[0].part(0);
        let mut course = StepValues([never; 5]);
        for (value, place) in course.0.iter_mut().zip(values) {
            *value = opposite(zero, before, place.part(0));
        }
        if !course.likely().and(wanted).any() {
            continue;
        }
        // the first place found counts, for each function
        let mut mine = never;
        for (k, theta) in PLACES.into_iter().enumerate().take(4).skip(1) {
            let theta = c(theta);
            let open = mine.lt(never).not();
            let deep = open.and(course.matters(course.0[k]));
            mine = T::Part::select(deep, theta, mine);
            let (at_stake, way) = course.vertex(k);
            let likely = open.and(deep.not()).and(at_stake).and(wanted);
            if likely.any() {
                let vertex = T::Part::select(likely, c(0.25).mul_add(way, theta), theta);
                probe.at(T::of_part(vertex));
                let value = opposite(zero, before, probe.values[i].part(0));
                let sure = likely.and(course.matters(value));
                mine = T::Part::select(sure, vertex, mine);
            }
        }
        result = result.min(mine);
    }
    result
}
