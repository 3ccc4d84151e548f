//! Indices from a polynomial through the runs (polynomial chaos): y = Σ c_α ψ_α, with ψ orthonormal under the distribution of the
//! parameters, has the variance Σ_{α ≠ 0} c_α², and each term its own parameters \[B. Sudret, Reliab. Eng. Syst. Saf. 93, 964
//! (2008)\].
//!
//! ψ are products of Legendre's polynomials in u = F(x), or of Hermite's in Φ⁻¹(u) where x is normal or lognormal; c are least
//! squares; the total degree is the one that predicts best the runs left out of the fit, one at a time, whose errors are
//! r_i/(1 − h_i) with h the diagonal of the projection. Intervals come from leaving out one of 32 parts of the runs (jackknife).

use super::index::{Estimate, Indices, Method, Sensitivity};
use super::sample::Sample;
use crate::design::permutation::Permutation;
use crate::normal;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Terms of a polynomial at most.
const MOST_TERMS: usize = 300;
/// Degree at most; numbers of Hermite's polynomials grow fast.
const HIGHEST: usize = 12;
/// Parts of the runs, of which one is left out.
const PARTS: usize = 32;
/// Stream that puts runs into parts.
const PARTING: u64 = 13 << 32;
/// Half of a normal interval of 95 %, in deviations.
const WIDTH: f64 = 1.959_963_984_540_054;

/// Indices of a response; `None` where it does not vary, or where there are too few runs for a polynomial.
pub fn indices(sample: &Sample, response: usize) -> Option<Sensitivity> {
    let d = sample.normal.len();
    let width = sample.responses.len() / sample.count.max(1);
    let y = |row: usize| sample.responses[row * width + response];
    let rows: Vec<usize> = (0..sample.count)
        .filter(|row| y(*row).is_finite())
        .collect();
    let n = rows.len();
    let basis = Basis::new(d, MOST_TERMS.min(n / 2))?;
    let values = DVector::from_iterator(n, rows.iter().map(|row| y(*row)));
    let mean = values.mean();
    let values = values.add_scalar(-mean);
    let variance = values.norm_squared() / n as f64;
    // what rounding alone leaves of a constant
    if variance <= (1e-14 * mean).powi(2) {
        return None;
    }
    let terms = basis.terms.len();
    let mut matrix = DMatrix::zeros(terms, n);
    for (column, row) in rows.iter().enumerate() {
        let point = &sample.points[row * d..(row + 1) * d];
        basis.evaluate(
            point,
            &sample.normal,
            matrix.column_mut(column).as_mut_slice(),
        );
    }
    let whole = Fit::new(&matrix, &values)?;
    let (degree, error) = basis.best(&whole, &matrix, &values)?;
    let terms = basis.ends[degree];
    let shares = basis.shares(&whole.coefficients(terms)?)?;
    let intervals = jackknife(&basis, &matrix, &values, terms, &shares)?;
    let estimate = |p: usize, which: usize| {
        let (value, half) = (shares[p][which], intervals[p][which]);
        Estimate {
            value,
            low: value - half,
            high: value + half,
        }
    };
    Some(Sensitivity {
        method: Method::Polynomial {
            degree,
            terms,
            runs: n,
            explained: 1.0 - error / variance,
        },
        parameters: (0..d)
            .map(|p| Indices {
                main: estimate(p, 0),
                total: estimate(p, 1),
            })
            .collect(),
    })
}

/// Products of polynomials, by their total degree.
struct Basis {
    /// Per term, the degree in each parameter.
    terms: Vec<Vec<usize>>,
    /// Terms up to each total degree.
    ends: Vec<usize>,
}

impl Basis {
    /// All degrees whose terms together are at most so many; `None` where that is not even the first.
    fn new(parameters: usize, most: usize) -> Option<Basis> {
        let mut basis = Basis {
            terms: vec![vec![0; parameters]],
            ends: vec![1],
        };
        for degree in 1..=HIGHEST {
            let begin = if degree == 1 {
                0
            } else {
                basis.ends[degree - 2]
            };
            let mut next = Vec::new();
            for term in &basis.terms[begin..] {
                // each term once: a higher degree in its last parameter or in a later one
                let last = term.iter().rposition(|k| *k > 0).unwrap_or(0);
                for parameter in last..parameters {
                    let mut term = term.clone();
                    term[parameter] += 1;
                    next.push(term);
                }
                if basis.terms.len() + next.len() > most {
                    return (degree > 1).then_some(basis);
                }
            }
            basis.terms.extend(next);
            basis.ends.push(basis.terms.len());
        }
        Some(basis)
    }

