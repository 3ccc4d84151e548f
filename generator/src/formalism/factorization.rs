//! S = L D Lᵀ with a fixed pattern of zeros, and the accelerations by it.
//!
//! The order is from the leaves to the root, as in Featherstone's LᵀDL: then no entry fills that the tree leaves empty. No
//! square root, one division per row; pivots are positive because S is.

use super::layout::Layout;
use crate::expression::{Expr, Graph};
use std::ops::{Mul, Sub};

/// L D Lᵀ of a symmetric positive definite matrix.
pub struct Ldl<'g> {
    /// Strictly below the diagonal, by rows.
    lower: Vec<Vec<Expr<'g>>>,
    /// 1/d
    inverse_diagonal: Vec<Expr<'g>>,
}

impl<'g> Ldl<'g> {
    /// Factorises; `matrix` holds the lower triangle by rows, diagonal included.
    pub fn of(graph: &'g Graph, mut matrix: Vec<Vec<Expr<'g>>>) -> Self {
        let size = matrix.len();
        let mut inverse_diagonal = Vec::with_capacity(size);
        for j in 0..size {
            let inverse = graph.constant(1.0) / matrix[j][j];
            inverse_diagonal.push(inverse);
            let column: Vec<Expr<'g>> = (j + 1..size).map(|i| matrix[i][j]).collect();
            for i in j + 1..size {
                let factor = column[i - j - 1] * inverse;
                if factor.is_zero() {
                    continue;
                }
                for k in j + 1..=i {
                    matrix[i][k] = matrix[i][k] - factor * column[k - j - 1];
                }
                matrix[i][j] = factor;
            }
        }
        for (i, row) in matrix.iter_mut().enumerate() {
            row.truncate(i);
        }
        Ldl {
            lower: matrix,
            inverse_diagonal,
        }
    }

    /// L⁻¹ b, of numbers or of rows of a matrix.
    pub fn forward<V>(&self, mut b: Vec<V>) -> Vec<V>
    where
        V: Copy + Sub<Output = V>,
        Expr<'g>: Mul<V, Output = V>,
    {
        for (i, row) in self.lower.iter().enumerate() {
            for (j, l) in row.iter().enumerate() {
                if !l.is_zero() {
                    b[i] = b[i] - *l * b[j];
                }
            }
        }
        b
    }

    /// D⁻¹ y
    pub fn scale<V>(&self, y: &[V]) -> Vec<V>
    where
        V: Copy,
        Expr<'g>: Mul<V, Output = V>,
    {
        y.iter()
            .zip(&self.inverse_diagonal)
            .map(|(y, d)| *d * *y)
            .collect()
    }

    /// L⁻ᵀ z
    pub fn backward(&self, mut z: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
        for i in (0..z.len()).rev() {
            for (j, l) in self.lower[i].iter().enumerate() {
                z[j] = z[j] - *l * z[i];
            }
        }
        z
    }

    /// The solution of L D Lᵀ x = b.
    pub fn solve(&self, b: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
        let y = self.forward(b);
        self.backward(self.scale(&y))
    }
}

/// v̇ = S⁻¹ (r_s + r_k).
pub fn accelerations<'g>(
    graph: &'g Graph,
    layout: &Layout,
    matrix: &[Vec<Option<Expr<'g>>>],
    velocity_forces: &[Expr<'g>],
    applied_forces: &[Expr<'g>],
) -> Vec<Expr<'g>> {
    graph.section("factorisation of S");
    let zero = graph.constant(0.0);
    let order: Vec<usize> = (0..layout.velocities.len()).rev().collect();
    let triangle = order
        .iter()
        .enumerate()
        .map(|(i, &row)| {
            order[..=i]
                .iter()
                .map(|&column| matrix[row][column].unwrap_or(zero))
                .collect()
        })
        .collect();
    let factors = Ldl::of(graph, triangle);
    let right = order
        .iter()
        .map(|&row| velocity_forces[row] + applied_forces[row])
        .collect();
    let mut solution = factors.solve(right);
    solution.reverse();
    solution
}
