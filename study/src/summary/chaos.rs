//! Sobol' indices from polynomial chaos, a polynomial that is fitted to the runs: y = Σ c_α ψ_α, with ψ orthonormal
//! under the distribution of the parameters, has the variance Σ_{α ≠ 0} c_α². Each term contributes to the parameters
//! that it depends on \[B. Sudret, Reliab. Eng. Syst. Saf. 93, 964 (2008)\].
//!
//! The ψ are products of functions of one parameter each (`family`), and the c follow from least squares. The total
//! degree is chosen by cross-validation: each run is predicted by a fit without it, and the degree with the least
//! errors is used. The error of run i is r_i/(1 − h_i), with the residual r and the diagonal h of the projection. For
//! intervals, the fit is repeated without one of 32 parts of the runs, for each part (jackknife).
//!
//! If some values, or combinations of values, are rare, a term may differ from others in no run, or in a single run,
//! which the fit would then predict from itself. Such a term is left out.

use super::family::{Family, HIGHEST};
use super::index::{Estimate, Estimator, Indices, Sensitivity};
use super::sample::Sample;
use crate::design::permutation::Permutation;
use nalgebra::{DMatrix, DVector};

/// Largest number of terms of a polynomial.
const MOST_TERMS: usize = 300;
/// Number of parts of the runs for the jackknife.
const PARTS: usize = 32;
/// Stream of random numbers that assigns runs to parts of the jackknife.
const PARTING: u64 = 13 << 32;
/// A term is independent of earlier ones if at least this share of its squared norm remains after projection on them.
/// Rounding of the sums over the runs is smaller.
const INDEPENDENT: f64 = 1e-10;
/// A run is predicted from itself only if 1 − h is below this; rounding is smaller.
const ALONE: f64 = 1e-8;
/// Half of a normal interval of 95 %, in standard deviations.
const WIDTH: f64 = 1.959_963_984_540_054;

