//! Hysteresis: unloading along another curve than loading. The only memory is p, the foot of a steep line.
//!
//! F(x; p) = clamp(s (x − p), u(x), f(x)),   after an accepted step   p ← clamp(p, x − f(x)/s, x − u(x)/s)
//!
//! Loading drags the foot along with f, so that F = f. At a reversal the force follows the line of slope s down to u,
//! which then drags the foot back. When loading begins again, the force follows a line up to f: nested loops close (the
//! play operator of Prandtl and Ishlinskii). Without a curve of unloading u = 0 and the foot only advances, p ← max(p,
//! x − f(x)/s): a permanent set, and with a straight f the law of Walton and Braun (1986), with the restitution
//! √(f'/s).
//!
//! A joint has the law on both sides of 0: after a reversal |F| falls along |u|. With u there is one foot, which passes
//! 0 together with the abscissa; without u, each side has a permanent set of its own. Neither f nor u, both through 0,
//! may have the wrong sign anywhere:
//!
//! x > 0: F = clamp(s (x − p), u(x), f(x)),   x < 0: F = clamp(s (x − p), f(x), u(x))
//!
//! During a step p is held constant. With the new foot the force is the same as with the old one, so the force does not
//! jump at the end of a step. An event function ends steps where the rate changes its sign, because a turning point
//! inside a step would be missed.
//!
//! If both operands are equal, `max` and `min` return the left one. So the curve that drags the foot is the left
//! operand, and its derivatives count.

use super::switch::Gate;
use super::{Acts, AppliedForces};
use crate::expression::Expr;
use crate::expression::choose;
use crate::model::Hysteresis;
use crate::motion::numbers::{curve, number};

/// Relative change of the abscissa in the function that finds where the line meets a curve. While a curve drags the
/// foot, the two differ only by rounding, which must not look like a kink. The value is well above the rounding of
/// single precision.
const APART: f64 = 1e-6;

/// Returns the elastic force of a law with hysteresis, and the foot p of its line if the abscissa turns here.
///
/// `owner` names the force that the memory belongs to ("contact seat"), `unit` is the unit of the abscissa, and
/// `loading` is f at the abscissa. The `abscissa` must be one at which the curves have values in every state, such as
/// max(δ, 0), because the memory must be finite. `below` makes the same abscissa later, without the bound at 0.
/// [`watch_turns`] must be called, too. While the force waits for its switch (`gate`), earlier loading leaves no trace
/// in the memory.
#[expect(
    clippy::too_many_arguments,
    reason = "whose, what law, when, and where on it"
)]
pub fn apply<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    unit: &'static str,
    law: &Hysteresis,
    gate: Gate<'g>,
    abscissa: Expr<'g>,
    loading: Expr<'g>,
    below: impl Fn() -> Expr<'g> + Copy + 'g,
) -> (Expr<'g>, Expr<'g>) {
    let graph = abscissa.graph();
    let slope = number(graph, &law.slope);
    let name = match law.unloading {
        Some(_) => format!("{owner}: foot of the unloading line"),
        None => format!("{owner}: permanent set"),
    };
    let fresh = number(graph, &law.foot);
    let (index, foot) = applied.memory(name, unit, fresh);
    let kept = gate.either(foot, fresh);
    let unloading = match &law.unloading {
        Some(unloading) => curve(graph, unloading, abscissa),
        None => graph.constant(0.0),
    };
    // keep this order of operands: `max` and `min` pass on a NaN of their left operand, so leaving the curve shows as
    // NaN
    let line = slope * (abscissa - foot);
    let force = loading.min(unloading.max(line));

    let furthest = abscissa - loading / slope;
    let renewed = match &law.unloading {
        Some(_) => furthest.max((abscissa - unloading / slope).min(kept)),
        None => furthest.max(kept),
    };
    applied.states.memory[index].next = renewed;
    // While the loading curve drags the foot, the line is above it by APART; after a reversal the line is below it. The
    // unloading curve has the opposite signs.
    applied.kink(
        format!("{owner}: the line meets the loading curve"),
        move || (1.0 + APART) * below() - loading / slope - foot,
    );
    match &law.unloading {
        Some(curve) => {
            applied.kink(
                format!("{owner}: the line meets the unloading curve"),
                move || (1.0 - APART) * below() - unloading / slope - foot,
            );
            applied.curve_of_state(
                owner,
                "unloading curve",
                unit,
                curve,
                Acts::AboveFirst,
                below,
            );
        }
        None => applied.kink(format!("{owner}: the line ends"), move || below() - foot),
    }
    (force, renewed)
}

