//! Webbing that is paid out and taken in: what the untensioned length ℓ of a belt of length L becomes.
//!
//! ℓ = b − r + x
//!
//! | | |
//! |---|---|
//! | b | L₀; with a retractor such that the belt pulls with its spool, b − r + x = L/(1 + ε_s), until it locks: the b of that moment is remembered |
//! | r | what the pretensioner has taken in, a curve of the time since it fired |
//! | x | what the limiter has paid out for good, remembered: x ← max(x, L/(1 + ε_F) − b + r) |
//!
//! ε_s and ε_F are the elongations at which the curve takes the tensions of the retractor and of the limiter. What is remembered
//! is so when a step is accepted, and gives the very tension that there was: nothing jumps where a step ends.
//!
//! While the limiter pays out, x follows L also within a step, so that the elongation stays at ε_F; whether it does is
//! remembered too, and guards end the steps where it begins, L = (1 + ε_F) ℓ, and where it ends because the webbing no more
//! lengthens, L̇ + (1 + ε_F) ṙ = 0.

use super::switch::Remembered;
use super::{Loads, choose};
use crate::dynamics::numbers::{curve, derivative, inverse, number};
use crate::dynamics::time;
use crate::expression::{Expr, Function, Graph};
use crate::model::webbing::SHORTEST;
use crate::model::{Belt, Model, Number};

/// Most kinks of the curve of a pretensioner that steps end at; those of a curve of more points are passed as smooth.
const MOST_KINKS: usize = 32;

/// What is known of the webbing of a belt.
#[derive(Clone, Copy)]
pub struct Webbing<'g> {
    /// ℓ \[m\].
    pub length: Expr<'g>,
    /// ℓ at the start \[m\].
    pub initial: Expr<'g>,
    /// ṙ, the rate at which it is taken in \[m/s\].
    pub taken_in: Expr<'g>,
    /// Length of the belt up to which it is not damped: ℓ, or that at which a retractor locked \[m\].
    pub undamped: Expr<'g>,
    /// The switch that locks the retractor, and the tension until then \[N\].
    pub retractor: Option<(Remembered<'g>, Expr<'g>)>,
    /// The force of the limiter \[N\], and 1 while it pays out, else 0.
    pub limiter: Option<(Expr<'g>, Expr<'g>)>,
}

/// The webbing of a belt that spans `span` \[m\] now and `initial_span` at the start; `rate` is that of the span \[m/s\],
/// `untensioned` is L₀ \[m\].
pub fn webbing<'g>(
    graph: &'g Graph,
    model: &Model,
    loads: &mut Loads<'g>,
    name: &str,
    belt: &Belt,
    [span, rate, initial_span]: [Expr<'g>; 3],
    untensioned: Expr<'g>,
) -> Webbing<'g> {
    let (zero, one, half) = (
        graph.constant(0.0),
        graph.constant(1.0),
        graph.constant(0.5),
    );
    let (taken, taken_in) = pretensioner(graph, model, loads, name, belt);
    let paid = belt.limiter.as_ref().map(|force| {
        let (paid, payout) = loads.memory(format!("belt {name}: paid out"), "m", zero);
        let (paying, pays) = loads.memory(format!("belt {name}: pays out"), "", zero);
        (force, (paid, payout), (paying, pays))
    });
    let payout = paid.map_or(zero, |(_, (_, payout), _)| payout);

    let (mut base, mut initial, mut undamped, mut reel) = (untensioned, untensioned, one, None);
    if let Some(retractor) = &belt.retractor {
        undamped = one + elongation(graph, belt, &retractor.spool);
        initial = initial_span / undamped;
        let lock = loads.switches[retractor.lock];
        let (index, locked) = loads.memory(format!("belt {name}: locked length"), "m", initial);
        base = lock.once(locked, span / undamped + taken - payout);
        loads.memory[index].next = base;
        reel = Some((lock, number(graph, &retractor.spool)));
    }

    let mut length = base - taken;
    let limiter = paid.map(|(force, (paid, payout), (paying, pays))| {
        let yields = one + elongation(graph, belt, force);
        let paid_now = payout.max(span / yields - length);
        let beyond = span - yields * (length + payout);
        let lengthens = rate + yields * taken_in;
        length = length + choose(pays, half, payout, paid_now);

        let guard = choose(pays, half, -beyond, lengthens);
        let begins = choose(guard, zero, choose(zero, lengthens, one, zero), zero);
        loads.memory[paid].next = paid_now;
        loads.memory[paying].next = choose(pays, half, begins, choose(guard, zero, zero, one));
        loads.guard(format!("belt {name}: limiter"), guard);
        (number(graph, force), pays)
    });
    if belt.pretensioner.is_some() {
        length = length.max(graph.constant(SHORTEST));
    }
    Webbing {
        length,
        initial,
        taken_in,
        undamped: undamped * length,
        retractor: reel,
        limiter,
    }
}

/// The elongation at which the curve takes a tension.
fn elongation<'g>(graph: &'g Graph, belt: &Belt, tension: &Number) -> Expr<'g> {
    let tension = number(graph, tension);
    if tension.is_zero() {
        return tension;
    }
    inverse(graph, &belt.force, tension)
}

/// r and ṙ, both 0 until it fires; and a guard at each kink.
fn pretensioner<'g>(
    graph: &'g Graph,
    model: &Model,
    loads: &mut Loads<'g>,
    name: &str,
    belt: &Belt,
) -> (Expr<'g>, Expr<'g>) {
    let zero = graph.constant(0.0);
    let Some(pretensioner) = &belt.pretensioner else {
        return (zero, zero);
    };
    let (fire, retract) = (loads.switches[pretensioner.fire], &pretensioner.retract);
    let now = time(graph);
    let since = (now - fire.since).max(zero);
    let slope = derivative(graph, retract, Function::CurveSlope, since);
    let rate = fire.once(slope, zero);

    let points = &model.curves[retract.curve].points;
    for (index, point) in points.iter().enumerate().skip(1) {
        if points.len() <= MOST_KINKS {
            let kink = point[0] * number(graph, &retract.stretch);
            let left = fire.since + kink - now;
            let guard = format!("belt {name}: point {} of the pretensioner", index + 1);
            loads.guard(guard, left);
        }
    }
    (curve(graph, retract, since), rate)
}
