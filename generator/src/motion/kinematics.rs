//! Forward kinematics: position, orientation and velocity of every element, from the root of each tree to its leaves.
//!
//! p_c = p + u_c,   ṗ_c = ṗ + ω × u_c,   γ(v) = ω × (ω × v) + ε × v
//!
//! u_c = A s_c is the position of the joint of child c on a ball joint. ε is the part of the angular acceleration that
//! remains when v̇ = 0. The motion of an element by its own joint is in the files `ball`;
//! `twist` for joints with coordinates of their own; `free` and `prescribed` for reference joints.

use super::element::ElementMotion;
use super::layout::{Layout, State};
use super::numbers::time;
use super::numbers::{bryant, vector};
use super::vehicle::{self, VehicleMotion};
use super::{ball, free, prescribed_joint, twist};
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::{Attachment, Body, Element, ElementId, Model, Number, Reference, System};
use crate::model::{Freedom, Joint};

/// Motion of all elements.
pub struct Motion<'g> {
    /// For each system, the motion of each element.
    pub systems: Vec<Vec<ElementMotion<'g>>>,
    /// For each system, the velocity of its reference joint.
    pub references: Vec<Vec3<'g>>,
    /// For each vehicle, its motion.
    pub vehicles: Vec<VehicleMotion<'g>>,
    frame: ElementMotion<'g>,
}

impl<'g> Motion<'g> {
    /// The motion as a function of the inputs t, q, v.
    pub fn of(graph: &'g Graph, model: &Model, layout: &Layout, state: &State<'g>) -> Self {
        Self::new(graph, model, layout, state, Some(time(graph)))
    }

    /// The motion at the start of a run, where q and v depend on parameters.
    pub fn at_start(graph: &'g Graph, model: &Model, layout: &Layout, start: &State<'g>) -> Self {
        Self::new(graph, model, layout, start, None)
    }

    fn new(
        graph: &'g Graph,
        model: &Model,
        layout: &Layout,
        state: &State<'g>,
        time: Option<Expr<'g>>,
    ) -> Self {
        let label = |text: String| {
            if time.is_some() {
                graph.section(text);
            }
        };
        let vehicles: Vec<VehicleMotion<'g>> = model
            .vehicles
            .iter()
            .map(|vehicle| {
                label(format!("vehicle {}", vehicle.name));
                vehicle::motion(graph, vehicle, time)
            })
            .collect();
        let frame = ElementMotion::frame(graph);
        let (mut systems, mut references) = (Vec::new(), Vec::new());
        for (s, system) in model.systems.iter().enumerate() {
            label(format!("system {}: reference joint", system.name));
            let (position, velocity) = match (
                layout.reference_coordinates(s),
                layout.reference_velocities(s),
            ) {
                (Some(at), Some(rate)) => (
                    free::vector(graph, layout.directions, &state.q[at]),
                    free::vector(graph, layout.directions, &state.v[rate]),
                ),
                _ => prescribed_joint::motion(graph, system, &vehicles, time),
            };
            let turned = match system.reference {
                Reference::Riding { vehicle, .. } => &vehicles[vehicle].body,
                _ => &frame,
            };
            let tree = Tree {
                graph,
                model,
                layout,
                state,
                named: time.is_some(),
                reference: ElementMotion {
                    position,
                    velocity,
                    ..turned.clone()
                },
            };
            systems.push(tree.motions(s));
            references.push(velocity);
        }
        Motion {
            systems,
            references,
            vehicles,
            frame,
        }
    }

    /// The motion of an element.
    pub fn element(&self, id: ElementId) -> &ElementMotion<'g> {
        &self.systems[id.system][id.element]
    }

    /// The motion of a body: an element, a vehicle, or the absolute frame at rest.
    pub fn body(&self, body: Body) -> &ElementMotion<'g> {
        match body {
            Body::Frame => &self.frame,
            Body::Element(id) => self.element(id),
            Body::Vehicle(index) => &self.vehicles[index].body,
        }
    }

    /// A point at which forces attach: its offset from the body's joint, its position and its velocity, in absolute
    /// axes.
    pub fn attachment(&self, graph: &'g Graph, attachment: &Attachment) -> Point<'g> {
        let body = self.body(attachment.on);
        let offset = body.rotation.times(vector(graph, &attachment.at));
        Point {
            offset,
            position: body.position + offset,
            velocity: body.velocity_at(offset),
        }
    }
}

/// A system while its motion is derived.
struct Tree<'a, 'g> {
    graph: &'g Graph,
    model: &'a Model,
    layout: &'a Layout,
    state: &'a State<'g>,
    /// Whether expressions get names, for the reader.
    named: bool,
    /// The carrier of the root: the absolute frame or a vehicle, with its origin in the reference joint.
    reference: ElementMotion<'g>,
}

