//! Given translations in closed form.
//!
//! | given | x − x₀ | ẋ | ẍ |
//! |---|---|---|---|
//! | displacement c | c | c' | c'' |
//! | velocity c | v₀ t + ∫ c | v₀ + c | c' |
//! | acceleration c | v₀ t + ∬ c | v₀ + ∫ c | c |

use super::numbers::{derivative, vector};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph};
use crate::model::{Given, Number, ScaledCurve, Translation};

use Function::{Curve, CurveDoubleIntegral, CurveIntegral, CurveSecondDerivative, CurveSlope};

/// Position and velocity at a time; where a run starts, at no time, the position x₀, and v₀.
pub fn motion<'g>(
    graph: &'g Graph,
    translation: &Translation,
    position: &[Number; 3],
    velocity: &[Number; 3],
    time: Option<Expr<'g>>,
) -> (Vec3<'g>, Vec3<'g>) {
    let (mut position, mut velocity) = (vector(graph, position), vector(graph, velocity));
    let Some(time) = time else {
        return (position, velocity);
    };
    let functions: [fn(u32) -> Function; 2] = match translation.given {
        Given::Displacement => [Curve, CurveSlope],
        Given::Velocity => [CurveIntegral, Curve],
        Given::Acceleration => [CurveDoubleIntegral, CurveIntegral],
    };
    position = position + time * velocity;
    for (i, curve) in translation.curves.iter().enumerate() {
        if let Some(curve) = curve {
            let [moved, rate] = functions.map(|f| derivative(graph, curve, f, time));
            position.0[i] = position.0[i] + moved;
            velocity.0[i] = velocity.0[i] + rate;
        }
    }
    (position, velocity)
}

/// Acceleration at a time.
pub fn acceleration<'g>(graph: &'g Graph, translation: &Translation, time: Expr<'g>) -> Vec3<'g> {
    let function = match translation.given {
        Given::Displacement => CurveSecondDerivative,
        Given::Velocity => CurveSlope,
        Given::Acceleration => Curve,
    };
    let component = |curve: &ScaledCurve| derivative(graph, curve, function, time);
    let zero = graph.constant(0.0);
    Vec3(std::array::from_fn(|i| {
        translation.curves[i].as_ref().map_or(zero, component)
    }))
}
