//! Belt: a tension along the line between two attachments.   \[MADYMO 1980, force model 4\]
//!
//! d = p_to − p_from,   L = |d|,   n = d/L,   ε = (L − L₀)/L₀,   T = tension(ε, curve(ε), damping · L̇),   L̇ = n · ḋ
//!
//! +T n acts on `from`, −T n on `to`. L₀ is given, or the initial distance plus slack, or such that the belt pulls with its
//! pretension at the initial distance: L₀ = L_start/(1 + ε_p) with curve(ε_p) = pretension.

use super::switch::Gate;
use super::{BeltMeasures, Loads, Motion, Product, choose};
use crate::expression::{Expr, Function, Graph};
use crate::formalism::numbers::{curve, number};
use crate::model::{Attachment, Belt, BeltLength};

/// Squared distance below which the direction of a belt is taken at this distance \[m²\]: no belt is that short, and
/// coinciding attachments then give no force instead of NaN.
const SMALLEST_SQUARED_LENGTH: f64 = 1e-20;

pub fn apply<'g>(
    graph: &'g Graph,
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

    let untensioned = untensioned_length(graph, start, belt);
    let elongation = length / untensioned - graph.constant(1.0);
    let rate = direction.dot(to.velocity - from.velocity);
    let viscous = match &belt.damping {
        Some(damping) => number(graph, damping) * rate,
        None => graph.constant(0.0),
    };
    let elastic = curve(graph, &belt.force, elongation);
    let tension = graph.call(Function::BeltTension, &[elongation, elastic, viscous]);
    if belt.damping.is_some() {
        // the tension jumps where it goes taut, and ends while still stretched where damping would push
        let zero = graph.constant(0.0);
        let pulls = choose(zero, elongation, elastic + viscous, elongation);
        loads.guard(format!("belt {name}: pulls"), pulls);
    }
    let tension = gate.of(tension);
    let pull = tension * direction;
    loads.apply(belt.from.on, from.offset, pull);
    loads.apply(belt.to.on, to.offset, -pull);
    loads.work(format!("belt {name}"), Product::Scalars(-tension, rate));
    BeltMeasures {
        tension,
        length,
        elongation,
    }
}

fn length<'g>(graph: &'g Graph, squared: Expr<'g>) -> Expr<'g> {
    squared.max(graph.constant(SMALLEST_SQUARED_LENGTH)).sqrt()
}

fn untensioned_length<'g>(graph: &'g Graph, start: &Motion<'g>, belt: &Belt) -> Expr<'g> {
    let point = |a: &Attachment| start.attachment(graph, a).position;
    let distance = || length(graph, (point(&belt.to) - point(&belt.from)).squared());
    match &belt.length {
        BeltLength::Given(length) => number(graph, length),
        BeltLength::Slack(slack) => distance() + number(graph, slack),
        BeltLength::Pretension(force) => {
            let ordinate = number(graph, force) / number(graph, &belt.force.times);
            let elongation =
                graph.call(Function::CurveInverse(belt.force.curve as u32), &[ordinate]);
            distance() / (graph.constant(1.0) + elongation)
        }
    }
}
