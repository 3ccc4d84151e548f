//! Quantities that an output measures.

use super::body::{Body, ElementId};
use super::law::OfLaw;
use super::number::Number;
use serde::Serialize;

/// Component of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Component {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// Euclidean norm.
    Resultant,
}

/// One component of a vector, along the axes of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Projection {
    /// The component.
    pub component: Component,
    /// The body whose axes are used.
    pub axes: Body,
}

impl Projection {
    /// A component along the absolute axes.
    pub fn absolute(component: Component) -> Projection {
        Projection {
            component,
            axes: Body::Frame,
        }
    }
}

impl Projection {
    /// True if this component of a vector in the plane x–z can differ from 0.
    pub fn lies_in_plane(self) -> bool {
        self.component != Component::Y
    }

    /// True if this component of a vector along y can differ from 0.
    pub fn is_about_y(self) -> bool {
        matches!(self.component, Component::Y | Component::Resultant)
    }
}

/// A quantity that an output measures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Quantity {
    /// Kinematics of a point of an element or a vehicle.
    Point {
        /// The body; never the absolute frame.
        body: Body,
        /// The point in the local frame \[m\]; the centre of gravity is resolved to its coordinates.
        at: [Number; 3],
        /// The kind of kinematic quantity. The reading of an accelerometer exists for elements only.
        what: PointQuantity,
        /// The body that the observer moves with.
        relative_to: Body,
        /// The component.
        projection: Projection,
    },
    /// Rotation of an element or a vehicle; in the plane the component is always [`Component::Y`](super::Component::Y).
    Rotation {
        /// The body; never the absolute frame.
        body: Body,
        /// The angle or one of its derivatives.
        what: RotationQuantity,
        /// The body that the observer moves with.
        relative_to: Body,
        /// The component. For angles, X, Y, Z are the first, second, third Bryant angle, and the resultant is the angle
        /// of the single rotation from the observer's axes to those of the body; `axes` has no meaning.
        projection: Projection,
    },
    /// Force or moment that a joint transmits.
    JointLoad {
        /// The element that the joint carries.
        element: ElementId,
        /// Force or moment.
        what: JointLoadQuantity,
        /// True for the load on the carrier, which is opposite to that on the element.
        on_carrier: bool,
        /// The component.
        projection: Projection,
    },
    /// The force of a law between two bodies, on one of them.
    ForceOn {
        /// Index into [`Model::forces`](super::Model::forces).
        force: usize,
        /// True for the force on the second body, which is opposite to that on the first. The first body is that of a
        /// contact's `ellipsoid`, or of the end `from`.
        on_second: bool,
        /// The component.
        projection: Projection,
    },
    /// The coordinate of a freedom of a joint, or a derivative.
    Freedom {
        /// The element that the joint carries.
        element: ElementId,
        /// Index of the freedom among those of the joint.
        freedom: usize,
        /// The coordinate or one of its derivatives.
        what: FreedomQuantity,
    },
    /// The force on one body by a belt that runs through rings, or by an airbag: the sum over all points of the law on
    /// this body.
    ForceOnPoints {
        /// Index into [`Model::forces`](super::Model::forces).
        force: usize,
        /// The points on that body. The points of a belt are numbered from its end `from`; those of an airbag are its
        /// own body, then the bodies that it meets.
        points: Vec<usize>,
        /// The component.
        projection: Projection,
    },
    /// A quantity of a law.
    OfForce {
        /// Index into [`Model::forces`](super::Model::forces).
        force: usize,
        /// The quantity.
        what: Box<dyn OfLaw>,
    },
    /// A quantity of a switch.
    Switch {
        /// Index into [`Model::switches`](super::Model::switches).
        switch: usize,
        /// The quantity.
        what: SwitchQuantity,
    },
    /// A quantity of a whole system.
    System {
        /// Index into [`Model::systems`](super::Model::systems).
        system: usize,
        /// The quantity.
        what: SystemQuantity,
        /// The component, if the quantity is a vector.
        projection: Projection,
    },
    /// An arithmetic expression of other quantities.
    Formula(Box<Formula>),
}

/// An arithmetic expression of quantities, in SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Formula {
    /// The expression. Its parameters are indices into `leaves`, not parameters of the model.
    pub value: Number,
    /// The operands of the expression.
    pub leaves: Vec<Leaf>,
}

/// An operand of a formula.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Leaf {
    /// An expression of the model's parameters.
    Number(Number),
    /// A quantity.
    Quantity(Quantity),
}

impl Quantity {
    /// A quantity of the law of a force.
    pub fn of_force(force: usize, what: impl OfLaw) -> Self {
        let what = Box::new(what);
        Quantity::OfForce { force, what }
    }

    /// The measured quantities: for a formula all its operands that are quantities, otherwise the quantity itself.
    pub fn leaves(&self) -> Vec<&Quantity> {
        let Quantity::Formula(formula) = self else {
            return vec![self];
        };
        let leaves = formula.leaves.iter().flat_map(|leaf| match leaf {
            Leaf::Number(_) => Vec::new(),
            Leaf::Quantity(quantity) => quantity.leaves(),
        });
        leaves.collect()
    }

