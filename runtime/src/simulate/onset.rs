//! Finds laws that begin and end to act within one step, such as a contact that is passed over. Excludes them by bounds
//! that follow from the motion.
//!
//! Each law that may begin to act has a gap g, positive while the law is idle, and a speed c, a bound on how fast g
//! changes ([`crate::Model::onsets`]). Between two places of a step that are a time d apart, with the gaps g₀ and g₁,
//!
//! g ≥ (g₀ + g₁ − c d)/2.
//!
//! Where this bound is above the limit, the law does not act between the two places. Elsewhere the gap is evaluated in
//! the middle, on the step's interpolant, and both halves are examined, the first one first, until all are excluded or
//! a place with g below the limit is found. A motion that passes close by without touching would be halved without end.
//! Therefore a second test uses the gap g in the middle, with the second difference b = g₀ − 2 g + g₁: both halves are
//! excluded if min(g₀, g) − |b| and min(g, g₁) − |b| are above the limit. This is valid for every convex function, such
//! as the distance of a point that moves straight past a ball, a plate or an edge; for a parabola it has a margin of a
//! factor of eight.
//!
//! **Limit.** The limit is 0 for a law that is idle at both ends of the step. For a law that acts at an end it is
//! [`DEEPER`] times the lowest gap there: the error estimate notices the force at that end, but not a much deeper visit
//! between. For a law that is idle at the start of the step, the search finds the place where it begins to act; for any
//! other, some place below the limit is enough, and the next step then notices its force.
//!
//! **Shortcuts.** Most steps need no search. A step is excluded by the gaps at three places that are known anyway, at
//! the start of the previous step and at both ends of this one ([`straight`]), or with one more in the middle
//! ([`calm`]), if the gap bends too little to reach the limit.
//!
//! **Corners.** A force that acts already may change its slope at a corner of its curve: a soft layer over a hard
//! ground. The model reports the distance to the nearest corner, positive on one side and negative on the other. A
//! motion may leave either side and come back, so a corner stands for two laws, one with this gap and one with its
//! negative ([`sides`]). A step is ended behind the first corner that it passes with no, or hardly any, trace at its
//! end.
//!
//! **Fixed steps** cannot be taken again. If one passes over a law or a corner, this is reported if it matters. The
//! part of a rate that the step missed is estimated as follows ([`Visit`]): the rate at the deepest place, minus the
//! value there of a straight line through the rates where the visit begins and as long before, times the duration of
//! the visit. For a law that acts at an end of the step, the line is that between both ends. A visit that would change
//! no velocity by more than [`UNSEEN`] of itself is resolved well enough. A corner at which the step begins is not
//! reported, because motions begin at corners.
//!
//! **Assumptions.** A step no longer than the time between samples is excluded without a search under one of three
//! assumptions. (1) No speed is more than [`NEAR`] times the larger of those at its ends. (2) No speed is more than
//! [`STRAIGHT`] times that, and the second derivative of the gap is at most 4 times that of the parabola through the
//! three places. (3) With the gap in the middle: the second derivative is at most 8 times that of the parabola through
//! the step's own three places, and the speed or the bend condition of (2) holds. Any other step is searched, assuming
//! that between the places evaluated, quarters of a step or less, no speed is more than [`MARGIN`] times the largest
//! found. Where a second difference excludes, in eighths of a step or less, the gap is assumed to be convex, or to have
//! no second derivative above 8 times that of the parabola through the three places.

use super::excursion::overshoot;
use crate::Real;
use crate::real::{Mask, Number, mapped};

