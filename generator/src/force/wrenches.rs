//! The forces and moments on bodies.

use super::AppliedForces;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::model::{Body, ElementId, Model, System};
use crate::motion::Motion;
use crate::motion::numbers::{number, vector};

/// The force and the moment on one body, absolute axes.
#[derive(Clone, Copy)]
pub struct Wrench<'g> {
    /// Resultant force \[N\].
    pub force: Vec3<'g>,
    /// Resultant moment about the element's joint \[N m\].
    pub moment: Vec3<'g>,
}

impl Wrench<'_> {
    /// True if force and moment are 0.
    pub fn is_zero(&self) -> bool {
        self.force.is_zero() && self.moment.is_zero()
    }
}

/// The forces and moments on all bodies.
pub struct Wrenches<'g> {
    /// By system and element; without the fields that act on a whole system.
    pub elements: Vec<Vec<Wrench<'g>>>,
    /// By system and element: the moments that laws apply in the element's joint, on the element.
    pub in_joints: Vec<Vec<Vec<Vec3<'g>>>>,
    /// By system, element and freedom of its joint: the torques and forces that laws apply on its coordinate.
    pub on_freedoms: Vec<Vec<Vec<Expr<'g>>>>,
    /// By vehicle: forces, and moments about its origin. A vehicle's motion is prescribed, so they do not change it,
    /// but its drive works against them.
    pub vehicles: Vec<Wrench<'g>>,
    /// By system: the sum of the fields that act on all of its elements \[m/s²\].
    pub fields: Vec<Vec3<'g>>,
    /// By system and element: the sum of the other fields \[m/s²\].
    pub partial_fields: Vec<Vec<Vec3<'g>>>,
}

impl<'g> Wrenches<'g> {
    /// The wrenches of fields that only some elements feel, about the origins of the elements: their accelerations
    /// \[m/s²\] by system and element.
    pub fn of_partial_fields(
        graph: &'g Graph,
        model: &Model,
        motion: &Motion<'g>,
        fields: &[Vec<Vec3<'g>>],
    ) -> Self {
        let mut wrenches = Wrenches::none(graph, model);
        for (s, system) in model.systems.iter().enumerate() {
            for (k, element) in system.elements.iter().enumerate() {
                let force = number(graph, &element.mass) * fields[s][k];
                let offset = motion.systems[s][k].rotation;
                let offset = offset.times(vector(graph, &element.cg));
                let moment = offset.cross(force);
                wrenches.elements[s][k] = Wrench { force, moment };
            }
        }
        wrenches
    }

    /// No forces, on the bodies of a model.
    pub fn none(graph: &'g Graph, model: &Model) -> Self {
        let (zero, vector) = (graph.constant(0.0), Vec3::zero(graph));
        let none = Wrench {
            force: vector,
            moment: vector,
        };
        let systems = &model.systems;
        let freedoms = |system: &System| {
            let elements = system.elements.iter();
            elements
                .map(|e| vec![zero; e.joint.freedoms().len()])
                .collect()
        };
        Wrenches {
            elements: systems
                .iter()
                .map(|s| vec![none; s.elements.len()])
                .collect(),
            in_joints: systems
                .iter()
                .map(|s| vec![Vec::new(); s.elements.len()])
                .collect(),
            on_freedoms: systems.iter().map(freedoms).collect(),
            vehicles: vec![none; model.vehicles.len()],
            fields: vec![vector; systems.len()],
            partial_fields: systems
                .iter()
                .map(|s| vec![vector; s.elements.len()])
                .collect(),
        }
    }
}

impl<'g> AppliedForces<'g> {
    /// Applies a force at an offset from the body's joint.
    pub(crate) fn apply(&mut self, body: Body, offset: Vec3<'g>, force: Vec3<'g>) {
        if let Some(wrench) = self.on(body) {
            wrench.force = wrench.force + force;
            wrench.moment = wrench.moment + offset.cross(force);
        }
    }

    /// Applies a moment.
    pub(crate) fn turn(&mut self, body: Body, moment: Vec3<'g>) {
        if let Some(wrench) = self.on(body) {
            wrench.moment = wrench.moment + moment;
        }
    }

    /// Applies a moment in the joint of an element, and the opposite one to its carrier.
    pub(crate) fn turn_joint(&mut self, child: ElementId, carrier: Body, moment: Vec3<'g>) {
        self.turn(Body::Element(child), moment);
        self.turn(carrier, -moment);
        self.wrenches.in_joints[child.system][child.element].push(moment);
    }

    /// The wrench of a body; `None` for the absolute frame.
    pub(crate) fn on(&mut self, body: Body) -> Option<&mut Wrench<'g>> {
        match body {
            Body::Frame => None,
            Body::Element(id) => Some(&mut self.wrenches.elements[id.system][id.element]),
            Body::Vehicle(index) => Some(&mut self.wrenches.vehicles[index]),
        }
    }
}
