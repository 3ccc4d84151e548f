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

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and variance of a distribution from its quantiles at the midpoints of n parts: the midpoint rule.
    fn moments(of: &Distribution) -> [f64; 2] {
        let n = 200_000;
        let values = || (0..n).map(|k| of.quantile((f64::from(k) + 0.5) / f64::from(n)));
        let mean = values().sum::<f64>() / f64::from(n);
        let square = |x: f64| (x - mean) * (x - mean);
        [mean, values().map(square).sum::<f64>() / f64::from(n)]
    }

    fn assert_moments(of: Distribution, mean: f64, variance: f64) {
        let found = moments(&of);
        // the midpoint rule neglects the part of a Gaussian tail beyond u = 1/2n: less than 1e-3 of a variance
        assert!(
            (found[0] - mean).abs() < 1e-4 * (1.0 + mean.abs()),
            "{of:?}: mean {found:?}"
        );
        assert!(
            (found[1] - variance).abs() < 1e-3 * variance,
            "{of:?}: variance {found:?}"
        );
    }

    #[test]
    fn means_and_variances_are_those_of_the_books() {
        let (a, b, c) = (0.5, 2.0, 1.0);
        assert_moments(
            Distribution::Uniform { from: a, to: b },
            1.25,
            1.5 * 1.5 / 12.0,
        );
        let variance = (a * a + b * b + c * c - a * b - a * c - b * c) / 18.0;
        assert_moments(
            Distribution::Triangular {
                from: a,
                mode: c,
                to: b,
            },
            (a + b + c) / 3.0,
            variance,
        );
        let (mean, deviation) = (0.3, 0.05);
        let normal = Distribution::Normal {
            mean,
            deviation,
            min: None,
            max: None,
        };
        assert_moments(normal, mean, deviation * deviation);
        let (median, s): (f64, f64) = (1.5, 0.3);
        let lognormal = Distribution::Lognormal {
            median,
            deviation: s,
            min: None,
            max: None,
        };
        let w = (s * s).exp();
        assert_moments(
            lognormal,
            median * w.sqrt(),
            median * median * w * (w - 1.0),
        );
        let discrete = Distribution::Discrete {
            values: vec![1.0, 3.0],
            weights: vec![0.25, 0.75],
        };
        assert_moments(discrete, 2.5, 0.75);
    }

    #[test]
    fn a_half_normal_has_its_closed_moments() {
        // truncated at the mean: mean √(2/π), variance 1 − 2/π
        let half = Distribution::Normal {
            mean: 0.0,
            deviation: 1.0,
            min: Some(0.0),
            max: None,
        };
        let pi = std::f64::consts::PI;
        assert_moments(half, (2.0 / pi).sqrt(), 1.0 - 2.0 / pi);
    }

    #[test]
    fn values_keep_to_their_support() {
        let all = [
            Distribution::Uniform { from: 0.1, to: 0.3 },
            Distribution::Triangular {
                from: 0.1,
                mode: 0.1,
                to: 0.3,
            },
            Distribution::Normal {
                mean: 0.2,
                deviation: 1.0,
                min: Some(0.1),
                max: Some(0.3),
            },
            Distribution::Lognormal {
                median: 5.0,
                deviation: 0.5,
                min: Some(0.1),
                max: Some(0.3),
            },
        ];
        for distribution in &all {
            let [low, high] = distribution.support();
            assert_eq!([low, high], [0.1, 0.3]);
            for u in [1e-17, 1e-9, 0.3, 0.5, 0.7, 1.0 - 1e-9, 1.0 - 1e-16] {
                let x = distribution.quantile(u);
                assert!((low..=high).contains(&x), "{distribution:?} at {u}: {x}");
            }
        }
    }
}