/// A visit of a law that acts at an end of a step is searched for if it gets this many times deeper within the step.
const DEEPER: f64 = 4.0;
/// Assumed bound on speeds in a step, over those at its ends, if nothing else is known.
pub(crate) const NEAR: f64 = 4.0;
/// Assumed bound on speeds if the gap hardly bends. A freely flying body is never faster than at the faster of two
/// places.
const STRAIGHT: f64 = 1.05;
/// Assumed bound on speeds in a search, over the largest speed found.
const MARGIN: f64 = 1.5;
/// A step is evaluated at its quarters before anything is halved.
pub(crate) const QUARTERS: usize = 4;
/// Largest number of halvings.
const LEVELS: usize = 50;
/// Depth from which a second difference may exclude a visit: 1 halving of a quarter, i.e. 1/8 step.
const RESOLVED: usize = 1;
/// Limit of evaluations for one law in a quarter of a step; if it is reached, a shorter step is taken.
const PATIENCE: u32 = 500;
/// Accuracy of a found place, as a share of its distance from the start of the step; or its depth below the limit \[m,
/// rad\].
const WIDTH: f64 = 1e-9;
const SHALLOW: f64 = 1e-7;
/// If a search is given up, at least this part of the step is taken.
const PART: f64 = 0.25;
/// Share of a velocity that a fixed step may miss without a report.
const UNSEEN: f64 = 0.01;
/// The same for a corner, where a force that acts already goes on; and how deep a corner must be passed to be reported
/// \[m, rad\].
const UNSEEN_OF_CORNERS: f64 = 0.1;
const DEEP: f64 = 1e-5;
/// Velocities below this share of the fastest are compared with that share of it: a resting body has velocities of
/// rounding size.
const SLOW: f64 = 1e-6;
/// Number of halvings of the way from where a law is found to the end of the step; one of these places lies well within
/// the visit.
const HALVINGS: u32 = 30;

/// Depth of a gap below which a contact is ignored \[m, rad\], for doubles and for scalars with few digits: for a
/// touch, the size of rounding; for a corner, whose curve acts on both sides, a passage too small to matter.
pub(crate) const fn finest_gap(few_digits: bool, corner: bool) -> f64 {
    match (few_digits, corner) {
        (true, _) => 1e-5,
        (false, false) => 1e-12,
        (false, true) => 1e-9,
    }
}

/// [`finest_gap`] for a touch and for a corner.
pub(crate) const fn finest_gaps(few_digits: bool) -> [f64; 2] {
    [finest_gap(few_digits, false), finest_gap(few_digits, true)]
}

/// Number of laws to search for: every onset, and once more the corners, which are searched from both sides. `corners`
/// counts the last onsets.
pub(crate) const fn sides(onsets: usize, corners: usize) -> usize {
    onsets + corners
}

/// The onset of a side, and true if the side is the far side of a corner, whose gap is the negative of the onset's.
#[inline(always)]
pub(crate) const fn onset_of(side: usize, onsets: usize, corners: usize) -> (usize, bool) {
    if side < onsets {
        (side, false)
    } else {
        (side - corners, true)
    }
}

/// A gap at a place of a step, given as a part of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct GapPoint {
    pub theta: f64,
    pub gap: f64,
}

/// The limit that a gap must fall below to be searched for, from the gaps at both ends of the step; `finest` as
/// [`finest_gap`].
#[inline(always)]
pub(crate) fn limit<P: Number>([a, b]: [P; 2], finest: f64) -> P {
    let c = P::from_f64;
    c(DEEPER) * a.min(b).min(c(0.0)) - c(finest)
}

/// True if a gap stays above the limit between two places, given that it changes by no more than `way` from one to the
/// other.
#[inline(always)]
fn stays_above<T: Real>([a, b]: [T; 2], way: T, limit: T) -> T::Mask {
    let lowest = T::from_f64(0.5) * (a + b - way);
    limit.lt(a).and(limit.lt(b)).and(limit.lt(lowest))
}

/// True if the gaps at its ends exclude a step of this length, given that no speed is above [`NEAR`] times `speed`.
#[inline(always)]
pub(crate) fn far<T: Real>(gaps: [T; 2], speed: T, length: T, limit: T) -> T::Mask {
    stays_above(gaps, T::from_f64(NEAR) * speed * length, limit)
}

