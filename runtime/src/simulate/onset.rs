//! Whether a step went over something that began and ended in it: exclusion, by bounds that follow from the motion.
//!
//! Each law that may begin to act has a gap g, positive while it does not, and a speed c, by which g changes at most
//! ([`crate::Model::onsets`]). Between two places of a step that are a time d apart, with the gaps g₀ and g₁,
//!
//! g ≥ (g₀ + g₁ − c d)/2.
//!
//! Where that is above the limit, nothing is there. Elsewhere the gap is evaluated in the middle, on the step's interpolant, and both
//! halves are looked at, the first one first, until all is excluded or a place is found where g is below the limit. A motion close
//! by that does not touch would be halved without end: with the gap g in the middle, whose second difference is b = g₀ − 2 g + g₁, both
//! halves are excluded where min(g₀, g) − |b| and min(g, g₁) − |b| are above the limit. That holds of every convex function, such as the
//! distance of what moves straight past a ball, a plate or an edge, and of a parabola eight times over.
//!
//! **Limit.** 0, of a law that is idle at both ends. Of a law that acts at an end it is [`DEEPER`] times the lowest gap there: the
//! force at that end is seen by the estimate of the error, but not what is far deeper between. A law that is idle where the step begins is
//! found where it begins to act; of another any place that is so deep will do, and the next step sees its force.
//!
//! **Shortcuts.** Most steps need no search. A step is excluded by the gaps at three places that are known anyway, where the step before began and at the
//! ends of this one ([`straight`]), or with one more in the middle ([`calm`]): the gap bends too little to reach the limit.
//!
//! **Corners.** A force that acts already may change its slope at a corner of its curve: a soft layer over a hard ground. What is told of it is how
//! far the nearest corner is, positive on one side and negative on the other. Either side may be the one that is left and come back to, and so a
//! corner stands for two laws, one with that gap and one with its negative ([`sides`]). A step ends behind the first corner that it passes
//! without a sign of it at its end, or barely one.
//!
//! **Fixed steps** cannot be taken again. Where one goes over a law or a corner, it is told if that matters: what the rates at the deepest place
//! differ by from a straight line through those where the visit begins and as long before, times how long it lasts, is what the step did not
//! see ([`Visit`]). Of a law that acts at an end of the step, the line is that between both ends. A visit that would change no velocity by more
//! than [`UNSEEN`] of itself is as well resolved as what the step does see. A corner at which the step begins is not told: motions begin there.
//!
//! **What is assumed.** In a step that is no longer than the time between samples, no speed is more than [`NEAR`] times the larger of those at its
//! ends. Or no speed is more than [`STRAIGHT`] times that, and the second derivative of the gap is at most 4 times that of the parabola through the
//! three places. Or, with the gap in the middle, the second derivative is at most 8 times that of the parabola through the step's own three places,
//! and one of the conditions before holds. Any other step is searched: between the places that are looked at, quarters of a step or less, no speed
//! is more than [`MARGIN`] times the largest that was found. Where a second difference excludes, in eighths of a step or less, the gap is convex, or no
//! second derivative is above 8 times that of the parabola through the three.

use super::excursion::overshoot;
use crate::Real;
use crate::real::{Mask, Number};

/// How many times deeper than at the ends of a step a law must act within it to be looked at.
const DEEPER: f64 = 4.0;
/// How many times the speeds at the ends of a step may be exceeded in it where nothing else is looked at.
pub(crate) const NEAR: f64 = 4.0;
/// The same of a gap that hardly bends. What flies freely is never faster than at the faster one of two places.
const STRAIGHT: f64 = 1.05;
/// How many times the largest speed that was found may be exceeded.
const MARGIN: f64 = 1.5;
/// A step is looked at in its quarters before anything is halved.
pub(crate) const QUARTERS: usize = 4;
/// Halvings at most.
const LEVELS: usize = 50;
/// Halvings of a quarter before a second derivative counts: eighths of a step.
const RESOLVED: usize = 1;
/// Evaluations for one law in a quarter of a step; what is not excluded by then is left to a shorter step.
const PATIENCE: u32 = 500;
/// A place is found to this part of the way to it, or to this depth below the limit \[m, rad\].
const WIDTH: f64 = 1e-9;
const SHALLOW: f64 = 1e-7;
/// Where a search ends without an answer, at least this part of the step is taken.
const PART: f64 = 0.25;
/// Share of a velocity that a fixed step may miss without a word.
const UNSEEN: f64 = 0.01;
/// The same of a corner, where a force goes on that is there already, and how deep one must be passed \[m, rad\].
const UNSEEN_OF_CORNERS: f64 = 0.1;
const DEEP: f64 = 1e-5;
/// Velocities below this share of the fastest are measured by it: what rests does so but for roundings.
const SLOW: f64 = 1e-6;
/// Halvings of the way from where a law is found to the end of the step: of the places between, one is well within the visit.
const HALVINGS: u32 = 30;

