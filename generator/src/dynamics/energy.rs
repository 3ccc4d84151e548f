//! The energy balance: dT/dt = Σ P, where T is the kinetic energy of all elements and P the power of each effect.
//!
//! A force between two bodies has the power F·(velocity of one point minus that of the other), so the power of a
//! contact or a belt does not depend on the observer. A field has the power Σ m a·v over the elements on which it acts.
//! A prescribed reference joint exerts R = Σ m p̈ − Σ F, the force that the elements of its system need in addition to
//! the forces on them, with the power R·ẋ. If a vehicle turns a root that is not on a ball joint, the power M·ω is
//! added, where M is the moment that the root's joint transmits. The drive of a vehicle overcomes the forces F on it
//! and their moment M about its origin, with the power −F·ẋ − M·ω.

use super::outputs::ModelInMotion;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, sum};
use crate::force::Product;
use crate::model::{Component, ElementId, Projection, Reference, SystemQuantity};
use crate::motion::numbers::{number, vector};

/// The kinetic energy T \[J\].
pub fn kinetic_energy<'g>(scene: &ModelInMotion<'g, '_>) -> Expr<'g> {
    scene.graph.section("kinetic energy");
    let systems = 0..scene.model.systems.len();
    let size = Projection::absolute(Component::Resultant);
    let of = |s| scene.system(s, SystemQuantity::KineticEnergy, size);
    sum(scene.graph, systems.map(of))
}

/// The power M·ω of a turning vehicle on a root that turns with it; M is the moment about the reference joint.
fn turning_power<'g>(
    scene: &ModelInMotion<'g, '_>,
    system: usize,
    vehicle: usize,
    reaction: Vec3<'g>,
) -> Expr<'g> {
    let root = ElementId { system, element: 0 };
    let motion = scene.motion.element(root);
    let omega = scene.motion.vehicles[vehicle].body.omega;
    if !motion.turns_with_carrier || omega.is_zero() {
        return scene.graph.constant(0.0);
    }
    let moment = scene.joint_moment(root) + motion.offset.cross(reaction);
    moment.dot(omega)
}

/// The name and the power P of each effect \[W\], in the order of the model's forces; prescribed motions come last.
pub fn powers<'g>(scene: &ModelInMotion<'g, '_>) -> Vec<(String, Expr<'g>)> {
    let graph = scene.graph;
    let mut powers: Vec<(String, Expr<'g>)> = Vec::new();
    for work in &scene.applied.works {
        graph.section(format!("power of {}", work.name));
        let power = sum(
            graph,
            work.products.iter().map(|product| match *product {
                Product::Scalars(a, b) => a * b,
                Product::Vectors(a, b) => a.dot(b),
                Product::Field(acceleration, id) => {
                    let element = &scene.model.systems[id.system].elements[id.element];
                    let motion = scene.motion.element(id);
                    let offset = motion.rotation.times(vector(graph, &element.cg));
                    let mass = number(graph, &element.mass);
                    mass * acceleration.dot(motion.velocity_at(offset))
                }
            }),
        );
        powers.push((work.name.clone(), power));
    }
    for (s, system) in scene.model.systems.iter().enumerate() {
        if matches!(system.reference, Reference::Free | Reference::Fixed) {
            continue;
        }
        let name = format!("system {}: prescribed motion", system.name);
        graph.section(format!("power of {name}"));
        let mut reaction = Vec3::zero(graph);
        for (k, element) in system.elements.iter().enumerate() {
            let id = ElementId {
                system: s,
                element: k,
            };
            let motion = scene.motion.element(id);
            let offset = motion.rotation.times(vector(graph, &element.cg));
            let acceleration = scene.acceleration(id, offset) - scene.applied.wrenches.fields[s];
            let force = number(graph, &element.mass) * acceleration;
            reaction = reaction + force - scene.applied.wrenches.elements[s][k].force;
        }
        let mut power = reaction.dot(scene.motion.references[s]);
        if let Reference::Riding { vehicle, .. } = system.reference {
            power = power + turning_power(scene, s, vehicle, reaction);
        }
        powers.push((name, power));
    }
    let vehicles = scene
        .model
        .vehicles
        .iter()
        .zip(&scene.applied.wrenches.vehicles);
    for ((vehicle, load), motion) in vehicles.zip(&scene.motion.vehicles) {
        let name = format!("vehicle {}: prescribed motion", vehicle.name);
        graph.section(format!("power of {name}"));
        let body = &motion.body;
        let power = -(load.force.dot(body.velocity) + load.moment.dot(body.omega));
        if !power.is_zero() {
            powers.push((name, power));
        }
    }
    powers
}
