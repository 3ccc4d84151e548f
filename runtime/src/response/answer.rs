//! A response of a run, and its distance from that of another run.

use super::Response;

/// Differences are relative to at least this share of the largest sample of the signal: a response that is nearly 0
/// need not be correct in its own digits.
const FLOOR: f64 = 1e-2;

/// A response of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The value; NaN where there is none.
    pub value: f64,
    /// The smallest value that a difference is taken relative to.
    pub floor: f64,
    /// The largest magnitude of a sample of its signal.
    pub largest: f64,
}

impl Answer {
    /// A response, given the largest magnitude of a sample and the length of the signal \[s\].
    pub fn new(response: Response, value: f64, largest: f64, duration: f64) -> Self {
        let size = match response {
            Response::TimeOfPeak | Response::TimeOfMinimum => duration,
            Response::Integral => largest * duration,
            Response::Hic { .. } | Response::Olc => 0.0,
            Response::Exceedance { limit } => largest / limit.corners()[0][1],
            _ => largest,
        };
        Answer {
            value,
            floor: FLOOR * size,
            largest,
        }
    }

    /// The difference from the response of a less accurate run, relative to the larger of both; NaN where either is
    /// NaN. If both are equal, the relative difference of the largest samples: two inaccurate runs may agree in a value
    /// that is a bound, such as the smallest value of a force that is never negative.
    pub fn apart(&self, other: &Answer) -> f64 {
        let scale = self.value.abs().max(other.value.abs()).max(self.floor);
        match (self.value - other.value).abs() {
            0.0 if self.largest == other.largest => 0.0,
            0.0 => (self.largest - other.largest).abs() / self.largest.max(other.largest),
            difference => difference / scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Answer;
    use crate::Response;

    #[test]
    fn what_is_next_to_nothing_is_measured_by_its_signal() {
        let answer = |response, value| Answer::new(response, value, 200.0, 0.5);
        let peak = |value| answer(Response::Peak, value);
        assert_eq!(peak(100.0).apart(&peak(90.0)), 0.1);
        // 1 % of 200 is more than both
        assert_eq!(peak(0.5).apart(&peak(-0.5)), 0.5);
        assert_eq!(peak(0.0).apart(&peak(0.0)), 0.0);
        assert!(peak(f64::NAN).apart(&peak(1.0)).is_nan());
        // times are relative to the duration: 1 ms in 1 % of 0.5 s
        let time = |value| answer(Response::TimeOfPeak, value);
        assert!((time(0.0).apart(&time(1e-3)) - 0.2).abs() < 1e-15);
        let hic = |value| answer(Response::Hic { window: 15e-3 }, value);
        assert_eq!(hic(1e-3).apart(&hic(2e-3)), 0.5);
    }

    #[test]
    fn equal_responses_of_signals_that_differ_are_apart() {
        let smallest = |largest| Answer::new(Response::Minimum, 0.0, largest, 0.5);
        assert_eq!(smallest(200.0).apart(&smallest(200.0)), 0.0);
        assert_eq!(smallest(200.0).apart(&smallest(50.0)), 0.75);
        assert_eq!(smallest(50.0).apart(&smallest(200.0)), 0.75);
        assert_eq!(smallest(0.0).apart(&smallest(0.0)), 0.0);
        let peak = |value| Answer::new(Response::Peak, value, value, 0.5);
        assert_eq!(peak(200.0).apart(&peak(50.0)), 0.75);
        let none = Answer::new(Response::Peak, f64::NAN, 0.0, 0.5);
        assert!(none.apart(&peak(1.0)).is_nan());
    }
}