/// Gaps below this are none \[m, rad\], of doubles and of scalars with few digits: what rounding leaves; of corners, whose curve acts on both
/// sides, what passes them by too little to matter.
pub(crate) const fn finest_gap(few_digits: bool, corner: bool) -> f64 {
    match (few_digits, corner) {
        (true, _) => 1e-5,
        (false, false) => 1e-12,
        (false, true) => 1e-9,
    }
}

/// The finest gaps of a touch and of a corner.
pub(crate) const fn finest_gaps(few_digits: bool) -> [f64; 2] {
    [finest_gap(few_digits, false), finest_gap(few_digits, true)]
}

/// How many laws are searched for, of so many onsets, of which the last are `corners`: these from both sides.
pub(crate) const fn sides(onsets: usize, corners: usize) -> usize {
    onsets + corners
}

/// Which onset such a law is, and whether it is the far side of a corner, where the gap is the negative.
#[inline(always)]
pub(crate) const fn onset_of(side: usize, onsets: usize, corners: usize) -> (usize, bool) {
    if side < onsets {
        (side, false)
    } else {
        (side - corners, true)
    }
}

/// A gap and where in a step it is, as a part of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    pub theta: f64,
    pub gap: f64,
}

/// The lowest gap that need not be looked for, by those at both ends of the step; `finest` is what rounding leaves of one.
#[inline(always)]
pub(crate) fn limit<P: Number>([a, b]: [P; 2], finest: f64) -> P {
    let c = P::from_f64;
    c(DEEPER) * a.min(b).min(c(0.0)) - c(finest)
}

/// Whether a gap stays above the limit between two places, if it changes by no more than `way` on the way from one to the other.
#[inline(always)]
fn stays_above<T: Real>([a, b]: [T; 2], way: T, limit: T) -> T::Mask {
    let lowest = T::from_f64(0.5) * (a + b - way);
    limit.lt(a).and(limit.lt(b)).and(limit.lt(lowest))
}

/// Whether a step of this length is excluded by the gaps at its ends, if no speed is above [`NEAR`] times `speed`.
#[inline(always)]
pub(crate) fn far<T: Real>(gaps: [T; 2], speed: T, length: T, limit: T) -> T::Mask {
    stays_above(gaps, T::from_f64(NEAR) * speed * length, limit)
}

/// Whether a step is excluded by the gaps where the step before began, where it begins and where it ends: they hardly bend, and no speed is above [`STRAIGHT`] times
/// `speed`. `lengths` are those of the step before, above 0, and of this one.
#[inline(always)]
pub(crate) fn straight<T: Real>(gaps: [T; 3], speed: T, lengths: [T; 2], limit: T) -> T::Mask {
    let way = T::from_f64(STRAIGHT) * speed * lengths[1];
    let above = [gaps[0] - limit, gaps[1] - limit, gaps[2] - limit];
    let bend = overshoot(above, lengths);
    let bends = T::from_f64(0.0).lt(bend);
    stays_above([gaps[1], gaps[2]], way, limit).and(bends.not())
}

/// Whether a step is excluded by the gaps where it begins, in its middle and where it ends, which hardly bend, and by one thing more: no speed is above
/// [`STRAIGHT`] times `speed`, or neither does the gap bend since the step before, as [`straight`] is told of it, if `known`.
#[inline(always)]
pub(crate) fn calm<T: Real>(
    [past, a, middle, b]: [T; 4],
    speed: T,
    lengths: [T; 2],
    known: T::Mask,
    limit: T,
) -> T::Mask {
    // 8 times as far as the parabola comes off the chord of a half
    let bend = (a - middle - middle + b).abs();
    let lowest = limit + bend;
    let bends_little = lowest.lt(a).and(lowest.lt(middle)).and(lowest.lt(b));
    let half = T::from_f64(0.5 * STRAIGHT) * speed * lengths[1];
    let slow = stays_above([a, middle], half, limit).and(stays_above([middle, b], half, limit));
    let since = overshoot([past - limit, a - limit, b - limit], lengths);
    let straight = known.and(T::from_f64(0.0).lt(since).not());
    bends_little.and(slow.or(straight))
}