/// True if a step is excluded by the gaps at the start of the previous step, at its start and at its end: they hardly
/// bend, and no speed is above [`STRAIGHT`] times `speed`. `lengths` are those of the previous step, above 0, and of
/// this one.
#[inline(always)]
pub(crate) fn straight<T: Real>(gaps: [T; 3], speed: T, lengths: [T; 2], limit: T) -> T::Mask {
    let way = T::from_f64(STRAIGHT) * speed * lengths[1];
    let above = [gaps[0] - limit, gaps[1] - limit, gaps[2] - limit];
    let bend = overshoot(above, lengths);
    let bends = T::from_f64(0.0).lt(bend);
    stays_above([gaps[1], gaps[2]], way, limit).and(bends.not())
}

/// True if a step is excluded by the gaps at its start, in its middle and at its end. They must hardly bend, and in
/// addition no speed is above [`STRAIGHT`] times `speed`, or the gap hardly bends since the previous step either, as in
/// [`straight`], if that step is `known`.
#[inline(always)]
pub(crate) fn calm<T: Real>(
    [past, a, middle, b]: [T; 4],
    speed: T,
    lengths: [T; 2],
    known: T::Mask,
    limit: T,
) -> T::Mask {
    // 8 times the distance of the parabola from the chord of a half
    let bend = (a - middle - middle + b).abs();
    let lowest = limit + bend;
    let bends_little = lowest.lt(a).and(lowest.lt(middle)).and(lowest.lt(b));
    let half = T::from_f64(0.5 * STRAIGHT) * speed * lengths[1];
    let slow = stays_above([a, middle], half, limit).and(stays_above([middle, b], half, limit));
    let since = overshoot([past - limit, a - limit, b - limit], lengths);
    let straight = known.and(T::from_f64(0.0).lt(since).not());
    bends_little.and(slow.or(straight))
}

/// The limits to search below, in this order as long as something is found; true if the first place below the limit is
/// wanted, false if any place will do.
fn limits(ends: [f64; 2], finest: f64) -> [Option<(f64, bool)>; 2] {
    let touch = (-finest, true);
    let deep = (limit(ends, finest), false);
    match mapped(ends, |gap| gap > 0.0) {
        [true, true] => [Some(touch), None],
        [true, false] => [Some(deep), Some(touch)],
        [false, _] => [Some(deep), None],
    }
}

/// True if no gap between two places, a time `length` apart, is below the limit, given that no speed is above `speed`.
pub(crate) fn excluded(gaps: [f64; 2], speed: f64, length: f64, limit: f64) -> bool {
    let [a, b] = gaps;
    a > limit && b > limit && 0.5 * (a + b - speed * length) > limit
}

/// The search for a law in a part of a step. [`Search::next`] says where to evaluate the gap next, and [`Search::tell`]
/// receives it, so that a single run and a lane search alike.
#[derive(Clone, Copy, Debug)]
struct Search {
    /// Length of the whole step \[s\].
    length: f64,
    /// Upper bound of the speed.
    speed: f64,
    limit: f64,
    /// Left end of the current interval; no gap before it is below the limit.
    left: GapPoint,
    /// Right ends of the current interval and of the intervals that contain it, the innermost at `depth`.
    right: [GapPoint; LEVELS + 1],
    depth: usize,
    /// Number of evaluations so far.
    taken: u32,
    /// True if the first place below the limit is wanted, false if any place will do.
    first: bool,
    /// The result, once the search is over: the part of the step to take instead, if there is one.
    result: Option<Option<f64>>,
}

impl Search {
    /// A search in a step of this length between two of its places, for the `first` place below the limit or for any.
    pub fn new(length: f64, ends: [GapPoint; 2], speed: f64, limit: f64, first: bool) -> Self {
        let mut search = Search {
            length,
            speed,
            limit,
            left: ends[0],
            right: [ends[1]; LEVELS + 1],
            depth: 0,
            taken: 0,
            first,
            result: None,
        };
        search.pass(None);
        search
    }

