//! Surfaces as written: ellipsoids and planes on bodies, which meet in contacts and are drawn.

use super::measure::{Angle, Length, Positive, Pure};
use super::place::At;
use super::quantity::{Number, OneOrThree};
use super::schema::{Schema, any_of};
use super::shape::{Misfit, Problems, Shape, check_record, record, words};
use serde_yaml::Value;

record! {
    /// An ellipsoid on a body.
    Ellipsoid as "an ellipsoid" {
        /// `frame`, a vehicle, or an element as `system/element`
        on: String,
        /// centre, local frame
        center: Vec<Number<Length>>,
        /// half the extents along its own axes: `[x, z]` in the plane
        semi_axes: Vec<Number<Positive<Length>>>,
        /// Bryant angles of its axes relative to the local frame; one angle in the plane
        axes: Option<OneOrThree<Number<Angle>>> = "0",
        /// the even n of Σ (xᵢ/aᵢ)ⁿ = 1, up to 100: 2 is an ellipsoid, 4 and more are rounded boxes, the sharper the
        /// larger n is
        degree: Option<Number<Pure>> = "2",
        /// of a named surface: `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    }
}

record! {
    /// A plane on a body.
    Plane as "a plane" {
        /// `frame`, a vehicle, or an element as `system/element`
        on: String,
        /// a point of it, local frame
        at: Vec<Number<Length>>,
        /// direction to the side on which the ellipsoid should be, local frame; of any length
        normal: Vec<Number<Pure>>,
        /// in space: direction along the plane, the first of its tangents, local frame; of any length; the second is
        /// normal × first. In `extent: [a, b]`, a is half the length along the first, b along the second
        along: Option<Vec<Number<Pure>>> = "the local axis most across the normal: x, or y for a normal along x",
        /// from `at` to its edges: one half-length in the plane x–z; in space `[a, b]`, along the two tangents
        extent: Option<OneOrThree<Number<Positive<Length>>>> = "endless",
        /// what happens [there](#an-edge)
        edge: Option<Edge> = "fades over the depth",
        /// of a named surface: `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    }
}

record! {
    /// Where a plane ends.
    Edge as "an edge" {
        /// `cut` or `fade`
        rule: Option<EdgeRule> = "`fade`",
        /// for `fade`: over how much, at most the shorter half-length
        width: Option<Number<Positive<Length>>> = "the expected depth, see above",
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
    fn schema(to: &mut Schema) -> Value {
        any_of([Plane::schema(to), Ellipsoid::schema(to)])
    }

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
