//! The level that a signal exceeds for a duration: in all, or without a break.
//!
//! Of the samples sorted downwards, the one after k intervals is exceeded for k intervals in all, to within one interval: with
//! a signal that only falls, exactly. Without a break, it is the largest of the smallest values within a window, and windows
//! begin or end on samples.

use super::whole_and_rest;
use crate::{Mask, Real};

/// The level that is exceeded for so many intervals in all; `None` where the signal is shorter.
#[inline(always)]
pub(super) fn cumulative<T: Real>(samples: &[T], intervals: f64, scratch: &mut [T]) -> Option<T> {
    let (whole, rest) = whole_and_rest(intervals, samples.len().checked_sub(1)?)?;
    let largest = largest(samples, whole + 2, scratch);
    let here = largest[whole];
    let next = largest.get(whole + 1).copied().unwrap_or(here);
    Some(between(here, next, rest))
}

/// The level that is exceeded for so many intervals in a row; `None` where the signal is shorter.
#[inline(always)]
pub(super) fn contiguous<T: Real>(samples: &[T], intervals: f64, scratch: &mut [T]) -> Option<T> {
    let (whole, rest) = whole_and_rest(intervals, samples.len().checked_sub(1)?)?;
    scratch.copy_from_slice(samples);
    let least = sliding_minimum(scratch, whole + 1);
    let (first, others) = least.split_first()?;
    if rest == 0.0 {
        return Some(others.iter().fold(*first, |most, a| most.max(*a)));
    }
    // a window of whole intervals, and the rest behind or ahead of it
    let mut highest: Option<T> = None;
    for (start, level) in least.iter().enumerate() {
        let end = start + whole;
        let behind = samples
            .get(end + 1)
            .map(|next| between(samples[end], *next, rest));
        let ahead = start
            .checked_sub(1)
            .map(|i| between(samples[start], samples[i], rest));
        for edge in [behind, ahead].into_iter().flatten() {
            let level = level.min(edge);
            highest = Some(highest.map_or(level, |most| most.max(level)));
        }
    }
    highest
}

/// From `a` towards `b`, a part of the way.
#[inline(always)]
fn between<T: Real>(a: T, b: T, part: f64) -> T {
    (b - a).mul_add(T::from_f64(part), a)
}

/// The smallest of each `width` neighbours: of 2, 4, 8, … first, and then of two such groups that overlap.
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

/// The largest samples, so many or all, the largest first. Every one that is among them so far is put in its place by comparisons with
/// all of them, so that each lane is sorted for itself; most are not, and cost one.
#[inline(always)]
fn largest<'a, T: Real>(samples: &[T], count: usize, scratch: &'a mut [T]) -> &'a [T] {
    let count = count.min(samples.len());
    let top = &mut scratch[..count];
    top.fill(T::from_f64(f64::NEG_INFINITY));
    for sample in samples {
        if !top[count - 1].lt(*sample).any() {
            continue;
        }
        for i in (1..count).rev() {
            top[i] = top[i].max(top[i - 1].min(*sample));
        }
        top[0] = top[0].max(*sample);
    }
    top
}
