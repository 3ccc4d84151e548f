//! The outputs of a scene.
//!
//! The acceleration of a point at the offset ρ is p̈ + ω̇ × ρ + ω × (ω × ρ), where p̈ of the joints is summed from the
//! reference joint outwards. An accelerometer reads this minus the fields, which act on its own mass, too.
//!
//! An observer rides on a body b with its origin at o. With r = p − o, all in absolute axes, he sees the point p move
//! with
//!
//! r,   ṙ − ω_b × r,   r̈ − ω̇_b × r − ω_b × (ω_b × r) − 2 ω_b × (ṙ − ω_b × r)
//!
//! and a rotation ω with the angular velocity ω − ω_b and the angular acceleration ω̇ − ω̇_b − ω_b × (ω − ω_b).
//!
//! A joint transmits the force Σ (m a − m g − F) to the element that it carries, summed over that element and all that
//! this carries. A ball joint turns freely, so it transmits only the moment of its laws. Any other joint transmits Σ (r
//! × (m a − m g − F) + I α + ω × I ω − M), with r from the element's origin.

use super::augmented_body::{own_inertia, rotated};
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
use crate::force::AppliedForces;
use crate::force::Value;
use crate::model::{
    Body, Component, ElementId, FreedomQuantity, JointLoadQuantity, Leaf, Model, PointQuantity,
    Projection, Quantity, RotationQuantity, Switch, SwitchQuantity, SystemQuantity,
};
use crate::motion::ball::Orientation;
use crate::motion::kinematics::reference_acceleration;
use crate::motion::numbers::{arithmetic, number, vector};
use crate::motion::{ElementMotion, Layout, Motion};

/// The values of the model's outputs, in their order.
pub fn outputs<'g>(scene: &ModelInMotion<'g, '_>) -> Vec<Expr<'g>> {
    scene
        .model
        .outputs
        .iter()
        .map(|output| {
            scene.graph.section(format!("output {}", output.name));
            let value = scene.quantity(&output.quantity);
            match output.channel {
                Some(channel) if channel.reversed => -value,
                _ => value,
            }
        })
        .collect()
}

/// All derived quantities of a model in motion.
pub struct ModelInMotion<'g, 'a> {
    /// The graph of the expressions.
    pub graph: &'g Graph,
    /// The model.
    pub model: &'a Model,
    /// Its coordinates.
    pub layout: &'a Layout,
    /// The motion at t, q, v.
    pub motion: &'a Motion<'g>,
    /// The motion at the start of a run.
    pub start: &'a Motion<'g>,
    /// The applied forces.
    pub applied: &'a AppliedForces<'g>,
    /// v̇
    pub accelerations: &'a [Expr<'g>],
}

