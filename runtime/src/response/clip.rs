//! The level that a signal exceeds for a duration: in all, or without a break.
//!
//! Of the samples sorted downwards, the one after k intervals is exceeded for k intervals in all, to within one interval: with
//! a signal that only falls, exactly. Without a break, it is the largest of the smallest values within a window, and windows
//! begin or end on samples.

use super::whole_and_rest;
use crate::Real;

/// The level that is exceeded for so many intervals in all; `None` where the signal is shorter.
pub(super) fn cumulative<T: Real>(samples: &[T], intervals: f64, scratch: &mut [T]) -> Option<T> {
    let (whole, rest) = whole_and_rest(intervals, samples.len().checked_sub(1)?)?;
    scratch.copy_from_slice(samples);
    sort_downwards(scratch);
    let here = scratch[whole];
    let next = scratch.get(whole + 1).copied().unwrap_or(here);
    Some(between(here, next, rest))
}

/// The level that is exceeded for so many intervals in a row; `None` where the signal is shorter.
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
fn between<T: Real>(a: T, b: T, part: f64) -> T {
    (b - a).mul_add(T::from_f64(part), a)
}

/// The smallest of each `width` neighbours: of 2, 4, 8, … first, and then of two such groups that overlap.
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

/// Sorts by comparisons that do not depend on their outcomes, so that each lane is sorted for itself: Batcher's merge exchange
/// \[Knuth, The Art of Computer Programming 3, 5.2.2, algorithm M\].
fn sort_downwards<T: Real>(values: &mut [T]) {
    let count = values.len();
    let largest = count.next_power_of_two() / 2;
    let mut p = largest;
    while p > 0 {
        let (mut q, mut r, mut distance) = (largest, 0, p);
        loop {
            for i in (0..count.saturating_sub(distance)).filter(|i| i & p == r) {
                let (a, b) = (values[i], values[i + distance]);
                let rises = a.lt(b);
                values[i] = T::select(rises, b, a);
                values[i + distance] = T::select(rises, a, b);
            }
            if q == p {
                break;
            }
            distance = q - p;
            q /= 2;
            r = p;
        }
        p /= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::{sliding_minimum, sort_downwards};

    /// Numbers without order, with repetitions.
    fn unordered(count: usize) -> Vec<f64> {
        (0..count)
            .map(|i| ((i * 37 + 11) % 23) as f64 - 7.0)
            .collect()
    }

    #[test]
    fn every_count_is_sorted() {
        for count in 0..70 {
            let mut values = unordered(count);
            let mut expected = values.clone();
            expected.sort_by(|a, b| b.total_cmp(a));
            sort_downwards(&mut values);
            assert_eq!(values, expected, "{count}");
        }
    }

    #[test]
    fn minima_slide_over_every_width() {
        let values = unordered(40);
        for width in 1..=40 {
            let smallest = |group: &[f64]| group.iter().copied().fold(f64::INFINITY, f64::min);
            let expected: Vec<f64> = values.windows(width).map(smallest).collect();
            assert_eq!(
                sliding_minimum(&mut values.clone(), width),
                expected,
                "{width}"
            );
        }
    }
}
