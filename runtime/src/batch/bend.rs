//! Finds joints that are bent through 180° within the steps of lanes, where flexion has no direction. Passing 180°
//! turns the bearing by half a turn. As in the watch of a single run, a step is searched if its bearing turned by more
//! than a sixteenth of a turn from start to end, or if the joint is bent by more than 90° at only one end. The same is
//! done for the direction in which two ellipsoids push each other, which leaps if they sink through each other.
//!
//! The arguments of curves of the state are also checked at the end of each step: if one is so far outside its points
//! that the value is made up ([`CurveInfo::trusted`]), the run is doubtful.

use super::copies;
use super::run::{Run, Work, each};
use crate::leap::Turning;
use crate::model::CurveInfo;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::{Info, Real};

/// The bearings of joints and the directions of contacts, in each lane.
type Bearings = Box<[[Turning; MOST_LANES]]>;

/// The state of this search for all lanes.
pub(super) struct Bends<T: Several> {
    /// For each bearing or direction, its first entry in [`Info::curves`], and its number of entries.
    bearings: Box<[(usize, usize)]>,
    /// The curves whose argument may go too far outside, as indices in [`Info::curves`], each with the range of
    /// arguments that is trusted.
    curves: Box<[(usize, [f64; 2])]>,
    /// Workspace for the arguments of all curves of the state; empty if there is nothing to check.
    pub(super) arguments: Box<[T]>,
    /// The bearings at the start and at the end of the step, at the ends of a piece of it, and at the place evaluated
    /// last.
    begin: Bearings,
    end: Bearings,
    before: Bearings,
    after: Bearings,
    now: Bearings,
    /// The first bearing that leapt in the run of each lane, an index in [`Info::curves`].
    pub(super) leapt: [Option<usize>; MOST_LANES],
    /// The first curve of each lane's run that was left too far, an index in [`Info::curves`].
    pub(super) left: [Option<usize>; MOST_LANES],
}

impl<T: Several> Bends<T> {
    pub(super) fn new(info: &Info) -> Self {
        let curves = info.curves.iter().enumerate();
        let bearings: Box<[(usize, usize)]> = curves
            .filter_map(|(index, curve)| Some((index, curve.turning(info.dimension)?)))
            .collect();
        let room = || copies([[f64::NAN; 3]; MOST_LANES], bearings.len());
        let curves = info.curves.iter().map(CurveInfo::trusted).enumerate();
        let may_end = |(_, [from, to]): &(usize, [f64; 2])| from.is_finite() || to.is_finite();
        let curves: Box<[(usize, [f64; 2])]> = curves.filter(may_end).collect();
        let arguments = match bearings.is_empty() && curves.is_empty() {
            true => 0,
            false => info.curves.len(),
        };
        Bends {
            arguments: copies(T::from_f64(0.0), arguments),
            begin: room(),
            end: room(),
            before: room(),
            after: room(),
            now: room(),
            bearings,
            curves,
            leapt: [None; MOST_LANES],
            left: [None; MOST_LANES],
        }
    }

    /// Clears the findings of a lane, for a new run.
    pub(super) fn forget(&mut self, lane: usize) {
        (self.leapt[lane], self.left[lane]) = (None, None);
    }

    /// Checks the arguments of curves in these lanes.
    #[inline(always)]
    fn look_at_curves(&mut self, lanes: T::Mask) {
        for (curve, [from, to]) in &self.curves {
            let argument = self.arguments[*curve].part(0);
            let below = argument.lt(T::Part::from_f64(*from));
            let beyond = below.or(T::Part::from_f64(*to).lt(argument)).and(lanes);
            for i in each(beyond.lanes()).take_while(|i| *i < T::LANES) {
                self.left[i].get_or_insert(*curve);
            }
        }
    }

    /// Copies the bearings from the arguments of all curves.
    fn read(&mut self) {
        for (now, (first, count)) in self.now.iter_mut().zip(&self.bearings) {
            let entries = &self.arguments[*first..][..*count];
            for (i, now) in now.iter_mut().enumerate().take(T::LANES) {
                *now = [0.0; 3];
                for (now, entry) in now.iter_mut().zip(entries) {
                    *now = entry.lane(i).to_f64();
                }
            }
        }
    }

