//! Whether steps went over something that begins and ends in them, in each lane, as [`crate::simulate`] looks for it in a single run.

use super::run::{Run, Section, each, replace};
use crate::Real;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::simulate::excursion::overshoot;
use crate::simulate::onset::{
    Course, DEEPER, Hunt, NEAR, QUARTERS, STRAIGHT, finest_gap, onset_of, sides,
};

/// Places of a step at which onsets are kept: its beginning, the ends of its quarters, its end, any, and the beginning of the step before.
const PLACES: usize = QUARTERS + 3;
const END: usize = QUARTERS;
const ANY: usize = QUARTERS + 1;
const PAST: usize = QUARTERS + 2;

/// What is known of the onsets in the step of each lane.
pub(super) struct Onsets<T: Several> {
    /// By place, each gaps, then speeds.
    values: [Box<[T]>; PLACES],
    /// How many of them, the last ones, are corners, and how many [`sides`] are searched.
    corners: usize,
    sides: usize,
    /// In which lanes those at the beginning are known.
    known: T::Mask,
    hunts: Box<[Option<Hunt>]>,
    /// The law that was found last in the step of each lane, and the first that a fixed step of its run went over, indices in
    /// [`Info::onsets`](crate::Info::onsets).
    found: [usize; MOST_LANES],
    pub(super) missed: [Option<usize>; MOST_LANES],
}

impl<T: Several> Onsets<T> {
    /// Of so many, of which the last are so many corners.
    pub fn new(count: usize, corners: usize, adaptive: bool) -> Self {
        let zeros = || vec![T::from_f64(0.0); 2 * count].into_boxed_slice();
        Onsets {
            values: core::array::from_fn(|_| zeros()),
            corners,
            sides: sides(count, corners, adaptive),
            known: T::Mask::of_lanes(0),
            hunts: vec![None; if count > 0 { T::LANES } else { 0 }].into_boxed_slice(),
            found: [0; MOST_LANES],
            missed: [None; MOST_LANES],
        }
    }

    /// The gap of one of the sides.
    #[inline(always)]
    fn gap(&self, place: usize, side: usize) -> T {
        let (onset, far) = onset_of(side, self.count(), self.corners);
        let gap = self.values[place][onset];
        if far { -gap } else { gap }
    }

    #[inline(always)]
    fn speed(&self, place: usize, side: usize) -> T {
        let (onset, _) = onset_of(side, self.count(), self.corners);
        self.values[place][self.count() + onset]
    }

    #[inline(always)]
    fn count(&self) -> usize {
        self.values[0].len() / 2
    }

    fn course(&self, side: usize, lane: usize) -> Course {
        let of = |value: T| value.lane(lane).to_f64();
        let gaps = core::array::from_fn(|place| of(self.gap(place, side)));
        let speeds = (0..=QUARTERS).map(|place| of(self.speed(place, side)));
        Course {
            gaps,
            speed: speeds.fold(0.0, f64::max),
        }
    }
}

/// [`Run::hunt`]
struct Chase<M>(M);

impl<T: Several> Section<T> for Chase<T::Mask> {
    type Output = T::Part;
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> T::Part {
        run.hunt(self.0)
    }
}

