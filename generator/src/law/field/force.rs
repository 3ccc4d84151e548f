//! Acceleration field: F = m a at the centre of gravity of each element that feels it.   \[MADYMO 1980, force model 2\]
//!
//! If all elements of a system feel a field, the field is not applied to each of them, but once, to the reference
//! joint.

use super::keys::Field;
use crate::force::{AppliedForces, Product, components};
use crate::force::{Equations, Measures, Setting};
use crate::model::{Body, ElementId};
use crate::motion::numbers::{number, vector};

impl Equations for Field {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        apply(self, setting, applied);
        Box::new(())
    }
}

fn apply<'g>(field: &Field, setting: Setting<'_, 'g>, applied: &mut AppliedForces<'g>) {
    let Setting {
        graph,
        model,
        motion,
        name,
        gate,
        ..
    } = setting;
    let Field { on, acceleration } = field;
    let acceleration = gate.of_vector(components(graph, acceleration));
    for &id in on {
        applied.work(format!("field {name}"), Product::Field(acceleration, id));
    }
    for (s, system) in model.systems.iter().enumerate() {
        let felt: Vec<usize> = (0..system.elements.len())
            .filter(|&k| {
                on.contains(&ElementId {
                    system: s,
                    element: k,
                })
            })
            .collect();
        if felt.len() == system.elements.len() {
            applied.wrenches.fields[s] = applied.wrenches.fields[s] + acceleration;
            continue;
        }
        for k in felt {
            let id = ElementId {
                system: s,
                element: k,
            };
            let element = &system.elements[k];
            let offset = motion
                .element(id)
                .rotation
                .times(vector(graph, &element.cg));
            applied.wrenches.partial_fields[s][k] =
                applied.wrenches.partial_fields[s][k] + acceleration;
            applied.apply(
                Body::Element(id),
                offset,
                number(graph, &element.mass) * acceleration,
            );
        }
    }
}
