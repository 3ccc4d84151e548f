//! Finds contacts and other laws that begin and end to act within one step of a run.

use super::{TimeLoop, finest_of};
use crate::integrate::Stepper;
use crate::real::Mask;
use crate::real::mapped;
use crate::simulate::Pace;
use crate::simulate::onset::{
    GapCourse, Hunt, QUARTERS, Unseen, Visit, calm, far, finest_gaps, limit, onset_of, sides,
    straight,
};
use crate::{Dynamics, Real};

/// A law that a step passed over.
#[derive(Clone, Copy)]
pub(super) struct Found {
    /// The part of the step at which the law was found to act.
    part: f64,
    /// The law, an index in [`sides`].
    side: usize,
    /// True if the law was found on the cubic instead of the step's own interpolant, which the force has spoiled.
    on_cubic: bool,
}

/// Two steps whose lengths differ by less than this share count as the same.
const SAME: f64 = 1e-9;

/// Gaps and speeds of all onsets: at the start of a step, at its end, at the ends of its quarters between, at one
/// further place, and at the start of the previous step.
pub(super) struct Onsets<'w, T> {
    /// All values. The places are start, end, three quarters between, further place, start of the previous step; each
    /// has all gaps, then all speeds.
    values: &'w mut [T],
    /// The number of onsets, and the number of corners, which are the last onsets.
    count: usize,
    corners: usize,
    finest: [f64; 2],
}

/// The number of places at which values are kept; then the indices of the further place and of the start of the
/// previous step.
pub(super) const KEPT: usize = 7;
const ANY: usize = 5;
const PAST: usize = 6;
const MIDDLE: usize = 3;
/// The index at which the values at the end of the step are kept.
pub(super) const STORED_END: usize = 1;
/// The places in their order within a step.
const IN_ORDER: [usize; QUARTERS + 1] = [0, 2, 3, 4, 1];

impl<'w, T: Real> Onsets<'w, T> {
    /// Onsets of a model with this many, the last of them corners. `values` has 2 [`KEPT`] scalars per onset.
    pub fn new(count: usize, corners: usize, values: &'w mut [T]) -> Self {
        Onsets {
            values,
            count,
            corners,
            finest: finest_gaps(T::from_f64(1.0 + 1e-10).to_f64() == 1.0),
        }
    }

    pub fn at(&mut self, place: usize) -> &mut [T] {
        &mut self.values[2 * place * self.count..][..2 * self.count]
    }

    /// The gap of a side; of several lanes the smallest.
    fn gap(&self, place: usize, side: usize) -> f64 {
        let (onset, far) = onset_of(side, self.count, self.corners);
        let gap = self.values[2 * place * self.count + onset];
        if far { -gap.to_f64() } else { -(-gap).to_f64() }
    }

    fn speed(&self, place: usize, side: usize) -> f64 {
        let (onset, _) = onset_of(side, self.count, self.corners);
        self.values[(2 * place + 1) * self.count + onset].to_f64()
    }

    /// Moves on to the next step, which begins where this one ended.
    pub fn advance(&mut self) {
        let place = |place: usize| 2 * place * self.count..2 * (place + 1) * self.count;
        self.values.copy_within(place(0), place(PAST).start);
        self.values.copy_within(place(STORED_END), 0);
    }

    /// Keeps a copy of the values at the end of the step.
    pub fn keep(&mut self) {
        let place = |place: usize| 2 * place * self.count..2 * (place + 1) * self.count;
        self.values.copy_within(place(STORED_END), place(ANY).start);
    }

    /// True if the values at the end of the step equal the copy that was kept.
    pub fn as_kept(&self) -> bool {
        let place = |place: usize| &self.values[2 * place * self.count..][..2 * self.count];
        place(STORED_END) == place(ANY)
    }

    fn course(&self, side: usize) -> GapCourse {
        let speeds = mapped(IN_ORDER, |place| self.speed(place, side));
        GapCourse {
            gaps: mapped(IN_ORDER, |place| self.gap(place, side)),
            speed: speeds.into_iter().fold(0.0, f64::max),
        }
    }

    /// The first of the [`sides`] that belongs to a corner.
    fn first_corner(&self) -> usize {
        self.count - self.corners
    }

    /// The depth of a side below which the search looks for a visit: a gap above this limit is ignored.
    fn limit(&self, side: usize) -> f64 {
        let finest = self.finest[usize::from(side >= self.first_corner())];
        limit([self.gap(0, side), self.gap(1, side)], finest)
    }

