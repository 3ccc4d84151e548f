//! Where every element is, how it is turned, and how fast.
//!
//! p_c = p + u_c,   ṗ_c = ṗ + ω × u_c,   γ(v) = ω × (ω × v) + ε × v
//!
//! with u_c = A s_c the joint of child c on a ball, and ε = Σ ė_j v_j the part of the angular acceleration that is there when v̇ = 0.
//! What other joints do is in [`joint::twist`](crate::joint::twist).

use super::chart;
use super::layout::{Layout, Orientation};
use super::numbers::{bryant, rotation_of_quaternion, vector};
use super::vehicle::{self, VehicleMotion};
use super::{time, translation};
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph, Symbol};
use crate::joint::twist;
use crate::model::{Attachment, Body, Element, ElementId, Joint, Model, Number, Reference, System};

/// q and v as expressions.
pub struct State<'g> {
    /// q
    pub q: Vec<Expr<'g>>,
    /// v
    pub v: Vec<Expr<'g>>,
    /// The chart of each element's Bryant angles, the first of m; none in other coordinates.
    pub charts: Vec<Expr<'g>>,
}

impl<'g> State<'g> {
    /// The inputs of the equations.
    pub fn symbols(graph: &'g Graph, layout: &Layout) -> Self {
        State {
            q: (0..layout.coordinates.len())
                .map(|i| graph.symbol(Symbol::Coordinate(i as u32)))
                .collect(),
            v: (0..layout.velocities.len())
                .map(|i| graph.symbol(Symbol::Velocity(i as u32)))
                .collect(),
            charts: (0..layout.charts())
                .map(|i| graph.symbol(Symbol::Memory(i as u32)))
                .collect(),
        }
    }

    /// The inputs of the equations with all Bryant angles in chart 0.
    pub fn in_first_chart(graph: &'g Graph, layout: &Layout) -> Self {
        State {
            charts: vec![graph.constant(0.0); layout.charts()],
            ..State::symbols(graph, layout)
        }
    }
}

/// Motion of one element, absolute axes.
#[derive(Clone)]
pub struct ElementMotion<'g> {
    /// A, local frame → absolute frame.
    pub rotation: Mat3<'g>,
    /// φ in the plane, 0 in space \[rad\].
    pub angle: Expr<'g>,
    /// Axes e_j, by which its velocities v_j turn it: ω = Σ e_j v_j on a ball joint, else that and ω of the carrier.
    pub axes: Vec<Vec3<'g>>,
    /// s_j, by which its velocities v_j move its origin against the carrier; none on a ball joint.
    pub slides: Vec<Vec3<'g>>,
    /// q and q̇ of the freedoms of its joint; none on a ball joint.
    pub freedoms: Vec<(Expr<'g>, Expr<'g>)>,
    /// Whether it turns with its carrier.
    pub turns_with_carrier: bool,
    /// ω \[rad/s\]
    pub omega: Vec3<'g>,
    /// ω · ω
    omega_squared: Expr<'g>,
    /// ε, the angular acceleration when v̇ = 0 \[rad/s²\]: Σ ė_j v_j on a ball joint, zero but for Bryant angles.
    pub bias: Vec3<'g>,
    /// Acceleration of the origin less that of the carrier's, when v̇ = 0 \[m/s²\]; of the root, less that of the reference joint. Zero on ball joints, where
    /// [`ElementMotion::gamma`] of the carrier says it.
    pub slide_bias: Vec3<'g>,
    /// Position of the joint \[m\].
    pub position: Vec3<'g>,
    /// Velocity of the joint \[m/s\].
    pub velocity: Vec3<'g>,
    /// Position of the origin relative to the parent's, u = A_parent s on a ball joint; of the root, relative to the reference joint.
    pub offset: Vec3<'g>,
}

impl<'g> ElementMotion<'g> {
    /// A body at rest in the absolute frame.
    pub(crate) fn frame(graph: &'g Graph) -> Self {
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        let none = Vec3::zero(graph);
        ElementMotion {
            rotation: Mat3([[one, zero, zero], [zero, one, zero], [zero, zero, one]]),
            angle: zero,
            axes: Vec::new(),
            slides: Vec::new(),
            freedoms: Vec::new(),
            turns_with_carrier: false,
            omega: none,
            omega_squared: zero,
            bias: none,
            slide_bias: none,
            position: none,
            velocity: none,
            offset: none,
        }
    }

    /// Sets ω.
    pub(crate) fn turns(&mut self, omega: Vec3<'g>) {
        self.omega = omega;
        self.omega_squared = omega.squared();
    }

    /// ω × (ω × v) = (ω·v) ω − (ω·ω) v
    pub fn centripetal(&self, v: Vec3<'g>) -> Vec3<'g> {
        self.omega.dot(v) * self.omega - self.omega_squared * v
    }

    /// ω · ω
    pub fn omega_squared(&self) -> Expr<'g> {
        self.omega_squared
    }

