//! ∂v̇/∂q and ∂v̇/∂v: −S⁻¹ times the derivatives of τ at v̇.

use super::loads::Loads;
use super::{DerivativeInputs, NotDifferentiable, Square, Way, cost, zeros};
use crate::dynamics::LARGEST_FACTORIZED;
use crate::dynamics::factorization::{Branches, Ldl, outboard_first, triangle_of};
use crate::expression::{Expr, Graph};
use std::cell::RefCell;

/// v̇ and its derivatives; the matrices are of the size of v, by rows.
pub struct AccelerationDerivatives<'g> {
    /// v̇
    pub accelerations: Vec<Expr<'g>>,
    /// ∂v̇/∂q, along the motions of v
    pub by_position: Square<'g>,
    /// ∂v̇/∂v
    pub by_velocity: Square<'g>,
    /// S⁻¹ = ∂v̇/∂r
    pub inverse: Square<'g>,
}

impl<'g> AccelerationDerivatives<'g> {
    /// All values.
    pub fn values(&self) -> impl Iterator<Item = Expr<'g>> + '_ {
        let matrices = [&self.by_position, &self.by_velocity, &self.inverse];
        let entries = matrices.into_iter().flatten().flatten();
        self.accelerations.iter().chain(entries).copied()
    }
}

/// v̇ = S⁻¹ (r_s + r_f + r) under the generalised forces r \[N m or N, in the order of v\] of all laws but fields, and
/// its derivatives with r held constant, as Pinocchio's `computeABADerivatives` holds τ.
///
/// `by_position[i][j]` is the derivative of v̇_i along the motion of `v[j]` (see [this folder](super)); `inverse` is
/// S⁻¹. With r zero, these are the derivatives of the mechanism that only fields move. Each system takes the way with
/// the fewest operations for all results together.
///
/// v̇ follows from S = LᵀDL and from τ at v̇ = 0, of which ½ ∂τ/∂v · v is the part that is quadratic in v. The columns
/// of −∂τ/∂q and −∂τ/∂v, taken at this v̇, are solved with the same factors or multiplied by S⁻¹, whichever is less.
///
/// # Errors
/// As for [`inverse_dynamics_derivatives`](super::inverse_dynamics_derivatives).
pub fn acceleration_derivatives<'g>(
    scene: &DerivativeInputs<'g, '_>,
    forces: &[Expr<'g>],
) -> Result<AccelerationDerivatives<'g>, NotDifferentiable> {
    let fields = Loads::of_partial_fields(scene)?;
    let none = |_: &[Expr<'g>]| Ok(Vec::new());
    Ok(under_loads(scene, forces, &fields, &none)?.0)
}

/// The results under the loads as well, whose derivatives count, and the derivatives of v̇ with respect to the other
/// inputs of the loads. `needed` has for each of these inputs the change of τ at constant v̇.
pub(super) fn under_loads<'g>(
    scene: &DerivativeInputs<'g, '_>,
    forces: &[Expr<'g>],
    loads: &Loads<'g>,
    needed: &Needed<'g, '_>,
) -> Result<(AccelerationDerivatives<'g>, Columns<'g>), NotDifferentiable> {
    let (graph, size) = (scene.graph, forces.len());
    let zero = graph.constant(0.0);
    let mut whole = AccelerationDerivatives {
        accelerations: vec![zero; size],
        by_position: zeros(graph, size),
        by_velocity: zeros(graph, size),
        inverse: zeros(graph, size),
    };
    let mut by_others = vec![vec![zero; size]; loads.by_others.len()];
    for spatial in scene.systems {
        let mut least = None;
        let rows = outboard_first(spatial.layout.system_velocities(spatial.system));
        if rows.is_empty() {
            continue;
        }
        for way in Way::all(scene, spatial)? {
            for found in by_way(scene, &way, &rows, (forces, loads, needed))? {
                let others = found.1.iter().flatten().copied();
                let now = cost(graph, found.0.values().chain(others));
                if least.as_ref().is_none_or(|(before, _)| now < *before) {
                    least = Some((now, found));
                }
            }
        }
        let Some((_, (found, others))) = least else {
            continue;
        };
        for i in rows {
            whole.accelerations[i] = found.accelerations[i];
            whole.by_position[i].clone_from(&found.by_position[i]);
            whole.by_velocity[i].clone_from(&found.by_velocity[i]);
            whole.inverse[i].clone_from(&found.inverse[i]);
            for (column, own) in by_others.iter_mut().zip(&others) {
                column[i] = own[i];
            }
        }
    }
    Ok((whole, by_others))
}

