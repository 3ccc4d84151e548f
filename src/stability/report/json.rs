//! The table as JSON.

use crate::stability::Outcome;
use bryant_hard::{Bound, Check, Found};
use serde_json::{Value, json};

/// A list of cases, each with its checks.
pub fn json(outcomes: &[Outcome]) -> Value {
    let cases = outcomes.iter().map(|outcome| {
        json!({
            "group": outcome.case.group.title(),
            "case": outcome.case.name,
            "law": outcome.case.law,
            "holds": outcome.holds(),
            "broke_off": outcome.trouble.as_ref().map(ToString::to_string),
            "checks": outcome.checks.iter().map(check).collect::<Vec<_>>(),
        })
    });
    Value::Array(cases.collect())
}

fn check(check: &Check) -> Value {
    let mut value = json!({
        "variant": check.variant,
        "criterion": check.criterion,
        "because": check.because,
        "holds": check.holds(),
    });
    match &check.found {
        Found::Number {
            measured,
            bound,
            unit,
        } => {
            let (kind, bound) = match bound {
                Bound::AtMost(bound) => ("at_most", bound),
                Bound::AtLeast(bound) => ("at_least", bound),
            };
            value[kind] = json!(bound);
            value["measured"] = json!(measured);
            value["unit"] = json!(unit);
            value["margin"] = json!(check.margin());
        }
        Found::Statement { seen, .. } => value["seen"] = json!(seen),
    }
    value
}
