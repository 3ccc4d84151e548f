//! The quantities that a scene asks to see.
//!
//! Acceleration of a point at offset ρ: p̈ + ω̇ × ρ + ω × (ω × ρ), the joints' p̈ from the reference joint outwards.
//! An accelerometer reads that less the fields, which act on its own mass as well.

use super::augmented::own_inertia;
use super::force::{Loads, Measures, UserMeasures};
use super::kinematics::{ElementMotion, Motion, reference_acceleration};
use super::layout::Layout;
use super::numbers::{number, vector};
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::{
    BeltQuantity, Component, ContactQuantity, ElementId, JointQuantity, Model, PointQuantity,
    Quantity, RotationQuantity, Switch, SwitchQuantity, SystemQuantity, UserQuantity,
};

/// Values of the model's outputs, in its order.
pub fn outputs<'g>(scene: &Scene<'g, '_>) -> Vec<Expr<'g>> {
    scene
        .model
        .outputs
        .iter()
        .map(|output| {
            scene.graph.section(format!("output {}", output.name));
            scene.quantity(&output.quantity)
        })
        .collect()
}

/// Everything that is known of a model in motion.
pub struct Scene<'g, 'a> {
    /// Where expressions are made.
    pub graph: &'g Graph,
    /// What is in motion.
    pub model: &'a Model,
    /// Its coordinates.
    pub layout: &'a Layout,
    /// The motion at t, q, v.
    pub motion: &'a Motion<'g>,
    /// The motion at the start of a run.
    pub start: &'a Motion<'g>,
    /// What acts.
    pub loads: &'a Loads<'g>,
    /// v̇
    pub accelerations: &'a [Expr<'g>],
}

