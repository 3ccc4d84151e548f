//! Columns of numbers in text files (CSV) and channels, as the points of curves: [`bryant_table`] says how they are
//! read.

use super::tree::MAX_BYTES;
use super::unit::{product, spelled};
use crate::diagnostic::{Diagnostic, quoted, suggestion};
use bryant_table::mme::{Channel, Times};
use bryant_table::{Fault as InTable, Field, Heading};

/// So many lines of numbers are read; of more than a curve may have, some are left out later.
const MOST_ROWS: usize = 1_000_000;

/// A file of numbers as read.
#[derive(Debug)]
pub struct Table {
    /// Name as shown to the user.
    pub name: String,
    /// Text, without byte order mark, lines ended by `\n`.
    pub text: String,
    /// Of a channel of a test, whose text is that of its file, the points.
    channel: Option<Columns>,
}

/// Which column is wanted.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// By its number, from 1.
    Number(usize),
    /// By its heading, with or without its unit.
    Name(String),
}

/// A line: its two numbers, and where they stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// As written, units not applied.
    pub values: [f64; 2],
    /// Line, column and length \[characters\] of both numbers, from 1.
    places: [(usize, usize, usize); 2],
}

/// Two columns.
#[derive(Clone, Debug)]
pub struct Columns {
    /// The lines with numbers, two or more.
    pub rows: Vec<Row>,
    /// The units in their headings, as the model's language spells them.
    pub units: [Option<String>; 2],
    /// Places of the headings: line, column, length.
    headings: [(usize, usize, usize); 2],
}

/// Why there are no numbers.
#[derive(Debug)]
pub enum Fault {
    /// The table has no such column: which of the two, what is wrong, what would be right.
    Column(usize, String, String),
    /// Something in the file.
    InFile(Box<Diagnostic>),
}

impl Table {
    /// The text of a file as a table.
    ///
    /// # Errors
    /// If it is too long.
    pub fn new(name: &str, text: &str) -> Result<Table, Box<Diagnostic>> {
        if text.len() > MAX_BYTES {
            return Err(Box::new(Diagnostic::of_file(
                name,
                format!("the file has {} bytes", text.len()),
                format!("at most {} MiB are read", MAX_BYTES >> 20),
            )));
        }
        Ok(Table {
            name: name.to_owned(),
            channel: None,
            text: text.trim_start_matches('\u{feff}').replace("\r\n", "\n"),
        })
    }

    /// A channel of a test: its times, and its values in its unit.
    ///
    /// # Errors
    /// The data are in doubt, or lack a unit or a sample.
    pub fn of_channel(name: &str, text: &str, channel: &Channel) -> Result<Table, Diagnostic> {
        let at = |line: usize, message: String, help: &str| {
            Err(Diagnostic::at(name, text, (line, 1, 1), message, help))
        };
        if let Some(doubt) = &channel.doubt {
            let help = "give a channel that is sound; if you know that it is, write `Data status :ok` into its file";
            return at(1, format!("the file says of its data: `{doubt}`"), help);
        }
        let Some(unit) = &channel.unit else {
            let help = "write its unit into the file: `Unit :m/s^2`";
            return at(1, "the channel has no unit".to_owned(), help);
        };
        if product(spelled(unit)).is_none() {
            let help = "write a unit that is known, such as m/s^2";
            return at(channel.unit_line, format!("`{unit}` is no unit"), help);
        }
        let mut rows = Vec::with_capacity(channel.values.len());
        for (index, value) in channel.values.iter().enumerate() {
            let line = channel.line + index;
            if value.is_nan() {
                let help =
                    "a curve has all of its points: cut the channel where samples are missing";
                return at(line, "the sample is missing".to_owned(), help);
            }
            let time = match &channel.times {
                Times::Even(first, interval) => first + index as f64 * interval,
                Times::Listed(times) => times[index],
            };
            rows.push(Row {
                values: [time, *value],
                places: [(line, 1, 1); 2],
            });
        }
        if rows.len() < 2 {
            let message = "a curve has at least two points, but the channel has one".to_owned();
            return at(channel.line, message, "give a channel with more samples");
        }
        Ok(Table {
            name: name.to_owned(),
            text: text.to_owned(),
            channel: Some(Columns {
                rows,
                units: [Some("s".to_owned()), Some(spelled(unit).to_owned())],
                headings: [(1, 1, 1); 2],
            }),
        })
    }

