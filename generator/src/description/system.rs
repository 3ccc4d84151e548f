//! Systems as written: trees of elements, their reference joints, where they start.

use super::curve::OverTime;
use super::element::{Anatomy, Element};
use super::measure::{Acceleration, Angle, Coordinate, CoordinateRate, Length, Rate, Speed};
use super::place::At;
use super::quantity::{Number, OneOrThree};
use super::schema::{Schema, any_of, words};
use super::shape::{Misfit, Named, Problems, Shape, check_record, check_word_or, record};
use super::tree::NodeKind;
use serde_yaml::Value;

record! {
    /// A tree of elements.
    System as "a system" {
        /// name, unique among the systems
        name: String,
        /// `free`, `fixed`, a [prescribed](#a-prescribed-reference) motion, or a [vehicle](#a-reference-on-a-vehicle)
        /// that it is attached to
        reference: Option<Reference> = "`free`",
        /// list of [elements](#an-element), in any order; left out only where an included file describes the system
        elements: Option<Vec<Element>> = "those included",
        /// which axes of its elements are [forward and up](#an-anatomy)
        anatomy: Option<Anatomy> = "x forward, z up",
        /// [initial state](#a-start)
        start: Option<Start> = "at rest in the origin",
    }
}

record! {
    /// Initial state.
    Start as "a start" {
        /// of the reference joint, absolute frame
        position: Option<Vec<Number<Length>>> = "the origin",
        /// of a free or prescribed reference joint, absolute frame
        velocity: Option<Vec<Number<Speed>>> = "0",
        /// by element, absolute: one angle in the plane, `[φ1, φ2, φ3]` in space
        angles: Option<Named<OneOrThree<Number<Angle>>>> = "0",
        /// by element: one rate in the plane, the angular velocity `[x, y, z]` in absolute axes in space
        rates: Option<Named<OneOrThree<Number<Rate>>>> = "0",
        /// by element: the coordinates of its [joint](#a-joint), relative to its carrier; one, or a list in the order
        /// of the freedoms
        joints: Option<Named<OneOrThree<Number<Coordinate>>>> = "0",
        /// by element: the rates of the same
        joint_rates: Option<Named<OneOrThree<Number<CoordinateRate>>>> = "0",
    }
}

record! {
    /// A prescribed motion of the reference joint.
    Prescribed as "a prescribed reference" {
        /// from the start, per absolute axis: 0, or a curve of time (s → m) with `interpolate: cubic`
        displacement: Option<Vec<OverTime<Length>>>,
        /// per absolute axis: a number, or a curve of time (s → m/s)
        velocity: Option<Vec<OverTime<Speed>>>,
        /// per absolute axis: a number, or a curve of time (s → m/s²)
        acceleration: Option<Vec<OverTime<Acceleration>>>,
        /// `true`: along each axis it comes to rest when its velocity reaches 0, as [a vehicle](#a-vehicle-that-stops)
        /// does; only with `acceleration`
        stops: Option<bool> = "`false`",
    }
}

impl Prescribed {
    /// How many of the three quantities are written.
    pub fn count(&self) -> usize {
        let written = [
            self.displacement.is_some(),
            self.velocity.is_some(),
            self.acceleration.is_some(),
        ];
        written.into_iter().filter(|&is| is).count()
    }
}

record! {
    /// A reference joint that moves with a vehicle.
    Riding as "a reference on a vehicle" {
        /// name of the vehicle
        on: String,
        /// the point, local frame of the vehicle
        at: Vec<Number<Length>>,
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
    fn schema(to: &mut Schema) -> Value {
        any_of([
            words(&["free", "fixed"]),
            Riding::schema(to),
            Prescribed::schema(to),
        ])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            NodeKind::Map(_) if at.node.get("on").is_some() => check_record::<Riding>(at, problems),
            NodeKind::Map(_) => check_record::<Prescribed>(at, problems),
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
