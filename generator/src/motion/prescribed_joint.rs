//! A reference joint that does not move freely: it is at rest, has a prescribed motion, or rides on a vehicle. It has
//! no coordinate.
//!
//! | reference joint | p | p̈ |
//! |---|---|---|
//! | fixed | x₀ | 0 |
//! | prescribed | [x(t)](crate::model::Translation) | ẍ(t) |
//! | riding at s on a vehicle | x + A s | ẍ + α × A s + ω × (ω × A s) |
//!
//! The acceleration p̈ acts on the system as the field −p̈.

use super::numbers::time;
use super::numbers::vector;
use super::translation;
use super::vehicle::VehicleMotion;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::model::{Reference, System};

/// Position and velocity of a reference joint that is not free; at the start if no time is given.
pub(crate) fn motion<'g>(
    graph: &'g Graph,
    system: &System,
    vehicles: &[VehicleMotion<'g>],
    time: Option<Expr<'g>>,
) -> (Vec3<'g>, Vec3<'g>) {
    match &system.reference {
        Reference::Riding { vehicle, at } => {
            let body = &vehicles[*vehicle].body;
            let offset = body.rotation.times(vector(graph, at));
            (body.position + offset, body.velocity_at(offset))
        }
        Reference::Prescribed(translation) => {
            translation::motion(graph, translation, &system.position, &system.velocity, time)
        }
        Reference::Free | Reference::Fixed => (vector(graph, &system.position), Vec3::zero(graph)),
    }
}

/// Acceleration of a reference joint that is not free.
pub(crate) fn acceleration<'g>(
    graph: &'g Graph,
    system: &System,
    vehicles: &[VehicleMotion<'g>],
) -> Vec3<'g> {
    match &system.reference {
        Reference::Prescribed(translation) => {
            translation::acceleration(graph, translation, &system.velocity, time(graph))
        }
        Reference::Riding { vehicle, at } => {
            let vehicle = &vehicles[*vehicle];
            vehicle.acceleration_at(vehicle.body.rotation.times(vector(graph, at)))
        }
        Reference::Free | Reference::Fixed => Vec3::zero(graph),
    }
}
