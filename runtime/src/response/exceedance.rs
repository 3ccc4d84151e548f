//! A load beside a limit that falls with the duration of the load.
//!
//! To every duration belongs the level that the size of the signal exceeds for this long in total. The answer is the
//! largest ratio of such a level to the limit of its duration. The size is linear between samples. So between
//! neighbouring values of samples the duration is linear in the level, between corners the limit is linear in the
//! duration, and a quotient of two linear functions has no maximum inside. The largest ratio is at the value of a
//! sample, or at a corner of the limit.

use crate::real::mapped;
use crate::{Mask, Real};

/// The largest number of corners of a limit.
const MOST: usize = 4;

/// The relative difference of durations that counts as rounding.
const HAIR: f64 = 1e-12;

/// The relative difference of ratios that counts as rounding: some times that of durations, because a limit falls.
const SAME: f64 = 1e-10;

/// A limit that falls with the duration of a load: straight lines between corners, constant behind the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingLimit {
    /// Durations \[s\] and levels; the last corner is repeated where there are fewer.
    corners: [[f64; 2]; MOST],
}

impl FallingLimit {
    /// A limit by its corners, each a duration \[s\] and a level. `None` unless there are one to four, the first at the
    /// duration 0, with durations that increase and positive levels that do not.
    pub const fn new(corners: &[[f64; 2]]) -> Option<Self> {
        if corners.is_empty() || corners.len() > MOST || corners[0][0] != 0.0 {
            return None;
        }
        let mut all = [corners[corners.len() - 1]; MOST];
        let mut i = 0;
        while i < corners.len() {
            let [duration, level] = corners[i];
            let falls = i == 0 || corners[i - 1][0] < duration && level <= corners[i - 1][1];
            if !(falls && 0.0 < level && level < f64::INFINITY && duration < f64::INFINITY) {
                return None;
            }
            all[i] = corners[i];
            i += 1;
        }
        Some(FallingLimit { corners: all })
    }

    /// The limit for a duration \[s\].
    #[inline(always)]
    pub fn at<T: Real>(&self, duration: T) -> T {
        let num = T::from_f64;
        let mut limit = num(self.corners[0][1]);
        for [[from, high], [to, low]] in self.corners.windows(2).map(|pair| [pair[0], pair[1]]) {
            if from < to {
                // equal to 1 from `to` on, so that the level of a corner has no rounding error
                let part = (duration.max(num(from)).min(num(to)) - num(from)) / num(to - from);
                limit += part * num(low - high);
            }
        }
        limit
    }

    /// Its corners, each a duration \[s\] and a level; the last is repeated where there are fewer than four.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }
}

/// The largest ratio of a load to the limit of its duration, and that duration \[s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceedance<T> {
    /// The ratio; at most 1 where the limit is kept.
    pub ratio: T,
    /// \[s\]
    pub duration: T,
}

