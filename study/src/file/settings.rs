//! Reads `fixed`, `run`, `keep` and `tables`, and checks that no name is used twice.

use super::design::known;
use super::reader::{Reader, entries, items, optional, word};
use crate::facts::{ModelFacts, OutputFact, RunFact};
use crate::response::Response;
use crate::study::{
    Fixed, FixedSteps, Keep, KeptOutput, OWN_COLUMNS, RunSettings, TableKind, Varied,
};
use bryant_generator::description::place::At;
use bryant_generator::diagnostic::{quoted, suggestion};

/// Parameters with one value for all runs.
pub fn fixed(reader: &Reader, root: At<'_>, facts: &ModelFacts) -> Vec<Fixed> {
    let Some(at) = optional(root, "fixed") else {
        return Vec::new();
    };
    let mut fixed = Vec::new();
    for (name, at) in entries(at) {
        let Some(fact) = known(reader, at, name, facts) else {
            continue;
        };
        let Some(value) = reader.quantity(at, &fact.unit) else {
            continue;
        };
        if fact.allows([value; 2]) {
            fixed.push(Fixed {
                name: name.to_owned(),
                value,
            });
        } else {
            let message = format!("{value} is out of the bounds of \"{name}\"");
            reader.add(at.problem(message, format!("in the model it is {}", fact.bounds())));
        }
    }
    fixed
}

/// Settings of each run.
pub fn run(reader: &Reader, root: At<'_>, model: &RunFact) -> RunSettings {
    let Some(at) = optional(root, "run") else {
        return RunSettings::default();
    };
    let time = |key: &str, what: &str| reader.positive(optional(at, key)?, "s", what);
    let accuracy = optional(at, "accuracy").and_then(|at| {
        let value = reader.positive(at, "", "the accuracy")?;
        if value >= 1.0 {
            reader.add(at.problem(
                format!("the accuracy is {value}"),
                "it is a relative error, such as `0.1 %`",
            ));
            return None;
        }
        Some(value)
    });
    let settings = RunSettings {
        duration: time("duration", "the duration"),
        accuracy,
        sampling: time("sampling", "the time between samples"),
        step: steps(reader, at),
        energy_limit: energy_limit(reader, at),
        precision: optional(at, "precision").and_then(word).unwrap_or_default(),
    };
    let step = settings.step.map(|steps| steps.length);
    let duration = settings.duration.unwrap_or(model.duration);
    for (key, length) in [("sampling", settings.sampling), ("step", step)] {
        if length.is_some_and(|length| length > duration) {
            let message = format!("`{key}` is longer than the run of {duration} s");
            reader.add(at.key(key).problem(message, "take a shorter one"));
        }
    }
    settings
}

/// The largest share of energy and momentum that may be missing in runs with fixed steps.
fn energy_limit(reader: &Reader, at: At<'_>) -> Option<f64> {
    let limit = optional(at, "energy_limit")?;
    if optional(at, "step").is_none() {
        let message = "`energy_limit` is one of fixed steps, and there is no `step`";
        reader.add(at.key("energy_limit").key_problem(
            message,
            "remove it: steps that follow from the accuracy are judged by the estimate of their error",
        ));
    }
    reader.positive(limit, "", "the share of energy that may be missing")
}

/// Fixed steps.
fn steps(reader: &Reader, at: At<'_>) -> Option<FixedSteps> {
    let method = optional(at, "method");
    let Some(step) = optional(at, "step") else {
        if method.is_some() {
            let message = "a `method` is one of fixed steps, and there is no `step`";
            reader.add(at.key("method").key_problem(
                message,
                "give steps, such as `step: 0.1 ms`, or remove it: steps that follow from the accuracy are Dormand and Prince's",
            ));
        }
        return None;
    };
    if optional(at, "accuracy").is_some() {
        let message = "fixed steps have the accuracy that they have";
        reader.add(at.key("accuracy").key_problem(
            message,
            "remove `accuracy` or `step`; the column `error estimate` says how accurate they were",
        ));
    }
    let length = reader.positive(step, "s", "the step")?;
    let method = method.and_then(word).unwrap_or_default();
    Some(FixedSteps { length, method })
}

