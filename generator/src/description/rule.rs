//! Rules for the values of numbers. Constants are checked when a model is read, parameters before a run.

use serde::{Deserialize, Serialize};

/// The values that a number may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
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
    /// True if a value keeps the rule. NaN and infinities keep no rule.
    pub fn keeps(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Rule::Finite => true,
                Rule::NotZero => value != 0.0,
                Rule::NotNegative => value >= 0.0,
                Rule::Positive => value > 0.0,
            }
    }

    /// The rule in words, to follow the name of the number.
    pub fn words(self) -> &'static str {
        match self {
            Rule::Finite => "must be finite",
            Rule::NotZero => "must not be 0",
            Rule::NotNegative => "must not be negative",
            Rule::Positive => "must be positive",
        }
    }

    /// A remedy for a value that breaks the rule.
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

    /// What the reference page writes behind the unit; "" for any finite number.
    pub fn bound(self) -> &'static str {
        match self {
            Rule::Finite => "",
            Rule::NotZero => "≠ 0",
            Rule::NotNegative => "≥ 0",
            Rule::Positive => "> 0",
        }
    }
}
