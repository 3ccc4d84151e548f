//! The result of a run on one screen: peaks of the first outputs, responses, criteria, and how far the run can be
//! trusted.

use super::responses::Responses;
use super::{Done, ErrorReport};
use crate::balance;
use crate::simulation::Recording;
use crate::table::{Column, Table};
use bryant_picture::text::{typeset, wrap};
use bryant_runtime::response::{Response, reduce};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Width of lines in characters, if that of the terminal is not known.
const WIDTH: usize = 80;
/// Length of a run from which times are in seconds instead of milliseconds \[s\].
const LONG: f64 = 10.0;

/// The largest magnitude of an output, with its sign, and its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Peak {
    /// Name of the output.
    pub name: String,
    /// Unit of the output.
    pub unit: String,
    /// The value in this unit.
    pub value: f64,
    /// Its time \[s\].
    pub time: f64,
}

impl Peak {
    /// The peak of a signal whose samples are `every` \[s\] apart, with the first at `start` \[s\]. `None` if the
    /// signal has no peak, for example no samples.
    pub fn of(
        (name, unit): (&str, &str),
        samples: &[f64],
        [start, every]: [f64; 2],
    ) -> Option<Self> {
        let read = |response| reduce(response, samples, every, &mut []);
        let [above, below] = [Response::Peak, Response::Minimum].map(read);
        let (value, when) = match above.abs() >= below.abs() {
            true => (above, Response::TimeOfPeak),
            false => (below, Response::TimeOfMinimum),
        };
        let peak = Peak {
            name: name.to_owned(),
            unit: unit.to_owned(),
            value,
            time: start + read(when),
        };
        (peak.value.is_finite() && peak.time.is_finite()).then_some(peak)
    }
}

/// The result as text, after an empty line. Lines have at most `width` characters, unless names are longer.
pub fn text(done: &Done<'_>, width: Option<usize>) -> String {
    let Done {
        found,
        recording,
        errors,
        responses,
        ..
    } = *done;
    let mut text = String::new();
    // a run that failed has a message instead
    if recording.result.is_ok() {
        let model = &found.model;
        let title = match model.title.as_str() {
            "" => model.name.clone(),
            title => format!("{}: {title}", model.name),
        };
        for line in wrap(&title, width.unwrap_or(WIDTH)) {
            let _ = write!(text, "\n{line}");
        }
        text.push('\n');
        let peaks = responses.peaks(recording);
        if !peaks.is_empty() {
            let more = recording.header.outputs.len().saturating_sub(peaks.len());
            let _ = write!(text, "\n{}", of_peaks(&peaks, more, recording.last_time()));
        }
    }
    text += &responses.text(recording, errors);
    match &done.verdict {
        Some(Some(verdict)) => {
            let _ = write!(text, "\n{}", verdict.summary());
        }
        Some(None) => {
            text += "\nThe criteria are not judged: the run did not come to its end, or cannot be trusted.\n";
        }
        None => {}
    }
    let lines = ["energy", "trust"]
        .into_iter()
        .zip(trust(recording, errors));
    let lines = lines.map(|(what, line)| match what {
        "energy" => (what, line.map(|line| line + " (--energy lists the works)")),
        _ => (what, line),
    });
    for (index, (what, line)) in lines
        .filter_map(|(what, line)| Some((what, line?)))
        .enumerate()
    {
        let begin = if index == 0 { "\n" } else { "" };
        let _ = writeln!(text, "{begin}{what:7} {line}");
    }
    match recording.notes.len() {
        0 => {}
        1 => text += "remark  one, above\n",
        count => {
            let _ = writeln!(text, "remarks {count}, above");
        }
    }
    text
}

/// The result for a report: peaks, the number of outputs without a peak, how far energy is conserved, and how well
/// outputs are known.
pub fn json(responses: &Responses, recording: &Recording, errors: &ErrorReport) -> Value {
    let peaks = responses.peaks(recording);
    let [energy, trust] = trust(recording, errors);
    json!({
        "more": recording.header.outputs.len().saturating_sub(peaks.len()),
        "peaks": json_of_peaks(&peaks),
        "energy": energy,
        "trust": trust,
    })
}

/// The peaks as JSON: `[{"output", "value", "unit", "time_s"}, …]`
pub fn json_of_peaks(peaks: &[Peak]) -> Value {
    let peak = |peak: &Peak| json!({ "output": peak.name, "value": peak.value, "unit": peak.unit, "time_s": peak.time });
    peaks.iter().map(peak).collect()
}

/// How far energy is conserved, and how well outputs are known; `None` for a run that did not reach its end.
fn trust(recording: &Recording, errors: &ErrorReport) -> [Option<String>; 2] {
    let done = recording.result.is_ok();
    let energy = recording.energy.as_ref().filter(|_| done);
    [energy.map(balance::closes), done.then(|| errors.summary())]
}

/// A line for each peak, and one that says that `more` outputs have none.
fn of_peaks(peaks: &[Peak], more: usize, end: f64) -> String {
    let (scale, unit) = match end < LONG {
        true => (1e3, "ms"),
        false => (1.0, "s"),
    };
    let times = Column {
        name: "at".to_owned(),
        unit: unit.to_owned(),
        values: peaks.iter().map(|peak| scale * peak.time).collect(),
    };
    let decimals = if scale > 1.0 { 1 } else { 3 };
    let cells: Vec<[String; 3]> = peaks
        .iter()
        .zip(&times.values)
        .map(|(peak, time)| {
            let value = Table::number(peak.value, &peak.unit);
            let unit = typeset(&peak.unit);
            [
                peak.name.clone(),
                format!("{value} {unit}").trim_end().to_owned(),
                format!("{time:.decimals$} {}", times.unit),
            ]
        })
        .collect();
    let widest = |column: usize| cells.iter().map(|cell| cell[column].chars().count()).max();
    let [names, values, at] = [0, 1, 2].map(|column| widest(column).unwrap_or(0));
    let mut text = String::new();
    for [name, value, time] in &cells {
        let _ = writeln!(text, "{name:names$}  {value:>values$}  at {time:>at$}");
    }
    if more > 0 {
        let plural = if more == 1 { "" } else { "s" };
        let _ = writeln!(text, "{more} more output{plural} in the table");
    }
    text
}
