//! The level that a signal exceeds for a given duration: in total, or without a break. The signal is linear between
//! samples; the error of this is of the order of the square of their interval.
//!
//! In total: the time above a level decreases as the level rises. It is linear between neighbouring values of samples,
//! and jumps where the signal stays on one value. Newton's step from any level is exact if it stays between the
//! neighbouring values. If it does not, all levels up to a neighbour are excluded. So the search ends, and bisection
//! makes it end soon.
//!
//! Without a break: it is the largest of the smallest values within a window. The smallest value is the least of the
//! two edges and of the samples between them. So the best window begins or ends on a sample; or the signal rises at its
//! beginning, falls at its end, and both edges are on one level.

use super::whole_and_rest;
use crate::{Mask, Real};

/// The level that is exceeded for this number of intervals in total; `None` if the signal is shorter.
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
    // in lanes with a sample that is NaN, the interval becomes empty
    high += taint;

    let (pairs, _) = scratch.as_chunks_mut::<2>();
    for (pair, neighbours) in pairs.iter_mut().zip(samples.windows(2)) {
        let (a, b) = (neighbours[0], neighbours[1]);
        *pair = [a.min(b), a.max(b)];
    }
    let (mut left, mut over) = (samples.len() - 1, num(0.0));
    let mut level = middle(low, high);
    // every pass excludes a value of a sample
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

        // Newton's step, or bisection if the last step halved too little; within the remaining interval
        let inside = low.lt(solved).and(solved.lt(high));
        let far = (high - low).lt(before * num(0.5));
        level = T::select(inside.and(far), solved, middle(low, high));
        level = T::select(low.lt(level).and(level.lt(high)), level, high).frozen();
    }
    Some(low)
}

/// The time for which a signal is at or above a level, in intervals between samples.
struct TimeOver<T> {
    /// Number of intervals that are above from end to end.
    whole: T,
    /// The time above in all other intervals.
    parts: T,
    /// The decrease of the time when the level rises by 1, for levels from `below` to `above`.
    fall: T,
    /// The largest value of a sample below the level.
    below: T,
    /// The smallest value of a sample that is not below the level.
    above: T,
}

/// The time above `level`, which lies between `low` and `high`. Each pair is an interval, with the smaller value first.
/// Intervals that have nothing between `low` and `high` in any lane are dropped; those above both are counted in
/// `over`. Returns the number of intervals left, and the time.
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

/// The level that is exceeded for this number of intervals without a break; `None` if the signal is shorter.
#[inline(always)]
pub(super) fn contiguous<T: Real>(samples: &[T], intervals: f64, scratch: &mut [T]) -> Option<T> {
    let last = samples.len().checked_sub(1)?;
    let (whole, rest) = whole_and_rest(intervals, last)?;
    if whole == last {
        return samples.iter().copied().reduce(T::min);
    }
    // the smallest of the `whole` samples from each sample on
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
        // the window moves on until it begins on the next sample
        if let (true, Some(next)) = (rest > 0.0, samples.get(i + whole + 2)) {
            let fall = [end[1], between(end[1], *next, rest)];
            highest = highest.max(crossing([edge, start[1]], fall, least.min(end[1])));
        }
    }
    Some(highest)
}

/// The level where a rise and a fall meet, limited to `most`; −∞ where they do not meet.
#[inline(always)]
fn crossing<T: Real>(rise: [T; 2], fall: [T; 2], most: T) -> T {
    let meet = rise[0].lt(rise[1]).and(fall[1].lt(fall[0]));
    let meet = meet.and(rise[0].lt(fall[0])).and(fall[1].lt(rise[1]));
    let (before, after) = (fall[0] - rise[0], rise[1] - fall[1]);
    let part = before / T::select(meet, before + after, T::from_f64(1.0));
    let level = (rise[1] - rise[0]).mul_add(part, rise[0]);
    T::select(meet, level.min(most), T::from_f64(f64::NEG_INFINITY))
}

/// The middle of `a` and `b`.
#[inline(always)]
fn middle<T: Real>(a: T, b: T) -> T {
    let half = T::from_f64(0.5);
    a.mul_add(half, b * half)
}

/// The value at a part of the way from `a` to `b`.
#[inline(always)]
fn between<T: Real>(a: T, b: T, part: f64) -> T {
    (b - a).mul_add(T::from_f64(part), a)
}

/// The smallest of each `width` neighbours, one or more: first of 2, 4, 8, …, then of two such groups that overlap.
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
