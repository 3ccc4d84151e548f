//! Short forms as written: one entry that stands for several. [`expand`](super::expand) writes them out before serde reads,
//! so that serde meets the long form only.

use super::force::{Ellipsoid, LongAxis, Plane};
use super::place::At;
use super::shape::{Problems, Record, Shape, check_record, record};
use super::tree::Kind;
use serde::de::{Deserialize, Deserializer, Error};
use std::ops::Deref;

record! {
    /// How the names and the places of two sides correspond.
    Mirror as "a mirror" {
        /// Word in the names of the side that is written.
        from: Option<String>,
        /// Word in its place in the names of the other side.
        to: Option<String>,
        /// The axis that is reversed.
        axis: Option<LongAxis>,
    }
}

record! {
    /// A file that is read with another name for its system.
    Instance as "an instance" {
        /// The file, relative to this one.
        file: String,
        /// Name of its system here.
        system: String,
    }
}

/// A file to be read first: by its path alone, or as an instance.
#[derive(Clone, Debug)]
pub struct Include;

impl Shape for Include {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::Map(_) => check_record::<Instance>(at, problems),
            _ => String::check(at, problems),
        }
    }
}

impl<'de> Deserialize<'de> for Include {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(D::Error::custom("files are included before serde reads"))
    }
}

/// One, or a list for one entry of the long form each. Derefs to the one.
#[derive(Clone, Copy, Debug, serde::Deserialize)]
#[serde(transparent)]
pub struct Each<T>(pub T);

impl<T> Deref for Each<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: Shape> Shape for Each<T> {
    fn check(at: At<'_>, problems: &Problems) {
        let Kind::List(items) = &at.node.kind else {
            return T::check(at, problems);
        };
        if items.is_empty() {
            problems.add(at.problem("the list is empty", "name at least one"));
        }
        Vec::<T>::check(at, problems);
    }
}

/// A surface in place, the name of one, or a list of names. Derefs to the surface.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(transparent)]
pub struct ByName<R>(pub R);

impl<R> Deref for ByName<R> {
    type Target = R;
    fn deref(&self) -> &R {
        &self.0
    }
}

impl<R: Record> Shape for ByName<R> {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::Map(_) => check_record::<R>(at, problems),
            _ => Each::<String>::check(at, problems),
        }
    }
}

/// A named surface.
#[derive(Clone, Debug)]
pub enum Surface {
    /// An ellipsoid.
    Ellipsoid(Ellipsoid),
    /// A plane.
    Plane(Plane),
}

impl Shape for Surface {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.get("normal") {
            Some(_) => check_record::<Plane>(at, problems),
            None => check_record::<Ellipsoid>(at, problems),
        }
    }
}

impl<'de> Deserialize<'de> for Surface {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_yaml::Value::deserialize(deserializer)?;
        match value.get("normal") {
            Some(_) => Plane::deserialize(value).map(Surface::Plane),
            None => Ellipsoid::deserialize(value).map(Surface::Ellipsoid),
        }
        .map_err(D::Error::custom)
    }
}
