//! The values of a row. They depend only on the study and the row's index, so that any row may be run anywhere and at
//! any time.
//!
//! ```text
//! row ─design→ u ∈ (0, 1)^d ─quantiles→ parameters        row ─mixed radix→ grid        row → list
//! ```

pub mod directions;
pub mod permutation;
pub mod sobol;

use crate::distribution::Distribution;
use crate::hash;
use crate::study::{Plan, RandomDesign, Study};
use permutation::Permutation;
use sobol::Sobol;

/// Streams of random numbers. The index of the parameter is added in the lower bits.
const JITTER: u64 = 1 << 32;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub const PERMUTATION: u64 = 2 << 32;
const INDEPENDENT: u64 = 3 << 32;

/// Number of parts of a stratum. A point of a Latin hypercube is in the middle of one of them. With so few parts,
/// rounding never moves u out of its stratum, for up to 2³² rows.
const PARTS: f64 = (1 << 20) as f64;

/// Draws the rows of a study.
#[derive(Debug)]
pub struct Sampler<'a> {
    study: &'a Study,
    points: Points,
}

#[derive(Debug)]
enum Points {
    Written,
    Strata(Vec<Permutation>),
    Sobol(Sobol),
    Independent,
}

/// There are more parameters than the design has dimensions for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} parameters are more than the {most} that this design has numbers for")]
pub struct TooManyParameters {
    /// Number of varied parameters.
    pub found: usize,
    /// Largest possible number of parameters.
    pub most: usize,
}

/// Largest number of parameters that a random design can vary.
pub fn most_parameters(design: RandomDesign) -> usize {
    match design {
        RandomDesign::Sobol => Sobol::DIMENSIONS,
        RandomDesign::Saltelli => Sobol::DIMENSIONS / 2,
        // bounded by the type of the number
        RandomDesign::LatinHypercube | RandomDesign::MonteCarlo => u32::MAX as usize,
    }
}

impl<'a> Sampler<'a> {
    /// A sampler for a study.
    ///
    /// # Errors
    /// There are more parameters than Sobol' sequences have numbers for; a study that was read from a file does not
    /// have this error.
    pub fn new(study: &'a Study) -> Result<Self, TooManyParameters> {
        let d = study.varied.len();
        let points = match &study.plan {
            Plan::Grid(_) | Plan::List(_) => Points::Written,
            Plan::Random { design, seed, .. } => {
                let sobol = |dimensions| {
                    Sobol::new(dimensions)
                        .map(Points::Sobol)
                        .ok_or(TooManyParameters {
                            found: d,
                            most: most_parameters(*design),
                        })
                };
                match design {
                    RandomDesign::LatinHypercube => {
                        let one = |p| Permutation::new(study.rows, *seed, PERMUTATION + p as u64);
                        Points::Strata((0..d).map(one).collect())
                    }
                    RandomDesign::Sobol => sobol(d)?,
                    RandomDesign::Saltelli => sobol(2 * d)?,
                    RandomDesign::MonteCarlo => Points::Independent,
                }
            }
        };
        Ok(Sampler { study, points })
    }

    /// The values of a row, SI, one for each varied parameter.
    pub fn values(&self, row: u64, values: &mut [f64]) {
        match &self.study.plan {
            Plan::Grid(levels) => {
                let mut rest = row;
                for (value, levels) in values.iter_mut().zip(levels).rev() {
                    let n = levels.count();
                    *value = levels.value(rest % n);
                    rest /= n;
                }
            }
            Plan::List(list) => {
                let d = values.len();
                let start = row as usize * d;
                values.copy_from_slice(&list.0[start..start + d]);
            }
            Plan::Random {
                design,
                seed,
                distributions,
            } => {
                for (p, (value, distribution)) in values.iter_mut().zip(distributions).enumerate() {
                    *value = distribution.quantile(self.coordinate(*design, *seed, row, p));
                }
            }
        }
    }

    /// The point of the unit cube for a row, and the distributions of the parameters; `None` if the design is not
    /// random.
    pub fn point(&self, row: u64, point: &mut [f64]) -> Option<&'a [Distribution]> {
        let Plan::Random {
            design,
            seed,
            distributions,
        } = &self.study.plan
        else {
            return None;
        };
        for (p, u) in point.iter_mut().enumerate() {
            *u = self.coordinate(*design, *seed, row, p);
        }
        Some(distributions)
    }

    fn coordinate(&self, design: RandomDesign, seed: u64, row: u64, parameter: usize) -> f64 {
        let stream = parameter as u64;
        match &self.points {
            Points::Strata(permutations) => {
                let stratum = permutations[parameter].of(row) as f64;
                let part = (hash::uniform(seed, JITTER + stream, row) * PARTS).floor() + 0.5;
                (stratum + part / PARTS) / self.study.rows as f64
            }
            Points::Sobol(sobol) if design == RandomDesign::Saltelli => {
                let d = self.study.varied.len();
                let group = d as u64 + 2;
                let from_b = match row % group {
                    0 => false,
                    1 => true,
                    exchanged => exchanged == stream + 2,
                };
                let dimension = if from_b { d + parameter } else { parameter };
                sobol.coordinate(seed, row / group, dimension)
            }
            Points::Sobol(sobol) => sobol.coordinate(seed, row, parameter),
            Points::Independent | Points::Written => hash::uniform(seed, INDEPENDENT + stream, row),
        }
    }
}
