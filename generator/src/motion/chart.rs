//! Two charts of Bryant angles, so that no orientation is singular: A = R(φ) P_c, where c is the chart of the element,
//! 0 or 1.
//!
//! P₀ = 1,   P₁ = Ry(−90°)   ⇒   sin φ₂ = a₁₃ in chart 0, a₁₁ in chart 1
//!
//! Bryant angles are singular where sin φ₂ = ±1. A row of a rotation has the length 1. So if |sin φ₂| exceeds [`LIMIT`]
//! in one chart, it is at most √(1 − LIMIT²) in the other. P₁ is constant in the element, so ω = W(φ) φ̇ is the same
//! function in both charts, and so is everything that follows from ω. Only where A is used, the columns of R have
//! another order.
//!
//! The chart is a discrete state, constant during a step, so all stages of a step, its error and its interpolant use
//! one chart. After an accepted step, [`changed`] gives the new φ, φ̇ and c of an element.

use super::numbers::bryant;
use super::numbers::inverse_rates;
use crate::expression::choose;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};

/// The |sin φ₂| beyond which the chart changes. It is then at most 0.6 in the new chart, so a body turns by at least
/// 16° before the chart changes again. Rates are divided by cos φ₂, which is never below 0.6 where a step begins.
pub const LIMIT: f64 = 0.8;

/// Angles, their rates, and their chart.
pub struct Charted<'g> {
    /// φ \[rad\]
    pub angles: [Expr<'g>; 3],
    /// φ̇ \[rad/s\]
    pub rates: [Expr<'g>; 3],
    /// c, 0 or 1
    pub chart: Expr<'g>,
}

/// A = R P_c.
pub fn rotation<'g>(r: &Mat3<'g>, chart: Expr<'g>) -> Mat3<'g> {
    Mat3(r.0.map(|[x, y, z]| [in_second(chart, z, x), y, in_second(chart, -x, z)]))
}

/// `then` in chart 1, `otherwise` in chart 0.
fn in_second<'g>(chart: Expr<'g>, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
    choose(chart.graph().constant(0.5), chart, then, otherwise)
}

/// `then` if the second angle is too near to ±90° for its chart, `otherwise` elsewhere.
fn near_pole<'g>(second: Expr<'g>, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
    let limit = second.graph().constant(LIMIT * LIMIT);
    choose(limit, second.sin().squared(), then, otherwise)
}

/// The angles, rates and chart at the start, for an orientation that is given by Bryant angles in chart 0 and turns
/// with ω (absolute axes). The chart is the one in which the angles are not near ±90°.
pub fn start<'g>(graph: &'g Graph, angles: [Expr<'g>; 3], omega: Vec3<'g>) -> Charted<'g> {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let (r, [_, second, third]) = bryant(graph, angles);
    let cosine = near_pole(angles[1], one, angles[1].cos());
    let charted = Charted {
        angles,
        rates: inverse_rates(second, third, cosine, omega),
        chart: zero,
    };
    changed(&charted, &r, omega)
}

/// The same orientation and angular velocity, in the other chart if the second angle is too near to ±90°, otherwise
/// unchanged; `r` is R(φ).
///
/// R' = A P'ᵀ has the columns (−r₃, r₂, r₁) of R where the chart was 0, and (r₃, r₂, −r₁) where it was 1.
pub fn changed<'g>(charted: &Charted<'g>, r: &Mat3<'g>, omega: Vec3<'g>) -> Charted<'g> {
    let graph = charted.chart.graph();
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let second = charted.angles[1];
    let [[r11, r12, r13], [r21, ..], [r31, ..]] = r.0;
    let sign = in_second(charted.chart, -one, one);

    let first_row = [-(sign * r13), r12];
    let third = Vec3([sign * r11, sign * r21, sign * r31]);
    let cosine = (r13.squared() + r12.squared()).sqrt();
    let [s2, minus_s1_c2, c1_c2] = third.0;
    let angles = [
        (-minus_s1_c2).atan2(c1_c2),
        s2.atan2(cosine),
        (-first_row[1]).atan2(first_row[0]),
    ];
    // the other chart may be singular in states where it is not chosen; the divisor 1 keeps its values finite there
    let divisor = near_pole(second, cosine, one);
    let second_axis = Vec3([zero, c1_c2 / divisor, -minus_s1_c2 / divisor]);
    let rates = inverse_rates(second_axis, third, divisor, omega);

    let select = |then: [Expr<'g>; 3], otherwise: [Expr<'g>; 3]| -> [Expr<'g>; 3] {
        std::array::from_fn(|i| near_pole(second, then[i], otherwise[i]))
    };
    Charted {
        angles: select(angles, charted.angles),
        rates: select(rates, charted.rates),
        chart: near_pole(second, in_second(charted.chart, zero, one), charted.chart),
    }
}
