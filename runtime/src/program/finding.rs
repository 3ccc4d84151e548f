//! Reasons not to trust a run that went on, in words.

use crate::Real;
use crate::simulate::{Diagnostic, OutOfRange, Watch};

/// A reason not to trust a run that went on: [`Diagnostic`] in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Time since which it holds \[s\].
    pub since: f64,
    /// A word for programs: that of [`Diagnostic::kind`], or "singular".
    pub kind: String,
    /// Its size: the step over the largest stable one, the argument of a curve, or the missing share.
    pub amount: f64,
    /// The coordinate or velocity concerned; "" where there is none.
    pub coordinate: String,
    /// The whole sentence.
    pub message: String,
    /// The remedy.
    pub remedy: String,
    /// True if it holds at every accuracy: [`Problem::lasts`](crate::simulate::Problem::lasts).
    pub lasts: bool,
}

impl From<Diagnostic<'_>> for Finding {
    fn from(diagnostic: Diagnostic<'_>) -> Self {
        Finding {
            since: diagnostic.t,
            kind: diagnostic.kind().into(),
            amount: diagnostic.amount(),
            coordinate: diagnostic.coordinate().unwrap_or_default().into(),
            message: diagnostic.to_string(),
            remedy: diagnostic.remedy().into(),
            lasts: diagnostic.problem.lasts(),
        }
    }
}

/// Curves of the state that were left, but not so far that their values are made up: a sentence for each.
pub(super) fn notes<T: Real>(watch: &Watch<'_, T>) -> Vec<String> {
    let info = watch.info();
    let harmless = watch.left().filter(|left| !left.made_up(info));
    harmless
        .filter_map(|left| {
            let curve = info.curves.get(left.curve)?;
            let beyond = OutOfRange {
                curve,
                argument: left.argument,
            };
            Some(format!(
                "since t = {} {beyond}",
                crate::simulate::Time(left.since)
            ))
        })
        .collect()
}
