//! The table for a terminal.

use super::cells;
use crate::stability::Outcome;
use std::fmt::Write as _;

/// Largest width of a criterion with its variant, and of the observation of a statement, in characters.
const WIDTHS: [usize; 2] = [64, 48];

/// The table as text: groups, cases and checks, then a summary.
pub fn text(outcomes: &[Outcome], laws: bool) -> String {
    let mut text = String::new();
    let mut group = None;
    for outcome in outcomes {
        let case = &outcome.case;
        if group != Some(case.group) {
            group = Some(case.group);
            let _ = writeln!(text, "\n{}", case.group.title().to_uppercase());
        }
        let _ = writeln!(text, "\n{}", case.name);
        if laws || !outcome.holds() {
            let _ = writeln!(text, "  {}", case.law);
        }
        rows(outcome, laws, &mut text);
        if let Some(trouble) = &outcome.trouble {
            let _ = writeln!(text, "  broke off: {trouble}");
        }
    }
    text
}

fn rows(outcome: &Outcome, laws: bool, text: &mut String) {
    let rows: Vec<[String; 4]> = outcome
        .checks
        .iter()
        .map(|check| {
            let what = match check.variant.as_str() {
                "" => check.criterion.clone(),
                variant => format!("{variant}: {}", check.criterion),
            };
            [
                cut(what, WIDTHS[0]),
                cells::bound(check),
                cut(cells::measured(check), WIDTHS[1]),
                cells::margin(check),
            ]
        })
        .collect();
    let width = |column: usize| {
        let lengths = rows.iter().map(|row| row[column].chars().count());
        lengths.max().unwrap_or(0)
    };
    let widths = [0, 1, 2].map(width);
    for (row, check) in rows.iter().zip(&outcome.checks) {
        let [what, bound, measured, margin] = row;
        let [a, b, c] = widths;
        let _ = writeln!(text, "  {what:a$}  {bound:b$}  {measured:c$}  {margin}");
        if laws || !check.holds() {
            let _ = writeln!(text, "      {}", check.because);
        }
    }
}

fn cut(text: String, width: usize) -> String {
    match text.chars().count() > width {
        true => text.chars().take(width - 1).chain(['…']).collect(),
        false => text,
    }
}

/// A line such as "41 cases, 130 checks, all bounds kept", or with the number of bounds that were missed.
pub fn summary(outcomes: &[Outcome]) -> String {
    let checks = || outcomes.iter().flat_map(|outcome| &outcome.checks);
    let missed = checks().filter(|check| !check.holds()).count();
    let broken = outcomes.iter().filter(|o| o.trouble.is_some()).count();
    let mut text = format!("{} cases, {} checks: ", outcomes.len(), checks().count());
    text += &match (missed, broken) {
        (0, 0) => "every bound is kept".to_owned(),
        (missed, 0) => format!("{missed} missed their bound"),
        (missed, broken) => format!("{missed} missed their bound, {broken} cases broke off"),
    };
    text
}
