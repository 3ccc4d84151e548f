//! Belt: a tension along the line between two attachments.   \[MADYMO 1980, force model 4\]
//!
//! d = p_to − p_from,   L = |d|,   n = d/L,   L̇ = n · ḋ,   ε = (L − ℓ)/ℓ
//!
//! T = tension(ε, curve(ε), damping · min((L − ℓ)/stretch, 1) · (L̇ + ṙ))
//!
//! +T n acts on `from`, −T n on `to`. The untensioned length ℓ is L₀, given, or the initial distance plus slack, or such that the
//! belt pulls with its pretension at the initial distance: L₀ = L_start/(1 + ε_p) with curve(ε_p) = pretension; a
//! retractor, pretensioner or limiter (`webbing`) changes it, taking in webbing at the rate ṙ. Until the retractor
//! locks T is its spool, and T is never larger than the force of the limiter.
//!
//! The power −T L̇ on the bodies is told apart: what stretches the webbing, −T (L̇ + ṙ), to `elastic`, `damping` and
//! `limiter`, T ṙ to the `pretensioner`, and all of it to the `retractor` until that locks.

use super::fade::faded;
use super::hysteresis;
use super::onset::{FAR, Onset, absolute, size};
use super::switch::Gate;
use super::webbing::{Webbing, webbing};
use super::{Acts, BeltMeasures, Loads, Motion, Product, choose};
use crate::dynamics::numbers::{curve, inverse, number};
use crate::expression::{Expr, Function, Graph};
use crate::model::webbing::SHORTEST;
use crate::model::{Attachment, Belt, BeltLength, Model};

/// Smallest squared length that a division by the length sees \[m²\]: ends that are closer than 1e-10 m give a direction of (nearly) 0 and so no force,
/// instead of NaN.
///
/// Generated text has no branches, so both sides of "slack or taut" are computed and every divisor must be safe in every state. The other
/// divisor, the untensioned length, is positive by the rules for its numbers: `model/part.rs`, `dynamics/conditions.rs`, and at least
/// [`SHORTEST`] where a pretensioner takes webbing in.
const SMALLEST_SQUARED_LENGTH: f64 = 1e-20;

pub use crate::model::webbing::must_have_length;

/// Applies a belt.
#[expect(clippy::too_many_arguments, reason = "as all laws, and its own two")]
pub fn apply<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    start: &Motion<'g>,
    loads: &mut Loads<'g>,
    name: &str,
    gate: Gate<'g>,
    belt: &Belt,
) -> BeltMeasures<'g> {
    let (from, to) = (
        motion.attachment(graph, &belt.from),
        motion.attachment(graph, &belt.to),
    );
    let span = to.position - from.position;
    let length = length(graph, span.squared());
    let direction = length.recip() * span;
    let rate = direction.dot(to.velocity - from.velocity);

    let initial = initial_length(graph, start, belt);
    let untensioned = untensioned_length(graph, belt, initial);
    let spans = [length, rate, initial];
    let webbing = webbing(graph, model, loads, name, belt, spans, untensioned);
    let elongation = length / webbing.length - graph.constant(1.0);
    let stretching = rate + webbing.taken_in;

    let owner = format!("belt {name}");
    let curves = loads.curves_so_far();
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let below = move || webbing.once_locked(elongation, -one);
    loads.curve_of_state(&owner, "curve", &belt.force, Acts::AboveFirst, below);
    let (elastic, permanent_set) = elastic(graph, loads, &owner, belt, &webbing, spans, below);
    let tension = |viscous: Expr<'g>| {
        let tension = graph.call(Function::BeltTension, &[elongation, elastic, viscous]);
        let limit = webbing.limiter.map(|(limit, _)| limit);
        gate.of(limit.map_or(tension, |limit| tension.min(limit)))
    };
    let undamped = tension(graph.constant(0.0));
    let stretched = match &belt.damping {
        Some(damping) => {
            let fade = faded(
                graph,
                length - webbing.undamped,
                belt.damping_stretch.as_ref(),
            );
            // a retractor locks where the webbing is stretched already
            let fade = match belt.retractor {
                Some(_) => fade.max(graph.constant(0.0)),
                None => fade,
            };
            let viscous = number(graph, damping) * fade * stretching;
            // the tension has a kink where it goes taut, and ends while still stretched where damping would push
            loads.kink(format!("{owner}: pulls"), move || {
                let pulls = choose(zero, elongation, elastic + viscous, elongation);
                webbing.once_locked(pulls, one)
            });
            if let Some((limit, _)) = webbing.limiter {
                loads.kink(
                    format!("{owner}: pulls with the force of the limiter"),
                    move || webbing.once_locked(elastic + viscous - limit, one),
                );
            }
            if let Some(stretch) = belt.damping_stretch.clone() {
                let beyond = move || length - webbing.undamped;
                if belt.retractor.is_some() {
                    loads.kink(format!("{owner}: damping sets in"), move || {
                        webbing.once_locked(beyond(), one)
                    });
                }
                loads.kink(format!("{owner}: damping is full"), move || {
                    webbing.once_locked(beyond() - number(graph, &stretch), one)
                });
            }
            tension(viscous)
        }
        None => {
            loads.kink(format!("{owner}: goes taut"), move || {
                webbing.once_locked(elongation, one)
            });
            undamped
        }
    };
    let taken_in = webbing.taken_in;
    let moving = to.velocity - from.velocity;
    let unloading = belt.hysteresis.as_ref().map(|law| &law.unloading);
    let belt_curves = [
        (Some(&belt.force), "curve"),
        (unloading.and_then(Option::as_ref), "unloading curve"),
    ];
    for (curve, which) in belt_curves {
        let Some(curve) = curve else { continue };
        loads.corners(&owner, which, gate, curve, below, move || {
            (size(moving) + absolute(taken_in)) / webbing.length
        });
    }
    loads.onset(format!("{owner}: goes taut"), move || {
        gate.of_onset(Onset {
            gap: webbing.once_locked(webbing.length - length, graph.constant(FAR)),
            speed: size(moving) + absolute(taken_in),
        })
    });
    let spool = webbing.retractor.map(|(_, spool)| gate.of(spool));
    let tension = spool.map_or(stretched, |spool| webbing.once_locked(stretched, spool));

    loads.curves_act(curves, tension);
    let pull = tension * direction;
    loads.apply(belt.from.on, from.offset, pull);
    loads.apply(belt.to.on, to.offset, -pull);
    works(
        graph,
        loads,
        &owner,
        &webbing,
        [undamped, stretched],
        spool,
        rate,
    );
    BeltMeasures {
        on_first: pull,
        tension,
        length,
        elongation,
        untensioned: webbing.length,
        payout: webbing.length - webbing.initial,
        permanent_set,
    }
}

