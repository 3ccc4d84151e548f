//! Responses that are requested on the command line: numbers that are computed from a run.
//!
//! They are written as the headings of columns of a study, WHAT of OUTPUT: `HIC15 of head accelerometer`, `3 ms clip of
//! chest acceleration`.

use super::Error;
use super::model_argument::nearest;
use crate::quantity;
use crate::sweep::response_of;
use bryant_generator::model::units::Unit;
use bryant_runtime::batch::rows::Asked;
use bryant_runtime::response::filter::{Class, Filter, MEAN};
use bryant_study::criteria::{self, Criterion};
use bryant_study::facts::ModelFacts;
use bryant_study::response::{self, NAMES, What, channel_of};

/// A requested response.
pub struct Requested {
    /// Its name, the same as in a study.
    pub name: String,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// The length of its window, if it has one \[s\].
    pub window: Option<f64>,
    /// The response as a request to the runtime.
    pub asked: Asked,
    /// A warning about it.
    pub caution: Option<String>,
}

/// Largest number of samples of a run, as in a study, because they are kept until its end.
const MOST_SAMPLES: f64 = 1e6;

/// The number of intervals between samples in a run of this duration \[s\]. `bytes` is the size of a sample of one
/// response.
///
/// # Errors
/// There are more samples than can be kept, or fewer than the run, the window of a response or a filter needs.
pub fn intervals(
    every: f64,
    duration: f64,
    responses: &[Requested],
    bytes: usize,
) -> Result<usize, Error> {
    let fault = |what: &str, length: f64| {
        Error::Input(format!(
            "there is a sample every {every} s, and {what} is {length} s long\n  help: give a shorter time with --sampling"
        ))
    };
    if every > duration {
        return Err(fault("the run", duration));
    }
    for response in responses {
        if let Some(window) = response.window.filter(|window| every > *window) {
            return Err(fault(&format!("the window of {}", response.name), window));
        }
        if let Some(class) = response.filter().filter(|class| !class.allows(every)) {
            return Err(too_coarse(class, every));
        }
    }
    let intervals = (duration / every).round().max(1.0);
    let filtered = responses.iter().any(|response| response.filter().is_some());
    if filtered && intervals < MEAN as f64 {
        return Err(too_short(duration));
    }
    if intervals >= MOST_SAMPLES {
        return Err(Error::Input(format!(
            "a sample every {every} s makes {intervals:.0} of a run of {duration} s, which would take about {:.1} GB, and at most \
             {MOST_SAMPLES} are kept\n  help: give a longer time with --sampling, or a shorter --duration",
            intervals * (bytes * responses.len()) as f64 / 1e9
        )));
    }
    Ok(intervals as usize)
}

/// The error for a run that is too short for a filter.
pub fn too_short(duration: f64) -> Error {
    Error::Input(format!(
        "a filter needs {MEAN} samples at least, and the run is {duration} s long\n  help: give a longer --duration, or a shorter time between samples with --sampling"
    ))
}

/// The error for samples that are too far apart for a filter.
pub fn too_coarse(class: Class, every: f64) -> Error {
    Error::Input(format!(
        "{class} needs a sample every {} s at least, and there is one every {every} s\n  help: give a shorter time with --sampling, or leave out --sampling",
        class.longest_interval()
    ))
}

/// The time between samples by default \[s\]: `usual`, or less if filters need less.
pub fn sampling(usual: f64, responses: &[Requested]) -> f64 {
    let filters = responses.iter().filter_map(Requested::filter);
    filters.map(Class::longest_interval).fold(usual, f64::min)
}

/// Kinds of responses that need a time.
const TIMED: [&str; 3] = ["value", "clip", "contiguous clip"];

impl Requested {
    /// The class of its filter, if it has one.
    pub fn filter(&self) -> Option<Class> {
        self.asked.channel.filter.map(|filter| filter.class)
    }

