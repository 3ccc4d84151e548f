//! A given force at a point of an element, and a given moment, in absolute axes.

use super::keys::Load;
use crate::force::{AppliedForces, Product, components};
use crate::force::{Equations, Measures, Setting};

impl Equations for Load {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        let Setting {
            graph,
            motion,
            name,
            gate,
            ..
        } = setting;
        let point = motion.attachment(graph, &self.on);
        let force = gate.of_vector(components(graph, &self.force));
        let moment = gate.of_vector(components(graph, &self.moment));
        applied.apply(self.on.on, point.offset, force);
        applied.turn(self.on.on, moment);
        let work = format!("load {name}");
        applied.work(&work, Product::Vectors(force, point.velocity));
        let omega = motion.body(self.on.on).omega;
        applied.work(&work, Product::Vectors(moment, omega));
        Box::new(())
    }
}
