//! Solving A x = b with the fixed sizes of a model.
//!
//! A = I/(hγ) − ∂ẏ/∂y of a mechanism has q̇ = K(q) v in its first rows, nearly diagonal. These are eliminated first and without
//! exchange of rows, which leaves the system of the velocities that a structural engineer would have written down,
//! I/(hγ) − ∂v̇/∂v − hγ ∂v̇/∂q, half as large; there the pivot is the largest of its column. Zeros are skipped, so that the first
//! part costs what the sparse q̇ costs.

use crate::{Real, Vector};

/// A matrix, factored into L (unit diagonal) and U, rows exchanged.
pub(crate) struct Factored<T, S: Vector<T>> {
    rows: S::Square,
    /// Row i was exchanged with this one when i was eliminated.
    exchanged: S::Indices,
    /// Rows and columns in use, from the first.
    size: usize,
}

impl<T: Real, S: Vector<T>> Factored<T, S> {
    /// Nothing yet.
    pub fn new() -> Self {
        Factored {
            rows: S::square(T::from_f64(0.0)),
            exchanged: S::indices(),
            size: 0,
        }
    }

    /// Factors diagonal · I − `matrix`, of whose rows and columns the first `size` count; the first `fixed` pivots stay in
    /// their places. A singular matrix gives what is not finite.
    pub fn factor(&mut self, diagonal: T, matrix: &S::Square, size: usize, fixed: usize) {
        self.size = size;
        let zero = T::from_f64(0.0);
        let rows = self.rows.as_mut();
        for (i, (row, from)) in rows.iter_mut().zip(matrix.as_ref()).enumerate().take(size) {
            for j in 0..size {
                row[j] = -from[j];
            }
            row[i] += diagonal;
        }
        for k in 0..size {
            let mut pivot = k;
            if k >= fixed {
                for i in k + 1..size {
                    if rows[pivot][k].abs().to_f64() < rows[i][k].abs().to_f64() {
                        pivot = i;
                    }
                }
                rows.swap(k, pivot);
            }
            self.exchanged.as_mut()[k] = pivot;
            let (above, below) = rows.split_at_mut(k + 1);
            let row_k = &above[k];
            // of the rows of q̇ few entries are not zero
            let mut columns = S::indices();
            let mut count = 0;
            for j in k + 1..size {
                if row_k[j] != zero {
                    columns.as_mut()[count] = j;
                    count += 1;
                }
            }
            let inverse = T::from_f64(1.0) / row_k[k];
            for row in below.iter_mut().take(size - k - 1) {
                if row[k] == zero {
                    continue;
                }
                let factor = row[k] * inverse;
                row[k] = factor;
                let minus = -factor;
                if count < size - k - 1 {
                    for &j in &columns.as_ref()[..count] {
                        row[j] = minus.mul_add(row_k[j], row[j]);
                    }
                } else {
                    for j in k + 1..size {
                        row[j] = minus.mul_add(row_k[j], row[j]);
                    }
                }
            }
        }
    }

    /// Solves for one right-hand side, in its place.
    pub fn solve(&self, b: &mut S) {
        let zero = T::from_f64(0.0);
        let (rows, exchanged) = (self.rows.as_ref(), self.exchanged.as_ref());
        for (k, &other) in exchanged.iter().enumerate().take(self.size) {
            b.as_mut().swap(k, other);
        }
        for i in 0..self.size {
            let mut sum = b[i];
            for k in 0..i {
                if rows[i][k] != zero {
                    sum = (-rows[i][k]).mul_add(b[k], sum);
                }
            }
            b[i] = sum;
        }
        for i in (0..self.size).rev() {
            let mut sum = b[i];
            for k in i + 1..self.size {
                sum = (-rows[i][k]).mul_add(b[k], sum);
            }
            b[i] = sum / rows[i][i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Factored;

    type Vector6 = [f64; 6];

    /// Random numbers in −1..1 (xorshift).
    fn random(seed: &mut u64) -> f64 {
        *seed ^= *seed << 13;
        *seed ^= *seed >> 7;
        *seed ^= *seed << 17;
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[test]
    fn solutions_satisfy_their_equations() {
        let mut seed = 7;
        for case in 0..200 {
            let mut matrix = [[0.0; 6]; 6];
            for (i, row) in matrix.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    // the first three rows like q̇ = v, the others full and stiff
                    *entry = match (i < 3, j == i + 3) {
                        (true, true) => 1.0,
                        (true, false) => 0.0,
                        _ => 1e3 * random(&mut seed),
                    };
                }
            }
            let diagonal = 10f64.powi(case % 5);
            let x: Vector6 = core::array::from_fn(|_| random(&mut seed));
            let product = |x: &Vector6| -> Vector6 {
                core::array::from_fn(|i| {
                    diagonal * x[i] - (0..6).map(|j| matrix[i][j] * x[j]).sum::<f64>()
                })
            };
            let b = product(&x);
            let mut factored = Factored::<f64, Vector6>::new();
            factored.factor(diagonal, &matrix, 6, 3);
            let mut solved = b;
            factored.solve(&mut solved);
            // backward error: the growth of the fixed part is at most max(1, |∂v̇/∂q| / diagonal) each time
            let residual = product(&solved);
            let largest = matrix
                .iter()
                .flatten()
                .fold(diagonal, |m, x| m.max(x.abs()));
            let growth = 1.0 + largest / diagonal;
            let size = solved.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let bound = 100.0 * f64::EPSILON * growth * largest * size;
            for i in 0..6 {
                assert!((residual[i] - b[i]).abs() <= bound, "case {case}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_shows() {
        let matrix = [[1.0, 2.0], [2.0, 4.0]];
        let mut factored = Factored::<f64, [f64; 2]>::new();
        factored.factor(0.0, &matrix, 2, 0);
        let mut b = [1.0, 0.0];
        factored.solve(&mut b);
        assert!(b.iter().any(|x| !x.is_finite()));
    }

    #[test]
    fn what_is_beyond_the_size_stays() {
        let matrix = [[-1.0, 0.0, 9.0], [0.0, -1.0, 9.0], [9.0, 9.0, 9.0]];
        let mut factored = Factored::<f64, [f64; 3]>::new();
        factored.factor(1.0, &matrix, 2, 0);
        let mut b = [4.0, 6.0, 5.0];
        factored.solve(&mut b);
        assert_eq!(b, [2.0, 3.0, 5.0]);
    }
}
