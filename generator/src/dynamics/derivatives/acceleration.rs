//! ∂v̇/∂q and ∂v̇/∂v: −S⁻¹ times the derivatives of τ at v̇.

use super::{Found, NotDifferentiable, Scene, Square, Way, cost, outboard_first, zeros};
use crate::dynamics::factorization::{Ldl, triangle_of};
use crate::expression::Expr;

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

/// The results of a way, with columns that are solved and with columns that are multiplied.
fn by_way<'g>(
    scene: &Scene<'g, '_>,
    way: &Way<'g>,
    rows: &[usize],
    forces: &[Expr<'g>],
) -> [AccelerationDerivatives<'g>; 2] {
    let (graph, size) = (scene.graph(), forces.len());
    let zero = graph.constant(0.0);
    let bias = way.bias(zero, &scene.state.v);
    let rest = way.at(&vec![zero; size]);
    graph.section("factorisation of S");
    let factors = Ldl::of(graph, triangle_of(rows, |i, j| rest.matrix[i][j]));
    let solve = |of: &dyn Fn(usize) -> Expr<'g>| {
        let solved = factors.solve(rows.iter().map(|&row| of(row)).collect());
        let mut column = vec![zero; size];
        for (&row, value) in rows.iter().zip(solved) {
            column[row] = value;
        }
        column
    };
    let accelerations = solve(&|row| forces[row] - bias[row]);
    graph.section("inverse of S");
    let mut inverse = zeros(graph, size);
    for (place, &j) in rows.iter().enumerate() {
        let one = graph.constant(1.0);
        let column = solve(&|row| if row == j { one } else { zero });
        // the entries further inboard take fewer operations, and the matrix is symmetric
        for &i in &rows[place..] {
            (inverse[i][j], inverse[j][i]) = (column[i], column[i]);
        }
    }
    let Found {
        by_position,
        by_velocity,
        ..
    } = way.at(&accelerations);
    graph.section("derivatives of the accelerations");
    let solved = |of: &Square<'g>| {
        let mut result = zeros(graph, size);
        for &j in rows {
            let column = solve(&|row| -of[row][j]);
            for &i in rows {
                result[i][j] = column[i];
            }
        }
        result
    };
    let multiplied = |of: &Square<'g>| {
        let mut result = zeros(graph, size);
        for &i in rows {
            for &j in rows {
                let terms = rows.iter().map(|&k| inverse[i][k] * of[k][j]);
                result[i][j] = -terms.fold(zero, |sum, term| sum + term);
            }
        }
        result
    };
    [
        AccelerationDerivatives {
            accelerations: accelerations.clone(),
            by_position: solved(&by_position),
            by_velocity: solved(&by_velocity),
            inverse: inverse.clone(),
        },
        AccelerationDerivatives {
            accelerations,
            by_position: multiplied(&by_position),
            by_velocity: multiplied(&by_velocity),
            inverse,
        },
    ]
}
