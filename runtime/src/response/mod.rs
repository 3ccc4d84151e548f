//! Responses: one number for a whole signal, which is sampled at equal intervals.
//!
//! | file | what |
//! |---|---|
//! | `extremes` | largest and smallest values, when they occur, and how far apart they are |
//! | `integrals` | integral and mean |
//! | `value` | the signal at a time |
//! | `hic` | the head injury criterion |
//! | `clip` | the level that is exceeded for a given duration |
//! | `exceedance` | the load beside a limit that falls with its duration |
//! | `olc` | the occupant load criterion of a pulse |
//! | `answer` | the distance between the responses of two runs |
//! | `filter` (feature `std`) | filters of channel frequency classes |
//! | `channel` (feature `std`) | a signal formed from outputs: filtered, then combined |
//! | `jumps` (feature `std`) | all responses, for a signal that jumps between samples |
//!
//! They are written over [`Real`], with selections in place of branches. So dual numbers give derivatives, where the
//! selection follows the value, and every lane of a register has a signal of its own. Nothing allocates, except for
//! signals that jump.

mod answer;
#[cfg(feature = "std")]
pub mod channel;
mod clip;
mod exceedance;
mod extremes;
#[cfg(feature = "std")]
pub mod filter;
mod hic;
mod integrals;
#[cfg(feature = "std")]
mod jumps;
mod olc;
mod value;

pub use answer::Answer;
#[cfg(feature = "std")]
pub use channel::Channel;
pub use exceedance::{Exceedance, FallingLimit};
pub use hic::STANDARD_GRAVITY;
#[cfg(feature = "std")]
pub use jumps::{Jump, move_with_jumps, reduce_with_jumps};

use crate::Real;

/// The kind of response. Times are in seconds from the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Response {
    /// The largest sample.
    Peak,
    /// The smallest sample.
    Minimum,
    /// The largest absolute value of a sample.
    Magnitude,
    /// The time of the largest value \[s\]: the first such sample, moved by at most half an interval to the top of the
    /// parabola through it and its neighbours.
    TimeOfPeak,
    /// The time of the smallest value \[s\], found like [`TimeOfPeak`](Response::TimeOfPeak).
    TimeOfMinimum,
    /// The largest sample less the smallest one.
    Range,
    /// The largest absolute difference from the first sample.
    Excursion,
    /// The integral over time by the trapezium rule, in the unit of the signal times seconds.
    Integral,
    /// The integral, divided by the length of the signal.
    Mean,
    /// The last sample.
    Final,
    /// The value at a time, by the cubic polynomial through the four nearest samples, or through all if there are
    /// fewer.
    Value {
        /// \[s\]
        at: f64,
    },
    /// The head injury criterion of an acceleration \[m/s²\]: max L (V/(g L))^2.5 over windows of length L that gain
    /// the velocity V. Windows begin and end on samples; a window of the longest length may have one end between two
    /// samples.
    Hic {
        /// The longest window \[s\]: 15 or 36 ms.
        window: f64,
    },
    /// The level that is exceeded for a duration in total, however often it is crossed: the cumulative 3 ms value. The
    /// signal is linear between samples.
    Clip {
        /// \[s\]
        duration: f64,
    },
    /// The level that is exceeded for a duration without a break: the contiguous 3 ms value. The signal is linear
    /// between samples.
    ContiguousClip {
        /// \[s\]
        duration: f64,
    },
    /// The largest ratio of a level of the size of the signal to the limit of the time for which this level is exceeded
    /// in total. The size is linear between samples.
    Exceedance {
        /// In the unit of the signal.
        limit: FallingLimit,
    },
    /// The occupant load criterion of the acceleration of a vehicle along its path \[m/s²\]: the constant deceleration
    /// \[m/s²\] that stops an occupant over 235 mm after a free flight of 65 mm.
    Olc,
}

impl Response {
    /// Number of scratch entries that [`reduce`] needs for a signal of this many samples.
    pub const fn scratch(self, samples: usize) -> usize {
        match self {
            Response::Hic { .. } | Response::ContiguousClip { .. } => samples,
            Response::Clip { .. } => 2 * samples,
            Response::Exceedance { .. } => 3 * samples,
            _ => 0,
        }
    }
}

