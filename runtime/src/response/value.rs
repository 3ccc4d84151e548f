//! A signal at any time, by Lagrange's polynomial through the nearest four samples.

use super::whole_and_rest;
use crate::Real;

/// The value at `place` intervals behind the first sample; `None` outside of the signal.
#[inline(always)]
pub(super) fn value<T: Real>(samples: &[T], place: f64) -> Option<T> {
    let last = samples.len().checked_sub(1)?;
    let (whole, rest) = whole_and_rest(place, last)?;
    if rest == 0.0 {
        return samples.get(whole).copied();
    }
    // two samples on either side, if there are that many
    let points = samples.len().min(4);
    let first = whole.saturating_sub(1).min(samples.len() - points);
    let nearest = &samples[first..first + points];
    let at = place - first as f64;
    let weight = |i: usize| {
        (0..points).filter(|j| *j != i).fold(1.0, |product, j| {
            product * (at - j as f64) / (i as f64 - j as f64)
        })
    };
    Some(
        nearest
            .iter()
            .enumerate()
            .fold(T::from_f64(0.0), |sum, (i, a)| {
                a.mul_add(T::from_f64(weight(i)), sum)
            }),
    )
}