    /// The result: the part of the step to take instead, which ends just behind the first place below the limit, or
    /// `Some(None)` if there is no such place. `None` while the gap at [`Search::next`] is to be evaluated.
    pub fn result(&self) -> Option<Option<f64>> {
        self.result
    }

    /// The place at which the gap is to be evaluated next, as a part of the step.
    pub fn next(&self) -> f64 {
        0.5 * (self.left.theta + self.right[self.depth].theta)
    }

    /// The places at which the gap may be evaluated after the next one: in the middle of either half, then in the
    /// middle of their halves.
    #[cfg(feature = "std")]
    fn ahead(&self) -> [f64; 6] {
        let half = |a: f64, b: f64| 0.5 * (a + b);
        let (a, b) = (self.left.theta, self.right[self.depth].theta);
        let middle = self.next();
        let (left, right) = (half(a, middle), half(middle, b));
        let halves = [half(a, left), half(left, middle)];
        let behind = [half(middle, right), half(right, b)];
        [left, right, halves[0], halves[1], behind[0], behind[1]]
    }

    /// Takes the gap at the place [`Search::next`].
    pub fn tell(&mut self, gap: f64) {
        self.taken += 1;
        let (theta, right) = (self.next(), self.right[self.depth]);
        let bend = (self.left.gap - 2.0 * gap + right.gap).abs();
        let bend = (self.depth >= RESOLVED).then_some(bend);
        self.depth += 1;
        self.right[self.depth] = GapPoint { theta, gap };
        if gap <= self.limit && !self.first {
            self.result = Some(Some(theta));
        } else if self.taken > PATIENCE {
            self.result = Some(Some(self.left.theta.max(PART)));
        } else {
            self.pass(bend);
        }
    }

    /// Moves on past all excluded intervals. `bend` is the second difference over the innermost two, if it is to count.
    fn pass(&mut self, bend: Option<f64>) {
        let (mut bend, mut second) = (bend, false);
        loop {
            let right = self.right[self.depth];
            let width = right.theta - self.left.theta;
            let gaps = [self.left.gap, right.gap];
            let shallow = right.gap > self.limit - SHALLOW;
            let narrow = width <= WIDTH * right.theta || self.depth == LEVELS;
            if (narrow || shallow) && right.gap <= self.limit {
                self.result = Some(Some(right.theta));
                return;
            }
            let smooth = bend.is_some_and(|bend| gaps[0].min(gaps[1]) - bend > self.limit);
            let out = excluded(gaps, self.speed, width * self.length, self.limit);
            if !(smooth || out || self.depth == LEVELS) {
                return;
            }
            self.left = right;
            if self.depth == 0 {
                self.result = Some(None);
                return;
            }
            self.depth -= 1;
            // `bend` counts for the second half, too, but not for the intervals around both
            bend = bend.filter(|_| !second);
            second = true;
        }
    }
}

/// The gaps of one law at the start of a step, at the ends of its quarters and at its end, and the largest speed there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapCourse {
    pub gaps: [f64; QUARTERS + 1],
    pub speed: f64,
}

/// The search for all laws in one step, one after the other. Like [`Search`], it asks for gaps and is told them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hunt {
    /// Length of the step \[s\].
    length: f64,
    finest: [f64; 2],
    laws: usize,
    /// The index of the first law that is a side of a corner.
    corners: usize,
    law: usize,
    /// The current one of the [`limits`].
    phase: usize,
    quarter: usize,
    /// True if there is a second limit.
    second: bool,
    search: Option<Search>,
    /// The shortest part of the step to take instead, and the law that requires it.
    best: Option<(f64, usize)>,
}

impl Hunt {
    /// A search in a step of this length for this number of laws, of which those from `corners` on are sides of
    /// corners; `finest` as [`finest_gaps`].
    pub fn new(length: f64, laws: usize, corners: usize, finest: [f64; 2]) -> Self {
        Hunt {
            length,
            finest,
            laws,
            corners,
            law: 0,
            phase: 0,
            quarter: 0,
            second: false,
            search: None,
            best: None,
        }
    }