    /// γ(v): acceleration of the tip of v, fixed in the element, when v̇ = 0.
    pub fn gamma(&self, v: Vec3<'g>) -> Vec3<'g> {
        self.centripetal(v) + self.bias.cross(v)
    }

    /// D(v): the columns e_j × v.
    pub fn turned(&self, v: Vec3<'g>) -> Vec<Vec3<'g>> {
        self.axes.iter().map(|e| e.cross(v)).collect()
    }

    /// Velocity of a point at offset ρ from the joint.
    pub fn velocity_at(&self, offset: Vec3<'g>) -> Vec3<'g> {
        self.velocity + self.omega.cross(offset)
    }
}

/// Motion of all elements.
pub struct Motion<'g> {
    /// By system and element.
    pub systems: Vec<Vec<ElementMotion<'g>>>,
    /// By system: the velocity of its reference joint.
    pub references: Vec<Vec3<'g>>,
    /// By vehicle.
    pub vehicles: Vec<VehicleMotion<'g>>,
    frame: ElementMotion<'g>,
}

impl<'g> Motion<'g> {
    /// The motion at the inputs t, q, v.
    pub fn of(graph: &'g Graph, model: &Model, layout: &Layout, state: &State<'g>) -> Self {
        Self::new(graph, model, layout, state, Some(time(graph)))
    }

    /// The motion at the start of a run, where q and v are functions of parameters.
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
                    in_space(graph, layout, &state.q[at]),
                    in_space(graph, layout, &state.v[rate]),
                ),
                _ => reference_motion(graph, system, &vehicles, time),
            };
            let mut elements: Vec<ElementMotion<'g>> = Vec::new();
            for (k, element) in system.elements.iter().enumerate() {
                let id = ElementId {
                    system: s,
                    element: k,
                };
                if let Joint::Freedoms(freedoms) = &element.joint {
                    label(format!("element {}: joint", path(model, id)));
                    let shares = layout.shares(graph, model, id).into_iter();
                    let (q, v): (Vec<Expr<'g>>, Vec<Expr<'g>>) = shares
                        .map(|share| {
                            let q = share.ratio * state.q[share.coordinate] + share.offset;
                            (q, share.ratio * state.v[share.velocity])
                        })
                        .unzip();
                    let carrier = match (element.parent, &system.reference) {
                        (Some(parent), _) => elements[parent].clone(),
                        (None, reference) => {
                            let turned = match reference {
                                Reference::Riding { vehicle, .. } => {
                                    vehicles[*vehicle].body.clone()
                                }
                                _ => frame.clone(),
                            };
                            ElementMotion {
                                position,
                                velocity,
                                ..turned
                            }
                        }
                    };
                    let at = vector(graph, &element.at);
                    let motion = twist::motion(graph, freedoms, &carrier, at, &q, &v);
                    if time.is_some() {
                        named(model, id, &motion);
                    }
                    elements.push(motion);
                    continue;
                }
                let (q, v) = (
                    &state.q[layout.element_coordinates(id)],
                    &state.v[layout.element_velocities(id)],
                );
                let chart = layout.element_chart(id).map(|i| state.charts[i]);
                label(format!("element {}: orientation", path(model, id)));
                let mut motion = orientation(graph, layout.orientation, q, v, chart);
                if time.is_some() {
                    named(model, id, &motion);
                }
                label(format!("element {}: joint", path(model, id)));
                match element.parent {
                    None => (motion.position, motion.velocity) = (position, velocity),
                    Some(parent) => {
                        let parent = &elements[parent];
                        motion.offset = parent.rotation.times(vector(graph, &element.at));
                        motion.position = parent.position + motion.offset;
                        motion.velocity = parent.velocity_at(motion.offset);
                    }
                }
                if time.is_some() {
                    motion.offset.named(&format!("u_{}", identifier(model, id)));
                }
                elements.push(motion);
            }
            systems.push(elements);
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

    /// Offset from the body's joint, position and velocity of an attachment, absolute axes.
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

/// A point of a body, absolute axes.
#[derive(Clone, Copy)]
pub struct Point<'g> {
    /// From the body's joint \[m\].
    pub offset: Vec3<'g>,
    /// \[m\]
    pub position: Vec3<'g>,
    /// \[m/s\]
    pub velocity: Vec3<'g>,
}

/// Acceleration of a reference joint that is not free.
pub fn reference_acceleration<'g>(
    graph: &'g Graph,
    system: &System,
    motion: &Motion<'g>,
) -> Vec3<'g> {
    match &system.reference {
        Reference::Prescribed(translation) => {
            translation::acceleration(graph, translation, &system.velocity, time(graph))
        }
        Reference::Riding { vehicle, at } => {
            let vehicle = &motion.vehicles[*vehicle];
            vehicle.acceleration_at(vehicle.body.rotation.times(vector(graph, at)))
        }
        Reference::Free | Reference::Fixed => Vec3::zero(graph),
    }
}

