//! Prescribed translations in closed form.
//!
//! | given | x − x₀ | ẋ | ẍ |
//! |---|---|---|---|
//! | displacement c | c | c' | c'' |
//! | velocity c | v₀ t + ∫ c | v₀ + c | c' |
//! | acceleration c | v₀ t + ∬ c | v₀ + ∫ c | c |
//!
//! A motion that stops follows the last row until t = T, when v₀ + ∫ c first reaches 0. From then on x is x(T), and ẋ
//! and ẍ are 0. T and x(T) depend on parameters alone. t/T is the abscissa of a curve, so T is one of the times at
//! which curves of time have kinks.

use super::numbers::{derivative, number, vector};
use crate::expression::choose;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph};
use crate::model::{Given, Number, ScaledCurve, Translation};

use Function::{
    Curve, CurveDoubleIntegral, CurveIntegral, CurveSecondDerivative, CurveSlope, CurveStop,
};

/// Position and velocity at a time; without a time, those at the start of a run: x₀ and v₀.
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
    let start = position;
    position = position + time * velocity;
    for (i, curve) in translation.curves.iter().enumerate() {
        if let Some(curve) = curve {
            let speed = velocity.0[i];
            let [moved, rate] = functions.map(|f| derivative(graph, curve, f, time));
            position.0[i] = position.0[i] + moved;
            velocity.0[i] = velocity.0[i] + rate;
            if let Some(stops) = &translation.stops {
                let stop = Stop::of(graph, stops, curve, speed, time);
                let way = stop.time * speed + stop.gained;
                position.0[i] = stop.choose(position.0[i], start.0[i] + way);
                velocity.0[i] = stop.choose(velocity.0[i], graph.constant(0.0));
            }
        }
    }
    (position, velocity)
}

/// The acceleration at a time; `velocity` is v₀.
pub fn acceleration<'g>(
    graph: &'g Graph,
    translation: &Translation,
    velocity: &[Number; 3],
    time: Expr<'g>,
) -> Vec3<'g> {
    let function = match translation.given {
        Given::Displacement => CurveSecondDerivative,
        Given::Velocity => CurveSlope,
        Given::Acceleration => Curve,
    };
    let zero = graph.constant(0.0);
    let component = |curve: &ScaledCurve, velocity: &Number| {
        let moving = derivative(graph, curve, function, time);
        let Some(stops) = &translation.stops else {
            return moving;
        };
        let stop = Stop::of(graph, stops, curve, number(graph, velocity), time);
        stop.choose(moving, zero)
    };
    Vec3(std::array::from_fn(|i| {
        let curve = translation.curves[i].as_ref();
        curve.map_or(zero, |curve| component(curve, &velocity[i]))
    }))
}

/// The end of a motion along an axis.
struct Stop<'g> {
    /// T \[s\]; 0 if the motion never ends.
    time: Expr<'g>,
    /// ∬ of the acceleration up to T \[m\].
    gained: Expr<'g>,
    /// t/T up to 1, then 1; 0 if the motion never ends.
    over: Expr<'g>,
}

impl<'g> Stop<'g> {
    /// The end of a motion that begins with a velocity.
    fn of(
        graph: &'g Graph,
        stops: &ScaledCurve,
        curve: &ScaledCurve,
        velocity: Expr<'g>,
        time: Expr<'g>,
    ) -> Self {
        let (stretch, times) = (number(graph, &curve.stretch), number(graph, &curve.times));
        let factor = times * stretch;
        let at = graph.call(CurveStop(curve.curve as u32), &[velocity, factor]);
        let gained = graph.call(CurveDoubleIntegral(curve.curve as u32), &[at]);
        let end = at * stretch;
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        // both values of a choice must be finite, so an end at 0 is replaced by 1
        let some_end = choose(zero, end, end, one);
        let rate = choose(zero, end, some_end.recip(), zero);
        Stop {
            time: end,
            gained: factor * stretch * gained,
            over: graph.call(Curve(stops.curve as u32), &[time * rate]),
        }
    }

    /// The first value while the axis moves, the second from the end on.
    fn choose(&self, moving: Expr<'g>, at_rest: Expr<'g>) -> Expr<'g> {
        choose(self.over, moving.graph().constant(1.0), moving, at_rest)
    }
}
