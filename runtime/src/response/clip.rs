//! The level that a signal exceeds for a duration: in all, or without a break. The signal is linear between samples, which errs by
//! the square of their interval.
//!
//! In all: the time over a level falls with the level, linearly between neighbouring values of samples, and jumps where the signal
//! stays on one. Newton's step from any level is exact if it stays between the neighbours; if not, all up to a neighbour is ruled
//! out, so that there is an end, and by halving a soon one.
//!
//! Without a break, it is the largest of the smallest values within a window. The smallest value is the least of both edges and
//! of the samples between, so that the window that has the largest begins or ends on a sample, or else rises at its
//! beginning, falls at its end, and has both edges on one level.

use super::whole_and_rest;
use crate::{Mask, Real};

/// The level that is exceeded for so many intervals in all; `None` where the signal is shorter.
#[inline(always)]
pub(super) fn cumulative<T: Real>(samples: &[T], intervals: f64, scratch: &mut [T]) -> Option<T> {
    let (whole, rest) = whole_and_rest(intervals, samples.len().checked_sub(1)?)?;
    let num = T::from_f64;
    let (mut low, mut high, mut taint) = (samples[0], samples[0], num(0.0));
    for sample in samples {
        low = low.min(*sample);
        high = high.max(*sample);
        taint += sample.taint();
    }
    if whole == 0 && rest == 0.0 {
        return Some(high);
    }
    // lanes with a sample that is no number have nothing between
    high += taint;

    let (pairs, _) = scratch.as_chunks_mut::<2>();
    for (pair, neighbours) in pairs.iter_mut().zip(samples.windows(2)) {
        let (a, b) = (neighbours[0], neighbours[1]);
        *pair = [a.min(b), a.max(b)];
    }
    let (mut left, mut over) = (samples.len() - 1, num(0.0));
    let mut level = middle(low, high);
    // every pass rules out a value of a sample
    for _ in 1..samples.len() {
        let open = low.lt(high);
        if !open.any() {
            break;
        }
        let time;
        (left, time) = time_over(level, [low, high], &mut pairs[..left], &mut over);
        let excess = (over + time.whole - num(whole as f64)) + (time.parts - num(rest));
        let fall = T::select(num(0.0).lt(time.fall), time.fall, num(1.0));
        let solved = level + excess / fall;

        let short = excess.lt(num(0.0));
        let beyond = short
            .and(solved.lt(time.below))
            .or(short.not().and(time.above.lt(solved)));
        let before = high - low;
        let to_low = T::select(beyond, T::select(short, low, time.above), solved);
        let to_high = T::select(beyond, T::select(short, time.below, high), solved);
        low = T::select(open, to_low, low);
        high = T::select(open, to_high, high);

        // Newton's step, or half way if the last one did not come so far; within what is left
        let inside = low.lt(solved).and(solved.lt(high));
        let far = (high - low).lt(before * num(0.5));
        level = T::select(inside.and(far), solved, middle(low, high));
        level = T::select(low.lt(level).and(level.lt(high)), level, high).frozen();
    }
    Some(low)
}

/// How long a signal is at or over a level, in intervals.
struct TimeOver<T> {
    /// Intervals that are so from end to end.
    whole: T,
    /// Of all others.
    parts: T,
    /// What a unit of the level takes off, from `below` to `above`.
    fall: T,
    /// The largest value of a sample under the level.
    below: T,
    /// The smallest one that is not.
    above: T,
}

/// Of intervals with the smaller value first, and a level between two; `above` it goes no further than they. Intervals that have
/// nothing between them in any lane are dropped, and counted in `over` if they are over both; so many are left.
#[inline(always)]
fn time_over<T: Real>(
    level: T,
    [low, high]: [T; 2],
    pairs: &mut [[T; 2]],
    over: &mut T,
) -> (usize, TimeOver<T>) {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let mut time = TimeOver {
        whole: zero,
        parts: zero,
        fall: zero,
        below: low,
        above: high,
    };
    let open = low.lt(high);
    let mut left = 0;
    for i in 0..pairs.len() {
        let [a, b] = pairs[i];
        let starts_below = a.lt(high);
        if !starts_below.and(low.lt(b)).and(open).any() {
            *over += T::select(starts_below, zero, one);
            continue;
        }
        pairs[left] = [a, b];
        left += 1;
        let (under, crosses) = (b.lt(level), a.lt(level));
        time.whole += T::select(crosses, zero, one);
        time.above = time.above.min(T::select(crosses, high, a));
        time.below = time.below.max(T::select(under, b, low));
        let crosses = crosses.and(under.not());
        if crosses.any() {
            let rate = one / T::select(crosses, b - a, one);
            time.parts += T::select(crosses, (b - level) * rate, zero);
            time.fall += T::select(crosses, rate, zero);
            time.above = time.above.min(T::select(crosses, b, high));
            time.below = time.below.max(T::select(crosses, a, low));
        }
    }
    (left, time)
}