    /// The response of a study.
    pub fn of_study(response: &response::Response) -> Requested {
        Requested {
            name: response.name.clone(),
            unit: response.unit.clone(),
            window: response.what.window(),
            asked: Asked {
                channel: response.channel,
                response: response_of(response.what),
            },
            caution: None,
        }
    }

    /// Reads WHAT of OUTPUT, for a run that lasts from `start` to `end` \[s\]: `3 ms clip of chest`, or `clip 3 ms of
    /// chest`. Underscores stand for spaces, and an output may be named by some of its words. A filter follows a comma:
    /// `peak of chest x, CFC180`. The name of an injury criterion alone is that criterion of a model with `criteria`.
    /// `option` is the name of the option in messages.
    ///
    /// # Errors
    /// There is no such response or output, or a time is outside the run.
    pub fn read(
        option: &str,
        text: &str,
        facts: &ModelFacts,
        [start, end]: [f64; 2],
    ) -> Result<Requested, Error> {
        let words = text.replace('_', " ");
        let words = words.trim();
        if let Some(criterion) = Criterion::named(words) {
            return criteria::named(facts, criterion.name)
                .map(|response| Requested::of_study(&response))
                .map_err(|message| Error::Input(format!("{option} '{words}': {message}")));
        }
        let fault = |Fault { message, help }| {
            Error::Input(format!(
                "{option} '{}': {message}\n  help: {help}",
                text.escape_debug()
            ))
        };
        let behind = words.rsplit_once(',');
        let behind = behind.and_then(|(before, last)| Some((before, Filter::named(last.trim())?)));
        let (words, filter) = match behind {
            Some((before, filter)) => (before.trim(), Some(filter.to_string())),
            None => (words, None),
        };
        let (title, what, rest) = titled(words, [start, end]).map_err(fault)?;
        let output = output(rest, facts).map_err(|help| {
            fault(Fault {
                message: format!("no output is \"{}\"", rest.escape_debug()),
                help,
            })
        })?;
        let of = &facts.outputs[output];
        if what.is_injury_criterion() && of.unit != "m/s^2" {
            return Err(fault(Fault {
                message: format!(
                    "{title} needs an acceleration, and \"{}\" is in {}",
                    of.name, of.unit
                ),
                help: "name an output in m/s^2".into(),
            }));
        }
        Ok(Requested {
            name: match &filter {
                Some(filter) => format!("{title} of {}, {filter}", of.name),
                None => format!("{title} of {}", of.name),
            },
            unit: facts.unit_for(&what.unit(&of.unit), of),
            window: what.window(),
            asked: Asked {
                channel: channel_of(output, filter.as_deref().or(of.filter.as_deref())),
                response: response_of(what),
            },
            caution: what.caution(of),
        })
    }
}

/// Why a request for a response cannot be read, with a remedy.
struct Fault {
    message: String,
    help: String,
}