impl<'g> Tree<'_, 'g> {
    /// The motion of each element, from the root to the leaves.
    fn motions(&self, system: usize) -> Vec<ElementMotion<'g>> {
        let mut motions: Vec<ElementMotion<'g>> = Vec::new();
        for (element, of) in self.model.systems[system].elements.iter().enumerate() {
            let id = ElementId { system, element };
            let parent = of.parent.map(|parent| &motions[parent]);
            motions.push(match &of.joint {
                Joint::Ball => self.on_ball(id, of, parent),
                Joint::Freedoms(freedoms) => self.on_freedoms(id, of, freedoms, parent),
            });
        }
        motions
    }

    fn on_ball(
        &self,
        id: ElementId,
        element: &Element,
        parent: Option<&ElementMotion<'g>>,
    ) -> ElementMotion<'g> {
        let (layout, state) = (self.layout, self.state);
        let q = &state.q[layout.element_coordinates(id)];
        let v = &state.v[layout.element_velocities(id)];
        let chart = layout.element_chart(id).map(|i| state.charts[i]);
        self.section(id, "orientation");
        let mut motion = ball::motion(self.graph, layout.orientation, q, v, chart);
        self.name_rotation(id, &motion);
        self.section(id, "joint");
        match parent {
            None => {
                motion.position = self.reference.position;
                motion.velocity = self.reference.velocity;
            }
            Some(parent) => {
                motion.offset = parent.rotation.times(vector(self.graph, &element.at));
                motion.position = parent.position + motion.offset;
                motion.velocity = parent.velocity_at(motion.offset);
            }
        }
        if self.named {
            let name = identifier(self.model, id);
            motion.offset.named(&format!("u_{name}"));
        }
        motion
    }

    fn on_freedoms(
        &self,
        id: ElementId,
        element: &Element,
        freedoms: &[Freedom],
        parent: Option<&ElementMotion<'g>>,
    ) -> ElementMotion<'g> {
        self.section(id, "joint");
        let state = self.state;
        let shares = self.layout.shares(self.graph, self.model, id).into_iter();
        let (q, v): (Vec<Expr<'g>>, Vec<Expr<'g>>) = shares
            .map(|share| {
                let q = share.ratio * state.q[share.coordinate] + share.offset;
                (q, share.ratio * state.v[share.velocity])
            })
            .unzip();
        let carrier = parent.unwrap_or(&self.reference);
        let at = vector(self.graph, &element.at);
        let motion = twist::motion(self.graph, freedoms, carrier, at, &q, &v);
        self.name_rotation(id, &motion);
        motion
    }

    fn section(&self, id: ElementId, part: &str) {
        if self.named {
            let path = path(self.model, id);
            self.graph.section(format!("element {path}: {part}"));
        }
    }

    /// Names the rotation of an element for the reader.
    fn name_rotation(&self, id: ElementId, motion: &ElementMotion<'g>) {
        if !self.named {
            return;
        }
        let name = identifier(self.model, id);
        for (row, i) in motion.rotation.0.iter().zip(["x", "y", "z"]) {
            for (entry, j) in row.iter().zip(["x", "y", "z"]) {
                self.graph.name(*entry, format!("rot_{name}_{i}{j}"));
            }
        }
    }
}

/// A point of a body, in absolute axes.
#[derive(Clone, Copy)]
pub struct Point<'g> {
    /// Offset from the body's joint \[m\].
    pub offset: Vec3<'g>,
    /// Position \[m\].
    pub position: Vec3<'g>,
    /// Velocity \[m/s\].
    pub velocity: Vec3<'g>,
}

/// Acceleration of the reference joint of a system, unless it is free.
pub fn reference_acceleration<'g>(
    graph: &'g Graph,
    system: &System,
    motion: &Motion<'g>,
) -> Vec3<'g> {
    prescribed_joint::acceleration(graph, system, &motion.vehicles)
}

/// "head"; if there are several systems, with the name of the system before it.
pub fn path(model: &Model, id: ElementId) -> String {
    let system = &model.systems[id.system];
    let element = &system.elements[id.element].name;
    if model.systems.len() > 1 {
        format!("{}/{element}", system.name)
    } else {
        element.clone()
    }
}

/// The path as part of a Rust identifier.
pub fn identifier(model: &Model, id: ElementId) -> String {
    path(model, id).replace(['/', '-'], "_")
}

/// The constant rotation of a frame of principal axes relative to the frame of the element.
pub fn constant_rotation<'g>(graph: &'g Graph, axes: &[Number; 3]) -> Mat3<'g> {
    bryant(graph, vector(graph, axes).0).0
}

/// The children of every element of a system.
pub fn children(elements: &[Element]) -> Vec<Vec<usize>> {
    let mut children = vec![Vec::new(); elements.len()];
    for (k, element) in elements.iter().enumerate() {
        if let Some(parent) = element.parent {
            children[parent].push(k);
        }
    }
    children
}
