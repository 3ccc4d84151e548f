//! Finds the channels of a test, or the outputs of a model, that measure at the places of a dummy.
//!
//! All channels that are used belong to one occupant: they agree in test object and position, the first two characters
//! of a channel code. All channels of one part of the dummy belong to one sensor: they agree in characters 3 to 12. If
//! several sensors fit a place, none is used and all are reported. A channel whose file casts doubt on its data fills a
//! place only if the user names it.

use super::{PLACES, SensorPlace, fits};
use std::collections::BTreeMap;

/// A channel or an output.
#[derive(Clone, Copy, Debug)]
pub struct Candidate<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its channel code; "" if it has none.
    pub code: &'a str,
    /// The reason to doubt its data; `None` if there is none.
    pub doubt: Option<&'a str>,
}

/// The user's instructions.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// The candidates that the user names for places.
    pub named: Vec<(String, usize)>,
    /// Patterns of codes, with `?` for any character and `*` for any at the end, for places or parts such as `head`.
    pub patterns: Vec<(String, String)>,
    /// Test object and position of the occupant.
    pub occupant: Option<String>,
    /// The option or key for the occupant, for messages: `--occupant`.
    pub how: &'static str,
}

/// The candidates that were found for a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// The one that the user names.
    Named(usize),
    /// Candidates of one sensor; they differ only in their filters.
    Coded(Vec<usize>),
    /// Only candidates whose files cast doubt on their data.
    Doubtful(Vec<usize>),
    /// Candidates of several sensors, or with equal codes.
    Several(Vec<usize>),
}

/// The candidates that were found for all places of a dummy.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Test object and position; `None` if no code says it.
    pub occupant: Option<String>,
    /// The places for which candidates were found.
    pub found: Vec<(&'static str, Found)>,
}

impl Choice {
    /// The candidates that were found for a place; `None` if there are none.
    pub fn at(&self, place: &str) -> Option<&Found> {
        let found = self.found.iter().find(|(name, _)| *name == place);
        found.map(|(_, found)| found)
    }
}

/// True if a name contains wild cards, as a pattern of codes does.
pub fn is_pattern(name: &str) -> bool {
    name.contains(['?', '*'])
}

/// The message that several candidates fit a place.
pub fn ambiguous(place: &str, names: &[&str]) -> String {
    format!("several channels could be {place}: {}", names.join(", "))
}

/// The seat of an occupant in words; "" if the position says none [ISO/TS 13499 RED B 1.6.2, as in the program
/// pyisomme].
pub fn seat(occupant: &str) -> &'static str {
    match occupant.chars().nth(1) {
        Some('1') => "front left",
        Some('2') => "front middle",
        Some('3') => "front right",
        Some('4') => "second row left",
        Some('5') => "second row middle",
        Some('6') => "second row right",
        Some('7') => "third row left",
        Some('8') => "third row middle",
        Some('9') => "third row right",
        _ => "",
    }
}

