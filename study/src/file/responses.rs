//! Reads `responses`: the numbers that are computed from each run.

use super::reader::{Reader, items, optional};
use crate::criteria;
use crate::facts::ModelFacts;
use crate::quantity::dimension;
use crate::response::{NAMES, Response, What, channel_of, meant};
use crate::study::RunSettings;
use bryant_generator::description::place::At;
use bryant_generator::description::tree::NodeKind;
use bryant_generator::diagnostic::{quoted, suggestion};
use bryant_runtime::response::filter::Filter;

/// Reads all responses; responses with a problem are left out, and the reader collects the problem.
pub fn read(reader: &Reader, root: At<'_>, facts: &ModelFacts, run: &RunSettings) -> Vec<Response> {
    let Some(at) = optional(root, "responses") else {
        return Vec::new();
    };
    let items = items(at);
    if items.is_empty() {
        reader.add(at.problem(
            "there are no responses",
            "name what is read off each run, such as `- { of: OUTPUT, what: peak }`",
        ));
    }
    items
        .iter()
        .flat_map(|at| match optional(*at, "criterion") {
            Some(_) => criteria(reader, *at, facts, run),
            None => response(reader, *at, facts, run).into_iter().collect(),
        })
        .collect()
}

/// The word for all available criteria.
const ALL: &str = "all";

/// The responses for injury criteria, of a model that names its regulation.
fn criteria(reader: &Reader, at: At<'_>, facts: &ModelFacts, run: &RunSettings) -> Vec<Response> {
    let place = at.key("criterion");
    let Some(word) = reader.text(place) else {
        return Vec::new();
    };
    let found = match (word == ALL, &facts.criteria) {
        (true, Some(asked)) => criteria::judge(facts, asked).map(|(_, all)| {
            let there = all.into_iter().filter_map(|one| one.response.ok());
            there.collect::<Vec<_>>()
        }),
        // for `all`, any name gives the message about what is missing
        _ => criteria::named(
            facts,
            match word {
                ALL => criteria::CRITERIA[0].name,
                word => word,
            },
        )
        .map(|one| vec![one]),
    };
    let mut found = match found {
        Ok(found) => found,
        Err(message) => {
            let (message, help) = message.split_once("\n  help: ").unwrap_or((&message, ""));
            reader.add(place.problem(message, help));
            return Vec::new();
        }
    };
    if let Some(name) = optional(at, "name") {
        match found.as_mut_slice() {
            [one] => one.name = heading(reader, name).unwrap_or_default(),
            _ => reader.add(name.key_problem("several criteria have no one name", "remove it")),
        }
    }
    found.retain(|one| sampled(reader, place, &one.name.clone(), one, facts, run));
    found
}

/// The heading of a column; a problem is added if it is not valid.
fn heading(reader: &Reader, at: At<'_>) -> Option<String> {
    let name = reader.text(at)?;
    if name.contains(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')) {
        let message = "a name is a single line, the heading of a column";
        reader.add(at.problem(message, "write it without line breaks and tabs"));
        return None;
    }
    Some(name.to_owned())
}

fn response(
    reader: &Reader,
    at: At<'_>,
    facts: &ModelFacts,
    run: &RunSettings,
) -> Option<Response> {
    let output = optional(at, "of").and_then(|at| {
        let name = reader.text(at)?;
        let found = facts.output(name);
        if found.is_none() {
            let message = format!("the model has no output {}", quoted(name));
            let names = facts.outputs.iter().map(|o| o.name.as_str());
            reader.add(at.problem(message, suggestion(name, names, "it has no outputs at all")));
        }
        found
    });
    let words = NAMES.map(|(name, _)| name);
    let word = optional(at, "what");
    let word = word.and_then(|at| reader.word(at, "response", &words, meant))?;
    let what = timed(reader, at, word, facts, run)?;
    let (index, output) = output?;
    if what.is_injury_criterion() && dimension(&output.unit) != dimension("m/s^2") {
        let message = format!(
            "{word} needs an acceleration, but \"{}\" is in \"{}\"",
            output.name, output.unit
        );
        reader.add(at.key("of").problem(message, "name an output in m/s^2"));
        return None;
    }
    let name = match optional(at, "name") {
        Some(at) => heading(reader, at)?,
        None => match written_time(at) {
            Some((_, time)) if word == "value" => format!("value at {time} of {}", output.name),
            Some((_, time)) => format!("{time} {word} of {}", output.name),
            None => format!("{word} of {}", output.name),
        },
    };
    let filter = match optional(at, "filter") {
        None => output.filter.clone(),
        Some(at) => {
            let names: Vec<String> = Filter::all().map(|filter| filter.to_string()).collect();
            let words: Vec<&str> = names.iter().map(String::as_str).collect();
            Some(reader.word(at, "filter", &words, |_| None)?.to_owned())
        }
    };
    let response = Response {
        name,
        channel: channel_of(index, filter.as_deref()),
        of: output.name.clone(),
        what,
        unit: facts.unit_for(&what.unit(&output.unit), output),
    };
    sampled(reader, at.key("what"), word, &response, facts, run).then_some(response)
}

/// The key of a response's time and its value as written.
fn written_time(at: At<'_>) -> Option<(&'static str, String)> {
    ["at", "duration"]
        .into_iter()
        .find_map(|key| match &optional(at, key)?.node.kind {
            NodeKind::Scalar { text, .. } => Some((key, text.clone())),
            _ => None,
        })
}

/// A kind of response, with its time if it needs one.
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

/// The time between the samples of responses \[s\]: that of the study, else the shortest that the model and the filters
/// need.
pub fn sampling(run: &RunSettings, facts: &ModelFacts, responses: &[Response]) -> f64 {
    let needed = responses.iter().filter_map(Response::longest_interval);
    run.sampling
        .unwrap_or_else(|| needed.fold(facts.run.sampling, f64::min))
}

/// Checks that samples are close enough: a window must not be shorter than the time between samples, and each filter
/// has a longest time between samples.
fn sampled(
    reader: &Reader,
    at: At<'_>,
    word: &str,
    response: &Response,
    facts: &ModelFacts,
    run: &RunSettings,
) -> bool {
    let sampling = sampling(run, facts, std::slice::from_ref(response));
    let message = match (response.what.window(), response.channel.filter) {
        (Some(window), _) if sampling > window => {
            format!("{word} looks at {window} s, and there is a sample every {sampling} s")
        }
        (_, Some(Filter { class, .. })) if !class.allows(sampling) => format!(
            "{class} needs a sample every {} s at least, and there is one every {sampling} s",
            class.longest_interval()
        ),
        _ => return true,
    };
    reader.add(at.problem(
        message,
        "give a shorter time between samples, `run: { sampling: … }`",
    ));
    false
}
