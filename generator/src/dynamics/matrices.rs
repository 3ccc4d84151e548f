//! S, r_s and r_k of all systems, each in the form with the fewest operations.

use super::spatial::Spatial;
use super::{applied_forces, bias_forces, link, mass_matrix};
use crate::expression::{Expr, Graph};
use crate::force::AppliedForces;
use crate::motion::Layout;

/// S, r_s and r_k; empty where they are not derived.
#[derive(Default)]
pub struct Matrices<'g> {
    /// S, `None` where it is 0.
    pub mass: Vec<Vec<Option<Expr<'g>>>>,
    /// r_s
    pub velocity_forces: Vec<Expr<'g>>,
    /// r_k
    pub applied_forces: Vec<Expr<'g>>,
}

impl<'g> Matrices<'g> {
    /// S, r_s and r_k. If they are not `wanted` themselves, they are not brought into the cheapest form.
    pub fn of(
        graph: &'g Graph,
        layout: &Layout,
        systems: &[Spatial<'g, '_>],
        applied: &AppliedForces<'g>,
        wanted: bool,
    ) -> Self {
        let (none, size) = (graph.constant(0.0), layout.velocities.len());
        let mut matrices = Matrices {
            mass: mass_matrix::mass_matrix(systems, size),
            velocity_forces: bias_forces::velocity_forces(systems, none, size),
            applied_forces: applied_forces::applied_forces(systems, applied, none, size),
        };
        // v̇ from S is searched in frames of its own, so the search for frames of S is made only if S itself is wanted
        for spatial in with_axes(systems).filter(|_| wanted) {
            let forces = [
                &mut matrices.velocity_forces[..],
                &mut matrices.applied_forces[..],
            ];
            link::cheaper_matrices(spatial, applied, &mut matrices.mass, forces);
        }
        matrices
    }
}

/// The systems that have a joint other than a ball.
pub fn with_axes<'a, 'g, 'm>(
    systems: &'a [Spatial<'g, 'm>],
) -> impl Iterator<Item = &'a Spatial<'g, 'm>> {
    systems.iter().filter(|spatial| !spatial.has_balls_alone())
}
