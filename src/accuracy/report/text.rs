//! The table of a study: a group for each formula, a row for each point; points on the Pareto front are marked.

use crate::accuracy::conclusion::{Conclusion, bounded_by_stability};
use crate::accuracy::point::{Done, Known, Measure, Point, Status};
use crate::accuracy::setting::{Curves, Pace, Scheme, time, two_digits};
use crate::accuracy::study::Study;
use std::fmt::Write as _;

/// The mark in front of a point on the front.
const MARK: &str = "*";

/// Cells of a row; the first `WORDS` are left-aligned.
type Row = Vec<String>;

/// Number of columns with words, which are left-aligned and come before those with numbers.
const WORDS: usize = 5;

/// The study as text: head, table, and the meaning of the marks. The last line has no line end.
pub fn text(study: &Study, conclusion: &Conclusion) -> String {
    let mut text = head(study);
    let rows: Vec<(usize, Row)> = study
        .points
        .iter()
        .enumerate()
        .map(|(index, point)| (index, row(study, point, conclusion.front.contains(&index))))
        .collect();
    let [heading, units] = heading(study);
    let columns = heading.len();
    let complete = rows
        .iter()
        .map(|(_, row)| row)
        .filter(|r| r.len() == columns);
    let widths: Vec<usize> = (0..columns)
        .map(|column| {
            let cells = complete.clone().chain([&heading, &units]);
            let lengths = cells.map(|row| row[column].chars().count());
            lengths.max().unwrap_or(0)
        })
        .collect();
    for scheme in schemes(study) {
        let _ = writeln!(
            text,
            "\n{}, {}, order {}",
            scheme.name(),
            scheme.title(),
            scheme.formula.order()
        );
        line(&heading, &widths, &mut text);
        line(&units, &widths, &mut text);
        for (index, row) in &rows {
            if study.points[*index].setting.scheme() == scheme {
                line(row, &widths, &mut text);
            }
        }
    }
    let _ = write!(
        text,
        "\n{MARK} no other setting is both as accurate and as fast ({})\n≤ below the reference's own error\norder: seen between \
         this row and the one above, of the error in the state over the step, or over the tolerance",
        study.of.name(&study.reference.readings)
    );
    for (name, step, rate) in bounded_by_stability(study) {
        let _ = write!(
            text,
            "\n{name}: stability, not accuracy, bounds the steps, which are {} on average: the limit of a motion of {:.0} 1/s",
            time(two_digits(step)),
            two_digits(rate)
        );
    }
    if let Some(fastest) = &study.fastest {
        let _ = write!(text, "\n{}; rodas5 has no such bound", fastest.text());
    }
    text
}

/// The schemes of a study, in their usual order.
pub fn schemes(study: &Study) -> Vec<Scheme> {
    let there = |scheme: &Scheme| study.points.iter().any(|p| p.setting.scheme() == *scheme);
    Scheme::all().into_iter().filter(there).collect()
}

/// The subject of the study and its reference.
fn head(study: &Study) -> String {
    let mut text = format!(
        "{}: {} in samples of {}\nreference: {}\n",
        study.model,
        time(study.duration),
        time(study.every),
        study.reference.statement
    );
    if let Some(exchanged) = &study.exchanged {
        let worst = exchanged.readings.iter().copied().fold(0.0, f64::max);
        let _ = writeln!(
            text,
            "curves exchanged (cubics for straight lines): another scene, {} away in the state, {} in the worst reading; its rows are \
             measured against its own reference ({})",
            error(exchanged.state),
            error(worst),
            exchanged.reference.statement
        );
    }
    if let Some(why) = &study.not_exchanged {
        let _ = writeln!(
            text,
            "curves exchanged (cubics for straight lines): left out, {}",
            one_line(why)
        );
    }
    text
}

fn heading(study: &Study) -> [Row; 2] {
    let of = match study.of {
        // the state has a column of its own
        Measure::State | Measure::Worst => "worst reading".to_owned(),
        other => other.name(&study.reference.readings),
    };
    let columns = [
        ("", ""),
        ("step or", "tolerance"),
        ("scalar", ""),
        ("kinks", ""),
        ("curves", ""),
        ("error in", "the state"),
        ("order", "of it"),
        ("error in", &of),
        ("energy", "gap"),
        ("evaluations", ""),
        ("operations", "[10³]"),
        ("median", "[ms]"),
        ("95 %", "[ms]"),
        ("simulated", "/wall"),
    ];
    [
        columns.iter().map(|c| c.0.to_owned()).collect(),
        columns.iter().map(|c| c.1.to_owned()).collect(),
    ]
}

