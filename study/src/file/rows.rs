//! Reads `rows` of `design: list`. They are written in the study, or in a CSV file with a heading of names such as
//! `slack` or `slack [mm]`.

use super::design::{Planned, known, within};
use super::reader::{self, Reader, entries, items, optional};
use crate::facts::{ModelFacts, ParameterFact};
use crate::quantity::strict;
use crate::study::{Listed, Plan, Varied};
use bryant_generator::Diagnostic;
use bryant_generator::description::load::open_file;
use bryant_generator::description::place::At;
use bryant_generator::description::tree::NodeKind;
use bryant_generator::diagnostic::quoted;
use bryant_table::unit::{product, spelled};
use std::fmt::Display;
use std::io::Read as _;
use std::path::Path;

/// Largest number of rows in a list, because they are held in memory.
const MOST_LISTED: usize = 10_000_000;
/// Largest size of a CSV file in bytes.
const MOST_BYTES: u64 = 1 << 30;
/// Largest number of problems that are reported for a CSV file.
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
        NodeKind::Map(_) => {
            let at = optional(at, "csv")?;
            let path = reader.text(at)?;
            let table = Table {
                reader,
                at,
                name: path,
            };
            table.read(&directory.join(path), facts)?
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

/// Reads rows that are written in the study. A row that leaves out a parameter takes its default value.
fn written(reader: &Reader, at: At<'_>, facts: &ModelFacts) -> Option<Read> {
    let items = items(at);
    let mut sound = true;
    let mut varied: Vec<&ParameterFact> = Vec::new();
    for item in &items {
        for (name, at) in entries(*item) {
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

/// A column of a table: its parameter, and the unit in its heading.
type Column<'t> = (&'t ParameterFact, Option<&'t str>);

impl Table<'_> {
    /// Reads the rows of the file at `path`.
    fn read(&self, path: &Path, facts: &ModelFacts) -> Option<Read> {
        let file = open_file(path);
        let file = file.inspect_err(|error| self.unreadable(error)).ok()?;
        if file.metadata().is_ok_and(|about| about.len() > MOST_BYTES) {
            self.unreadable(&format!("it is longer than {MOST_BYTES} bytes"));
            return None;
        }
        let mut text = String::new();
        let whole = file.take(MOST_BYTES).read_to_string(&mut text);
        whole.inspect_err(|error| self.unreadable(error)).ok()?;
        let lines = Lines {
            table: self,
            text: &text,
        };
        let table = bryant_table::Table::of(&text).map_err(|fault| lines.fault(fault));
        let Some(table) = table.ok()? else {
            self.unreadable(&"it is empty");
            return None;
        };
        let columns = lines.columns(&table, facts)?;
        let values = lines.values(&table, &columns)?;
        let shown = columns
            .iter()
            .map(|(fact, unit)| reader::shown_in(fact, *unit));
        Some((shown.collect(), values))
    }

    /// Reports that the file as a whole cannot be read.
    fn unreadable(&self, error: &dyn Display) {
        let message = format!("cannot read {}: {error}", quoted(self.name));
        self.reader.add(self.at.problem(
            message,
            "the path is relative to the study; the file is CSV with a heading of parameters",
        ));
    }
}

/// The text of a table, in which problems are shown.
struct Lines<'r> {
    table: &'r Table<'r>,
    text: &'r str,
}

impl<'r> Lines<'r> {
    /// The columns, by the names and units in the heading.
    fn columns(
        &self,
        table: &bryant_table::Table<'r>,
        facts: &'r ModelFacts,
    ) -> Option<Vec<Column<'r>>> {
        let mut columns: Vec<Column<'r>> = Vec::new();
        let mut sound = true;
        for heading in table.headings(&|text| product(spelled(text)).is_some()) {
            // the name of a parameter may itself look like a name with a unit
            let whole = facts.parameter(heading.field.text);
            let (name, unit) = match whole {
                Some(_) => (heading.field.text, None),
                None => (heading.name, heading.unit),
            };
            let (message, help) = match facts.parameter(name) {
                Some(fact) if columns.iter().any(|(c, _)| c.name == fact.name) => (
                    format!("two columns are named {}", quoted(name)),
                    "remove one".into(),
                ),
                Some(fact) => {
                    columns.push((fact, unit));
                    continue;
                }
                None => facts.no_parameter(name),
            };
            self.fault(heading.field.fault(message, help));
            sound = false;
        }
        sound.then_some(columns)
    }

    /// The numbers of all rows, row by row.
    fn values(&self, table: &bryant_table::Table<'r>, columns: &[Column<'r>]) -> Option<Vec<f64>> {
        let mut values = Vec::new();
        let mut problems = 0;
        for fields in table.rows(true) {
            let fields = fields.map_err(|fault| self.fault(fault)).ok()?;
            for (field, (fact, unit)) in fields.iter().zip(columns) {
                match cell(field.text, fact, unit.unwrap_or("")) {
                    Ok(value) => values.push(value),
                    Err((message, help)) => {
                        let message = format!("\"{}\": {message}", fact.name);
                        self.fault(field.fault(message, help));
                        problems += 1;
                    }
                }
            }
            if problems >= MOST_PROBLEMS {
                return None;
            }
            if values.len() / columns.len() > MOST_LISTED {
                let message = format!("it has more than {MOST_LISTED} rows");
                self.table.unreadable(&message);
                return None;
            }
        }
        if values.is_empty() && problems == 0 {
            self.table.unreadable(&"it has no rows");
        }
        (problems == 0 && !values.is_empty()).then_some(values)
    }

    /// Reports what is wrong in the file.
    fn fault(&self, fault: bryant_table::Fault) {
        let place = (fault.line, fault.column, fault.length);
        let name = self.table.name;
        self.table.reader.add(Diagnostic::at(
            name,
            self.text,
            place,
            fault.message,
            fault.help,
        ));
    }
}

/// A number in a table: a bare number in the unit of the heading (SI if there is none), or a number with its own unit.
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
