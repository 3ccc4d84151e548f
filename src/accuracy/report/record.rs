//! All settings of a study with their results, as CSV and as JSON. Each quantity is declared once, with its heading in
//! CSV and its key in JSON; an entry that is an object has a column for each of its members in CSV.

use crate::accuracy::conclusion::{Conclusion, bounded_by_stability};
use crate::accuracy::point::{Point, Status};
use crate::accuracy::reading::Reading;
use crate::accuracy::setting::Pace;
use crate::accuracy::study::Study;
use serde_json::{Map, Value, json};
use std::io;

/// The heading of an entry, its key and its value.
type Entry = (&'static str, &'static str, Value);

/// What all settings have in common.
fn common(study: &Study) -> Vec<Entry> {
    let parameters = study.parameters.iter();
    let parameters: Map<String, Value> = parameters
        .map(|(name, value)| (name.clone(), json!(value)))
        .collect();
    let own = &study.reference.own;
    let mut reference = by_reading(&study.reference.readings, &own.readings);
    reference["the state"] = json!(own.state);
    vec![
        ("model", "model", json!(study.model)),
        ("model digest", "digest", json!(study.digest)),
        ("bryant", "bryant", json!(crate::VERSION)),
        ("engine", "engine", json!(study.engine)),
        ("target", "target", json!(target())),
        ("parameter", "parameters", parameters.into()),
        ("duration [s]", "duration_s", json!(study.duration)),
        ("every [s]", "every_s", json!(study.every)),
        ("reference", "reference", json!(study.reference.statement)),
        ("reference's own error in", "reference_errors", reference),
    ]
}

/// A setting and its result.
fn of_point(study: &Study, conclusion: &Conclusion, index: usize) -> Vec<Entry> {
    let Point { setting, status } = &study.points[index];
    let (step, tolerance) = match setting.pace {
        Pace::Step(step) => (Some(step), None),
        Pace::Tolerance(tolerance) => (None, Some(tolerance)),
    };
    let (status, reason) = match status {
        Status::Done(_) => ("done", None),
        Status::Failed(reason) => ("failed", Some(reason)),
        Status::Skipped(reason) => ("skipped", Some(reason)),
    };
    let mut entries = vec![
        ("method", "method", json!(setting.scheme().name())),
        ("step [s]", "step_s", json!(step)),
        ("tolerance", "tolerance", json!(tolerance)),
        ("scalar", "scalar", json!(setting.scalar.name())),
        ("kinks", "kinks", json!(setting.kinks())),
        ("status", "status", json!(status)),
        ("reason", "reason", json!(reason)),
    ];
    let Some(done) = study.points[index].done() else {
        return entries;
    };
    let error = done.error(study.of, &study.reference.own);
    let (report, timing) = (&done.report, &done.timing);
    let errors = by_reading(&study.reference.readings, &done.readings);
    let front = conclusion.front.contains(&index);
    entries.extend([
        ("front", "front", json!(front)),
        ("error", "error", json!(error.error)),
        (
            "below the reference's own error",
            "below_reference",
            json!(error.at_most),
        ),
        ("error in the state", "error_state", json!(done.state.error)),
        (
            "entry with that error",
            "error_state_entry",
            json!(done.state.entry),
        ),
        ("error in", "readings", errors),
        ("gap of energy", "energy_gap", json!(done.energy)),
        ("drift of momentum", "momentum_drift", json!(done.momentum)),
        ("observed order", "order", json!(done.order)),
        ("steps", "steps", json!(report.steps)),
        ("rejected", "rejected", json!(report.rejected)),
        ("events", "events", json!(report.events)),
        ("evaluations", "evaluations", json!(report.evaluations)),
        ("jacobians", "jacobians", json!(report.jacobians)),
        (
            "smallest step [s]",
            "smallest_step_s",
            json!(report.smallest_step),
        ),
        (
            "largest step [s]",
            "largest_step_s",
            json!(report.largest_step),
        ),
        (
            "wall time median [s]",
            "wall_median_s",
            json!(timing.median),
        ),
        (
            "wall time 95th percentile [s]",
            "wall_95_s",
            json!(timing.late),
        ),
        ("repetitions", "repetitions", json!(timing.repetitions)),
        (
            "simulated/wall",
            "simulated_per_wall",
            json!(report.t / timing.median),
        ),
    ]);
    entries
}