/// "head", with the system's name before it where there are several systems.
pub fn path(model: &Model, id: ElementId) -> String {
    let system = &model.systems[id.system];
    let element = &system.elements[id.element].name;
    if model.systems.len() > 1 {
        format!("{}/{element}", system.name)
    } else {
        element.clone()
    }
}

/// Names the rotation of an element for the reader.
fn named(model: &Model, id: ElementId, motion: &ElementMotion<'_>) {
    let name = identifier(model, id);
    for (row, i) in motion.rotation.0.iter().zip(["x", "y", "z"]) {
        for (entry, j) in row.iter().zip(["x", "y", "z"]) {
            entry.graph().name(*entry, format!("rot_{name}_{i}{j}"));
        }
    }
}

/// The path as part of a Rust identifier.
pub fn identifier(model: &Model, id: ElementId) -> String {
    path(model, id).replace(['/', '-'], "_")
}

/// W⁻¹ ν with W = \[e_x, second, third\]: φ̈ from α − ε, or φ̇ from ω; W is singular where cos φ₂ = 0.
pub fn inverse_rates<'g>(
    second: Vec3<'g>,
    third: Vec3<'g>,
    cosine_of_second_angle: Expr<'g>,
    nu: Vec3<'g>,
) -> [Expr<'g>; 3] {
    let [_, c1, s1] = second.0;
    let [x, y, z] = nu.0;
    let rate_3 = (c1 * z - s1 * y) / cosine_of_second_angle;
    [x - third.0[0] * rate_3, c1 * y + s1 * z, rate_3]
}

/// A vector of the model's directions, as one of space.
fn in_space<'g>(graph: &'g Graph, layout: &Layout, components: &[Expr<'g>]) -> Vec3<'g> {
    let mut vector = Vec3::zero(graph);
    for (&direction, &component) in layout.directions.iter().zip(components) {
        vector.0[direction] = component;
    }
    vector
}

/// Position and velocity of a reference joint that is not free.
fn reference_motion<'g>(
    graph: &'g Graph,
    system: &System,
    vehicles: &[VehicleMotion<'g>],
    time: Option<Expr<'g>>,
) -> (Vec3<'g>, Vec3<'g>) {
    match &system.reference {
        Reference::Riding { vehicle, at } => {
            let body = &vehicles[*vehicle].body;
            let offset = body.rotation.times(vector(graph, at));
            (body.position + offset, body.velocity_at(offset))
        }
        Reference::Prescribed(translation) => {
            translation::motion(graph, translation, &system.position, &system.velocity, time)
        }
        Reference::Free | Reference::Fixed => (vector(graph, &system.position), Vec3::zero(graph)),
    }
}

/// Rotation, axes, ω and ε of an element from its own coordinates and velocities.
fn orientation<'g>(
    graph: &'g Graph,
    kind: Orientation,
    q: &[Expr<'g>],
    v: &[Expr<'g>],
    chart: Option<Expr<'g>>,
) -> ElementMotion<'g> {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let unit = |i: usize| Vec3(std::array::from_fn(|j| if i == j { one } else { zero }));
    let mut motion = ElementMotion::frame(graph);
    match kind {
        Orientation::Angle => {
            let (s, c) = (q[0].sin(), q[0].cos());
            motion.rotation = Mat3([[c, zero, s], [zero, one, zero], [-s, zero, c]]);
            motion.angle = q[0];
            motion.axes = vec![unit(1)];
            motion.omega = Vec3([zero, v[0], zero]);
        }
        Orientation::Quaternion => {
            motion.rotation = rotation_of_quaternion(graph, [q[0], q[1], q[2], q[3]]);
            motion.axes = (0..3).map(unit).collect();
            motion.omega = Vec3([v[0], v[1], v[2]]);
        }
        Orientation::Bryant => {
            let (rotation, axes) = bryant(graph, [q[0], q[1], q[2]]);
            motion.rotation = chart.map_or(rotation, |chart| chart::rotation(&rotation, chart));
            motion.axes = axes.to_vec();
            // ω in three steps; each axis turns with those before it, so ė₂ = v₁ e₁ × e₂ and ė₃ = (v₁ e₁ + v₂ e₂) × e₃.
            let before_third = v[0] * axes[0] + v[1] * axes[1];
            motion.omega = before_third + v[2] * axes[2];
            motion.bias =
                (v[0] * v[1]) * axes[0].cross(axes[1]) + v[2] * before_third.cross(axes[2]);
        }
    }
    motion.turns(motion.omega);
    motion
}

/// A principal-axes frame as a constant rotation relative to the element's frame.
pub fn constant_rotation<'g>(graph: &'g Graph, axes: &[Number; 3]) -> Mat3<'g> {
    bryant(graph, vector(graph, axes).0).0
}

/// Children of every element of a system.
pub fn children(elements: &[Element]) -> Vec<Vec<usize>> {
    let mut children = vec![Vec::new(); elements.len()];
    for (k, element) in elements.iter().enumerate() {
        if let Some(parent) = element.parent {
            children[parent].push(k);
        }
    }
    children
}
