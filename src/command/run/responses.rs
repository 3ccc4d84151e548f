//! The responses of a run: each is one number for a whole signal, as in a study.
//!
//! Responses are computed from samples of their own, so they do not depend on the rows of the table.

use super::criteria::Criteria;
use super::result::Peak;
use super::{Arguments, Error, ErrorReport};
use crate::accuracy::conclusion::percent;
use crate::command::model_argument::Found;
use crate::command::response::{self, Requested, intervals};
use crate::command::sweep;
use crate::criteria::Verdict;
use crate::report::Samples;
use crate::simulation::Recording;
use crate::units::Units;
use bryant_generator::model::Model;
use bryant_picture::text::typeset;
use bryant_runtime::program::{Kept, OutputHeader, Reading};
use bryant_runtime::response::Channel;
use bryant_runtime::response::filter::{Class, MEAN};
use bryant_study::facts::ModelFacts;
use bryant_study::response::channel_of;
use serde_json::{Value, json};

/// The responses of a run.
pub struct Responses {
    /// The requested responses, then those of the criteria.
    asked: Vec<Requested>,
    /// The number of requested responses.
    own: usize,
    /// The criteria that the run is judged by.
    criteria: Option<Criteria>,
    /// The index of the first signal that is kept for the criteria.
    kept: usize,
    /// For each of the first outputs, the index of its kept signal; other outputs have none.
    signals: Vec<usize>,
    /// The units in which responses and outputs are shown.
    pub units: Units,
    /// Time between the samples \[s\].
    every: f64,
    /// The responses as a request to the runtime.
    pub reading: Reading,
    /// The differences between the settings of the run and those of the study whose responses it uses, in words.
    otherwise: Option<String>,
}

/// About the largest number of times in a report for which works of effects are kept.
const WORKS: f64 = 300.0;
/// Largest number of outputs whose peaks are printed.
const MOST_PEAKS: usize = 5;
/// About the largest number of samples of outputs that are kept for a report: 160 MB.
const MOST_KEPT: usize = 20_000_000;
/// Number of samples for each row of the table, if only peaks need samples. A peak between samples is that of a
/// parabola through them.
const BETWEEN_ROWS: f64 = 5.0;
/// A smaller relative difference is a rounding error.
const ROUNDING: f64 = 1e-12;
/// Significant digits of a response, as in the summary of a study.
const DIGITS: i32 = 4;

impl Responses {
    /// The requested responses for a run that begins at `start` \[s\].
    ///
    /// # Errors
    /// A response cannot be computed from this run, two responses have the same name, there are too many samples, or a
    /// time between samples is given without a response.
    pub fn of(arguments: &Arguments, found: &Found, start: f64) -> Result<Self, Error> {
        let model = &found.model;
        let facts = ModelFacts::of(&found.scene);
        let end = arguments.duration.unwrap_or(model.run.duration);
        let Requests {
            responses: mut asked,
            sampling,
            otherwise,
        } = Requests::of(arguments, &facts, [start, end])?;
        let own = asked.len();
        let criteria = Criteria::of(arguments, &facts)?;
        asked.extend(criteria.iter().flat_map(Criteria::responses));
        let mut kept = filtered(model);
        let columns = kept.len();
        kept.extend(criteria.iter().flat_map(Criteria::kept));
        let filters = kept.iter().filter_map(|kept| kept.channel.filter);
        let classes: Vec<Class> = filters.map(|filter| filter.class).collect();
        let sampling = sampling.unwrap_or_else(|| {
            let needed = classes.iter().copied().map(Class::longest_interval);
            let own = match asked.is_empty() && classes.is_empty() {
                true => arguments.every.unwrap_or(model.run.every) / BETWEEN_ROWS,
                false => response::sampling(facts.run.sampling, &asked),
            };
            needed.fold(own, f64::min)
        });
        if let Some(class) = classes.iter().find(|class| !class.allows(sampling)) {
            return Err(response::too_coarse(*class, sampling));
        }
        let silent = asked.is_empty() && kept.is_empty() && model.outputs.is_empty();
        let intervals = match end > start && !silent {
            true => intervals(sampling, end - start, &asked, size_of::<f64>())?,
            // the run itself reports this error
            false => 1,
        };
        if !classes.is_empty() && end > start && intervals < MEAN {
            return Err(response::too_short(end - start));
        }
        // a report shows samples of all outputs between rows, as far as memory allows
        let shown = match arguments.report {
            Some(_) => (MOST_KEPT / intervals).max(MOST_PEAKS),
            None => MOST_PEAKS,
        };
        let signals = signals(model.outputs.len().min(shown), &mut kept);
        Ok(Responses {
            reading: Reading {
                intervals: intervals as u64,
                asked: asked.iter().map(|response| response.asked).collect(),
                kept,
                works_every: arguments.report.as_ref().map(|_| (end - start) / WORKS),
            },
            asked,
            own,
            criteria,
            kept: columns,
            signals,
            units: Units::of(model),
            every: (end - start) / intervals as f64,
            otherwise,
        })
    }

