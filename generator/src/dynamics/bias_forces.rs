//! The bias forces with the sign reversed, r_s in the paper: minus the forces that the bodies need when v̇ = 0 and no
//! force acts. They follow from Newton's and Euler's equations of the augmented bodies, for trees of ball joints.
//!
//! r_x = −G_root,   r_k = −E_kᵀ (A J Aᵀ ε + ω × A J Aᵀ ω + Σ_c u_c × G_c + w_k × B_k)   \[MADYMO 1980\]
//!
//! | pass | |
//! |---|---|
//! | root to leaves: acceleration of the joints for v̇ = 0 | B_c = B + γ(u_c) |
//! | leaves to root: inertia force of the bodies outboard | G = γ(w) + Σ_c G_c |
//!
//! Systems with other joints get r_s from the [recursive Newton–Euler algorithm](super::spatial).

use super::spatial::{self, Spatial};
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::model::ElementId;
use crate::motion::kinematics::path;

/// r_s, by row.
pub fn velocity_forces<'g>(
    systems: &[Spatial<'g, '_>],
    zero: Expr<'g>,
    size: usize,
) -> Vec<Expr<'g>> {
    let mut forces = vec![zero; size];
    for spatial in systems {
        match spatial.has_balls_alone() {
            true => of_balls(spatial, &mut forces),
            false => spatial::velocity_forces(spatial, &mut forces),
        }
    }
    forces
}

/// Sets the rows of a system whose joints are all balls.
fn of_balls<'g>(spatial: &Spatial<'g, '_>, forces: &mut [Expr<'g>]) {
    let Spatial {
        graph,
        model,
        layout,
        system: s,
        motion,
        tree,
    } = *spatial;
    let system = spatial.of_system();
    let count = system.elements.len();
    let none = Vec3::zero(graph);

    // from the root outwards: the acceleration of the joints
    let mut joint_acceleration = vec![none; count];
    for (k, element) in system.elements.iter().enumerate() {
        if let Some(parent) = element.parent {
            graph.section(format!(
                "r_s: joint of {}",
                path(
                    model,
                    ElementId {
                        system: s,
                        element: k
                    }
                )
            ));
            let offset = motion.systems[s][k].offset;
            joint_acceleration[k] =
                joint_acceleration[parent] + motion.systems[s][parent].gamma(offset);
        }
    }

    // from the leaves inwards: the inertia forces of the bodies outboard, and their moments
    let mut outboard = vec![none; count];
    for k in (0..count).rev() {
        let id = ElementId {
            system: s,
            element: k,
        };
        let (element, body) = (motion.element(id), &tree.bodies[k]);
        graph.section(format!("r_s[{}]", path(model, id)));
        let mut moment = body.inertia.times(element.bias)
            + body.gyroscopic_moment(graph, element.omega)
            + body.first_moment.cross(joint_acceleration[k]);
        outboard[k] = element.gamma(body.first_moment);
        for &c in &tree.children[k] {
            moment = moment + motion.systems[s][c].offset.cross(outboard[c]);
            outboard[k] = outboard[k] + outboard[c];
        }
        for (row, axis) in layout.element_velocities(id).zip(&element.axes) {
            forces[row] = -axis.dot(moment);
        }
    }
    if let Some(x) = layout.reference_velocities(s) {
        graph.section(format!("r_s[{}.x]", system.name));
        for (row, &direction) in x.zip(layout.directions) {
            forces[row] = -outboard[0].0[direction];
        }
    }
}