/// A response of a signal whose `samples` are `every` \[s\] apart. `scratch` needs [`Response::scratch`] entries, whose
/// content does not matter.
///
/// NaN where there is no answer: no samples at all; fewer than two for the head injury criterion; a time or a duration
/// outside of the signal; an interval, a window or a duration that is not positive and finite; too little scratch. A
/// sample that is not finite makes every response NaN except those that do not use it, [`Final`](Response::Final) and
/// [`Value`](Response::Value).
#[inline(always)]
pub fn reduce<T: Real>(response: Response, samples: &[T], every: f64, scratch: &mut [T]) -> T {
    let answer = match (
        samples,
        scratch.get_mut(..response.scratch(samples.len())),
        every > 0.0 && every.is_finite(),
    ) {
        ([_, ..], Some(scratch), true) => answer(response, samples, every, scratch),
        _ => None,
    };
    answer.unwrap_or(T::from_f64(f64::NAN))
}

/// [`reduce`] for at least one sample, a valid interval, and scratch of the right length.
#[inline(always)]
fn answer<T: Real>(response: Response, samples: &[T], every: f64, scratch: &mut [T]) -> Option<T> {
    let last = *samples.last()?;
    let whole = match response {
        Response::Final => return Some(last),
        Response::Value { at } => return value::value(samples, at / every),
        Response::Peak => extremes::peak_of(samples, |a| a)?,
        Response::Minimum => -extremes::peak_of(samples, |a| -a)?,
        Response::Magnitude => extremes::peak_of(samples, |a| a.abs())?,
        Response::TimeOfPeak => extremes::place_of_peak(samples, |a| a)? * T::from_f64(every),
        Response::TimeOfMinimum => extremes::place_of_peak(samples, |a| -a)? * T::from_f64(every),
        Response::Range => extremes::peak_of(samples, |a| a)? + extremes::peak_of(samples, |a| -a)?,
        Response::Excursion => extremes::peak_of(samples, |a| (a - samples[0]).abs())?,
        Response::Integral => integrals::integral(samples) * T::from_f64(every),
        Response::Mean => integrals::mean(samples),
        Response::Hic { window } => hic::hic(samples, every, window, scratch)?,
        Response::Clip { duration } => clip::cumulative(samples, duration / every, scratch)?,
        Response::ContiguousClip { duration } => {
            clip::contiguous(samples, duration / every, scratch)?
        }
        Response::Exceedance { limit } => exceedance_of(samples, &limit, every, scratch).ratio,
        Response::Olc => olc::olc(samples, every)?,
    };
    Some(samples.iter().fold(whole, |sum, a| sum + a.taint()))
}

/// The largest ratio of a load to a limit that falls with its duration, and the duration where it occurs, for `samples`
/// that are `every` \[s\] apart. The ratio is that of [`Response::Exceedance`], and `scratch` is the same.
#[inline(always)]
pub fn exceedance_of<T: Real>(
    samples: &[T],
    limit: &FallingLimit,
    every: f64,
    scratch: &mut [T],
) -> Exceedance<T> {
    let (sizes, scratch) = scratch.split_at_mut(samples.len().min(scratch.len()));
    for (size, sample) in sizes.iter_mut().zip(samples) {
        *size = sample.abs();
    }
    let sizes = &*sizes;
    let points = sizes.iter().enumerate();
    let points = points.map(|(i, size)| [T::from_f64(i as f64 * every), *size]);
    let length = (sizes.len() as f64 - 1.0) * every;
    exceedance::worst(limit, points, length, |duration| {
        clip::cumulative(sizes, duration / every, scratch)
    })
}

/// A number of intervals as whole ones and a rest, 0 ≤ rest < 1; `None` where it is negative or beyond `most`. A
/// billionth either way counts as rounding, so times that should meet a sample meet it.
fn whole_and_rest(intervals: f64, most: usize) -> Option<(usize, f64)> {
    const HAIR: f64 = 1e-9;
    if !(-HAIR..=most as f64 + HAIR).contains(&intervals) {
        return None;
    }
    let whole = (intervals + HAIR) as usize;
    let rest = intervals - whole as f64;
    Some((whole, if rest > HAIR { rest } else { 0.0 }))
}
