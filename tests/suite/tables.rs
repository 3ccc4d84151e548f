//! The tables that runs write, by columns.

use super::command_call::call;
use super::directory;
use std::fs;
use std::path::Path;

/// Columns by their headings.
pub type Columns = Vec<(String, Vec<f64>)>;

/// A table of CSV.
pub fn read(path: &Path) -> Columns {
    let text = fs::read_to_string(path).unwrap();
    let mut rows = text.lines();
    // the first heading is in quotation marks
    let names = rows.next().unwrap().split(',');
    let names = names.map(|name| name.trim_matches('"').to_owned());
    let mut columns: Columns = names.map(|name| (name, Vec::new())).collect();
    for row in rows {
        for (cell, column) in row.split(',').zip(&mut columns) {
            column.1.push(cell.parse().unwrap());
        }
    }
    columns
}

/// The column whose heading begins with a name.
pub fn column<'a>(columns: &'a [(String, Vec<f64>)], name: &str) -> &'a [f64] {
    let found = columns.iter().find(|(n, _)| n.starts_with(name));
    &found.unwrap_or_else(|| panic!("no column {name}")).1
}

/// The largest value of a column, at least 0.
pub fn largest(columns: &[(String, Vec<f64>)], name: &str) -> f64 {
    column(columns, name).iter().copied().fold(0.0, f64::max)
}

/// A run of a bundled model, or of a model in a text, with options; it must be trusted. Returns its table, and its
/// messages.
pub fn run(model: &str, options: &[&str]) -> (Columns, String) {
    let directory = directory();
    let path = directory.path();
    let name = match model.contains('\n') {
        true => {
            fs::write(path.join("m.yaml"), model).unwrap();
            "m.yaml"
        }
        false => model,
    };
    let mut arguments = vec!["run", name, "--csv", "run.csv", "--no-files", "--energy"];
    arguments.extend(options);
    let (_, told) = call(path, &arguments, 0);
    (read(&path.join("run.csv")), told)
}

/// The work of an effect in the printed balance of energy \[J\].
pub fn energy(told: &str, effect: &str) -> f64 {
    let line = told.lines().find(|line| line.contains(effect));
    let line = line.unwrap_or_else(|| panic!("no {effect} in {told}"));
    line.split_whitespace().last().unwrap().parse().unwrap()
}
