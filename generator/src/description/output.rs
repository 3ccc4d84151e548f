//! Outputs as written: the columns of the table.

use super::place::At;
use super::quantity::Quantity;
use super::shape::{Problems, Shape, check_word, record, words};
use super::tree::Kind;
use serde::de::{Deserialize, Deserializer, Error};

record! {
    /// A column of the table.
    Output as "an output" {
        /// Heading, unique.
        name: String,
        /// Whether it is shown.
        enabled: Option<bool>,
        /// What is looked at: `man/head`, `joint man/head`, `contact seat`, `belt chest`, `man`.
        of: String,
        /// What of it.
        what: String,
        /// The point of an element, local frame \[m\].
        at: Option<Point>,
        /// Which component of a vector, absolute axes.
        component: Option<Component>,
        /// In space: which relative rotation of a joint.
        about: Option<Axis>,
    }
}

words! {
    /// Component of a vector.
    Component {
        /// Absolute x, or the first angle.
        X = "x",
        /// Absolute y, or the second angle.
        Y = "y",
        /// Absolute z, or the third angle.
        Z = "z",
        /// The length of the vector.
        Resultant = "resultant",
    }
}

words! {
    /// A relative rotation of a joint.
    Axis {
        /// The first relative angle.
        X = "x",
        /// The second.
        Y = "y",
        /// The third.
        Z = "z",
    }
}

/// A point of an element.
#[derive(Clone, Debug)]
pub enum Point {
    /// The centre of gravity.
    Cg,
    /// In the local frame \[m\].
    At(Vec<Quantity>),
}

impl Shape for Point {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::List(_) => Vec::<Quantity>::check(at, problems),
            Kind::Map(_) => problems.add(at.problem(
                "here stands a mapping, but a point is needed",
                "write `cg`, or the coordinates in the element's frame such as `[0, 0.1]`",
            )),
            Kind::Scalar { .. } => check_word(at, &["cg"], problems),
        }
    }
}

impl<'de> Deserialize<'de> for Point {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_yaml::Value::deserialize(deserializer)?;
        if value.as_str() == Some("cg") {
            return Ok(Point::Cg);
        }
        Vec::deserialize(value)
            .map(Point::At)
            .map_err(D::Error::custom)
    }
}