    /// True if the gap of `side` cannot have reached its limit within this step of the given `length`. Uses the gaps at
    /// both ends of the step and, if `past > 0`, at the start of the previous one, which is `past` long.
    fn quiet(&self, side: usize, past: f64, length: f64) -> bool {
        let [before, a, b] = mapped([PAST, 0, 1], |place| self.gap(place, side));
        let speed = self.speed(0, side).max(self.speed(1, side));
        let limit = self.limit(side);
        let [before, a, b, speed, length, limit] =
            mapped([before, a, b, speed, length, limit], T::from_f64);
        let lengths = [T::from_f64(past), length];
        far([a, b], speed, length, limit).all()
            || past > 0.0 && straight([before, a, b], speed, lengths, limit).all()
    }

    /// [`Onsets::quiet`] with the gap in the middle of the step known, too.
    fn calm(&self, side: usize, past: f64, length: f64) -> bool {
        let places = [0, MIDDLE, 1];
        let speed = mapped(places, |place| self.speed(place, side));
        let speed = speed.into_iter().fold(0.0, f64::max);
        let gaps = mapped([PAST, 0, MIDDLE, 1], |place| self.gap(place, side));
        let known = T::Mask::of_lanes(if past > 0.0 { u32::MAX } else { 0 });
        let [speed, limit] = mapped([speed, self.limit(side)], T::from_f64);
        let lengths = mapped([past, length], T::from_f64);
        calm(mapped(gaps, T::from_f64), speed, lengths, known, limit).all()
    }
}

impl<T: Real> TimeLoop<'_, '_, T> {
    /// The first law that acts within a step and shows nothing of this at the end of the step, if there is one.
    pub(super) fn stepped_over(&mut self, step: &mut dyn Stepper<T>) -> Option<Found> {
        let sides = self.sides();
        if sides == 0 {
            return None;
        }
        let length = step.span().h;
        let short = length <= self.settings.every;
        let past = self.past;
        if short && (0..sides).all(|side| self.onsets.quiet(side, past, length)) {
            return None;
        }
        self.search(step, length)
    }

    /// The number of [`sides`] to search.
    fn sides(&self) -> usize {
        sides(self.onsets.count, self.onsets.corners)
    }

    /// True if a step that passed over a law is to be taken again, only as far as `found.part`. Fixed steps are not
    /// taken again; the watch is told if the law matters.
    pub(super) fn turns_back(&mut self, step: &mut dyn Stepper<T>, found: Found) -> bool {
        match self.settings.method.pace {
            Pace::Fixed(_) => {
                if self.watch.is_none() {
                    return false;
                }
                let mut found = Some(found);
                while let Some(Found { side, on_cubic, .. }) = found {
                    if found.is_some_and(|found| self.matters(step, found)) {
                        let (onset, _) = onset_of(side, self.onsets.count, self.onsets.corners);
                        if let Some(watch) = &mut self.watch {
                            watch.step_over(step.span().t, onset);
                        }
                        break;
                    }
                    // a stage may have met the law, so that the step's own interpolant shows the visit at a wrong place
                    let length = step.span().h;
                    found = match on_cubic {
                        true => None,
                        false => self.search_cubic(step, length),
                    };
                }
                false
            }
            Pace::Adaptive(adaptive) => {
                let span = step.span();
                let length = found.part * span.h;
                let smallest = adaptive.smallest_step.max(finest_of::<T>(span.t));
                if span.h <= smallest || length > (1.0 - SAME) * span.h {
                    return false;
                }
                (self.h, self.approach) = (length, None);
                true
            }
        }
    }

