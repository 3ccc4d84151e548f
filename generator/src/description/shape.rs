//! The keys of the language, declared once: as types, as a check that reports every misfit with its place, and as the
//! list that the reference page is tested against.
//!
//! `record!` makes of one declaration a struct and its [`Shape`], which first walks the located tree and reports all
//! misfits, and then reads the values. What passes the check can be read. Values are read by this trait and not by
//! serde, whose code for so many records would be a tenth of the crate.

use super::language::Language;
use super::measure::Unit;
use super::mend::Correction;
use super::place::At;
use super::rule::Rule;
use super::schema::{Schema, list_of, mapping_of, typed};
use super::slip;
use super::tree::{Entry, NodeKind, Span};
use crate::diagnostic::{Diagnostic, nearest, quoted};
pub use serde_yaml::Value;
use std::cell::{Cell, RefCell};
use std::marker::PhantomData;
use std::ops::Deref;

/// Most problems that are kept.
const MAX_PROBLEMS: usize = 1000;

/// Problems found so far.
pub struct Problems {
    /// The kinds of joints that the texts may name.
    pub language: &'static Language,
    /// The first, each once.
    kept: RefCell<Vec<Diagnostic>>,
    reported: Cell<usize>,
    /// Unknown keys, by their places, and what they were meant to be.
    corrections: RefCell<Vec<(Span, Correction)>>,
}

impl Problems {
    /// No problems yet, in texts of this language.
    pub fn new(language: &'static Language) -> Self {
        Problems {
            language,
            kept: RefCell::default(),
            reported: Cell::default(),
            corrections: RefCell::default(),
        }
    }

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

    /// An unknown key, which was meant to be another one or means nothing.
    pub fn correct(&self, key: Span, correction: Correction) {
        self.corrections.borrow_mut().push((key, correction));
    }

    /// What was reported, and what unknown keys were meant to be.
    pub fn into_parts(self) -> (Vec<Diagnostic>, Vec<(Span, Correction)>) {
        (self.kept.into_inner(), self.corrections.into_inner())
    }

    /// Those reported since there were so many.
    pub fn since(&self, kept: usize) -> Vec<Diagnostic> {
        self.kept.borrow().get(kept..).unwrap_or_default().to_vec()
    }

    /// Forgets those that `keeps` does not keep; they count as reported.
    pub fn retain(&self, keeps: impl Fn(&Diagnostic) -> bool) {
        self.kept.borrow_mut().retain(keeps);
    }

    /// How many are kept.
    pub fn kept(&self) -> usize {
        self.kept.borrow().len()
    }
}

/// What a value may look like.
pub trait Shape: Sized {
    /// True where a key may be left out.
    const OPTIONAL: bool = false;
    /// What its numbers are measured in, as the reference page writes it; "" where it has none.
    fn unit() -> String {
        String::new()
    }
    /// The values that its numbers may have.
    const RULE: Rule = Rule::Finite;
    /// Its JSON Schema; what has a name is defined in `to`.
    fn schema(to: &mut Schema) -> Value;
    /// Reports what cannot be read.
    fn check(at: At<'_>, problems: &Problems);
    /// Reads a value that passed the check.
    ///
    /// # Errors
    /// A value that would not pass the check. A key that is left out is read as [`Value::Null`].
    fn read(value: &Value) -> Result<Self, Misfit>;

    /// Adds the key of a record that has such a value; a [`Flat`] adds several.
    fn declare(
        name: &'static str,
        default: &'static str,
        meaning: &'static str,
        to: &mut Vec<Key>,
    ) {
        to.push(Key::of::<Self>(name, default, meaning));
    }

    /// Reads the value of a key of a mapping.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    fn of_key(mapping: &Value, key: &str) -> Result<Self, Misfit> {
        let value = mapping.get(key).unwrap_or(&Value::Null);
        Self::read(value).map_err(|misfit| format!("{key}: {misfit}"))
    }
}

/// A value of the shape `S` that is measured in `U`. Derefs to the value, where the unit does not matter.
#[derive(Clone, Debug, PartialEq)]
pub struct In<S, U>(S, PhantomData<U>);

impl<S, U> Deref for In<S, U> {
    type Target = S;
    fn deref(&self) -> &S {
        &self.0
    }
}

impl<S: Shape, U: Unit> Shape for In<S, U> {
    const RULE: Rule = U::RULE;

    fn unit() -> String {
        U::unit()
    }

    fn schema(to: &mut Schema) -> Value {
        let any = S::schema(to);
        to.ruled(any, U::RULE)
    }

