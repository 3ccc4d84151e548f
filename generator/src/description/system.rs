//! Systems as written: trees of elements, their reference joints, where they start.

use super::curve::Function;
use super::element::{Anatomy, Element};
use super::place::At;
use super::quantity::{OneOrThree, Quantity};
use super::shape::{Misfit, Named, Problems, Shape, check_record, check_word_or, record};
use super::tree::Kind;
use serde_yaml::Value;

record! {
    /// A tree of elements.
    System as "a system" {
        /// Name, unique among the systems.
        name: String,
        /// What the reference joint does.
        reference: Option<Reference>,
        /// Its elements; left out where an included file describes the system.
        elements: Option<Vec<Element>>,
        /// Which axes of its elements are forward and up, where they are not x and z.
        anatomy: Option<Anatomy>,
        /// Where it starts.
        start: Option<Start>,
    }
}

record! {
    /// Initial state.
    Start as "a start" {
        /// Position of the reference joint, absolute frame \[m\].
        position: Option<Vec<Quantity>>,
        /// Velocity of the reference joint, absolute frame \[m/s\].
        velocity: Option<Vec<Quantity>>,
        /// Absolute angles by element \[rad\].
        angles: Option<Named<OneOrThree>>,
        /// Angular velocities by element, absolute axes \[rad/s\].
        rates: Option<Named<OneOrThree>>,
        /// Coordinates of joints with freedoms of their own, by element \[rad\] or \[m\].
        joints: Option<Named<OneOrThree>>,
        /// Their rates \[rad/s\] or \[m/s\].
        joint_rates: Option<Named<OneOrThree>>,
    }
}

record! {
    /// A prescribed motion of the reference joint.
    Prescribed as "a prescribed reference" {
        /// From the start, per absolute axis \[m\]: 0 or a smooth curve of time.
        displacement: Option<Vec<Function>>,
        /// Per absolute axis \[m/s\]: a number or a curve of time.
        velocity: Option<Vec<Function>>,
        /// Per absolute axis \[m/s²\]: a number or a curve of time.
        acceleration: Option<Vec<Function>>,
        /// Whether it stays, along each axis, as soon as its velocity is 0: where the acceleration is given.
        stops: Option<bool>,
    }
}

record! {
    /// A reference joint that moves with a vehicle.
    Riding as "a reference on a vehicle" {
        /// Name of the vehicle.
        on: String,
        /// The point, local frame of the vehicle \[m\].
        at: Vec<Quantity>,
    }
}

/// What a reference joint does.
#[derive(Clone, Debug)]
pub enum Reference {
    /// It moves as the forces make it.
    Free,
    /// It stays.
    Fixed,
    /// It moves as prescribed.
    Prescribed(Prescribed),
    /// It moves with a vehicle.
    Riding(Riding),
}

/// What a reference joint may do besides.
const OTHERWISE: &str = "`{ on: VEHICLE, at: [x, z] }` moves with a vehicle, and `{ acceleration: [CURVE, 0] }` (or `velocity`, `displacement`) as prescribed";

impl Shape for Reference {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::Map(_) if at.node.get("on").is_some() => check_record::<Riding>(at, problems),
            Kind::Map(_) => check_record::<Prescribed>(at, problems),
            _ => check_word_or(at, &["free", "fixed"], OTHERWISE, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.as_str() {
            Some("free") => Ok(Reference::Free),
            Some("fixed") => Ok(Reference::Fixed),
            _ if value.get("on").is_some() => Riding::read(value).map(Reference::Riding),
            _ => Prescribed::read(value).map(Reference::Prescribed),
        }
    }
}
