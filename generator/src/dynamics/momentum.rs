//! The momentum balance: ṗ = Σ F and L̇ = Σ (r × F + M), for all systems together whose reference joint is free.
//!
//! p = Σ m v is their linear momentum, and L = Σ (r × m v + I ω) their angular momentum about the origin of the
//! absolute frame, with the velocities v of the centres of gravity at r. F are the forces of laws and fields on their
//! elements, at r, and M moments. A force between two of their elements counts on both and cancels. Systems that are
//! held or moved, vehicles and the absolute frame are outside.

use super::outputs::ModelInMotion;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, sum};
use crate::model::{Component, ElementId, Projection, Reference, SystemQuantity};
use crate::motion::numbers::{number, vector};

/// The systems whose reference joint is free and whose root turns freely.
fn free(scene: &ModelInMotion<'_, '_>) -> Vec<usize> {
    let systems = scene.model.systems.iter().enumerate();
    systems
        .filter(|(_, system)| {
            // a root whose joint does not let it turn freely is held by the frame
            let held = system.elements[0].joint.turns_with_carrier();
            matches!(system.reference, Reference::Free) && !held
        })
        .map(|(s, _)| s)
        .collect()
}

/// p \[N s\] and L \[N m s\], in absolute axes; empty if no system is free.
pub fn momentum<'g>(scene: &ModelInMotion<'g, '_>) -> Vec<Expr<'g>> {
    let free = free(scene);
    if free.is_empty() {
        return Vec::new();
    }
    scene.graph.section("momentum");
    let of = |what, component| {
        let systems = free.iter().map(|&s| scene.system(s, what, component));
        sum(scene.graph, systems)
    };
    let components = [Component::X, Component::Y, Component::Z];
    [SystemQuantity::Momentum, SystemQuantity::AngularMomentum]
        .into_iter()
        .flat_map(|what| components.map(|component| of(what, Projection::absolute(component))))
        .collect()
}

/// Σ F \[N\] and Σ (r × F + M) \[N m\], the rates of [`momentum`]; empty if no system is free.
pub fn external_wrench<'g>(scene: &ModelInMotion<'g, '_>) -> Vec<Expr<'g>> {
    let free = free(scene);
    if free.is_empty() {
        return Vec::new();
    }
    let graph = scene.graph;
    graph.section("external_wrench");
    let (mut force, mut moment) = (Vec3::zero(graph), Vec3::zero(graph));
    for s in free {
        // laws act by their resultants at the joints; a field of the whole system acts on all centres of gravity at
        // once
        let field = scene.applied.wrenches.fields[s];
        let (mut mass, mut first_moment) = (graph.constant(0.0), Vec3::zero(graph));
        for (k, element) in scene.model.systems[s].elements.iter().enumerate() {
            let motion = scene.motion.element(ElementId {
                system: s,
                element: k,
            });
            let load = &scene.applied.wrenches.elements[s][k];
            force = force + load.force;
            moment = moment + load.moment + motion.position.cross(load.force);
            let own = number(graph, &element.mass);
            let centre = motion.position + motion.rotation.times(vector(graph, &element.cg));
            (mass, first_moment) = (mass + own, first_moment + own * centre);
        }
        force = force + mass * field;
        moment = moment + first_moment.cross(field);
    }
    force.0.into_iter().chain(moment.0).collect()
}
