//! A slider: it slides along its axis a by the length θ = q + zero.
//!
//! d ← d + R a θ
//!
//! Let e = R a, and γ the acceleration of the origin minus that of the carrier's origin, when v̇ = 0. Then
//!
//! H = (e, 0),   γ ← γ + ε × e θ + ω × (ω × e θ) + 2 ω × e q̇,   work of a wrench (f, n): e · f

use super::written::{Made, Spelling, key};
use super::{Coordinate, Kind};
use crate::description::joint::Axis;
use crate::model::Number;
use serde::Serialize;

/// A degree of freedom that slides.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Slider;

/// `slider: x`
pub(crate) const SPELLING: Spelling = Spelling {
    key: key::<Axis>("slider"),
    keys: &[],
    handed: &[],
    coordinates: &[Coordinate::Length],
    read: |reader| Some(vec![Made::new(Slider, reader.sliding()?)]),
};

impl Kind for Slider {
    fn coordinate(&self) -> Coordinate {
        Coordinate::Length
    }

    fn advance(&self) -> Option<Number> {
        Some(Number::Constant(1.0))
    }
}
