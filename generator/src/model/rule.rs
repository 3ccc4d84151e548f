//! What a number may be: the one classification of all numbers of all laws, by which constants are refused when a model is read and
//! parameters before a run.

use super::Number;

/// What a number may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// Any finite number.
    Finite,
    /// Finite, and not 0.
    NotZero,
    /// Finite, and 0 or more.
    NotNegative,
    /// Finite, and more than 0.
    Positive,
}

impl Rule {
    /// Whether a value keeps it. What is no number, or infinite, keeps none.
    pub fn keeps(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Rule::Finite => true,
                Rule::NotZero => value != 0.0,
                Rule::NotNegative => value >= 0.0,
                Rule::Positive => value > 0.0,
            }
    }

    /// What a number must do that is to keep it, in words.
    pub fn words(self) -> &'static str {
        match self {
            Rule::Finite => "must be finite",
            Rule::NotZero => "must not be 0",
            Rule::NotNegative => "must not be negative",
            Rule::Positive => "must be positive",
        }
    }

    /// A remedy.
    pub fn help(self) -> &'static str {
        match self {
            Rule::Finite => {
                "look for a division by zero, the root of a negative number, or numbers beyond all measure"
            }
            Rule::NotZero => "give a number that is not 0, or leave out what it makes nothing of",
            Rule::NotNegative => "give 0 or a positive number; the law itself provides the sign",
            Rule::Positive => "give a positive number",
        }
    }
}

/// Where a number stands, seen from the key of the term that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub enum Key {
    /// It is what the key says.
    Itself,
    /// An entry of the list that the key says.
    Item(usize),
    /// Below the key: `stop` → `stop.from`.
    Below(String),
    /// Beside the key: `about.x.friction` → `about.x.friction_speed`.
    Beside(String),
}

impl Key {
    /// Its path, given that of the term.
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

/// A number of a term: where it stands, and what it may be.
pub struct Ruled<'a> {
    /// What it may be; none where the term says it.
    pub rule: Option<Rule>,
    /// Where it stands.
    pub key: Key,
    /// The number.
    pub number: &'a mut Number,
}

impl<'a> Ruled<'a> {
    /// The number of a term that has no other: the term says what it may be.
    pub fn of_term(number: &'a mut Number) -> Self {
        Ruled {
            rule: None,
            key: Key::Itself,
            number,
        }
    }

    /// What the key of the term says.
    pub fn itself(rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Itself,
            number,
        }
    }

    /// An entry of the list that the key of the term says.
    pub fn item(index: usize, rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Item(index),
            number,
        }
    }

    /// Below the key of the term.
    pub fn below(key: impl Into<String>, rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Below(key.into()),
            number,
        }
    }

    /// Beside the key of the term.
    pub fn beside(key: &str, rule: Rule, number: &'a mut Number) -> Self {
        Ruled {
            rule: Some(rule),
            key: Key::Beside(key.to_owned()),
            number,
        }
    }

    /// The same, the term's key being below another.
    pub fn under(self, key: &str) -> Self {
        let key = match self.key {
            Key::Itself => Key::Below(key.to_owned()),
            Key::Item(index) => Key::Below(format!("{key}[{index}]")),
            below => Key::Below(below.path(key)),
        };
        Ruled { key, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::{Key, Rule};

    #[test]
    fn what_is_not_finite_keeps_no_rule() {
        let rules = [
            Rule::Finite,
            Rule::NotZero,
            Rule::NotNegative,
            Rule::Positive,
        ];
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(rules.map(|rule| rule.keeps(value)), [false; 4]);
        }
        assert_eq!(
            rules.map(|rule| rule.keeps(-1.0)),
            [true, true, false, false]
        );
        assert_eq!(
            rules.map(|rule| rule.keeps(-0.0)),
            [true, false, true, false]
        );
        assert_eq!(rules.map(|rule| rule.keeps(5e-324)), [true; 4]);
    }

    #[test]
    fn a_number_is_found_from_its_term() {
        let beside = Key::Beside("friction_speed".into());
        assert_eq!(beside.path("about.x.friction"), "about.x.friction_speed");
        assert_eq!(beside.path("friction"), "friction_speed");
        assert_eq!(Key::Below("from".into()).path("stop"), "stop.from");
        assert_eq!(Key::Item(1).path("plane.extent"), "plane.extent[1]");
    }
}
