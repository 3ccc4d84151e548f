//! What the coordinate of a freedom is: an angle, or a length.

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
    /// Name of a freedom that has no other.
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

    /// What a value of it is.
    pub(crate) fn value(self) -> Expected {
        match self {
            Coordinate::Angle => ANGLE,
            Coordinate::Length => LENGTH,
        }
    }

    /// What a rate of it is.
    pub(crate) fn rate(self) -> Expected {
        match self {
            Coordinate::Angle => RATE,
            Coordinate::Length => SPEED,
        }
    }

    /// What the inertia is that resists its rate alone.
    pub(crate) fn inertia(self) -> Expected {
        match self {
            Coordinate::Angle => INERTIA,
            Coordinate::Length => MASS,
        }
    }

    /// What its change per change of another coordinate is.
    pub(crate) fn per(self, other: Coordinate) -> Expected {
        match (self, other) {
            (Coordinate::Angle, Coordinate::Length) => ANGLE_PER_LENGTH,
            (Coordinate::Length, Coordinate::Angle) => LENGTH_PER_ANGLE,
            _ => PURE,
        }
    }
}