/// What is searched for, one after the other as long as something is found: places below a limit, the first or any.
fn limits(ends: [f64; 2], finest: f64) -> [Option<(f64, bool)>; 2] {
    let touch = (-finest, true);
    let deep = (limit(ends, finest), false);
    match ends.map(|gap| gap > 0.0) {
        [true, true] => [Some(touch), None],
        [true, false] => [Some(deep), Some(touch)],
        [false, _] => [Some(deep), None],
    }
}

/// Whether no gap between two places a time `length` apart is below the limit, if no speed there is above `speed`.
pub(crate) fn excluded(gaps: [f64; 2], speed: f64, length: f64, limit: f64) -> bool {
    let [a, b] = gaps;
    a > limit && b > limit && 0.5 * (a + b - speed * length) > limit
}

/// The search for a law in a part of a step. It says where the gap is to be evaluated next ([`Search::next`]) and is told what it is
/// ([`Search::tell`]), so that a single run and a lane search alike.
#[derive(Clone, Copy, Debug)]
struct Search {
    /// Length of the whole step \[s\].
    length: f64,
    /// No speed is higher.
    speed: f64,
    limit: f64,
    /// Left end of the interval that is looked at; nothing is below the limit before it.
    left: Place,
    /// Right ends of it and of those around it, the innermost at `depth`.
    right: [Place; LEVELS + 1],
    depth: usize,
    /// Evaluations.
    taken: u32,
    /// Whether the first place is wanted, or any.
    first: bool,
    /// What came of it: the part of the step that is to be taken instead, if any.
    result: Option<Option<f64>>,
}

impl Search {
    /// In a step of this length, between two of its places, for the `first` place below the limit or any.
    pub fn new(length: f64, ends: [Place; 2], speed: f64, limit: f64, first: bool) -> Self {
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

    /// What came of it: the part of the step to be taken instead, which ends just behind the first place below the limit, or
    /// nothing where there is none. `None` while [`Search::next`] is to be evaluated.
    pub fn result(&self) -> Option<Option<f64>> {
        self.result
    }

    /// Where the gap is to be evaluated next, as a part of the step.
    pub fn next(&self) -> f64 {
        0.5 * (self.left.theta + self.right[self.depth].theta)
    }

    /// Where it may be evaluated after that: in the middle of either half, then in the middle of their halves.
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

    /// What the gap is there.
    pub fn tell(&mut self, gap: f64) {
        self.taken += 1;
        let (theta, right) = (self.next(), self.right[self.depth]);
        let bend = (self.left.gap - 2.0 * gap + right.gap).abs();
        let bend = (self.depth >= RESOLVED).then_some(bend);
        self.depth += 1;
        self.right[self.depth] = Place { theta, gap };
        if gap <= self.limit && !self.first {
            self.result = Some(Some(theta));
        } else if self.taken > PATIENCE {
            self.result = Some(Some(self.left.theta.max(PART)));
        } else {
            self.pass(bend);
        }
    }

    /// Leaves the intervals behind that are excluded. `bend` is the second difference over the innermost two, where it is to count.
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
            // it counts for the second half, too, but not for what is around both
            bend = bend.filter(|_| !second);
            second = true;
        }
    }
}

/// What is known of one law in a step: the gaps at its beginning, at the ends of its quarters and at its end, and the largest speed there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course {
    pub gaps: [f64; QUARTERS + 1],
    pub speed: f64,
}

/// The search for all laws in one step, one after the other. Like [`Search`] it asks and is told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hunt {
    /// Length of the step \[s\].
    length: f64,
    finest: [f64; 2],
    laws: usize,
    /// The first law that is a side of a corner.
    corners: usize,
    law: usize,
    /// Which of [`limits`].
    phase: usize,
    quarter: usize,
    /// Whether there is a second limit.
    second: bool,
    search: Option<Search>,
    /// The shortest part of the step to be taken instead, and because of which law.
    best: Option<(f64, usize)>,
}

impl Hunt {
    /// In a step of this length, for so many laws, of which those from `corners` on are sides of corners; `finest` as [`finest_gaps`].
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

    /// The law that is looked at.
    pub fn law(&self) -> usize {
        self.law
    }

    /// What came of it.
    pub fn best(&self) -> Option<(f64, usize)> {
        self.best
    }

