//! Factorisation of the mass matrix, S = L D Lᵀ, and the accelerations by it: v̇ = L⁻ᵀ D⁻¹ L⁻¹ (r_s + r_k).
//!
//! Rows go from the leaves to the root. So entries that the tree leaves empty stay empty: entry (i, j) is not 0 only if
//! one of the two elements carries the other.   \[Featherstone 2008, ch. 6.5\]   There is no square root and one
//! division per row. The pivots D are positive because S is positive definite.
//!
//! [`Ldl`] also factorises the small matrices of single joints in the articulated-body algorithm, such as the 3×3
//! matrix of a ball joint. No inverse is formed.
//!
//! A pivot is the articulated inertia of its freedom: the rest of S_ii when the freedoms further
//! out are free to move.

use crate::expression::{Expr, Graph};
use crate::model::{Dimension, Model, Number};
use crate::motion::Layout;
use rustc_hash::FxHashMap;
use std::ops::{Mul, Range, Sub};

/// L D Lᵀ of a symmetric positive definite matrix.
pub struct Ldl<'g> {
    /// L strictly below the diagonal, by rows.
    lower: Vec<Vec<Expr<'g>>>,
    /// The diagonal d of D.
    diagonal: Vec<Expr<'g>>,
    /// 1/d
    inverse_diagonal: Vec<Expr<'g>>,
}

/// Factors of unknowns with respect to those further inboard, by place and by the first of the others.
pub type Branches<'g> = FxHashMap<(usize, usize), Vec<(usize, Expr<'g>)>>;

impl<'g> Ldl<'g> {
    /// Factorises a matrix, given its lower triangle by rows, with the diagonal.
    pub fn of(graph: &'g Graph, mut matrix: Vec<Vec<Expr<'g>>>) -> Self {
        let size = matrix.len();
        let mut inverse_diagonal = Vec::with_capacity(size);
        let mut diagonal = Vec::with_capacity(size);
        for j in 0..size {
            diagonal.push(matrix[j][j]);
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
            diagonal,
            inverse_diagonal,
        }
    }

