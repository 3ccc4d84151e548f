//! A case and its results.

use crate::bench::{Bench, Trouble};

/// A hard case: its scene is difficult, and its law says what must hold.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The kind of difficulty.
    pub group: Group,
    /// A short name of the difficulty, unique among all cases ("ten contacts at once").
    pub name: &'static str,
    /// The law that must hold, in a sentence, with the source of its formula.
    pub law: &'static str,
    /// Runs scenes, and records checks on the bench.
    pub run: fn(&mut Bench<'_>) -> Result<(), Trouble>,
}

/// Kinds of difficulties, in the order of the table.
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
    /// Long chains, long runs.
    Length,
    /// Input that is not a model, NaN and infinite numbers.
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

    /// The heading of the group.
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

/// One result of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The variant of scene or settings ("dopri5 at 1e-9", "100 elements"); empty if there is only one.
    pub variant: String,
    /// The measured quantity ("energy gained over energy exchanged").
    pub criterion: String,
    /// The source of the bound ("2 × steps × tolerance").
    pub because: String,
    /// The measured result.
    pub found: Found,
}

/// A number and its bound, or a statement that must hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// A number.
    Number {
        /// The measured value.
        measured: f64,
        /// The bound that it must keep.
        bound: Bound,
        /// Unit of both; "" for a pure number.
        unit: &'static str,
    },
    /// A statement.
    Statement {
        /// True if the statement holds.
        holds: bool,
        /// What was observed ("refused: …").
        seen: String,
    },
}

/// The bound of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The number must be at most this.
    AtMost(f64),
    /// The number must be at least this.
    AtLeast(f64),
}

impl Check {
    /// True if the bound is kept, or the statement holds; NaN keeps no bound.
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

    /// The margin to the bound as a factor, above 1 if the bound is kept; `None` for a statement.
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
