//! A case, and what comes out of it.

use crate::bench::{Bench, Trouble};

/// A hard case: what makes it hard is in its scene, what it must obey in its law.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What kind of hardness.
    pub group: Group,
    /// A few words, unique among all cases: what is hard ("ten contacts at once").
    pub name: &'static str,
    /// What must hold, in a sentence, with the source of its formula.
    pub law: &'static str,
    /// Measures, and adds checks to the bench.
    pub run: fn(&mut Bench<'_>) -> Result<(), Trouble>,
}

/// Kinds of hardness, in the order of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Group {
    /// Angles at their poles, tumbling, fast spin.
    Orientation,
    /// Ratios of masses, moments that vanish, joints that coincide.
    MassAndShape,
    /// Stops and contacts far stiffer than the rest.
    Stiffness,
    /// Friction that holds, contacts that close and open.
    NonSmoothness,
    /// Units, origin, order, precision.
    ScaleAndPrecision,
    /// Long chains, many steps.
    Length,
    /// Input that is no model, numbers that are none.
    Garbage,
    /// Runs that cannot be trusted.
    BlowUp,
}

impl Group {
    /// Every group.
    pub const ALL: [Group; 8] = [
        Group::Orientation,
        Group::MassAndShape,
        Group::Stiffness,
        Group::NonSmoothness,
        Group::ScaleAndPrecision,
        Group::Length,
        Group::Garbage,
        Group::BlowUp,
    ];

    /// As headings have it.
    pub const fn title(self) -> &'static str {
        match self {
            Group::Orientation => "orientation",
            Group::MassAndShape => "mass and shape",
            Group::Stiffness => "stiffness",
            Group::NonSmoothness => "non-smoothness",
            Group::ScaleAndPrecision => "scale and precision",
            Group::Length => "length",
            Group::Garbage => "garbage",
            Group::BlowUp => "blow-up",
        }
    }
}

/// One thing that a case found.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Which member of a family of scenes or settings ("dopri5 at 1e-9", "100 elements"); empty where there is one.
    pub variant: String,
    /// What is measured ("energy gained over energy exchanged").
    pub criterion: String,
    /// Where the bound comes from ("2 × steps × tolerance").
    pub because: String,
    /// What was found.
    pub found: Found,
}

/// A number and its bound, or a statement that must hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// A number.
    Number {
        /// What came out.
        measured: f64,
        /// What it must keep to.
        bound: Bound,
        /// Of both; "" for a pure number.
        unit: &'static str,
    },
    /// A statement.
    Statement {
        /// Whether it holds.
        holds: bool,
        /// What was seen ("refused: …").
        seen: String,
    },
}

/// What a number must keep to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// No more than this.
    AtMost(f64),
    /// No less than this.
    AtLeast(f64),
}

impl Check {
    /// Whether the bound is kept: a measured value that is not a number keeps none.
    pub fn holds(&self) -> bool {
        match &self.found {
            Found::Number {
                measured, bound, ..
            } => match bound {
                Bound::AtMost(bound) => *measured <= *bound,
                Bound::AtLeast(bound) => *measured >= *bound,
            },
            Found::Statement { holds, .. } => *holds,
        }
    }

    /// How far from the bound, as a factor: above 1 on the good side; `None` of a statement.
    pub fn margin(&self) -> Option<f64> {
        match self.found {
            Found::Number {
                measured, bound, ..
            } => Some(match bound {
                Bound::AtMost(bound) if measured == bound => 1.0,
                Bound::AtMost(bound) => bound / measured,
                Bound::AtLeast(bound) if measured == bound => 1.0,
                Bound::AtLeast(bound) => measured / bound,
            }),
            Found::Statement { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(measured: f64, bound: Bound) -> Check {
        Check {
            variant: String::new(),
            criterion: String::new(),
            because: String::new(),
            found: Found::Number {
                measured,
                bound,
                unit: "",
            },
        }
    }

    #[test]
    fn bounds_have_two_sides_and_nan_keeps_none() {
        assert!(number(1.0, Bound::AtMost(2.0)).holds());
        assert!(!number(3.0, Bound::AtMost(2.0)).holds());
        assert!(number(3.0, Bound::AtLeast(2.0)).holds());
        assert!(!number(1.0, Bound::AtLeast(2.0)).holds());
        for bound in [Bound::AtMost(2.0), Bound::AtLeast(2.0)] {
            assert!(!number(f64::NAN, bound).holds());
        }
        assert_eq!(number(1.0, Bound::AtMost(2.0)).margin(), Some(2.0));
        assert_eq!(number(6.0, Bound::AtLeast(2.0)).margin(), Some(3.0));
        assert_eq!(number(0.0, Bound::AtMost(0.0)).margin(), Some(1.0));
    }
}
