//! Dense symmetric positive definite matrices: factors, solutions, condition. For any scalar; not optimised for speed.

use bryant_runtime::Real;

/// The factors S = L D Lᵀ of a matrix scaled to a unit diagonal, s_ij/√(s_ii s_jj). No other diagonal scaling makes its
/// condition much smaller (van der Sluis 1969), and this condition determines the errors of a factorisation, whatever
/// the units and sizes of the unknowns (Demmel 1989).
#[derive(Clone, Debug)]
pub struct Factors<S> {
    /// √s_ii, each rounded to a double.
    scale: Vec<f64>,
    /// L below the diagonal, D on it, by rows.
    rows: Vec<Vec<S>>,
    /// ‖S‖∞ of the scaled matrix.
    norm: f64,
}

impl<S: Real> Factors<S> {
    /// Factors a matrix that is given by rows; `None` if a pivot is not positive.
    pub fn of(matrix: &[Vec<S>]) -> Option<Factors<S>> {
        let scale: Vec<f64> = (matrix.iter().enumerate())
            .map(|(i, row)| row[i].to_f64().sqrt())
            .collect();
        if !scale.iter().all(|&s| s > 0.0 && s.is_finite()) {
            return None;
        }
        let scaled =
            |i: usize, j: usize| matrix[i][j] / (S::from_f64(scale[i]) * S::from_f64(scale[j]));
        let norm = (0..scale.len())
            .map(|i| (0..scale.len()).map(|j| scaled(i, j).to_f64().abs()).sum())
            .fold(0.0, f64::max);
        let mut rows: Vec<Vec<S>> = Vec::with_capacity(scale.len());
        for i in 0..scale.len() {
            let mut row: Vec<S> = (0..=i).map(|j| scaled(i, j)).collect();
            // row_j holds l_ij d_j at first, and l_ij in the end
            for j in 0..i {
                for k in 0..j {
                    row[j] = row[j] - row[k] * rows[j][k];
                }
            }
            for j in 0..i {
                let product = row[j];
                row[j] = product / rows[j][j];
                row[i] = row[i] - product * row[j];
            }
            let pivot = row[i].to_f64();
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            rows.push(row);
        }
        Some(Factors { scale, rows, norm })
    }

    /// The scales √s_ii.
    pub fn scale(&self) -> &[f64] {
        &self.scale
    }

    /// The largest sum of absolute values in a row of the scaled matrix.
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// The smallest entry of D; the largest is at most 1.
    pub fn smallest_pivot(&self) -> f64 {
        let pivots = self.rows.iter().enumerate().map(|(i, row)| row[i].to_f64());
        pivots.fold(1.0, f64::min)
    }

    /// S⁻¹ b, for the matrix without scaling.
    pub fn solve(&self, b: &[S]) -> Vec<S> {
        let scaled = |values: &mut [S]| {
            for (value, scale) in values.iter_mut().zip(&self.scale) {
                *value = *value / S::from_f64(*scale);
            }
        };
        let mut x = b.to_vec();
        scaled(&mut x);
        self.solve_scaled(&mut x);
        scaled(&mut x);
        x
    }

    fn solve_scaled(&self, x: &mut [S]) {
        for i in 0..x.len() {
            for j in 0..i {
                x[i] = x[i] - self.rows[i][j] * x[j];
            }
        }
        for i in (0..x.len()).rev() {
            x[i] = x[i] / self.rows[i][i];
        }
        for i in (0..x.len()).rev() {
            for j in 0..i {
                x[j] = x[j] - self.rows[i][j] * x[i];
            }
        }
    }

    /// An estimate of κ∞ of the scaled matrix from below, rarely less than a third of it (Hager 1984; Higham 2002,
    /// algorithm 15.1). The norm of S⁻¹ comes from a few solutions.
    pub fn condition(&self) -> f64 {
        let size = self.scale.len();
        let mut x = vec![S::from_f64(1.0 / size as f64); size];
        let mut estimate = 0.0f64;
        for _ in 0..5 {
            self.solve_scaled(&mut x);
            let found: f64 = x.iter().map(|value| value.to_f64().abs()).sum();
            if found <= estimate {
                break;
            }
            estimate = found;
            let mut sign: Vec<S> = x
                .iter()
                .map(|value| S::from_f64(if value.to_f64() < 0.0 { -1.0 } else { 1.0 }))
                .collect();
            self.solve_scaled(&mut sign);
            let size_of = |i: &usize| sign[*i].to_f64().abs();
            let largest = (0..size)
                .max_by(|i, j| size_of(i).total_cmp(&size_of(j)))
                .unwrap_or(0);
            x = vec![S::from_f64(0.0); size];
            x[largest] = S::from_f64(1.0);
        }
        self.norm * estimate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bryant_runtime::DoubleDouble;

    /// Hilbert's matrix of order 6: the sum of the absolute values of a row of its inverse is at most 1.19e7 (Todd
    /// 1961: κ∞ = 29 070 279), and its factors can be solved without scaling.
    #[test]
    fn hilbert_matrix_is_solved_in_double_double() {
        let one = <DoubleDouble as Real>::from_f64(1.0);
        let entry = |i: usize, j: usize| one / Real::from_f64((i + j + 1) as f64);
        let matrix: Vec<Vec<DoubleDouble>> = (0..6)
            .map(|i| (0..6).map(|j| entry(i, j)).collect())
            .collect();
        let factors = Factors::of(&matrix).expect("positive definite");
        let x: Vec<DoubleDouble> = (1..=6).map(|i| Real::from_f64(f64::from(i))).collect();
        let b: Vec<DoubleDouble> = matrix
            .iter()
            .map(|row| {
                let products = row.iter().zip(&x).map(|(a, x)| *a * *x);
                products.fold(Real::from_f64(0.0), |sum, product| sum + product)
            })
            .collect();
        for (found, expected) in factors.solve(&b).into_iter().zip(x) {
            assert!((found - expected).to_f64().abs() < 1e-22);
        }
    }

    /// 1 on and r beside the diagonal: ‖S‖∞ = 1 + r, ‖S⁻¹‖∞ = 1/(1 − r), whatever the units.
    #[test]
    fn condition_does_not_depend_on_units() {
        let r = 0.999;
        for unit in [1.0, 1e-6, 1e6] {
            let matrix = [vec![1.0, r * unit], vec![r * unit, unit * unit]];
            let factors = Factors::of(&matrix).expect("positive definite");
            let condition = factors.condition();
            assert!((condition * (1.0 - r) / (1.0 + r) - 1.0).abs() < 1e-9);
        }
        assert!(Factors::of(&[vec![1.0, 2.0], vec![2.0, 1.0]]).is_none());
    }
}
