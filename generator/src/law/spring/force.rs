//! Springs between two points, with a damper in parallel: both pull and push.
//!
//! L is the distance of the ends and u the unit vector from the first to the second. F = f(L − L₀) + d L̇ acts on the
//! first end along u, and the opposite on the second.

use super::keys::Spring;
use super::outputs::SpringMeasures;
use crate::force::{Acts, AppliedForces, Product};
use crate::force::{Equations, Measures, Setting};
use crate::law::belt::force::length;
use crate::motion::Motion;
use crate::motion::numbers::{curve, number};

impl Equations for Spring {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        Box::new(apply(self, setting, applied))
    }
}

fn apply<'g>(
    spring: &Spring,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> SpringMeasures<'g> {
    let Setting {
        graph,
        motion,
        start,
        name,
        gate,
        ..
    } = setting;
    let ends =
        |motion: &Motion<'g>| [&spring.from, &spring.to].map(|end| motion.attachment(graph, end));
    let [from, to] = ends(motion);
    let span = to.position - from.position;
    let distance = length(graph, span.squared());
    let direction = distance.recip() * span;
    let rate = direction.dot(to.velocity - from.velocity);
    let relaxed = match &spring.length {
        Some(length) => number(graph, length),
        // the length at the start of a run
        None => {
            let [from, to] = ends(start);
            length(graph, (to.position - from.position).squared())
        }
    };
    let elongation = distance - relaxed;

    let owner = format!("spring {name}");
    let mut force = graph.constant(0.0);
    if let Some(elastic) = &spring.elastic {
        let curves = applied.curves_so_far();
        let argument = move || elongation;
        applied.curve_of_state(
            &owner,
            "elastic curve",
            "m",
            elastic,
            Acts::Everywhere,
            argument,
        );
        applied.onset_of_curve(&owner, gate, elastic, argument, rate);
        applied.corners(
            &owner,
            "elastic curve",
            gate,
            elastic,
            argument,
            move || rate,
        );
        if gate.waits() {
            applied.curves_act(curves, gate.of(graph.constant(1.0)));
        }
        let pull = gate.of(curve(graph, elastic, elongation));
        applied.work(format!("{owner}: elastic"), Product::Scalars(-pull, rate));
        force = force + pull;
    }
    if let Some(damping) = &spring.damping {
        let pull = gate.of(number(graph, damping) * rate);
        applied.work(format!("{owner}: damping"), Product::Scalars(-pull, rate));
        force = force + pull;
    }
    let on_first = force * direction;
    applied.apply(spring.from.on, from.offset, on_first);
    applied.apply(spring.to.on, to.offset, -on_first);
    SpringMeasures {
        on_first,
        force,
        length: distance,
        elongation,
        rate,
    }
}
