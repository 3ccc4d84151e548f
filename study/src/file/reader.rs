//! Reads values of a located tree and collects the problems in them.

use crate::facts::ParameterFact;
use crate::quantity::strict;
use crate::study::Varied;
use bryant_generator::description::place::At;
use bryant_generator::description::shape::{Problems, Shape};
use bryant_generator::description::tree::{Node, NodeKind};
use bryant_generator::diagnostic::{quoted, suggestion};
use bryant_generator::read::LANGUAGE;
use bryant_generator::{Diagnostic, Diagnostics};

/// Number up to which an `f64` represents every integer exactly.
const EXACT: f64 = (1u64 << 53) as f64;

/// Reads values and collects problems with them.
pub struct Reader(Problems);

impl Reader {
    /// Reads a file of this shape, whose misfits are collected.
    pub fn of<R: Shape>(root: At<'_>) -> Reader {
        let problems = Problems::new(LANGUAGE);
        R::check(root, &problems);
        Reader(problems)
    }

    /// Notes a problem, unless the shape of the same text is wrong already.
    pub fn add(&self, problem: Diagnostic) {
        if !self.0.has_at(&problem) {
            self.0.add(problem);
        }
    }

    /// True if there is no problem so far.
    pub fn is_sound(&self) -> bool {
        self.0.count() == 0
    }

    /// All problems, in the order of the text.
    pub fn problems(self) -> Diagnostics {
        let (mut problems, _) = self.0.into_parts();
        problems.sort_by_key(|p| (p.line, p.column));
        Diagnostics { problems }
    }

    /// Reports keys of a mapping that this use of it does not have.
    pub fn only(&self, at: At<'_>, what: &str, keys: &[&str]) {
        for (key, at) in entries(at) {
            if !keys.contains(&key) {
                let message = format!("{what} has no key {}", quoted(key));
                let help = suggestion(key, keys.iter().copied(), "");
                self.add(at.key_problem(message, help));
            }
        }
    }

    /// The value of a key that this use of a mapping needs.
    pub fn required<'a>(&self, at: At<'a>, key: &str, help: &str) -> Option<At<'a>> {
        let found = optional(at, key);
        if found.is_none() && at.node.get(key).is_none() {
            let message = format!("the key `{key}` is missing");
            self.add(at.problem(message, help));
        }
        found
    }

    /// A text, not empty.
    pub fn text<'a>(&self, at: At<'a>) -> Option<&'a str> {
        let text = at.node.text()?;
        if text.trim().is_empty() {
            self.add(at.problem("here stands an empty text", "write a name"));
            return None;
        }
        Some(text)
    }

    /// A quantity in SI units with the dimension of `unit`; a bare number is in `unit`.
    pub fn quantity(&self, at: At<'_>, unit: &str) -> Option<f64> {
        let NodeKind::Scalar { text, .. } = &at.node.kind else {
            let message = format!("here stands {}, but a number is needed", at.node.article());
            self.add(at.problem(
                message,
                "write a number, or one with its unit such as `10 mm`",
            ));
            return None;
        };
        match strict(text, unit) {
            Ok(value) => Some(value),
            Err(error) => {
                let error = error.to_string();
                let (message, help) = error.split_once("\n  help: ").unwrap_or((
                    error.as_str(),
                    "write a number, or one with its unit such as `10 mm`",
                ));
                self.add(at.problem(message, help));
                None
            }
        }
    }

    /// A quantity above 0.
    pub fn positive(&self, at: At<'_>, unit: &str, what: &str) -> Option<f64> {
        let value = self.quantity(at, unit)?;
        if value > 0.0 {
            return Some(value);
        }
        self.add(at.problem(
            format!("{what} is {value}"),
            format!("{what} is greater than 0"),
        ));
        None
    }

    /// An integer of at least 0, also written as `1e6`.
    pub fn whole(&self, at: At<'_>, what: &str) -> Option<u64> {
        let number = match &at.node.kind {
            NodeKind::Scalar { text, .. } => text.parse::<u64>().ok().or_else(|| {
                let float: f64 = text.parse().ok()?;
                let whole = (0.0..=EXACT).contains(&float) && float.fract() == 0.0;
                whole.then_some(float as u64)
            }),
            _ => None,
        };
        if number.is_none() {
            let float = match &at.node.kind {
                NodeKind::Scalar { text, .. } => text.parse::<f64>().ok(),
                _ => None,
            };
            let (message, help) = match float {
                Some(large) if large > EXACT => (
                    format!("{what} is too large"),
                    format!("write a number of at most {}", u64::MAX),
                ),
                _ => (
                    format!("{what} is not a whole number from 0"),
                    format!("write {what} as digits, such as `1024`"),
                ),
            };
            self.add(at.problem(message, help));
        }
        number
    }

    /// An integer of at least 1.
    pub fn count(&self, at: At<'_>, what: &str) -> Option<u64> {
        match self.whole(at, what)? {
            0 => {
                self.add(at.problem(format!("{what} is 0"), format!("{what} is at least 1")));
                None
            }
            count => Some(count),
        }
    }

    /// One of `words`; `meant` translates synonyms into one of them.
    pub fn word<'w>(
        &self,
        at: At<'_>,
        what: &str,
        words: &[&'w str],
        meant: impl Fn(&str) -> Option<&'static str>,
    ) -> Option<&'w str> {
        let text = self.text(at)?;
        let found = words.iter().find(|word| **word == text).copied();
        if found.is_none() {
            let message = format!("there is no {what} {}", quoted(text));
            let help = match meant(text) {
                Some(word) => format!("did you mean {}?", quoted(word)),
                None => suggestion(text, words.iter().copied(), ""),
            };
            self.add(at.problem(message, help));
        }
        found
    }
}

