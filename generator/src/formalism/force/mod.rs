//! The force interactions of a scene, as forces and moments on its elements.
//!
//! One file per law; each adds to the [`Load`] of the elements that it touches and leaves its [`Measures`] for the outputs.

mod belt;
mod contact;
mod field;
mod joint;
mod load;

use super::kinematics::{ElementMotion, Motion};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::formalism::numbers::{curve, number};
use crate::formalism::time;
use crate::model::{Body, FieldComponent, ForceKind, Model};

/// What acts on one element, absolute axes.
#[derive(Clone, Copy)]
pub struct Load<'g> {
    /// Resultant force \[N\].
    pub force: Vec3<'g>,
    /// Resultant moment about the element's joint \[N m\].
    pub moment: Vec3<'g>,
}

/// Everything that acts.
pub struct Loads<'g> {
    /// By system and element; without the fields common to a whole system.
    pub elements: Vec<Vec<Load<'g>>>,
    /// By system: the sum of the fields that act on all of its elements \[m/s²\].
    pub fields: Vec<Vec3<'g>>,
    /// By system and element: the sum of the other fields \[m/s²\].
    pub partial_fields: Vec<Vec<Vec3<'g>>>,
    /// By force of the model.
    pub measures: Vec<Measures<'g>>,
}

/// What can be asked of a force.
pub enum Measures<'g> {
    /// A field or a given load: nothing.
    None,
    /// A joint: per relative rotation, where a law acts about it.
    Joint([Option<JointMeasures<'g>>; 3]),
    /// A contact.
    Contact(ContactMeasures<'g>),
    /// A belt.
    Belt(BeltMeasures<'g>),
}

/// Of a joint about one relative rotation.
#[derive(Clone, Copy)]
pub struct JointMeasures<'g> {
    /// Generalised torque on the child \[N m\].
    pub torque: Expr<'g>,
    /// Relative angle \[rad\].
    pub angle: Expr<'g>,
    /// Its rate \[rad/s\].
    pub rate: Expr<'g>,
}

/// Of a contact.
#[derive(Clone, Copy)]
pub struct ContactMeasures<'g> {
    /// Normal force \[N\].
    pub normal: Expr<'g>,
    /// Magnitude of the friction force \[N\]; signed in the plane.
    pub friction: Expr<'g>,
    /// Penetration \[m\].
    pub penetration: Expr<'g>,
}

/// Of a belt.
#[derive(Clone, Copy)]
pub struct BeltMeasures<'g> {
    /// Tension \[N\].
    pub tension: Expr<'g>,
    /// Distance of the attachments \[m\].
    pub length: Expr<'g>,
    /// Relative elongation.
    pub elongation: Expr<'g>,
}

impl<'g> Loads<'g> {
    /// Applies a force at an offset from the body's joint.
    fn apply(&mut self, body: Body, offset: Vec3<'g>, force: Vec3<'g>) {
        if let Body::Element(id) = body {
            let load = &mut self.elements[id.system][id.element];
            load.force = load.force + force;
            load.moment = load.moment + offset.cross(force);
        }
    }

    /// Applies a moment.
    fn turn(&mut self, body: Body, moment: Vec3<'g>) {
        if let Body::Element(id) = body {
            let load = &mut self.elements[id.system][id.element];
            load.moment = load.moment + moment;
        }
    }
}

/// The loads of a model in motion; `start` is its motion where a run starts, from which belts take their length.
pub fn loads<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    start: &Motion<'g>,
) -> Loads<'g> {
    let none = Load {
        force: Vec3::zero(graph),
        moment: Vec3::zero(graph),
    };
    let mut loads = Loads {
        elements: model
            .systems
            .iter()
            .map(|s| vec![none; s.elements.len()])
            .collect(),
        fields: vec![Vec3::zero(graph); model.systems.len()],
        partial_fields: model
            .systems
            .iter()
            .map(|s| vec![Vec3::zero(graph); s.elements.len()])
            .collect(),
        measures: Vec::new(),
    };
    for force in &model.forces {
        let measures = match &force.kind {
            ForceKind::Field { on, acceleration } => {
                graph.section(format!("field {}", force.name));
                field::apply(graph, model, motion, &mut loads, on, acceleration);
                Measures::None
            }
            ForceKind::Joint { child, about } => {
                graph.section(format!("joint {}", force.name));
                Measures::Joint(joint::apply(
                    graph, model, motion, &mut loads, *child, about,
                ))
            }
            ForceKind::Contact(contact) => {
                graph.section(format!("contact {}", force.name));
                Measures::Contact(contact::apply(
                    graph,
                    model.dimension,
                    motion,
                    &mut loads,
                    contact,
                ))
            }
            ForceKind::Load(given) => {
                graph.section(format!("load {}", force.name));
                load::apply(graph, motion, &mut loads, given);
                Measures::None
            }
            ForceKind::Belt(belt) => {
                graph.section(format!("belt {}", force.name));
                Measures::Belt(belt::apply(graph, motion, start, &mut loads, belt))
            }
        };
        loads.measures.push(measures);
    }
    loads
}

/// Three components, each constant or a curve of time.
fn components<'g>(graph: &'g Graph, components: &[FieldComponent; 3]) -> Vec3<'g> {
    Vec3(std::array::from_fn(|i| match &components[i] {
        FieldComponent::Constant(value) => number(graph, value),
        FieldComponent::Curve(scaled) => curve(graph, scaled, time(graph)),
    }))
}

/// Offset of a point from the joint of a body, and the velocity of the body's material there.
fn point_on<'g>(body: &ElementMotion<'g>, position: Vec3<'g>) -> (Vec3<'g>, Vec3<'g>) {
    let offset = position - body.position;
    (offset, body.velocity_at(offset))
}
