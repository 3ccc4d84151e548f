//! Functions of one parameter that are orthonormal under its distribution: Legendre polynomials in u = F(x); Hermite
//! polynomials in Φ⁻¹(u) if x is normal or lognormal; polynomials under the weights for a parameter with k discrete
//! values. The latter are k − 1 functions besides the constant, and together they represent any function of the
//! parameter.

use crate::distribution::{Distribution, level};
use crate::normal;

/// Largest degree; the values of Hermite polynomials of higher degrees are too large.
pub const HIGHEST: usize = 12;
/// A polynomial of discrete values is lost in rounding if less than this share of it remains after projection on lower
/// degrees: half of the digits of a double.
const LEFT: f64 = 1e-8;

/// Orthonormal functions of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Family {
    /// Legendre polynomials of u.
    Legendre,
    /// Hermite polynomials of Φ⁻¹(u).
    Hermite,
    /// Functions of discrete values.
    Levels {
        /// Weights of the values, in their given order.
        weights: Vec<f64>,
        /// The functions at these values.
        functions: Vec<Vec<f64>>,
    },
}

impl Family {
    /// The family that fits a distribution.
    pub fn of(distribution: &Distribution) -> Family {
        match distribution {
            Distribution::Uniform { .. } | Distribution::Triangular { .. } => Family::Legendre,
            Distribution::Normal { .. } | Distribution::Lognormal { .. } => Family::Hermite,
            Distribution::Discrete { values, weights } => Family::Levels {
                weights: weights.clone(),
                functions: functions(values, weights),
            },
        }
    }

    /// Highest degree of the family.
    pub fn highest(&self) -> usize {
        match self {
            Family::Legendre | Family::Hermite => HIGHEST,
            Family::Levels { functions, .. } => functions.first().map_or(0, |f| f.len() - 1),
        }
    }

    /// The functions at u in (0, 1): up to degree `highest`, or all functions of discrete values.
    pub fn evaluate(&self, u: f64, highest: usize) -> Vec<f64> {
        match self {
            Family::Legendre => legendre(2.0 * u - 1.0, highest),
            Family::Hermite => hermite(normal::quantile(u), highest),
            Family::Levels { weights, functions } => functions[level(weights, u)].clone(),
        }
    }
}

fn legendre(x: f64, highest: usize) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for k in 1..highest {
        let (n, a, b) = (k as f64, values[k], values[k - 1]);
        values.push(((2.0 * n + 1.0) * x * a - n * b) / (n + 1.0));
    }
    for (k, value) in values.iter_mut().enumerate() {
        *value *= (2.0 * k as f64 + 1.0).sqrt();
    }
    values
}

fn hermite(x: f64, highest: usize) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for k in 1..highest {
        values.push(x * values[k] - k as f64 * values[k - 1]);
    }
    let mut factorial = 1.0;
    for (k, value) in values.iter_mut().enumerate() {
        factorial *= (k as f64).max(1.0);
        *value /= f64::sqrt(factorial);
    }
    values
}

/// The functions of each discrete value, by Stieltjes' procedure; each is made orthogonal to all lower ones twice. If
/// values are so close that the next power is lost in rounding, the next function is instead made from the indicator of
/// one value: the one that the lower functions represent worst.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn functions(values: &[f64], weights: &[f64]) -> Vec<Vec<f64>> {
    let mut levels: Vec<(f64, f64)> = Vec::new();
    let mut order: Vec<usize> = (0..values.len()).filter(|k| weights[*k] > 0.0).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut level_of = vec![None; values.len()];
    for k in order {
        match levels.last_mut() {
            Some((value, weight)) if *value == values[k] => *weight += weights[k],
            _ => levels.push((values[k], weights[k])),
        }
        level_of[k] = Some(levels.len() - 1);
    }
    let (Some((low, _)), Some((high, _))) = (levels.first(), levels.last()) else {
        return vec![vec![1.0]; values.len()];
    };
    // halves are used, because the difference of the ends might overflow
    let x = |value: f64| (0.5 * value - 0.5 * low) / (0.5 * high - 0.5 * low);
    let sum: f64 = levels.iter().map(|(_, weight)| weight).sum();
    let roots: Vec<f64> = levels.iter().map(|(_, w)| (w / sum).sqrt()).collect();
    // vectors of functions times square roots of weights are orthonormal
    let mut vectors = vec![roots.clone()];
    for degree in 1..levels.len().min(HIGHEST + 1) {
        let mut next: Vec<f64> = levels
            .iter()
            .zip(&vectors[degree - 1])
            .map(|((value, _), f)| x(*value) * f)
            .collect();
        let size = norm(&next);
        let left = rest(&mut next, &vectors);
        // false, too, for NaN, and for values that are too close to be halved
        let told = left > LEFT * size;
        if !told {
            let known = |l: usize| vectors.iter().map(|v| v[l] * v[l]).sum::<f64>();
            let worst = (0..levels.len()).min_by(|a, b| known(*a).total_cmp(&known(*b)));
            next.fill(0.0);
            next[worst.unwrap_or(0)] = 1.0;
            rest(&mut next, &vectors);
        }
        let size = norm(&next);
        next.iter_mut().for_each(|f| *f /= size);
        vectors.push(next);
    }
    let at = |level: &Option<usize>| match level {
        Some(l) => vectors.iter().map(|v| v[*l] / roots[*l]).collect(),
        // a value with probability 0
        None => (0..vectors.len()).map(|k| f64::from(k == 0)).collect(),
    };
    level_of.iter().map(at).collect()
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Makes a vector orthogonal to `others`, which are orthonormal; returns the norm after the first projection.
fn rest(vector: &mut [f64], others: &[Vec<f64>]) -> f64 {
    let mut left = f64::NAN;
    for _ in 0..2 {
        for other in others {
            let part: f64 = vector.iter().zip(other).map(|(a, b)| a * b).sum();
            vector
                .iter_mut()
                .zip(other)
                .for_each(|(a, b)| *a -= part * b);
        }
        if left.is_nan() {
            left = norm(vector);
        }
    }
    left
}
