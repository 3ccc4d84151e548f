//! What parameters must keep so that the model is one at all: what is required of each number of it, as far as parameters decide.
//!
//! At the defaults the description was judged by the same requirements; what a run sets is judged before it begins.

use super::kinematics::Motion;
use super::numbers::number;
use crate::equations::Condition;
use crate::expression::{Expr, Graph};
use crate::model::{Model, Number, Rule};

/// Those that parameters decide, each once; `start` is the motion where a run starts.
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
        // parameters themselves are finite
        if requirement.rule != Rule::Finite || !matches!(requirement.value, Number::Parameter(_)) {
            let value = number(graph, &requirement.value);
            add(requirement.sentence, value, requirement.rule);
        }
    }
    for force in &model.forces {
        if let Some((name, value)) = force.kind.condition(graph, start, &force.name) {
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

/// What is required of any number that is made of parameters.
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
