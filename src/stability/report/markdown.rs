//! The pages of the documentation: a summary with a line for each group, and a page for each group.

use super::{cells, text};
use crate::stability::Outcome;
use bryant_hard::{Bound, Check, Found, Group};
use std::fmt::Write as _;

/// A page and its file.
pub struct Page {
    /// Name of its file, in the folder of pages, whose name is that of the summary without extension.
    pub file: String,
    /// Its text.
    pub text: String,
}

/// The summary, and the page of each group. `folder` is the path from the summary to the folder of pages; `summary` is
/// the path from these pages to the summary.
pub fn pages(
    outcomes: &[Outcome],
    command: &str,
    [folder, summary]: [&str; 2],
) -> (String, Vec<Page>) {
    let mut text = format!(
        "# Hard cases\n\nThese are small scenes that are hard to compute. Each case states the law that the scene must obey, and how far the \
         result stays from its bound. Every bound comes from theory; none is fitted to a result. The margin \
         is the factor between the bound and the measured value. `{command}` writes these pages; the same cases run in `cargo test`.\n\n{}.\n\n\
         | group | cases | checks | error that is nearest to its bound | margin |\n|---|---:|---:|---|---:|\n",
        text::summary(outcomes)
    );
    let mut groups: Vec<Group> = Vec::new();
    for outcome in outcomes {
        if groups.last() != Some(&outcome.case.group) {
            groups.push(outcome.case.group);
        }
    }
    let page = |group: &Group| {
        let of_group = outcomes
            .iter()
            .filter(|outcome| outcome.case.group == *group);
        let of_group: Vec<&Outcome> = of_group.collect();
        let file = file(*group);
        let checks = of_group
            .iter()
            .map(|outcome| outcome.checks.len())
            .sum::<usize>();
        let nearest = nearest(&of_group);
        let nearest = nearest.map(|(outcome, check)| {
            let what = format!("{}: {}", outcome.case.name, check.criterion);
            (plain(&what), cells::margin(check))
        });
        let (what, margin) = nearest.unwrap_or_default();
        let title = capital(group.title());
        let _ = writeln!(
            text,
            "| [{title}]({folder}{file}) | {} | {checks} | {what} | {margin} |",
            of_group.len()
        );
        let mut page = format!(
            "# Hard cases: {}\n\nThe [summary]({summary}) says what these pages are.\n",
            group.title()
        );
        of_group.iter().for_each(|outcome| case(&mut page, outcome));
        Page { file, text: page }
    };
    let pages = groups.iter().map(page).collect();
    (text, pages)
}

/// The name of the file of a group's page.
pub fn file(group: Group) -> String {
    format!("{}.md", group.title().to_lowercase().replace(' ', "-"))
}

/// Summary and pages as one text.
pub fn whole(outcomes: &[Outcome], command: &str) -> String {
    let (summary, pages) = pages(outcomes, command, ["", ""]);
    let pages = pages.into_iter().map(|page| page.text);
    std::iter::once(summary)
        .chain(pages)
        .collect::<Vec<_>>()
        .join("\n")
}

/// Of the checks of errors, the one with the smallest margin; a missed one if there is any.
fn nearest<'a>(outcomes: &[&'a Outcome]) -> Option<(&'a Outcome, &'a Check)> {
    let errors = outcomes.iter().flat_map(|outcome| {
        let errors = outcome.checks.iter().filter(|check| {
            let at_most = matches!(
                check.found,
                Found::Number {
                    bound: Bound::AtMost(_),
                    ..
                }
            );
            at_most || !check.holds()
        });
        errors.map(|check| (*outcome, check))
    });
    let margin = |check: &Check| match check.holds() {
        true => check.margin().unwrap_or(f64::INFINITY),
        false => 0.0,
    };
    errors.min_by(|(_, a), (_, b)| margin(a).total_cmp(&margin(b)))
}

/// Writes a case: its law, and a table of its checks.
fn case(page: &mut String, outcome: &Outcome) {
    let case = &outcome.case;
    let _ = write!(page, "\n## {}\n\n{}\n\n", capital(case.name), case.law);
    *page += "| | criterion | bound | measured | margin | where the bound comes from |\n|---|---|---:|---:|---:|---|\n";
    for check in &outcome.checks {
        let cells = [
            &check.variant,
            &check.criterion,
            &cells::bound(check),
            &cells::measured(check),
            &cells::margin(check),
            &check.because,
        ];
        for cell in cells {
            let _ = write!(page, "| {} ", plain(cell));
        }
        *page += "|\n";
    }
    if let Some(trouble) = &outcome.trouble {
        let _ = write!(page, "\nBroke off: {trouble}\n");
    }
}

/// Text as the cell of a table.
fn plain(cell: &str) -> String {
    cell.replace('|', "\\|").replace('\n', " ")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}
