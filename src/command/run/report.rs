//! The report of a run: one page of HTML.

use super::super::Error;
use super::super::error_report::ErrorReport;
use super::super::model_argument::Found;
use super::super::prepare::prepare_model;
use super::super::terminal::Terminal;
use super::outcome;
use super::responses::Responses;
use super::{Arguments, beside};
use crate::accuracy::setting::Setting;
use crate::balance;
use crate::picture::Instant;
use crate::report::study::quoted;
use crate::report::{Samples, Scene, curves, page, plots, short, with_forces};
use crate::simulation::{self, Recording};
use bryant_generator::effect;
use bryant_runtime::program::{Header, History, Job};
use bryant_signal::unit;
use serde_json::{Value, json};

/// A report has at most this many poses: more than one for each picture of a screen in ten seconds.
const MOST_POSES: usize = 600;

/// The table of a report has at most this many rows: a page of some megabytes.
pub const MOST_ROWS: f64 = 2e4;

/// The page of a run.
///
/// # Errors
/// The equations cannot be prepared again for the forces between bodies.
pub fn html(
    arguments: &Arguments,
    found: &Found,
    job: &Job,
    (recording, errors): (&Recording, &ErrorReport),
    (responses, criteria): (&Responses, Option<Value>),
    terminal: &Terminal,
) -> Result<String, Error> {
    let model = &found.model;
    let instants = kept(recording);
    let parameters = recording.parameters(job);
    let forces = forces(found, job, recording, errors, &instants, terminal)?;
    let mut notes = recording.notes.clone();
    if forces.is_empty() && recording.result.is_err() {
        notes.push(
            "Forces of belts and contacts are not shown: the run did not come to its end.".into(),
        );
    }
    let scene = Scene::new(model, &recording.coordinates, &parameters, &instants);
    let scene = scene.map_err(Error::system)?;
    let [_, outputs @ ..] = recording.table.columns.as_slice() else {
        return Err(Error::system("a run has no time"));
    };
    let mut columns = output_curves(recording, responses);
    for (curve, output) in columns.iter_mut().zip(&model.outputs) {
        let bodies = plots::bodies(model, &output.quantity);
        curve["bodies"] = bodies.iter().map(|body| scene.index(*body)).collect();
        curve["laws"] = json!(plots::laws(&output.quantity));
    }
    let units: Vec<&str> = outputs.iter().map(|column| column.unit.as_str()).collect();
    let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let sizes: Vec<f64> = outputs
        .iter()
        .map(|column| largest(&column.values))
        .collect();
    let laws = model.forces.iter().enumerate().map(|(index, force)| {
        let bodies = plots::of_force(model, index);
        let bodies: Vec<i64> = bodies.iter().map(|body| scene.index(*body)).collect();
        json!({ "name": force.name, "kind": force.kind.key(), "bodies": bodies })
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
    let overlays = beside::measured(arguments, model, &recording.table)?;
    let beside = beside::run(
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
        "command": command(arguments),
        "times": seconds(recording).into_iter().map(short).collect::<Vec<_>>(),
        "columns": columns,
        "plots": plots::json(model, &units, &sizes),
        "scene": scene.json(&forces),
        "forces": laws,
        "responses": told(&responses.json(recording, errors)),
        "criteria": criteria,
        "energy": recording.energy.as_ref().map(|energy| balance::json(&recording.header, energy)),
        "accuracy": accuracy,
        "beyond": errors.check().is_err(),
        "notes": notes,
        "doubts": recording.doubts.iter().map(|doubt| &doubt.message).collect::<Vec<_>>(),
        "failure": recording.result.as_ref().err().map(|error| error.message.clone()),
        "report": outcome::report(recording),
        "effects": effect::summary(model),
        "parameters": values.collect::<serde_json::Map<_, _>>(),
    });
    Ok(page(&title, &data))
}

/// Times of the rows \[s\].
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
    let outputs = outputs.map(|(index, column)| {
        let own = &recording.header.outputs[index].unit;
        let factor = unit::factor(own, &column.unit).unwrap_or(1.0);
        let samples = responses.samples(recording, index);
        (column, samples.map(|samples| Samples { factor, ..samples }))
    });
    curves(&seconds(recording), &outputs.collect::<Vec<_>>())
}

/// Works of effects over time.
fn works(header: &Header, history: &History) -> Value {
    let times: Vec<Value> = history.times.iter().map(|t| short(*t)).collect();
    let effects = header.powers.iter().enumerate().map(|(index, name)| {
        let values = history.works.iter().map(|works| short(works[index]));
        json!({ "name": name, "values": values.collect::<Vec<_>>() })
    });
    json!({ "times": times, "effects": effects.collect::<Vec<_>>() })
}

/// At most [`MOST_POSES`] of the instants of a run, evenly spread and with the last one.
pub(super) fn kept(recording: &Recording) -> Vec<Instant> {
    let stride = recording.instants.len().div_ceil(MOST_POSES).max(1);
    let last = recording.instants.len().saturating_sub(1);
    let kept = recording.instants.iter().enumerate();
    let kept = kept.filter(|(k, _)| k % stride == 0 || *k == last);
    kept.map(|(_, instant)| instant.clone()).collect()
}

/// The forces between bodies at these instants, a column for each component. The same run is computed again, with outputs for these forces.
/// `None` if the run did not reach its end, this time or before.
fn forces(
    found: &Found,
    job: &Job,
    recording: &Recording,
    errors: &ErrorReport,
    instants: &[Instant],
    terminal: &Terminal,
) -> Result<Vec<Vec<f64>>, Error> {
    let model = with_forces(&found.model);
    let own = found.model.outputs.len();
    if model.outputs.len() == own || recording.result.is_err() {
        return Ok(Vec::new());
    }
    let engine = prepare_model(found, &model, terminal)?;
    let setting = errors.setting().unwrap_or(Setting::of(job));
    let mut job = setting.job(job);
    job.reading = Default::default();
    let again = simulation::run(&*engine, &job, &mut |_| {});
    engine.check()?;
    if again.result.is_err() {
        return Ok(Vec::new());
    }
    // additional outputs do not change steps
    let bits = |state: &[f64]| {
        state
            .iter()
            .map(|entry| entry.to_bits())
            .collect::<Vec<_>>()
    };
    if bits(&again.last_state) != bits(&recording.last_state) {
        return Err(Error::system(
            "the forces of the report are not those of the run\n  help: leave out --report, and tell the authors",
        ));
    }
    let times = &again.table.columns[0].values;
    let rows: Vec<usize> = instants
        .iter()
        .map(|instant| times.partition_point(|t| *t < instant.time))
        .collect();
    let columns = again.table.columns[1 + own..].iter();
    let at_rows = |values: &[f64]| {
        let value = |row: &usize| values.get(*row).copied().unwrap_or(f64::NAN);
        rows.iter().map(value).collect()
    };
    Ok(columns.map(|column| at_rows(&column.values)).collect())
}

/// The responses in the form that the page reads.
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

/// The command line that makes this page.
fn command(arguments: &Arguments) -> String {
    let words = std::env::args().skip(1).map(|word| quoted(&word));
    let words: Vec<String> = words.collect();
    match words.is_empty() {
        true => format!("bryant run {}", arguments.model),
        false => format!("bryant {}", words.join(" ")),
    }
}