/// The largest ratio for a signal of these points, each a time \[s\] and a size; the signal has this `length` \[s\].
/// `level` is the level that the size exceeds for a duration \[s\]; `None` if the signal is shorter.
///
/// Durations are halved until few samples lie between the levels of both ends. Where even the higher level is less
/// beside the lower limit than another one, no sample in between matters.
#[inline(always)]
pub(super) fn worst<T: Real>(
    limit: &FallingLimit,
    points: impl Iterator<Item = [T; 2]> + Clone,
    length: f64,
    mut level: impl FnMut(f64) -> Option<T>,
) -> Exceedance<T> {
    let num = T::from_f64;
    let mut worst = Exceedance {
        ratio: num(0.0),
        duration: num(0.0),
    };
    let corners = mapped(limit.corners, |[duration, _]| (duration, level(duration)));
    let mut take = |level: T| {
        let duration = time_over(level, points.clone());
        let ratio = level / limit.at(duration * num(1.0 - HAIR));
        worst.take(ratio, duration, worst.ratio);
    };
    // a ratio that is reached, or more
    let mut reached = num(0.0);
    let mut open = [Span::none(); MOST_SPANS];
    let mut count = 0;
    let mut from = (0.0, corners[0].1.unwrap_or(num(0.0)));
    for (duration, of_corner) in corners {
        let to = match of_corner {
            Some(level) => Some((duration, level)),
            None => level(length).map(|level| (length, level)),
        };
        let Some(to) = to else {
            continue;
        };
        reached = reached.max(to.1 / limit.at(num(to.0)));
        if from.0 < to.0 {
            (open[count], count) = (Span { from, to }, count + 1);
            from = to;
        }
    }
    // behind the last corner the limit falls no more
    take(from.1);
    let mut before = num(f64::NAN);
    while let Some(last) = count.checked_sub(1) {
        count = last;
        let span = open[count];
        let most = span.from.1 / limit.at(num(span.to.0)) * num(1.0 + SLACK);
        if most.lt(reached).all() {
            continue;
        }
        let inside = |size: T| span.to.1.lt(size).and(span.from.1.lt(size).not()).any();
        let samples = points.clone().filter(|[_, size]| inside(*size)).count();
        let middle = 0.5 * (span.from.0 + span.to.0);
        let wide = span.to.0 - span.from.0 > SHORT * span.to.0;
        let halves = samples > FEW && wide && count + 2 <= MOST_SPANS;
        match level(middle).filter(|_| halves) {
            Some(level) => {
                let middle = (middle, level);
                reached = reached.max(level / limit.at(num(middle.0)));
                open[count] = Span {
                    from: span.from,
                    to: middle,
                };
                open[count + 1] = Span {
                    from: middle,
                    to: span.to,
                };
                count += 2;
            }
            None => {
                for [_, size] in points.clone() {
                    if size != before && inside(size) {
                        take(size);
                        before = size;
                    }
                }
            }
        }
    }
    for (duration, level) in corners {
        if let Some(level) = level {
            // of ratios that differ by rounding, that of a sample with the whole of its duration is the one to be named
            let least = worst.ratio * num(1.0 + SAME);
            worst.take(level / limit.at(num(duration)), num(duration), least);
        }
    }
    worst
}

/// Durations with the levels that are exceeded for them: the shortest and the longest.
#[derive(Clone, Copy)]
struct Span<T> {
    from: (f64, T),
    to: (f64, T),
}

impl<T: Real> Span<T> {
    fn none() -> Self {
        let none = (0.0, T::from_f64(0.0));
        Span {
            from: none,
            to: none,
        }
    }
}

/// The largest number of spans that wait: the durations between four corners, halved twenty times.
const MOST_SPANS: usize = 40;

/// The number of samples that are compared one by one.
const FEW: usize = 16;

/// The share of a duration below which it is not halved any more: a signal may stay on one value for many samples.
const SHORT: f64 = 1e-6;

/// The relative difference of ratios that are still compared.
const SLACK: f64 = 1e-9;

impl<T: Real> Exceedance<T> {
    /// Takes a ratio that is larger than `least`.
    #[inline(always)]
    fn take(&mut self, ratio: T, duration: T, least: T) {
        let larger = least.lt(ratio);
        self.ratio = T::select(larger, ratio, self.ratio);
        self.duration = T::select(larger, duration, self.duration);
    }
}

/// The time for which the line through points is at or above a level \[s\].
#[inline(always)]
fn time_over<T: Real>(level: T, mut points: impl Iterator<Item = [T; 2]>) -> T {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let mut sum = zero;
    let Some(mut a) = points.next() else {
        return sum;
    };
    for b in points {
        let (low, high) = (a[1].min(b[1]), a[1].max(b[1]));
        let (touches, crosses) = (high.lt(level).not(), low.lt(level));
        if touches.any() {
            let rise = T::select(crosses.and(touches), high - low, one);
            let part = T::select(crosses, (high - level) / rise, one);
            sum += T::select(touches, (b[0] - a[0]) * part, zero);
        }
        a = b;
    }
    sum
}
