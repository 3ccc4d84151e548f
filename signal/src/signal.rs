//! Numbers at equal intervals of time.

/// Largest relative deviation of an interval from the mean for which the intervals count as equal: times are printed
/// with few digits.
const UNEVEN: f64 = 1e-3;

/// Numbers at equal intervals of time. NaN stands for a missing sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Time of the first sample \[s\].
    pub first: f64,
    /// Time from one sample to the next \[s\], positive.
    pub interval: f64,
    /// The samples.
    pub values: Vec<f64>,
}

impl Signal {
    /// The signal with these samples at these times; `None` if the times are not at equal intervals, or if there are
    /// fewer than two.
    pub fn of_samples(times: &[f64], values: &[f64]) -> Option<Signal> {
        let (first, last) = (*times.first()?, *times.last()?);
        let count = times.len();
        if count < 2 || values.len() != count {
            return None;
        }
        let interval = (last - first) / (count - 1) as f64;
        let in_place =
            |(i, t): (usize, &f64)| (t - first - i as f64 * interval).abs() <= UNEVEN * interval;
        let even = interval > 0.0 && times.iter().enumerate().all(in_place);
        even.then(|| Signal {
            first,
            interval,
            values: values.to_vec(),
        })
    }

    /// The time of a sample \[s\].
    pub fn time(&self, index: usize) -> f64 {
        self.first + index as f64 * self.interval
    }

    /// The time of the last sample \[s\].
    pub fn last(&self) -> f64 {
        self.time(self.values.len().saturating_sub(1))
    }

    /// The value at a time, interpolated linearly; NaN before the first and after the last sample.
    pub fn at(&self, time: f64) -> f64 {
        let place = (time - self.first) / self.interval;
        let last = self.values.len() as f64 - 1.0;
        // a time slightly outside by rounding counts as inside
        let inside = -UNEVEN <= place && place <= last + UNEVEN;
        if !inside {
            return f64::NAN;
        }
        let place = place.clamp(0.0, last);
        let (index, part) = (place.floor(), place.fract());
        let at = |index: f64| self.values[index as usize];
        match part == 0.0 {
            true => at(index),
            false => at(index) + part * (at(index + 1.0) - at(index)),
        }
    }

    /// The signal sampled anew from one time to another, at other intervals; NaN at times that it does not cover.
    pub fn resampled(&self, from: f64, to: f64, interval: f64) -> Signal {
        let count = ((to - from) / interval + UNEVEN).floor() as usize + 1;
        let values = (0..count).map(|i| self.at(from + i as f64 * interval));
        Signal {
            first: from,
            interval,
            values: values.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Signal;

    #[test]
    fn times_must_be_even() {
        let even = Signal::of_samples(&[0.1, 0.2, 0.3], &[1.0, 2.0, 4.0]).unwrap();
        assert_eq!((even.first, even.values.len()), (0.1, 3));
        assert!((even.interval - 0.1).abs() < 1e-15 && (even.last() - 0.3).abs() < 1e-15);
        assert_eq!(Signal::of_samples(&[0.0, 0.1, 0.3], &[1.0, 2.0, 4.0]), None);
        assert_eq!(Signal::of_samples(&[0.0], &[1.0]), None);
        assert_eq!(Signal::of_samples(&[0.1, 0.0], &[1.0, 2.0]), None);
    }

    #[test]
    fn between_samples_is_a_line_and_outside_is_nothing() {
        let signal = Signal::of_samples(&[0.0, 0.1, 0.2], &[1.0, 2.0, 4.0]).unwrap();
        assert!((signal.at(0.15) - 3.0).abs() < 1e-12);
        assert_eq!((signal.at(0.0), signal.at(0.2)), (1.0, 4.0));
        assert!(signal.at(-0.01).is_nan() && signal.at(0.21).is_nan());
        let finer = signal.resampled(0.05, 0.2, 0.05);
        let expected = [1.5, 2.0, 3.0, 4.0];
        let close = |(a, b): (&f64, f64)| (a - b).abs() < 1e-12;
        assert!(finer.values.len() == 4 && finer.values.iter().zip(expected).all(close));
    }
}
