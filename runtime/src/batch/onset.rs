//! Finds laws that begin and end to act within one step, in each lane, as [`crate::simulate`] does for a single run.

use super::arrays;
use super::onset_cache::OnsetCache;
use super::place::Places;
use super::run::{Run, Work, each, replace};
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several, mapped};
use crate::simulate::onset::{
    Hunt, QUARTERS, Unseen, Visit, calm, far, finest_gaps, limit, onset_of, sides, straight,
};
use crate::{Info, Real};

/// Places at which onsets are kept: the start of a step, the ends of its quarters, its end, one further place, and the
/// start of the previous step.
const PLACES: usize = QUARTERS + 3;
const MIDDLE: usize = QUARTERS / 2;
/// The place at the end of the step.
pub(super) const END_OF_STEP: usize = QUARTERS;
const ANY: usize = QUARTERS + 1;
const PAST: usize = QUARTERS + 2;

/// Gaps and speeds of the onsets in the step of each lane.
pub(super) struct Onsets<T: Several> {
    /// For each place all gaps, then all speeds.
    pub(super) values: [Box<[T]>; PLACES],
    /// The number of corners, which are the last onsets.
    corners: usize,
    hunts: Box<[Option<Hunt>]>,
    /// Values found within the steps that are searched.
    looked: OnsetCache,
    /// The side found last in the step of each lane, an index in [`sides`].
    found: [usize; MOST_LANES],
    /// Whether steps are evaluated on the cubic, which no inner stage spoils.
    on_cubic: bool,
    /// The first law that a fixed step of each lane's run passed over, an index in
    /// [`Info::onsets`](crate::Info::onsets).
    pub(super) missed: [Option<usize>; MOST_LANES],
    /// Workspace for rates, used with fixed steps.
    rates: [Box<[T]>; 3],
}

impl<T: Several> Onsets<T> {
    /// The onsets of a model.
    pub fn new(info: &Info, adaptive: bool) -> Self {
        let count = info.onsets.len();
        let nought = T::from_f64(0.0);
        let entries = match adaptive || count == 0 {
            true => 0,
            false => info.state_length(),
        };
        Onsets {
            values: arrays(nought, 2 * count),
            corners: info.corners,
            hunts: vec![None; if count > 0 { T::LANES } else { 0 }].into_boxed_slice(),
            looked: OnsetCache::new(count, info.corners),
            found: [0; MOST_LANES],
            on_cubic: false,
            missed: [None; MOST_LANES],
            rates: arrays(nought, entries),
        }
    }

    /// The number of laws to search for.
    #[inline(always)]
    fn sides(&self) -> usize {
        sides(self.count(), self.corners)
    }

    /// The gap of one of the sides.
    #[inline(always)]
    fn gap(&self, place: usize, side: usize) -> T::Part {
        let (onset, far) = onset_of(side, self.count(), self.corners);
        let gap = self.values[place][onset].part(0);
        if far { -gap } else { gap }
    }

    /// The gap of one of the sides in a lane.
    fn gap_in(&self, lane: usize, place: usize, side: usize) -> f64 {
        let (onset, far) = onset_of(side, self.count(), self.corners);
        let gap = self.values[place][onset].lane(lane).to_f64();
        if far { -gap } else { gap }
    }

    /// The larger speed of one of the sides at two places.
    #[inline(always)]
    fn speed(&self, [a, b]: [usize; 2], side: usize) -> T::Part {
        let (onset, _) = onset_of(side, self.count(), self.corners);
        let speed = self.count() + onset;
        self.values[a][speed]
            .part(0)
            .max(self.values[b][speed].part(0))
    }

    #[inline(always)]
    fn count(&self) -> usize {
        self.values[0].len() / 2
    }
}

/// [`Run::hunt`]
struct Chase<M>(M);

impl<T: Several> Work<T> for Chase<T::Mask> {
    type Output = T::Part;
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> T::Part {
        run.hunt(self.0)
    }
}

/// [`Run::quiet`]. Inlined at each of its calls, it made rows of a child seat in eight lanes a ninth slower.
struct Quiet;

