//! Tables of what the methods of a module cost, for the comment at its top.

use super::header::line;
use super::method::Function;
use crate::equations::{Equations, Route};
use crate::expression::count::Count;
use crate::names::plain;

/// Adds tables to the header: the operations of each method by kind and by section.
pub(crate) fn tables(text: &mut String, equations: &Equations, functions: &[Function]) {
    let route = match equations.route {
        Route::Elimination => "elimination from the leaves to the root",
        Route::MassMatrix => "the factorised mass matrix",
    };
    line(text, format!("Accelerations by {route}."));
    let functions: Vec<&Function> = functions
        .iter()
        .filter(|function| !function.operations.total.is_empty())
        .collect();
    if functions.is_empty() {
        return;
    }
    line(text, "");
    line(
        text,
        "Operations (a fused multiply-add counts two) and, apart from them, signs, trigonometry and calls:",
    );
    let rows: Vec<(String, &Count)> = functions
        .iter()
        .map(|function| (function.name.to_string(), &function.operations.total))
        .collect();
    let columns: Vec<OperationCounter> = KINDS
        .iter()
        .copied()
        .filter(|(_, of)| rows.iter().any(|(_, count)| of(count) > 0))
        .collect();
    let kinds = rows.iter().map(|(name, count)| {
        (
            name.clone(),
            columns.iter().map(|(_, of)| of(count)).collect(),
        )
    });
    table(
        text,
        "method",
        columns.iter().map(|(name, _)| *name),
        kinds.collect(),
    );
    line(text, "");
    line(text, "Operations by section:");
    let mut sections: Vec<(String, Vec<usize>)> = Vec::new();
    for (i, function) in functions.iter().enumerate() {
        for (section, count) in &function.operations.rows {
            let section = if section.is_empty() {
                "other".to_string()
            } else {
                plain(section)
            };
            let row = sections
                .iter()
                .position(|(name, _)| *name == section)
                .unwrap_or_else(|| {
                    sections.push((section, vec![0; functions.len()]));
                    sections.len() - 1
                });
            sections[row].1[i] += count.total();
        }
    }
    sections.retain(|(_, counts)| counts.iter().any(|&count| count > 0));
    table(
        text,
        "section",
        functions.iter().map(|function| &*function.name),
        sections,
    );
}

/// The name of a kind of operation, and the function that reads its number from a count.
type OperationCounter = (&'static str, fn(&Count) -> usize);

const KINDS: [OperationCounter; 12] = [
    ("total", Count::total),
    ("add", |count| count.add),
    ("sub", |count| count.sub),
    ("mul", |count| count.mul),
    ("fused", |count| count.fused),
    ("div", |count| count.div),
    ("sqrt", |count| count.sqrt),
    ("max/min", |count| count.max_min),
    ("signs", |count| count.neg),
    ("sin+cos", |count| count.sin + count.cos),
    ("atan2", |count| count.atan2),
    ("calls", Count::called),
];

/// Adds a table of numbers under headings. A zero is left blank.
fn table<'a>(
    text: &mut String,
    corner: &str,
    columns: impl Iterator<Item = &'a str> + Clone,
    rows: Vec<(String, Vec<usize>)>,
) {
    let names = rows.iter().map(|(name, _)| name.chars().count());
    let first = names.max().unwrap_or(0).max(corner.len());
    let width = |column: &str| column.len().max(5);
    let head = |column: &str| format!("  {column:>width$}", width = width(column));
    let heads = columns
        .clone()
        .fold(format!("{corner:first$}"), |line, column| {
            line + &head(column)
        });
    line(text, format!("  {heads}"));
    for (name, counts) in rows {
        let cells = columns.clone().zip(counts).map(|(column, count)| {
            let count = if count == 0 {
                String::new()
            } else {
                count.to_string()
            };
            format!("  {count:>width$}", width = width(column))
        });
        line(
            text,
            format!("  {name:first$}{}", cells.collect::<String>()),
        );
    }
}
