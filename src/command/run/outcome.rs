//! Describes a run that is over: its cost, doubts about it, its failure; for people and as JSON.

use super::{Error, ErrorReport};
use crate::balance;
use crate::simulation::Recording;
use crate::table::Table;
use bryant_runtime::Cause;
use bryant_runtime::program::{ErrorKind, Finding, Header, Job, RunError};
use serde_json::json;
use std::path::PathBuf;

/// The table and all information about the run as JSON. `engine` is its name on the command line.
pub fn json(
    engine: &str,
    job: &Job,
    (recording, table): (&Recording, &Table),
    errors: &ErrorReport,
    written: &[PathBuf],
) -> serde_json::Value {
    let mut value = table.json();
    value["model"] = json!(recording.header.name);
    value["digest"] = json!(recording.header.digest);
    let parameters = recording
        .header
        .parameters
        .iter()
        .zip(recording.parameters(job));
    let parameters = parameters
        .map(|(p, value)| (p.name.clone(), json!({ "value": value, "unit": p.unit })))
        .collect::<serde_json::Map<_, _>>();
    value["parameters"] = json!(parameters);
    value["files"] = json!(written);
    value["engine"] = json!(engine);
    if let Some(energy) = &recording.energy {
        value["energy"] = balance::json(&recording.header, energy);
    }
    value["doubts"] = doubts(&recording.doubts);
    value["notes"] = json!(recording.notes);
    value["accuracy"] = errors.json();
    match &recording.result {
        Ok(report) => {
            let wall = recording.wall.as_secs_f64();
            value["report"] = json!({
                "start_s": recording.first_time(),
                "simulated_s": report.t - recording.first_time(),
                "wall_s": wall,
                "simulated_per_wall": (report.t - recording.first_time()) / wall,
                "steps": report.steps,
                "rejected": report.rejected,
                "evaluations": report.evaluations,
                "jacobians": report.jacobians,
                "stiff": report.stiff,
                "events": report.events,
                "samples": report.samples,
                "smallest_step_s": report.smallest_step,
                "smallest_step_at_s": report.smallest_step_at,
                "smallest_step_for": cause(report.smallest_step_for, &recording.header),
                "largest_step_s": report.largest_step,
            });
        }
        Err(error) => {
            value["failure"] = json!({
                "time_s": error.t,
                "element": element(error),
                "coordinate": error.coordinate,
                "cause": error.cause,
                "message": error.message,
            });
        }
    }
    value
}

/// Fails if the run reached its end but cannot be trusted; the error says since when, why, and what the user can do.
pub fn doubtful(recording: &Recording) -> Result<(), Error> {
    let Some(first) = recording.doubts.first() else {
        return Ok(());
    };
    let mut lines = vec!["the simulation cannot be trusted:".to_owned()];
    lines.extend(
        recording
            .doubts
            .iter()
            .map(|doubt| format!("  {}", doubt.message)),
    );
    // the first cause has a remedy; the others follow from it
    lines.push(format!("  help: {}", first.remedy));
    Err(Error::Run(RunError {
        kind: ErrorKind::Run,
        t: Some(first.since),
        coordinate: Some(first.coordinate.clone()).filter(|name| !name.is_empty()),
        cause: first.message.clone(),
        message: lines.join("\n"),
    }))
}

/// The doubts about a run as JSON.
fn doubts(doubts: &[Finding]) -> serde_json::Value {
    let doubt = |doubt: &Finding| {
        json!({
            "since_s": doubt.since,
            "kind": doubt.kind,
            "amount": doubt.amount,
            "coordinate": Some(&doubt.coordinate).filter(|name| !name.is_empty()),
            "message": doubt.message,
            "remedy": doubt.remedy,
        })
    };
    doubts.iter().map(doubt).collect()
}

