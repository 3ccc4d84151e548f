//! Reads the value of a parameter in `parameters`: an interval, a distribution, or a list of values.

use super::reader::{Reader, items, optional};
use crate::distribution::Distribution;
use crate::facts::ParameterFact;
use crate::normal;
use crate::study::{Levels, MOST_ROWS};
use bryant_generator::description::place::At;

const KINDS: [&str; 5] = ["from", "normal", "lognormal", "triangular", "values"];
const HELP: &str = "write `{ from: a, to: b }`, `{ normal: { mean: m, deviation: s } }`, `{ lognormal: { median: m, deviation: s } }`, \
                    `{ triangular: { from: a, mode: m, to: b } }` or `{ values: [a, b, c] }`";

/// The values of a parameter in a grid.
pub fn levels(reader: &Reader, at: At<'_>, fact: &ParameterFact) -> Option<Levels> {
    let keys = ["from", "to", "steps", "values"];
    reader.only(at, "a parameter of a grid", &keys);
    if optional(at, "values").is_some() {
        let values = values(reader, at, fact)?;
        return allowed(reader, at, fact, &values).then_some(Levels::Values(values));
    }
    let help = "a grid needs `{ from: a, to: b, steps: n }` or `{ values: [a, b, c] }`";
    let steps = reader
        .required(at, "steps", help)
        .and_then(|at| reader.count(at, "the number of steps"));
    let [from, to] = interval(reader, at, fact)?;
    let count = steps?;
    if count > MOST_ROWS {
        let message = format!("\"{}\" has {count} steps", fact.name);
        reader.add(at.key("steps").problem(message, "take fewer steps"));
        return None;
    }
    if count == 1 {
        let message = format!("one step does not go from {from} to {to}");
        reader.add(
            at.key("steps")
                .problem(message, "take at least 2 steps, or `{ values: [a] }`"),
        );
        return None;
    }
    inside(reader, at, fact, [from, to]).then_some(Levels::Steps { from, to, count })
}

/// A distribution.
pub fn read(reader: &Reader, at: At<'_>, fact: &ParameterFact) -> Option<Distribution> {
    let kinds: Vec<&str> = KINDS
        .into_iter()
        .filter(|kind| at.node.get(kind).is_some())
        .collect();
    let keys: &[&str] = match kinds[..] {
        ["from"] => &["from", "to"],
        ["normal"] => &["normal", "min", "max"],
        ["lognormal"] => &["lognormal", "min", "max"],
        ["triangular"] => &["triangular"],
        ["values"] => &["values", "weights"],
        _ => {
            let message = format!("it is not clear how \"{}\" is distributed", fact.name);
            reader.add(at.problem(message, HELP));
            return None;
        }
    };
    if let (Some(steps), "from") = (optional(at, "steps"), kinds[0]) {
        let help = "remove it: steps are those of `design: grid`; here `runs` decides";
        reader.add(steps.key_problem("`steps` has no meaning with this design", help));
        return None;
    }
    reader.only(at, "the distribution", keys);
    let distribution = match kinds[0] {
        "from" => {
            let [from, to] = interval(reader, at, fact)?;
            Distribution::Uniform { from, to }
        }
        "triangular" => triangular(reader, at.key("triangular"), fact)?,
        "values" => {
            let values = values(reader, at, fact)?;
            let weights = weights(reader, at, values.len())?;
            return allowed(reader, at, fact, &values)
                .then_some(Distribution::Discrete { values, weights });
        }
        kind => bell(reader, at, fact, kind)?,
    };
    let found = distribution.support();
    inside(reader, at, fact, found).then_some(distribution)
}

fn interval(reader: &Reader, at: At<'_>, fact: &ParameterFact) -> Option<[f64; 2]> {
    let end = |key| {
        let help = "an interval is `{ from: a, to: b }`";
        let at = reader.required(at, key, help)?;
        reader.quantity(at, &fact.unit)
    };
    let (from, to) = (end("from"), end("to"));
    let (from, to) = (from?, to?);
    if from < to {
        return Some([from, to]);
    }
    let message = format!("the interval of \"{}\" goes from {from} to {to}", fact.name);
    reader.add(at.problem(
        message,
        "`from` is less than `to`; one value for all runs stands under `fixed`",
    ));
    None
}

fn triangular(reader: &Reader, at: At<'_>, fact: &ParameterFact) -> Option<Distribution> {
    let mode = optional(at, "mode").and_then(|at| reader.quantity(at, &fact.unit));
    let [from, to] = interval(reader, at, fact)?;
    let mode = mode?;
    if (from..=to).contains(&mode) {
        return Some(Distribution::Triangular { from, mode, to });
    }
    let message = format!("the mode {mode} is not between {from} and {to}");
    reader.add(at.key("mode").problem(
        message,
        "the mode is the most probable value: it lies between `from` and `to`",
    ));
    None
}

