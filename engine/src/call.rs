//! The functions that lists call: curves, force laws, functions of the user.

use crate::info::extrapolate;
use crate::user::UserFunctions;
use bryant_generator::expression::{ApproachCall, Function, UserCall};
use bryant_generator::program::Curve;
use bryant_runtime::curve::Table;
use bryant_runtime::force::approach::{plane, space};
use bryant_runtime::force::{ellipsoid, power, switch};
use bryant_runtime::{Real, Task};
use std::sync::Arc;

/// All functions that the lists of one model call.
#[derive(Debug)]
pub struct Library {
    curves: Vec<Table>,
    /// The functions of the user; `None` if the model calls none.
    users: Option<Arc<dyn UserFunctions>>,
}

/// A curve as the runtime evaluates it.
pub fn table(curve: &Curve) -> Table {
    let beyond = extrapolate(curve.extrapolate);
    match &curve.tangents {
        None => Table::of_lines(&curve.points, beyond),
        Some(tangents) => {
            let points = curve.points.iter().zip(tangents);
            let given: Vec<[f64; 3]> = points.map(|(&[x, y], &m)| [x, y, m]).collect();
            Table::of_cubics(&given, beyond)
        }
    }
}

impl Library {
    /// The functions of a model with these curves. A function of the user gives NaN if there are no `users`.
    pub fn new(curves: &[Curve], users: Option<Arc<dyn UserFunctions>>) -> Self {
        Library {
            curves: curves.iter().map(table).collect(),
            users,
        }
    }

    pub(crate) fn curve(&self, index: u32) -> &Table {
        &self.curves[index as usize]
    }

    /// Calls a function and writes all its results, in order. The function is compiled for each scalar, with the
    /// instructions that the scalar needs.
    #[inline(never)]
    pub fn call<T: Real>(&self, function: Function, arguments: &[T], results: &mut [T]) {
        T::dispatch(Call {
            library: self,
            function,
            arguments,
            results,
        });
    }

    #[inline(always)]
    fn called<T: Real>(&self, function: Function, a: &[T], results: &mut [T]) {
        let curve = |index: u32| &self.curves[index as usize];
        results[0] = match function {
            Function::Curve(index) => curve(index).value(a[0]),
            Function::CurveSlope(index) => curve(index).slope(a[0]),
            Function::CurveSecondDerivative(index) => curve(index).second_derivative(a[0]),
            Function::CurveInverse(index) => curve(index).inverse(a[0]),
            Function::CurveIntegral(index) => curve(index).integral(a[0]),
            Function::CurveDoubleIntegral(index) => curve(index).double_integral(a[0]),
            Function::CurveBreakpoints(index) => curve(index).breakpoint_indicator(a[0]),
            Function::CurveStop(index) => curve(index).stop(a[0], a[1]),
            Function::Power => power::power(a[0], a[1]),
            Function::Choose => switch::choose(a[0], a[1], a[2], a[3]),
            Function::User(UserCall { force, .. }) => {
                return match &self.users {
                    Some(users) => users.call_over(force.into(), a, results),
                    None => results.fill(T::from_f64(f64::NAN)),
                };
            }
            Function::Approach(call) => return approach(call, a, results),
            Function::Support(_) => {
                let found = ellipsoid::support(a[0], a[1], a[2], a[3]);
                return results.copy_from_slice(&found);
            }
        };
    }
}

/// The functions of a model with these curves, for plain numbers; a function of the user gives NaN.
pub fn functions(curves: &[Curve]) -> impl Fn(Function, &[f64]) -> f64 + use<> {
    let library = Library::new(curves, None);
    move |function, arguments| {
        let (part, parts) = function.part().unwrap_or((0, 1));
        let mut results = vec![f64::NAN; parts];
        library.call(function, arguments, &mut results);
        results[part]
    }
}

/// A call of a function as a task.
struct Call<'a, T> {
    library: &'a Library,
    function: Function,
    arguments: &'a [T],
    results: &'a mut [T],
}

impl<T: Real> Task for Call<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.library
            .called(self.function, self.arguments, self.results);
    }
}

/// (sin, cos) as a task.
struct SinCos<T>(T);

impl<T: Real> Task for SinCos<T> {
    type Output = (T, T);
    #[inline(always)]
    fn run(self) -> (T, T) {
        self.0.sin_cos()
    }
}

/// (sin, cos), compiled for each scalar, with the instructions that the scalar needs.
#[inline]
pub fn sin_cos<T: Real>(angle: T) -> (T, T) {
    T::dispatch_apart(SinCos(angle))
}

/// `atan2` as a task.
pub struct Atan2<T>(pub T, pub T);

impl<T: Real> Task for Atan2<T> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        self.0.atan2(self.1)
    }
}

/// The angle of the point (`x`, `y`), compiled like [`sin_cos`].
#[inline]
pub fn atan2<T: Real>(y: T, x: T) -> T {
    T::dispatch_apart(Atan2(y, x))
}

/// The nearest points of two ellipsoids.
#[inline(always)]
pub(crate) fn approach<T: Real>(call: ApproachCall, a: &[T], results: &mut [T]) {
    if call.planar {
        let found = match call.early {
            true => plane::touch(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]),
            false => plane::approach(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]),
        };
        results.copy_from_slice(&found);
        return;
    }
    let found = match call.early {
        true => space::touch(
            a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13],
            a[14],
        ),
        false => space::approach(
            a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13],
            a[14],
        ),
    };
    results.copy_from_slice(&found);
}
