//! Systems of elements, and bodies with a prescribed motion.

use super::coefficient::FieldComponent;
use super::curve::ScaledCurve;
use super::joint::{Follows, Freedom, Joint};
use super::number::Number;
use serde::Serialize;

/// A rigid body whose motion is prescribed: it has neither mass nor equations. In a model, something refers to every
/// vehicle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vehicle {
    /// Name, unique among the vehicles and systems.
    pub name: String,
    /// Position of the origin at t = 0, absolute frame \[m\].
    pub position: [Number; 3],
    /// Velocity of the origin at t = 0, less the part that curves determine \[m/s\].
    pub velocity: [Number; 3],
    /// Motion of the origin.
    pub translation: Translation,
    /// Absolute Bryant angles \[rad\]; curves have a continuous slope. In the plane only the second (about y) is used.
    pub angles: [FieldComponent; 3],
    /// The angles at t = 0 \[rad\].
    pub angles_at_start: [Number; 3],
}

/// One tree of elements.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct System {
    /// Name, unique among the systems.
    pub name: String,
    /// Elements, carriers before what they carry; element 0 is the root, whose origin is the reference joint.
    pub elements: Vec<Element>,
    /// Motion of the reference joint.
    pub reference: Reference,
    /// Initial position of the reference joint, absolute frame \[m\]. In the plane the second component is 0.
    pub position: [Number; 3],
    /// Initial velocity of the reference joint, absolute frame \[m/s\]; if its motion is prescribed, less the part that
    /// curves determine.
    pub velocity: [Number; 3],
}

/// Motion of a reference joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Reference {
    /// Its coordinates are unknowns of the equations of motion.
    Free,
    /// It stays at [`System::position`](super::System::position).
    Fixed,
    /// It moves as prescribed, from [`System::position`](super::System::position) with
    /// [`System::velocity`](super::System::velocity).
    Prescribed(Translation),
    /// It moves with a point of a vehicle, which is at [`System::position`](super::System::position) at t = 0.
    Riding {
        /// Index into [`Model::vehicles`](super::Model::vehicles).
        vehicle: usize,
        /// The point in the vehicle's local frame \[m\].
        at: [Number; 3],
    },
}

/// A prescribed translation x(t) along each absolute axis, from the start position x₀ and the start velocity v₀:
///
/// x = x₀ + c,   x = x₀ + v₀ t + ∫ c   or   x = x₀ + v₀ t + ∬ c
///
/// with a curve of time c; c is 0 if there is none. Velocity and acceleration follow in closed form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Translation {
    /// Which of these three formulas applies.
    pub given: Given,
    /// The curve c for each absolute axis. A displacement is 0 at t = 0 and has a continuous slope, and its v₀ is 0.
    pub curves: [Option<ScaledCurve>; 3],
    /// Present if a motion given by acceleration stops as soon as its velocity is 0, along each axis that has a curve:
    /// the line from 0 to 1, held at both ends. Its abscissa is the time divided by the time of the stop; its value is
    /// the fraction of the motion that is over.
    pub stops: Option<ScaledCurve>,
}

/// The quantity that the curves of a prescribed motion give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Given {
    /// Displacement from the start \[m\].
    Displacement,
    /// Velocity \[m/s\].
    Velocity,
    /// Acceleration \[m/s²\].
    Acceleration,
}

/// A frame fixed in an element.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedPoint {
    /// Name, unique among the elements and points of its system.
    pub name: String,
    /// Its origin, local frame \[m\].
    pub at: [Number; 3],
    /// Bryant angles of its axes relative to the local frame \[rad\].
    pub angles: [Number; 3],
}

/// One rigid element.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Element {
    /// Name, unique in its system; with underscores in place of dashes, a Rust identifier.
    pub name: String,
    /// Index of the carrier in the same system; `None` for element 0 only.
    pub parent: Option<usize>,
    /// Position of the joint in the carrier's local frame \[m\]; zero for the root.
    pub at: [Number; 3],
    /// The joint: its freedoms relative to the carrier.
    pub joint: Joint,
    /// Mass \[kg\].
    pub mass: Number,
    /// Centre of gravity, local frame \[m\].
    pub cg: [Number; 3],
    /// Principal moments of inertia about the centre of gravity \[kg m²\]. In the plane only the second (about y) is
    /// used.
    pub inertia: [Number; 3],
    /// Bryant angles of the principal axes relative to the local frame \[rad\]; zero if the axes coincide.
    pub axes: [Number; 3],
    /// Initial absolute Bryant angles on a ball joint \[rad\]. In the plane only the second (about y) is used.
    pub angles: [Number; 3],
    /// Initial angular velocity on a ball joint: in space ω in absolute axes \[rad/s\]; in the plane only the second
    /// component is used.
    pub angular_velocity: [Number; 3],
    /// Frames with names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<NamedPoint>,
}

impl System {
    /// True if all joints are ball joints, or hinges in the plane: then every orientation is absolute.
    pub fn has_balls_alone(&self) -> bool {
        self.elements.iter().all(|e| e.joint == Joint::Ball)
    }

    /// The freedoms of all joints.
    pub fn freedoms(&self) -> impl Iterator<Item = &Freedom> {
        self.elements.iter().flat_map(|e| e.joint.freedoms())
    }

    /// True if a freedom follows another: then S has more nonzero entries than the tree implies.
    pub fn is_coupled(&self) -> bool {
        self.freedoms().any(|freedom| !freedom.is_own())
    }
}

impl Follows {
    /// Index of the leader's coordinate among those of its element.
    pub fn coordinate(&self, elements: &[Element]) -> usize {
        let before = &elements[self.element].joint.freedoms()[..self.freedom];
        before.iter().filter(|freedom| freedom.is_own()).count()
    }

    /// Position and rate of the follower at the start.
    pub(crate) fn start(&self, elements: &[Element]) -> [Number; 2] {
        let leader = &elements[self.element].joint.freedoms()[self.freedom];
        let times = |n: &Number| Number::product(self.ratio.clone(), n.clone());
        let position = Number::sum(times(&leader.position), self.offset.clone());
        [position, times(&leader.rate)]
    }
}
