//! Webbing that is paid out and taken in: the untensioned length ℓ of a belt of length L, or of its first segment.
//!
//! ℓ = b − r + x + y − s
//!
//! | | |
//! |---|---|
//! | b | L₀. With a retractor, until it locks: such that the belt pulls with the tension of the spool, b − r + x + y − s = L/(1 + ε_s); afterwards the value of b at that moment, which is remembered |
//! | r | length that the pretensioner has taken in, a curve of the time since it fired |
//! | x | length that the limiter has paid out for good, remembered: x ← max(x, L/(1 + ε_F) − b + r − y + s) |
//! | y | length that the film spool has given, a state: c ẏ = T − T_s − curve(y) once the retractor has locked, and ẏ ≥ −y/τ, so that y ≥ 0 |
//! | s | length that has slipped out through the first ring |
//!
//! ε_s and ε_F are the elongations at which the curve has the tension of the retractor and of the limiter. Memory
//! changes only when a step is accepted, and reproduces the tension at that moment: nothing jumps at the end of a step.
//!
//! While the limiter pays out, x follows L also within a step, so that the elongation stays at ε_F. Whether the limiter
//! pays out is remembered too. Event functions end the steps where it begins, L = (1 + ε_F) ℓ, and where it ends
//! because the webbing no longer lengthens, L̇ + (1 + ε_F) (ṙ + ṡ − ẏ) = 0.

use super::Law;
use crate::expression::choose;
use crate::expression::{Expr, Function, Graph};
use crate::force::switch::Remembered;
use crate::force::{Acts, AppliedForces};
use crate::law::belt::check::Belt;
use crate::law::belt::check::{RESISTANCE, SHORTEST};
use crate::model::Number;
use crate::motion::numbers::time;
use crate::motion::numbers::{curve, derivative, inverse, number};

/// Steps end at the kinks of the curve of a pretensioner if it has at most this many; a curve with more is treated as
/// smooth.
const MOST_KINKS: usize = 32;

/// Rates below this count as 0 where webbing slips \[m/s\]: slip settles within less than a step, so the sign of a
/// smaller rate is rounding.
pub const NOISE: f64 = 1e-3;

/// Time constant with which a film spool takes back the webbing that it gave, if nothing pulls \[s\].
const BACK: f64 = 1e-3;

/// The untensioned length of the webbing of a belt or segment, and its devices.
#[derive(Clone, Copy)]
pub struct Webbing<'g> {
    /// ℓ \[m\].
    pub length: Expr<'g>,
    /// ℓ at the start \[m\].
    pub initial: Expr<'g>,
    /// ṙ, the rate at which webbing is taken in \[m/s\].
    pub taken_in: Expr<'g>,
    /// Length of the belt up to which damping is 0: ℓ, or with a retractor ℓ (1 + ε_s), at which the belt pulls with
    /// the tension of the spool \[m\].
    pub undamped: Expr<'g>,
    /// The switch that locks the retractor, and the tension until it locks \[N\].
    pub retractor: Option<(Remembered<'g>, Expr<'g>)>,
    /// Length that the film spool has given: index and value of the state.
    pub film: Option<(usize, Expr<'g>)>,
    /// The limiter.
    pub limiter: Option<Limiter<'g>>,
}

/// The part of a limiter that is known before the rates are.
#[derive(Clone, Copy)]
pub struct Limiter<'g> {
    /// Force of the limiter \[N\].
    pub force: Expr<'g>,
    /// 1 while the limiter pays out, otherwise 0.
    pub pays: Expr<'g>,
    /// Index of the memory of `pays`.
    paying: usize,
    /// 1 + ε_F
    yields: Expr<'g>,
    /// L − (1 + ε_F) ℓ, with ℓ computed from the remembered x \[m\].
    beyond: Expr<'g>,
}