    /// Highest degree that a term has.
    fn highest(&self) -> usize {
        self.ends.len() - 1
    }

    /// All terms at a point of the unit cube.
    fn evaluate(&self, point: &[f64], normal: &[bool], values: &mut [f64]) {
        let one = |(u, normal): (&f64, &bool)| polynomials(*u, *normal, self.highest());
        let factors: Vec<Vec<f64>> = point.iter().zip(normal).map(one).collect();
        for (value, term) in values.iter_mut().zip(&self.terms) {
            *value = term
                .iter()
                .zip(&factors)
                .filter(|(k, _)| **k > 0)
                .map(|(k, f)| f[*k])
                .product();
        }
    }

    /// The degree with the least error of runs left out, and the mean square of that.
    fn best(
        &self,
        fit: &Fit,
        matrix: &DMatrix<f64>,
        values: &DVector<f64>,
    ) -> Option<(usize, f64)> {
        let n = values.len();
        // With Q = L⁻¹ Ψ, fits of all degrees have the same rows of Q: ŷ = Σ Q_k (Q y)_k, h = Σ Q_k².
        let q = fit.factor.l_dirty().solve_lower_triangular(matrix)?;
        let (mut residual, mut leverage) = (values.clone(), vec![0.0; n]);
        let mut best: Option<(usize, f64)> = None;
        let mut begin = 0;
        for (degree, &end) in self.ends.iter().enumerate() {
            for term in begin..end {
                for row in 0..n {
                    residual[row] -= q[(term, row)] * fit.projected[term];
                    leverage[row] += q[(term, row)] * q[(term, row)];
                }
            }
            begin = end;
            let left_out = |(r, h): (&f64, &f64)| (r / (1.0 - h)).powi(2);
            let error = residual.iter().zip(&leverage).map(left_out).sum::<f64>() / n as f64;
            let possible = leverage.iter().all(|h| *h < 1.0) && degree > 0;
            if possible && best.is_none_or(|(_, least)| error < least) {
                best = Some((degree, error));
            }
        }
        best
    }

    /// Main and total share of the variance of a polynomial, per parameter.
    fn shares(&self, coefficients: &DVector<f64>) -> Option<Vec<[f64; 2]>> {
        let mut shares = vec![[0.0; 2]; self.terms[0].len()];
        let mut variance = 0.0;
        for (term, c) in self.terms.iter().zip(coefficients.iter()).skip(1) {
            variance += c * c;
            let alone = term.iter().filter(|k| **k > 0).count() == 1;
            for (share, _) in shares.iter_mut().zip(term).filter(|(_, k)| **k > 0) {
                share[0] += if alone { c * c } else { 0.0 };
                share[1] += c * c;
            }
        }
        let scaled = shares
            .iter()
            .map(|share| share.map(|s| s / variance))
            .collect();
        (variance > 0.0).then_some(scaled)
    }
}

/// Orthonormal polynomials of degrees 0 … `highest` at u of (0, 1).
fn polynomials(u: f64, is_normal: bool, highest: usize) -> Vec<f64> {
    let x = if is_normal {
        normal::quantile(u)
    } else {
        2.0 * u - 1.0
    };
    let mut values = vec![1.0, x];
    for k in 1..highest {
        let (k, a, b) = (k as f64, values[k], values[k - 1]);
        values.push(if is_normal {
            x * a - k * b
        } else {
            ((2.0 * k + 1.0) * x * a - k * b) / (k + 1.0)
        });
    }
    let mut factorial = 1.0;
    for (k, value) in values.iter_mut().enumerate() {
        factorial *= (k as f64).max(1.0);
        *value *= if is_normal {
            1.0 / f64::sqrt(factorial)
        } else {
            (2.0 * k as f64 + 1.0).sqrt()
        };
    }
    values
}

