//! Surfaces as written: ellipsoids and planes on bodies, which meet in contacts and are drawn.

use super::place::At;
use super::quantity::{OneOrThree, Quantity};
use super::shape::{Misfit, Problems, Shape, check_record, record, words};
use serde_yaml::Value;

record! {
    /// An ellipsoid on a body.
    Ellipsoid as "an ellipsoid" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// Centre, local frame \[m\].
        center: Vec<Quantity>,
        /// Semi-axes \[m\].
        semi_axes: Vec<Quantity>,
        /// Bryant angles of its axes relative to the local frame \[rad\].
        axes: Option<OneOrThree>,
        /// Even exponent of its equation.
        degree: Option<Quantity>,
        /// Of a named surface: whether it has a mirror image.
        mirror: Option<bool>,
    }
}

record! {
    /// A plane on a body.
    Plane as "a plane" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// A point of it, local frame \[m\].
        at: Vec<Quantity>,
        /// Direction to the side of the ellipsoid, local frame; of any length.
        normal: Vec<Quantity>,
        /// In space: direction of its first edge, local frame; of any length.
        along: Option<Vec<Quantity>>,
        /// Half its lengths \[m\]: one in the plane, two in space.
        extent: Option<OneOrThree>,
        /// What happens where it ends.
        edge: Option<Edge>,
        /// Of a named surface: whether it has a mirror image.
        mirror: Option<bool>,
    }
}

record! {
    /// Where a plane ends.
    Edge as "an edge" {
        /// What becomes of the force there.
        rule: Option<EdgeRule>,
        /// Width over which it fades \[m\].
        width: Option<Quantity>,
    }
}

words! {
    /// What becomes of a contact's force at an edge.
    EdgeRule {
        /// It ends.
        Cut = "cut",
        /// It fades.
        Fade = "fade",
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

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.get("normal") {
            Some(_) => Plane::read(value).map(Surface::Plane),
            None => Ellipsoid::read(value).map(Surface::Ellipsoid),
        }
    }
}
