//! Distributions of a parameter by their quantiles x = F⁻¹(u), 0 < u < 1, all in SI units.

use crate::normal;
use serde::Serialize;

/// The distribution of a parameter's values.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// All values of an interval are equally probable.
    Uniform {
        /// Least value.
        from: f64,
        /// Largest value.
        to: f64,
    },
    /// Normal, truncated at the given ends.
    Normal {
        /// Mean before truncation.
        mean: f64,
        /// Standard deviation before truncation, positive.
        deviation: f64,
        /// Least value.
        min: Option<f64>,
        /// Largest value.
        max: Option<f64>,
    },
    /// The logarithm is normal; truncated at the given ends.
    Lognormal {
        /// Median before truncation, positive.
        median: f64,
        /// Standard deviation of the natural logarithm, positive.
        deviation: f64,
        /// Least value.
        min: Option<f64>,
        /// Largest value.
        max: Option<f64>,
    },
    /// Triangular density.
    Triangular {
        /// Least value.
        from: f64,
        /// The most probable value.
        mode: f64,
        /// Largest value.
        to: f64,
    },
    /// A finite set of values.
    Discrete {
        /// The values.
        values: Vec<f64>,
        /// Probabilities; their sum is 1.
        weights: Vec<f64>,
    },
}

impl Distribution {
    /// The value x with the probability u of smaller values.
    pub fn quantile(&self, u: f64) -> f64 {
        match self {
            Distribution::Uniform { from, to } => {
                // the weighted mean stays within the ends even if `to − from` is rounded
                (from * (1.0 - u) + to * u).clamp(*from, *to)
            }
            Distribution::Normal {
                mean,
                deviation,
                min,
                max,
            } => {
                let [low, high] = self.ends();
                let z = normal::truncated(u, low, high);
                limited(mean + deviation * z, *min, *max)
            }
            Distribution::Lognormal {
                median,
                deviation,
                min,
                max,
            } => {
                let [low, high] = self.ends();
                let z = normal::truncated(u, low, high);
                limited(median * libm::exp(deviation * z), *min, *max)
            }
            Distribution::Triangular { from, mode, to } => {
                let (left, right, all) = (mode - from, to - mode, to - from);
                let x = if u * all < left {
                    from + (u * all * left).sqrt()
                } else {
                    to - ((1.0 - u) * all * right).sqrt()
                };
                x.clamp(*from, *to)
            }
            Distribution::Discrete { values, weights } => {
                values.get(level(weights, u)).copied().unwrap_or(f64::NAN)
            }
        }
    }

    /// For a normal or lognormal distribution: its ends, in standard deviations from its middle.
    pub fn ends(&self) -> [f64; 2] {
        let infinite = [f64::NEG_INFINITY, f64::INFINITY];
        match self {
            Distribution::Normal {
                mean,
                deviation,
                min,
                max,
            } => {
                let z = |x: f64| (x - mean) / deviation;
                [min.map_or(infinite[0], z), max.map_or(infinite[1], z)]
            }
            Distribution::Lognormal {
                median,
                deviation,
                min,
                max,
            } => {
                let z = |x: f64| libm::log(x / median) / deviation;
                let low = min.filter(|&min| min > 0.0);
                [low.map_or(infinite[0], z), max.map_or(infinite[1], z)]
            }
            _ => infinite,
        }
    }

    /// Least and largest possible value; infinite if a tail is not truncated.
    pub fn support(&self) -> [f64; 2] {
        let (min, max) = match self {
            Distribution::Uniform { from, to } | Distribution::Triangular { from, to, .. } => {
                (*from, *to)
            }
            Distribution::Normal { min, max, .. } => (
                min.unwrap_or(f64::NEG_INFINITY),
                max.unwrap_or(f64::INFINITY),
            ),
            Distribution::Lognormal { min, max, .. } => {
                (min.unwrap_or(0.0).max(0.0), max.unwrap_or(f64::INFINITY))
            }
            Distribution::Discrete { values, .. } => (
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ),
        };
        [min, max]
    }
}

/// The index of the value that u selects among values with these weights.
pub fn level(weights: &[f64], u: f64) -> usize {
    let mut sum = 0.0;
    let found = weights.iter().position(|weight| {
        sum += weight;
        u < sum
    });
    // rounding may leave the sum of the weights slightly below 1
    found.unwrap_or(weights.len().saturating_sub(1))
}

fn limited(x: f64, min: Option<f64>, max: Option<f64>) -> f64 {
    let x = min.map_or(x, |min| x.max(min));
    max.map_or(x, |max| x.min(max))
}
