//! A study as CSV: a row for each point, with all settings that are needed to repeat it, and all digits.

use crate::accuracy::conclusion::Conclusion;
use crate::accuracy::point::{Done, Point, Status};
use crate::accuracy::reading::Kind;
use crate::accuracy::setting::Pace;
use crate::accuracy::study::Study;
use std::io;

/// Writes all points.
///
/// # Errors
/// Those of `out`.
pub fn write(study: &Study, conclusion: &Conclusion, out: impl io::Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(headings(study))?;
    for (index, point) in study.points.iter().enumerate() {
        let front = conclusion.front.contains(&index);
        writer.write_record(record(study, point, front))?;
    }
    writer.flush()
}

/// Names and values of the columns that are the same in all rows.
fn common(study: &Study) -> Vec<(&'static str, String)> {
    let parameters = study.parameters.iter();
    let parameters = parameters.map(|(name, value, unit)| format!("{name}={value} {unit}"));
    let parameters: Vec<String> = parameters.map(|p| p.trim_end().to_owned()).collect();
    let environment = &study.environment;
    vec![
        ("model", study.model.clone()),
        ("model digest", study.digest.clone()),
        ("bryant", environment.version.clone()),
        ("commit", environment.commit.clone()),
        ("engine", environment.engine.clone()),
        ("target", environment.target.clone()),
        ("CPU features", environment.features.join(" ")),
        ("parameters", parameters.join("; ")),
        ("duration [s]", number(study.duration)),
        ("every [s]", number(study.every)),
        ("reference", study.reference.statement.clone()),
    ]
}

/// Headings of the columns of the setting.
const SETTING: [&str; 7] = [
    "method",
    "pace",
    "step [s]",
    "tolerance",
    "scalar",
    "kinks",
    "curves",
];

/// Headings of the columns of the result, except readings.
const RESULT: [&str; 22] = [
    "status",
    "reason",
    "front",
    "error in the state",
    "entry with that error",
    "reference's own error in the state",
    "error in the worst reading",
    "gap of energy",
    "drift of momentum",
    "observed order",
    "steps",
    "rejected",
    "events",
    "evaluations",
    "jacobians",
    "operations",
    "smallest step [s]",
    "largest step [s]",
    "wall time median [s]",
    "wall time 95th percentile [s]",
    "repetitions",
    "simulated/wall",
];

fn headings(study: &Study) -> Vec<String> {
    let common = common(study).into_iter().map(|(name, _)| name.to_owned());
    let fixed = SETTING.iter().chain(&RESULT).map(|name| name.to_string());
    let readings = study.reference.readings.iter().flat_map(|reading| {
        let mut names = vec![
            format!("error in {}", reading.name),
            format!("reference's own error in {}", reading.name),
        ];
        if reading.kind == Kind::Peak {
            names.push(format!("error in the time of {} [s]", reading.name));
        }
        names
    });
    common.chain(fixed).chain(readings).collect()
}

fn record(study: &Study, point: &Point, front: bool) -> Vec<String> {
    let mut record: Vec<String> = common(study).into_iter().map(|(_, value)| value).collect();
    let setting = &point.setting;
    let (pace, step, tolerance) = match setting.pace {
        Pace::Step(step) => ("fixed steps", number(step), String::new()),
        Pace::Tolerance(tolerance) => ("controlled error", String::new(), number(tolerance)),
    };
    record.extend([
        setting.scheme().name(),
        pace.to_owned(),
        step,
        tolerance,
        setting.scalar.name().to_owned(),
        setting.kinks().to_owned(),
        setting.curves.name().to_owned(),
    ]);
    match &point.status {
        Status::Done(done) => record.extend(done_record(study, point, done, front)),
        Status::Failed(reason) => record.extend(["failed".to_owned(), reason.clone()]),
        Status::Skipped(reason) => record.extend(["skipped".to_owned(), reason.clone()]),
    }
    // a point that was not run has no results
    record.resize(headings(study).len(), String::new());
    record
}

fn done_record(study: &Study, point: &Point, done: &Done, front: bool) -> Vec<String> {
    let optional = |value: Option<f64>| value.map_or(String::new(), number);
    let own = study.own(point.setting.curves);
    let report = &done.report;
    let worst = done.readings.iter().map(|r| r.value).reduce(f64::max);
    let mut record = vec![
        "done".to_owned(),
        String::new(),
        if front { "yes" } else { "no" }.to_owned(),
        number(done.state.error),
        done.state.entry.clone(),
        number(own.state),
        optional(worst),
        optional(done.energy),
        optional(done.momentum),
        optional(done.order),
        report.steps.to_string(),
        report.rejected.to_string(),
        report.events.to_string(),
        report.evaluations.to_string(),
        report.jacobians.to_string(),
        done.operations.to_string(),
        number(report.smallest_step),
        number(report.largest_step),
        number(done.timing.median),
        number(done.timing.late),
        done.timing.repetitions.to_string(),
        number(report.t / done.timing.median),
    ];
    for (index, (reading, error)) in study
        .reference
        .readings
        .iter()
        .zip(&done.readings)
        .enumerate()
    {
        record.push(number(error.value));
        record.push(optional(own.readings.get(index).copied()));
        if reading.kind == Kind::Peak {
            record.push(optional(error.time));
        }
    }
    record
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        magnitude if (1e-3..1e6).contains(&magnitude) || !value.is_finite() => value.to_string(),
        _ => format!("{value:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_read_back_to_the_last_bit() {
        let values = [
            0.1 + 0.2,
            1.0 / 3.0e9,
            6.531803069802436e-8,
            1e300,
            5e-324,
            123456.789,
            0.0,
        ];
        for value in values.into_iter().flat_map(|v: f64| [v, -v]) {
            let read: f64 = number(value).parse().unwrap();
            assert_eq!(read.abs().to_bits(), value.abs().to_bits(), "{value:e}");
            assert_eq!(read, value);
        }
        assert_eq!(number(f64::INFINITY), "inf");
    }
}
