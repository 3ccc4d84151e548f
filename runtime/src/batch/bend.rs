//! Joints that are bent through 180° within the steps of lanes, where flexion has no direction. What goes through 180° turns its bearing by half a
//! turn: a step is looked into, as the watch of a single run does, where the bearing turned by more than a sixteenth of a turn from its
//! beginning to its end, or the joint is bent by more than 90° at one of them alone. So is the direction in which two ellipsoids push each
//! other, which leaps where they sink through each other.
//!
//! Curves of the state, too, are looked at where each step ends: one that is left so far that what it gives is made up
//! ([`CurveInfo::trusted`]) makes a run doubtful.

use super::copies;
use super::run::{Run, Section, each};
use crate::leap::Turning;
use crate::model::CurveInfo;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::{Info, Real};

/// The bearings of a model's bent joints and the directions of its contacts, of each lane.
type Bearings = Box<[[Turning; MOST_LANES]]>;

/// What is known of bent joints, and of pairs of ellipsoids.
pub(super) struct Bends<T: Several> {
    /// Which they are, the first of their entries in [`Info::curves`], and how many entries each has.
    bearings: Box<[(usize, usize)]>,
    /// The curves that may be left too far, indices in [`Info::curves`], and how far is not too far.
    curves: Box<[(usize, [f64; 2])]>,
    /// Room for the arguments of all curves of the state; none where nothing is looked at.
    pub(super) arguments: Box<[T]>,
    /// Where the step begins and ends, where a piece of it does, and where they were asked for last.
    begin: Bearings,
    end: Bearings,
    before: Bearings,
    after: Bearings,
    now: Bearings,
    /// The first bearing that leapt in the run of each lane, an index in [`Info::curves`].
    pub(super) leapt: [Option<usize>; MOST_LANES],
    /// The first curve that was left too far in it, an index in [`Info::curves`].
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

    /// Nothing is known of the run that begins in a lane.
    pub(super) fn forget(&mut self, lane: usize) {
        (self.leapt[lane], self.left[lane]) = (None, None);
    }

    /// Looks at the curves of these lanes, whose arguments are known.
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

    /// Takes the bearings out of the arguments of all curves.
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

    /// The lanes of these whose steps are to be looked into, in whose runs nothing leapt before.
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

/// Looks into the steps of some lanes, of which a part counts.
struct LookWithin<T> {
    lanes: u32,
    part: T,
}

impl<T: Several> Section<T> for LookWithin<T> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.look_for_leaps(self.lanes, self.part);
    }
}

impl<T: Several> Run<'_, T> {
    /// Runs begin in these lanes.
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

    /// Steps end in these lanes, of which the first `part` counts: the arguments of curves there are known.
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

    /// Looks for leaps in the steps of these lanes.
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
                    // a cause counts before what follows from it
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

    /// The bearings within the steps, which are complete.
    #[inline(always)]
    fn bearings_within(&mut self, theta: T) {
        let model = &*self.models.all;
        self.step.inside(model, theta, &mut self.state);
        let t = theta * self.step.h + self.step.t;
        model.curves(t, &self.state, &mut self.bends.arguments);
        self.bends.read();
    }
}
