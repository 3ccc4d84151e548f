//! The keys of the language, declared once: as serde types, as a check that reports every misfit with its place, and as
//! the list that the reference page is tested against.
//!
//! serde stops at the first misfit and cannot always say where it stands. So `record!` makes of one declaration the
//! struct that serde reads and a [`Shape`] that walks the located tree first. What passes the check, serde reads.

use super::place::At;
use super::tree::Kind;
use crate::diagnostic::{Diagnostic, Diagnostics, nearest, quoted};
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use std::cell::{Cell, RefCell};
use std::fmt;
use std::marker::PhantomData;

/// Most problems that are kept.
const MAX_PROBLEMS: usize = 1000;

/// Problems found so far.
#[derive(Debug, Default)]
pub struct Problems {
    /// The first, each once.
    kept: RefCell<Vec<Diagnostic>>,
    reported: Cell<usize>,
}

impl Problems {
    /// One more; kept unless it is known already, or there are too many.
    pub fn add(&self, problem: Diagnostic) {
        self.reported.set(self.reported.get() + 1);
        let mut problems = self.kept.borrow_mut();
        if problems.len() < MAX_PROBLEMS && !problems.contains(&problem) {
            problems.push(problem);
        }
    }

    /// Whether something is reported of the text that this problem is with, or of a part of it.
    pub fn has_at(&self, problem: &Diagnostic) -> bool {
        let meets = |a: &Diagnostic, b: &Diagnostic| {
            a.column < b.column + b.length && b.column < a.column + a.length
        };
        let kept = self.kept.borrow();
        let mut same = kept
            .iter()
            .filter(|known| known.file == problem.file && known.line == problem.line);
        same.any(|known| meets(known, problem))
    }

    /// How many were reported, kept or not: where this stands still nothing is wrong.
    pub fn count(&self) -> usize {
        self.reported.get()
    }

    /// `value` where there is no problem.
    pub fn into_result<T>(self, value: Option<T>) -> Result<T, Diagnostics> {
        let problems = self.kept.into_inner();
        match value {
            Some(value) if problems.is_empty() => Ok(value),
            _ => Err(Diagnostics { problems }),
        }
    }
}

/// What a value may look like.
pub trait Shape {
    /// True where a key may be left out.
    const OPTIONAL: bool = false;
    /// Reports what serde would not read.
    fn check(at: At<'_>, problems: &Problems);
}

/// A key of a record.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// As written.
    pub name: &'static str,
    /// True where the key may be left out.
    pub optional: bool,
    /// Checks its value.
    pub check: fn(At<'_>, &Problems),
}

/// A mapping with known keys.
pub trait Record {
    /// What it is called, with its article ("an element").
    const TITLE: &'static str;
    /// Its keys, in the order of the reference page.
    const KEYS: &'static [Key];
}

/// Declares a record: the struct for serde, its [`Record`] and its [`Shape`].
macro_rules! record {
    ($(#[$meta:meta])* $name:ident as $title:literal { $( $(#[$field_meta:meta])* $field:ident: $type:ty, )* }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name { $( $(#[$field_meta])* pub $field: $type, )* }

        impl $crate::description::shape::Record for $name {
            const TITLE: &'static str = $title;
            const KEYS: &'static [$crate::description::shape::Key] = &[ $( $crate::description::shape::Key {
                name: stringify!($field),
                optional: <$type as $crate::description::shape::Shape>::OPTIONAL,
                check: <$type as $crate::description::shape::Shape>::check,
            }, )* ];
        }

        impl $crate::description::shape::Shape for $name {
            fn check(at: $crate::description::place::At<'_>, problems: &$crate::description::shape::Problems) {
                $crate::description::shape::check_record::<$name>(at, problems);
            }
        }
    };
}
pub(crate) use record;

