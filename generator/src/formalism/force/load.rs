//! A given force at a point of an element, and a given moment, in absolute axes.

use super::{Loads, Motion, components};
use crate::expression::Graph;
use crate::model::Load;

pub fn apply<'g>(graph: &'g Graph, motion: &Motion<'g>, loads: &mut Loads<'g>, load: &Load) {
    let point = motion.attachment(graph, &load.on);
    loads.apply(load.on.on, point.offset, components(graph, &load.force));
    loads.turn(load.on.on, components(graph, &load.moment));
}