impl<T: Several> Work<T> for Quiet {
    type Output = T::Mask;
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> T::Mask {
        run.quiet()
    }
}

/// [`Run::weigh`]
struct Weigh<M, P> {
    over: M,
    part: P,
}

impl<T: Several> Work<T> for Weigh<T::Mask, T::Part> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.weigh(self.over, self.part);
    }
}

impl<T: Several> Run<'_, T> {
    /// The part of each lane's step to take instead, because a law begins to act behind it and shows nothing of this at
    /// the end of the step; +∞ if there is none.
    #[inline(always)]
    pub(super) fn stepped_over(&mut self, accepted: T::Mask) -> T::Part {
        let never = T::Part::from_f64(f64::INFINITY);
        if self.onsets.sides() == 0 || !accepted.any() {
            return never;
        }
        let unclear = accepted.and(self.apart(Quiet).not());
        if !unclear.any() {
            return never;
        }
        self.apart(Chase(unclear))
    }

    /// Records laws that fixed steps passed over, if they matter; fixed steps cannot be taken again.
    #[inline(always)]
    pub(super) fn tell_missed(&mut self, accepted: T::Mask) {
        let never = T::Part::from_f64(f64::INFINITY);
        let part = self.stepped_over(accepted);
        let over = part.lt(never).and(accepted);
        if over.any() {
            self.apart(Weigh { over, part });
        }
        // a stage may have met the law, so that the step's own interpolant shows the visit at a wrong place
        if self.onsets.sides() == 0 || !self.step.has_cubic() {
            return;
        }
        let mut untold = accepted.and(self.apart(Quiet).not()).lanes() & ((1 << T::LANES) - 1);
        for i in each(untold) {
            if self.onsets.missed[i].is_some() {
                untold &= !(1 << i);
            }
        }
        if untold != 0 {
            self.onsets.on_cubic = true;
            let untold = T::Mask::of_lanes(untold);
            let part = self.apart(Chase(untold));
            let over = part.lt(never).and(untold);
            if over.any() {
                self.apart(Weigh { over, part });
            }
            self.onsets.on_cubic = false;
        }
    }

    /// Records the laws that the steps of these lanes passed over, each found at `part` of its step, if they matter.
    #[inline(always)]
    fn weigh(&mut self, over: T::Mask, part: T::Part) {
        let found = T::of_part(part);
        let mut visits = [Visit::new(0.5, [1.0; 2], false); MOST_LANES];
        let lanes = over.lanes();
        for i in each(lanes).take_while(|i| *i < T::LANES) {
            let side = self.onsets.found[i];
            let gaps = mapped([0, END_OF_STEP], |place| self.onsets.gap_in(i, place, side));
            let corner = side >= self.onsets.count() - self.onsets.corners;
            visits[i] = Visit::new(found.lane(i).to_f64(), gaps, corner);
        }
        for k in 0..Visit::PLACES {
            let theta = mapped(visits, |visit| T::One::from_f64(visit.place(k)));
            self.onsets_within(T::of_lanes(&theta), ANY);
            for i in each(lanes).take_while(|i| *i < T::LANES) {
                let gap = self.onsets.gap_in(i, ANY, self.onsets.found[i]);
                visits[i].tell(k, gap);
            }
        }
        self.rate_within(mapped(visits, |visit| visit.seen_from()[0]), 0);
        self.rate_within(mapped(visits, |visit| visit.seen_from()[1]), 1);
        self.rate_within(mapped(visits, |visit| visit.deepest()), 2);
        let from = self.info.coordinates.len();
        let velocities = from..from + self.info.velocities.len();
        for i in each(lanes).take_while(|i| *i < T::LANES) {
            let (step, visit) = (&self.step, visits[i]);
            let of = |entries: &[T], entry: usize| entries[entry].lane(i).to_f64();
            let rates = &self.onsets.rates;
            let unseen = velocities.clone().map(|entry| Unseen {
                ends: [of(&step.y, entry), of(&step.end, entry)],
                begin: of(&step.k[0], entry),
                seen: visit.seen([of(&rates[0], entry), of(&rates[1], entry)]),
                rate: of(&rates[2], entry),
            });
            if visit.matters(step.h.lane(i).to_f64(), unseen) {
                let Onsets { missed, found, .. } = &mut self.onsets;
                let (onset, _) = onset_of(found[i], self.info.onsets.len(), self.info.corners);
                missed[i].get_or_insert(onset);
            }
        }
    }

    /// The derivative within the steps, which must be complete, at a part of each; at the end of a step, the derivative
    /// just before it.
    #[inline(always)]
    fn rate_within(&mut self, parts: [f64; MOST_LANES], place: usize) {
        let model = &*self.models.all;
        let theta = T::of_lanes(&mapped(parts, T::One::from_f64));
        match self.onsets.on_cubic {
            true => self.step.on_cubic(model, theta, None, &mut self.state),
            false => self.step.inside(model, theta, &mut self.state),
        }
        let t = (theta * self.step.h + self.step.t).min(self.step.latest);
        model.derivative(t, &self.state, &mut self.onsets.rates[place]);
    }

    /// The depth of a side below which the search looks for a visit: a gap above this limit is ignored.
    #[inline(always)]
    fn limit(&self, side: usize) -> T::Part {
        let onsets = &self.onsets;
        let corner = usize::from(side >= onsets.count() - onsets.corners);
        let finest = finest_gaps(T::EPSILON > 1e-10)[corner];
        limit([onsets.gap(0, side), onsets.gap(END_OF_STEP, side)], finest)
    }

    /// The lanes whose steps are no longer than the time between samples.
    #[inline(always)]
    fn short(&self) -> T::Mask {
        let every = T::Part::from_f64(self.info.every);
        every.lt(self.step.h.part(0)).not()
    }

    /// The lanes in which no gap can have reached its limit, by the gaps at the ends of the step and at the start of
    /// the previous step.
    #[inline(always)]
    fn quiet(&self) -> T::Mask {
        let length = self.step.h.part(0);
        let known = T::Part::from_f64(0.0).lt(self.past);
        let onsets = &self.onsets;
        let mut quiet = self.short();
        for side in 0..onsets.sides() {
            let (a, b) = (onsets.gap(0, side), onsets.gap(END_OF_STEP, side));
            let (speed, limit) = (onsets.speed([0, END_OF_STEP], side), self.limit(side));
            let gaps = [onsets.gap(PAST, side), a, b];
            let straight = straight(gaps, speed, [self.past, length], limit).and(known);
            quiet = quiet.and(far([a, b], speed, length, limit).or(straight));
        }
        quiet
    }

    /// [`Run::quiet`] with the gaps in the middle of the step known, too.
    #[inline(always)]
    fn calm(&self) -> T::Mask {
        let length = self.step.h.part(0);
        let known = T::Part::from_f64(0.0).lt(self.past);
        let onsets = &self.onsets;
        let mut quiet = self.short();
        for side in 0..onsets.sides() {
            let (a, b) = (onsets.gap(0, side), onsets.gap(END_OF_STEP, side));
            let speed = onsets.speed([0, MIDDLE], side);
            let speed = speed.max(onsets.speed([MIDDLE, END_OF_STEP], side));
            let (past, middle) = (onsets.gap(PAST, side), onsets.gap(MIDDLE, side));
            let (gaps, lengths) = ([past, a, middle, b], [self.past, length]);
            quiet = quiet.and(calm(gaps, speed, lengths, known, self.limit(side)));
        }
        quiet
    }

    /// Searches the steps of these lanes. Returns the part of each step to take instead, +∞ if nothing is found.
    #[inline(always)]
    fn hunt(&mut self, lanes: T::Mask) -> T::Part {
        self.step.complete(&*self.models.all);
        // if there are few lanes, all their quarters fit in one register
        let among = lanes.lanes() & ((1 << T::LANES) - 1);
        let few = (QUARTERS - 1) * among.count_ones() as usize <= T::LANES;
        match few {
            true => self.look_at_quarters(among),
            false => self.onsets_within(T::from_f64(0.5), MIDDLE),
        }
        let lanes = lanes.and(self.calm().not());
        if !lanes.any() {
            return T::Part::from_f64(f64::INFINITY);
        }
        if !few {
            for quarter in [1, 3] {
                let theta = T::from_f64(quarter as f64 / QUARTERS as f64);
                self.onsets_within(theta, quarter);
            }
        }
        self.onsets.looked.begin(&self.onsets.values[..=QUARTERS]);
        let finest = finest_gaps(T::EPSILON > 1e-10);
        let laws = self.onsets.count() - self.onsets.corners;
        for i in each(lanes.lanes()).take_while(|i| *i < T::LANES) {
            let length = self.step.h.lane(i).to_f64();
            let hunt = Hunt::new(length, self.onsets.sides(), laws, finest);
            self.onsets.hunts[i] = Some(hunt);
        }
        let mut parts = [T::One::from_f64(f64::INFINITY); MOST_LANES];
        loop {
            let mut places = Places::new(0.0);
            let Onsets {
                hunts,
                looked,
                found,
                ..
            } = &mut self.onsets;
            for (i, place) in hunts.iter_mut().enumerate() {
                let Some(hunt) = place else {
                    continue;
                };
                if looked.go_on(i, hunt, &mut places) {
                    if let Some((part, law)) = hunt.best() {
                        parts[i] = T::One::from_f64(part);
                        found[i] = law;
                    }
                    *place = None;
                }
            }
            if places.is_empty() {
                break;
            }
            looked.look_ahead(hunts, T::LANES, &mut places);
            self.onsets_at(&mut places);
            let Onsets { looked, values, .. } = &mut self.onsets;
            looked.add(&places, &values[ANY]);
        }
        T::of_lanes(&parts).part(0)
    }

    /// Evaluates the onsets at the ends of the quarters of the steps of these lanes, all in one register; there must be
    /// room.
    #[inline(always)]
    fn look_at_quarters(&mut self, lanes: u32) {
        let (mut places, mut from) = (Places::new(0.0), [[0; MOST_LANES]; QUARTERS + 1]);
        let mut position = 0;
        for i in each(lanes) {
            for (quarter, from) in from.iter_mut().enumerate().take(QUARTERS).skip(1) {
                places.push(i, quarter as f64 / QUARTERS as f64);
                from[i] = position;
                position += 1;
            }
        }
        self.onsets_at(&mut places);
        let here = T::Mask::of_lanes(lanes);
        let [quarters @ .., _, any, _] = &mut self.onsets.values;
        for (values, from) in quarters.iter_mut().zip(&from).skip(1) {
            let order = T::order(from);
            for (value, found) in values.iter_mut().zip(&**any) {
                *value = T::select(here, found.ordered(order), *value);
            }
        }
    }

    /// Evaluates the onsets at several places of the steps, which must be complete, one place in each lane, into the
    /// further place.
    #[inline(always)]
    fn onsets_at(&mut self, places: &mut Places<f64>) {
        let order = self.pack(places);
        let step = &self.step;
        let theta = T::of_lanes(&mapped(*places.wanted(), T::One::from_f64));
        let model = &*self.models.packed;
        match self.onsets.on_cubic {
            true => step.on_cubic(model, theta, Some(order), &mut self.state),
            false => step.inside_in_order(model, theta, order, &mut self.state),
        }
        let t = theta * step.h.ordered(order) + step.t.ordered(order);
        model.onsets(t, &self.state, &mut self.onsets.values[ANY]);
    }

    /// Evaluates the onsets within the steps, which must be complete, into the given place.
    #[inline(always)]
    fn onsets_within(&mut self, theta: T, place: usize) {
        let model = &*self.models.all;
        match self.onsets.on_cubic {
            true => self.step.on_cubic(model, theta, None, &mut self.state),
            false => self.step.inside(model, theta, &mut self.state),
        }
        let t = theta * self.step.h + self.step.t;
        model.onsets(t, &self.state, &mut self.onsets.values[place]);
    }

    /// Moves on to the next step of these lanes, which begins where this one ended.
    #[inline(always)]
    pub(super) fn advance_onsets(&mut self, lanes: T::Mask) {
        let [begin, .., end, _, past] = &mut self.onsets.values;
        replace(lanes, past, begin);
        replace(lanes, begin, end);
    }
}