    /// The graph of its entries.
    ///
    /// # Panics
    /// If the matrix has no rows.
    pub fn graph(&self) -> &'g Graph {
        self.diagonal[0].graph()
    }

    /// L⁻¹ b, where b has numbers or rows of a matrix.
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

    /// L⁻ᵀ z for many z with zeros: an unknown whose own entry of z is 0, as that of a joint on another branch than the
    /// forces, follows from the unknowns of the joints that its branch and theirs have in common.
    pub fn backward_by_branches(
        &self,
        mut z: Vec<Expr<'g>>,
        known: &mut Branches<'g>,
    ) -> Vec<Expr<'g>> {
        for k in (0..z.len()).rev() {
            let zero = z[k].graph().constant(0.0);
            let first = z[k].is_zero().then(|| self.first_not_zero(k, &z)).flatten();
            let terms = match first {
                Some(first) => self.in_terms_of(k, first, known),
                None => Vec::new(),
            };
            let direct = (k + 1..z.len()).filter(|&i| !self.lower[i][k].is_zero());
            z[k] = match first.is_some() && terms.len() < direct.clone().count() {
                true => terms.iter().fold(zero, |sum, &(i, r)| sum - r * z[i]),
                false => direct.fold(z[k], |sum, i| sum - self.lower[i][k] * z[i]),
            };
        }
        z
    }

    /// The first place after k, among those on which unknown k depends, with a value that is not 0 before the values
    /// after it are taken away.
    fn first_not_zero(&self, k: usize, z: &[Expr<'g>]) -> Option<usize> {
        let mut reached = vec![false; z.len()];
        reached[k] = true;
        for i in k + 1..z.len() {
            reached[i] = (k..i).any(|j| reached[j] && !self.lower[i][j].is_zero());
            if reached[i] && !z[i].is_zero() {
                return Some(i);
            }
        }
        None
    }

    /// The factors of unknown k with respect to the unknowns from `first` on, if all before have no z of their own:
    /// minus k is the sum of the products.
    fn in_terms_of(
        &self,
        k: usize,
        first: usize,
        known: &mut Branches<'g>,
    ) -> Vec<(usize, Expr<'g>)> {
        if let Some(terms) = known.get(&(k, first)) {
            return terms.clone();
        }
        let size = self.lower.len();
        let mut factors: Vec<Expr<'g>> = (first..size).map(|i| self.lower[i][k]).collect();
        for m in k + 1..first {
            let factor = self.lower[m][k];
            if factor.is_zero() {
                continue;
            }
            for (i, of) in self.in_terms_of(m, first, known) {
                factors[i - first] = factors[i - first] - factor * of;
            }
        }
        let terms = (first..size).zip(factors).filter(|(_, f)| !f.is_zero());
        let terms: Vec<(usize, Expr<'g>)> = terms.collect();
        known.insert((k, first), terms.clone());
        terms
    }

    /// The solution of L D Lᵀ x = b.
    pub fn solve(&self, b: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
        let y = self.forward(b);
        self.backward(self.scale(&y))
    }
}

/// For each velocity of an element: the ratio of its pivot to its diagonal entry of S, i.e. the share of the inertia
/// that remains after the velocities further out are eliminated, with the path of the element. The ratio is 0 if
/// nothing resists this velocity while the elements outboard move freely. If all moments of inertia are positive, that
/// is impossible.
pub fn pivots<'g>(
    graph: &'g Graph,
    model: &Model,
    layout: &Layout,
    matrix: &[Vec<Option<Expr<'g>>>],
) -> Vec<(String, Expr<'g>)> {
    graph.section("what is left of the inertia");
    let order = outboard_first(0..layout.velocities.len());
    let factors = Ldl::of(graph, triangle(graph, &order, matrix));
    let mut pivots = Vec::new();
    for (&row, &left) in order.iter().zip(&factors.diagonal) {
        let variable = &layout.velocities[row];
        if let (Some(element), Some(whole)) = (variable.element, matrix[row][row]) {
            let system = &model.systems[variable.system];
            let path = format!("{}/{}", system.name, system.elements[element].name);
            pivots.push((path, left / whole));
        }
    }
    pivots
}

/// The largest number of freedoms for which the [`pivots`] are derived; beyond, they would take too many
/// statements.
pub const MOST_PIVOTS: usize = 60;

/// Whether an element has a moment of inertia of 0.
pub fn may_vanish(model: &Model) -> bool {
    let mut elements = model.systems.iter().flat_map(|system| &system.elements);
    elements.any(|element| match model.dimension {
        Dimension::Plane => element.inertia[1].is_zero(),
        Dimension::Space => element.inertia.iter().any(Number::is_zero),
    })
}

/// v̇ = S⁻¹ (r_s + r_k).
pub fn accelerations<'g>(
    graph: &'g Graph,
    layout: &Layout,
    matrix: &[Vec<Option<Expr<'g>>>],
    velocity_forces: &[Expr<'g>],
    applied_forces: &[Expr<'g>],
) -> Vec<Expr<'g>> {
    let mut accelerations = vec![graph.constant(0.0); velocity_forces.len()];
    let rows = 0..layout.velocities.len();
    let forces = [velocity_forces, applied_forces];
    accelerations_of(graph, rows, matrix, forces, &mut accelerations);
    accelerations
}

/// v̇ = S⁻¹ (r_s + r_k), for rows that are not coupled to any others.
pub fn accelerations_of<'g>(
    graph: &'g Graph,
    rows: Range<usize>,
    matrix: &[Vec<Option<Expr<'g>>>],
    [velocity_forces, applied_forces]: [&[Expr<'g>]; 2],
    accelerations: &mut [Expr<'g>],
) {
    graph.section("factorisation of S");
    let order = outboard_first(rows);
    let factors = Ldl::of(graph, triangle(graph, &order, matrix));
    let right = order
        .iter()
        .map(|&row| velocity_forces[row] + applied_forces[row])
        .collect();
    for (&row, solution) in order.iter().zip(factors.solve(right)) {
        accelerations[row] = solution;
    }
}

/// Indices of the velocities, with each element before the one that carries it.
pub fn outboard_first(rows: Range<usize>) -> Vec<usize> {
    rows.rev().collect()
}

/// The lower triangle of a symmetric matrix, with its rows in this order.
fn triangle<'g>(
    graph: &'g Graph,
    order: &[usize],
    matrix: &[Vec<Option<Expr<'g>>>],
) -> Vec<Vec<Expr<'g>>> {
    let zero = graph.constant(0.0);
    triangle_of(order, |row, column| matrix[row][column].unwrap_or(zero))
}

/// The lower triangle of the symmetric matrix with these entries, with its rows in this order.
pub fn triangle_of<'g>(
    order: &[usize],
    entry: impl Fn(usize, usize) -> Expr<'g>,
) -> Vec<Vec<Expr<'g>>> {
    let row = |(i, &row): (usize, &usize)| {
        let columns = order[..=i].iter();
        columns.map(|&column| entry(row, column)).collect()
    };
    order.iter().enumerate().map(row).collect()
}
