//! ∂v̇/∂q and ∂v̇/∂v: −S⁻¹ times the derivatives of τ at v̇.

use super::{NotDifferentiable, Scene, Square, Way, cost, zeros};
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

/// v̇ = S⁻¹ (r_s + r_f + r) under the generalised forces r \[N m or N, in the order of v\] of all laws but fields, and its
/// derivatives with r held constant, as Pinocchio's `computeABADerivatives` holds τ.
///
/// `by_position[i][j]` is the derivative of v̇_i along the motion of `v[j]` (see [this folder](super)); `inverse` is S⁻¹.
/// With r zero, these are the derivatives of the mechanism that only fields move. Each system takes the way with the
/// fewest operations for all results together.
///
/// v̇ follows from S = LᵀDL and from τ at v̇ = 0, of which ½ ∂τ/∂v · v is the part that is quadratic in v. The columns
/// of −∂τ/∂q and −∂τ/∂v, taken at this v̇, are solved with the same factors or multiplied by S⁻¹, whichever is less.
///
/// # Errors
/// As for [`inverse_dynamics_derivatives`](super::inverse_dynamics_derivatives).
pub fn acceleration_derivatives<'g>(
    scene: &Scene<'g, '_>,
    forces: &[Expr<'g>],
) -> Result<AccelerationDerivatives<'g>, NotDifferentiable> {
    let (graph, size) = (scene.graph(), forces.len());
    let mut whole = AccelerationDerivatives {
        accelerations: vec![graph.constant(0.0); size],
        by_position: zeros(graph, size),
        by_velocity: zeros(graph, size),
        inverse: zeros(graph, size),
    };
    for spatial in scene.systems {
        let mut least: Option<(usize, AccelerationDerivatives<'g>)> = None;
        let rows: Vec<usize> = outboard_first(spatial.layout.system_velocities(spatial.system));
        for way in Way::all(scene, spatial)? {
            for found in by_way(scene, &way, &rows, forces) {
                let now = cost(graph, found.values());
                if least.as_ref().is_none_or(|(before, _)| now < *before) {
                    least = Some((now, found));
                }
            }
        }
        let Some((_, found)) = least else { continue };
        for i in rows {
            whole.accelerations[i] = found.accelerations[i];
            whole.by_position[i].clone_from(&found.by_position[i]);
            whole.by_velocity[i].clone_from(&found.by_velocity[i]);
            whole.inverse[i].clone_from(&found.inverse[i]);
        }
    }
    Ok(whole)
}

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
    scene: &Scene<'g, '_>,
    way: &Way<'g>,
    rows: &[usize],
    forces: &[Expr<'g>],
) -> Vec<AccelerationDerivatives<'g>> {
    let (graph, size) = (scene.graph(), forces.len());
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
    let accelerations = solver.solve(Solve::Factors, &|row| forces[row] - bias[row]);
    let found = way.at(&accelerations);
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
        let by_velocity = columns(&found.by_velocity);
        let by_position = match way {
            Way::InLinks(way) if way.base().is_some() => {
                let mut of = found.by_position.clone();
                let base = way.base().expect("a free base");
                // its columns follow from the others
                for row in &mut of {
                    row[base.rotation..base.rotation + 3].fill(zero);
                }
                let mut columns = columns(&of);
                base.turn(
                    &mut columns,
                    &by_velocity,
                    &inverse,
                    [&accelerations, forces],
                );
                columns
            }
            _ => columns(&found.by_position),
        };
        AccelerationDerivatives {
            accelerations: accelerations.clone(),
            by_position,
            by_velocity,
            inverse,
        }
    };
    ways.into_iter().map(with).collect()
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
        for &j in self.rows {
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
            for &j in self.rows {
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
