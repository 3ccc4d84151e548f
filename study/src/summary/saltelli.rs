//! Sobol' indices from groups f(A), f(B), f(AB₁) … f(AB_d):
//!
//! ```text
//! main_i  = Σ f(B) (f(AB_i) − f(A)) / N V       [A. Saltelli et al., Comput. Phys. Commun. 181, 259 (2010)]
//! total_i = Σ (f(A) − f(AB_i))² / 2 N V         [M. J. W. Jansen, Comput. Phys. Commun. 117, 35 (1999)]
//! ```
//!
//! V is the variance of all f(A) and f(B). The mean is subtracted from f: this leaves the expected sums as they are,
//! but reduces their scatter. Sums are kept for batches of groups; intervals follow from batches that are drawn with
//! replacement (bootstrap).

use super::index::{Estimate, Estimator, Indices, Sensitivity};
use super::sample::quantile;
use crate::hash;
use crate::study::Study;

/// Largest number of batches.
const BATCHES: u64 = 256;
/// Number of draws of the bootstrap.
const DRAWS: u64 = 1000;
/// Stream of random numbers for the draws.
const DRAWING: u64 = 11 << 32;

/// Sums over the groups of a study, for every response.
#[derive(Clone, Debug)]
pub struct Groups {
    parameters: usize,
    width: usize,
    groups: u64,
    next: u64,
    /// Responses of the rows of the current group.
    open: Vec<f64>,
    /// For each response the number that is subtracted from all its values, to save digits: its first value.
    shifts: Vec<f64>,
    /// Sums for each response and each batch.
    sums: Vec<Vec<Sums>>,
}

/// Sums over a batch of groups; the shift is subtracted from f.
#[derive(Clone, Debug, PartialEq)]
struct Sums {
    count: f64,
    /// f(A) + f(B)
    values: f64,
    /// f(A)² + f(B)²
    squares: f64,
    /// For each parameter: f(B) (f(AB) − f(A)), f(AB) − f(A), (f(A) − f(AB))²
    parameters: Vec<[f64; 3]>,
}

impl Sums {
    fn zero(parameters: usize) -> Sums {
        Sums {
            count: 0.0,
            values: 0.0,
            squares: 0.0,
            parameters: vec![[0.0; 3]; parameters],
        }
    }

    fn add(&mut self, other: &Sums) {
        self.count += other.count;
        self.values += other.values;
        self.squares += other.squares;
        for (sums, others) in self.parameters.iter_mut().zip(&other.parameters) {
            for (sum, other) in sums.iter_mut().zip(others) {
                *sum += other;
            }
        }
    }

    /// Main and total index of each parameter; `None` if nothing varies.
    fn indices(&self) -> Option<Vec<[f64; 2]>> {
        let mean = self.values / (2.0 * self.count);
        let variance = self.squares / (2.0 * self.count) - mean * mean;
        // the values of a constant differ by rounding only
        let rounding = 1e-14 * self.squares / (2.0 * self.count);
        let varies = self.count >= 2.0 && variance > rounding;
        let scale = self.count * variance;
        let of = |[product, difference, square]: &[f64; 3]| {
            [
                (product - mean * difference) / scale,
                square / (2.0 * scale),
            ]
        };
        varies.then(|| self.parameters.iter().map(of).collect())
    }
}

impl Groups {
    /// No groups yet.
    pub fn new(study: &Study) -> Groups {
        let (parameters, width) = (study.varied.len(), study.responses.len());
        let groups = study.rows / (parameters as u64 + 2);
        let batches = groups.min(BATCHES) as usize;
        Groups {
            parameters,
            width,
            groups,
            next: 0,
            open: Vec::new(),
            shifts: vec![f64::NAN; width],
            sums: vec![vec![Sums::zero(parameters); batches]; width],
        }
    }

    /// Adds the responses of the next row.
    pub fn add(&mut self, responses: &[f64]) {
        self.open.extend_from_slice(responses);
        if self.open.len() < self.width * (self.parameters + 2) {
            return;
        }
        let open = std::mem::take(&mut self.open);
        for response in 0..self.width {
            let value = |row: usize| open[row * self.width + response];
            // a group with a failed run is left out
            if !(0..self.parameters + 2).all(|row| value(row).is_finite()) {
                continue;
            }
            if self.shifts[response].is_nan() {
                self.shifts[response] = value(0);
            }
            let shift = self.shifts[response];
            let (a, b) = (value(0) - shift, value(1) - shift);
            let batch = (u128::from(self.next) * u128::from(self.groups.min(BATCHES))
                / u128::from(self.groups)) as usize;
            let sums = &mut self.sums[response][batch];
            sums.count += 1.0;
            sums.values += a + b;
            sums.squares += a * a + b * b;
            for (parameter, sums) in sums.parameters.iter_mut().enumerate() {
                let difference = value(2 + parameter) - shift - a;
                sums[0] += b * difference;
                sums[1] += difference;
                sums[2] += difference * difference;
            }
        }
        self.open = open;
        self.open.clear();
        self.next += 1;
    }

    /// Indices of a response; `None` if it does not vary.
    pub fn indices(&self, response: usize) -> Option<Sensitivity> {
        let batches = &self.sums[response];
        let sum = |chosen: &mut dyn Iterator<Item = usize>| {
            let mut sums = Sums::zero(self.parameters);
            chosen.for_each(|batch| sums.add(&batches[batch]));
            sums
        };
        let all = sum(&mut (0..batches.len()));
        let values = all.indices()?;
        let n = batches.len() as u64;
        let draw = |draw: u64| {
            let batch = |k: u64| (hash::uniform(draw, DRAWING, k) * n as f64) as usize;
            sum(&mut (0..n).map(batch)).indices()
        };
        let draws: Vec<Vec<[f64; 2]>> = (0..DRAWS).filter_map(draw).collect();
        let estimate = |parameter: usize, which: usize| {
            let mut drawn: Vec<f64> = draws.iter().map(|draw| draw[parameter][which]).collect();
            drawn.sort_unstable_by(f64::total_cmp);
            Estimate {
                value: values[parameter][which],
                low: quantile(&drawn, 0.025),
                high: quantile(&drawn, 0.975),
            }
        };
        let indices = |p| Indices {
            main: estimate(p, 0),
            total: estimate(p, 1),
        };
        Some(Sensitivity {
            method: Estimator::Groups {
                groups: all.count as u64,
            },
            parameters: (0..self.parameters).map(indices).collect(),
        })
    }
}
