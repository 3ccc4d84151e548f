//! Motors and drives of one coordinate of a joint: a torque that is given over time, or a spring and a damper to a
//! given coordinate.
//!
//! | | Q |
//! |---|---|
//! | motor | M(t) |
//! | drive | k (c(t) − θ) + d (ċ(t) − θ̇), limited to ± the largest torque |

use super::Rotation;
use crate::expression::{Expr, Function, Graph};
use crate::force::AppliedForces;
use crate::law::joint::check::Drive;
use crate::model::FieldComponent;
use crate::motion::numbers::time;
use crate::motion::numbers::{curve, derivative, number};

/// The torque of a motor.
pub fn motor<'g>(graph: &'g Graph, law: &FieldComponent) -> Expr<'g> {
    match law {
        FieldComponent::Constant(torque) => number(graph, torque),
        FieldComponent::Curve(scaled) => curve(graph, scaled, time(graph)),
    }
}

/// The torque of a drive.
pub fn drive<'g>(
    graph: &'g Graph,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    law: &Drive,
    Rotation { angle, rate, .. }: Rotation<'g>,
) -> Expr<'g> {
    let speed = match &law.to {
        FieldComponent::Constant(_) => graph.constant(0.0),
        FieldComponent::Curve(scaled) => {
            derivative(graph, scaled, Function::CurveSlope, time(graph))
        }
    };
    let mut torque = number(graph, &law.stiffness) * (motor(graph, &law.to) - angle);
    if let Some(damping) = &law.damping {
        torque = torque + number(graph, damping) * (speed - rate);
    }
    let Some(limit) = &law.limit else {
        return torque;
    };
    let limit = number(graph, limit);
    applied.kink(
        format!("{owner}: drives with its largest torque"),
        move || torque.max(-torque) - limit,
    );
    // with the operands in this order, a NaN stays a NaN
    torque.max(-limit).min(limit)
}