impl<'g> Scene<'g, '_> {
    /// What the switches look at; nothing for a time.
    pub fn triggers(&self) -> Vec<Option<Expr<'g>>> {
        let of = |switch: &Switch| {
            self.graph.section(format!("switch {}", switch.name));
            switch.trigger.quantity().map(|q| self.quantity(q))
        };
        self.model.switches.iter().map(of).collect()
    }

    fn quantity(&self, quantity: &Quantity) -> Expr<'g> {
        let zero = self.graph.constant(0.0);
        match quantity {
            Quantity::Point {
                element,
                at,
                what,
                component,
            } => of(
                *component,
                self.point(*element, vector(self.graph, at), *what),
            ),
            Quantity::Vehicle {
                vehicle,
                at,
                what,
                component,
            } => of(
                *component,
                self.vehicle_point(*vehicle, vector(self.graph, at), *what),
            ),
            Quantity::Rotation {
                element,
                what,
                component,
            } => self.rotation(*element, *what, *component),
            Quantity::Joint { force, about, what } => match &self.loads.measures[*force] {
                Measures::Joint(measures) => measures[*about].map_or(zero, |m| match what {
                    JointQuantity::Torque => m.torque,
                    JointQuantity::Angle => m.angle,
                    JointQuantity::Rate => m.rate,
                }),
                _ => zero,
            },
            Quantity::Contact { force, what } => match &self.loads.measures[*force] {
                Measures::Contact(m) => match what {
                    ContactQuantity::Force => m.force,
                    ContactQuantity::Normal => m.normal,
                    ContactQuantity::Friction => m.friction,
                    ContactQuantity::Penetration => m.penetration,
                    ContactQuantity::PermanentSet => m.permanent_set,
                },
                _ => zero,
            },
            Quantity::Belt { force, what } => match &self.loads.measures[*force] {
                Measures::Belt(m) => match what {
                    BeltQuantity::Force => m.tension,
                    BeltQuantity::Length => m.length,
                    BeltQuantity::Elongation => m.elongation,
                    BeltQuantity::UntensionedLength => m.untensioned,
                    BeltQuantity::Payout => m.payout,
                    BeltQuantity::PermanentSet => m.permanent_set,
                },
                _ => zero,
            },
            Quantity::Switch { switch, what } => {
                let (one, switch) = (self.graph.constant(1.0), self.loads.switches[*switch]);
                match what {
                    SwitchQuantity::Acts => switch.once(one, zero),
                    SwitchQuantity::Time => switch.once(switch.since, -one),
                }
            }
            Quantity::User { force, what } => match &self.loads.measures[*force] {
                Measures::User(measures) => user(measures, *what).unwrap_or(zero),
                _ => zero,
            },
            Quantity::System {
                system,
                what,
                component,
            } => self.system(*system, *what, *component),
        }
    }

    fn point(&self, id: ElementId, at: Vec3<'g>, what: PointQuantity) -> Vec3<'g> {
        let element = self.motion.element(id);
        let offset = element.rotation.times(at);
        match what {
            PointQuantity::Position => element.position + offset,
            PointQuantity::Displacement => {
                let start = self.start.element(id);
                element.position + offset - (start.position + start.rotation.times(at))
            }
            PointQuantity::Velocity => element.velocity_at(offset),
            PointQuantity::Acceleration => self.acceleration(id, offset),
            PointQuantity::Accelerometer => {
                let fields =
                    self.loads.fields[id.system] + self.loads.partial_fields[id.system][id.element];
                self.acceleration(id, offset) - fields
            }
        }
    }

    fn vehicle_point(&self, index: usize, at: Vec3<'g>, what: PointQuantity) -> Vec3<'g> {
        let vehicle = &self.motion.vehicles[index];
        let (body, start) = (&vehicle.body, &self.start.vehicles[index].body);
        let offset = body.rotation.times(at);
        match what {
            PointQuantity::Position => body.position + offset,
            PointQuantity::Displacement => {
                body.position + offset - (start.position + start.rotation.times(at))
            }
            PointQuantity::Velocity => body.velocity_at(offset),
            PointQuantity::Acceleration | PointQuantity::Accelerometer => {
                vehicle.acceleration_at(offset)
            }
        }
    }

    fn rotation(&self, id: ElementId, what: RotationQuantity, component: Component) -> Expr<'g> {
        let element = self.motion.element(id);
        match what {
            RotationQuantity::Angle => self.angle(id, component),
            RotationQuantity::AngularVelocity => of(component, element.omega),
            RotationQuantity::AngularAcceleration => of(component, self.angular_acceleration(id)),
        }
    }

    /// The absolute angle in the plane, a Bryant angle in space.
    fn angle(&self, id: ElementId, component: Component) -> Expr<'g> {
        use super::layout::Orientation;
        use crate::expression::Symbol;
        let axis = match component {
            Component::X => 0,
            Component::Z => 2,
            Component::Y | Component::Resultant => 1,
        };
        match self.layout.orientation {
            Orientation::Angle => {
                let first = self.layout.element_coordinates(id).start;
                self.graph.symbol(Symbol::Coordinate(first as u32))
            }
            // of A, whatever chart the coordinates are in
            Orientation::Bryant | Orientation::Quaternion => {
                bryant_angle(&self.motion.element(id).rotation, axis)
            }
        }
    }

    /// α = Σ e_j v̇_j + ε
    fn angular_acceleration(&self, id: ElementId) -> Vec3<'g> {
        let element = self.motion.element(id);
        let rates = &self.accelerations[self.layout.element_velocities(id)];
        element
            .axes
            .iter()
            .zip(rates)
            .fold(element.bias, |sum, (axis, rate)| sum + *rate * *axis)
    }

    /// Acceleration of a point at an offset from the joint of an element.
    pub fn acceleration(&self, id: ElementId, offset: Vec3<'g>) -> Vec3<'g> {
        let system = &self.model.systems[id.system];
        // joints from the element inwards to the reference joint
        let (mut sum, mut element, mut offset) = (Vec3::zero(self.graph), id.element, offset);
        loop {
            let at = ElementId {
                system: id.system,
                element,
            };
            let motion = self.motion.element(at);
            sum = sum + self.angular_acceleration(at).cross(offset) + motion.centripetal(offset);
            offset = motion.offset;
            match system.elements[element].parent {
                Some(parent) => element = parent,
                None => break,
            }
        }
        match self.layout.reference_velocities(id.system) {
            Some(range) => {
                for (&d, row) in self.layout.directions.iter().zip(range) {
                    sum.0[d] = sum.0[d] + self.accelerations[row];
                }
                sum
            }
            None => sum + reference_acceleration(self.graph, system, self.motion),
        }
    }

    /// A quantity of a whole system; the component is of vectors.
    pub fn system(&self, system: usize, what: SystemQuantity, component: Component) -> Expr<'g> {
        let graph = self.graph;
        let (mut energy, mut vector_sum) = (graph.constant(0.0), Vec3::zero(graph));
        let mut total = graph.constant(0.0);
        for (k, element) in self.model.systems[system].elements.iter().enumerate() {
            let motion: &ElementMotion<'g> = &self.motion.systems[system][k];
            let mass = number(graph, &element.mass);
            let offset = motion.rotation.times(vector(graph, &element.cg));
            let (position, velocity) = (motion.position + offset, motion.velocity_at(offset));
            let inertia = own_inertia(graph, self.model.dimension, element);
            let local_omega = motion.rotation.transposed_times(motion.omega);
            match what {
                SystemQuantity::KineticEnergy => {
                    let spin = local_omega.dot(inertia.times(local_omega));
                    energy = energy + 0.5 * (mass * velocity.squared() + spin);
                }
                SystemQuantity::Momentum => vector_sum = vector_sum + mass * velocity,
                SystemQuantity::AngularMomentum => {
                    let own = motion.rotation.times(inertia.times(local_omega));
                    vector_sum = vector_sum + position.cross(mass * velocity) + own;
                }
                SystemQuantity::Position => {
                    total = total + mass;
                    vector_sum = vector_sum + mass * position;
                }
            }
        }
        match what {
            SystemQuantity::KineticEnergy => energy,
            SystemQuantity::Position => of(component, total.recip() * vector_sum),
            SystemQuantity::Momentum | SystemQuantity::AngularMomentum => of(component, vector_sum),
        }
    }
}

