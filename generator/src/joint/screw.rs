//! A screw: it turns about its axis a by the angle θ = q + zero, and slides along the axis by h θ. Its pitch is the
//! distance per full turn: h = pitch/2π.
//!
//! d ← d + R a h θ,   R ← R Rot(a, θ)
//!
//! Let e = R a, and r the vector from a point of the axis to the origin of the element. Then
//!
//! H = (h e + e × r, e), Ḣ v as for a slider by h θ, then a hinge; work of a wrench (f, n) about the origin: h e · f +
//! e · (n + r × f)

use crate::description::joint::{Axis, Coordinate, JointKey};
use crate::description::measure::{LENGTH, Length};
use crate::description::quantity::Number as WrittenNumber;
use crate::description::shape::Key;
use crate::model::resolve::joint::{Made, Spelling};
use crate::model::{FreedomKind, Number};
use std::f64::consts::TAU;

/// `screw: z, pitch: 5 mm`
pub(crate) const SPELLING: Spelling = Spelling {
    written: JointKey {
        key: Key::of::<Option<Axis>>(
            "screw",
            "",
            "in space: axis that it turns about while it slides along it",
        ),
        keys: &[Key::of::<Option<WrittenNumber<Length>>>(
            "pitch",
            "",
            "required for a screw: how far it slides in one turn; a negative pitch is left-handed",
        )],
        handed: &["pitch"],
        coordinates: &[Coordinate::Angle],
    },
    read: |reader| {
        if reader.leads_out_of_plane("write `hinge: y`, or give the model `dimension: 3`") {
            return None;
        }
        let Some(pitch) = reader.number("pitch", LENGTH) else {
            reader.problem(
                "a screw needs its pitch, the length of one turn",
                "add `pitch: 5 mm`; negative is left-handed",
            );
            return None;
        };
        let advance = Number::quotient(pitch, TAU.into());
        Some(vec![Made::new(
            FreedomKind::screw(advance),
            reader.turning()?,
        )])
    },
};
