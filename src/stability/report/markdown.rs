//! The page of the documentation.

use super::{cells, text};
use crate::stability::Outcome;
use std::fmt::Write as _;

/// The whole page: what it is, how it is made, a table per case.
pub fn page(outcomes: &[Outcome], command: &str) -> String {
    let mut page = format!(
        "# Hard cases\n\nSmall scenes that are hard to compute, each with the law that it must obey, and how far from the bound it \
         stays. Bounds come from theory and stand\nbeside their reason; none is fitted to what came out. The margin is the factor \
         between the bound and what was measured. Written by `{command}`; the\nsame cases run in `cargo test`.\n\n{}.\n",
        text::summary(outcomes)
    );
    let mut group = None;
    for outcome in outcomes {
        let case = &outcome.case;
        if group != Some(case.group) {
            group = Some(case.group);
            let _ = write!(page, "\n## {}\n", capital(case.group.title()));
        }
        let _ = write!(page, "\n### {}\n\n{}\n\n", capital(case.name), case.law);
        page += "| | criterion | bound | measured | margin | where the bound comes from |\n|---|---|---|---|---|---|\n";
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
                let _ = write!(page, "| {} ", cell.replace('|', "\\|").replace('\n', " "));
            }
            page += "|\n";
        }
        if let Some(trouble) = &outcome.trouble {
            let _ = write!(page, "\nBroke off: {trouble}\n");
        }
    }
    page
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}
