//! A hinge: it turns about its axis a by θ = q + zero, an angle.
//!
//! R ← R Rot(a, θ)
//!
//! Let e = R a, and r the vector from a point of the axis to the origin of the element. Then
//!
//! H = (e × r, e),   ε ← ε + ω × e q̇,   work of a wrench (f, n) about the origin: H · (f, n) = e · (n + r × f)

use crate::description::joint::{Axis, Coordinate, JointKey, JointWord};
use crate::description::shape::Key;
use crate::model::FreedomKind;
use crate::model::Joint;
use crate::model::resolve::joint::{Made, Spelling, Word};

/// `hinge: y`
pub(crate) const SPELLING: Spelling = Spelling {
    written: JointKey {
        key: Key::of::<Option<Axis>>("hinge", "", "axis that the element turns about"),
        keys: &[],
        handed: &[],
        coordinates: &[Coordinate::Angle],
    },
    read: |reader| Some(vec![Made::new(FreedomKind::HINGE, reader.turning()?)]),
};

/// `joint: hinge` in the plane: like a [ball](super::ball) in space, with an absolute orientation.
pub(crate) const WORD: Word = Word {
    written: JointWord {
        word: "hinge",
        has_axes: false,
    },
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