/// The cost of the run, in one line.
pub fn report(recording: &Recording) -> String {
    let Ok(report) = &recording.result else {
        return String::new();
    };
    let wall = recording.wall.as_secs_f64();
    let simulated = report.t - recording.first_time();
    let rejected = match report.rejected {
        0 => String::new(),
        count => format!(" ({count} more rejected)"),
    };
    let stiff = match report.stiff {
        0 => String::new(),
        count if count == report.steps => ", all by rodas5 as the scene is stiff".to_owned(),
        count => format!(", {count} by rodas5 where the scene is stiff"),
    };
    format!(
        "{} steps{rejected}{stiff}, the smallest {} at {} ({}), {} evaluations; {} simulated in {}, {} × real time",
        report.steps,
        duration(report.smallest_step),
        duration(report.smallest_step_at),
        cause(report.smallest_step_for, &recording.header),
        report.evaluations,
        duration(simulated),
        duration(wall),
        ratio(simulated / wall)
    )
}

/// The failure of the run: its time, element and cause, and the time of the last sample.
pub fn failure(error: &RunError, recording: &Recording) -> String {
    let what = error
        .message
        .split("; likely cause: ")
        .next()
        .unwrap_or(&error.message);
    let mut lines = vec![format!("the simulation failed: {what}")];
    if let Some(element) = element(error) {
        lines.push(format!("  element: {element}"));
    }
    if !error.cause.is_empty() {
        lines.push(format!("  likely cause: {}", error.cause));
    }
    if error.kind == ErrorKind::Time {
        lines.push(
            "  help: leave --method away, or give --method rodas5, which takes long steps where a scene is stiff; or make that force softer or smoother; \
             --time-limit gives the run more time"
                .to_owned(),
        );
    }
    lines.push(match recording.table.rows() {
        0 => "  there are no samples: the start itself cannot be evaluated".to_owned(),
        rows => {
            let since = recording.doubts.iter().map(|doubt| doubt.since);
            let since = since.fold(f64::INFINITY, f64::min);
            let good = match since.is_finite() {
                true => format!("there, but not to be trusted from t = {since} s on"),
                false => "good".to_owned(),
            };
            let last = recording.last_time();
            format!("  the {rows} samples up to t = {last} s are {good}")
        }
    });
    lines.join("\n")
}

/// The element or reference joint of the failing coordinate or velocity.
pub fn element(error: &RunError) -> Option<&str> {
    let (owner, _) = error.coordinate.as_deref()?.rsplit_once('.')?;
    Some(owner)
}

/// A length of time in the unit that is easiest to read.
pub fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s >= 1.0 => (s, "s"),
        s if s >= 1e-3 => (s * 1e3, "ms"),
        s if s >= 1e-6 => (s * 1e6, "µs"),
        0.0 => return "0 s".into(),
        s => (s * 1e9, "ns"),
    };
    // on a busy machine, times are not more precise than three digits
    let decimals = (2 - libm::log10(value).floor() as i32).clamp(0, 3) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => format!(
            "{} {unit}",
            text.trim_end_matches('0').trim_end_matches('.')
        ),
        false => format!("{text} {unit}"),
    }
}

fn ratio(ratio: f64) -> String {
    match ratio {
        r if !r.is_finite() => "∞".into(),
        r if r >= 10.0 => format!("{r:.0}"),
        r => format!("{r:.2}"),
    }
}

/// The reason for the length of a step, with the names of the model.
fn cause(cause: Cause, header: &Header) -> String {
    let named = |names: &[String], index: usize| names.get(index).cloned().unwrap_or_default();
    match cause {
        Cause::First => "the first".into(),
        Cause::Tolerance(index) => {
            let states = [
                &header.coordinates,
                &header.velocities,
                &header.auxiliaries,
                &header.memory,
            ];
            let names: Vec<String> = states.into_iter().flatten().cloned().collect();
            let coordinates = header.coordinates.len();
            let kind = match index {
                index if index < coordinates => "coordinate",
                index if index < coordinates + header.velocities.len() => "velocity",
                _ => "state of a force law",
            };
            format!("tolerance of the {kind} {}", named(&names, index))
        }
        Cause::Largest => "largest step allowed".into(),
        Cause::Fixed => "fixed steps".into(),
        Cause::Breakpoint => "kink of a curve of time".into(),
        Cause::Sample => "row of the table".into(),
        Cause::Kink(index) => format!("kink: {}", named(&header.kinks, index)),
        Cause::EventFunction(index) => format!("event: {}", named(&header.event_functions, index)),
        Cause::End => "end of the run".into(),
    }
}