/// Declares a set of words, of which one may be written.
macro_rules! words {
    ($(#[$meta:meta])* $name:ident { $( $(#[$word_meta:meta])* $word:ident = $text:literal, )* }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
        pub enum $name { $( $(#[$word_meta])* #[serde(rename = $text)] $word, )* }

        impl $crate::description::shape::Shape for $name {
            fn check(at: $crate::description::place::At<'_>, problems: &$crate::description::shape::Problems) {
                $crate::description::shape::check_word(at, &[ $( $text, )* ], problems);
            }
        }
    };
}
pub(crate) use words;

/// Reports unknown, missing and empty keys, and looks at the values of the others.
pub fn check_record<R: Record>(at: At<'_>, problems: &Problems) {
    let Kind::Map(entries) = &at.node.kind else {
        let keys: Vec<String> = R::KEYS
            .iter()
            .filter(|k| !k.optional)
            .map(|k| format!("{}: …", k.name))
            .collect();
        let keys = match keys.is_empty() {
            true => R::KEYS
                .iter()
                .take(1)
                .map(|k| format!("{}: …", k.name))
                .collect(),
            false => keys,
        };
        problems.add(at.problem(
            format!(
                "here stands {}, but {} has keys",
                at.node.article(),
                R::TITLE
            ),
            format!("write `{{ {} }}`", keys.join(", ")),
        ));
        return;
    };
    let mut misspelt = Vec::new();
    for entry in entries {
        let Some(key) = R::KEYS.iter().find(|k| k.name == entry.key) else {
            let help = match nearest(&entry.key, R::KEYS.iter().map(|k| k.name)) {
                Some(near) => {
                    misspelt.push(near);
                    format!("did you mean `{near}`?")
                }
                None => format!("the keys of {} are {}", R::TITLE, list(R::KEYS)),
            };
            problems.add(at.problem_at(
                entry.span,
                format!("{} has no key {}", R::TITLE, quoted(&entry.key)),
                help,
            ));
            continue;
        };
        if entry.value.is_null() {
            problems.add(at.problem_at(
                entry.span,
                format!("the key {} has no value", quoted(&entry.key)),
                "write the value behind the colon, or remove the key",
            ));
        } else {
            (key.check)(at.key(&entry.key), problems);
        }
    }
    for key in R::KEYS.iter().filter(|k| !k.optional) {
        if at.node.get(key.name).is_none() && !misspelt.contains(&key.name) {
            problems.add(at.problem(
                format!("{} lacks the key \"{}\"", R::TITLE, key.name),
                format!("add `{}: …`; see the reference of the language", key.name),
            ));
        }
    }
}

/// Reports anything but one of some words.
pub fn check_word(at: At<'_>, words: &[&str], problems: &Problems) {
    let all = words
        .iter()
        .map(|w| format!("`{w}`"))
        .collect::<Vec<_>>()
        .join(", ");
    match &at.node.kind {
        Kind::Scalar { text, .. } if words.contains(&text.as_str()) => {}
        Kind::Scalar { text, .. } => problems.add(at.problem(
            format!("{} is none of the words that may stand here", quoted(text)),
            match nearest(text, words.iter().copied()) {
                Some(near) => format!("did you mean `{near}`? The words are {all}"),
                None => format!("the words are {all}"),
            },
        )),
        _ => problems.add(at.problem(
            format!("here stands {}, but a word is needed", at.node.article()),
            format!("the words are {all}"),
        )),
    }
}

fn list(keys: &[Key]) -> String {
    keys.iter()
        .map(|k| format!("`{}`", k.name))
        .collect::<Vec<_>>()
        .join(", ")
}

impl super::tree::Node {
    /// What it is, with an article, for messages.
    pub fn article(&self) -> &'static str {
        match &self.kind {
            Kind::List(_) => "a list",
            Kind::Map(_) => "a mapping",
            Kind::Scalar { .. } if self.is_null() => "nothing",
            Kind::Scalar { plain: true, text } if is_truth(text) => "true or false",
            Kind::Scalar { plain: true, text } if is_number(text) => "a number",
            Kind::Scalar { .. } => "a text",
        }
    }
}

fn is_truth(text: &str) -> bool {
    matches!(text, "true" | "True" | "TRUE" | "false" | "False" | "FALSE")
}

/// True for what YAML reads as a number.
fn is_number(text: &str) -> bool {
    serde_yaml::from_str::<serde_yaml::Value>(text).is_ok_and(|v| v.is_number())
}

impl<T: Shape> Shape for Option<T> {
    const OPTIONAL: bool = true;
    fn check(at: At<'_>, problems: &Problems) {
        T::check(at, problems);
    }
}

impl<T: Shape> Shape for Vec<T> {
    fn check(at: At<'_>, problems: &Problems) {
        let Kind::List(items) = &at.node.kind else {
            problems.add(at.problem(
                format!("here stands {}, but a list is needed", at.node.article()),
                "write `[a, b]`, or one entry per line, each begun with `- `",
            ));
            return;
        };
        for index in 0..items.len() {
            T::check(at.item(index), problems);
        }
    }
}

impl Shape for String {
    fn check(at: At<'_>, problems: &Problems) {
        if at.node.article() != "a text" {
            problems.add(at.problem(
                format!("here stands {}, but a text is needed", at.node.article()),
                match at.node.kind {
                    Kind::Scalar { .. } => {
                        "put it in quotation marks if this is what it should be called"
                    }
                    _ => "write a word or a text in quotation marks",
                },
            ));
        }
    }
}

impl Shape for u32 {
    fn check(at: At<'_>, problems: &Problems) {
        let whole = match &at.node.kind {
            Kind::Scalar { text, .. } => text.parse::<u32>().is_ok(),
            _ => false,
        };
        if !whole {
            problems.add(at.problem(
                format!(
                    "here stands {}, but a whole number is needed",
                    at.node.article()
                ),
                "write a number such as 1 or 2",
            ));
        }
    }
}

impl Shape for bool {
    fn check(at: At<'_>, problems: &Problems) {
        if at.node.article() != "true or false" {
            problems.add(at.problem(
                format!(
                    "here stands {}, but true or false is needed",
                    at.node.article()
                ),
                "write `true` or `false`",
            ));
        }
    }
}

/// A mapping whose keys are names of the user's, in the order of the text.
#[derive(Clone, Debug)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Named(Vec::new())
    }
}

impl<T: Shape> Shape for Named<T> {
    fn check(at: At<'_>, problems: &Problems) {
        let Kind::Map(entries) = &at.node.kind else {
            problems.add(at.problem(
                format!(
                    "here stands {}, but names and their values are needed",
                    at.node.article()
                ),
                "write one `name: value` per line",
            ));
            return;
        };
        for entry in entries {
            if entry.value.is_null() {
                problems.add(at.problem_at(
                    entry.span,
                    format!("{} has no value", quoted(&entry.key)),
                    "write the value behind the colon, or remove the line",
                ));
            } else {
                T::check(at.key(&entry.key), problems);
            }
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Named<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("names and their values")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Named(entries))
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}
