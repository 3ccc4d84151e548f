//! What a report shows beside the run: curves of a test, and a second run with other parameters.

use super::super::Error;
use super::super::compare::{channel, doubt, recording};
use super::super::error_report::ErrorReport;
use super::super::model_argument::Found;
use super::super::terminal::Terminal;
use super::Arguments;
use super::report::{kept, output_curves, seconds};
use super::responses::Responses;
use crate::accuracy::setting::Setting;
use crate::command::parameters::parse_parameters;
use crate::command::prepare::prepare;
use crate::report::{self, short};
use crate::scene::Scene;
use crate::simulation::{self, Recording};
use crate::table::Table;
use bryant_generator::model::Model;
use bryant_runtime::program::Job;
use bryant_signal::{Channel, NoChannel, unit};
use serde_json::{Value, json};

/// Largest number of samples of a curve; if there are more, every second, third, … sample is shown.
const MOST_SAMPLES: usize = 4000;

/// The curves of the test for outputs of the run, in the units of the outputs.
///
/// # Errors
/// The recording cannot be read, it has no channel for a requested output, or a channel has another quantity than its
/// output.
pub fn measured(arguments: &Arguments, model: &Model, table: &Table) -> Result<Vec<Value>, Error> {
    let Some(path) = &arguments.measured else {
        return Ok(Vec::new());
    };
    let recording = recording(path)?;
    let column = |name: &str| table.columns.iter().skip(1).position(|c| c.name == name);
    let mut pairs: Vec<(usize, &Channel)> = Vec::new();
    for (output, theirs) in &arguments.channel {
        let Some(index) = column(output) else {
            let names: Vec<&str> = model.outputs.iter().map(|o| o.name.as_str()).collect();
            return Err(Error::Input(format!(
                "--channel: the model has no output \"{output}\"\n  help: there are: {}",
                names.join(", ")
            )));
        };
        pairs.push((index, channel(&recording, path, theirs)?));
    }
    if pairs.is_empty() {
        for (index, output) in model.outputs.iter().enumerate() {
            let code = output.code.as_deref();
            for name in code.into_iter().chain([output.name.as_str()]) {
                if recording.channel(name) != Err(NoChannel::Unknown)
                    || recording.damaged(name).is_some()
                {
                    pairs.push((index, channel(&recording, path, name)?));
                    break;
                }
            }
        }
    }
    if pairs.is_empty() {
        let names: Vec<&str> = recording.channels.iter().map(|c| c.name.as_str()).collect();
        return Err(Error::Input(format!(
            "{} has no channel with the name or the code of an output\n  help: say which belong together, --channel 'OUTPUT=CHANNEL'; it has {}",
            path.display(),
            names.join(", ")
        )));
    }
    let curves = pairs.into_iter().map(|(index, channel)| {
        let output = &model.outputs[index];
        if let Some(doubt) = doubt(channel, path) {
            return Err(Error::Input(format!(
                "{doubt}\n  help: name channels that are sound, --channel 'OUTPUT=CHANNEL'"
            )));
        }
        let Some(factor) = unit::factor(&channel.unit, &output.unit) else {
            return Err(Error::Input(format!(
                "the channel \"{}\" of {} is in `{}`, and the output \"{}\" in `{}`\n  help: take channels of one quantity, with units that are known",
                channel.name,
                path.display(),
                channel.unit,
                output.name,
                output.unit
            )));
        };
        let signal = &channel.signal;
        let stride = signal.values.len().div_ceil(MOST_SAMPLES).max(1);
        let shown = || (0..signal.values.len()).step_by(stride);
        let unit = model.unit_of(output);
        Ok(json!({
            "name": "measured",
            "of": index,
            "unit": unit.name,
            "times": shown().map(|i| short(signal.time(i))).collect::<Vec<_>>(),
            "values": shown().map(|i| short(unit.of_si(factor * signal.values[i]))).collect::<Vec<_>>(),
        }))
    });
    curves.collect()
}

/// The motion and the curves of a second run with other parameters; null if none is requested.
///
/// # Errors
/// There is no such parameter, or the run fails or cannot be trusted.
pub fn run(
    arguments: &Arguments,
    found: &Found,
    job: &Job,
    (recording, errors): (&Recording, &ErrorReport),
    responses: &Responses,
    terminal: &Terminal,
) -> Result<Value, Error> {
    if arguments.beside.is_empty() {
        return Ok(Value::Null);
    }
    let others = parse_parameters(&arguments.beside, &found.scene)?;
    let engine = prepare(found, terminal)?;
    let mut job = errors.setting().unwrap_or(Setting::of(job)).job(job);
    job.reading.asked.clear();
    job.parameters
        .retain(|(name, _)| others.iter().all(|(other, _)| other != name));
    job.parameters.extend(others);
    let second = simulation::run(&*engine, &job, &mut |_| {});
    engine.check()?;
    let label = arguments.beside.join(", ");
    if let Err(error) = &second.result {
        return Err(Error::failed(format!(
            "the second run, with {label}, did not come to its end: {}",
            error.message
        )));
    }
    if let Some(doubt) = second
        .doubts
        .first()
        .filter(|_| recording.doubts.is_empty())
    {
        return Err(Error::failed(format!(
            "the second run, with {label}, cannot be trusted: {}\n  help: {}",
            doubt.message, doubt.remedy
        )));
    }
    let parameters = second.parameters(&job);
    let instants = kept(&second);
    let scene = Scene::new(
        &found.model,
        &second.coordinates,
        &parameters,
        &instants,
        &[],
    );
    let scene = report::json(&scene.map_err(Error::system)?);
    let times: Vec<Value> = seconds(&second).into_iter().map(short).collect();
    let curves = output_curves(&second, responses);
    Ok(json!({ "label": label, "scene": scene, "times": times, "curves": curves }))
}