    /// The lanes, among these, whose steps are to be searched: those that are suspect, and had no leap yet in their
    /// run.
    fn suspected(&self, info: &Info, lanes: u32) -> u32 {
        let mut suspected = 0;
        for i in each(lanes).filter(|i| self.leapt[*i].is_none()) {
            let places = self.bearings.iter().zip(self.begin.iter().zip(&self.end));
            let mut places = places.map(|((first, _), (begin, end))| (first, [begin[i], end[i]]));
            let is = places.any(|(first, ends)| info.curves[*first].may_leap(ends));
            suspected |= u32::from(is) << i;
        }
        suspected
    }
}

/// [`Run::look_for_leaps`]
struct LookWithin<T> {
    lanes: u32,
    part: T,
}

impl<T: Several> Work<T> for LookWithin<T> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.look_for_leaps(self.lanes, self.part);
    }
}

impl<T: Several> Run<'_, T> {
    /// Sets the bearings at the start of the runs in these lanes.
    #[inline(always)]
    pub(super) fn begin_bends(&mut self, lanes: T::Mask) {
        if self.bends.arguments.is_empty() {
            return;
        }
        let bends = &mut self.bends;
        self.models
            .all
            .curves(self.step.t, &self.step.y, &mut bends.arguments);
        bends.look_at_curves(lanes);
        bends.read();
        for i in each(lanes.lanes()).take_while(|i| *i < T::LANES) {
            for (begin, now) in bends.begin.iter_mut().zip(&bends.now) {
                begin[i] = now[i];
            }
        }
    }

    /// Checks curves and bearings at the end of steps in these lanes, of which only the first `part` is kept. The
    /// arguments of curves there must have been evaluated.
    #[inline(always)]
    pub(super) fn advance_bends(&mut self, lanes: T::Mask, part: T) {
        if self.bends.arguments.is_empty() {
            return;
        }
        let bends = &mut self.bends;
        bends.look_at_curves(lanes);
        if bends.bearings.is_empty() {
            return;
        }
        bends.read();
        bends.end.copy_from_slice(&bends.now);
        let lanes = lanes.lanes() & ((1 << T::LANES) - 1);
        let lanes_within = bends.suspected(self.info, lanes);
        if lanes_within != 0 {
            self.apart(LookWithin {
                lanes: lanes_within,
                part,
            });
        }
        let bends = &mut self.bends;
        for i in each(lanes) {
            for (begin, end) in bends.begin.iter_mut().zip(&bends.end) {
                begin[i] = end[i];
            }
        }
    }

    /// Searches the steps of these lanes for leaps of bearings.
    #[inline(always)]
    fn look_for_leaps(&mut self, lanes: u32, part: T) {
        self.step.complete(&*self.models.all);
        let Bends { before, begin, .. } = &mut self.bends;
        before.copy_from_slice(begin);
        let pieces = f64::from(CurveInfo::PIECES);
        for piece in 1..=CurveInfo::PIECES {
            let places = [f64::from(piece - 1) / pieces, f64::from(piece) / pieces];
            if piece < CurveInfo::PIECES {
                self.bearings_within(part * T::from_f64(places[1]));
                let Bends { after, now, .. } = &mut self.bends;
                after.copy_from_slice(now);
            } else {
                let Bends { after, end, .. } = &mut self.bends;
                after.copy_from_slice(end);
            }
            for k in 0..self.bends.bearings.len() {
                let first = self.bends.bearings[k].0;
                let curve = &self.info.curves[first];
                let ends = [self.bends.before[k], self.bends.after[k]];
                for i in each(lanes) {
                    let mut apart = [(places[0], ends[0][i]), (places[1], ends[1][i])];
                    let mut halvings = 0;
                    while curve.leaps(apart) && halvings < CurveInfo::HALVINGS {
                        let middle = 0.5 * (apart[0].0 + apart[1].0);
                        self.bearings_within(part * T::from_f64(middle));
                        apart = curve.half(apart, (middle, self.bends.now[k][i]));
                        halvings += 1;
                    }
                    // a leap that causes another takes precedence
                    let free = self.bends.leapt[i]
                        .is_none_or(|found| self.info.curves[found].leaps_with(curve));
                    if free && curve.leaps(apart) {
                        self.bends.leapt[i] = Some(first);
                    }
                }
            }
            let Bends { before, after, .. } = &mut self.bends;
            before.copy_from_slice(after);
        }
    }

    /// Evaluates the bearings within the steps, which must be complete.
    #[inline(always)]
    fn bearings_within(&mut self, theta: T) {
        let model = &*self.models.all;
        self.step.inside(model, theta, &mut self.state);
        let t = theta * self.step.h + self.step.t;
        model.curves(t, &self.state, &mut self.bends.arguments);
        self.bends.read();
    }
}
