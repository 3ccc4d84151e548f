//! The report of a run: one page of HTML.

use super::super::Error;
use super::super::error_report::ErrorReport;
use super::super::terminal::Terminal;
use super::outcome;
use super::responses::Responses;
use super::scene::Shown;
use super::{Arguments, comparison};
use crate::balance;
use crate::picture::Instant;
use crate::process::command_line;
use crate::report::{self, Curve, curves, page, plots, short};
use crate::simulation::Recording;
use crate::table::Table;
use bryant_generator::effect;
use bryant_generator::model::Body;
use bryant_runtime::program::{Header, History};
use bryant_signal::unit;
use serde_json::{Value, json};

/// Largest number of poses in a report: more than the pictures of a screen in ten seconds.
const MOST_POSES: usize = 600;

/// Largest number of rows in the table of a report: a page of some megabytes.
pub const MOST_ROWS: f64 = 2e4;

/// The page of a run.
///
/// # Errors
/// The equations cannot be prepared again for the forces between bodies.
pub fn html(
    arguments: &Arguments,
    shown: &Shown<'_>,
    (recording, table, errors): (&Recording, &Table, &ErrorReport),
    (responses, criteria): (&Responses, Option<Value>),
    terminal: &Terminal,
) -> Result<String, Error> {
    let Shown { found, job, .. } = *shown;
    let model = &found.model;
    let parameters = recording.parameters(job);
    let scene = shown.scene(recording, &kept(recording), terminal)?;
    let [_, outputs @ ..] = table.columns.as_slice() else {
        return Err(Error::system("a run has no time"));
    };
    let mut columns = output_curves(recording, responses);
    let places = crate::scene::Bodies::of(model);
    let indices = |bodies: &[Body]| -> Vec<usize> {
        bodies
            .iter()
            .filter_map(|body| places.index(*body))
            .collect()
    };
    for (curve, output) in columns.iter_mut().zip(&model.outputs) {
        curve["bodies"] = json!(indices(&plots::bodies(model, &output.quantity)));
        curve["laws"] = json!(plots::laws(&output.quantity));
    }
    let units: Vec<&str> = outputs.iter().map(|column| column.unit.as_str()).collect();
    let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let sizes: Vec<f64> = outputs
        .iter()
        .map(|column| largest(&column.values))
        .collect();
    let laws = model.forces.iter().enumerate().map(|(index, force)| {
        let bodies = indices(&plots::of_force(model, index));
        json!({ "name": force.name, "kind": force.law.key(), "bodies": bodies })
    });
    let laws: Vec<Value> = laws.collect();
    let title = match model.title.as_str() {
        "" => model.name.clone(),
        title => title.to_owned(),
    };
    let mut accuracy = errors.lines();
    if accuracy.is_empty() {
        accuracy.push("The run was not compared with another one.".to_owned());
    }
    let values = parameters.iter().zip(&recording.header.parameters);
    let values = values.map(|(value, parameter)| {
        let number = json!({ "value": value, "unit": parameter.unit });
        (parameter.name.clone(), number)
    });
    let overlays = comparison::measured(arguments, model, &recording.table)?;
    let beside = comparison::run(
        arguments,
        found,
        job,
        (recording, errors),
        responses,
        terminal,
    )?;
    let data = json!({
        "overlays": overlays,
        "beside": beside,
        "result": super::result::json(responses, recording, errors),
        "works": recording.history.as_ref().map(|history| works(&recording.header, history)),
        "model": model.name,
        "title": title,
        "version": env!("CARGO_PKG_VERSION"),
        "digest": recording.header.digest,
        "command": command_line(),
        "times": seconds(recording).into_iter().map(short).collect::<Vec<_>>(),
        "columns": columns,
        "plots": plots::json(model, &units, &sizes),
        "scene": report::json(&scene),
        "forces": laws,
        "responses": told(&responses.json(recording, errors)),
        "criteria": criteria,
        "energy": recording.energy.as_ref().map(|energy| balance::json(&recording.header, energy)),
        "accuracy": accuracy,
        "beyond": errors.check().is_err(),
        "notes": recording.notes,
        "doubts": recording.doubts.iter().map(|doubt| &doubt.message).collect::<Vec<_>>(),
        "failure": recording.result.as_ref().err().map(|error| error.message.clone()),
        "report": outcome::report(recording),
        "effects": effect::summary(model),
        "parameters": values.collect::<serde_json::Map<_, _>>(),
    });
    Ok(page(&title, &data))
}

/// The times of the rows \[s\].
pub(super) fn seconds(recording: &Recording) -> Vec<f64> {
    let Some(time) = recording.table.columns.first() else {
        return Vec::new();
    };
    let factor = unit::factor(&time.unit, "s").unwrap_or(1.0);
    time.values.iter().map(|t| factor * t).collect()
}

/// The curves of all outputs, with samples between the rows.
pub(super) fn output_curves(recording: &Recording, responses: &Responses) -> Vec<Value> {
    let outputs = recording.table.columns.iter().skip(1).enumerate();
    let outputs = outputs.map(|(index, column)| Curve {
        column,
        samples: responses.samples(recording, index),
        unit: responses.units.output(index),
    });
    curves(&seconds(recording), &outputs.collect::<Vec<_>>())
}

/// The works of effects over time.
fn works(header: &Header, history: &History) -> Value {
    let times: Vec<Value> = history.times.iter().map(|t| short(*t)).collect();
    let effects = header.powers.iter().enumerate().map(|(index, name)| {
        let values = history.works.iter().map(|works| short(works[index]));
        json!({ "name": name, "values": values.collect::<Vec<_>>() })
    });
    json!({ "times": times, "effects": effects.collect::<Vec<_>>() })
}

/// At most about [`MOST_POSES`] samples of a run, evenly spread, with the last one.
pub(super) fn kept(recording: &Recording) -> Vec<Instant> {
    let stride = recording.instants.len().div_ceil(MOST_POSES).max(1);
    let last = recording.instants.len().saturating_sub(1);
    let kept = recording.instants.iter().enumerate();
    let kept = kept.filter(|(k, _)| k % stride == 0 || *k == last);
    kept.map(|(_, instant)| instant.clone()).collect()
}

/// The responses in the form that the script of the page reads.
fn told(responses: &Value) -> Value {
    let each = responses.as_array().into_iter().flatten().map(|response| {
        json!({
            "name": response["response"],
            "value": response["value"],
            "unit": response["unit"],
        })
    });
    each.collect()
}
