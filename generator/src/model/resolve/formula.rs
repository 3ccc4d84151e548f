//! Outputs that are computed from others: sums, differences, products, roots, with their units.

use super::Resolver;
use super::output::heading;
use super::quantity::Measure;
use super::units::unit_shown;
use crate::description::expression;
use crate::description::output::Formula as Written;
use crate::description::place::At;
use crate::description::unit::{Dimension, product};
use crate::diagnostic::{quoted, suggestion};
use crate::model::{Formula, Leaf, Number, Output, Quantity};
use std::cell::RefCell;

/// The checked form of a formula; `None` if it is wrong or switched off. `headings` are the headings of the outputs so
/// far, including those that are switched off.
pub(super) fn formula(
    resolver: &mut Resolver<'_>,
    written: &Written,
    at: At<'_>,
    headings: &mut Vec<String>,
) -> Option<Output> {
    let above = headings.clone();
    heading(resolver, &written.name, at.key("name"), headings);
    let place = at.key("formula");
    let leaves = RefCell::new(Vec::new());
    let leaf = |leaf: Leaf| {
        let mut leaves = leaves.borrow_mut();
        leaves.push(leaf);
        Number::Parameter(leaves.len() - 1)
    };
    let output = |name: &str, report: &dyn Fn(String, String)| {
        let (quantity, dimension) = output_above(resolver, name, &above, report)?;
        Some((leaf(Leaf::Quantity(quantity)), Measure::Known(dimension)))
    };
    let with = written.with.as_ref().map_or(&[][..], |with| &with.0);
    let mut standing = Vec::new();
    for (word, name) in with {
        let of_word = at.key("with").key(word);
        let report = |message, help| resolver.problems.add(of_word.problem(message, help));
        if resolver.check_parameter_name(word, of_word) {
            standing.push((word.as_str(), output(name, &report)));
        }
    }
    let parsed = match expression::parse(&written.formula) {
        Ok(parsed) => parsed,
        Err(m) => {
            let problem = place.text_problem(m.offset, m.length, m.message, m.help);
            resolver.problems.add(problem);
            return None;
        }
    };
    let names = |name: &str, offset: usize, length: usize| {
        if let Some((_, found)) = standing.iter().find(|(word, _)| *word == name) {
            return found.clone();
        }
        let report = |message, help| {
            let problem = place.text_problem(offset, length, message, help);
            resolver.problems.add(problem);
        };
        if resolver.parameters.iter().any(|p| p.name == name) && !above.iter().any(|h| h == name) {
            resolver.inputs_may_stand.set(true);
            let found = resolver.parameter(name, place, offset, length);
            resolver.inputs_may_stand.set(false);
            let (number, measure) = found?;
            return Some((leaf(Leaf::Number(number)), measure));
        }
        output(name, &report)
    };
    let (value, measure) = resolver.expression(&parsed, place, &names)?;
    let leaves = leaves.into_inner();
    if !leaves.iter().any(|leaf| matches!(leaf, Leaf::Quantity(_))) {
        resolver.problems.add(place.problem(
            "the formula names no output",
            "name outputs that stand above it: by their names where these are words, by `with: { a: NAME }` otherwise",
        ));
    }
    let unit = match measure {
        Measure::Known(dimension) => dimension.to_string(),
        Measure::Bare => String::new(),
        Measure::Unknown => {
            resolver.problems.add(place.problem(
                "the unit of the formula is not known, because a parameter in it has none",
                "give the parameter a value with a unit, as `{ value: 0.2 m }`, or write the number with its unit",
            ));
            return None;
        }
    };
    if let Some(shown) = &written.unit {
        unit_shown(resolver, shown, &unit, &written.name, at.key("unit"));
    }
    (written.enabled != Some(false)).then(|| Output {
        name: written.name.clone(),
        quantity: Quantity::Formula(Box::new(Formula { value, leaves })),
        unit,
        code: None,
        filter: None,
        channel: None,
    })
}

/// The quantity of an output that is defined above the formula, and its dimension. Calls `report` if there is none.
fn output_above(
    resolver: &Resolver<'_>,
    name: &str,
    above: &[String],
    report: &dyn Fn(String, String),
) -> Option<(Quantity, Dimension)> {
    let found = resolver.outputs.iter().find(|output| output.name == name);
    let Some(output) = found else {
        let (message, help) = match above.iter().any(|heading| heading == name) {
            // if the output above is wrong, that has been reported there
            true if resolver.problems.count() > 0 => return None,
            true => (
                format!("the output {} is switched off", quoted(name)),
                "switch it on, or leave it out of the formula".to_owned(),
            ),
            false => (
                format!("no output above is called {}", quoted(name)),
                suggestion(
                    name,
                    above.iter().map(String::as_str),
                    "write the outputs of a formula above it",
                ),
            ),
        };
        report(message, help);
        return None;
    };
    if output.filter.is_some() {
        report(
            format!(
                "the output {} is filtered, and a formula takes what is not",
                quoted(name)
            ),
            "name an output without `filter`, which may be a second one of the same quantity"
                .to_owned(),
        );
        return None;
    }
    let unit = product(&output.unit);
    let dimension = unit.map_or(Dimension::ONE, |unit| unit.dimension);
    Some((output.quantity.clone(), dimension))
}
