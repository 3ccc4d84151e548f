//! The kind of coordinate of a degree of freedom: an angle or a length.

use crate::model::resolve::quantity::{
    ANGLE, ANGLE_PER_LENGTH, Expected, INERTIA, LENGTH, LENGTH_PER_ANGLE, MASS, PURE, RATE, SPEED,
};

/// An angle, or a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// \[rad\]
    Angle,
    /// \[m\]
    Length,
}

impl Coordinate {
    /// The name of a degree of freedom that has no other.
    pub fn name(self) -> &'static str {
        match self {
            Coordinate::Angle => "angle",
            Coordinate::Length => "position",
        }
    }

    /// SI units of the coordinate and of its rate.
    pub fn units(self) -> [&'static str; 2] {
        match self {
            Coordinate::Angle => ["rad", "rad/s"],
            Coordinate::Length => ["m", "m/s"],
        }
    }

    /// The quantity of a value.
    pub(crate) fn value(self) -> Expected {
        match self {
            Coordinate::Angle => ANGLE,
            Coordinate::Length => LENGTH,
        }
    }

    /// The quantity of a rate.
    pub(crate) fn rate(self) -> Expected {
        match self {
            Coordinate::Angle => RATE,
            Coordinate::Length => SPEED,
        }
    }

    /// The quantity of the inertia that resists its rate alone.
    pub(crate) fn inertia(self) -> Expected {
        match self {
            Coordinate::Angle => INERTIA,
            Coordinate::Length => MASS,
        }
    }

    /// The quantity of its derivative with respect to another coordinate.
    pub(crate) fn per(self, other: Coordinate) -> Expected {
        match (self, other) {
            (Coordinate::Angle, Coordinate::Length) => ANGLE_PER_LENGTH,
            (Coordinate::Length, Coordinate::Angle) => LENGTH_PER_ANGLE,
            _ => PURE,
        }
    }
}
