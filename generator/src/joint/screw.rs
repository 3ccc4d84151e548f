//! A screw: it turns about its axis a by the angle θ = q + zero, and slides along the axis by h θ. Its pitch is the
//! distance per full turn: h = pitch/2π.
//!
//! d ← d + R a h θ,   R ← R Rot(a, θ)
//!
//! Let e = R a, and r the vector from a point of the axis to the origin of the element. Then
//!
//! H = (h e + e × r, e),   Ḣ v as for a slider by h θ, then a hinge;   work of a wrench (f, n) about the origin: h e · f + e · (n + r × f)

use super::written::{Made, Spelling, key};
use super::{Coordinate, Kind};
use crate::description::joint::Axis;
use crate::description::quantity::Quantity;
use crate::model::Number;
use crate::model::resolve::quantity::LENGTH;
use serde::Serialize;
use std::f64::consts::TAU;

/// A degree of freedom that turns, and slides by this distance per angle \[m/rad\].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Screw(pub Number);

/// `screw: z, pitch: 5 mm`
pub(crate) const SPELLING: Spelling = Spelling {
    key: key::<Axis>("screw"),
    keys: &[key::<Quantity>("pitch")],
    handed: &["pitch"],
    coordinates: &[Coordinate::Angle],
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
        Some(vec![Made::new(Screw(advance), reader.turning()?)])
    },
};

impl Kind for Screw {
    fn coordinate(&self) -> Coordinate {
        Coordinate::Angle
    }

    fn advance(&self) -> Option<Number> {
        Some(self.0.clone())
    }

    fn numbers_mut(&mut self) -> Vec<&mut Number> {
        vec![&mut self.0]
    }
}