/// The webbing of a belt, or of its first segment. Its points are `span` apart now and `initial_span` at the start
/// \[m\]; `untensioned` is L₀ \[m\]; `slipped` is the length that has slipped out of it.
pub fn webbing<'g>(
    law: Law<'_, 'g>,
    applied: &mut AppliedForces<'g>,
    [span, initial_span]: [Expr<'g>; 2],
    untensioned: Expr<'g>,
    slipped: Option<Expr<'g>>,
) -> Webbing<'g> {
    let Law {
        graph, name, belt, ..
    } = law;
    let (zero, one, half) = (
        graph.constant(0.0),
        graph.constant(1.0),
        graph.constant(0.5),
    );
    let (taken, taken_in) = pretensioner(law, applied);
    let paid = belt.limiter.as_ref().map(|force| {
        let (paid, payout) = applied.memory(format!("belt {name}: paid out"), "m", zero);
        let (paying, pays) = applied.memory(format!("belt {name}: pays out"), "", zero);
        (force, (paid, payout), (paying, pays))
    });
    let payout = paid.map_or(zero, |(_, (_, payout), _)| payout);
    let film = belt
        .film_spool
        .as_ref()
        .map(|_| applied.auxiliary(format!("belt {name}: given by the film spool"), "m", zero));
    // additions to ℓ by slip and film spool
    let given = match (film, slipped) {
        (Some((_, film)), Some(slipped)) => film - slipped,
        (Some((_, film)), None) => film,
        (None, Some(slipped)) => -slipped,
        (None, None) => zero,
    };

    let (mut base, mut initial, mut undamped, mut reel) = (untensioned, untensioned, one, None);
    if let Some(retractor) = &belt.retractor {
        undamped = one + elongation(graph, belt, &retractor.spool);
        initial = initial_span / undamped;
        let lock = applied.states.switches[retractor.lock];
        let (index, locked) = applied.memory(format!("belt {name}: locked length"), "m", initial);
        base = lock.once(locked, span / undamped + taken - payout - given);
        applied.states.memory[index].next = base;
        reel = Some((lock, number(graph, &retractor.spool)));
    }

    let mut length = base - taken + given;
    let limiter = paid.map(|(force, (paid, payout), (paying, pays))| {
        let yields = one + elongation(graph, belt, force);
        // the operand that varies with L stands on the left: if both are equal, its derivatives count
        let paid_now = (span / yields - length).max(payout);
        let beyond = span - yields * (length + payout);
        length = length + choose(pays, half, payout, paid_now);
        applied.states.memory[paid].next = paid_now;
        Limiter {
            force: number(graph, force),
            pays,
            paying,
            yields,
            beyond,
        }
    });
    if belt.pretensioner.is_some() || slipped.is_some() {
        length = length.max(graph.constant(SHORTEST));
    }
    Webbing {
        length,
        initial,
        taken_in,
        undamped: undamped * length,
        retractor: reel,
        film,
        limiter,
    }
}