impl<'g> ModelInMotion<'g, '_> {
    /// The quantities that trigger switches; `None` for a switch at a time.
    pub fn triggers(&self) -> Vec<Option<Expr<'g>>> {
        let of = |switch: &Switch| {
            self.graph.section(format!("switch {}", switch.name));
            switch.trigger.quantity().map(|q| self.quantity(q))
        };
        self.model.switches.iter().map(of).collect()
    }

    // Long: one `match`, an arm for each kind of quantity.
    fn quantity(&self, quantity: &Quantity) -> Expr<'g> {
        let zero = self.graph.constant(0.0);
        match quantity {
            Quantity::Point {
                body,
                at,
                what,
                relative_to,
                projection,
            } => {
                let at = vector(self.graph, at);
                let seen = match relative_to {
                    Body::Frame => self.point(*body, at, *what),
                    observer => self.point_seen(*observer, *body, at, *what),
                };
                self.of(*projection, seen)
            }
            Quantity::Rotation {
                body,
                what,
                relative_to,
                projection,
            } => self.rotation(*body, *what, *relative_to, *projection),
            Quantity::JointLoad {
                element,
                what,
                on_carrier,
                projection,
            } => {
                let load = match what {
                    JointLoadQuantity::Force => self.joint_force(*element),
                    JointLoadQuantity::Moment => self.joint_moment(*element),
                };
                self.of(*projection, if *on_carrier { -load } else { load })
            }
            Quantity::Freedom {
                element,
                freedom,
                what,
            } => {
                let (position, rate) = self.motion.element(*element).freedoms[*freedom];
                match what {
                    FreedomQuantity::Position => position,
                    FreedomQuantity::Rate => rate,
                    FreedomQuantity::Acceleration => self.rates_of_joint(*element)[*freedom],
                }
            }
            Quantity::ForceOn {
                force,
                on_second,
                projection,
            } => {
                let on = self.applied.measures[*force].on();
                let on_first = on.first().copied();
                let on_first = on_first.unwrap_or_else(|| Vec3::zero(self.graph));
                self.of(*projection, if *on_second { -on_first } else { on_first })
            }
            Quantity::OfForce { force, what } => match self.applied.measures[*force].value(&**what)
            {
                Some(Value::Scalar(value)) => value,
                Some(Value::Along(projection, vector)) => self.of(projection, vector),
                None => zero,
            },
            Quantity::ForceOnPoints {
                force,
                points,
                projection,
            } => {
                let on = self.applied.measures[*force].on();
                let on = points.iter().filter_map(|&point| on.get(point).copied());
                let on = on.reduce(|sum, force| sum + force);
                let on = on.unwrap_or_else(|| Vec3::zero(self.graph));
                self.of(*projection, on)
            }
            Quantity::Switch { switch, what } => {
                let (one, switch) = (
                    self.graph.constant(1.0),
                    self.applied.states.switches[*switch],
                );
                match what {
                    SwitchQuantity::Acts => switch.once(one, zero),
                    SwitchQuantity::Time => switch.once(switch.since, -one),
                }
            }
            Quantity::System {
                system,
                what,
                projection,
            } => self.system(*system, *what, *projection),
            Quantity::Formula(formula) => {
                let leaf = |leaf: &Leaf| match leaf {
                    Leaf::Number(n) => number(self.graph, n),
                    Leaf::Quantity(quantity) => self.quantity(quantity),
                };
                let leaves: Vec<Expr<'g>> = formula.leaves.iter().map(leaf).collect();
                arithmetic(self.graph, &formula.value, &|index| leaves[index])
            }
        }
    }

    /// The required component of a vector, which is given in absolute axes.
    fn of(&self, projection: Projection, v: Vec3<'g>) -> Expr<'g> {
        let axis = match projection.component {
            Component::X => 0,
            Component::Y => 1,
            Component::Z => 2,
            Component::Resultant => return v.squared().sqrt(),
        };
        match projection.axes {
            Body::Frame => v.0[axis],
            body => self.motion.body(body).rotation.column(axis).dot(v),
        }
    }

    fn point(&self, body: Body, at: Vec3<'g>, what: PointQuantity) -> Vec3<'g> {
        let (now, start) = (self.motion.body(body), self.start.body(body));
        let offset = now.rotation.times(at);
        match what {
            PointQuantity::Position => now.position + offset,
            PointQuantity::Displacement => {
                now.position + offset - (start.position + start.rotation.times(at))
            }
            PointQuantity::Velocity => now.velocity_at(offset),
            PointQuantity::Acceleration => self.body_acceleration(body, offset),
            PointQuantity::Accelerometer => {
                let acceleration = self.body_acceleration(body, offset);
                match body {
                    Body::Element(id) => acceleration - self.fields(id),
                    Body::Vehicle(_) | Body::Frame => acceleration,
                }
            }
        }
    }

    /// The motion of a point as seen by an observer on a body, in absolute axes.
    fn point_seen(
        &self,
        observer: Body,
        body: Body,
        at: Vec3<'g>,
        what: PointQuantity,
    ) -> Vec3<'g> {
        let carried = self.motion.body(observer);
        let offset = self.point(body, at, PointQuantity::Position) - carried.position;
        let velocity =
            || self.point(body, at, PointQuantity::Velocity) - carried.velocity_at(offset);
        match what {
            PointQuantity::Position => offset,
            PointQuantity::Displacement => {
                let (start, mine) = (self.start.body(observer), self.start.body(body));
                let then = mine.position + mine.rotation.times(at) - start.position;
                let fixed = start.rotation.transposed_times(then);
                offset - carried.rotation.times(fixed)
            }
            PointQuantity::Velocity => velocity(),
            PointQuantity::Acceleration | PointQuantity::Accelerometer => {
                let own = self.body_acceleration(body, self.motion.body(body).rotation.times(at));
                let coriolis = carried
                    .omega
                    .cross(velocity())
                    .scale(self.graph.constant(2.0));
                own - self.body_acceleration(observer, offset) - coriolis
            }
        }
    }

    fn rotation(
        &self,
        body: Body,
        what: RotationQuantity,
        observer: Body,
        projection: Projection,
    ) -> Expr<'g> {
        let (motion, carried) = (self.motion.body(body), self.motion.body(observer));
        let omega = motion.omega - carried.omega;
        match what {
            RotationQuantity::Angle => self.angle(body, observer, projection.component),
            RotationQuantity::AngularVelocity => self.of(projection, omega),
            RotationQuantity::AngularAcceleration => {
                let turning = self.body_angular_acceleration(body)
                    - self.body_angular_acceleration(observer)
                    - carried.omega.cross(omega);
                self.of(projection, turning)
            }
        }
    }

    /// In the plane the angle; in space a Bryant angle, or the angle of the single rotation from the observer's axes to
    /// those of the body.
    fn angle(&self, body: Body, observer: Body, component: Component) -> Expr<'g> {
        let (motion, carried) = (self.motion.body(body), self.motion.body(observer));
        if self.layout.orientation == Orientation::Angle {
            return motion.angle - carried.angle;
        }
        // computed from A, because the coordinates may be in either chart
        let rotation = match observer {
            Body::Frame => motion.rotation,
            _ => carried.rotation.transposed().product(&motion.rotation),
        };
        match component {
            Component::X => bryant_angle(&rotation, 0),
            Component::Y => bryant_angle(&rotation, 1),
            Component::Z => bryant_angle(&rotation, 2),
            Component::Resultant => turn(&rotation),
        }
    }

    /// The acceleration of a material point of a body at an offset from its joint or origin.
    pub(super) fn body_acceleration(&self, body: Body, offset: Vec3<'g>) -> Vec3<'g> {
        match body {
            Body::Frame => Vec3::zero(self.graph),
            Body::Element(id) => self.acceleration(id, offset),
            Body::Vehicle(index) => self.motion.vehicles[index].acceleration_at(offset),
        }
    }

    pub(super) fn body_angular_acceleration(&self, body: Body) -> Vec3<'g> {
        match body {
            Body::Element(id) => self.angular_acceleration(id),
            // the motion of a vehicle is given, so the bias is its whole angular acceleration
            Body::Frame | Body::Vehicle(_) => self.motion.body(body).bias,
        }
    }

    /// The sum of all fields that act on an element.
    pub(super) fn fields(&self, id: ElementId) -> Vec3<'g> {
        self.applied.wrenches.fields[id.system]
            + self.applied.wrenches.partial_fields[id.system][id.element]
    }

    /// The force on an element from its carrier.
    fn joint_force(&self, carried: ElementId) -> Vec3<'g> {
        let outboard = self.outboard(carried);
        outboard.fold(Vec3::zero(self.graph), |sum, id| sum + self.needed(id))
    }

    /// An element and all elements that it carries.
    fn outboard(&self, carried: ElementId) -> impl Iterator<Item = ElementId> {
        let elements = &self.model.systems[carried.system].elements;
        let mut outward = vec![false; elements.len()];
        outward[carried.element] = true;
        for (k, element) in elements.iter().enumerate() {
            // carriers come before the elements that they carry
            outward[k] |= element.parent.is_some_and(|parent| outward[parent]);
        }
        (0..elements.len())
            .filter(move |&k| outward[k])
            .map(move |element| ElementId { element, ..carried })
    }

    /// m a − m g − F of an element: the force that its joints must provide.
    fn needed(&self, id: ElementId) -> Vec3<'g> {
        let element = &self.model.systems[id.system].elements[id.element];
        // the applied forces contain the fields that do not act on the whole system
        let free = self.acceleration(id, self.center(id)) - self.applied.wrenches.fields[id.system];
        let load = self.applied.wrenches.elements[id.system][id.element].force;
        number(self.graph, &element.mass) * free - load
    }

    /// The centre of gravity of an element from its origin, in absolute axes.
    fn center(&self, id: ElementId) -> Vec3<'g> {
        let element = &self.model.systems[id.system].elements[id.element];
        let rotation = &self.motion.element(id).rotation;
        rotation.times(vector(self.graph, &element.cg))
    }

    /// The moment on an element from its carrier, about its origin.
    pub fn joint_moment(&self, carried: ElementId) -> Vec3<'g> {
        let moments = &self.applied.wrenches.in_joints[carried.system][carried.element];
        let none = Vec3::zero(self.graph);
        let mut sum = moments.iter().fold(none, |sum, moment| sum + *moment);
        if !self.motion.element(carried).turns_with_carrier {
            return sum;
        }
        let origin = self.motion.element(carried).position;
        for id in self.outboard(carried) {
            let motion = self.motion.element(id);
            let element = &self.model.systems[id.system].elements[id.element];
            let own = own_inertia(self.graph, self.model.dimension, element);
            let inertia = rotated(self.graph, &motion.rotation, &own);
            let load = &self.applied.wrenches.elements[id.system][id.element];
            let free =
                self.acceleration(id, self.center(id)) - self.applied.wrenches.fields[id.system];
            let inertial = number(self.graph, &element.mass) * free;
            let arm = motion.position - origin;
            sum = sum
                + (arm + self.center(id)).cross(inertial)
                + inertia.times(self.angular_acceleration(id))
                + motion.omega.cross(inertia.times(motion.omega))
                - arm.cross(load.force)
                - load.moment;
        }
        sum
    }

    /// v̇ of the velocities of an element's joint.
    fn rates_of_joint(&self, id: ElementId) -> Vec<Expr<'g>> {
        let shares = self.layout.shares(self.graph, self.model, id).into_iter();
        shares
            .map(|share| share.ratio * self.accelerations[share.velocity])
            .collect()
    }

    /// α = Σ e_j v̇_j + ε, over the freedoms of the element and of the elements with which it turns
    fn angular_acceleration(&self, id: ElementId) -> Vec3<'g> {
        self.plus_turn(id, self.motion.element(id).bias)
    }

    /// The contribution of v̇ to the angular acceleration of an element.
    fn turn(&self, id: ElementId) -> Vec3<'g> {
        self.plus_turn(id, Vec3::zero(self.graph))
    }

    /// A vector plus the contribution of v̇ to the angular acceleration of an element.
    fn plus_turn(&self, id: ElementId, vector: Vec3<'g>) -> Vec3<'g> {
        let element = self.motion.element(id);
        let rates = self.rates_of_joint(id);
        let parent = self.model.systems[id.system].elements[id.element].parent;
        let carried = match parent {
            Some(parent) if element.turns_with_carrier => {
                let parent = ElementId {
                    element: parent,
                    ..id
                };
                self.plus_turn(parent, vector)
            }
            _ => vector,
        };
        let own = element.axes.iter().zip(rates);
        own.fold(carried, |sum, (axis, rate)| sum + rate * *axis)
    }

    /// Acceleration of a point at an offset from the joint of an element.
    pub fn acceleration(&self, id: ElementId, offset: Vec3<'g>) -> Vec3<'g> {
        let system = &self.model.systems[id.system];
        // from the element inwards to the reference joint
        let (mut sum, mut element, mut offset) = (Vec3::zero(self.graph), id.element, offset);
        loop {
            let at = ElementId { element, ..id };
            let motion = self.motion.element(at);
            if motion.turns_with_carrier {
                // `slide_bias` contains the terms of the carrier's motion, except those with v̇
                sum = sum + self.turn(at).cross(offset) + motion.gamma(offset) + motion.slide_bias;
                let rates = self.rates_of_joint(at);
                for (slide, rate) in motion.slides.iter().zip(rates) {
                    sum = sum + rate * *slide;
                }
                let Some(parent) = system.elements[element].parent else {
                    break;
                };
                element = parent;
                let carrier = ElementId { element, ..id };
                sum = sum + self.turn(carrier).cross(motion.offset);
                // from here on, only the acceleration of the carrier's origin is missing
                offset = Vec3::zero(self.graph);
                continue;
            }
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

    /// A quantity of a whole system; the projection is used for vectors.
    pub fn system(&self, system: usize, what: SystemQuantity, projection: Projection) -> Expr<'g> {
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
                    for (freedom, (_, rate)) in
                        element.joint.freedoms().iter().zip(&motion.freedoms)
                    {
                        let armature = number(self.graph, &freedom.armature);
                        energy = energy + 0.5 * armature * rate.squared();
                    }
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
            SystemQuantity::Position => self.of(projection, total.recip() * vector_sum),
            SystemQuantity::Momentum | SystemQuantity::AngularMomentum => {
                self.of(projection, vector_sum)
            }
        }
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

/// The angle θ of a rotation about one axis, 0 to π: 2 sin θ is the length of (A₃₂ − A₂₃, A₁₃ − A₃₁, A₂₁ − A₁₂), and
/// 2 cos θ is A₁₁ + A₂₂ + A₃₃ − 1.
fn turn<'g>(a: &Mat3<'g>) -> Expr<'g> {
    let [[a11, a12, a13], [a21, a22, a23], [a31, a32, a33]] = a.0;
    let sines = Vec3([a32 - a23, a13 - a31, a21 - a12]);
    let one = a11.graph().constant(1.0);
    sines.squared().sqrt().atan2(a11 + a22 + a33 - one)
}
