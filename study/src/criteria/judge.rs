//! Finds the criteria of a model, and the outputs from which they are computed.

use super::choice::{Asked, Candidate, Found, ambiguous, choose, is_pattern, known};
use super::limits::{self, Limit, Limits};
use super::{CRITERIA, Criterion, Missing, PLACES, SensorPlace};
use crate::facts::{CriteriaFact, ModelFacts, OutputFact};
use crate::quantity::dimension;
use crate::response::Response;
use bryant_generator::model::units::UnitSystem;
use bryant_runtime::response::Channel;
use bryant_runtime::response::filter::{Filter, Standard};

/// A criterion of a model.
pub struct Judged {
    /// The criterion.
    pub criterion: &'static Criterion,
    /// Its limit; `None` if it has no limit.
    pub limit: Option<Limit>,
    /// The response that computes its value \[SI\], or the reason why there is none.
    pub response: Result<Response, Missing>,
    /// A remark on it.
    pub detail: String,
    /// The places that it uses, each with the name and channel code of the output there.
    pub channels: Vec<(String, String)>,
}

/// How the number that a response computes is shown beside its limit.
pub struct Shown {
    /// The unit of both.
    pub unit: &'static str,
    /// SI value of that unit.
    pub scale: f64,
    /// The limit in that unit; `None` if there is none.
    pub limit: Option<f64>,
}

impl Judged {
    /// How the number that its response computes is shown. Of a limit that falls with the duration of the load, it is
    /// the largest ratio of the load to the limit.
    pub fn shown(&self) -> Shown {
        let (unit, scale) = (self.criterion.unit, self.criterion.scale);
        match self.limit {
            None => Shown {
                unit,
                scale,
                limit: None,
            },
            Some(Limit::Constant(limit)) => Shown {
                unit,
                scale,
                limit: Some(limit),
            },
            Some(Limit::Falling(_)) => Shown {
                unit: "",
                scale: 1.0,
                limit: Some(1.0),
            },
        }
    }
}

/// The criteria of a model by a regulation: all criteria that the regulation limits, and those criteria without a limit
/// that can be computed and share no output with a limited one.
///
/// # Errors
/// There is no such regulation or dummy, no such place or output, or an output has a unit of another quantity.
pub fn judge(facts: &ModelFacts, asked: &CriteriaFact) -> Result<(Limits, Vec<Judged>), String> {
    let limits = limits::find(&asked.standard, &asked.dummy)?;
    let found = outputs(facts, asked)?;
    let one = |criterion: &'static Criterion| {
        let formed = response(
            criterion,
            facts,
            (&limits, asked.standard_of_filters()),
            &found,
        );
        let (response, detail) = match formed {
            Ok((response, detail)) => (Ok(response), detail),
            Err(missing) => (Err(missing), String::new()),
        };
        let channels = match &response {
            Ok(response) => channels(facts, response, &found),
            Err(_) => Vec::new(),
        };
        Judged {
            criterion,
            limit: limits.of(criterion).cloned(),
            response,
            detail,
            channels,
        }
    };
    let mut all: Vec<Judged> = CRITERIA.iter().map(one).collect();
    let outputs = |one: &Judged| match &one.response {
        Ok(response) => response.channel.outputs().to_vec(),
        Err(_) => Vec::new(),
    };
    let limited = all.iter().filter(|one| one.limit.is_some());
    let limited: Vec<usize> = limited.flat_map(outputs).collect();
    all.retain(|one| {
        let of_others = outputs(one).iter().any(|output| limited.contains(output));
        one.limit.is_some() || one.response.is_ok() && !of_others
    });
    Ok((limits, all))
}

