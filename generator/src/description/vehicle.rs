//! Vehicles as written: bodies whose motion is given.

use super::curve::OverTime;
use super::measure::{Angle, Length, Speed};
use super::mesh::Meshes;
use super::quantity::{Number, OneOrThree};
use super::shape::{Flat, record};
use super::system::Prescribed;

record! {
    /// A rigid body that moves as given.
    Vehicle as "a vehicle" {
        /// name, unique among the vehicles and the systems
        name: String,
        /// the motion of the origin of its frame
        translation: Flat<Prescribed>,
        /// absolute: one angle in the plane, the Bryant angles `[φ1, φ2, φ3]` in space; numbers, or curves of time (s →
        /// rad) with `interpolate: cubic`
        angles: Option<OneOrThree<OverTime<Angle>>> = "0",
        /// [where it starts](#a-start-of-a-vehicle)
        start: Option<Start> = "at rest in the origin",
        /// the [meshes](#a-mesh) that it is shown with
        mesh: Option<Meshes>,
    }
}

record! {
    /// Where a vehicle starts.
    Start as "a start of a vehicle" {
        /// of the origin of its frame, absolute frame
        position: Option<Vec<Number<Length>>> = "the origin",
        /// of the origin; only if the acceleration is given, or no motion at all
        velocity: Option<Vec<Number<Speed>>> = "0",
    }
}
