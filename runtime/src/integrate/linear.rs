//! Solves A x = b by Gaussian elimination.
//!
//! The matrix is A = I/(hγ) − ∂ẏ/∂y. For a mechanism its first rows come from q̇ = K(q) v and are nearly diagonal. They
//! are eliminated first, without exchange of rows. This leaves the system of the velocities, I/(hγ) − ∂v̇/∂v − hγ
//! ∂v̇/∂q, which is half as large and which a structural engineer would write. There the pivot is the largest entry of
//! its column. Zeros are skipped, so the first part costs no more than the sparse q̇.

use super::workspace::Workspace;
use crate::Real;

/// A matrix factored into L (unit diagonal) and U, with rows exchanged.
pub(crate) struct Factored<'w, T> {
    /// The entries by rows.
    rows: &'w mut [T],
    /// The row that row i was exchanged with when it was eliminated. The index is stored as a scalar, so that all
    /// memory of a run is of one type; every scalar is exact below 2²⁴.
    exchanged: &'w mut [T],
    /// The first and last columns of the runs of entries of a row that are not zero, one run after the other.
    runs: &'w mut [T],
    /// Number of rows and columns.
    order: usize,
    /// Number of rows and columns in use, from the first.
    size: usize,
}

/// Reads an index that is stored as a scalar.
#[inline(always)]
fn index<T: Real>(scalar: T) -> usize {
    scalar.to_f64() as usize
}

impl<T> Factored<'_, T> {
    /// Number of scalars of workspace for a matrix of this many rows.
    pub const fn length(order: usize) -> usize {
        order * order + 2 * order + 1
    }
}

impl<'w, T: Real> Factored<'w, T> {
    /// Workspace for a matrix of this many rows; nothing is factored yet.
    pub fn new(order: usize, workspace: &mut Workspace<'w, T>) -> Self {
        Factored {
            rows: workspace.part(order * order),
            exchanged: workspace.part(order),
            // between two runs there is at least one zero
            runs: workspace.part(order + 1),
            order,
            size: 0,
        }
    }

    /// Factors diagonal · I − `matrix`. Only the first `size` rows and columns count. The first `fixed` pivots stay in
    /// their places. For a singular matrix the results are not finite.
    pub fn factor(&mut self, diagonal: T, matrix: &[T], size: usize, fixed: usize) {
        self.size = size;
        let order = self.order;
        for i in 0..size {
            let row = i * order..i * order + size;
            for (entry, from) in self.rows[row.clone()].iter_mut().zip(&matrix[row]) {
                *entry = -*from;
            }
            self.rows[i * order + i] += diagonal;
        }
        for k in 0..size {
            let pivot = if k < fixed { k } else { self.largest(k) };
            if pivot != k {
                let (above, below) = self.rows.split_at_mut(pivot * order);
                above[k * order..][..size].swap_with_slice(&mut below[..size]);
            }
            self.exchanged[k] = T::from_f64(pivot as f64);
            self.eliminate(k);
        }
    }

    /// The row from `k` on with the largest entry in column `k`.
    fn largest(&self, k: usize) -> usize {
        let size_of = |i: usize| self.rows[i * self.order + k].abs().to_f64();
        let mut pivot = k;
        for i in k + 1..self.size {
            if size_of(pivot) < size_of(i) {
                pivot = i;
            }
        }
        pivot
    }

    /// Eliminates column `k` from the rows below row `k`.
    fn eliminate(&mut self, k: usize) {
        let (zero, order, size) = (T::from_f64(0.0), self.order, self.size);
        let (above, below) = self.rows.split_at_mut((k + 1) * order);
        let row_k = &above[k * order..][..size];
        // few entries of the rows of q̇ are not zero
        let mut ends = 0;
        for j in k + 1..size {
            let begins = row_k[j] != zero && (j == k + 1 || row_k[j - 1] == zero);
            let stops = row_k[j] == zero && j > k + 1 && row_k[j - 1] != zero;
            if begins || stops {
                self.runs[ends] = T::from_f64(j as f64);
                ends += 1;
            }
        }
        if ends % 2 == 1 {
            self.runs[ends] = T::from_f64(size as f64);
            ends += 1;
        }
        let inverse = T::from_f64(1.0) / row_k[k];
        for row in below.chunks_exact_mut(order).take(size - k - 1) {
            if row[k] == zero {
                continue;
            }
            let factor = row[k] * inverse;
            row[k] = factor;
            let minus = -factor;
            for run in self.runs[..ends].chunks_exact(2) {
                let columns = index(run[0])..index(run[1]);
                for (entry, pivot) in row[columns.clone()].iter_mut().zip(&row_k[columns]) {
                    *entry = minus.mul_add(*pivot, *entry);
                }
            }
        }
    }

    /// Solves for one right-hand side, in place.
    pub fn solve(&self, b: &mut [T]) {
        let zero = T::from_f64(0.0);
        let row = |i: usize| &self.rows[i * self.order..][..self.size];
        for (k, other) in self.exchanged.iter().enumerate().take(self.size) {
            b.swap(k, index(*other));
        }
        for i in 0..self.size {
            let mut sum = b[i];
            for (entry, x) in row(i)[..i].iter().zip(&b[..i]) {
                if *entry != zero {
                    sum = (-*entry).mul_add(*x, sum);
                }
            }
            b[i] = sum;
        }
        for i in (0..self.size).rev() {
            let row = row(i);
            let mut sum = b[i];
            for (entry, x) in row[i + 1..].iter().zip(&b[i + 1..self.size]) {
                sum = (-*entry).mul_add(*x, sum);
            }
            b[i] = sum / row[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Factored, Workspace};

    type Vector6 = [f64; 6];

    /// Random numbers in −1..1 (xorshift).
    fn random(seed: &mut u64) -> f64 {
        *seed ^= *seed << 13;
        *seed ^= *seed >> 7;
        *seed ^= *seed << 17;
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Solves (diagonal · I − matrix) x = b. The first `size` rows count, and the first `fixed` pivots stay in their
    /// places.
    fn solve(diagonal: f64, matrix: &[f64], [size, fixed]: [usize; 2], b: &mut [f64]) {
        // whatever the memory holds before
        let mut memory = vec![f64::NAN; Factored::<f64>::length(b.len())];
        let mut workspace = Workspace::new(&mut memory);
        let mut factored = Factored::new(b.len(), &mut workspace);
        assert_eq!(workspace.left(), 0);
        factored.factor(diagonal, matrix, size, fixed);
        factored.solve(b);
    }

    #[test]
    fn solutions_satisfy_their_equations() {
        let mut seed = 7;
        for case in 0..200 {
            let mut matrix = [[0.0; 6]; 6];
            for (i, row) in matrix.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    // the first three rows are like q̇ = v, the others full and stiff
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
            let mut solved = b;
            solve(diagonal, matrix.as_flattened(), [6, 3], &mut solved);
            // backward error: in the fixed part each elimination grows entries by at most max(1, |∂v̇/∂q| / diagonal)
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
        let mut b = [1.0, 0.0];
        solve(0.0, matrix.as_flattened(), [2, 0], &mut b);
        assert!(b.iter().any(|x| !x.is_finite()));
    }

    #[test]
    fn what_is_beyond_the_size_stays() {
        let matrix = [[-1.0, 0.0, 9.0], [0.0, -1.0, 9.0], [9.0, 9.0, 9.0]];
        let mut b = [4.0, 6.0, 5.0];
        solve(1.0, matrix.as_flattened(), [2, 0], &mut b);
        assert_eq!(b, [2.0, 3.0, 5.0]);
    }
}