impl<'g> Webbing<'g> {
    /// `then` once a retractor, if there is one, has locked; `otherwise` before.
    fn once_locked(&self, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
        self.retractor
            .map_or(then, |(lock, _)| lock.once(then, otherwise))
    }
}

/// The elastic tension, and the elongation that remains without it.
fn elastic<'g>(
    graph: &'g Graph,
    loads: &mut Loads<'g>,
    owner: &str,
    belt: &Belt,
    webbing: &Webbing<'g>,
    [length, rate, _]: [Expr<'g>; 3],
    below: impl Fn() -> Expr<'g> + Copy + 'g,
) -> (Expr<'g>, Expr<'g>) {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let ratio = length / webbing.length;
    match &belt.hysteresis {
        Some(law) => {
            // what is remembered must be finite, and a curve need not be defined while slack
            let elongation = (ratio - one).max(zero);
            let loading = curve(graph, &belt.force, elongation);
            let growing = webbing.once_locked(rate + ratio * webbing.taken_in, one);
            hysteresis::apply(loads, owner, "", law, elongation, loading, growing, below)
        }
        None => (curve(graph, &belt.force, ratio - one), zero),
    }
}

/// Counts the powers of a belt whose webbing pulls with `undamped` and, with damping, with `stretched`.
fn works<'g>(
    graph: &'g Graph,
    loads: &mut Loads<'g>,
    owner: &str,
    webbing: &Webbing<'g>,
    [undamped, stretched]: [Expr<'g>; 2],
    spool: Option<Expr<'g>>,
    rate: Expr<'g>,
) {
    let (zero, half) = (graph.constant(0.0), graph.constant(0.5));
    let stretching = rate + webbing.taken_in;
    let locked = |tension: Expr<'g>| webbing.once_locked(tension, zero);
    let elastic = locked(undamped);
    match webbing.limiter {
        Some((_, pays)) => {
            let (stores, yields) = (
                choose(pays, half, elastic, zero),
                choose(pays, half, zero, elastic),
            );
            loads.work(
                format!("{owner}: elastic"),
                Product::Scalars(-stores, stretching),
            );
            loads.work(
                format!("{owner}: limiter"),
                Product::Scalars(-yields, stretching),
            );
        }
        None => loads.work(
            format!("{owner}: elastic"),
            Product::Scalars(-elastic, stretching),
        ),
    }
    if undamped.id() != stretched.id() {
        let damping = locked(stretched) - elastic;
        loads.work(
            format!("{owner}: damping"),
            Product::Scalars(-damping, stretching),
        );
    }
    if !webbing.taken_in.is_zero() {
        let work = format!("{owner}: pretensioner");
        loads.work(work, Product::Scalars(locked(stretched), webbing.taken_in));
    }
    if let Some(spool) = spool {
        let free = webbing.once_locked(zero, spool);
        loads.work(format!("{owner}: retractor"), Product::Scalars(-free, rate));
    }
}

/// √ of a squared distance, never 0.
pub fn length<'g>(graph: &'g Graph, squared: Expr<'g>) -> Expr<'g> {
    squared.max(graph.constant(SMALLEST_SQUARED_LENGTH)).sqrt()
}

fn initial_length<'g>(graph: &'g Graph, start: &Motion<'g>, belt: &Belt) -> Expr<'g> {
    let point = |a: &Attachment| start.attachment(graph, a).position;
    length(graph, (point(&belt.to) - point(&belt.from)).squared())
}

/// What parameters must not make negative: by how much the length at the start is more than nothing \[m\]. A given length is ruled by
/// itself.
pub fn length_at_start<'g>(graph: &'g Graph, start: &Motion<'g>, belt: &Belt) -> Expr<'g> {
    let slack = match &belt.length {
        BeltLength::Given(_) => return graph.constant(0.0),
        BeltLength::Slack(slack) => number(graph, slack),
        BeltLength::Pretension(_) => graph.constant(0.0),
    };
    initial_length(graph, start, belt) + slack - graph.constant(SHORTEST)
}

fn untensioned_length<'g>(graph: &'g Graph, belt: &Belt, initial: Expr<'g>) -> Expr<'g> {
    match &belt.length {
        BeltLength::Given(length) => number(graph, length),
        BeltLength::Slack(slack) => initial + number(graph, slack),
        BeltLength::Pretension(force) => {
            let elongation = inverse(graph, &belt.force, number(graph, force));
            initial / (graph.constant(1.0) + elongation)
        }
    }
}
