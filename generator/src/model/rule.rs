//! The numbers of a term, each with its key and its rule.

use super::number::Number;
pub use crate::description::rule::Rule;

/// The key of a number, relative to the key of the term that the number belongs to.
#[derive(Clone, Debug, PartialEq)]
pub enum Key {
    /// The key of the term itself.
    Itself,
    /// An entry of the list at the key.
    Item(usize),
    /// A key below that of the term: `stop` → `stop.from`.
    Below(String),
    /// A key beside that of the term: `about.x.friction` → `about.x.friction_speed`.
    Beside(String),
}

impl Key {
    /// The path of the key, given that of the term.
    pub fn path(&self, term: &str) -> String {
        match self {
            Key::Itself => term.to_owned(),
            Key::Item(index) => format!("{term}[{index}]"),
            Key::Below(key) => format!("{term}.{key}"),
            Key::Beside(key) => match term.rsplit_once('.') {
                Some((above, _)) => format!("{above}.{key}"),
                None => key.clone(),
            },
        }
    }
}

/// A number of a term, with its key and its rule.
pub struct Ruled<'a> {
    /// The rule; `None` for the rule of the term.
    pub rule: Option<Rule>,
    /// The key, relative to that of the term.
    pub key: Key,
    /// The number.
    pub number: &'a mut Number,
}

impl<'a> Ruled<'a> {
    /// The only number of a term; the term has its rule.
    pub fn of_term(number: &'a mut Number) -> Self {
        Ruled {
            rule: None,
            key: Key::Itself,
            number,
        }
    }

    /// A number at the key of the term.
    pub fn itself(rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Itself,
            number,
        }
    }

    /// An entry of the list at the key of the term.
    pub fn item(index: usize, rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Item(index),
            number,
        }
    }

    /// A number at a key below that of the term.
    pub fn below(key: impl Into<String>, rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Below(key.into()),
            number,
        }
    }

    /// A number at a key beside that of the term.
    pub fn beside(key: &str, rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Beside(key.to_owned()),
            number,
        }
    }

    /// The same number, if the key of the term moves below `key`.
    pub fn under(self, key: &str) -> Self {
        let key = match self.key {
            Key::Itself => Key::Below(key.to_owned()),
            Key::Item(index) => Key::Below(format!("{key}[{index}]")),
            below => Key::Below(below.path(key)),
        };
        Ruled { key, ..self }
    }
}