/// A list of rows for each of several inputs.
pub(super) type Columns<'g> = Vec<Vec<Expr<'g>>>;

/// For each of several inputs the derivative of τ at these v̇, which are constant.
pub(super) type Needed<'g, 'a> = dyn Fn(&[Expr<'g>]) -> Result<Columns<'g>, NotDifferentiable> + 'a;

/// The derivatives of v̇ by the motions of v, by v, S⁻¹ and the derivatives by other inputs.
type FoundByWay<'g> = (AccelerationDerivatives<'g>, Columns<'g>);

/// How the columns of ∂v̇/∂q and ∂v̇/∂v follow from those of τ.
#[derive(Clone, Copy, PartialEq)]
enum Solve {
    /// By the factors of S.
    Factors,
    /// By the factors of S, branch by branch.
    Branches,
    /// By S⁻¹.
    Inverse,
}

/// The results of a way.
fn by_way<'g>(
    scene: &DerivativeInputs<'g, '_>,
    way: &Way<'g>,
    rows: &[usize],
    (forces, loads, needed): (&[Expr<'g>], &Loads<'g>, &Needed<'g, '_>),
) -> Result<Vec<FoundByWay<'g>>, NotDifferentiable> {
    let (graph, size) = (scene.graph, forces.len());
    let zero = graph.constant(0.0);
    let bias = way.bias(zero, &scene.state.v);
    let rest = way.at(&vec![zero; size]);
    graph.section("factorisation of S");
    let solver = Solver {
        factors: Ldl::of(graph, triangle_of(rows, |i, j| rest.matrix[i][j])),
        rows,
        size,
        known: RefCell::default(),
    };
    let acting: Vec<Expr<'g>> = (0..size).map(|i| forces[i] + loads.forces[i]).collect();
    let accelerations = solver.solve(Solve::Factors, &|row| acting[row] - bias[row]);
    let rigid = way.at(&accelerations);
    let base = match way {
        Way::InLinks(way) => way.base(),
        Way::InGraph(_) => None,
    };
    let by_position = less(&rigid.by_position, &loads.by_position, |j| {
        // these columns of the rigid part follow from others
        base.as_ref().is_some_and(|base| base.turns(j))
    });
    let by_velocity = less(&rigid.by_velocity, &loads.by_velocity, |_| false);
    let spinning = base.as_ref().map(|base| {
        let mut only = rigid.by_velocity.clone();
        for row in &mut only {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = if base.turns(j) { *entry } else { zero };
            }
        }
        only
    });
    let mut others = needed(&accelerations)?;
    others.resize(loads.by_others.len(), vec![zero; size]);
    for (other, load) in others.iter_mut().zip(&loads.by_others) {
        for (entry, load) in other.iter_mut().zip(load) {
            *entry = *entry - *load;
        }
    }
    let mut ways = vec![Solve::Factors, Solve::Branches];
    if rows.len() <= LARGEST_FACTORIZED {
        ways.push(Solve::Inverse);
    }
    let with = |by: Solve| {
        let inverse = solver.inverse(match by {
            Solve::Branches => by,
            _ => Solve::Factors,
        });
        graph.section("derivatives of the accelerations");
        let columns = |of: &Square<'g>| match by {
            Solve::Inverse => solver.multiplied(&inverse, of),
            _ => solver.columns(by, of),
        };
        let mut by_position = columns(&by_position);
        if let (Some(base), Some(spinning)) = (&base, &spinning) {
            let known = [&accelerations[..], &acting];
            base.turn(&mut by_position, &columns(spinning), &inverse, known);
        }
        let other = |column: &Vec<Expr<'g>>| solver.solve(by, &|row| -column[row]);
        let others = others.iter().map(other).collect();
        let found = AccelerationDerivatives {
            accelerations: accelerations.clone(),
            by_position,
            by_velocity: columns(&by_velocity),
            inverse,
        };
        (found, others)
    };
    Ok(ways.into_iter().map(with).collect())
}

