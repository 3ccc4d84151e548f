//! Rings that a belt slips through: the law of a rope on a drum (Euler, Eytelwein), with a resistance to slip.
//!
//! R = e^(μ θ),   θ = ∠(n_before, n_behind)
//!
//! c ṡ = max(T_behind − R T_before, 0) − max(T_before − R T_behind, 0)
//!
//! s is a state: the untensioned length that has slipped from the segment before the ring into the segment behind it.
//! While T_behind/T_before is between 1/R and R, the webbing sticks, ṡ = 0 exactly. Beyond, it slips, and the excess of
//! the tension over the ratio is c ṡ. The tensions are those without damping. The resistance c is part of the law, and
//! makes ṡ a function of the state: webbing has no mass here that could be accelerated.
//!
//! A segment has run out at ℓ ≤ ℓ_e: no more webbing slips out of it. From 2 ℓ_e down to ℓ_e the slip slows down.

use super::{Law, Segment};
use crate::expression::{Expr, Function, Graph};
use crate::force::{AppliedForces, Product};
use crate::law::belt::check::RUN_OUT;
use crate::law::belt::outputs::SegmentMeasures;
use crate::motion::numbers::number;

/// Lower bound of sin² θ under the root, whose slope is infinite at 0.
const SMALLEST_SQUARE: f64 = 1e-24;

/// The state of a ring: webbing that has slipped through it.
pub struct Ring<'g> {
    /// Index of the state.
    index: usize,
    /// s \[m\].
    pub slipped: Expr<'g>,
}

/// The states of the rings of a belt.
pub fn rings<'g>(law: Law<'_, 'g>, applied: &mut AppliedForces<'g>) -> Vec<Ring<'g>> {
    let states = law.belt.rings.iter().map(|ring| {
        let name = format!("belt {}: slip through {}", law.name, ring.name);
        let (index, slipped) = applied.auxiliary(name, "m", law.graph.constant(0.0));
        Ring { index, slipped }
    });
    states.collect()
}

/// Rates at which webbing moves \[m/s\].
#[derive(Default)]
pub struct Slips<'g> {
    /// Through each ring, from the side of `from`.
    through: Vec<Expr<'g>>,
    /// Off a film spool, if there is one.
    given: Option<Expr<'g>>,
}

/// Lets webbing slip from segment to segment, and come off a film spool. Returns the rates.
pub fn slip<'g>(
    law: Law<'_, 'g>,
    applied: &mut AppliedForces<'g>,
    rings: &[Ring<'g>],
    segments: &mut [Segment<'g>],
) -> Slips<'g> {
    let mut slips = Slips::default();
    let tensions: Vec<Expr<'g>> = segments.iter().map(|segment| segment.held(law)).collect();
    if !rings.is_empty() || law.belt.film_spool.is_some() {
        segments
            .iter()
            .for_each(|segment| segment.tell_held(applied));
    }
    if let Some(given) = segments[0].webbing.film(law, applied, tensions[0]) {
        segments[0].leaves(-given);
        slips.given = Some(given);
    }
    for (k, ring) in rings.iter().enumerate() {
        let (graph, given) = (law.graph, &law.belt.rings[k]);
        let [before, behind] = [tensions[k], tensions[k + 1]];
        let ratio = given
            .friction
            .as_ref()
            .map(|friction| ratio(graph, number(graph, friction), &segments[k..k + 2]));
        let times = |tension: Expr<'g>| ratio.map_or(tension, |ratio| ratio * tension);
        let (forth, back) = (behind - times(before), before - times(behind));
        let zero = graph.constant(0.0);
        let driven = forth.max(zero) * room(graph, &segments[k])
            - back.max(zero) * room(graph, &segments[k + 1]);
        let rate = driven / number(graph, &given.resistance);
        applied.states.auxiliaries[ring.index].next = rate;
        segments[k].leaves(rate);
        segments[k + 1].leaves(-rate);
        let owner = format!("belt {}: ring {}", law.name, given.name);
        applied.kink(format!("{owner} slips towards to"), move || back);
        applied.kink(format!("{owner} slips towards from"), move || forth);
        slips.through.push(rate);
    }
    slips
}

/// Adds the powers that are lost in the rings and the film spool.
pub fn works<'g>(
    law: Law<'_, 'g>,
    applied: &mut AppliedForces<'g>,
    slips: &Slips<'g>,
    segments: &[SegmentMeasures<'g>],
) {
    if let Some(given) = slips.given {
        let work = format!("belt {}: film spool", law.name);
        applied.work(work, Product::Scalars(-segments[0].tension, given));
    }
    let rings = slips.through.iter().zip(&law.belt.rings);
    for ((rate, ring), tensions) in rings.zip(segments.windows(2)) {
        let work = format!("belt {}: ring {}", law.name, ring.name);
        let difference = tensions[0].tension - tensions[1].tension;
        applied.work(work, Product::Scalars(difference, *rate));
    }
}

/// e^(μ θ) for the ring between two segments.
fn ratio<'g>(graph: &'g Graph, friction: Expr<'g>, segments: &[Segment<'g>]) -> Expr<'g> {
    let [before, behind] = [segments[0].direction, segments[1].direction];
    let least = graph.constant(SMALLEST_SQUARE);
    let across = before.cross(behind).squared().max(least).sqrt();
    let angle = across.atan2(before.dot(behind));
    let e = graph.constant(std::f64::consts::E);
    graph.call(Function::Power, &[e, friction * angle])
}

/// 1 if a segment has webbing that may slip out of it, 0 if it has run out; between them, a linear transition.
fn room<'g>(graph: &'g Graph, segment: &Segment<'g>) -> Expr<'g> {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let left = segment.webbing.length * graph.constant(1.0 / RUN_OUT) - one;
    left.max(zero).min(one)
}