    /// Like [`leaves`](Self::leaves), mutable.
    pub fn leaves_mut(&mut self) -> Vec<&mut Quantity> {
        match self {
            Quantity::Formula(formula) => {
                let leaves = formula.leaves.iter_mut().flat_map(|leaf| match leaf {
                    Leaf::Number(_) => Vec::new(),
                    Leaf::Quantity(quantity) => quantity.leaves_mut(),
                });
                leaves.collect()
            }
            leaf => vec![leaf],
        }
    }

    /// True if the quantity is the magnitude of a vector.
    pub fn is_resultant(&self) -> bool {
        match self {
            // the angle of rotation in the plane is a single number
            Quantity::Rotation {
                what: RotationQuantity::Angle,
                ..
            } => false,
            Quantity::System {
                what: SystemQuantity::KineticEnergy,
                ..
            } => false,
            Quantity::Point { projection, .. }
            | Quantity::Rotation { projection, .. }
            | Quantity::JointLoad { projection, .. }
            | Quantity::ForceOn { projection, .. }
            | Quantity::ForceOnPoints { projection, .. }
            | Quantity::System { projection, .. } => projection.component == Component::Resultant,
            Quantity::OfForce { what, .. } => what.component() == Some(Component::Resultant),
            _ => false,
        }
    }
}

/// A load that a joint transmits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum JointLoadQuantity {
    /// Force at the joint \[N\].
    Force,
    /// Moment about the joint \[N m\].
    Moment,
}

/// Kinematics of a point, as seen by an observer who moves with a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum PointQuantity {
    /// Position relative to the origin of the observer's frame \[m\].
    Position,
    /// Position less initial position ("excursion") \[m\].
    Displacement,
    /// Velocity \[m/s\].
    Velocity,
    /// Second derivative of the position \[m/s²\].
    Acceleration,
    /// Reading of an accelerometer: acceleration less that of every field that acts on the element \[m/s²\].
    Accelerometer,
}

/// Rotation of a body, as seen by an observer who moves with another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum RotationQuantity {
    /// (Bryant) angle \[rad\].
    Angle,
    /// Angular velocity \[rad/s\].
    AngularVelocity,
    /// Angular acceleration \[rad/s²\].
    AngularAcceleration,
}

/// The coordinate of a freedom of a joint, or a derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum FreedomQuantity {
    /// The coordinate \[rad\] or \[m\].
    Position,
    /// Rate of the coordinate.
    Rate,
    /// Second derivative of the coordinate.
    Acceleration,
}

/// A quantity of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SystemQuantity {
    /// Kinetic energy \[J\].
    KineticEnergy,
    /// Momentum \[kg m/s\].
    Momentum,
    /// Angular momentum about the origin of the absolute frame \[kg m²/s\].
    AngularMomentum,
    /// Position of the centre of gravity \[m\].
    Position,
}

impl Quantity {
    /// The bodies that are observed, and those of observers and axes. Not included are elements that joints carry,
    /// systems, and bodies of forces; for a formula there are none.
    pub fn bodies_mut(&mut self) -> impl Iterator<Item = &mut Body> {
        let bodies = match self {
            Quantity::Point {
                body,
                relative_to,
                projection,
                ..
            }
            | Quantity::Rotation {
                body,
                relative_to,
                projection,
                ..
            } => [Some(body), Some(relative_to), Some(&mut projection.axes)],
            Quantity::JointLoad { projection, .. }
            | Quantity::ForceOn { projection, .. }
            | Quantity::ForceOnPoints { projection, .. }
            | Quantity::System { projection, .. } => [Some(&mut projection.axes), None, None],
            Quantity::OfForce { what, .. } => {
                let projection = what.projection_mut();
                [projection.map(|p| &mut p.axes), None, None]
            }
            Quantity::Freedom { .. } | Quantity::Switch { .. } | Quantity::Formula(_) => {
                [None, None, None]
            }
        };
        bodies.into_iter().flatten()
    }

    /// Index of the force that is observed; `None` for a formula.
    pub fn force_mut(&mut self) -> Option<&mut usize> {
        match self {
            Quantity::OfForce { force, .. }
            | Quantity::ForceOnPoints { force, .. }
            | Quantity::ForceOn { force, .. } => Some(force),
            Quantity::Point { .. }
            | Quantity::Rotation { .. }
            | Quantity::JointLoad { .. }
            | Quantity::Freedom { .. }
            | Quantity::Switch { .. }
            | Quantity::Formula(_)
            | Quantity::System { .. } => None,
        }
    }
}

/// A quantity of a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SwitchQuantity {
    /// 1 once the switch is in effect, 0 before.
    Acts,
    /// The time at which the switch takes effect \[s\], −1 before.
    Time,
}