    /// The law that is being searched for.
    pub fn law(&self) -> usize {
        self.law
    }

    /// The shortest part of the step to take instead, and the law that requires it, once the search is over.
    pub fn best(&self) -> Option<(f64, usize)> {
        self.best
    }

    /// The place at which the gap of [`Hunt::law`] is to be evaluated next; `None` when all laws are done.
    pub fn next(&mut self, course: impl Fn(usize) -> GapCourse) -> Option<f64> {
        while self.law < self.laws {
            if let Some(search) = &self.search {
                match search.result() {
                    None => return Some(search.next()),
                    Some(None) => self.search = None,
                    Some(found) => self.ended(found),
                }
                continue;
            }
            let GapCourse { gaps, speed } = course(self.law);
            let of_ends = limits(
                [gaps[0], gaps[QUARTERS]],
                self.finest[usize::from(self.law >= self.corners)],
            );
            self.second = of_ends[1].is_some();
            let (Some((limit, first)), true) =
                (of_ends[self.phase], gaps.iter().all(|gap| gap.is_finite()))
            else {
                self.ended(None);
                continue;
            };
            let seen = gaps.iter().position(|gap| *gap <= limit);
            let seen = seen.filter(|_| !first && self.quarter == 0);
            if seen.is_some() {
                self.ended(seen.map(|k| k as f64 / QUARTERS as f64));
                continue;
            }
            let speed = MARGIN * speed;
            let length = self.length / QUARTERS as f64;
            while self.search.is_none() && self.quarter < QUARTERS {
                let ends = mapped([self.quarter, self.quarter + 1], |k| GapPoint {
                    theta: k as f64 / QUARTERS as f64,
                    gap: gaps[k],
                });
                self.quarter += 1;
                if !excluded(mapped(ends, |end| end.gap), speed, length, limit) {
                    self.search = Some(Search::new(self.length, ends, speed, limit, first));
                }
            }
            if self.search.is_none() {
                self.ended(None);
            }
        }
        None
    }

    /// The number of places that [`Hunt::ahead`] can name.
    #[cfg(feature = "std")]
    pub const AHEAD: usize = 6 + QUARTERS;

    /// A place at which a gap may be needed after the next one, the likeliest first: close to the next one, in the
    /// middle of the quarters left, for this law or another, and closer to the next one.
    #[cfg(feature = "std")]
    pub fn ahead(&self, k: usize) -> Option<f64> {
        const NEAREST: usize = 2;
        let search = self.search.as_ref()?;
        if (NEAREST..NEAREST + QUARTERS).contains(&k) {
            let quarter = (self.quarter + k - NEAREST) % QUARTERS;
            let [a, b] = mapped([quarter, quarter + 1], |k| k as f64 / QUARTERS as f64);
            return Some(0.5 * (a + b));
        }
        let about = if k < NEAREST { k } else { k - QUARTERS };
        search.ahead().get(about).copied()
    }

    /// Takes the gap at the place [`Hunt::next`].
    pub fn tell(&mut self, gap: f64) {
        if let Some(search) = &mut self.search {
            search.tell(gap);
        }
    }

    /// Ends the search for a law below one of its limits.
    fn ended(&mut self, found: Option<f64>) {
        (self.search, self.quarter) = (None, 0);
        match found {
            Some(_) if self.phase == 0 && self.second => self.phase = 1,
            Some(part) if self.best.is_none_or(|(best, _)| part < best) => {
                self.best = Some((part, self.law));
                self.next_law();
            }
            _ => self.next_law(),
        }
    }

    fn next_law(&mut self) {
        self.law += 1;
        self.phase = 0;
    }
}