/// The places that a response uses, each with the name and channel code of the output there.
fn channels(
    facts: &ModelFacts,
    response: &Response,
    found: &[(&'static str, usize)],
) -> Vec<(String, String)> {
    let outputs = response.channel.outputs().iter();
    let each = outputs.filter_map(|output| {
        let (place, _) = found.iter().find(|(_, index)| index == output)?;
        let fact = &facts.outputs[*output];
        let name = match &fact.code {
            Some(code) => format!("{} ({code})", fact.name),
            None => fact.name.clone(),
        };
        Some(((*place).to_owned(), name))
    });
    each.collect()
}

/// The response that computes a criterion, with a remark on it; `found` are the available places with their outputs.
fn response(
    criterion: &Criterion,
    facts: &ModelFacts,
    (limits, standard): (&Limits, Standard),
    found: &[(&'static str, usize)],
) -> Result<(Response, String), Missing> {
    let output = |place: &str| found.iter().find(|(name, _)| *name == place);
    let formed = criterion.formed(limits, &|place| output(place).is_some(), facts.planar)?;
    let indices = formed.places.iter().filter_map(|place| output(place));
    let indices: Vec<usize> = indices.map(|(_, index)| *index).collect();
    let names = indices
        .iter()
        .map(|index| facts.outputs[*index].name.as_str());
    let of = names.collect::<Vec<_>>().join(", ");
    // the filter of the criterion, not the one that the output has in tables
    let filter = criterion
        .class(limits)
        .map(|class| Filter { class, standard });
    let channel = Channel::of(&indices, filter, formed.combination);
    let channel = channel.ok_or_else(|| Missing::Unusable("it has too few places".to_owned()))?;
    let first = &facts.outputs[indices[0]];
    let si = match formed.combination.keeps_unit() {
        true => formed.what.unit(&first.unit),
        false => si(criterion.unit).to_owned(),
    };
    let shown = first.unit_shown();
    let all_alike = indices
        .iter()
        .all(|index| facts.outputs[*index].unit_shown() == shown);
    let unit = match all_alike {
        true => facts.unit_for(&si, first),
        false => UnitSystem::Si.unit(&si),
    };
    let response = Response {
        name: criterion.name.to_owned(),
        channel,
        of,
        what: formed.what,
        unit,
    };
    let remarks = indices
        .iter()
        .map(|index| facts.outputs[*index].remark.as_deref());
    let mut detail: Vec<&str> = remarks.flatten().chain([formed.detail]).collect();
    detail.dedup();
    detail.retain(|text| !text.is_empty());
    Ok((response, detail.join("; ")))
}

/// The response of a criterion for a model that names its regulation.
///
/// # Errors
/// The model names no regulation, it lacks the outputs, or the regulation does not have this criterion.
pub fn named(facts: &ModelFacts, name: &str) -> Result<Response, String> {
    let Some(criterion) = Criterion::named(name) else {
        let all: Vec<&str> = CRITERIA.iter().map(|one| one.name).collect();
        return Err(format!(
            "there is no criterion \"{name}\"\n  help: one of {}",
            all.join(", ")
        ));
    };
    let Some(asked) = &facts.criteria else {
        return Err(format!(
            "the model does not say where the places of {} are\n  help: give it `criteria: {{ standard: …, dummy: …, head: … }}`",
            criterion.name
        ));
    };
    let limits = limits::find(&asked.standard, &asked.dummy)?;
    let found = outputs(facts, asked)?;
    match response(
        criterion,
        facts,
        (&limits, asked.standard_of_filters()),
        &found,
    ) {
        Ok((response, _)) => Ok(response),
        Err(Missing::Place(place)) => Err(format!(
            "{} needs an output at the place {place}\n  help: name it under `criteria`, `{}: OUTPUT`",
            criterion.name,
            place.replace('-', "_")
        )),
        Err(Missing::Unusable(why)) => Err(format!(
            "{}: {why}\n  help: take another criterion, or another regulation",
            criterion.name
        )),
    }
}

/// The region of the body that a place belongs to: `head` for `head-wx`.
fn stem(place: &str) -> &str {
    place.split('-').next().unwrap_or(place)
}

/// The SI unit of the same quantity as the unit in which a criterion is shown.
fn si(shown: &str) -> &str {
    match shown {
        "g" => "m/s^2",
        "mm" => "m",
        other => other,
    }
}

/// Refuses an output that differs from the reading of an instrument: an acceleration that no instrument can measure, or
/// a load of the neck in the axes of the model.
fn is_a_reading(output: &OutputFact, place: &SensorPlace) -> Result<(), String> {
    let name = &output.name;
    if let Some(why) = &output.unread {
        return Err(format!(
            "the output \"{name}\" at the place {} is no reading of an instrument: {why}\n  help: name an output with `what: accelerometer`",
            place.name
        ));
    }
    let is_signed = place.name.starts_with("neck");
    match is_signed && !output.standard {
        true => Err(format!(
            "the output \"{name}\" at the place {} has the axes of the model, and not those of SAE J211\n  \
             help: write `criteria: {{ neck: SYSTEM/HEAD }}` in the model, or give the output its `code`, such as 11NECKUP00H3{}A",
            place.name,
            &place.code[12..15]
        )),
        false => Ok(()),
    }
}

/// The places of a dummy, each with the index of its output: the output that the user names, else the output with the
/// channel code of the place.
fn outputs(facts: &ModelFacts, asked: &CriteriaFact) -> Result<Vec<(&'static str, usize)>, String> {
    for (name, output) in &asked.places {
        known(name, output)?;
    }
    let choice = choice(facts, asked)?;
    let mut found = Vec::new();
    for place in &PLACES {
        let index = match choice.iter().find(|(name, _)| *name == place.name) {
            Some((_, Found::Named(index))) => *index,
            // the candidates differ only in their filters, which do not matter here: a run has unfiltered outputs
            Some((_, Found::Coded(all) | Found::Doubtful(all))) => all[0],
            Some((_, Found::Several(all))) => {
                let names = all.iter().map(|index| facts.outputs[*index].name.as_str());
                return Err(format!(
                    "{}\n  help: name one, `{}: OUTPUT` under `criteria` or --place {}=OUTPUT",
                    ambiguous(place.name, &names.collect::<Vec<_>>()),
                    place.name.replace('-', "_"),
                    place.name
                ));
            }
            None => continue,
        };
        let unit = &facts.outputs[index].unit;
        if dimension(unit) != dimension(place.unit) {
            return Err(format!(
                "the output \"{}\" is in `{unit}`, and the place {} is in {}\n  help: name an output of that unit",
                facts.outputs[index].name, place.name, place.unit
            ));
        }
        is_a_reading(&facts.outputs[index], place)?;
        let resultant = facts.outputs[index].resultant;
        let whole = ["head", "chest"].contains(&place.name);
        let part = [
            "head-x", "head-y", "head-z", "head-wx", "head-wy", "head-wz", "chest-x", "chest-y",
            "chest-z",
        ]
        .contains(&place.name);
        if whole && resultant == Some(false) || part && resultant == Some(true) {
            let (is, wants) = match whole {
                true => ("a component", "a resultant"),
                false => ("a resultant", "a component"),
            };
            return Err(format!(
                "the output \"{}\" is {is}, and the place {} is {wants}\n  help: name components as {}-x, {}-y, {}-z, or a resultant as {}",
                facts.outputs[index].name,
                place.name,
                stem(place.name),
                stem(place.name),
                stem(place.name),
                stem(place.name)
            ));
        }
        found.push((place.name, index));
    }
    Ok(found)
}

/// The candidates for each place.
fn choice(facts: &ModelFacts, asked: &CriteriaFact) -> Result<Vec<(&'static str, Found)>, String> {
    let mut said = Asked {
        occupant: asked.occupant.clone(),
        how: "`occupant` under `criteria`, or --occupant",
        ..Asked::default()
    };
    for (place, output) in &asked.places {
        match facts.output(output) {
            Some((index, _)) => said.named.push((place.clone(), index)),
            None if is_pattern(output) => said.patterns.push((place.clone(), output.clone())),
            None => {
                let all: Vec<&str> = facts.outputs.iter().map(|o| o.name.as_str()).collect();
                return Err(format!(
                    "there is no output \"{output}\" for the place {place}\n  help: there are: {}",
                    all.join(", ")
                ));
            }
        }
    }
    let each = facts.outputs.iter().map(|output| Candidate {
        name: &output.name,
        code: output.code.as_deref().unwrap_or_default(),
        doubt: None,
    });
    let candidates: Vec<Candidate<'_>> = each.collect();
    choose(&candidates, &said).map(|choice| choice.found)
}
