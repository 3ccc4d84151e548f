//! The conditions that parameters must satisfy so that the model is valid: the requirements on its numbers, as far as
//! parameters decide them.
//!
//! The default values were checked by the same requirements when the description was read. The values of a run are
//! checked before it begins.

use crate::equations::Condition;
use crate::expression::{Expr, Graph};
use crate::law::ForceKind;
use crate::model::{Model, Number, Rule};
use crate::motion::Motion;
use crate::motion::numbers::number;

/// The conditions that parameters decide, each once; `start` is the motion at the start of a run.
pub fn of<'g>(graph: &'g Graph, model: &Model, start: &Motion<'g>) -> Vec<Condition> {
    graph.section("what parameters must keep");
    let mut conditions = Vec::new();
    let mut add = |name: String, value: Expr<'_>, rule: Rule| {
        let condition = Condition {
            name,
            value: value.id(),
            rule,
        };
        let same = |other: &Condition| {
            other.value == condition.value
                && (other.rule == condition.rule || condition.rule == Rule::Finite)
        };
        if value.as_constant().is_none() && !conditions.iter().any(same) {
            conditions.push(condition);
        }
    };
    for requirement in model.requirements() {
        // parameters themselves are checked to be finite
        if requirement.rule != Rule::Finite || !matches!(requirement.value, Number::Parameter(_)) {
            let value = number(graph, &requirement.value);
            add(requirement.sentence, value, requirement.rule);
        }
    }
    for force in &model.forces {
        if let Some((name, value)) =
            ForceKind::of(force)
                .equations()
                .condition(graph, start, &force.name)
        {
            add(name, value, Rule::NotNegative);
        }
    }
    for number in model.clone().numbers_mut() {
        if !matches!(number, Number::Parameter(_)) {
            let value = self::number(graph, number);
            add(made_of(model, number), value, Rule::Finite);
        }
    }
    conditions
}

/// The words for a condition on a number that depends on parameters.
fn made_of(model: &Model, number: &Number) -> String {
    let mut names: Vec<&str> = Vec::new();
    number.for_each_parameter(&mut |index| {
        let name = model.parameters[index].name.as_str();
        if !names.contains(&name) {
            names.push(name);
        }
    });
    format!("the number made of {} must be finite", names.join(", "))
}
