//! Generalised forces by the recursive Newton–Euler algorithm. From the leaves to the root, every element passes on the
//! wrench that it and the elements that it carries need, and each velocity takes the power of that wrench.

use super::{Spatial, Wrench};
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::force::AppliedForces;
use crate::motion::kinematics::reference_acceleration;

/// Sets the rows of r_s of the system: minus the forces that the bodies need when v̇ = 0 and no force acts.
pub fn velocity_forces<'g>(spatial: &Spatial<'g, '_>, forces: &mut [Expr<'g>]) {
    let bodies = spatial.bodies();
    let biases = spatial.origin_biases(Vec3::zero(spatial.graph));
    let needed = (bodies.iter().zip(biases).enumerate())
        .map(|(k, (body, acceleration))| {
            spatial.graph.section(format!("r_s[{}]", spatial.label(k)));
            spatial.inertia(k, body, acceleration)
        })
        .collect();
    for (row, power) in powers(spatial, needed, "r_s") {
        forces[row] = forces[row] - power;
    }
}

/// Sets the rows of r_k of the system: the applied forces, minus the inertia against a given acceleration of the
/// reference joint.
pub fn applied_forces<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    forces: &mut [Expr<'g>],
) {
    let graph = spatial.graph;
    let reference = reference_acceleration(graph, spatial.of_system(), spatial.motion);
    let field = applied.wrenches.fields[spatial.system] - reference;
    let bodies = spatial.bodies();
    let acting = (bodies.iter().enumerate())
        .map(|(k, body)| {
            graph.section(format!("r_k[{}]", spatial.label(k)));
            let load = &applied.wrenches.elements[spatial.system][k];
            Wrench {
                force: load.force + body.mass * field,
                moment: load.moment + body.first_moment.cross(field),
            }
        })
        .collect();
    for (row, power) in powers(spatial, acting, "r_k") {
        forces[row] = forces[row] + power;
    }
    for k in 0..spatial.of_system().elements.len() {
        let shares = spatial.layout.shares(graph, spatial.model, spatial.id(k));
        for (share, force) in shares
            .iter()
            .zip(&applied.wrenches.on_freedoms[spatial.system][k])
        {
            forces[share.velocity] = forces[share.velocity] + share.ratio * *force;
        }
    }
}

/// Sets the rows of the forces that the system needs for these v̇, beyond those in `applied`, of which only wrenches
/// and fields count.
pub fn inverse_dynamics<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    accelerations: &[Expr<'g>],
    forces: &mut [Expr<'g>],
) {
    let graph = spatial.graph;
    let mut reference = reference_acceleration(graph, spatial.of_system(), spatial.motion);
    if let Some(rows) = spatial.layout.reference_velocities(spatial.system) {
        for (row, &direction) in rows.zip(spatial.layout.directions) {
            reference.0[direction] = reference.0[direction] + accelerations[row];
        }
    }
    let field = applied.wrenches.fields[spatial.system];
    let biases = spatial.origin_biases(reference - field);
    let none = Vec3::zero(graph);
    // the contributions of v̇ to the accelerations of each element
    let (mut turns, mut slides): (Vec<Vec3<'g>>, Vec<Vec3<'g>>) = (Vec::new(), Vec::new());
    let mut needed = Vec::new();
    for (k, (body, bias)) in spatial.bodies().iter().zip(biases).enumerate() {
        graph.section(format!("inverse dynamics of {}", spatial.label(k)));
        let motion = spatial.motion_of(k);
        let (mut turn, mut slide) = (none, none);
        if let Some(parent) = spatial.of_system().elements[k].parent {
            slide = slides[parent] + turns[parent].cross(motion.offset);
            if motion.turns_with_carrier {
                turn = turns[parent];
            }
        }
        for column in spatial.columns(k) {
            let given = accelerations[column.row];
            turn = turn + given * column.axis;
            slide = slide + given * column.slide;
            forces[column.row] = forces[column.row] + column.armature * given;
        }
        let wrench = spatial.inertia(k, body, bias + slide);
        let load = &applied.wrenches.elements[spatial.system][k];
        needed.push(Wrench {
            force: wrench.force + turn.cross(body.first_moment) - load.force,
            moment: wrench.moment + body.inertia.times(turn) - load.moment,
        });
        turns.push(turn);
        slides.push(slide);
    }
    for (row, power) in powers(spatial, needed, "inverse dynamics") {
        forces[row] = forces[row] + power;
    }
}

/// The power of a wrench on each element per velocity, by row: the sum over all elements that the velocity moves.
fn powers<'g>(
    spatial: &Spatial<'g, '_>,
    mut wrenches: Vec<Wrench<'g>>,
    what: &str,
) -> Vec<(usize, Expr<'g>)> {
    let mut powers = Vec::new();
    let elements = &spatial.of_system().elements;
    for k in (0..elements.len()).rev() {
        spatial
            .graph
            .section(format!("{what}[{}]", spatial.label(k)));
        let wrench = wrenches[k];
        for column in spatial.columns(k) {
            powers.push((column.row, column.power(&wrench)));
        }
        if let Some(parent) = elements[k].parent {
            let passed = wrench.on_carrier(spatial.motion_of(k));
            wrenches[parent] = wrenches[parent].plus(passed);
        }
    }
    if let Some(rows) = spatial.layout.reference_velocities(spatial.system) {
        for (row, &direction) in rows.zip(spatial.layout.directions) {
            powers.push((row, wrenches[0].force.0[direction]));
        }
    }
    powers
}
