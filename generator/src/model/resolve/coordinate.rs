//! The physical quantities that belong to the coordinate of a freedom.

use crate::description::joint::Coordinate;
use crate::description::measure::{
    ANGLE, ANGLE_PER_LENGTH, Expected, INERTIA, LENGTH, LENGTH_PER_ANGLE, MASS, PURE, RATE, SPEED,
};

impl Coordinate {
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