/// The difference of two matrices; the first counts as 0 in some columns.
fn less<'g>(a: &Square<'g>, b: &Square<'g>, left_out: impl Fn(usize) -> bool) -> Square<'g> {
    let entry = |j: usize, a: Expr<'g>, b: Expr<'g>| match left_out(j) {
        true => -b,
        false => a - b,
    };
    let row = |(a, b): (&Vec<Expr<'g>>, &Vec<Expr<'g>>)| {
        let entries = a.iter().zip(b).enumerate();
        entries.map(|(j, (a, b))| entry(j, *a, *b)).collect()
    };
    a.iter().zip(b).map(row).collect()
}

/// S of a system, factorised.
struct Solver<'g, 'a> {
    factors: Ldl<'g>,
    /// The rows of the system, from the leaves to the root.
    rows: &'a [usize],
    size: usize,
    known: RefCell<Branches<'g>>,
}

impl<'g> Solver<'g, '_> {
    /// S⁻¹ times a vector.
    fn solve(&self, by: Solve, of: &dyn Fn(usize) -> Expr<'g>) -> Vec<Expr<'g>> {
        let right: Vec<Expr<'g>> = self.rows.iter().map(|&row| of(row)).collect();
        let zero = right[0].graph().constant(0.0);
        let scaled = self.factors.scale(&self.factors.forward(right));
        let solved = match by {
            Solve::Branches => {
                let known = &mut self.known.borrow_mut();
                self.factors.backward_by_branches(scaled, known)
            }
            _ => self.factors.backward(scaled),
        };
        let mut column = vec![zero; self.size];
        for (&row, value) in self.rows.iter().zip(solved) {
            column[row] = value;
        }
        column
    }

    /// S⁻¹
    fn inverse(&self, by: Solve) -> Square<'g> {
        let graph = self.graph();
        graph.section("inverse of S");
        let [zero, one] = [0.0, 1.0].map(|c| graph.constant(c));
        let mut inverse = zeros(graph, self.size);
        for (place, &j) in self.rows.iter().enumerate() {
            let column = self.solve(by, &|row| if row == j { one } else { zero });
            // the entries further inboard take fewer operations, and the matrix is symmetric
            for &i in &self.rows[place..] {
                (inverse[i][j], inverse[j][i]) = (column[i], column[i]);
            }
        }
        inverse
    }

    /// −S⁻¹ times each column.
    fn columns(&self, by: Solve, of: &Square<'g>) -> Square<'g> {
        let mut result = zeros(self.graph(), self.size);
        for j in 0..self.size {
            if self.rows.iter().all(|&row| of[row][j].is_zero()) {
                continue;
            }
            let column = self.solve(by, &|row| -of[row][j]);
            for &i in self.rows {
                result[i][j] = column[i];
            }
        }
        result
    }

    /// −S⁻¹ times a matrix, as a product.
    fn multiplied(&self, inverse: &Square<'g>, of: &Square<'g>) -> Square<'g> {
        let zero = self.graph().constant(0.0);
        let mut result = zeros(self.graph(), self.size);
        for &i in self.rows {
            for j in 0..self.size {
                let terms = self.rows.iter().map(|&k| inverse[i][k] * of[k][j]);
                result[i][j] = -terms.fold(zero, |sum, term| sum + term);
            }
        }
        result
    }

    fn graph(&self) -> &'g Graph {
        self.factors.graph()
    }
}
