//! A study as a section of a page: its conclusion, its diagram, its front.

use super::text::{digits, error, known};
use crate::accuracy::conclusion::Conclusion;
use crate::accuracy::point::{Measure, Status};
use crate::accuracy::study::Study;
use std::fmt::Write as _;

/// The section; `picture` is the link to the diagram, `command` is the command that made the study.
pub fn section(
    study: &Study,
    conclusion: &Conclusion,
    picture: Option<&str>,
    command: &str,
) -> String {
    let readings = &study.reference.readings;
    let of = study.of.name(readings);
    let mut text = format!("## {}\n\n", study.model);
    let mut sentence = conclusion.sentence(study);
    if let Some(first) = sentence.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    let _ = writeln!(text, "{sentence}.\n");
    if let Some(picture) = picture {
        let _ = writeln!(text, "![time of a run over the error in {of}]({picture})\n");
    }
    let _ = writeln!(
        text,
        "(`{command}`)\n\nReference: {}.",
        study.reference.statement
    );
    if let Some(exchanged) = &study.exchanged {
        let worst = exchanged.readings.iter().copied().fold(0.0, f64::max);
        let _ = writeln!(
            text,
            "With cubic curves in the place of linear ones, and the reverse, the scene itself is another one: it differs by {} in the \
             state, and by {} in the worst reading.",
            error(exchanged.state),
            error(worst)
        );
    }
    if let Some(why) = &study.not_exchanged {
        let _ = writeln!(
            text,
            "The scene with cubic curves in the place of linear ones, and the reverse, is left out: {}.",
            why.lines().next().unwrap_or_default()
        );
    }
    front(&mut text, study, conclusion);
    let count = |of: fn(&Status) -> bool| study.points.iter().filter(|p| of(&p.status)).count();
    let failed = count(|status| matches!(status, Status::Failed(_)));
    let skipped = count(|status| matches!(status, Status::Skipped(_)));
    let environment = &study.environment;
    let _ = writeln!(
        text,
        "\nOf {} settings {failed} failed and {skipped} were skipped as too slow. bryant {} ({}), {}, {}.",
        study.points.len(),
        environment.version,
        environment.commit,
        environment.engine,
        environment.target
    );
    text
}

/// Appends the table of the settings on the front.
fn front(text: &mut String, study: &Study, conclusion: &Conclusion) {
    let of = study.of.name(&study.reference.readings);
    // the error of the state has a column, unless it is the error that the study is about
    let state = !matches!(study.of, Measure::State);
    let (heading, rule) = match state {
        true => (" error in the state |", "---:|"),
        false => ("", ""),
    };
    let _ = writeln!(
        text,
        "\nSettings for which no other setting is better in both error and time:\n\n\
         | setting | error in {of} |{heading} evaluations | time of a run \\[ms\\] | simulated/wall |\n\
         |---|---:|{rule}---:|---:|---:|"
    );
    let own = &study.reference.own;
    for &index in &conclusion.front {
        let point = &study.points[index];
        let Some(done) = point.done() else { continue };
        let beside = match state {
            true => format!(" {} |", known(done.error(Measure::State, own))),
            false => String::new(),
        };
        let _ = writeln!(
            text,
            "| {} | {} |{beside} {} | {} | {} |",
            point.setting.name(),
            known(done.error(study.of, own)),
            done.report.evaluations,
            digits(1e3 * done.timing.median),
            digits(done.report.t / done.timing.median),
        );
    }
}
