//! ∂τ/∂q and ∂τ/∂v.

use super::loads::Loads;
use super::{DerivativeInputs, Found, NotDifferentiable, Way, cost, zeros};
use crate::expression::Expr;

/// τ \[N m or N\], its derivatives, and S, at the state of the scene and the given v̇ (rad/s² or m/s², in the order of
/// v; for a free base the components of ẍ and ω̇ in absolute axes).
///
/// All matrices are of the size of v, by rows. `by_position[i][j]` is the derivative of τ_i along the motion of `v[j]`
/// (see [this folder](super)), `by_velocity[i][j]` is ∂τ_i/∂v_j with v̇ constant, `matrix` is S. Entries that vanish in
/// every state are the number 0. Each system takes the way with the fewest operations for both derivatives together:
/// [in the frames of its links](crate::dynamics::link::derivatives), or by differentiation of S and r_s.
///
/// # Errors
/// Only for systems that link frames cannot describe: if S or r_s cannot be differentiated in symbols. No model is
/// known for which this is so.
pub fn inverse_dynamics_derivatives<'g>(
    scene: &DerivativeInputs<'g, '_>,
    accelerations: &[Expr<'g>],
) -> Result<Found<'g>, NotDifferentiable> {
    let size = accelerations.len();
    let graph = scene.graph;
    let mut whole = Found {
        matrix: zeros(graph, size),
        forces: vec![graph.constant(0.0); size],
        by_position: zeros(graph, size),
        by_velocity: zeros(graph, size),
    };
    for spatial in scene.systems {
        let rows = spatial.layout.system_velocities(spatial.system);
        if rows.is_empty() {
            continue;
        }
        let ways = Way::all(scene, spatial)?.into_iter();
        let found = ways.map(|way| way.at(accelerations)).min_by_key(|found| {
            let both = found.by_position.iter().chain(&found.by_velocity);
            cost(graph, both.flatten().copied())
        });
        let Some(found) = found else { continue };
        for i in rows {
            whole.matrix[i].clone_from(&found.matrix[i]);
            whole.forces[i] = found.forces[i];
            whole.by_position[i].clone_from(&found.by_position[i]);
            whole.by_velocity[i].clone_from(&found.by_velocity[i]);
        }
    }
    // fields that only some elements feel
    let fields = Loads::of_partial_fields(scene)?;
    for i in 0..size {
        whole.forces[i] = whole.forces[i] - fields.forces[i];
        for j in 0..size {
            whole.by_position[i][j] = whole.by_position[i][j] - fields.by_position[i][j];
            whole.by_velocity[i][j] = whole.by_velocity[i][j] - fields.by_velocity[i][j];
        }
    }
    Ok(whole)
}