/// Of a user force; `None` beyond what it has.
fn user<'g>(measures: &UserMeasures<'g>, what: UserQuantity) -> Option<Expr<'g>> {
    let joint = |joint: usize, about: usize| measures.joints.get(joint)?.get(about).copied()?;
    match what {
        UserQuantity::Force(i, component) => Some(of(component, *measures.forces.get(i)?)),
        UserQuantity::Moment(i, component) => Some(of(component, *measures.moments.get(i)?)),
        UserQuantity::Tension(i) => Some(measures.lines.get(i)?.tension),
        UserQuantity::Length(i) => Some(measures.lines.get(i)?.length),
        UserQuantity::LengthRate(i) => Some(measures.lines.get(i)?.rate),
        UserQuantity::Torque(i, about) => Some(joint(i, about)?.torque),
        UserQuantity::Angle(i, about) => Some(joint(i, about)?.angle),
        UserQuantity::AngleRate(i, about) => Some(joint(i, about)?.rate),
        UserQuantity::State(i) => Some(measures.states.get(i)?.0),
        UserQuantity::StateRate(i) => Some(measures.states.get(i)?.1),
    }
}

/// A component of a vector, or its norm.
fn of<'g>(component: Component, v: Vec3<'g>) -> Expr<'g> {
    match component {
        Component::X => v.0[0],
        Component::Y => v.0[1],
        Component::Z => v.0[2],
        Component::Resultant => v.squared().sqrt(),
    }
}

/// The Bryant angles of a rotation: φ₁ = atan2(−A₂₃, A₃₃), φ₂ = atan2(A₁₃, √(A₂₃² + A₃₃²)), φ₃ = atan2(−A₁₂, A₁₁).
fn bryant_angle<'g>(a: &Mat3<'g>, axis: usize) -> Expr<'g> {
    let [[a11, a12, a13], [_, _, a23], [_, _, a33]] = a.0;
    match axis {
        0 => (-a23).atan2(a33),
        1 => a13.atan2((a23.squared() + a33.squared()).sqrt()),
        _ => (-a12).atan2(a11),
    }
}