/// The level that is exceeded for so many intervals in a row; `None` where the signal is shorter.
#[inline(always)]
pub(super) fn contiguous<T: Real>(samples: &[T], intervals: f64, scratch: &mut [T]) -> Option<T> {
    let last = samples.len().checked_sub(1)?;
    let (whole, rest) = whole_and_rest(intervals, last)?;
    if whole == last {
        return samples.iter().copied().reduce(T::min);
    }
    // of so many samples from each
    scratch.copy_from_slice(samples);
    let least = match whole {
        0 => {
            scratch.fill(T::from_f64(f64::INFINITY));
            &*scratch
        }
        _ => sliding_minimum(scratch, whole),
    };
    let windows = samples.windows(2).zip(samples[whole..].windows(2));
    let windows = windows.zip(&least[1..]);

    let mut highest = T::from_f64(f64::NEG_INFINITY);
    for ((start, end), least) in windows.clone() {
        let begins = start[0].min(between(end[0], end[1], rest));
        let ends = end[1].min(between(start[1], start[0], rest));
        highest = highest.max(least.min(begins)).max(least.min(ends));
    }
    for (i, ((start, end), least)) in windows.enumerate() {
        if !highest.lt(*least).any() {
            continue;
        }
        let edge = between(start[1], start[0], rest);
        let rise = [start[0], edge];
        let fall = [between(end[0], end[1], rest), end[1]];
        highest = highest.max(crossing(rise, fall, *least));
        // and on, until it begins on the next sample
        if let (true, Some(next)) = (rest > 0.0, samples.get(i + whole + 2)) {
            let fall = [end[1], between(end[1], *next, rest)];
            highest = highest.max(crossing([edge, start[1]], fall, least.min(end[1])));
        }
    }
    Some(highest)
}

/// The level where a rise and a fall meet, at most `most`; −∞ where they do not.
#[inline(always)]
fn crossing<T: Real>(rise: [T; 2], fall: [T; 2], most: T) -> T {
    let meet = rise[0].lt(rise[1]).and(fall[1].lt(fall[0]));
    let meet = meet.and(rise[0].lt(fall[0])).and(fall[1].lt(rise[1]));
    let (before, after) = (fall[0] - rise[0], rise[1] - fall[1]);
    let part = before / T::select(meet, before + after, T::from_f64(1.0));
    let level = (rise[1] - rise[0]).mul_add(part, rise[0]);
    T::select(meet, level.min(most), T::from_f64(f64::NEG_INFINITY))
}

/// Half way from `a` to `b`.
#[inline(always)]
fn middle<T: Real>(a: T, b: T) -> T {
    let half = T::from_f64(0.5);
    a.mul_add(half, b * half)
}

/// From `a` towards `b`, a part of the way.
#[inline(always)]
fn between<T: Real>(a: T, b: T, part: f64) -> T {
    (b - a).mul_add(T::from_f64(part), a)
}

/// The smallest of each `width` neighbours, one or more: of 2, 4, 8, … first, and then of two such groups that overlap.
#[inline(always)]
fn sliding_minimum<T: Real>(values: &mut [T], width: usize) -> &[T] {
    let mut groups = 1;
    let mut left = values.len();
    let mut merge = |distance: usize| {
        left -= distance;
        for i in 0..left {
            values[i] = values[i].min(values[i + distance]);
        }
    };
    while 2 * groups <= width {
        merge(groups);
        groups *= 2;
    }
    merge(width - groups);
    &values[..left]
}
