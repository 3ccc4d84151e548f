//! `rows` of `design: list`: written in the study, or in a CSV file with a heading of names such as `slack` or `slack [mm]`.

use super::design::{Planned, known, within};
use super::reader::{self, Reader};
use crate::facts::{ModelFacts, ParameterFact};
use crate::quantity::strict;
use crate::study::{Listed, Plan, Varied};
use bryant_generator::Diagnostic;
use bryant_generator::description::load::open_file;
use bryant_generator::description::place::At;
use bryant_generator::description::tree::Kind;
use bryant_generator::diagnostic::quoted;
use std::fmt::Display;
use std::io::Read as _;
use std::path::Path;

/// Largest number of rows in a list, because they are held in memory.
const MOST_LISTED: usize = 10_000_000;
/// Largest size of a CSV file in bytes.
const MOST_BYTES: u64 = 1 << 30;
/// Largest number of problems that are reported for a CSV file: thousands of equal messages help nobody.
const MOST_PROBLEMS: usize = 20;

/// Reads the rows.
pub fn read(
    reader: &Reader,
    root: At<'_>,
    facts: &ModelFacts,
    directory: &Path,
) -> Option<Planned> {
    let help = "write `rows: [{ slack: 10 mm }, …]` or `rows: { csv: FILE }`";
    let at = reader.required(root, "rows", help)?;
    let (varied, values) = match &at.node.kind {
        Kind::Map(_) => {
            reader.record(at, "`rows`", &["csv"]);
            let at = reader.required(at, "csv", help)?;
            let path = reader.text(at)?;
            let table = Table {
                reader,
                at,
                name: &path,
            };
            table.read(&directory.join(&path), facts)?
        }
        _ => written(reader, at, facts)?,
    };
    let rows = values.len() / varied.len();
    let rows = within(reader, root, "rows", rows as u128, || {
        "take fewer rows".into()
    })?;
    Some(Planned {
        rows,
        varied,
        plan: Plan::List(Listed(values)),
    })
}

/// The varied parameters, and their values row by row.
type Read = (Vec<Varied>, Vec<f64>);

/// Rows in the study itself. A parameter that a row leaves out has its default value there.
fn written(reader: &Reader, at: At<'_>, facts: &ModelFacts) -> Option<Read> {
    let items = reader.items(at, "`rows`");
    let mut sound = true;
    let mut varied: Vec<&ParameterFact> = Vec::new();
    for item in &items {
        for (name, at) in reader.entries(*item, "a row") {
            match known(reader, at, name, facts) {
                Some(fact) if !varied.iter().any(|v| v.name == fact.name) => varied.push(fact),
                Some(_) => {}
                None => sound = false,
            }
        }
    }
    if varied.is_empty() {
        if sound {
            reader.add(at.problem(
                "the rows name no parameter",
                "write rows such as `{ slack: 10 mm }`",
            ));
        }
        return None;
    }
    let mut values = Vec::new();
    for item in &items {
        for fact in &varied {
            let value =
                match item.node.get(&fact.name) {
                    None => Some(fact.default),
                    Some(_) => {
                        let at = item.key(&fact.name);
                        let value = reader.quantity(at, &fact.unit);
                        value.filter(|value| {
                            let allowed = fact.allows([*value; 2]);
                            if !allowed {
                                let message =
                                    format!("{value} is out of the bounds of \"{}\"", fact.name);
                                reader.add(at.problem(
                                    message,
                                    format!("in the model it is {}", fact.bounds()),
                                ));
                            }
                            allowed
                        })
                    }
                };
            sound &= value.is_some();
            values.push(value.unwrap_or(fact.default));
        }
    }
    let shown = varied.into_iter().map(|fact| {
        let values = items.iter().filter_map(|item| item.node.get(&fact.name));
        reader::varied(fact, values)
    });
    sound.then(|| (shown.collect(), values))
}

/// A CSV file with rows. Messages call it `name` and point to `at` in the study.
struct Table<'r> {
    reader: &'r Reader,
    at: At<'r>,
    name: &'r str,
}

/// A column of a table: its parameter, and the unit in its heading, "" if it has none.
type Column<'f> = (&'f ParameterFact, String);