fn row(study: &Study, point: &Point, front: bool) -> Row {
    let setting = &point.setting;
    let mut row = vec![
        if front { MARK } else { "" }.to_owned(),
        match setting.pace {
            Pace::Step(step) => time(step),
            Pace::Tolerance(tolerance) => format!("{tolerance:e}"),
        },
        setting.scalar.name().to_owned(),
        setting.kinks().to_owned(),
        match setting.curves {
            Curves::Written => String::new(),
            Curves::Exchanged => "exchanged".to_owned(),
        },
    ];
    match &point.status {
        Status::Done(done) => row.extend(numbers(study, point, done)),
        Status::Failed(reason) => row.push(format!("failed: {}", one_line(reason))),
        Status::Skipped(reason) => row.push(format!("skipped: {}", one_line(reason))),
    }
    row
}

fn numbers(study: &Study, point: &Point, done: &Done) -> Row {
    let own = study.own(point.setting.curves);
    let of = match study.of {
        Measure::State => Measure::Worst,
        other => other,
    };
    let wall = done.timing.median;
    vec![
        known(done.error(Measure::State, own)),
        done.order.map_or("-".into(), order),
        known(done.error(of, own)),
        done.energy.map_or("-".into(), error),
        done.report.evaluations.to_string(),
        digits(done.operations as f64 / 1e3),
        digits(1e3 * wall),
        digits(1e3 * done.timing.late),
        digits(done.report.t / wall),
    ]
}

/// The first line of a text.
pub fn one_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim().to_owned()
}

/// An order with one decimal; zero has no sign.
fn order(value: f64) -> String {
    format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0)
}

/// An error with two digits.
pub fn error(value: f64) -> String {
    format!("{value:.1e}")
}

/// An error; with "≤" if only a bound is known.
pub fn known(known: Known) -> String {
    let bound = if known.at_most { "≤" } else { "" };
    format!("{bound}{}", error(known.error))
}

/// A number with about three digits.
pub fn digits(value: f64) -> String {
    if !value.is_finite() {
        return "-".into();
    }
    let exponent = libm::log10(value.abs().max(1e-9)).floor() as i32;
    let decimals = (2 - exponent).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

/// Appends a line of cells. A row with fewer cells ends in words, which may be long.
fn line(row: &Row, widths: &[usize], text: &mut String) {
    let whole = row.len() == widths.len();
    let mut line = String::new();
    for (column, (cell, width)) in row.iter().zip(widths).enumerate() {
        let gap = if column == 0 { 0 } else { 2 };
        // the width is in characters, not bytes
        let _ = match column < WORDS || !whole {
            true => write!(line, "{:gap$}{cell:<width$}", ""),
            false => write!(line, "{:gap$}{cell:>width$}", ""),
        };
    }
    text.push_str(line.trim_end());
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(digits(0.21456), "0.215");
        assert_eq!(digits(21.456), "21.5");
        assert_eq!(digits(2145.6), "2146");
        assert_eq!(digits(f64::INFINITY), "-");
        assert_eq!((order(-0.04), order(3.96)), ("0.0".into(), "4.0".into()));
        let below = Known {
            error: 1.23e-10,
            at_most: true,
        };
        assert_eq!(known(below), "≤1.2e-10");
    }

    #[test]
    fn numbers_are_right_aligned_and_words_left() {
        let widths = [1, 6, 3, 3, 3, 8];
        let cells = |row: &[&str]| row.iter().map(|c| c.to_string()).collect::<Row>();
        let mut text = String::new();
        line(
            &cells(&["*", "1e-3", "f64", "a", "", "1.5"]),
            &widths,
            &mut text,
        );
        line(&cells(&["", "1e-3", "f64", "a", ""]), &widths, &mut text);
        assert_eq!(
            text,
            "*  1e-3    f64  a              1.5\n   1e-3    f64  a\n"
        );
    }
}