    /// True if a law that a fixed step passed over would have changed the end of the step noticeably.
    #[cold]
    fn matters(&mut self, step: &mut dyn Stepper<T>, found: Found) -> bool {
        let Found {
            part,
            side,
            on_cubic,
        } = found;
        step.complete(&mut self.f);
        let step = &*step;
        let interpolant = |theta: f64, state: &mut [T]| {
            if !(on_cubic && step.cubic(theta, state)) {
                step.interpolate(theta, state);
            }
        };
        let span = step.span();
        let gaps = mapped([0, 1], |place| self.onsets.gap(place, side));
        let corner = side >= self.onsets.count - self.onsets.corners;
        let mut visit = Visit::new(part, gaps, corner);
        for k in 0..Visit::PLACES {
            self.onsets_within(&interpolant, span.h, visit.place(k), ANY);
            visit.tell(k, self.onsets.gap(ANY, side));
        }
        let [first, second] = visit.seen_from();
        for (theta, in_spare) in [(first, true), (second, false)] {
            let to = match in_spare {
                true => &mut *self.spare,
                false => &mut *self.f.found_at,
            };
            rate_within(
                self.model,
                [span.t, span.h],
                &interpolant,
                theta,
                self.inside,
                to,
            );
        }
        for (seen, second) in self.spare.iter_mut().zip(&*self.f.found_at) {
            *seen = T::from_f64(visit.seen([seen.to_f64(), second.to_f64()]));
        }
        rate_within(
            self.model,
            [span.t, span.h],
            &interpolant,
            visit.deepest(),
            self.inside,
            self.f.found_at,
        );
        let from = self.info.coordinates.len();
        let velocities = from..from + self.info.velocities.len();
        let unseen = velocities.map(|i| Unseen {
            ends: [span.y[i].to_f64(), span.end[i].to_f64()],
            begin: self.rate[i].to_f64(),
            seen: self.spare[i].to_f64(),
            rate: self.f.found_at[i].to_f64(),
        });
        visit.matters(span.h, unseen)
    }

    /// Searches a step for a law on its own interpolant, then on the cubic, because a force may have spoiled the first.
    #[inline(never)]
    fn search(&mut self, step: &mut dyn Stepper<T>, length: f64) -> Option<Found> {
        step.complete(&mut self.f);
        let own = self.search_on(&|theta, state| step.interpolate(theta, state), length);
        match own {
            Some((part, side)) => Some(Found {
                part,
                side,
                on_cubic: false,
            }),
            None => self.search_cubic(step, length),
        }
    }

    /// [`TimeLoop::search`] on the cubic interpolant, if the method has an interpolant of its own besides.
    fn search_cubic(&mut self, step: &dyn Stepper<T>, length: f64) -> Option<Found> {
        if !step.cubic(0.5, self.inside) {
            return None;
        }
        let cubic = |theta: f64, state: &mut [T]| {
            step.cubic(theta, state);
        };
        let (part, side) = self.search_on(&cubic, length)?;
        Some(Found {
            part,
            side,
            on_cubic: true,
        })
    }

    /// [`TimeLoop::search`] on one interpolant: in the middle of the step, at its quarters, and between them where
    /// these do not exclude a visit. Returns the part of the step and the side.
    fn search_on(
        &mut self,
        interpolant: &dyn Fn(f64, &mut [T]),
        length: f64,
    ) -> Option<(f64, usize)> {
        self.onsets_within(interpolant, length, 0.5, MIDDLE);
        let sides = self.sides();
        let (short, past) = (length <= self.settings.every, self.past);
        if short && (0..sides).all(|side| self.onsets.calm(side, past, length)) {
            return None;
        }
        for quarter in [1, 3] {
            self.onsets_within(interpolant, length, 0.25 * quarter as f64, 1 + quarter);
        }
        let onsets = &self.onsets;
        let mut hunt = Hunt::new(length, sides, onsets.first_corner(), onsets.finest);
        while let Some(theta) = hunt.next(|side| self.onsets.course(side)) {
            self.onsets_within(interpolant, length, theta, ANY);
            hunt.tell(self.onsets.gap(ANY, hunt.law()));
        }
        hunt.best()
    }

    /// Evaluates the onsets at the part `theta` of a step of this length, into the given place.
    fn onsets_within(
        &mut self,
        interpolant: &dyn Fn(f64, &mut [T]),
        length: f64,
        theta: f64,
        place: usize,
    ) {
        interpolant(theta, self.inside);
        self.model.normalize(self.inside);
        let t = T::from_f64(self.report.t + theta * length);
        self.model.onsets(t, self.inside, self.onsets.at(place));
    }
}

/// The derivative at the part `theta` of a step of this beginning and length \[s\], on an interpolant; `state` is
/// workspace. At the end of the step the derivative is taken just before, because the equations may change there at a
/// kink of a curve of time.
fn rate_within<T: Real>(
    model: &dyn Dynamics<T>,
    [begin, length]: [f64; 2],
    interpolant: &dyn Fn(f64, &mut [T]),
    theta: f64,
    state: &mut [T],
    rate: &mut [T],
) {
    interpolant(theta, state);
    model.normalize(state);
    let t = begin + theta.min(1.0 - f64::EPSILON) * length;
    model.derivative(T::from_f64(t), state, rate);
}
