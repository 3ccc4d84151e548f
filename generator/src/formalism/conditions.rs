//! What parameters must keep so that the model stays a body in motion: masses, moments, stretches of curves.
//!
//! The description was checked at the defaults of its parameters; what a run sets is checked before it begins.

use super::kinematics::path;
use super::numbers::number;
use crate::equations::Condition;
use crate::expression::{Expr, Graph};
use crate::model::{Dimension, ElementId, Model, Number};

/// Relative excess of a moment over the sum of the others that is rounding, as in the description.
const ROUNDING: f64 = 1e-9;

/// Those that parameters decide, each once.
pub fn of(graph: &Graph, model: &Model) -> Vec<Condition> {
    graph.section("what parameters must keep");
    let mut conditions = Vec::new();
    let mut add = |name: String, value: Expr<'_>, positive: bool| {
        let condition = Condition {
            name,
            value: value.id(),
            positive,
        };
        let same = |other: &Condition| {
            other.value == condition.value && other.positive == condition.positive
        };
        if value.as_constant().is_none() && !conditions.iter().any(same) {
            conditions.push(condition);
        }
    };
    for (system, elements) in model.systems.iter().map(|s| &s.elements).enumerate() {
        for (element, body) in elements.iter().enumerate() {
            let label = path(model, ElementId { system, element });
            let mass = number(graph, &body.mass);
            add(format!("the mass of {label} is positive"), mass, true);
            let moments = body.inertia.each_ref().map(|moment| number(graph, moment));
            for moment in moments {
                let name = format!("no moment of inertia of {label} is negative");
                add(name, moment, false);
            }
            if model.dimension == Dimension::Space {
                let [x, y, z] = moments;
                let sum = graph.constant(1.0 + ROUNDING) * (x + y + z);
                for moment in moments {
                    let name = format!(
                        "no moment of inertia of {label} is above the sum of the other two"
                    );
                    add(name, sum - graph.constant(2.0) * moment, false);
                }
            }
        }
    }
    let mut uses = model.clone();
    let stretches = uses.curve_uses_mut().into_iter();
    for stretch in stretches.map(|curve| curve.stretch.clone()) {
        let name = match &stretch {
            Number::Parameter(index) => {
                format!(
                    "the stretch of a curve, {}, is positive",
                    model.parameters[*index].name
                )
            }
            _ => "the stretch of a curve is positive".to_owned(),
        };
        add(name, number(graph, &stretch), true);
    }
    conditions
}
