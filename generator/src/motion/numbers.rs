//! Numbers of the model as expressions: constants fold, parameters stay inputs.

use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Function, Graph, Symbol};
use crate::model::{Number, ScaledCurve};

/// The expression of a number.
pub fn number<'g>(graph: &'g Graph, number: &Number) -> Expr<'g> {
    arithmetic(graph, number, &|index| {
        graph.symbol(Symbol::Parameter(index as u32))
    })
}

/// The expression of a number whose indexed operands (for a number of the model, its parameters) are given by
/// `indexed`.
pub fn arithmetic<'g>(
    graph: &'g Graph,
    number: &Number,
    indexed: &dyn Fn(usize) -> Expr<'g>,
) -> Expr<'g> {
    let of = |n: &Number| arithmetic(graph, n, indexed);
    match number {
        Number::Constant(value) => graph.constant(*value),
        Number::Parameter(index) => indexed(*index),
        Number::OverTime { curve, .. } => {
            let time = graph.symbol(Symbol::Time);
            graph.call(Function::Curve(*curve as u32), &[time])
        }
        Number::Negative(a) => -of(a),
        Number::Sum(a, b) => of(a) + of(b),
        Number::Difference(a, b) => of(a) - of(b),
        Number::Product(a, b) => of(a) * of(b),
        Number::Quotient(a, b) => of(a) / of(b),
        Number::Smaller(a, b) => of(a).min(of(b)),
        Number::SquareRoot(a) => of(a).sqrt(),
        Number::Sine(a) => of(a).sin(),
        Number::Cosine(a) => of(a).cos(),
    }
}

/// The vector of three numbers.
pub fn vector<'g>(graph: &'g Graph, numbers: &[Number; 3]) -> Vec3<'g> {
    Vec3(std::array::from_fn(|i| number(graph, &numbers[i])))
}

/// A scaled curve at an argument.
pub fn curve<'g>(graph: &'g Graph, curve: &ScaledCurve, argument: Expr<'g>) -> Expr<'g> {
    derivative(graph, curve, Function::Curve, argument)
}

/// A derivative or an integral of a scaled curve at an argument. c(x) = times · curve(x/stretch), so its slope is
/// times/stretch · curve'(x/stretch), and so on.
pub fn derivative<'g>(
    graph: &'g Graph,
    curve: &ScaledCurve,
    function: fn(u32) -> Function,
    argument: Expr<'g>,
) -> Expr<'g> {
    let (stretch, rate) = (number(graph, &curve.stretch), rate(graph, curve));
    let function = function(curve.curve as u32);
    let factor = match function {
        Function::CurveSlope(_) => number(graph, &curve.times) * rate,
        Function::CurveSecondDerivative(_) => number(graph, &curve.times) * rate * rate,
        Function::CurveIntegral(_) => number(graph, &curve.times) * stretch,
        Function::CurveDoubleIntegral(_) => number(graph, &curve.times) * stretch * stretch,
        _ => number(graph, &curve.times),
    };
    factor * graph.call(function, &[argument * rate])
}

/// The breakpoint indicator of a scaled curve at an argument: its sign changes where the curve is not smooth.
pub fn breakpoint_indicator<'g>(
    graph: &'g Graph,
    curve: &ScaledCurve,
    argument: Expr<'g>,
) -> Expr<'g> {
    let function = Function::CurveBreakpoints(curve.curve as u32);
    graph.call(function, &[argument * rate(graph, curve)])
}

/// The factor on the argument of a scaled curve: 1/stretch.
pub fn rate<'g>(graph: &'g Graph, curve: &ScaledCurve) -> Expr<'g> {
    number(graph, &curve.stretch).recip()
}

/// The argument at which a scaled curve has this value.
pub fn inverse<'g>(graph: &'g Graph, curve: &ScaledCurve, value: Expr<'g>) -> Expr<'g> {
    let ordinate = value / number(graph, &curve.times);
    let x = graph.call(Function::CurveInverse(curve.curve as u32), &[ordinate]);
    x * number(graph, &curve.stretch)
}

/// Rx(φ₁) Ry(φ₂) Rz(φ₃), and the columns of W, with which φ̇ gives the angular velocity in absolute axes.
pub fn bryant<'g>(graph: &'g Graph, angles: [Expr<'g>; 3]) -> (Mat3<'g>, [Vec3<'g>; 3]) {
    let [(s1, c1), (s2, c2), (s3, c3)] = angles.map(|a| (a.sin(), a.cos()));
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let (s1s2, c1s2) = (s1 * s2, c1 * s2);
    let rotation = Mat3([
        [c2 * c3, -(c2 * s3), s2],
        [c1 * s3 + s1s2 * c3, c1 * c3 - s1s2 * s3, -(s1 * c2)],
        [s1 * s3 - c1s2 * c3, s1 * c3 + c1s2 * s3, c1 * c2],
    ]);
    let axes = [
        Vec3([one, zero, zero]),
        Vec3([zero, c1, s1]),
        rotation.column(2),
    ];
    (rotation, axes)
}

/// The unit quaternion (w, x, y, z) of Rx(φ₁) Ry(φ₂) Rz(φ₃).
pub fn quaternion_of_bryant(angles: [Expr<'_>; 3]) -> [Expr<'_>; 4] {
    let [(s1, c1), (s2, c2), (s3, c3)] = angles.map(|a| {
        let half = 0.5 * a;
        (half.sin(), half.cos())
    });
    [
        c1 * c2 * c3 - s1 * s2 * s3,
        s1 * c2 * c3 + c1 * s2 * s3,
        c1 * s2 * c3 - s1 * c2 * s3,
        c1 * c2 * s3 + s1 * s2 * c3,
    ]
}

/// The rotation of a unit quaternion (w, x, y, z), local → absolute.
pub fn rotation_of_quaternion<'g>(graph: &'g Graph, quaternion: [Expr<'g>; 4]) -> Mat3<'g> {
    rotation_of_scaled_quaternion(graph, quaternion, 1.0, 1.0)
}

/// `length` times the rotation of a quaternion (w, x, y, z) whose squares add up to `norm`.
pub fn rotation_of_scaled_quaternion<'g>(
    graph: &'g Graph,
    [w, x, y, z]: [Expr<'g>; 4],
    length: f64,
    norm: f64,
) -> Mat3<'g> {
    let (one, two) = (graph.constant(length), 2.0 * length / norm);
    let (x2, y2, z2) = (two * x, two * y, two * z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    Mat3([
        [one - (yy + zz), xy - wz, xz + wy],
        [xy + wz, one - (xx + zz), yz - wx],
        [xz - wy, yz + wx, one - (xx + yy)],
    ])
}

/// W⁻¹ ν with W = \[e_x, second, third\]. It gives φ̈ from α − ε, or φ̇ from ω. W is singular where cos φ₂ = 0.
pub fn inverse_rates<'g>(
    second: Vec3<'g>,
    third: Vec3<'g>,
    cosine_of_second_angle: Expr<'g>,
    nu: Vec3<'g>,
) -> [Expr<'g>; 3] {
    let [_, c1, s1] = second.0;
    let [x, y, z] = nu.0;
    let rate_3 = (c1 * z - s1 * y) / cosine_of_second_angle;
    [x - third.0[0] * rate_3, c1 * y + s1 * z, rate_3]
}

/// The time symbol.
pub(crate) fn time(graph: &Graph) -> Expr<'_> {
    graph.symbol(Symbol::Time)
}
