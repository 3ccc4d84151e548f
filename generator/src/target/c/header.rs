//! The header of a model: sizes, names, and declarations of functions.

use super::methods::Function;
use super::names::Enumerators;
use super::{comment, number};
use crate::program::{Facts, Lists};
use std::fmt::Write as _;

/// The text of the header of a model. `about` is a comment that describes the model.
pub(super) fn header(lists: &Lists, name: &str, about: &str, functions: &[Function]) -> String {
    let upper = name.to_ascii_uppercase();
    let mut text = format!(
        "{about}\n#ifndef {upper}_H\n#define {upper}_H\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n"
    );
    sizes(&mut text, lists, &upper);
    let facts = &lists.facts;
    places(&mut text, facts, name);
    if facts.duration.is_finite() {
        let (duration, every) = (number(facts.duration), number(facts.every));
        let _ = writeln!(
            text,
            "/* Length of a run, and time between samples [s]. */\n#define {upper}_DURATION {duration}\n#define {upper}_EVERY {every}\n"
        );
    }
    structure(&mut text, lists, name);
    for function in functions {
        let _ = writeln!(text, "{}{};\n", function.about, function.head);
    }
    names(&mut text, facts, name);
    text.push_str("#ifdef __cplusplus\n}\n#endif\n\n#endif\n");
    text
}

fn sizes(text: &mut String, lists: &Lists, upper: &str) {
    let facts = &lists.facts;
    let sizes = [
        ("COORDINATES", facts.coordinates.len(), "length of q"),
        ("VELOCITIES", facts.velocities.len(), "length of v"),
        (
            "AUXILIARIES",
            facts.auxiliaries.len(),
            "length of z: states of laws, which are integrated",
        ),
        (
            "MEMORY",
            facts.memory.len(),
            "length of m: what laws remember, which changes between steps alone",
        ),
        (
            "STATE",
            facts.kinds.len(),
            "length of the state y: q, v, z, m",
        ),
        (
            "PARAMETERS",
            facts.parameters.len(),
            "numbers that can be set",
        ),
        ("OUTPUTS", facts.outputs.len(), "outputs"),
        (
            "EVENT_FUNCTIONS",
            facts.event_functions.len(),
            "functions at whose change of sign a step is to end",
        ),
        (
            "KINKS",
            facts.kinks.len(),
            "functions at whose change of sign a force is not smooth",
        ),
        (
            "ONSETS",
            facts.onsets.len(),
            "gaps at whose end something begins to act",
        ),
        ("CURVES", facts.curves.len(), "arguments of curves"),
        ("PIVOTS", facts.pivots.len(), "inertias that may vanish"),
        (
            "CONDITIONS",
            facts.conditions.len(),
            "what parameters must keep",
        ),
        ("POWERS", facts.powers.len(), "effects that do work"),
    ];
    text.push_str("enum {\n");
    for (what, size, words) in sizes {
        let _ = writeln!(text, "    {upper}_{what} = {size}, /* {words} */");
    }
    text.push_str("};\n\n");
}

/// Writes enumerations of the entries of the state, the parameters and the outputs.
fn places(text: &mut String, facts: &Facts, name: &str) {
    let mut taken = Enumerators::default();
    let state = [
        &facts.coordinates,
        &facts.velocities,
        &facts.auxiliaries,
        &facts.memory,
    ];
    let state = state.into_iter().flatten().zip(&facts.units);
    let state = state.map(|(name, unit)| (name.as_str(), unit.as_str(), String::new()));
    let outputs = facts.outputs.iter();
    let outputs = outputs.map(|output| (output.name.as_str(), output.unit.as_str(), String::new()));
    let parameters = facts.parameters.iter().map(|parameter| {
        let bound = |words: &str, value: f64| match value.is_finite() {
            true => format!(", {words} {value}"),
            false => String::new(),
        };
        let least = bound("at least", parameter.min);
        let most = bound("at most", parameter.max);
        let words = format!("default {}{least}{most}", parameter.default);
        (parameter.name.as_str(), parameter.unit.as_str(), words)
    });
    let groups: [(&str, &str, Vec<_>); 3] = [
        ("Places in the state y, with units.", "y", state.collect()),
        (
            "Places among the parameters, with units, defaults and bounds.",
            "parameter",
            parameters.collect(),
        ),
        (
            "Places among the outputs, with units.",
            "output",
            outputs.collect(),
        ),
    ];
    for (title, kind, members) in groups {
        if members.is_empty() {
            continue;
        }
        let _ = writeln!(text, "/* {title} */\nenum {{");
        for (place, (words, unit, more)) in members.into_iter().enumerate() {
            let enumerator = taken.take(&format!("{name}_{kind}"), words);
            let unit = if unit.is_empty() { "-" } else { unit };
            let more = if more.is_empty() {
                more
            } else {
                format!(": {more}")
            };
            let words = comment(&format!("{words} [{unit}]{more}"));
            let _ = writeln!(text, "    {enumerator} = {place}, /* {words} */");
        }
        text.push_str("};\n\n");
    }
}

fn structure(text: &mut String, lists: &Lists, name: &str) {
    let members = [
        ("parameters", lists.facts.parameters.len()),
        ("derived", lists.derived),
    ];
    let mut body = String::new();
    for (member, count) in members {
        if count > 0 {
            let _ = writeln!(body, "    double {member}[{count}];");
        }
    }
    if body.is_empty() {
        body.push_str("    char nothing;\n");
    }
    let _ = writeln!(
        text,
        "/* Parameters, and what depends on them alone. {name}_new fills it in; nothing else writes it. */\n\
         typedef struct {{\n{body}}} {name}_model;\n"
    );
}

/// Tables of names, units and descriptions: the name of each array, that of its length, and its entries.
pub(super) fn tables(facts: &Facts) -> Vec<(&'static str, &'static str, Vec<&str>)> {
    let state = [
        &facts.coordinates,
        &facts.velocities,
        &facts.auxiliaries,
        &facts.memory,
    ];
    let outputs = facts.outputs.iter();
    let parameters = facts.parameters.iter();
    let mut tables = vec![
        (
            "state_names",
            "STATE",
            state.into_iter().flatten().map(String::as_str).collect(),
        ),
        (
            "state_units",
            "STATE",
            facts.units.iter().map(String::as_str).collect(),
        ),
        (
            "output_names",
            "OUTPUTS",
            outputs.clone().map(|output| output.name.as_str()).collect(),
        ),
        (
            "output_units",
            "OUTPUTS",
            outputs.map(|output| output.unit.as_str()).collect(),
        ),
        (
            "parameter_names",
            "PARAMETERS",
            parameters
                .clone()
                .map(|parameter| parameter.name.as_str())
                .collect(),
        ),
        (
            "parameter_units",
            "PARAMETERS",
            parameters
                .map(|parameter| parameter.unit.as_str())
                .collect(),
        ),
        (
            "condition_names",
            "CONDITIONS",
            facts.conditions.iter().map(String::as_str).collect(),
        ),
        (
            "power_names",
            "POWERS",
            facts.powers.iter().map(String::as_str).collect::<Vec<_>>(),
        ),
    ];
    tables.retain(|(_, _, members)| !members.is_empty());
    tables
}

fn names(text: &mut String, facts: &Facts, name: &str) {
    let upper = name.to_ascii_uppercase();
    text.push_str("/* Names and SI units, in order. */\n");
    for (table, size, _) in tables(facts) {
        let _ = writeln!(
            text,
            "extern const char *const {name}_{table}[{upper}_{size}];"
        );
    }
    text.push('\n');
}