    fn check(at: At<'_>, problems: &Problems) {
        S::check(at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        Ok(In(S::read(value)?, PhantomData))
    }
}

/// A record whose keys stand among those of another record. Derefs to it.
#[derive(Clone, Debug)]
pub struct Flat<R>(pub R);

impl<R> Deref for Flat<R> {
    type Target = R;
    fn deref(&self) -> &R {
        &self.0
    }
}

impl<R: Record> Shape for Flat<R> {
    fn schema(to: &mut Schema) -> Value {
        to.record::<R>()
    }

    fn check(at: At<'_>, problems: &Problems) {
        check_record::<R>(at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        R::among(value).map(Flat)
    }

    fn declare(_: &'static str, _: &'static str, _: &'static str, to: &mut Vec<Key>) {
        to.extend(R::keys());
    }

    fn of_key(mapping: &Value, _: &str) -> Result<Self, Misfit> {
        Self::read(mapping)
    }
}

/// Why a value cannot be read, as text.
pub type Misfit = String;

/// A key of a record.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// As written.
    pub name: &'static str,
    /// True where the key may be left out.
    pub optional: bool,
    /// What its numbers are measured in; "" where it has none.
    pub unit: fn() -> String,
    /// The values that its numbers may have.
    pub rule: Rule,
    /// What holds where the key is left out, as the reference page says it.
    pub default: &'static str,
    /// What it means: the sentence of the reference page.
    pub meaning: &'static str,
    /// Checks its value.
    pub check: fn(At<'_>, &Problems),
    /// The JSON Schema of its value.
    pub schema: fn(&mut Schema) -> Value,
}

impl Key {
    /// A key with a value of this shape. `default` says what holds where it is left out; "" for the usual.
    pub const fn of<T: Shape>(
        name: &'static str,
        default: &'static str,
        meaning: &'static str,
    ) -> Key {
        Key {
            name,
            optional: T::OPTIONAL,
            unit: T::unit,
            rule: T::RULE,
            default: match default.as_bytes() {
                [] if T::OPTIONAL => "none",
                [] => "required",
                _ => default,
            },
            meaning,
            check: T::check,
            schema: T::schema,
        }
    }
}

/// A mapping with known keys.
pub trait Record {
    /// What it is called, with its article ("an element").
    const TITLE: &'static str;
    /// Its keys, in the order of the reference page.
    fn keys() -> Vec<Key>;
    /// Reads a mapping that passed the check, and may have other keys besides.
    ///
    /// # Errors
    /// As [`Shape::read`].
    fn among(value: &Value) -> Result<Self, Misfit>
    where
        Self: Sized;
}

/// Declares a record: the struct, its [`Record`] and its [`Shape`].
#[macro_export]
#[doc(hidden)]
macro_rules! record {
    ($(#[$meta:meta])* $name:ident as $title:literal {
        $( $(#[doc = $meaning:literal])* $field:ident: $type:ty $(= $default:literal)?, )*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug)]
        pub struct $name { $( $(#[doc = $meaning])* pub $field: $type, )* }

        impl $crate::description::shape::Record for $name {
            const TITLE: &'static str = $title;
            fn keys() -> Vec<$crate::description::shape::Key> {
                let mut all = Vec::new();
                $( <$type as $crate::description::shape::Shape>::declare(
                    stringify!($field),
                    concat!($( $default )?),
                    concat!($( $meaning ),*),
                    &mut all,
                ); )*
                all
            }

            fn among(value: &$crate::description::shape::Value) -> Result<Self, $crate::description::shape::Misfit> {
                use $crate::description::shape::Shape;
                Ok($name { $( $field: <$type>::of_key(value, stringify!($field))?, )* })
            }
        }

        impl $crate::description::shape::Shape for $name {
            fn schema(to: &mut $crate::description::schema::Schema) -> $crate::description::shape::Value {
                to.record::<$name>()
            }

            fn check(at: $crate::description::place::At<'_>, problems: &$crate::description::shape::Problems) {
                $crate::description::shape::check_record::<$name>(at, problems);
            }

            fn read(value: &$crate::description::shape::Value) -> Result<Self, $crate::description::shape::Misfit> {
                use $crate::description::shape::{Record, with_keys};
                with_keys(value, Self::TITLE, &Self::keys())?;
                Self::among(value)
            }
        }
    };
}
pub use record;

/// Declares a set of words, of which one may be written: an enumeration, or the words of one that there is.
#[macro_export]
#[doc(hidden)]
macro_rules! words {
    (impl $name:ident { $( $word:ident = $text:literal, )* }) => {
        impl $name {
            /// As it is written.
            pub fn word(self) -> &'static str {
                match self { $( $name::$word => $text, )* }
            }
        }

        impl $crate::description::shape::Shape for $name {
            fn schema(_: &mut $crate::description::schema::Schema) -> $crate::description::shape::Value {
                $crate::description::schema::words(&[ $( $text, )* ])
            }

            fn check(at: $crate::description::place::At<'_>, problems: &$crate::description::shape::Problems) {
                $crate::description::shape::check_word(at, &[ $( $text, )* ], problems);
            }

            fn read(value: &$crate::description::shape::Value) -> Result<Self, $crate::description::shape::Misfit> {
                match value.as_str() {
                    $( Some($text) => Ok($name::$word), )*
                    _ => Err($crate::description::shape::misfit(value, "a word")),
                }
            }
        }
    };
    ($(#[$meta:meta])* $name:ident { $( $(#[$word_meta:meta])* $word:ident = $text:literal, )* }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $( $(#[$word_meta])* $word, )* }

        $crate::description::shape::words! { impl $name { $( $word = $text, )* } }
    };
}
pub use words;

/// The message that a value is not what is needed.
pub fn misfit(value: &Value, needed: &str) -> Misfit {
    format!("{value:?} stands where {needed} is needed")
}

/// Whether a value is a mapping with no other keys than these.
///
/// # Errors
/// If it is not.
pub fn with_keys(value: &Value, title: &str, keys: &[Key]) -> Result<(), Misfit> {
    let entries = (value.as_mapping()).ok_or_else(|| misfit(value, title))?;
    let known = |key: &Value| keys.iter().any(|known| key.as_str() == Some(known.name));
    match entries.keys().find(|key| !known(key)) {
        Some(key) => Err(misfit(key, &format!("a key of {title}"))),
        None => Ok(()),
    }
}

/// Reports unknown, missing and empty keys, and looks at the values of the others.
pub fn check_record<R: Record>(at: At<'_>, problems: &Problems) {
    check_keys(R::TITLE, &R::keys(), at, problems);
}

/// [`check_record`] of the record with this title and these keys.
pub fn check_keys(title: &str, all: &[Key], at: At<'_>, problems: &Problems) {
    let NodeKind::Map(entries) = &at.node.kind else {
        let keys: Vec<String> = all
            .iter()
            .filter(|k| !k.optional)
            .map(|k| format!("{}: …", k.name))
            .collect();
        let keys = match keys.is_empty() {
            true => all
                .iter()
                .take(1)
                .map(|k| format!("{}: …", k.name))
                .collect(),
            false => keys,
        };
        let names: Vec<&str> = all.iter().map(|k| k.name).collect();
        let meant = at
            .node
            .text()
            .and_then(|text| slip::key_meant(text, &names));
        let (message, help) = meant.map_or_else(
            || {
                (
                    format!("here stands {}, but {} has keys", at.node.article(), title),
                    format!("write `{{ {} }}`", keys.join(", ")),
                )
            },
            |meant| meant.said,
        );
        problems.add(at.problem(message, help));
        return;
    };
    let mut misspelt = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let Some(key) = all.iter().find(|k| k.name == entry.key) else {
            let before = index.checked_sub(1).map(|before| &entries[before]);
            let meant = unknown_key(title, all, at, entry, before, problems);
            misspelt.extend(meant.key.clone());
            problems.correct(entry.span, meant);
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
    for key in all.iter().filter(|k| !k.optional) {
        if at.node.get(key.name).is_none() && !misspelt.iter().any(|meant| meant == key.name) {
            problems.add(at.problem(
                format!("{} lacks the key \"{}\"", title, key.name),
                format!("add `{}: …`; see the reference of the language", key.name),
            ));
        }
    }
}

/// Reports a key that is none; what it was meant to be.
fn unknown_key(
    title: &str,
    all: &[Key],
    at: At<'_>,
    entry: &Entry,
    before: Option<&Entry>,
    problems: &Problems,
) -> Correction {
    let names: Vec<&str> = all.iter().map(|k| k.name).collect();
    // the rest of a number with a comma: `mass: 4,5 kg` in braces
    let number = before.and_then(|before| Some((&before.key, before.value.text()?)));
    if let Some((key, number)) = number
        && entry.value.is_null()
        && slip::is_decimal_comma(number, &entry.key)
    {
        problems.add(at.problem_at(
            entry.span,
            format!(
                "a comma divides `{number},{}`, which is no entry",
                entry.key
            ),
            format!(
                "the decimal sign is a point: write `{key}: {number}.{}`",
                entry.key
            ),
        ));
        return Correction::default();
    }
    if let Some(meant) =
        slip::key_meant(&entry.key, &names).filter(|m| m.value.is_none() || entry.value.is_null())
    {
        problems.add(at.problem_at(entry.span, meant.said.0, meant.said.1));
        return Correction {
            key: Some(meant.key),
            value: meant.value,
        };
    }
    let near = nearest(&entry.key, names.iter().copied());
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the keys of {title} are {}", list(all)),
    };
    problems.add(at.problem_at(
        entry.span,
        format!("{title} has no key {}", quoted(&entry.key)),
        help,
    ));
    Correction {
        key: near.map(str::to_owned),
        value: None,
    }
}

/// Reports anything but one of some words.
pub fn check_word(at: At<'_>, words: &[&str], problems: &Problems) {
    check_word_or(at, words, "", problems);
}

/// The same where something else may stand, too: `or` says what.
pub fn check_word_or(at: At<'_>, words: &[&str], or: &str, problems: &Problems) {
    let all = words
        .iter()
        .map(|w| format!("`{w}`"))
        .collect::<Vec<_>>()
        .join(", ");
    let all = match or {
        "" => all,
        or => format!("{all}; {or}"),
    };
    match &at.node.kind {
        NodeKind::Scalar { text, .. } if words.contains(&text.as_str()) => {}
        NodeKind::Scalar { text, .. } => problems.add(at.problem(
            format!("{} is none of the words that may stand here", quoted(text)),
            match (slip::in_word(text), nearest(text, words.iter().copied())) {
                (Some((message, help)), _) => format!("{message}: {help}"),
                (None, Some(near)) => format!("did you mean `{near}`? The words are {all}"),
                (None, None) => format!("the words are {all}"),
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
            NodeKind::List(_) => "a list",
            NodeKind::Map(_) => "a mapping",
            NodeKind::Scalar { .. } if self.is_null() => "nothing",
            NodeKind::Scalar { plain: true, text } if is_truth(text) => "true or false",
            NodeKind::Scalar { plain: true, text } if is_number(text) => "a number",
            NodeKind::Scalar { .. } => "a text",
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
    const RULE: Rule = T::RULE;

    fn unit() -> String {
        T::unit()
    }

    fn schema(to: &mut Schema) -> Value {
        T::schema(to)
    }

    fn check(at: At<'_>, problems: &Problems) {
        T::check(at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value {
            Value::Null => Ok(None),
            value => T::read(value).map(Some),
        }
    }
}

impl<T: Shape> Shape for Vec<T> {
    const RULE: Rule = T::RULE;

    fn unit() -> String {
        T::unit()
    }

    fn schema(to: &mut Schema) -> Value {
        list_of(T::schema(to))
    }

    fn check(at: At<'_>, problems: &Problems) {
        let NodeKind::List(items) = &at.node.kind else {
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

    fn read(value: &Value) -> Result<Self, Misfit> {
        let items = (value.as_sequence()).ok_or_else(|| misfit(value, "a list"))?;
        items.iter().map(T::read).collect()
    }
}

impl Shape for String {
    fn schema(_: &mut Schema) -> Value {
        typed("string")
    }

    fn check(at: At<'_>, problems: &Problems) {
        if at.node.article() != "a text" {
            problems.add(at.problem(
                format!("here stands {}, but a text is needed", at.node.article()),
                match at.node.kind {
                    NodeKind::Scalar { .. } => {
                        "put it in quotation marks if this is what it should be called"
                    }
                    _ => "write a word or a text in quotation marks",
                },
            ));
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        let text = value.as_str().map(str::to_owned);
        text.ok_or_else(|| misfit(value, "a text"))
    }
}

impl Shape for u32 {
    fn schema(_: &mut Schema) -> Value {
        typed("integer")
    }

    fn check(at: At<'_>, problems: &Problems) {
        let whole = match &at.node.kind {
            NodeKind::Scalar { text, .. } => text.parse::<u32>().is_ok(),
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

    fn read(value: &Value) -> Result<Self, Misfit> {
        let whole = value.as_u64().and_then(|whole| whole.try_into().ok());
        whole.ok_or_else(|| misfit(value, "a whole number"))
    }
}

impl Shape for bool {
    fn schema(_: &mut Schema) -> Value {
        typed("boolean")
    }

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

    fn read(value: &Value) -> Result<Self, Misfit> {
        let truth = value.as_bool();
        truth.ok_or_else(|| misfit(value, "true or false"))
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
    fn unit() -> String {
        T::unit()
    }

    fn schema(to: &mut Schema) -> Value {
        mapping_of(T::schema(to))
    }

    fn check(at: At<'_>, problems: &Problems) {
        let NodeKind::Map(entries) = &at.node.kind else {
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

    fn read(value: &Value) -> Result<Self, Misfit> {
        let entries =
            (value.as_mapping()).ok_or_else(|| misfit(value, "names and their values"))?;
        let entry = |(name, value): (&Value, &Value)| Ok((String::read(name)?, T::read(value)?));
        Ok(Named(
            entries.iter().map(entry).collect::<Result<_, Misfit>>()?,
        ))
    }
}
