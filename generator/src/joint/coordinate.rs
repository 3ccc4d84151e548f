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
    /// The default name of a degree of freedom with this kind of coordinate.
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

    /// The physical quantity of a coordinate.
    pub(crate) fn value(self) -> Expected {
        match self {
            Coordinate::Angle => ANGLE,
            Coordinate::Length => LENGTH,
        }
    }

    /// The physical quantity of its rate.
    pub(crate) fn rate(self) -> Expected {
        match self {
            Coordinate::Angle => RATE,
            Coordinate::Length => SPEED,
        }
    }

    /// The physical quantity of an inertia that resists only this rate (an armature).
    pub(crate) fn inertia(self) -> Expected {
        match self {
            Coordinate::Angle => INERTIA,
            Coordinate::Length => MASS,
        }
    }

    /// The physical quantity of the derivative of this coordinate with respect to another.
    pub(crate) fn per(self, other: Coordinate) -> Expected {
        match (self, other) {
            (Coordinate::Angle, Coordinate::Length) => ANGLE_PER_LENGTH,
            (Coordinate::Length, Coordinate::Angle) => LENGTH_PER_ANGLE,
            _ => PURE,
        }
    }
}