fn values(reader: &Reader, at: At<'_>, fact: &ParameterFact) -> Option<Vec<f64>> {
    let at = at.key("values");
    let items = items(at);
    if items.is_empty() {
        reader.add(at.problem("there are no values", "write at least one"));
        return None;
    }
    let read: Vec<_> = items
        .iter()
        .map(|at| reader.quantity(*at, &fact.unit))
        .collect();
    read.into_iter().collect()
}

/// Weights as shares of 1; equal weights if none are given.
fn weights(reader: &Reader, at: At<'_>, count: usize) -> Option<Vec<f64>> {
    let Some(at) = optional(at, "weights") else {
        return Some(vec![1.0 / count as f64; count]);
    };
    let items = items(at);
    let read: Vec<_> = items
        .iter()
        .map(|at| reader.positive(*at, "", "a weight"))
        .collect();
    let weights: Vec<f64> = read.into_iter().collect::<Option<_>>()?;
    let sum: f64 = weights.iter().sum();
    if weights.len() != count || !sum.is_finite() {
        let message = format!("there are {} weights of {count} values", weights.len());
        reader.add(at.problem(message, "write one weight per value"));
        return None;
    }
    Some(weights.iter().map(|w| w / sum).collect())
}

/// A normal or lognormal distribution with checked tails.
fn bell(reader: &Reader, at: At<'_>, fact: &ParameterFact, kind: &str) -> Option<Distribution> {
    let (middle, unit) = if kind == "normal" {
        ("mean", fact.unit.as_str())
    } else {
        ("median", "")
    };
    let inner = at.key(kind);
    let centre = optional(inner, middle).and_then(|at| match kind {
        "normal" => reader.quantity(at, &fact.unit),
        _ => reader.positive(at, &fact.unit, "the median"),
    });
    let deviation = optional(inner, "deviation");
    let deviation = deviation.and_then(|at| reader.positive(at, unit, "the deviation"));
    let end = |key| match optional(at, key) {
        Some(at) => reader.quantity(at, &fact.unit).map(Some),
        None => Some(None),
    };
    let (min, max) = (end("min"), end("max"));
    let (centre, deviation, min, max) = (centre?, deviation?, min?, max?);
    if let (Some(low), Some(high)) = (min, max)
        && low >= high
    {
        let message = format!("nothing lies between {low} and {high}");
        reader.add(at.problem(message, "`min` is less than `max`"));
        return None;
    }
    let distribution = if kind == "normal" {
        Distribution::Normal {
            mean: centre,
            deviation,
            min,
            max,
        }
    } else {
        Distribution::Lognormal {
            median: centre,
            deviation,
            min,
            max,
        }
    };
    let ends = distribution.ends();
    let empty = kind == "lognormal" && max.is_some_and(|max| max <= 0.0);
    // a smaller probability is lost in rounding
    let mass = normal::between(ends[0], ends[1]);
    if empty || mass.is_nan() || mass < 1e-290 {
        let message = format!(
            "the distribution of \"{}\" has no probability between its ends",
            fact.name
        );
        reader.add(at.problem(message, format!("`min` and `max` lie around the {middle}")));
        return None;
    }
    Some(distribution)
}

/// Checks that all possible values lie within the bounds of the parameter.
fn inside(reader: &Reader, at: At<'_>, fact: &ParameterFact, found: [f64; 2]) -> bool {
    if fact.allows(found) {
        return true;
    }
    let tail = |end: f64, bound: Option<f64>, key: &str| {
        let bound = bound.filter(|_| end.is_infinite())?;
        Some(format!("`{key}: {bound}`"))
    };
    let tails = [
        tail(found[0], fact.min, "min"),
        tail(found[1], fact.max, "max"),
    ];
    let tails: Vec<String> = tails.into_iter().flatten().collect();
    let (message, help) = if tails.is_empty() {
        (
            format!(
                "values of \"{}\" from {} to {} leave its bounds",
                fact.name, found[0], found[1]
            ),
            format!("in the model it is {}", fact.bounds()),
        )
    } else {
        (
            format!(
                "the tails of the distribution of \"{}\" leave its bounds",
                fact.name
            ),
            format!(
                "in the model it is {}: cut them off by {}",
                fact.bounds(),
                tails.join(", ")
            ),
        )
    };
    reader.add(at.problem(message, help));
    false
}

/// Checks that all `values` lie within the bounds of the parameter.
fn allowed(reader: &Reader, at: At<'_>, fact: &ParameterFact, values: &[f64]) -> bool {
    let mut sound = true;
    for (index, value) in values.iter().enumerate() {
        if !fact.allows([*value; 2]) {
            let message = format!(
                "the value {value} of \"{}\" is out of its bounds",
                fact.name
            );
            let help = format!("in the model it is {}", fact.bounds());
            reader.add(at.key("values").item(index).problem(message, help));
            sound = false;
        }
    }
    sound
}
