//! The units in which outputs are shown. All computations are in SI.

use crate::description::unit::{STANDARD_GRAVITY, whole_power};
use serde::{Deserialize, Serialize};

/// A system of units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnitSystem {
    /// m, N, rad, s, …
    #[default]
    Si,
    /// The units of crash tests and workshops: mm, g, kN, °, °/s, kPa, ms.
    Engineering,
}

/// A unit in which a number is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unit {
    /// As files have it: `g`, `mm`, `deg`, `N*m`; "" for a pure number.
    #[serde(rename = "unit")]
    pub name: String,
    /// The SI value of one unit.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub size: f64,
}

fn one() -> f64 {
    1.0
}

fn is_one(size: &f64) -> bool {
    *size == 1.0
}

/// The units of a scene's outputs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    /// The system of outputs without a unit of their own, and of times.
    pub system: UnitSystem,
    /// The outputs with a unit of their own, by name.
    pub own: Vec<(String, Unit)>,
}

impl UnitSystem {
    /// The names of all systems, as in models and on the command line.
    pub const NAMES: [&str; 2] = ["SI", "engineering"];

    /// The system of this name, one of [`UnitSystem::NAMES`].
    pub fn named(name: &str) -> Option<UnitSystem> {
        match name {
            "SI" => Some(UnitSystem::Si),
            "engineering" => Some(UnitSystem::Engineering),
            _ => None,
        }
    }

    /// The unit for quantities of this SI unit.
    pub fn unit(self, si: &str) -> Unit {
        let (name, size) = match (self, si) {
            (UnitSystem::Si, si) => (si, 1.0),
            (UnitSystem::Engineering, "m/s^2") => ("g", STANDARD_GRAVITY),
            (UnitSystem::Engineering, "m") => ("mm", whole_power(10.0, -3)),
            (UnitSystem::Engineering, "N") => ("kN", 1e3),
            (UnitSystem::Engineering, "rad") => ("deg", std::f64::consts::PI / 180.0),
            (UnitSystem::Engineering, "rad/s") => ("deg/s", std::f64::consts::PI / 180.0),
            (UnitSystem::Engineering, "Pa") => ("kPa", 1e3),
            (UnitSystem::Engineering, "s") => ("ms", whole_power(10.0, -3)),
            (UnitSystem::Engineering, si) => (si, 1.0),
        };
        Unit {
            name: name.to_owned(),
            size,
        }
    }
}

impl Unit {
    /// Converts an SI value to this unit.
    pub fn of_si(&self, value: f64) -> f64 {
        // keeps all digits of SI values
        match self.size {
            1.0 => value,
            size => value / size,
        }
    }
}