    /// The warnings about the requested responses.
    pub fn cautions(&self) -> impl Iterator<Item = &str> {
        self.asked.iter().filter_map(|one| one.caution.as_deref())
    }

    /// The samples of an output; `None` if they are not kept, or the run did not reach its end.
    pub fn samples<'a>(&self, recording: &'a Recording, output: usize) -> Option<Samples<'a>> {
        let values = recording.kept.get(*self.signals.get(output)?)?;
        (!values.is_empty()).then_some(Samples {
            values,
            start: recording.first_time(),
            every: self.every,
        })
    }

    /// The peaks of the first outputs; empty if the run did not reach its end.
    pub fn peaks(&self, recording: &Recording) -> Vec<Peak> {
        let first = recording.header.outputs.iter().enumerate().take(MOST_PEAKS);
        let peak = |(index, output): (usize, &OutputHeader)| {
            let Samples {
                values,
                start,
                every,
            } = self.samples(recording, index)?;
            let unit = self.units.output(index);
            let peak = Peak::of((&output.name, &unit.name), values, [start, every])?;
            Some(Peak {
                value: unit.of_si(peak.value),
                ..peak
            })
        };
        first.filter_map(peak).collect()
    }

    /// The verdict on the run. The outer `None`: no criteria are requested. The inner `None`: the run does not allow a
    /// verdict.
    pub fn verdict(&self, recording: &Recording) -> Option<Option<Verdict>> {
        let criteria = self.criteria.as_ref()?;
        Some(criteria.verdict(recording, [self.own, self.kept], self.every))
    }

    /// Each response with its value, its unit, and its difference from the run that it was compared with.
    fn values<'a>(
        &'a self,
        recording: &'a Recording,
        errors: &'a ErrorReport,
    ) -> impl Iterator<Item = (&'a Requested, Option<f64>, &'a str, Option<f64>)> {
        self.asked[..self.own]
            .iter()
            .enumerate()
            .map(|(index, response)| {
                let answer = recording.answers.get(index).map(|answer| answer.value);
                let apart = errors.responses().and_then(|all| all.get(index).copied());
                let value = answer.map(|si| response.unit.of_si(si));
                (
                    response,
                    value.filter(|value| value.is_finite()),
                    response.unit.name.as_str(),
                    apart.filter(|apart| apart.is_finite()),
                )
            })
    }

    /// The responses for people, a line for each, after an empty line; empty if no responses are requested.
    pub fn text(&self, recording: &Recording, errors: &ErrorReport) -> String {
        if self.own == 0 {
            return String::new();
        }
        let lines: Vec<[String; 3]> = self
            .values(recording, errors)
            .map(|(response, value, unit, apart)| {
                let value = match (value, unit) {
                    (None, _) => "not known".to_owned(),
                    (Some(value), "") => digits(value),
                    (Some(value), unit) => format!("{} {}", digits(value), typeset(unit)),
                };
                let apart = apart.map(|apart| match apart {
                    _ if apart < ROUNDING => "as in its check".to_owned(),
                    apart => format!("differs by {} from its check", percent(apart)),
                });
                [response.name.clone(), value, apart.unwrap_or_default()]
            })
            .collect();
        let width = |column: usize| {
            let widths = lines.iter().map(|line| line[column].chars().count());
            widths.max().unwrap_or(0)
        };
        let (names, values) = (width(0), width(1));
        let mut text = "\n".to_owned();
        for [name, value, apart] in &lines {
            let line = format!("{name:names$}  {value:values$}  {apart}");
            text += line.trim_end();
            text.push('\n');
        }
        if recording.answers.is_empty() {
            text +=
                "there are no responses: the run did not come to its end, or cannot be trusted\n";
        }
        if let Some(line) = &self.otherwise {
            text += line;
            text.push('\n');
        }
        text
    }

    /// The responses as JSON: `[{"response", "value", "unit", "difference"}, …]`; an unknown value is `null`.
    pub fn json(&self, recording: &Recording, errors: &ErrorReport) -> Value {
        let each = self
            .values(recording, errors)
            .map(|(response, value, unit, apart)| {
                json!({
                    "response": response.name,
                    "value": value,
                    "unit": unit,
                    "difference": apart,
                })
            });
        each.collect()
    }
}