impl<T: Several> Run<'_, T> {
    /// The part of the step of each lane that is to be taken instead, because a law begins to act behind it and shows nothing of it where the
    /// step ends; +∞ where there is none.
    #[inline(always)]
    pub(super) fn stepped_over(&mut self, accepted: T::Mask) -> T::Part {
        let never = T::Part::from_f64(f64::INFINITY);
        if self.onsets.sides == 0 || !accepted.any() {
            return never;
        }
        let model = &*self.models.all;
        let fresh = accepted.and(self.onsets.known.not());
        if fresh.any() {
            let [begin, .., any, _] = &mut self.onsets.values;
            model.onsets(self.step.t, &self.step.y, any);
            replace(fresh, begin, any);
            self.onsets.known = self.onsets.known.or(fresh);
        }
        self.state.copy_from_slice(&self.step.end);
        model.normalize(&mut self.state);
        let end = self.step.t + self.step.h;
        model.onsets(end, &self.state, &mut self.onsets.values[END]);
        let unclear = accepted.and(self.quiet().not());
        if !unclear.any() {
            return never;
        }
        self.apart(Chase(unclear))
    }

    /// Fixed steps cannot be taken again: where one goes over a law, that is told.
    #[inline(always)]
    pub(super) fn tell_missed(&mut self, accepted: T::Mask) {
        let part = self.stepped_over(accepted);
        let over = part.lt(T::Part::from_f64(f64::INFINITY)).and(accepted);
        for i in each(over.lanes()).take_while(|i| *i < T::LANES) {
            let Onsets { missed, found, .. } = &mut self.onsets;
            missed[i].get_or_insert(found[i]);
        }
    }

    /// The lanes in which nothing can have happened, by what is known at the ends of the step, and of corners at the beginning of the step
    /// before.
    #[inline(always)]
    fn quiet(&self) -> T::Mask {
        let c = T::Part::from_f64;
        let length = self.step.h.part(0);
        let known = c(0.0).lt(self.past);
        let onsets = &self.onsets;
        let laws = onsets.count() - onsets.corners;
        let finest = c(finest_gap(T::EPSILON > 1e-10));
        let mut quiet = c(self.info.every).lt(length).not();
        for side in 0..onsets.sides {
            let (a, b) = (onsets.gap(0, side).part(0), onsets.gap(END, side).part(0));
            let (from, to) = (onsets.speed(0, side), onsets.speed(END, side));
            let speed = from.part(0).max(to.part(0));
            let lowest = a.min(b);
            let limit = c(DEEPER) * lowest.min(c(0.0)) - finest;
            let way = c(NEAR) * speed * length;
            let mut above = limit.lt(c(0.5) * (a + b - way)).and(limit.lt(lowest));
            if side >= laws {
                let past = onsets.gap(PAST, side).part(0);
                let way = c(STRAIGHT) * speed * length;
                let near = limit.lt(c(0.5) * (a + b - way)).and(limit.lt(lowest));
                let bend = overshoot([past - limit, a - limit, b - limit], [self.past, length]);
                let straight = known.and(near).and(c(0.0).lt(bend).not());
                above = above.or(straight);
            }
            quiet = quiet.and(above);
        }
        quiet
    }

    /// Looks into the steps of these lanes.
    #[inline(always)]
    fn hunt(&mut self, lanes: T::Mask) -> T::Part {
        self.step.complete(&*self.models.all);
        for quarter in 1..QUARTERS {
            let theta = T::from_f64(quarter as f64 / QUARTERS as f64);
            self.onsets_within(theta, quarter);
        }
        let finest = finest_gap(T::EPSILON > 1e-10);
        for i in each(lanes.lanes()).take_while(|i| *i < T::LANES) {
            let length = self.step.h.lane(i).to_f64();
            let hunt = Hunt::new(length, self.onsets.sides, finest);
            self.onsets.hunts[i] = Some(hunt);
        }
        let mut parts = [T::One::from_f64(f64::INFINITY); MOST_LANES];
        loop {
            let mut theta = [T::One::from_f64(0.5); MOST_LANES];
            let mut any = false;
            for i in 0..T::LANES {
                let Some(mut hunt) = self.onsets.hunts[i].take() else {
                    continue;
                };
                match hunt.next(|side| self.onsets.course(side, i)) {
                    Some(next) => {
                        theta[i] = T::One::from_f64(next);
                        any = true;
                        self.onsets.hunts[i] = Some(hunt);
                    }
                    None => {
                        if let Some((part, law)) = hunt.best() {
                            parts[i] = T::One::from_f64(part);
                            self.onsets.found[i] = law;
                        }
                    }
                }
            }
            if !any {
                break;
            }
            self.onsets_within(T::of_lanes(&theta), ANY);
            for i in 0..T::LANES {
                if let Some(mut hunt) = self.onsets.hunts[i].take() {
                    let gap = self.onsets.gap(ANY, hunt.law());
                    hunt.tell(gap.lane(i).to_f64());
                    self.onsets.hunts[i] = Some(hunt);
                }
            }
        }
        T::of_lanes(&parts).part(0)
    }

    /// The onsets within the steps, which are complete.
    #[inline(always)]
    fn onsets_within(&mut self, theta: T, place: usize) {
        let model = &*self.models.all;
        self.step.inside(model, theta, &mut self.state);
        let t = theta * self.step.h + self.step.t;
        model.onsets(t, &self.state, &mut self.onsets.values[place]);
    }

    /// The next step of these lanes begins where this one ended, in `same` with what is known of its end.
    #[inline(always)]
    pub(super) fn advance_onsets(&mut self, accepted: T::Mask, same: T::Mask) {
        if self.info.onsets.is_empty() {
            return;
        }
        let [begin, .., end, _, past] = &mut self.onsets.values;
        replace(accepted, past, begin);
        replace(accepted.and(same), begin, end);
        let known = self.onsets.known;
        self.onsets.known = known.and(accepted.not()).or(accepted.and(same));
    }

    /// Nothing is known of the onsets in these lanes.
    #[inline(always)]
    pub(super) fn forget_onsets(&mut self, lanes: T::Mask) {
        self.onsets.known = self.onsets.known.and(lanes.not());
    }
}
