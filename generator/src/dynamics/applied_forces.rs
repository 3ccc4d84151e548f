//! The generalised applied forces, r_k in the paper, by virtual power, for trees of ball joints:
//!
//! r_x = F_out,root,   r_k = E_kᵀ (τ_k + Σ_c u_c × F_out,c)
//!
//! F_out = F + Σ_c F_out,c is summed from the leaves to the root. τ_k is the moment about joint k of the forces that
//! act on element k. A field a that is common to a whole system needs no sum: it acts as M a on the reference joint,
//! and as w_k × a on element k. A given acceleration of the reference joint acts as a field with the opposite sign.
//!
//! Systems with other joints get r_k from the [power of wrenches](super::spatial).

use super::spatial::{self, Spatial};
use crate::expression::Expr;
use crate::force::AppliedForces;
use crate::model::ElementId;
use crate::motion::kinematics::{path, reference_acceleration};

/// r_k, by row.
pub fn applied_forces<'g>(
    systems: &[Spatial<'g, '_>],
    applied: &AppliedForces<'g>,
    zero: Expr<'g>,
    size: usize,
) -> Vec<Expr<'g>> {
    let mut forces = vec![zero; size];
    for spatial in systems {
        match spatial.has_balls_alone() {
            true => of_balls(spatial, applied, &mut forces),
            false => spatial::applied_forces(spatial, applied, &mut forces),
        }
    }
    forces
}

/// Sets the rows of a system whose joints are all balls.
fn of_balls<'g>(spatial: &Spatial<'g, '_>, applied: &AppliedForces<'g>, forces: &mut [Expr<'g>]) {
    let Spatial {
        graph,
        model,
        layout,
        system: s,
        motion,
        tree,
    } = *spatial;
    let system = spatial.of_system();
    let field = applied.wrenches.fields[s] - reference_acceleration(graph, system, motion);
    let mut outboard: Vec<_> = applied.wrenches.elements[s]
        .iter()
        .map(|load| load.force)
        .collect();
    for k in (0..system.elements.len()).rev() {
        let id = ElementId {
            system: s,
            element: k,
        };
        graph.section(format!("r_k[{}]", path(model, id)));
        let mut moment =
            applied.wrenches.elements[s][k].moment + tree.bodies[k].first_moment.cross(field);
        for &c in &tree.children[k] {
            moment = moment + motion.systems[s][c].offset.cross(outboard[c]);
            outboard[k] = outboard[k] + outboard[c];
        }
        for (row, axis) in layout.element_velocities(id).zip(&motion.element(id).axes) {
            forces[row] = axis.dot(moment);
        }
    }
    if let Some(x) = layout.reference_velocities(s) {
        graph.section(format!("r_k[{}.x]", system.name));
        let force = outboard[0] + tree.bodies[0].mass * field;
        for (row, &direction) in x.zip(layout.directions) {
            forces[row] = force.0[direction];
        }
    }
}
