//! Whether steps went over something that begins and ends in them, in each lane, as [`crate::simulate`] looks for it in a single run.

use super::run::{Run, Section, each, replace};
use crate::Real;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::simulate::onset::{Course, DEEPER, Hunt, NEAR, QUARTERS, finest_gap};

/// Places of a step at which onsets are kept: its beginning, the ends of its quarters, its end, and any.
const PLACES: usize = QUARTERS + 2;
const END: usize = QUARTERS;
const ANY: usize = QUARTERS + 1;

/// What is known of the onsets in the step of each lane.
pub(super) struct Onsets<T: Several> {
    /// By place, each gaps, then speeds.
    values: [Box<[T]>; PLACES],
    /// In which lanes those at the beginning are known.
    known: T::Mask,
    hunts: Box<[Option<Hunt>]>,
    /// The law that was found last in the step of each lane, and the first that a fixed step of its run went over, indices in
    /// [`Info::onsets`](crate::Info::onsets).
    found: [usize; MOST_LANES],
    pub(super) missed: [Option<usize>; MOST_LANES],
}

impl<T: Several> Onsets<T> {
    /// Of so many laws.
    pub fn new(count: usize) -> Self {
        let zeros = || vec![T::from_f64(0.0); 2 * count].into_boxed_slice();
        Onsets {
            values: core::array::from_fn(|_| zeros()),
            known: T::Mask::of_lanes(0),
            hunts: vec![None; if count > 0 { T::LANES } else { 0 }].into_boxed_slice(),
            found: [0; MOST_LANES],
            missed: [None; MOST_LANES],
        }
    }

    fn course(&self, law: usize, lane: usize) -> Course {
        let count = self.values[0].len() / 2;
        let value = |place: usize, index: usize| self.values[place][index].lane(lane).to_f64();
        let gaps = core::array::from_fn(|place| value(place, law));
        let speeds = (0..=QUARTERS).map(|place| value(place, count + law));
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
        if self.info.onsets.is_empty() || !accepted.any() {
            return never;
        }
        let model = &*self.models.all;
        let fresh = accepted.and(self.onsets.known.not());
        if fresh.any() {
            let [begin, .., any] = &mut self.onsets.values;
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

    /// The lanes in which nothing can have happened, by what is known at the ends of the step alone.
    #[inline(always)]
    fn quiet(&self) -> T::Mask {
        let c = T::Part::from_f64;
        let length = self.step.h.part(0);
        let finest = c(finest_gap(T::EPSILON > 1e-10));
        let mut quiet = c(self.info.every).lt(length).not();
        let count = self.info.onsets.len();
        let [begin, .., end, _] = &self.onsets.values;
        for law in 0..count {
            let (a, b) = (begin[law].part(0), end[law].part(0));
            let speed = begin[count + law].part(0).max(end[count + law].part(0));
            let lowest = a.min(b);
            let limit = c(DEEPER) * lowest.min(c(0.0)) - finest;
            let way = c(NEAR) * speed * length;
            let above = limit.lt(c(0.5) * (a + b - way)).and(limit.lt(lowest));
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
            let hunt = Hunt::new(length, self.info.onsets.len(), finest);
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
                match hunt.next(|law| self.onsets.course(law, i)) {
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
            let Onsets { values, hunts, .. } = &mut self.onsets;
            for (i, hunt) in hunts.iter_mut().enumerate() {
                if let Some(hunt) = hunt {
                    hunt.tell(values[ANY][hunt.law()].lane(i).to_f64());
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
        let [begin, .., end, _] = &mut self.onsets.values;
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