/// The requested responses: those of a study, and single ones.
struct Requests {
    responses: Vec<Requested>,
    /// Time between the samples \[s\], if the user gives one.
    sampling: Option<f64>,
    /// The differences between the settings of the run and those of the study, in words.
    otherwise: Option<String>,
}

impl Requests {
    /// The requests for a run that lasts from the first to the second time of `span` \[s\].
    fn of(arguments: &Arguments, facts: &ModelFacts, span: [f64; 2]) -> Result<Self, Error> {
        let [_, end] = span;
        let mut requests = Requests {
            responses: Vec::new(),
            sampling: arguments.sampling,
            otherwise: None,
        };
        if let Some(path) = &arguments.responses {
            let (study, _) = sweep::read(path)?;
            let (responses, every) = study
                .responses(facts, end, arguments.sampling)
                .map_err(Error::Model)?;
            let responses = responses.iter().map(|one| Requested {
                caution: one.caution(&facts.outputs),
                ..Requested::of_study(one)
            });
            requests.responses.extend(responses);
            requests.sampling = Some(every);
            let other = study.duration(facts).filter(|other| *other != end);
            requests.otherwise = other.map(|other| {
                format!(
                    "the runs of {} end at {other} s, this one at {end} s: --duration '{other} s' makes it like them",
                    path.display()
                )
            });
        }
        for text in &arguments.response {
            let response = Requested::read("--response", text, facts, span)?;
            requests.responses.push(response);
        }
        for (index, Requested { name, .. }) in requests.responses.iter().enumerate() {
            let mut earlier = requests.responses[..index].iter();
            if earlier.any(|earlier| earlier.name == *name) {
                return Err(Error::Input(format!(
                    "the response \"{name}\" is asked for twice\n  help: leave one of them out"
                )));
            }
        }
        if requests.responses.is_empty() && arguments.sampling.is_some() {
            return Err(Error::Input(
                "--sampling says when responses are sampled, and there are none\n  \
                 help: ask for one with --response 'WHAT of OUTPUT', or leave out --sampling; --every gives the rows of the table"
                    .into(),
            ));
        }
        Ok(requests)
    }
}

/// The filtered signals of outputs that have a filter and are shown filtered.
fn filtered(model: &Model) -> Vec<Kept> {
    let outputs = model.outputs.iter().enumerate();
    let filtered = outputs.filter(|(_, output)| output.filter.is_some());
    let kept = filtered.map(|(index, output)| Kept {
        channel: channel_of(index, output.filter),
        in_place_of: Some(index),
    });
    kept.collect()
}

/// The indices of the signals of the first outputs; a signal that is not kept yet is added to `kept`.
fn signals(outputs: usize, kept: &mut Vec<Kept>) -> Vec<usize> {
    let mut index_of = |output: usize| {
        let known = kept.iter().position(|one| one.in_place_of == Some(output));
        known.unwrap_or_else(|| {
            kept.push(Kept {
                channel: Channel::output(output),
                in_place_of: None,
            });
            kept.len() - 1
        })
    };
    (0..outputs).map(&mut index_of).collect()
}

/// A number with four digits; a large number as an integer.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".into(),
        _ if (1e-4..1e7).contains(&size) => {
            let decimals = DIGITS - 1 - libm::log10(size).floor() as i32;
            format!("{value:.*}", decimals.max(0) as usize)
        }
        _ => format!("{value:.*e}", DIGITS as usize - 1),
    }
}