/// Chooses the candidates for each place.
///
/// # Errors
/// Several occupants have channels, an occupant has none, or a pattern fits nothing.
pub fn choose(candidates: &[Candidate<'_>], asked: &Asked) -> Result<Choice, String> {
    let mut at = fitting(candidates, asked)?;
    let named = |place: &str| asked.named.iter().find(|(name, _)| name == place);
    let occupant = occupant(candidates, asked, &at)?;
    if let Some(occupant) = &occupant {
        at.iter_mut().for_each(|(_, all)| {
            all.retain(|index| occupant_of(candidates[*index].code) == *occupant)
        });
    }
    let mut found = Vec::new();
    for (place, coded) in &at {
        if let Some((_, index)) = named(place.name) {
            found.push((place.name, Found::Named(*index)));
            continue;
        }
        let is_sound = |index: &&usize| candidates[**index].doubt.is_none();
        let sound: Vec<usize> = coded.iter().filter(is_sound).copied().collect();
        let part = part(place.name);
        // a resultant is not compared with the sensors of its components, because it is not used beside them
        let others = at.iter().filter(|(other, _)| {
            self::part(other.name) == part && (place.name == part || other.name != part)
        });
        let mut of_part: Vec<usize> = others.flat_map(|(_, all)| all).copied().collect();
        of_part.retain(|index| candidates[*index].doubt.is_none());
        let several = sensors(candidates, &of_part) > 1 || has_twins(candidates, &sound);
        match (sound.is_empty(), coded.is_empty()) {
            (true, true) => {}
            (true, false) => found.push((place.name, Found::Doubtful(coded.clone()))),
            (false, _) if several => found.push((place.name, Found::Several(of_part))),
            (false, _) => found.push((place.name, Found::Coded(sound))),
        }
    }
    Ok(Choice { occupant, found })
}

/// The candidates that fit each place by their codes and the user's patterns. Components of a resultant that the user
/// names get no candidates.
fn fitting(
    candidates: &[Candidate<'_>],
    asked: &Asked,
) -> Result<Vec<(&'static SensorPlace, Vec<usize>)>, String> {
    let named = |place: &str| asked.named.iter().any(|(name, _)| name == place);
    let mut used = vec![false; asked.patterns.len()];
    let mut at = Vec::new();
    for place in &PLACES {
        let part = part(place.name);
        let replaced = part != place.name && named(part) && !named(place.name);
        let all = candidates.iter().enumerate();
        let all = all.filter(|(_, one)| !replaced && fits(one.code, place.code));
        let mut all: Vec<usize> = all.map(|(index, _)| index).collect();
        for ((of, pattern), used) in asked.patterns.iter().zip(&mut used) {
            if of == place.name || of == part {
                all.retain(|index| matches(candidates[*index].code, pattern));
                *used |= !all.is_empty();
            }
        }
        at.push((place, all));
    }
    let unused = asked.patterns.iter().zip(used).find(|(_, used)| !used);
    match unused {
        Some(((place, pattern), _)) => Err(format!(
            "no channel of the place {place} has a code as \"{pattern}\"\n  help: a code has 16 characters, `?` stands for one, `*` for all that follow"
        )),
        None => Ok(at),
    }
}

/// The occupant: the one that the user names, else that of the named channels, else the only one.
fn occupant(
    candidates: &[Candidate<'_>],
    asked: &Asked,
    at: &[(&'static SensorPlace, Vec<usize>)],
) -> Result<Option<String>, String> {
    let of = |index: &usize| occupant_of(candidates[*index].code).to_owned();
    let mut there: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for (place, all) in at {
        for index in all {
            let places = there.entry(of(index)).or_default();
            if !places.contains(&place.name) {
                places.push(place.name);
            }
        }
    }
    let mut named: Vec<(String, &str)> = Vec::new();
    for (_, index) in &asked.named {
        let occupant = of(index);
        if !occupant.is_empty() {
            named.push((occupant, candidates[*index].name));
        }
    }
    let list = || {
        let each = there.iter().map(|(occupant, places)| match seat(occupant) {
            "" => format!("{occupant} ({})", places.join(", ")),
            seat => format!("{occupant} ({seat}: {})", places.join(", ")),
        });
        each.collect::<Vec<_>>().join("; ")
    };
    let said = asked
        .occupant
        .as_ref()
        .map(|said| said.to_ascii_uppercase());
    let wanted = said
        .clone()
        .or_else(|| named.first().map(|(occupant, _)| occupant.clone()));
    if let Some(wanted) = wanted {
        if let Some((other, name)) = named.iter().find(|(other, _)| *other != wanted) {
            return Err(format!(
                "\"{name}\" belongs to occupant {other}, and other channels of this verdict to {wanted}\n  help: name channels of one occupant"
            ));
        }
        let is_there = there.contains_key(&wanted) || !named.is_empty();
        return match (is_there, said.is_some()) {
            (false, true) => Err(format!(
                "there is no channel of occupant {wanted}\n  help: there are those of {}",
                match there.is_empty() {
                    true => "none: no code says an occupant".to_owned(),
                    false => list(),
                }
            )),
            _ => Ok(Some(wanted)),
        };
    }
    match there.len() {
        0 => Ok(None),
        1 => Ok(there.into_keys().next()),
        _ => Err(format!(
            "there are channels of several occupants: {}\n  help: choose one by test object and position, the first two characters of the codes: {} {}",
            list(),
            asked.how,
            there.keys().next().map_or("", String::as_str)
        )),
    }
}

/// Test object and position of a channel code; "" if the text is not a channel code.
fn occupant_of(code: &str) -> &str {
    let is_code = code.len() == 16
        && code
            .bytes()
            .all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit());
    match is_code {
        true => &code[..2],
        false => "",
    }
}

/// Checks that `place` is the name of a place; the name of a part is allowed, too, if `of` is a pattern of codes.
///
/// # Errors
/// There is no such place.
pub fn known(place: &str, of: &str) -> Result<(), String> {
    let fits = |one: &SensorPlace| one.name == place || is_pattern(of) && part(one.name) == place;
    match PLACES.iter().any(fits) {
        true => Ok(()),
        false => {
            let all: Vec<&str> = PLACES.iter().map(|place| place.name).collect();
            Err(format!(
                "there is no place \"{place}\"\n  help: one of {}",
                all.join(", ")
            ))
        }
    }
}

/// The part of the dummy that a place belongs to, such as `head` for `head-x`; the channels of a part belong to one
/// sensor.
pub fn part(place: &str) -> &str {
    match place {
        "head-excursion" | "chest-deflection" | "femur-left" | "femur-right" | "knee-left"
        | "knee-right" => place,
        _ if place.starts_with("head-w") => "head-w",
        _ => match place.rsplit_once('-') {
            Some((part, _)) => part,
            None => place,
        },
    }
}

/// Number of different sensors.
fn sensors(candidates: &[Candidate<'_>], all: &[usize]) -> usize {
    let sensor = |index: &usize| candidates[*index].code.get(..12);
    let mut sensors: Vec<Option<&str>> = all.iter().map(sensor).collect();
    sensors.sort();
    sensors.dedup();
    sensors.len()
}

/// True if two of the candidates have the same code.
fn has_twins(candidates: &[Candidate<'_>], all: &[usize]) -> bool {
    let code = |index: &usize| candidates[*index].code;
    let twin = |(i, index)| all[..i].iter().any(|other| code(other) == code(index));
    all.iter().enumerate().any(twin)
}

/// True if a code matches a pattern.
fn matches(code: &str, pattern: &str) -> bool {
    let pattern = pattern.trim().to_ascii_uppercase();
    let (begin, is_long_enough) = match pattern.split_once('*') {
        Some((begin, _)) => (begin, code.len() >= begin.len()),
        None => (pattern.as_str(), code.len() == pattern.len()),
    };
    is_long_enough
        && code
            .chars()
            .zip(begin.chars())
            .all(|(a, b)| b == '?' || a == b)
}