/// The entries of a mapping, with their places.
pub fn entries(at: At<'_>) -> Vec<(&str, At<'_>)> {
    match &at.node.kind {
        NodeKind::Map(entries) => {
            let keys = entries.iter().map(|entry| entry.key.as_str());
            keys.map(|key| (key, at.key(key))).collect()
        }
        _ => Vec::new(),
    }
}

/// The entries of a list.
pub fn items(at: At<'_>) -> Vec<At<'_>> {
    match &at.node.kind {
        NodeKind::List(items) => (0..items.len()).map(|i| at.item(i)).collect(),
        _ => Vec::new(),
    }
}

/// One of the words of a key.
pub fn word<W: Shape>(at: At<'_>) -> Option<W> {
    W::read(&at.node.text()?.into()).ok()
}

/// The value of a key, `None` if the key is missing.
pub fn optional<'a>(at: At<'a>, key: &str) -> Option<At<'a>> {
    at.node.get(key).filter(|node: &&Node| !node.is_null())?;
    Some(at.key(key))
}

/// A varied parameter whose values are in these nodes. It is shown in the unit of the first number that is written with
/// one.
pub fn varied<'n>(fact: &ParameterFact, values: impl IntoIterator<Item = &'n Node>) -> Varied {
    let stated = values.into_iter().find_map(|node| stated(node, &fact.unit));
    shown_in(fact, stated)
}

/// A varied parameter that is shown in `unit`, or in its SI unit if `unit` does not fit.
pub fn shown_in(fact: &ParameterFact, unit: Option<&str>) -> Varied {
    let measures = |unit: &&str| {
        !fact.unit.is_empty() && strict(&format!("1 {unit}"), &fact.unit).is_ok_and(|one| one > 0.0)
    };
    let shown = unit.filter(measures).unwrap_or(&fact.unit);
    Varied {
        name: fact.name.clone(),
        unit: fact.unit.clone(),
        shown: shown.to_owned(),
    }
}

/// The unit of the first number in a node that is written with one.
fn stated<'n>(node: &'n Node, unit: &str) -> Option<&'n str> {
    match &node.kind {
        NodeKind::Scalar { text, .. } => {
            let text = text.trim();
            let end = text.find(|c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E'))?;
            let (number, stated) = text.split_at(end);
            let plain = number.trim().parse::<f64>().is_ok();
            (plain && strict(text, unit).is_ok()).then_some(stated)
        }
        NodeKind::List(items) => items.iter().find_map(|item| self::stated(item, unit)),
        NodeKind::Map(entries) => entries
            .iter()
            .find_map(|entry| self::stated(&entry.value, unit)),
    }
}
