//! A hinge: it turns about its axis a by θ = q + zero, an angle.
//!
//! R ← R Rot(a, θ)
//!
//! Let e = R a, and r the vector from a point of the axis to the origin of the element. Then
//!
//! H = (e × r, e),   ε ← ε + ω × e q̇,   work of a wrench (f, n) about the origin: H · (f, n) = e · (n + r × f)

use super::written::{Made, Spelling, Word, key};
use super::{Coordinate, Joint, Kind};
use crate::description::joint::Axis;
use crate::model::Number;
use serde::Serialize;

/// A degree of freedom that turns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hinge;

/// `hinge: y`
pub(crate) const SPELLING: Spelling = Spelling {
    key: key::<Axis>("hinge"),
    keys: &[],
    handed: &[],
    coordinates: &[Coordinate::Angle],
    read: |reader| Some(vec![Made::new(Hinge, reader.turning()?)]),
};

/// `joint: hinge` in the plane: like a [ball](super::ball) in space, with an absolute orientation.
pub(crate) const WORD: Word = Word {
    word: "hinge",
    has_axes: false,
    joint: |resolver, at| {
        if !resolver.planar {
            resolver.problems.add(at.problem(
                "in space a hinge needs an axis",
                "write `joint: { hinge: y }`, with the axis in the frame of the carrier",
            ));
        }
        Joint::Ball
    },
};

impl Kind for Hinge {
    fn coordinate(&self) -> Coordinate {
        Coordinate::Angle
    }

    fn advance(&self) -> Option<Number> {
        None
    }
}