/// Values by the names of readings.
fn by_reading(readings: &[Reading], values: &[f64]) -> Value {
    let names = readings.iter().map(|reading| reading.name.clone());
    let members = names.zip(values.iter().map(|value| json!(value)));
    members.collect::<Map<String, Value>>().into()
}

/// Architecture and operating system: "x86_64-linux".
pub fn target() -> String {
    format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS)
}

/// Writes a row for each point, with all settings that are needed to repeat it, and all digits.
///
/// # Errors
/// Those of `out`.
pub fn csv(study: &Study, conclusion: &Conclusion, out: impl io::Write) -> io::Result<()> {
    let rows = (0..study.points.len()).map(|index| {
        let entries = common(study)
            .into_iter()
            .chain(of_point(study, conclusion, index));
        entries.flat_map(cells).collect()
    });
    let rows: Vec<Vec<(String, String)>> = rows.collect();
    let headings = rows.iter().max_by_key(|row| row.len());
    let headings: Vec<&str> = headings
        .into_iter()
        .flatten()
        .map(|cell| cell.0.as_str())
        .collect();
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(&headings)?;
    for row in &rows {
        // a point without a result has no cells of it
        let cell = |heading: &&str| {
            let cell = row.iter().find(|cell| cell.0 == *heading);
            cell.map_or("", |cell| cell.1.as_str())
        };
        writer.write_record(headings.iter().map(cell))?;
    }
    writer.flush()
}

/// The headings and texts of the cells of an entry.
fn cells((heading, _, value): Entry) -> Vec<(String, String)> {
    let text = |value: &Value| match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    match &value {
        Value::Object(members) => {
            let members = members.iter();
            members
                .map(|(name, value)| (format!("{heading} {name}"), text(value)))
                .collect()
        }
        value => vec![(heading.to_owned(), text(value))],
    }
}

/// The whole study; a number that is not finite is `null`.
pub fn json(study: &Study, conclusion: &Conclusion) -> Value {
    let object = |entries: Vec<Entry>| -> Map<String, Value> {
        let members = entries
            .into_iter()
            .map(|(_, key, value)| (key.to_owned(), value));
        members.collect()
    };
    let readings = study.reference.readings.iter();
    let readings = readings.map(|r| json!({ "name": r.name, "unit": r.unit, "value": r.value }));
    let bounded = bounded_by_stability(study).into_iter();
    let bounded = bounded.map(|(setting, step, rate)| {
        json!({ "setting": setting, "step_s": step, "limit_of_rate_per_s": rate })
    });
    let fastest = study.fastest.as_ref().map(|fastest| {
        json!({
            "rate_per_s": fastest.rate,
            "time_s": fastest.t,
            "velocity": fastest.velocity,
            "effect": fastest.effect,
        })
    });
    let points = 0..study.points.len();
    let points = points.map(|index| object(of_point(study, conclusion, index)));
    let mut whole = object(common(study));
    for (key, value) in [
        ("readings", readings.collect()),
        ("of", json!(study.of.name(&study.reference.readings))),
        ("sentence", json!(conclusion.sentence(study))),
        (
            "factor_per_digit",
            json!(conclusion.digits.map(|d| d.factor)),
        ),
        ("points", points.map(Value::Object).collect()),
        ("bounded_by_stability", bounded.collect()),
        ("fastest_motion", json!(fastest)),
        ("complete", json!(!study.interrupted)),
        ("took_s", json!(study.took)),
    ] {
        whole.insert(key.to_owned(), value);
    }
    whole.into()
}
