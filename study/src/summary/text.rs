//! The summary as text for people.

use super::index::{Estimate, Estimator, Sensitivity};
use super::{About, Summary};
use crate::table::csv::heading;
use bryant_picture::text::typeset;
use std::fmt::Write as _;

/// Significant digits of numbers.
const DIGITS: usize = 4;

/// Tables of all responses; `parameters` are the names of the varied parameters.
pub fn text(summary: &Summary, parameters: &[String]) -> String {
    let mut text = format!("{} runs", summary.runs);
    let ends: Vec<String> = summary
        .ends
        .iter()
        .map(|(word, count)| format!("{count} {word}"))
        .collect();
    let _ = writeln!(text, ": {}", ends.join(", "));
    for (reason, count) in &summary.reasons {
        let _ = writeln!(text, "  {count} because {reason}");
    }
    text.push_str(&summary.errors.text());
    text.push('\n');
    aligned(&mut text, &numbers(&summary.responses));
    for about in &summary.responses {
        let _ = writeln!(text);
        if about.count > 1 && about.minimum == about.maximum {
            let _ = writeln!(text, "{}: the same in all {} runs", about.name, about.count);
            continue;
        }
        let (title, rows) = match &about.sensitivity {
            Some(sensitivity) => (
                method(sensitivity),
                indices(sensitivity, &about.correlations, parameters),
            ),
            None => (
                "correlation with the parameters".to_owned(),
                correlations(&about.correlations, parameters),
            ),
        };
        let _ = writeln!(text, "{}: {title}", about.name);
        aligned(&mut text, &rows);
    }
    text
}

/// A table with a row for each response: its numbers of runs, its moments and quantiles.
fn numbers(responses: &[About]) -> Vec<Vec<String>> {
    let headings = [
        "response",
        "runs",
        "missing",
        "mean",
        "deviation",
        "minimum",
        "5 %",
        "median",
        "95 %",
        "maximum",
    ];
    let row = |about: &About| {
        let mut row = vec![
            heading(&about.name, &typeset(&about.unit)),
            about.count.to_string(),
            about.missing.to_string(),
        ];
        let [low, median, high] = about.quantiles;
        let numbers = [
            about.mean,
            about.deviation,
            about.minimum,
            low,
            median,
            high,
            about.maximum,
        ];
        row.extend(numbers.map(number));
        row
    };
    let mut rows = vec![headings.map(str::to_owned).to_vec()];
    rows.extend(responses.iter().map(row));
    rows
}

/// A table with a row for each parameter: its shares of the variance of a response, and its correlation with the
/// response.
fn indices(
    sensitivity: &Sensitivity,
    correlations: &[f64],
    parameters: &[String],
) -> Vec<Vec<String>> {
    let headings = ["parameter", "main", "", "total", "", "correlation"];
    let mut rows = vec![headings.map(str::to_owned).to_vec()];
    let all = parameters
        .iter()
        .zip(&sensitivity.parameters)
        .zip(correlations);
    for ((name, indices), correlation) in all {
        let [main, total] = [indices.main, indices.total];
        let row = [
            name.clone(),
            share(main.value),
            interval(main),
            share(total.value),
            interval(total),
            share(*correlation),
        ];
        rows.push(row.to_vec());
    }
    rows
}

/// A table with a row for each parameter: its correlation with a response.
fn correlations(correlations: &[f64], parameters: &[String]) -> Vec<Vec<String>> {
    let mut rows = vec![["parameter", "correlation"].map(str::to_owned).to_vec()];
    for (name, correlation) in parameters.iter().zip(correlations) {
        rows.push(vec![name.clone(), share(*correlation)]);
    }
    rows
}

/// The method of estimation of the indices, in words.
pub fn method(sensitivity: &Sensitivity) -> String {
    match sensitivity.method {
        Estimator::Groups { groups } => format!("shares of the variance, from {groups} groups"),
        Estimator::Polynomial {
            degree,
            terms,
            runs,
            explained,
        } => format!(
            "shares of the variance, from a polynomial of degree {degree} ({terms} terms, {runs} runs) that explains {:.1} %",
            100.0 * explained
        ),
    }
}

fn share(value: f64) -> String {
    if value.is_nan() {
        return "–".into();
    }
    // a number that rounds to zero has no sign
    let rounded = (value * 1000.0).round() / 1000.0 + 0.0;
    format!("{rounded:.3}")
}

fn interval(of: Estimate) -> String {
    format!("{} to {}", share(of.low), share(of.high))
}

/// A number with few digits; with an exponent instead of many zeros.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let magnitude = if value == 0.0 {
        0
    } else {
        libm::log10(value.abs()).floor() as i32
    };
    if (-4..7).contains(&magnitude) {
        let decimals = (DIGITS as i32 - 1 - magnitude).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.*e}", DIGITS - 1)
    }
}

/// Appends a table: the first column is left-aligned, the others are right-aligned.
fn aligned(text: &mut String, rows: &[Vec<String>]) {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |column: usize| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
            let _ = if column == 0 {
                write!(line, "  {cell:<width$}")
            } else {
                write!(line, "  {cell:>width$}")
            };
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
}
