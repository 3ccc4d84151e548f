//! `responses`: what is read off each run.

use super::reader::{Reader, optional};
use crate::facts::ModelFacts;
use crate::quantity::dimension;
use crate::response::{NAMES, Response, What};
use crate::study::RunSettings;
use bryant_generator::description::place::At;
use bryant_generator::description::tree::Kind;
use bryant_generator::diagnostic::{quoted, suggestion};

/// Reads all responses; those with a problem are left out, and the reader has the problem.
pub fn read(reader: &Reader, root: At<'_>, facts: &ModelFacts, run: &RunSettings) -> Vec<Response> {
    let help = "name what is read off each run, such as `- { of: OUTPUT, what: peak }`";
    let Some(at) = reader.required(root, "responses", help) else {
        return Vec::new();
    };
    let items = reader.items(at, "`responses`");
    if items.is_empty() && matches!(at.node.kind, Kind::List(_)) {
        reader.add(at.problem("there are no responses", help));
    }
    items
        .iter()
        .filter_map(|at| response(reader, *at, facts, run))
        .collect()
}

fn response(
    reader: &Reader,
    at: At<'_>,
    facts: &ModelFacts,
    run: &RunSettings,
) -> Option<Response> {
    if !reader.record(at, "a response", &["name", "of", "what", "at", "duration"]) {
        return None;
    }
    let output = reader
        .required(at, "of", "name an output of the model")
        .and_then(|at| {
            let name = reader.text(at)?;
            let found = facts.output(&name);
            if found.is_none() {
                let message = format!("the model has no output {}", quoted(&name));
                let names = facts.outputs.iter().map(|o| o.name.as_str());
                reader.add(at.problem(
                    message,
                    suggestion(&name, names, "it has no outputs at all"),
                ));
            }
            found
        });
    let words = NAMES.map(|(name, _)| name);
    let word = reader
        .required(at, "what", &format!("one of {}", words.join(", ")))
        .and_then(|at| reader.word(at, "response", &words))?;
    let what = timed(reader, at, word, facts, run)?;
    let what = sampled(reader, at, word, what, facts, run)?;
    let (index, output) = output?;
    if what.is_injury_criterion() && dimension(&output.unit) != dimension("m/s^2") {
        let message = format!(
            "{word} is of accelerations, but \"{}\" is in \"{}\"",
            output.name, output.unit
        );
        reader.add(at.key("of").problem(message, "name an output in m/s^2"));
        return None;
    }
    let name = match optional(at, "name") {
        Some(at) => {
            let name = reader.text(at)?;
            if name.contains(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')) {
                let message = "a name is a single line, the heading of a column";
                reader.add(at.problem(message, "write it without line breaks and tabs"));
                return None;
            }
            name
        }
        None => match written_time(at) {
            Some((_, time)) if word == "value" => format!("value at {time} of {}", output.name),
            Some((_, time)) => format!("{time} {word} of {}", output.name),
            None => format!("{word} of {}", output.name),
        },
    };
    Some(Response {
        name,
        output: index,
        of: output.name.clone(),
        what,
        unit: what.unit(&output.unit),
    })
}

/// The time of a response as it is written, with its key.
fn written_time(at: At<'_>) -> Option<(&'static str, String)> {
    ["at", "duration"]
        .into_iter()
        .find_map(|key| match &optional(at, key)?.node.kind {
            Kind::Scalar { text, .. } => Some((key, text.clone())),
            _ => None,
        })
}

/// A kind with its time, where it needs one.
fn timed(
    reader: &Reader,
    at: At<'_>,
    word: &str,
    facts: &ModelFacts,
    run: &RunSettings,
) -> Option<What> {
    let what = What::named(word)?;
    let needed = match what {
        What::Value { .. } => Some("at"),
        What::Clip { .. } | What::ContiguousClip { .. } => Some("duration"),
        _ => None,
    };
    for key in ["at", "duration"] {
        if let Some(at) = optional(at, key)
            && needed != Some(key)
        {
            let message = format!("`{key}` has no meaning for {word}");
            reader.add(at.key_problem(message, "remove it"));
            return None;
        }
    }
    let Some(key) = needed else {
        return Some(what);
    };
    let place = reader.required(
        at,
        key,
        &format!("{word} needs a time, such as `{key}: 3 ms`"),
    )?;
    let time = reader.quantity(place, "s")?;
    let (allowed, help) = match key {
        "at" => (time >= 0.0, "write a time from 0 on"),
        _ => (time > 0.0, "write a time greater than 0"),
    };
    if !allowed {
        reader.add(place.problem(format!("the time is {time} s"), help));
        return None;
    }
    let duration = run.duration.unwrap_or(facts.run.duration);
    if time > duration {
        let message = format!("{time} s is beyond the end of the run at {duration} s");
        reader.add(place.problem(
            message,
            "write a time within the run, or a longer `run: { duration: … }`",
        ));
        return None;
    }
    Some(match what {
        What::Value { .. } => What::Value { at: time },
        What::Clip { .. } => What::Clip { duration: time },
        _ => What::ContiguousClip { duration: time },
    })
}

/// What is read off windows needs several samples in each.
fn sampled(
    reader: &Reader,
    at: At<'_>,
    word: &str,
    what: What,
    facts: &ModelFacts,
    run: &RunSettings,
) -> Option<What> {
    let sampling = run.sampling.unwrap_or(facts.run.sampling);
    let Some(window) = what.window().filter(|window| sampling > *window) else {
        return Some(what);
    };
    let message = format!("{word} looks at {window} s, and there is a sample every {sampling} s");
    reader.add(at.key("what").problem(
        message,
        "give a shorter time between samples, `run: { sampling: … }`",
    ));
    None
}
