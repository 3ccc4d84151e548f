//! Inverse dynamics, S, and the generalised forces of fields and laws.

use super::Known;
use crate::dynamics::matrices::{Matrices, with_axes};
use crate::dynamics::outputs::ModelInMotion;
use crate::dynamics::{link, spatial};
use crate::expression::Expr;
use crate::force::{AppliedForces, Wrenches};

/// S a − r_s − r_g, by the recursive Newton–Euler algorithm in the axes with the fewest operations.
pub fn inverse_dynamics<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let (graph, fields) = (known.scene.graph, fields(known.scene));
    let mut forces = vec![graph.constant(0.0); known.size()];
    for spatial in known.systems {
        spatial::inverse_dynamics(spatial, &fields, &known.given, &mut forces);
    }
    for spatial in with_axes(known.systems) {
        link::cheaper_inverse_dynamics(spatial, &fields, &known.given, &mut forces);
    }
    forces
}

pub fn mass_matrix<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let zero = known.scene.graph.constant(0.0);
    let entries = known.matrices().mass.iter().flatten();
    entries.map(|entry| entry.unwrap_or(zero)).collect()
}

pub fn bias<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let forces = known.matrices().velocity_forces.iter();
    forces.map(|force| -*force).collect()
}

pub fn gravity_forces<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let ModelInMotion { graph, layout, .. } = *known.scene;
    let fields = fields(known.scene);
    Matrices::of(graph, layout, known.systems, &fields, true).applied_forces
}

pub fn applied_forces<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    known.matrices().applied_forces.clone()
}

/// The fields of a scene without its other forces.
fn fields<'g>(scene: &ModelInMotion<'g, '_>) -> AppliedForces<'g> {
    let ModelInMotion { graph, model, .. } = *scene;
    let given = &scene.applied.wrenches;
    let partial = &given.partial_fields;
    let wrenches = Wrenches {
        fields: given.fields.clone(),
        partial_fields: partial.clone(),
        ..Wrenches::of_partial_fields(graph, model, scene.motion, partial)
    };
    AppliedForces::of_wrenches(model, wrenches)
}