impl<'g> Webbing<'g> {
    /// The webbing of a segment without devices, of length L₀. A length `fed[0]` has slipped into it, and `fed[1]` out
    /// of it.
    pub fn without_devices(untensioned: Expr<'g>, fed: [Option<Expr<'g>>; 2]) -> Self {
        let graph = untensioned.graph();
        let length = match fed {
            [Some(into), Some(out)] => untensioned + (into - out),
            [Some(into), None] => untensioned + into,
            [None, Some(out)] => untensioned - out,
            [None, None] => untensioned,
        };
        let length = length.max(graph.constant(SHORTEST));
        Webbing {
            length,
            initial: untensioned,
            taken_in: graph.constant(0.0),
            undamped: length,
            retractor: None,
            film: None,
            limiter: None,
        }
    }

    /// Watches where the limiter begins to pay out, and where it ends. `rate` is the rate of the span, `leaving` the
    /// rate at which webbing leaves.
    pub fn watch_limiter(
        &self,
        applied: &mut AppliedForces<'g>,
        name: &str,
        [rate, leaving]: [Expr<'g>; 2],
    ) {
        let Some(limiter) = self.limiter else { return };
        let graph = rate.graph();
        let (zero, one, half) = (
            graph.constant(0.0),
            graph.constant(1.0),
            graph.constant(0.5),
        );
        let lengthens = rate + limiter.yields * (self.taken_in + leaving);
        let ends = match leaving.is_zero() {
            true => lengthens,
            false => lengthens + graph.constant(NOISE),
        };
        let event_function = choose(limiter.pays, half, -limiter.beyond, ends);
        let begins = choose(
            event_function,
            zero,
            choose(zero, lengthens, one, zero),
            zero,
        );
        let ends = choose(event_function, zero, zero, one);
        applied.states.memory[limiter.paying].next = choose(limiter.pays, half, begins, ends);
        applied.event_function(format!("belt {name}: limiter"), event_function);
    }

    /// The rate at which the film spool gives webbing under the tension `tension`; `None` without a film spool.
    pub fn film(
        &self,
        law: Law<'_, 'g>,
        applied: &mut AppliedForces<'g>,
        tension: Expr<'g>,
    ) -> Option<Expr<'g>> {
        let ((index, given), (_, spool)) = (self.film?, self.retractor?);
        let (graph, film) = (law.graph, law.belt.film_spool.as_ref()?);
        let owner = format!("belt {}", law.name);
        applied.curve_of_state(
            &owner,
            "film spool",
            "m",
            film,
            Acts::Everywhere,
            move || given,
        );
        let resistance = graph.constant(RESISTANCE);
        let pulled = (tension - spool - curve(graph, film, given)) / resistance;
        let back = given / graph.constant(-BACK);
        let rate = self.once_locked(pulled.max(back), graph.constant(0.0));
        applied.states.auxiliaries[index].next = rate;
        let webbing = *self;
        applied.kink(format!("{owner}: film spool"), move || {
            webbing.once_locked(pulled - back, graph.constant(1.0))
        });
        Some(rate)
    }
}

/// The elongation at which the tension curve has this tension.
fn elongation<'g>(graph: &'g Graph, belt: &Belt, tension: &Number) -> Expr<'g> {
    let tension = number(graph, tension);
    if tension.is_zero() {
        return tension;
    }
    inverse(graph, &belt.force, tension)
}

/// r and ṙ, both 0 until the pretensioner fires and its delay is over. Adds an event function at each kink.
fn pretensioner<'g>(law: Law<'_, 'g>, applied: &mut AppliedForces<'g>) -> (Expr<'g>, Expr<'g>) {
    let Law {
        graph,
        model,
        name,
        belt,
        ..
    } = law;
    let zero = graph.constant(0.0);
    let Some(pretensioner) = &belt.pretensioner else {
        return (zero, zero);
    };
    let (fire, retract) = (
        applied.states.switches[pretensioner.fire],
        &pretensioner.retract,
    );
    let now = time(graph);
    let delay = pretensioner
        .delay
        .as_ref()
        .map(|delay| number(graph, delay));
    let begins = delay.map_or(fire.since, |delay| fire.since + delay);
    let since = (now - begins).max(zero);
    let slope = derivative(graph, retract, Function::CurveSlope, since);
    // until the delay is over the rate is 0, although the curve has the slope of its first piece at 0
    let slope = match delay {
        Some(_) => choose(now, begins, zero, slope),
        None => slope,
    };
    let rate = fire.once(slope, zero);

    let points = &model.curves[retract.curve].points;
    if delay.is_some() {
        let name_of_event = format!("belt {name}: begin of the pretensioner");
        applied.event_function(name_of_event, begins - now);
    }
    for (index, point) in points.iter().enumerate().skip(1) {
        if points.len() <= MOST_KINKS {
            let kink = point[0] * number(graph, &retract.stretch);
            let left = begins + kink - now;
            let name_of_event = format!("belt {name}: point {} of the pretensioner", index + 1);
            applied.event_function(name_of_event, left);
        }
    }
    (curve(graph, retract, since), rate)
}
