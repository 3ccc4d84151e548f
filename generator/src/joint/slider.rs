//! A slider: it slides along its axis a by the length θ = q + zero.
//!
//! d ← d + R a θ
//!
//! Let e = R a, and γ the acceleration of the origin minus that of the carrier's origin, when v̇ = 0. Then
//!
//! H = (e, 0),   γ ← γ + ε × e θ + ω × (ω × e θ) + 2 ω × e q̇,   work of a wrench (f, n): e · f

use crate::description::joint::{Axis, Coordinate, JointKey};
use crate::description::shape::Key;
use crate::model::FreedomKind;
use crate::model::resolve::joint::{Made, Spelling};

/// `slider: x`
pub(crate) const SPELLING: Spelling = Spelling {
    written: JointKey {
        key: Key::of::<Option<Axis>>("slider", "", "axis that it slides along"),
        keys: &[],
        handed: &[],
        coordinates: &[Coordinate::Length],
    },
    read: |reader| Some(vec![Made::new(FreedomKind::SLIDER, reader.sliding()?)]),
};
