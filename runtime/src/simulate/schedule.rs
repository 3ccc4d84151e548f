//! When to sample and where to stop.

use super::Settings;
use crate::{Model, Real};

/// The step that goes `span` or fairly towards it when `h` is wanted, and whether it arrives: never a tiny rest.
pub fn to_meet(span: f64, h: f64) -> (f64, bool) {
    if span <= 1.05 * h {
        (span, true)
    } else if span < 2.0 * h {
        (0.5 * span, false)
    } else {
        (h, false)
    }
}

/// When to sample and where to stop.
pub struct Schedule {
    duration: f64,
    every: f64,
    /// Index of the last sample, which is due at the duration.
    last: u64,
    /// Index of the next sample.
    next: u64,
}

impl Schedule {
    pub fn new(settings: &Settings) -> Self {
        let Settings {
            duration, every, ..
        } = *settings;
        // a duration within rounding of a multiple is one
        let last = (duration / every * (1.0 - 1e-14) - 1e-9).max(0.0) as u64 + 1;
        Schedule {
            duration,
            every,
            last,
            next: 0,
        }
    }

    /// Time of the next sample, +∞ after the last.
    pub fn next_sample(&self) -> f64 {
        match self.next {
            next if next > self.last => f64::INFINITY,
            next if next == self.last => self.duration,
            next => next as f64 * self.every,
        }
    }

    pub fn advance(&mut self) {
        self.next += 1;
    }

    /// The first kink after `t`, at most the duration.
    pub fn kink_after<T: Real, M: Model<T>>(&self, model: &M, t: f64) -> f64 {
        let passed = M::INFO.breakpoints.partition_point(|kink| *kink <= t);
        let kink = M::INFO.breakpoints.get(passed).copied();
        let kink = kink.unwrap_or(f64::INFINITY).min(model.kink_after(t));
        kink.min(self.duration)
    }
}
