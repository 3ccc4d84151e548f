//! Rings that a belt slips through: the law of a rope on a drum (Euler, Eytelwein), with a resistance to slip.
//!
//! R = e^(μ θ),   θ = ∠(n_before, n_behind)
//!
//! c ṡ = max(T_behind − R T_before, 0) − max(T_before − R T_behind, 0)
//!
//! s is the untensioned length that has slipped from the segment before the ring into that behind it: a state. Between T_behind/T_before = 1/R
//! and R the webbing sticks, ṡ = 0 exactly. Beyond, it slips, and what the tensions exceed the ratio by is c ṡ. The tensions are those without
//! damping. c belongs to the law, and keeps ṡ a function of the state: webbing has no mass here that could be accelerated.
//!
//! Where a segment has run out, ℓ ≤ ℓ_e, no more slips from it, and up to 2 ℓ_e the slip slows down.

use super::{Law, Segment};
use crate::dynamics::force::{AppliedForces, Product};
use crate::dynamics::numbers::number;
use crate::expression::{Expr, Function, Graph};
use crate::law::belt::check::RUN_OUT;
use crate::law::belt::outputs::SegmentMeasures;

/// Smallest square of the sine of θ whose root is taken: the root has no slope at 0.
const SMALLEST_SQUARE: f64 = 1e-24;

/// The state of a ring.
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
    /// Through each ring.
    through: Vec<Expr<'g>>,
    /// Off a film spool, where there is one.
    given: Option<Expr<'g>>,
}

/// Lets webbing slip from segment to segment, and off a film spool.
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

/// Counts what is lost in the rings and the film spool.
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

/// e^(μ θ) between two segments.
fn ratio<'g>(graph: &'g Graph, friction: Expr<'g>, segments: &[Segment<'g>]) -> Expr<'g> {
    let [before, behind] = [segments[0].direction, segments[1].direction];
    let least = graph.constant(SMALLEST_SQUARE);
    let across = before.cross(behind).squared().max(least).sqrt();
    let angle = across.atan2(before.dot(behind));
    let e = graph.constant(std::f64::consts::E);
    graph.call(Function::Power, &[e, friction * angle])
}

/// 1 where a segment has webbing that may slip from it, 0 where it has run out.
fn room<'g>(graph: &'g Graph, segment: &Segment<'g>) -> Expr<'g> {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let left = segment.webbing.length * graph.constant(1.0 / RUN_OUT) - one;
    left.max(zero).min(one)
}