/// A law that a fixed step passed over: where it was found, and how deep and how long it acts from there on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Visit {
    found: f64,
    /// True if the law acts at the start or at the end of the step.
    at_end: bool,
    /// True if the law is a side of a corner.
    corner: bool,
    /// True if the step begins at the corner, as motions do; another visit in this step cannot be told apart from that.
    begins_there: bool,
    /// The deepest place evaluated.
    deepest: GapPoint,
    /// The last evaluated place at which the law acts.
    last: f64,
}

impl Visit {
    /// The number of places to evaluate.
    pub const PLACES: u32 = HALVINGS + 1;

    /// A visit of a law or a `corner`, found at this part of the step, with these gaps at the ends of the step.
    pub fn new(found: f64, gaps: [f64; 2], corner: bool) -> Self {
        let deepest = GapPoint {
            theta: found,
            gap: f64::INFINITY,
        };
        Visit {
            found,
            at_end: gaps[0].min(gaps[1]) <= 0.0,
            corner,
            begins_there: corner && gaps[0].abs() < DEEP,
            deepest,
            last: found,
        }
    }

    /// Place number `k` to be evaluated: from where the law was found to half of the rest of the step.
    pub fn place(&self, k: u32) -> f64 {
        match k {
            0 => self.found,
            _ => self.found + (1.0 - self.found) / (1_u64 << k) as f64,
        }
    }

    /// Takes the gap at place number `k`.
    pub fn tell(&mut self, k: u32, gap: f64) {
        let theta = self.place(k);
        if gap < self.deepest.gap {
            self.deepest = GapPoint { theta, gap };
        }
        if gap <= 0.0 {
            self.last = self.last.max(theta);
        }
    }

    /// The place where the visit is deepest, as a part of the step.
    pub fn deepest(&self) -> f64 {
        self.deepest.theta
    }

    /// The two places whose rates give, by a straight line, the rate that the step assumes at the deepest place.
    pub fn seen_from(&self) -> [f64; 2] {
        let before = 2.0 * self.found - self.deepest.theta;
        match self.at_end {
            true => [0.0, 1.0],
            false => [before.max(0.0), self.found],
        }
    }

    /// The rate that the step assumes at the deepest place, from the rates at [`Visit::seen_from`].
    pub fn seen(&self, [a, b]: [f64; 2]) -> f64 {
        let [from, to] = self.seen_from();
        let slope = if from < to {
            (b - a) / (to - from)
        } else {
            0.0
        };
        b + (self.deepest.theta - to) * slope
    }

    /// The duration of the visit, as a part of the step. The next place evaluated was twice as far, and already outside
    /// of the visit.
    fn part(&self) -> f64 {
        match self.at_end {
            true => 1.0,
            false => (2.0 * (self.last - self.found)).min(1.0 - self.found),
        }
    }

    /// True if the visit would have changed a velocity by more than [`UNSEEN`] of itself in a step of this length
    /// \[s\]; for a corner, by more than [`UNSEEN_OF_CORNERS`], if it is passed by more than [`DEEP`].
    pub fn matters(&self, length: f64, all: impl Iterator<Item = Unseen> + Clone) -> bool {
        let (share, depth) = match self.corner {
            true => (UNSEEN_OF_CORNERS, DEEP),
            false => (UNSEEN, 0.0),
        };
        if self.begins_there || -self.deepest.gap < depth {
            return false;
        }
        let size = |v: &Unseen| v.ends[0].abs().max(v.ends[1].abs());
        let fastest = all.clone().map(|v| size(&v)).fold(0.0, f64::max);
        let mut all = all;
        all.any(|v| {
            let unseen = (v.rate - v.seen).abs() * self.part() * length;
            let size = size(&v).max(v.begin.abs() * length);
            // NaN matters
            unseen.is_nan() || unseen > share * size.max(SLOW * fastest)
        })
    }
}

/// A velocity and its rates in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unseen {
    /// The velocity at both ends of the step.
    pub ends: [f64; 2],
    /// Its rate at the start of the step.
    pub begin: f64,
    /// Its rate where a law is deepest: as the step assumes it, and as evaluated.
    pub seen: f64,
    pub rate: f64,
}
