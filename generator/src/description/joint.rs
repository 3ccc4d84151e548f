//! The joint of an element as written: a word, one joint, or a list of hinges, sliders and screws from the carrier outwards.

use super::place::At;
use super::quantity::Quantity;
use super::shape::{Problems, Shape, check_record, check_word, record};
use super::tree::Kind;
use serde::de::{Deserialize, Deserializer, Error};

/// The words for a joint that needs no axis.
pub const WORDS: [&str; 5] = ["ball", "hinge", "weld", "translation", "free"];

/// The words for an axis: one of the frame's own, or its opposite.
pub const AXES: [&str; 6] = ["x", "y", "z", "-x", "-y", "-z"];

record! {
    /// A joint with freedoms of its own.
    Freedom as "a joint" {
        /// Name of the freedom, unique in its joint.
        name: Option<String>,
        /// Axis that it turns about.
        hinge: Option<Axis>,
        /// Axis that it slides along.
        slider: Option<Axis>,
        /// Axis that it turns about while it slides along it.
        screw: Option<Axis>,
        /// Two axes that it turns about, one after the other.
        universal: Option<Vec<Axis>>,
        /// Axis that it slides along and turns about.
        cylinder: Option<Axis>,
        /// Normal of a plane that it slides in, turning about the normal.
        planar: Option<Axis>,
        /// Of a screw: the length of one turn \[m\].
        pitch: Option<Quantity>,
        /// What is added to the coordinate \[rad\] or \[m\].
        zero: Option<Quantity>,
        /// Inertia of a rotor that turns with the coordinate \[kg·m²\] or \[kg\].
        armature: Option<Quantity>,
        /// Another freedom of the system, whose coordinate gives this one.
        follows: Option<Follows>,
    }
}

record! {
    /// How a freedom follows another: its coordinate is ratio times that of the other, plus an offset.
    Follows as "a coupling" {
        /// The element that the other joint carries, of the same system.
        joint: String,
        /// Of a joint with several freedoms: the one that is followed.
        freedom: Option<String>,
        /// Change of this coordinate per change of the other.
        ratio: Option<Quantity>,
        /// This coordinate where the other is 0 \[rad\] or \[m\].
        offset: Option<Quantity>,
    }
}

/// An axis in the frame of what carries the element.
#[derive(Clone, Debug)]
pub enum Axis {
    /// One of the frame's own, or its opposite.
    Word(String),
    /// A vector; its length does not matter.
    Vector(Vec<Quantity>),
}

/// What a joint may look like.
#[derive(Clone, Debug)]
pub enum Joint {
    /// One that needs no axis.
    Word(String),
    /// One.
    One(Box<Freedom>),
    /// Several with no mass between, from the carrier outwards.
    List(Vec<Freedom>),
}

impl Shape for Axis {
    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            Kind::List(_) => Vec::<Quantity>::check(at, problems),
            _ => check_word(at, &AXES, problems),
        }
    }
}

impl Shape for Joint {
    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            Kind::List(_) => Vec::<Freedom>::check(at, problems),
            Kind::Map(_) => check_record::<Freedom>(at, problems),
            Kind::Scalar { .. } => check_word(at, &WORDS, problems),
        }
    }
}

impl<'de> Deserialize<'de> for Axis {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_yaml::Value::deserialize(deserializer)?;
        match value.as_str() {
            Some(word) => Ok(Axis::Word(word.to_owned())),
            None => Vec::deserialize(value)
                .map(Axis::Vector)
                .map_err(D::Error::custom),
        }
    }
}

impl<'de> Deserialize<'de> for Joint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_yaml::Value::deserialize(deserializer)?;
        if let Some(word) = value.as_str() {
            return Ok(Joint::Word(word.to_owned()));
        }
        match value.is_sequence() {
            true => Vec::deserialize(value).map(Joint::List),
            false => Freedom::deserialize(value).map(|one| Joint::One(Box::new(one))),
        }
        .map_err(D::Error::custom)
    }
}