    /// Two columns of it; the first two if nothing is said.
    ///
    /// # Errors
    /// The first fault found.
    pub fn columns(&self, said: Option<&[Column; 2]>) -> Result<Columns, Fault> {
        if let Some(channel) = &self.channel {
            return Ok(channel.clone());
        }
        let in_file = |fault: InTable| self.in_file(fault);
        let table = bryant_table::Table::of(&self.text).map_err(in_file)?;
        let table = table.ok_or_else(|| {
            Fault::InFile(Box::new(Diagnostic::of_file(
                &self.name,
                "the file has no numbers",
                "write a line `abscissa, ordinate` for each point",
            )))
        })?;
        let headings = table.headings(&|text| product(spelled(text)).is_some());
        let first_two = [Column::Number(1), Column::Number(2)];
        let wanted = said.unwrap_or(&first_two);
        let chosen = self.chosen(wanted, &headings)?;
        let named = wanted.iter().any(|c| matches!(c, Column::Name(_)));
        let headed = named || table.is_headed(chosen[0]);
        if !headed && said.is_none() && headings.len() > 2 {
            return Err(in_file(headings[2].field.fault(
                format!("there are {} columns without headings, and two are needed", headings.len()),
                "say which: `columns: [1, 2]`; if commas are decimal marks here, write decimals behind a point",
            )));
        }
        let mut rows = Vec::new();
        for fields in table.rows(headed) {
            if rows.len() == MOST_ROWS {
                return Err(in_file(headings[0].field.fault(
                    format!("the file has more than {MOST_ROWS} lines of numbers"),
                    "leave points out; a motion does not need more",
                )));
            }
            rows.push(self.row(&fields.map_err(in_file)?, chosen)?);
        }
        let first = headings[0].field;
        if rows.len() < 2 {
            let message = match rows.len() {
                0 => "below the headings there are no numbers",
                _ => "a curve has at least two points, but the file has one",
            };
            let help = "write a line `abscissa, ordinate` for each point";
            return Err(in_file(first.fault(message, help)));
        }
        let of = |index: usize| headings[chosen[index]];
        let unit = |index: usize| {
            of(index)
                .unit
                .filter(|_| headed)
                .map(|unit| spelled(unit).to_owned())
        };
        Ok(Columns {
            rows,
            units: [unit(0), unit(1)],
            headings: [place(&of(0).field), place(&of(1).field)],
        })
    }

    /// A problem with one of the numbers of a row.
    pub fn problem(
        &self,
        row: &Row,
        which: usize,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::at(&self.name, &self.text, row.places[which], message, help)
    }

    /// A problem with the heading of one of two columns.
    pub fn heading_problem(
        &self,
        columns: &Columns,
        which: usize,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::at(
            &self.name,
            &self.text,
            columns.headings[which],
            message,
            help,
        )
    }

    fn in_file(&self, fault: InTable) -> Fault {
        let place = (fault.line, fault.column, fault.length);
        let problem = Diagnostic::at(&self.name, &self.text, place, fault.message, fault.help);
        Fault::InFile(Box::new(problem))
    }

    /// Indices of the columns wanted.
    fn chosen(&self, wanted: &[Column; 2], headings: &[Heading<'_>]) -> Result<[usize; 2], Fault> {
        let mut chosen = [0; 2];
        for (which, column) in wanted.iter().enumerate() {
            let wrong = |message: String, help: String| Err(Fault::Column(which, message, help));
            chosen[which] = match column {
                Column::Number(number) if (1..=headings.len()).contains(number) => number - 1,
                Column::Number(number) => {
                    return wrong(
                        format!(
                            "{} has no column {number}: its first line has {}",
                            quoted(&self.name),
                            headings.len()
                        ),
                        "columns count from 1; they are separated by `,`, `;` or tabs".to_owned(),
                    );
                }
                Column::Name(name) => {
                    let all = headings.iter().enumerate();
                    let called = all.filter(|(_, heading)| heading.is_called(name));
                    let called: Vec<usize> = called.map(|(index, _)| index).collect();
                    match called.as_slice() {
                        [one] => *one,
                        [] => {
                            let names: Vec<&str> = headings.iter().map(|h| h.field.text).collect();
                            let list: Vec<String> = names.iter().map(|n| quoted(n)).collect();
                            return wrong(
                                format!("{} has no column {}", quoted(&self.name), quoted(name)),
                                suggestion(
                                    name,
                                    names.iter().copied(),
                                    &format!("its first line has {}", list.join(", ")),
                                ),
                            );
                        }
                        several => {
                            return wrong(
                                format!(
                                    "{} has {} columns {}",
                                    quoted(&self.name),
                                    several.len(),
                                    quoted(name)
                                ),
                                "give each a heading of its own, or say the number of the column"
                                    .to_owned(),
                            );
                        }
                    }
                }
            };
        }
        Ok(chosen)
    }

    fn row(&self, fields: &[Field<'_>], chosen: [usize; 2]) -> Result<Row, Fault> {
        let fields = chosen.map(|index| fields[index]);
        let mut values = [0.0; 2];
        for (value, field) in values.iter_mut().zip(&fields) {
            let number = field.number().map_err(|fault| self.in_file(fault))?;
            let wrong = |message: String| {
                let help = "write a number without unit; lines that are no data begin with `#`";
                self.in_file(field.fault(message, help))
            };
            *value = match number {
                Some(number) if number.is_finite() => number,
                Some(_) => return Err(wrong(format!("{} is no number", quoted(field.text)))),
                None => return Err(wrong("here a number is missing".to_owned())),
            };
        }
        Ok(Row {
            values,
            places: [place(&fields[0]), place(&fields[1])],
        })
    }
}

/// Line, column and length.
fn place(field: &Field<'_>) -> (usize, usize, usize) {
    (field.line, field.column, field.length.max(1))
}