/// Least squares by normal equations; the terms are orthonormal on average, so these are well conditioned.
struct Fit {
    factor: Cholesky<f64, Dyn>,
    /// L⁻¹ Ψ y
    projected: DVector<f64>,
}

impl Fit {
    /// Of all terms.
    fn new(matrix: &DMatrix<f64>, values: &DVector<f64>) -> Option<Fit> {
        Fit::solved(matrix * matrix.transpose(), matrix * values)
    }

    fn solved(gram: DMatrix<f64>, right: DVector<f64>) -> Option<Fit> {
        let factor = Cholesky::new(gram)?;
        let projected = factor.l_dirty().solve_lower_triangular(&right)?;
        Some(Fit { factor, projected })
    }

    /// Coefficients of the first terms alone: Lᵀ c = L⁻¹ Ψ y, of the leading blocks.
    fn coefficients(&self, terms: usize) -> Option<DVector<f64>> {
        let leading = self.factor.l_dirty().view((0, 0), (terms, terms));
        leading.tr_solve_lower_triangular(&self.projected.rows(0, terms))
    }
}

/// Half the interval of each share: fits without one part of the runs, var = (m − 1)/m Σ (θ_k − θ̄)².
fn jackknife(
    basis: &Basis,
    matrix: &DMatrix<f64>,
    values: &DVector<f64>,
    terms: usize,
    shares: &[[f64; 2]],
) -> Option<Vec<[f64; 2]>> {
    let n = values.len();
    // in turn, so that parts have the same size, but not by neighbours, which designs tie together
    let order = Permutation::new(n as u64, 0, PARTING);
    let mut parts: Vec<Vec<usize>> = vec![Vec::new(); PARTS];
    for row in 0..n {
        parts[order.of(row as u64) as usize % PARTS].push(row);
    }
    let used = matrix.rows(0, terms);
    let (gram, right) = (used * used.transpose(), used * values);
    let mut found: Vec<Vec<[f64; 2]>> = Vec::new();
    for part in &parts {
        let left_out = used.select_columns(part);
        let part_values = DVector::from_iterator(part.len(), part.iter().map(|row| values[*row]));
        let fit = Fit::solved(
            &gram - &left_out * left_out.transpose(),
            &right - &left_out * part_values,
        )?;
        found.push(basis.shares(&fit.coefficients(terms)?)?);
    }
    let m = PARTS as f64;
    let half = |parameter: usize, which: usize| {
        let of = |shares: &Vec<[f64; 2]>| shares[parameter][which];
        let mean = found.iter().map(of).sum::<f64>() / m;
        let squares: f64 = found.iter().map(|shares| (of(shares) - mean).powi(2)).sum();
        WIDTH * ((m - 1.0) / m * squares).sqrt()
    };
    Some(
        (0..shares.len())
            .map(|p| [half(p, 0), half(p, 1)])
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_orthonormal() {
        // the midpoint rule over u; of Hermite's, tails beyond u = 1/2n are left out
        let n = 1_000_000;
        for (is_normal, tolerance) in [(false, 1e-9), (true, 2e-3)] {
            let mut products = [[0.0; 5]; 5];
            for k in 0..n {
                let values = polynomials((f64::from(k) + 0.5) / f64::from(n), is_normal, 4);
                for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
                    products[i][j] += values[i] * values[j] / f64::from(n);
                }
            }
            for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
                let expected = f64::from(u8::from(i == j));
                // higher degrees live further out in the tails
                let allowed = tolerance * 8f64.powi(i.max(j) as i32 - 1).max(1.0);
                assert!(
                    (products[i][j] - expected).abs() < allowed,
                    "{is_normal} {i} {j}: {}",
                    products[i][j]
                );
            }
        }
    }

    #[test]
    fn terms_are_counted_by_binomials() {
        // C(d + p, p) terms up to degree p
        let basis = Basis::new(3, 60).unwrap();
        assert_eq!(basis.ends, [1, 4, 10, 20, 35, 56]);
        let mut terms = basis.terms.clone();
        terms.sort();
        terms.dedup();
        assert_eq!(terms.len(), 56);
        assert!(Basis::new(60, 60).is_none());
    }
}
