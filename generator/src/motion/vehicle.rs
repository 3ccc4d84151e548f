//! Vehicles: bodies whose motion is given by functions of time, in closed form.
//!
//! Let φ(t) be Bryant angles, and e_j the axes with which their rates give the angular velocity:
//!
//! ω = Σ φ̇_j e_j,   α = Σ φ̈_j e_j + φ̇₁ φ̇₂ e₁ × e₂ + φ̇₃ (φ̇₁ e₁ + φ̇₂ e₂) × e₃,   p̈(ρ) = p̈ + α × ρ + ω × (ω × ρ)

use super::element::ElementMotion;
use super::numbers::{bryant, derivative, number, vector};
use super::translation;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph};
use crate::model::{FieldComponent, Vehicle};

/// The motion of a vehicle, in absolute axes.
pub struct VehicleMotion<'g> {
    /// Rotation, angular velocity, position and velocity of its origin; the bias is the whole angular acceleration.
    pub body: ElementMotion<'g>,
    /// Acceleration of its origin \[m/s²\].
    pub acceleration: Vec3<'g>,
}

impl<'g> VehicleMotion<'g> {
    /// The acceleration of the point at an offset from the origin, in absolute axes.
    pub fn acceleration_at(&self, offset: Vec3<'g>) -> Vec3<'g> {
        self.acceleration + self.body.gamma(offset)
    }
}

/// The motion at a time; without a time, position and rotation at t = 0, at rest.
pub fn motion<'g>(
    graph: &'g Graph,
    vehicle: &Vehicle,
    time: Option<Expr<'g>>,
) -> VehicleMotion<'g> {
    let zero = graph.constant(0.0);
    let mut body = ElementMotion::frame(graph);
    let (mut angles, mut rates, mut accelerations) = ([zero; 3], [zero; 3], [zero; 3]);
    match time {
        None => angles = vector(graph, &vehicle.angles_at_start).0,
        Some(time) => {
            for (i, angle) in vehicle.angles.iter().enumerate() {
                match angle {
                    FieldComponent::Constant(value) => angles[i] = number(graph, value),
                    FieldComponent::Curve(curve) => {
                        let of = |function| derivative(graph, curve, function, time);
                        angles[i] = of(Function::Curve);
                        rates[i] = of(Function::CurveSlope);
                        accelerations[i] = of(Function::CurveSecondDerivative);
                    }
                }
            }
        }
    }
    let (rotation, axes) = bryant(graph, angles);
    body.rotation = rotation;
    body.angle = angles[1];
    let before_third = rates[0] * axes[0] + rates[1] * axes[1];
    body.turns(before_third + rates[2] * axes[2]);
    let turning =
        accelerations[0] * axes[0] + accelerations[1] * axes[1] + accelerations[2] * axes[2];
    body.bias = turning
        + (rates[0] * rates[1]) * axes[0].cross(axes[1])
        + rates[2] * before_third.cross(axes[2]);
    let (x, v) = (&vehicle.position, &vehicle.velocity);
    (body.position, body.velocity) = translation::motion(graph, &vehicle.translation, x, v, time);
    let acceleration = match time {
        Some(time) => translation::acceleration(graph, &vehicle.translation, v, time),
        None => Vec3::zero(graph),
    };
    VehicleMotion { body, acceleration }
}