/// Runs whose series are kept.
pub fn keep(reader: &Reader, root: At<'_>, facts: &ModelFacts, rows: Option<u64>) -> Keep {
    let Some(at) = optional(root, "keep") else {
        return Keep::default();
    };
    let mut keep = Keep {
        time: facts.time.clone(),
        ..Keep::default()
    };
    for at in optional(at, "runs").map_or(Vec::new(), items) {
        let Some(run) = reader.whole(at, "the index of a run") else {
            continue;
        };
        match rows {
            Some(rows) if run >= rows => {
                let help = format!("runs count from 0 to {}", rows - 1);
                reader.add(at.problem(format!("there is no run {run}"), help));
            }
            _ => keep.runs.push(run),
        }
    }
    keep.runs.sort_unstable();
    keep.runs.dedup();
    keep.every = optional(at, "every").and_then(|at| reader.count(at, "`every`"));
    if optional(at, "runs").is_none() && optional(at, "every").is_none() {
        let message = "`keep` names no runs";
        reader.add(at.problem(message, "write `runs: [0]` or `every: 1000`"));
    }
    let kept = |index: usize, output: &OutputFact| KeptOutput {
        index,
        name: output.name.clone(),
        unit: output.unit_shown(),
    };
    let Some(at) = optional(at, "outputs") else {
        keep.outputs = facts
            .outputs
            .iter()
            .enumerate()
            .map(|(index, o)| kept(index, o))
            .collect();
        return keep;
    };
    for at in items(at) {
        let Some(name) = reader.text(at) else {
            continue;
        };
        match facts.output(name) {
            None => {
                let names = facts.outputs.iter().map(|o| o.name.as_str());
                let message = format!("the model has no output {}", quoted(name));
                reader
                    .add(at.problem(message, suggestion(name, names, "it has no outputs at all")));
            }
            Some((index, _)) if keep.outputs.iter().any(|o| o.index == index) => {}
            Some((index, output)) => keep.outputs.push(kept(index, output)),
        }
    }
    keep
}

/// Formats of tables; Parquet by default.
pub fn tables(root: At<'_>) -> Vec<TableKind> {
    let Some(at) = optional(root, "tables") else {
        return vec![TableKind::Parquet];
    };
    let mut tables = Vec::new();
    for kind in items(at).into_iter().filter_map(word) {
        if !tables.contains(&kind) {
            tables.push(kind);
        }
    }
    tables
}

/// Checks that columns of the table have distinct names, and that a parameter has only one value.
pub fn distinct(
    reader: &Reader,
    root: At<'_>,
    varied: &[Varied],
    fixed: &[Fixed],
    responses: &[Response],
) {
    for parameter in fixed
        .iter()
        .filter(|f| varied.iter().any(|v| v.name == f.name))
    {
        let message = format!("\"{}\" is varied and fixed", parameter.name);
        let at = root.key("fixed").key(&parameter.name);
        reader.add(at.key_problem(message, "remove one of the two"));
    }
    let mut names: Vec<&str> = OWN_COLUMNS.to_vec();
    names.extend(varied.iter().map(|v| v.name.as_str()));
    let at = root.key("responses");
    for response in responses {
        if names.contains(&response.name.as_str()) {
            let message = format!(
                "two columns of the table would be named {}",
                quoted(&response.name)
            );
            reader.add(at.key_problem(message, "give the response another `name`"));
        }
        names.push(&response.name);
    }
    for parameter in varied
        .iter()
        .filter(|v| OWN_COLUMNS.contains(&v.name.as_str()))
    {
        let message = format!(
            "the table has a column {} of its own",
            quoted(&parameter.name)
        );
        reader.add(
            root.key("parameters")
                .problem(message, "rename the parameter in the model"),
        );
    }
}
