//! Vehicles as written: bodies whose motion is given.

use super::curve::Function;
use super::mesh::Meshes;
use super::quantity::{OneOrThree, Quantity};
use super::shape::record;

record! {
    /// A rigid body that moves as given.
    Vehicle as "a vehicle" {
        /// Name, unique among the vehicles.
        name: String,
        /// Of its origin, from the start, per absolute axis \[m\]: 0 or a smooth curve of time.
        displacement: Option<Vec<Function>>,
        /// Of its origin, per absolute axis \[m/s\]: a number or a curve of time.
        velocity: Option<Vec<Function>>,
        /// Of its origin, per absolute axis \[m/s²\]: a number or a curve of time.
        acceleration: Option<Vec<Function>>,
        /// Whether it stays, along each axis, as soon as its velocity is 0: where the acceleration is given.
        stops: Option<bool>,
        /// Absolute angles \[rad\]: numbers or smooth curves of time.
        angles: Option<OneOrThree<Function>>,
        /// Where its origin starts.
        start: Option<Start>,
        /// How it is shown.
        mesh: Option<Meshes>,
    }
}

record! {
    /// Where a vehicle starts.
    Start as "a start of a vehicle" {
        /// Position of its origin, absolute frame \[m\].
        position: Option<Vec<Quantity>>,
        /// Velocity of its origin, absolute frame \[m/s\].
        velocity: Option<Vec<Quantity>>,
    }
}