impl Table<'_> {
    /// Reads the rows of the file at `path`.
    fn read(&self, path: &Path, facts: &ModelFacts) -> Option<Read> {
        let file = open_file(path);
        let file = file.inspect_err(|error| self.unreadable(error)).ok()?;
        if file.metadata().is_ok_and(|about| about.len() > MOST_BYTES) {
            self.unreadable(&format!("it is longer than {MOST_BYTES} bytes"));
            return None;
        }
        let mut csv = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(file.take(MOST_BYTES));
        let headings = csv.headers().inspect_err(|error| self.unreadable(error));
        let columns = self.columns(headings.ok()?, facts)?;
        let values = self.values(&mut csv, &columns)?;
        let shown = columns.iter().map(|(fact, unit)| {
            reader::shown_in(fact, Some(unit.as_str()).filter(|unit| !unit.is_empty()))
        });
        Some((shown.collect(), values))
    }

    /// The columns, by the names and units in the heading.
    fn columns<'f>(
        &self,
        headings: &csv::StringRecord,
        facts: &'f ModelFacts,
    ) -> Option<Vec<Column<'f>>> {
        if headings.is_empty() {
            self.unreadable(&"it is empty");
            return None;
        }
        let mut columns: Vec<Column<'f>> = Vec::new();
        let mut sound = true;
        for heading in headings {
            let (parameter, unit) = match heading.strip_suffix(']').and_then(|h| h.split_once('['))
            {
                Some((parameter, unit)) => (parameter.trim(), unit.trim()),
                None => (heading, ""),
            };
            let (message, help) = match facts.parameter(parameter) {
                Some(fact) if columns.iter().any(|(c, _)| c.name == fact.name) => (
                    format!("two columns are named {}", quoted(parameter)),
                    "remove one".into(),
                ),
                Some(fact) => {
                    columns.push((fact, unit.to_owned()));
                    continue;
                }
                None if heading.contains([';', '\t']) => (
                    format!("the heading has a column {}", quoted(heading)),
                    "separate columns by commas".into(),
                ),
                None => facts.no_parameter(parameter),
            };
            self.problem(1, message, help);
            sound = false;
        }
        sound.then_some(columns)
    }

    /// The numbers of all rows, row by row.
    fn values(
        &self,
        csv: &mut csv::Reader<impl std::io::Read>,
        columns: &[Column<'_>],
    ) -> Option<Vec<f64>> {
        let mut values = Vec::new();
        let mut problems = 0;
        for record in csv.records() {
            let record = record.inspect_err(|error| self.unreadable(error)).ok()?;
            let line = record.position().map_or(0, csv::Position::line);
            for (text, (fact, unit)) in record.iter().zip(columns) {
                match cell(text, fact, unit) {
                    Ok(value) => values.push(value),
                    Err((message, help)) => {
                        self.problem(line, format!("\"{}\": {message}", fact.name), help);
                        problems += 1;
                    }
                }
            }
            if problems >= MOST_PROBLEMS {
                return None;
            }
            if values.len() / columns.len() > MOST_LISTED {
                self.unreadable(&format!("it has more than {MOST_LISTED} rows"));
                return None;
            }
        }
        if values.is_empty() && problems == 0 {
            self.unreadable(&"it has no rows");
        }
        (problems == 0 && !values.is_empty()).then_some(values)
    }

    /// Reports that the file as a whole cannot be read.
    fn unreadable(&self, error: &dyn Display) {
        let message = format!("cannot read {}: {error}", quoted(self.name));
        self.reader.add(self.at.problem(
            message,
            "the path is relative to the study; the file is CSV with a heading of parameters",
        ));
    }

    /// Reports a problem in a line of the file.
    fn problem(&self, line: u64, message: String, help: String) {
        let mut problem = Diagnostic::of_file(self.name, message, help);
        problem.line = line as usize;
        problem.column = 1;
        self.reader.add(problem);
    }
}

/// A number in a table: in the unit of its heading, in SI, or with a unit of its own.
fn cell(text: &str, fact: &ParameterFact, unit: &str) -> Result<f64, (String, String)> {
    let with_unit = match text.parse::<f64>() {
        Ok(_) if !unit.is_empty() => format!("{text} {unit}"),
        _ => text.to_owned(),
    };
    let value = strict(&with_unit, &fact.unit).map_err(|error| {
        let error = error.to_string();
        let (message, help) = error
            .split_once("\n  help: ")
            .unwrap_or((&error, "write a number, or one with its unit"));
        (message.to_owned(), help.to_owned())
    })?;
    if fact.allows([value; 2]) {
        Ok(value)
    } else {
        let message = format!("{value} is out of its bounds");
        Err((message, format!("in the model it is {}", fact.bounds())))
    }
}
