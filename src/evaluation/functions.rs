//! The functions that the graph of a model calls, for plain numbers. They are here because evaluation without
//! compilation needs both the generator and the runtime, which do not know each other.

use bryant_engine::UserFunctions;
use bryant_generator::expression::{ApproachCall, Function, UserCall};
use bryant_generator::model::{Curve, Extrapolate, Interpolate, Model};
use bryant_runtime::Real;
use bryant_runtime::curve as runtime;
use bryant_runtime::force::approach::{plane, space};
use bryant_runtime::force::{ellipsoid, power, switch};

/// The functions of a model that are not algebra, for plain numbers; a user function returns NaN.
pub fn functions(model: &Model) -> impl Fn(Function, &[f64]) -> f64 + '_ {
    functions_with(model, None)
}

/// The functions of a model that are not algebra, for plain numbers. `users` has the user functions; without it they
/// return NaN.
pub fn functions_with<'a>(
    model: &'a Model,
    users: Option<&'a dyn UserFunctions>,
) -> impl Fn(Function, &[f64]) -> f64 + 'a {
    let curve = |index: u32| &model.curves[index as usize];
    move |function, a| match function {
        Function::Curve(index) => curve(index).value(a[0]),
        Function::CurveSlope(index) => curve(index).slope(a[0]),
        Function::CurveSecondDerivative(index) => curve(index).second_derivative(a[0]),
        Function::CurveInverse(index) => curve(index).inverse(a[0]),
        Function::CurveIntegral(index) => curve(index).integral(a[0]),
        Function::CurveDoubleIntegral(index) => curve(index).double_integral(a[0]),
        Function::CurveBreakpoints(index) => curve(index).breakpoint_indicator(a[0]),
        Function::CurveStop(index) => stop(curve(index), a[0], a[1]),
        Function::Power => power::power(a[0], a[1]),
        Function::Choose => switch::choose(a[0], a[1], a[2], a[3]),
        Function::User(call) => users.map_or(f64::NAN, |users| user(users, call, a)),
        Function::Approach(call) => approach(call, a),
        Function::Support(part) => ellipsoid::support(a[0], a[1], a[2], a[3])[usize::from(part)],
    }
}

/// The first x > 0 for which velocity + factor · ∫₀ˣ curve is 0; 0 if there is none. The runtime searches it.
pub(crate) fn stop(curve: &Curve, velocity: f64, factor: f64) -> f64 {
    let beyond = match curve.extrapolate {
        Extrapolate::Linear => runtime::Extrapolate::Linear,
        Extrapolate::Hold => runtime::Extrapolate::Hold,
        Extrapolate::Error => runtime::Extrapolate::Error,
    };
    let table = match curve.interpolate {
        Interpolate::Linear => runtime::Table::of_lines(&curve.points, beyond),
        Interpolate::Cubic => {
            let points = curve.points.iter().enumerate();
            let given: Vec<[f64; 3]> = points
                .map(|(k, &[x, y])| [x, y, curve.tangent(k)])
                .collect();
            runtime::Table::of_cubics(&given, beyond)
        }
    };
    table.stop(velocity, factor)
}

/// Result `call.part` of a user function.
fn user(users: &dyn UserFunctions, call: UserCall, a: &[f64]) -> f64 {
    let mut results = vec![f64::NAN; usize::from(call.parts)];
    if let Some(form) = f64::FORM {
        users.call(call.force.into(), form, a, &mut results);
    }
    results[usize::from(call.part)]
}

/// Result `call.part` of the approach of two ellipsoids.
fn approach(call: ApproachCall, a: &[f64]) -> f64 {
    let part = usize::from(call.part);
    if call.planar {
        let of = match call.early {
            true => plane::touch,
            false => plane::approach,
        };
        return of(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7])[part];
    }
    let of = match call.early {
        true => space::touch,
        false => space::approach,
    };
    of(
        a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13],
        a[14],
    )[part]
}
