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