/// Ends steps where the abscissa turns, i.e. where `rate`, which has the sign of its rate, changes its sign. At
/// abscissae of 0 and below there is no contact, and the rate does not count.
pub fn watch_turns<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    abscissa: Expr<'g>,
    rate: Expr<'g>,
) {
    let graph = abscissa.graph();
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    applied.event_function(
        format!("{owner}: turns from loading to unloading"),
        choose(zero, abscissa, rate, one),
    );
}

/// Returns the elastic force of a law with hysteresis on both sides of 0, and the permanent sets above and below 0 if
/// the abscissa turns here.
///
/// `owner` names the law that the memory belongs to ("joint man/head"), and `unit` is the unit of the abscissa, which
/// `argument` makes. `loading` is f at the abscissa, `rate` the rate of the abscissa. While the force waits for its
/// switch, earlier loading leaves no trace in the memory.
#[expect(
    clippy::too_many_arguments,
    reason = "whose, what law, when, and where on it"
)]
pub fn apply_both_ways<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    unit: &'static str,
    law: &Hysteresis,
    gate: Gate<'g>,
    argument: impl Fn() -> Expr<'g> + Copy + 'g,
    loading: Expr<'g>,
    rate: Expr<'g>,
) -> (Expr<'g>, [Expr<'g>; 2]) {
    let graph = loading.graph();
    let (abscissa, zero) = (argument(), graph.constant(0.0));
    let slope = number(graph, &law.slope);
    applied.event_function(format!("{owner}: turns from loading to unloading"), rate);
    let furthest = abscissa - loading / slope;
    let Some(unloading) = &law.unloading else {
        // on each side of 0 the force from the foot of the other side has the wrong sign, so the bound at 0 removes it
        let mut side = |which: &str, above: bool| {
            let name = format!("{owner}: permanent set {which}");
            let (index, foot) = applied.memory(name, unit, zero);
            let (line, kept) = (slope * (abscissa - foot), gate.of(foot));
            let (force, renewed) = match above {
                true => (loading.min(line).max(zero), furthest.max(kept)),
                false => (loading.max(line).min(zero), furthest.min(kept)),
            };
            applied.states.memory[index].next = renewed;
            applied.kink(
                format!("{owner}: the line {which} meets the loading curve"),
                move || (1.0 + APART) * argument() - loading / slope - foot,
            );
            applied.kink(format!("{owner}: the line {which} ends"), move || {
                argument() - foot
            });
            (force, renewed)
        };
        let [above, below] = [side("above", true), side("below", false)];
        return (above.0 + below.0, [above.1, below.1]);
    };
    let back = curve(graph, unloading, abscissa);
    let name = format!("{owner}: foot of the unloading line");
    let (index, foot) = applied.memory(name, unit, zero);
    let (line, kept) = (slope * (abscissa - foot), gate.of(foot));
    let returns = abscissa - back / slope;
    // keep this order of operands: `max` and `min` pass on a NaN of their left operand, so leaving the curve shows as
    // NaN
    let above = loading.min(back.max(line));
    let below = loading.max(back.min(line));
    let renewed = choose(
        zero,
        abscissa,
        furthest.max(returns.min(kept)),
        furthest.min(returns.max(kept)),
    );
    applied.states.memory[index].next = renewed;
    applied.kink(
        format!("{owner}: the line meets the loading curve"),
        move || (1.0 + APART) * argument() - loading / slope - foot,
    );
    applied.kink(
        format!("{owner}: the line meets the unloading curve"),
        move || (1.0 - APART) * argument() - back / slope - foot,
    );
    applied.kink(format!("{owner}: passes the zero of its curves"), argument);
    let which = "unloading curve";
    applied.curve_of_state(owner, which, unit, unloading, Acts::Everywhere, argument);
    applied.corners(owner, which, gate, unloading, argument, move || rate);
    let force = choose(zero, abscissa, above, below);
    (force, [renewed.max(zero), renewed.min(zero)])
}
