//! Acceleration field: F = m a at the centre of gravity of each element that feels it.   \[MADYMO 1980, force model 2\]
//!
//! A field that all elements of a system feel is not applied to them one by one: it enters once, at the reference joint.

use crate::dynamics::force::switch::Gate;
use crate::dynamics::force::{Loads, Motion, Product, components};
use crate::dynamics::numbers::{number, vector};
use crate::expression::Graph;
use crate::model::{Body, ElementId, FieldComponent, Model};

#[expect(clippy::too_many_arguments, reason = "as all laws, and its own two")]
pub fn apply<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    loads: &mut Loads<'g>,
    name: &str,
    gate: Gate<'g>,
    on: &[ElementId],
    acceleration: &[FieldComponent; 3],
) {
    let acceleration = gate.of_vector(components(graph, acceleration));
    for &id in on {
        loads.work(format!("field {name}"), Product::Field(acceleration, id));
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
            loads.fields[s] = loads.fields[s] + acceleration;
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
            loads.partial_fields[s][k] = loads.partial_fields[s][k] + acceleration;
            loads.apply(
                Body::Element(id),
                offset,
                number(graph, &element.mass) * acceleration,
            );
        }
    }
}
