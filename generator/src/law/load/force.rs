//! A given force at a point of an element, and a given moment, in absolute axes.

use crate::dynamics::force::switch::Gate;
use crate::dynamics::force::{Loads, Motion, Product, components};
use crate::expression::Graph;
use crate::model::Load;

pub fn apply<'g>(
    graph: &'g Graph,
    motion: &Motion<'g>,
    loads: &mut Loads<'g>,
    name: &str,
    gate: Gate<'g>,
    load: &Load,
) {
    let point = motion.attachment(graph, &load.on);
    let force = gate.of_vector(components(graph, &load.force));
    let moment = gate.of_vector(components(graph, &load.moment));
    loads.apply(load.on.on, point.offset, force);
    loads.turn(load.on.on, moment);
    let work = format!("load {name}");
    loads.work(&work, Product::Vectors(force, point.velocity));
    let omega = motion.body(load.on.on).omega;
    loads.work(&work, Product::Vectors(moment, omega));
}
