//! The largest value of a signal, or of a function of it, and its place.

use crate::Real;

/// The largest value of a function of the samples; `None` if there are no samples.
#[inline(always)]
pub(super) fn peak_of<T: Real>(samples: &[T], seen: impl Fn(T) -> T) -> Option<T> {
    let (first, others) = samples.split_first()?;
    Some(
        others
            .iter()
            .fold(seen(*first), |most, a| most.max(seen(*a))),
    )
}

/// The place where a function of the samples is largest, in intervals from the first sample.
///
/// Let b be the first of the largest samples, a the one before and c the one after it. The top of the parabola through
/// them is (c − a)/2 over (b − a) + (b − c) intervals after b. At either end of the signal, and on a plateau, the place
/// is b.
#[inline(always)]
pub(super) fn place_of_peak<T: Real>(samples: &[T], seen: impl Fn(T) -> T) -> Option<T> {
    let zero = T::from_f64(0.0);
    let mut most = seen(*samples.first()?);
    let (mut place, mut before, mut after) = (zero, most, most);
    for i in 1..samples.len() {
        let value = seen(samples[i]);
        let larger = most.lt(value);
        // beyond an end, there is no parabola
        let inside = i + 1 < samples.len();
        let (left, right) = match inside {
            true => (seen(samples[i - 1]), seen(samples[i + 1])),
            false => (value, value),
        };
        most = T::select(larger, value, most);
        before = T::select(larger, left, before);
        after = T::select(larger, right, after);
        place = T::select(larger, T::from_f64(i as f64), place);
    }
    let bend = (most - before) + (most - after);
    let bends = zero.lt(bend);
    let offset = T::from_f64(0.5) * (after - before) / T::select(bends, bend, T::from_f64(1.0));
    Some(place + T::select(bends, offset, zero))
}
