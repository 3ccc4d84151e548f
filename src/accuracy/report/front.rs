//! The front of a study for people: the settings that no other one beats, in a terminal or as a section of a page.

use super::record::target;
use crate::accuracy::conclusion::{Conclusion, bounded_by_stability};
use crate::accuracy::point::{Known, Measure};
use crate::accuracy::setting::{time, two_digits};
use crate::accuracy::study::Study;
use crate::command::fitted;
use crate::table::{Cells, side_by_side};
use std::fmt::Write as _;

/// The table, what it says, and the sentence, in lines of at most `room` characters; the last line has no line end.
pub fn text(study: &Study, conclusion: &Conclusion, room: Option<usize>) -> String {
    let columns = columns(study, conclusion).into_iter().enumerate();
    let columns = columns.map(|(index, Column { name, unit, values })| {
        let cells = Cells::of_words(&name, unit, values);
        if index == 0 {
            cells.left_aligned()
        } else {
            cells
        }
    });
    let columns: Vec<Cells> = columns.collect();
    let text = format!(
        "{}: {} in samples of {}\nreference: {}\n\n{}\n{}\n\n{}",
        study.model,
        time(study.duration),
        time(study.every),
        study.reference.statement,
        side_by_side(&columns, room),
        notes(study).join("\n"),
        conclusion.sentence(study)
    );
    match room {
        Some(room) => fitted(&text, room),
        None => text,
    }
}

/// The section; `picture` is the link to the diagram, `command` is the command that made the study.
pub fn section(
    study: &Study,
    conclusion: &Conclusion,
    picture: Option<&str>,
    command: &str,
) -> String {
    let mut sentence = conclusion.sentence(study);
    if let Some(first) = sentence.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    let mut text = format!("## {}\n\n{sentence}.\n\n", study.model);
    if let Some(picture) = picture {
        let of = study.of.name(&study.reference.readings);
        let _ = writeln!(text, "![time of a run over the error in {of}]({picture})\n");
    }
    let _ = writeln!(
        text,
        "(`{command}`)\n\nReference: {}.\n",
        study.reference.statement
    );
    let columns = columns(study, conclusion);
    let mut row = |cells: &mut dyn Iterator<Item = String>| {
        let _ = writeln!(text, "| {} |", cells.collect::<Vec<_>>().join(" | "));
    };
    row(&mut columns.iter().map(|column| match column.unit {
        "" => column.name.clone(),
        unit => format!("{} \\[{unit}\\]", column.name),
    }));
    row(&mut (0..columns.len()).map(|i| if i == 0 { "---" } else { "---:" }.to_owned()));
    for i in 0..conclusion.front.len() {
        row(&mut columns.iter().map(|column| column.values[i].clone()));
    }
    let notes = notes(study).join("\n- ");
    let (version, engine) = (crate::VERSION, &study.engine);
    let _ = writeln!(
        text,
        "\n- {notes}\n\nbryant {version}, {engine}, {}.",
        target()
    );
    text
}

/// A column of the table.
struct Column {
    name: String,
    unit: &'static str,
    values: Vec<String>,
}

/// The columns of the front, the most important ones first.
fn columns(study: &Study, conclusion: &Conclusion) -> Vec<Column> {
    let points = conclusion.front.iter().map(|&index| &study.points[index]);
    let points: Vec<_> = points.filter_map(|p| Some((p, p.done()?))).collect();
    let mut columns: Vec<Column> = Vec::new();
    let mut add = |name: String, unit, values| columns.push(Column { name, unit, values });
    let own = &study.reference.own;
    let error = |of| {
        let values = points.iter().map(|(_, done)| known(done.error(of, own)));
        values.collect()
    };
    let number =
        |value: &dyn Fn(usize) -> f64| (0..points.len()).map(|i| digits(value(i))).collect();
    let settings = points.iter().map(|(point, _)| point.setting.name());
    add("setting".into(), "", settings.collect());
    let of = study.of.name(&study.reference.readings);
    add(format!("error in {of}"), "", error(study.of));
    let median = |i: usize| points[i].1.timing.median;
    add("time of a run".into(), "ms", number(&|i| 1e3 * median(i)));
    let evaluations = points.iter().map(|(_, done)| done.report.evaluations);
    add(
        "evaluations".into(),
        "",
        evaluations.map(|n| n.to_string()).collect(),
    );
    if study.of != Measure::State {
        add("error in the state".into(), "", error(Measure::State));
    }
    add(
        "simulated/wall".into(),
        "",
        number(&|i| points[i].1.report.t / median(i)),
    );
    columns
}

/// What the table does not say by itself.
fn notes(study: &Study) -> Vec<String> {
    let mut notes = vec![
        "no other setting is both as accurate and as fast; ≤: below the reference's own error"
            .into(),
    ];
    notes.extend(bounded_by_stability(study).into_iter().map(|(name, step, rate)| {
        format!(
            "{name}: stability, not accuracy, bounds the steps, which are {} on average: the limit of a motion of {:.0} 1/s",
            time(two_digits(step)),
            two_digits(rate)
        )
    }));
    notes.extend(
        study
            .fastest
            .iter()
            .map(|f| format!("{}; rodas5 has no such bound", f.text())),
    );
    notes
}

/// An error with two digits; with "≤" if only a bound is known.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn known(Known { error, at_most }: Known) -> String {
    format!("{}{error:.1e}", if at_most { "≤" } else { "" })
}

/// A number with about three digits.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn digits(value: f64) -> String {
    let exponent = libm::log10(value.abs().max(1e-9)).floor() as i32;
    let decimals = (2 - exponent).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}
