//! The page of the documentation.

use super::{cells, text};
use crate::stability::Outcome;
use std::fmt::Write as _;

/// The whole page: what it is, how it is made, a table per case.
pub fn page(outcomes: &[Outcome], command: &str) -> String {
    let mut page = format!(
        "# Hard cases\n\nThese are small scenes that are hard to compute. Each case states the law that the scene must obey, and how far the \
         result stays from its bound. Every bound comes\nfrom theory, which stands beside it; none is fitted to a result. The margin \
         is the factor between the bound and the measured value. `{command}` writes this page; the\nsame cases run in `cargo test`.\n\n{}.\n",
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