/// Reads the beginning of a request. Returns the title of the response, as in a study, its kind, and the text after it,
/// which names the output.
fn titled(words: &str, [start, end]: [f64; 2]) -> Result<(String, What, &str), Fault> {
    let (time_before, rest) = time_before(words).unwrap_or(("", words));
    let Some((name, what, rest)) = kind(rest) else {
        let said = words.split(" of ").next().unwrap_or(words);
        let names = NAMES.map(|(name, _)| name);
        // the first word is enough for a suggestion, as in `max crush` and `maximum of crush`
        let first = said.split_whitespace().next().unwrap_or(said);
        let near = response::meant(said)
            .or_else(|| nearest(said, &names))
            .or_else(|| response::meant(first));
        let near = near.map(|near| format!("did you mean \"{near}\"? "));
        let near = near.unwrap_or_default();
        return Err(Fault {
            message: "it does not begin with a response".into(),
            help: format!(
                "{near}write WHAT of OUTPUT with one of {}",
                names.join(", ")
            ),
        });
    };
    if !TIMED.contains(&name) {
        let output = rest.strip_prefix("of ").unwrap_or(rest);
        return Ok((name.to_owned(), what, output.trim()));
    }
    let (written, output) = match (time_before, rest.split_once(" of ")) {
        ("", Some((written, rest))) => (written.trim().trim_start_matches("at ").trim(), rest),
        ("", None) => ("", rest),
        (time, _) => (time, rest.strip_prefix("of ").unwrap_or(rest)),
    };
    if written.is_empty() {
        return Err(Fault {
            message: format!("\"{name}\" needs a time"),
            help: match name {
                "value" => "write `value at 80 ms of OUTPUT`".into(),
                name => format!("write `3 ms {name} of OUTPUT`"),
            },
        });
    }
    let time = quantity::time(written).map_err(|error| Fault {
        message: error.to_string(),
        help: "write a time".into(),
    })?;
    let (what, title, outside) = match what {
        What::Value { .. } => (
            What::Value { at: time },
            format!("value at {written}"),
            !(start..=end).contains(&time),
        ),
        What::Clip { .. } => (
            What::Clip { duration: time },
            format!("{written} {name}"),
            time > end - start,
        ),
        _ => (
            What::ContiguousClip { duration: time },
            format!("{written} {name}"),
            time > end - start,
        ),
    };
    match (outside, start > 0.0) {
        (false, _) => Ok((title, what, output.trim())),
        (true, true) => Err(Fault {
            message: format!("{time} s is outside of the run from {start} s to {end} s"),
            help: "take a time within it".into(),
        }),
        (true, false) => Err(Fault {
            message: format!("{time} s is beyond the run of {end} s"),
            help: "take an earlier time, or a longer run by --duration".into(),
        }),
    }
}

/// The kind of response at the beginning of a text (the longest name that fits), and the rest of the text.
fn kind(text: &str) -> Option<(&'static str, What, &str)> {
    let begins = |name: &str| {
        let rest = text.get(name.len()..);
        let same = text.get(..name.len());
        same.is_some_and(|same| same.eq_ignore_ascii_case(name))
            && rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let kinds = NAMES.iter().filter(|(name, _)| begins(name));
    let (name, what) = kinds.max_by_key(|(name, _)| name.len())?;
    Some((name, *what, text[name.len()..].trim()))
}

/// A time in front of a kind that needs one, and the rest of the text, for example of `3 ms clip of chest`.
fn time_before(text: &str) -> Option<(&str, &str)> {
    let spaces = text.match_indices(' ').map(|(at, _)| at);
    let mut ways = spaces.map(|at| (text[..at].trim(), text[at..].trim()));
    ways.find(|(time, rest)| {
        let timed = kind(rest).is_some_and(|(name, ..)| name != "value" && TIMED.contains(&name));
        timed && quantity::quantity(time, "s").is_ok()
    })
}

/// The index of the output with this name; if there is none, of the only output whose name has all of these words.
fn output(text: &str, facts: &ModelFacts) -> Result<usize, String> {
    let names: Vec<&str> = facts.outputs.iter().map(|o| o.name.as_str()).collect();
    // underscores and spaces are the same, also in names of outputs
    let spaced = |name: &str| name.replace('_', " ").trim().to_owned();
    if let Some(index) = names.iter().position(|name| spaced(name) == text) {
        return Ok(index);
    }
    let has_all = |name: &str| {
        let name = spaced(name);
        let words: Vec<&str> = name.split_whitespace().collect();
        !text.is_empty() && text.split_whitespace().all(|word| words.contains(&word))
    };
    let alike: Vec<usize> = (0..names.len()).filter(|i| has_all(names[*i])).collect();
    match (alike.as_slice(), nearest(text, &names)) {
        ([one], _) => Ok(*one),
        ([], Some(near)) => Err(format!("did you mean \"{near}\"?")),
        ([], None) => Err(format!("there are: {}", names.join(", "))),
        (several, _) => {
            let several: Vec<&str> = several.iter().map(|i| names[*i]).collect();
            Err(format!(
                "several outputs have these words: {}",
                several.join(", ")
            ))
        }
    }
}
