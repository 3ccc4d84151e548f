//! Finds when a law begins to act, so that a run can tell that no step has skipped a short action.
//!
//! The *gap* of a law is positive while the law certainly does not act; its *speed* is an upper bound of the rate of
//! change of the gap. If the gaps at the ends of a time h are g₀ and g₁ and the speed in between is at most c, no gap
//! in between is below (g₀ + g₁ − c h)/2.
//!
//! | law | gap | speed |
//! |---|---|---|
//! | belt | ℓ − L | \|ḋ\| + \|ṙ\| |
//! | stop | angle left to the stop | \|θ̇\| |
//! | corner of a curve | distance of the abscissa from the corner, with a sign that changes at each corner | speed of the abscissa |
//!
//! A belt has the length ℓ, and the path between its points has the length L. ḋ is the relative velocity of its points,
//! ṙ the rate at which it is taken in; webbing that leaves through rings or off a film spool adds its rate. Speeds are
//! relative between the two bodies, so bodies that move together have no speed. Those of contacts are with
//! [contacts](crate::law::contact).

use super::AppliedForces;
use super::events::exact;
use super::switch::Gate;
use crate::expression::passes::Recall;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::model::ScaledCurve;
use crate::motion::numbers::{breakpoint_indicator, rate};

/// The gap of a law that cannot begin before another event, such as a switch.
pub const FAR: f64 = 1e30;

/// The name of an onset, and the function that makes it after all other expressions are made.
pub type DeferredOnset<'g> = (String, Box<dyn Fn() -> Onset<'g> + 'g>);

/// The gap and the speed of a law.
#[derive(Clone, Copy)]
pub struct Onset<'g> {
    /// Positive while the law certainly does not act.
    pub gap: Expr<'g>,
    /// Upper bound of the rate of change of the gap, in the gap's unit per second.
    pub speed: Expr<'g>,
}

impl<'g> AppliedForces<'g> {
    /// Adds the onset of a law. `onset` is called after all other expressions are made.
    pub(crate) fn onset(&mut self, name: impl Into<String>, onset: impl Fn() -> Onset<'g> + 'g) {
        self.events.onsets.push((name.into(), Box::new(onset)));
    }

    /// Adds the onset of a curve of the state that is 0 on an interval: the gap is the distance of the argument from
    /// the end of the interval. `speed` is the rate of the argument, of any sign.
    pub(crate) fn onset_of_curve(
        &mut self,
        owner: &str,
        gate: Gate<'g>,
        curve: &ScaledCurve,
        argument: impl Fn() -> Expr<'g> + 'g,
        speed: Expr<'g>,
    ) {
        let idle = self.events.idle[curve.curve].clone();
        if idle.is_empty() {
            return;
        }
        let curve = curve.clone();
        self.onset(format!("{owner}: leaves where its curve is 0"), move || {
            let scale = rate(speed.graph(), &curve);
            let (x, graph) = (argument() * scale, speed.graph());
            let inside = |[from, to]: &[f64; 2]| {
                let above = from.is_finite().then(|| x - graph.constant(*from));
                let below = to.is_finite().then(|| graph.constant(*to) - x);
                match (above, below) {
                    (Some(above), Some(below)) => above.min(below),
                    (one, other) => one.or(other).unwrap_or(graph.constant(FAR)),
                }
            };
            let all = idle.iter().map(inside);
            gate.of_onset(Onset {
                gap: all.reduce(Expr::max).unwrap_or(graph.constant(FAR)),
                speed: absolute(speed * scale),
            })
        });
    }

    /// Adds the corners of a curve of the state as onsets, so that a step that passes a corner and returns is noticed.
    /// `which` names the curve of the `owner` for people; `speed` is the rate of the argument, of any sign.
    pub(crate) fn corners(
        &mut self,
        owner: &str,
        which: &str,
        gate: Gate<'g>,
        curve: &ScaledCurve,
        argument: impl Fn() -> Expr<'g> + 'g,
        speed: impl Fn() -> Expr<'g> + 'g,
    ) {
        if !self.events.kinked[curve.curve] {
            return;
        }
        let (name, curve) = (format!("{owner}: corner of the {which}"), curve.clone());
        let corner = move || {
            let (argument, speed) = (argument(), speed());
            let graph = argument.graph();
            gate.of_onset(Onset {
                gap: breakpoint_indicator(graph, &curve, argument),
                speed: absolute(speed * rate(graph, &curve)),
            })
        };
        self.events.corners.push((name, Box::new(corner)));
    }

    /// The depth of a contact up to which its curve is 0, in the unit of the curve's argument.
    pub(crate) fn lead(&self, graph: &'g Graph, curve: &ScaledCurve) -> Expr<'g> {
        let from_zero = |interval: &&[f64; 2]| interval[0] <= 0.0 && 0.0 < interval[1];
        let idle = self.events.idle[curve.curve].iter().find(from_zero);
        match idle {
            Some([_, to]) if to.is_finite() => graph.constant(*to) / rate(graph, curve),
            Some(_) => graph.constant(FAR),
            None => graph.constant(0.0),
        }
    }

    /// The onsets of all laws, and the corners of their curves.
    pub fn onsets(&self, graph: &'g Graph) -> [Vec<(String, Onset<'g>)>; 2] {
        [&self.events.onsets, &self.events.corners].map(|onsets| Self::made(graph, onsets))
    }

    fn made(graph: &'g Graph, onsets: &[DeferredOnset<'g>]) -> Vec<(String, Onset<'g>)> {
        let mut exact = Recall::new(graph, exact);
        let made = onsets.iter().map(|(name, onset)| {
            graph.section(format!("onset {name}"));
            let Onset { gap, speed } = onset();
            // a second derivative says something of a distance alone, not of a bound of it
            let gap = exact.expression(gap);
            (name.clone(), Onset { gap, speed })
        });
        // an onset that depends on parameters alone cannot begin during a run
        let changes =
            |onset: &Onset<'g>| onset.gap.as_constant().is_none() && !onset.speed.is_zero();
        made.filter(|(_, onset)| changes(onset)).collect()
    }
}

/// The length of a vector.
pub fn size<'g>(vector: Vec3<'g>) -> Expr<'g> {
    let parts: Vec<Expr<'g>> = vector
        .0
        .into_iter()
        .filter(|part| !part.is_zero())
        .collect();
    match parts[..] {
        [] => vector.0[0].graph().constant(0.0),
        [one] => one.max(-one),
        _ => vector.squared().sqrt(),
    }
}

/// |x|
pub fn absolute<'g>(x: Expr<'g>) -> Expr<'g> {
    x.max(-x)
}