/// Indices of a response; `None` if it does not vary, or if there are too few runs for a polynomial.
pub fn indices(sample: &Sample, response: usize) -> Option<Sensitivity> {
    let d = sample.families.len();
    let width = sample.responses.len() / sample.count.max(1);
    let y = |row: usize| sample.responses[row * width + response];
    let rows: Vec<usize> = (0..sample.count)
        .filter(|row| y(*row).is_finite())
        .collect();
    let n = rows.len();
    let caps: Vec<usize> = sample.families.iter().map(Family::highest).collect();
    let mut basis = Basis::new(&caps, MOST_TERMS.min(n / 2))?;
    let values = DVector::from_iterator(n, rows.iter().map(|row| y(*row)));
    let mean = values.mean();
    let values = values.add_scalar(-mean);
    let variance = values.norm_squared() / n as f64;
    // the values of a constant differ by rounding only
    if variance <= squared(1e-14 * mean) {
        return None;
    }
    let terms = basis.terms.len();
    let mut matrix = DMatrix::zeros(terms, n);
    for (column, row) in rows.iter().enumerate() {
        let point = &sample.points[row * d..(row + 1) * d];
        basis.evaluate(
            point,
            &sample.families,
            matrix.column_mut(column).as_mut_slice(),
        );
    }
    let (whole, projection) = loop {
        let whole = Fit::new(&matrix, &values)?;
        // With Q = L⁻¹ Ψ, fits of all degrees have the same rows of Q: ŷ = Σ Q_k (Q y)_k, h = Σ Q_k².
        let projection = whole.lower.solve_lower_triangular(&matrix)?;
        let lost = whole.lost(&projection);
        if lost.is_empty() {
            break (whole, projection);
        }
        basis.remove(&lost);
        matrix = matrix.remove_rows_at(&lost);
    };
    let (degree, error) = basis.best(&whole, &projection, &values)?;
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
        method: Estimator::Polynomial {
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
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub struct Basis {
    /// For each term, the degree in each parameter.
    pub terms: Vec<Vec<usize>>,
    /// Number of terms up to each total degree.
    pub ends: Vec<usize>,
}

impl Basis {
    /// The terms of all total degrees up to the largest for which there are at most `most` terms; `None` if the first
    /// degree already has more. `caps` are the highest degrees of each parameter alone.
    pub fn new(caps: &[usize], most: usize) -> Option<Basis> {
        let mut basis = Basis {
            terms: vec![vec![0; caps.len()]],
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
                // each term is made once: from a term of the degree below, by raising its last parameter or a later one
                let last = term.iter().rposition(|k| *k > 0).unwrap_or(0);
                for parameter in (last..caps.len()).filter(|p| term[*p] < caps[*p]) {
                    let mut term = term.clone();
                    term[parameter] += 1;
                    next.push(term);
                }
                if basis.terms.len() + next.len() > most {
                    return (degree > 1).then_some(basis);
                }
            }
            // all functions of the parameters are in use
            if next.is_empty() {
                return (degree > 1).then_some(basis);
            }
            basis.terms.extend(next);
            basis.ends.push(basis.terms.len());
        }
        Some(basis)
    }

    /// Removes some terms, given in increasing order.
    pub fn remove(&mut self, lost: &[usize]) {
        let before = |end: &usize| lost.partition_point(|term| term < end);
        self.ends = self.ends.iter().map(|end| end - before(end)).collect();
        for term in lost.iter().rev() {
            self.terms.remove(*term);
        }
    }

    /// Highest degree of a term.
    fn highest(&self) -> usize {
        self.ends.len() - 1
    }

    /// The values of all terms at a point of the unit cube.
    fn evaluate(&self, point: &[f64], families: &[Family], values: &mut [f64]) {
        let one = |(u, family): (&f64, &Family)| family.evaluate(*u, self.highest());
        let factors: Vec<Vec<f64>> = point.iter().zip(families).map(one).collect();
        for (value, term) in values.iter_mut().zip(&self.terms) {
            *value = term
                .iter()
                .zip(&factors)
                .filter(|(k, _)| **k > 0)
                .map(|(k, f)| f[*k])
                .product();
        }
    }

    /// The total degree with the least error in cross-validation, and the mean square of this error.
    fn best(&self, fit: &Fit, q: &DMatrix<f64>, values: &DVector<f64>) -> Option<(usize, f64)> {
        let n = values.len();
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
            let left_out = |(r, h): (&f64, &f64)| squared(r / (1.0 - h));
            let error = residual.iter().zip(&leverage).map(left_out).sum::<f64>() / n as f64;
            if degree > 0 && best.is_none_or(|(_, least)| error < least) {
                best = Some((degree, error));
            }
        }
        best
    }

    /// Main and total share of the variance of a polynomial, for each parameter.
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

/// Least squares by normal equations, which are well conditioned because the terms are orthonormal on average.
struct Fit {
    /// L of Ψ Ψᵀ = L Lᵀ. Its diagonal is infinite for a term that depends linearly on earlier ones, so that the
    /// coefficient of the term is 0.
    lower: DMatrix<f64>,
    /// L⁻¹ Ψ y
    projected: DVector<f64>,
}

impl Fit {
    /// The fit with all terms.
    fn new(matrix: &DMatrix<f64>, values: &DVector<f64>) -> Option<Fit> {
        Fit::solved(gram(matrix, matrix.nrows()), matrix * values)
    }

    fn solved(gram: DMatrix<f64>, right: DVector<f64>) -> Option<Fit> {
        // the constant term has the number of runs on the diagonal, which is the mean for all other terms
        let least = INDEPENDENT * gram[(0, 0)];
        let terms = gram.nrows();
        let mut lower = gram;
        for term in 0..terms {
            let (mut column, mut later) = lower.columns_range_pair_mut(term, term + 1..);
            let below = terms - term - 1;
            if column[term] <= least {
                column[term] = f64::INFINITY;
                column.rows_mut(term + 1, below).fill(0.0);
                continue;
            }
            let root = column[term].sqrt();
            column.rows_mut(term, below + 1).unscale_mut(root);
            for k in 0..below {
                let row = term + 1 + k;
                later.column_mut(k).rows_mut(row, below - k).axpy(
                    -column[row],
                    &column.rows(row, below - k),
                    1.0,
                );
            }
        }
        let projected = lower.solve_lower_triangular(&right)?;
        Some(Fit { lower, projected })
    }

    /// Terms that depend linearly on earlier ones, and terms that make the fit predict a run from itself only.
    fn lost(&self, q: &DMatrix<f64>) -> Vec<usize> {
        let mut leverage = vec![0.0; q.ncols()];
        let mut lost = Vec::new();
        for (term, row) in q.row_iter().enumerate() {
            let with = |(h, q): (&f64, &f64)| h + q * q;
            let next: Vec<f64> = leverage.iter().zip(row.iter()).map(with).collect();
            if self.lower[(term, term)].is_infinite() || next.iter().any(|h| 1.0 - h < ALONE) {
                lost.push(term);
            } else {
                leverage = next;
            }
        }
        lost
    }

    /// Coefficients of a fit with only the first `terms` terms: Lᵀ c = L⁻¹ Ψ y for the leading blocks.
    fn coefficients(&self, terms: usize) -> Option<DVector<f64>> {
        let leading = self.lower.view((0, 0), (terms, terms));
        leading.tr_solve_lower_triangular(&self.projected.rows(0, terms))
    }
}

/// The lower triangle of Ψ Ψᵀ for the first `terms` rows of Ψ; 0 above the diagonal. nalgebra is not used, because its
/// products of large matrices differ in the last bits between processors.
fn gram(matrix: &DMatrix<f64>, terms: usize) -> DMatrix<f64> {
    let mut gram = DMatrix::zeros(terms, terms);
    for column in matrix.as_slice().chunks_exact(matrix.nrows()) {
        for (i, factor) in column[..terms].iter().enumerate() {
            let sums = &mut gram.as_mut_slice()[i * terms + i..(i + 1) * terms];
            for (sum, other) in sums.iter_mut().zip(&column[i..terms]) {
                *sum += factor * other;
            }
        }
    }
    gram
}

fn squared(x: f64) -> f64 {
    x * x
}

/// Half width of the interval of each share: fits without one part of the runs each, var = (m − 1)/m Σ (θ_k − θ̄)².
fn jackknife(
    basis: &Basis,
    matrix: &DMatrix<f64>,
    values: &DVector<f64>,
    terms: usize,
    shares: &[[f64; 2]],
) -> Option<Vec<[f64; 2]>> {
    let n = values.len();
    // parts have equal sizes and are drawn at random, because designs relate neighbouring rows to each other
    let order = Permutation::new(n as u64, 0, PARTING);
    let mut parts: Vec<Vec<usize>> = vec![Vec::new(); PARTS];
    for row in 0..n {
        parts[order.of(row as u64) as usize % PARTS].push(row);
    }
    let used = matrix.rows(0, terms);
    let (whole, right) = (gram(matrix, terms), used * values);
    let mut found: Vec<Vec<[f64; 2]>> = Vec::new();
    for part in &parts {
        let left_out = used.select_columns(part);
        let part_values = DVector::from_iterator(part.len(), part.iter().map(|row| values[*row]));
        let fit = Fit::solved(
            &whole - gram(&left_out, terms),
            &right - &left_out * part_values,
        )?;
        found.push(basis.shares(&fit.coefficients(terms)?)?);
    }
    let m = PARTS as f64;
    let half = |parameter: usize, which: usize| {
        let of = |shares: &Vec<[f64; 2]>| shares[parameter][which];
        let mean = found.iter().map(of).sum::<f64>() / m;
        let squares: f64 = found.iter().map(|shares| squared(of(shares) - mean)).sum();
        WIDTH * ((m - 1.0) / m * squares).sqrt()
    };
    Some(
        (0..shares.len())
            .map(|p| [half(p, 0), half(p, 1)])
            .collect(),
    )
}
