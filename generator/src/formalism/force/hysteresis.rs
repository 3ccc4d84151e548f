//! Hysteresis: unloading along another curve than loading, by one memory p, the foot of a steep line.
//!
//! F(x; p) = clamp(s (x − p), u(x), f(x)),   after an accepted step   p ← clamp(p, x − f(x)/s, x − u(x)/s)
//!
//! Loading drags the foot along with f, so that F = f; at a reversal the line of slope s leads down to u, which drags the foot
//! back, and up again to f from wherever loading sets in: nested loops close (the play operator of Prandtl and Ishlinskii).
//! Without a curve of unloading u = 0 and the foot only advances, p ← max(p, x − f(x)/s): a permanent set, and with a
//! straight f the law of Walton and Braun (1986), of restitution √(f'/s).
//!
//! During a step p is held. The new foot gives the very force of the old one, so nothing jumps where a step ends; and a
//! guard ends steps where the rate changes its sign, because a turning point inside a step would be forgotten.

use super::{Acts, Loads, choose};
use crate::expression::Expr;
use crate::formalism::numbers::{curve, number};
use crate::model::Hysteresis;

/// By how much the abscissa is taken larger, or smaller, where the line meets a curve: while one of them drags the foot, they
/// differ by rounding, which must not look like a kink. Well above the rounding of single precision.
const APART: f64 = 1e-6;

/// The elastic force of a law with hysteresis, and the foot p that its line has when it turns here.
///
/// `owner` is the force that the memory belongs to ("contact seat"), `unit` that of the `abscissa`. `loading` is f at the
/// abscissa, `rate` has the sign of the abscissa's rate. The abscissa must be one at which the curves have values
/// whatever the state, such as max(δ, 0): what is remembered must be finite. At 0 and below it nothing touches, and the
/// rate does not count. `below` is the same abscissa made later, with its values below 0.
#[expect(
    clippy::too_many_arguments,
    reason = "whose, what law, and where on it"
)]
pub fn apply<'g>(
    loads: &mut Loads<'g>,
    owner: &str,
    unit: &'static str,
    law: &Hysteresis,
    abscissa: Expr<'g>,
    loading: Expr<'g>,
    rate: Expr<'g>,
    below: impl Fn() -> Expr<'g> + Copy + 'g,
) -> (Expr<'g>, Expr<'g>) {
    let graph = abscissa.graph();
    let slope = number(graph, &law.slope);
    let name = match law.unloading {
        Some(_) => format!("{owner}: foot of the unloading line"),
        None => format!("{owner}: permanent set"),
    };
    let (index, foot) = loads.memory(name, unit, number(graph, &law.foot));
    let unloading = match &law.unloading {
        Some(unloading) => curve(graph, unloading, abscissa),
        None => graph.constant(0.0),
    };
    // in this order a curve that was left shows: `max` and `min` keep what is no number on their left
    let line = slope * (abscissa - foot);
    let force = loading.min(unloading.max(line));

    let furthest = abscissa - loading / slope;
    let renewed = match &law.unloading {
        Some(_) => furthest.max(foot.min(abscissa - unloading / slope)),
        None => furthest.max(foot),
    };
    loads.memory[index].next = renewed;
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    loads.guard(
        format!("{owner}: turns from loading to unloading"),
        choose(zero, abscissa, rate, one),
    );
    // the line is above a curve while that drags the foot, below after a turn
    loads.kink(
        format!("{owner}: the line meets the loading curve"),
        move || (1.0 + APART) * below() - loading / slope - foot,
    );
    match &law.unloading {
        Some(curve) => {
            loads.kink(
                format!("{owner}: the line meets the unloading curve"),
                move || (1.0 - APART) * below() - unloading / slope - foot,
            );
            loads.curve_of_state(owner, "unloading curve", curve, Acts::AboveFirst, below);
        }
        None => loads.kink(format!("{owner}: the line ends"), move || below() - foot),
    }
    (force, renewed)
}
