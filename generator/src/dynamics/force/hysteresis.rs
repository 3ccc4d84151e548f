//! Hysteresis: unloading along another curve than loading, by one memory p, the foot of a steep line.
//!
//! F(x; p) = clamp(s (x − p), u(x), f(x)),   after an accepted step   p ← clamp(p, x − f(x)/s, x − u(x)/s)
//!
//! Loading drags the foot along with f, so that F = f; at a reversal the line of slope s leads down to u, which drags the foot
//! back, and up again to f from wherever loading sets in: nested loops close (the play operator of Prandtl and Ishlinskii).
//! Without a curve of unloading u = 0 and the foot only advances, p ← max(p, x − f(x)/s): a permanent set, and with a
//! straight f the law of Walton and Braun (1986), of restitution √(f'/s).
//!
//! A joint has the law on both sides of 0: |F| falls along |u| from wherever |F| came up along |f|. With u it is one foot, which passes 0
//! with the abscissa; without, each side has a set of its own. Of f and u, both through 0, none has the wrong sign anywhere:
//!
//! x > 0: F = clamp(s (x − p), u(x), f(x)),   x < 0: F = clamp(s (x − p), f(x), u(x))
//!
//! During a step p is held. The new foot gives the very force of the old one, so nothing jumps where a step ends; and a
//! event function ends steps where the rate changes its sign, because a turning point inside a step would be forgotten.
//!
//! Where what drags the foot and the foot are equal, `max` and `min` take their left operand, so what drags stands there: its derivatives count.

use super::switch::Gate;
use super::{Acts, AppliedForces, choose};
use crate::dynamics::numbers::{curve, number};
use crate::expression::Expr;
use crate::model::Hysteresis;

/// By how much the abscissa is taken larger, or smaller, where the line meets a curve: while one of them drags the foot, they
/// differ by rounding, which must not look like a kink. Well above the rounding of single precision.
const APART: f64 = 1e-6;

/// The elastic force of a law with hysteresis, and the foot p that its line has when it turns here.
///
/// `owner` is the force that the memory belongs to ("contact seat"), `unit` that of the `abscissa`. `loading` is f at the
/// abscissa. The abscissa must be one at which the curves have values whatever the state, such as max(δ, 0): what is remembered must be
/// finite. `below` is the same abscissa made later, with its values below 0. [`watch_turns`] goes with it. While the force waits for its switch
/// (`gate`), nothing is kept of how far it would have been loaded.
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
    // keep this order of operands: `max` and `min` pass on a NaN of their left operand, so leaving the curve shows as NaN
    let line = slope * (abscissa - foot);
    let force = loading.min(unloading.max(line));

    let furthest = abscissa - loading / slope;
    let renewed = match &law.unloading {
        Some(_) => furthest.max((abscissa - unloading / slope).min(kept)),
        None => furthest.max(kept),
    };
    applied.states.memory[index].next = renewed;
    // the line is above a curve while that drags the foot, below after a turn
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
            applied.curve_of_state(owner, "unloading curve", curve, Acts::AboveFirst, below);
        }
        None => applied.kink(format!("{owner}: the line ends"), move || below() - foot),
    }
    (force, renewed)
}

/// Ends steps where an abscissa turns, whose rate has the sign of `rate`. At 0 and below nothing touches, and the rate does not count.
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

/// The elastic force of a law with hysteresis on both sides of 0, and the sets above and below it that are left when it turns here.
///
/// `owner` is the law that the memory belongs to ("joint man/head"), `unit` that of the abscissa, which is made by `argument`; `loading` is f
/// at the abscissa, `rate` the abscissa's rate. While the force waits for its switch, nothing is kept of how far it would have been loaded.
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
        // on each side of 0 the line of the other side has the wrong sign, so the clamp makes it 0
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
    // keep this order of operands: `max` and `min` pass on a NaN of their left operand, so leaving the curve shows as NaN
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
    applied.curve_of_state(owner, which, unloading, Acts::Everywhere, argument);
    applied.corners(owner, which, gate, unloading, argument, move || rate);
    let force = choose(zero, abscissa, above, below);
    (force, [renewed.max(zero), renewed.min(zero)])
}