    /// Where the gap of [`Hunt::law`] is to be evaluated next; `None` where all laws are done with.
    pub fn next(&mut self, course: impl Fn(usize) -> Course) -> Option<f64> {
        while self.law < self.laws {
            if let Some(search) = &self.search {
                match search.result() {
                    None => return Some(search.next()),
                    Some(None) => self.search = None,
                    Some(found) => self.ended(found),
                }
                continue;
            }
            let Course { gaps, speed } = course(self.law);
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
                let ends = [self.quarter, self.quarter + 1].map(|k| Place {
                    theta: k as f64 / QUARTERS as f64,
                    gap: gaps[k],
                });
                self.quarter += 1;
                if !excluded(ends.map(|end| end.gap), speed, length, limit) {
                    self.search = Some(Search::new(self.length, ends, speed, limit, first));
                }
            }
            if self.search.is_none() {
                self.ended(None);
            }
        }
        None
    }

    /// How many places [`Hunt::ahead`] knows of.
    #[cfg(feature = "std")]
    pub const AHEAD: usize = 6 + QUARTERS;

    /// A place at which a gap may be wanted after the next one, the likeliest first: about the next one, in the middle of the quarters that are
    /// left, for this law or another, and closer about the next one.
    #[cfg(feature = "std")]
    pub fn ahead(&self, k: usize) -> Option<f64> {
        const NEAREST: usize = 2;
        let search = self.search.as_ref()?;
        if (NEAREST..NEAREST + QUARTERS).contains(&k) {
            let quarter = (self.quarter + k - NEAREST) % QUARTERS;
            let [a, b] = [quarter, quarter + 1].map(|k| k as f64 / QUARTERS as f64);
            return Some(0.5 * (a + b));
        }
        let about = if k < NEAREST { k } else { k - QUARTERS };
        search.ahead().get(about).copied()
    }

    /// What the gap is there.
    pub fn tell(&mut self, gap: f64) {
        if let Some(search) = &mut self.search {
            search.tell(gap);
        }
    }

    /// A law was searched for below one of its limits.
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

/// A law that a fixed step went over: from where it was found, and how deep and how long it acts behind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Visit {
    found: f64,
    /// Whether the law acts where the step begins or ends.
    at_end: bool,
    /// Whether it is a corner.
    corner: bool,
    /// Whether the step begins at the corner, as motions do: what else begins in the step is not told apart from it.
    begins_there: bool,
    /// The deepest place that was looked at.
    deepest: Place,
    /// The farthest place behind at which the law acts.
    last: f64,
}

impl Visit {
    /// How many places are to be looked at.
    pub const PLACES: u32 = HALVINGS + 1;

    /// Found at this part of the step, with these gaps at its ends; of a law, or of a corner.
    pub fn new(found: f64, gaps: [f64; 2], corner: bool) -> Self {
        let deepest = Place {
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

    /// The place to be looked at as number `k`, from where it was found to half of what is left of the step.
    pub fn place(&self, k: u32) -> f64 {
        match k {
            0 => self.found,
            _ => self.found + (1.0 - self.found) / (1_u64 << k) as f64,
        }
    }

    /// What the gap is there.
    pub fn tell(&mut self, k: u32, gap: f64) {
        let theta = self.place(k);
        if gap < self.deepest.gap {
            self.deepest = Place { theta, gap };
        }
        if gap <= 0.0 {
            self.last = self.last.max(theta);
        }
    }

    /// Where it is deepest, as a part of the step.
    pub fn deepest(&self) -> f64 {
        self.deepest.theta
    }

    /// The places whose rates tell what the step sees where it is deepest.
    pub fn seen_from(&self) -> [f64; 2] {
        let before = 2.0 * self.found - self.deepest.theta;
        match self.at_end {
            true => [0.0, 1.0],
            false => [before.max(0.0), self.found],
        }
    }

    /// What the step sees where it is deepest, by what it sees at those places.
    pub fn seen(&self, [a, b]: [f64; 2]) -> f64 {
        let [from, to] = self.seen_from();
        let slope = if from < to {
            (b - a) / (to - from)
        } else {
            0.0
        };
        b + (self.deepest.theta - to) * slope
    }

    /// How long it lasts, as a part of the step: the next place that was looked at is twice as far and beyond.
    fn part(&self) -> f64 {
        match self.at_end {
            true => 1.0,
            false => (2.0 * (self.last - self.found)).min(1.0 - self.found),
        }
    }

    /// Whether it would have changed a velocity by more than [`UNSEEN`] of itself in a step of this length \[s\]; a corner by more than
    /// [`UNSEEN_OF_CORNERS`], and passed by more than [`DEEP`].
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
            // what is no number matters
            unseen.is_nan() || unseen > share * size.max(SLOW * fastest)
        })
    }
}

/// What is known of a velocity in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unseen {
    /// It at both ends.
    pub ends: [f64; 2],
    /// Its rate at the beginning.
    pub begin: f64,
    /// Its rate where a law is deepest, as the step sees it and as it is.
    pub seen: f64,
    pub rate: f64,
}
