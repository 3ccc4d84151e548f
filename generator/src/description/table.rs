//! Columns of numbers in text files (CSV): fields between `,`, `;` or tabs, comments from `#`, a line of headings or none.

use super::tree::{MAX_BYTES, MAX_POINTS};
use crate::diagnostic::{Diagnostic, quoted, suggestion};

/// A file of numbers as read.
#[derive(Debug)]
pub struct Table {
    /// Name as shown to the user.
    pub name: String,
    /// Text, without byte order mark, lines ended by `\n`.
    pub text: String,
    /// Of a channel of a test the unit of its values.
    pub unit: Option<String>,
}

/// Which column is wanted.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// By its number, from 1.
    Number(usize),
    /// By its heading.
    Name(String),
}

/// A line: its two numbers, and where they stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// As written, units not applied.
    pub values: [f64; 2],
    /// Line and, of both numbers, column and length \[characters\], from 1.
    line: usize,
    spans: [(usize, usize); 2],
}

/// Why there are no numbers.
#[derive(Debug)]
pub enum Fault {
    /// The table has no such column: which of the two, what is wrong, what would be right.
    Column(usize, String, String),
    /// Something in the file.
    InFile(Box<Diagnostic>),
}

/// A field of a line.
struct Field<'a> {
    /// Without quotation marks and blanks around it.
    text: &'a str,
    /// From 1.
    column: usize,
    /// \[characters\]
    length: usize,
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
            unit: None,
            text: text.trim_start_matches('\u{feff}').replace("\r\n", "\n"),
        })
    }

    /// Two columns of it.
    ///
    /// # Errors
    /// The first fault found.
    pub fn columns(&self, wanted: &[Column; 2]) -> Result<Vec<Row>, Fault> {
        let mut lines = self
            .text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line))
            .filter(|(_, line)| {
                let line = line.trim_start();
                !line.is_empty() && !line.starts_with('#')
            })
            .peekable();
        let Some(&(first, heading)) = lines.peek() else {
            return Err(Fault::InFile(Box::new(Diagnostic::of_file(
                &self.name,
                "the file has no numbers",
                "write a line `abscissa, ordinate` for each point",
            ))));
        };
        let delimiter = delimiter(heading);
        let fields = split(heading, delimiter);
        let chosen = self.chosen(wanted, &fields)?;
        let is_number = |&index: &usize| {
            fields
                .get(index)
                .is_some_and(|field| field.text.parse::<f64>().is_ok())
        };
        let named = wanted.iter().any(|c| matches!(c, Column::Name(_)));
        if named || !chosen.iter().all(is_number) {
            lines.next();
        }
        let mut rows = Vec::new();
        for (line, text) in lines {
            if rows.len() == MAX_POINTS {
                return Err(self.fault(
                    (line, 1, 1),
                    format!("the curve has more than {MAX_POINTS} points"),
                    "leave points out; a motion does not need more",
                ));
            }
            rows.push(self.row(line, &split(text, delimiter), chosen, delimiter)?);
        }
        if rows.len() < 2 {
            return Err(self.fault(
                (first, 1, heading.chars().count()),
                match rows.len() {
                    0 => "below the headings there are no numbers".to_owned(),
                    _ => "a curve has at least two points, but the file has one".to_owned(),
                },
                "write a line `abscissa, ordinate` for each point",
            ));
        }
        Ok(rows)
    }

    /// A problem with one of the numbers of a row.
    pub fn problem(
        &self,
        row: &Row,
        which: usize,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        let (column, length) = row.spans[which];
        Diagnostic::at(
            &self.name,
            &self.text,
            (row.line, column, length),
            message,
            help,
        )
    }

    fn fault(
        &self,
        place: (usize, usize, usize),
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Fault {
        let problem = Diagnostic::at(&self.name, &self.text, place, message, help);
        Fault::InFile(Box::new(problem))
    }

    /// Indices of the columns wanted.
    fn chosen(&self, wanted: &[Column; 2], headings: &[Field<'_>]) -> Result<[usize; 2], Fault> {
        let mut chosen = [0; 2];
        for (which, column) in wanted.iter().enumerate() {
            chosen[which] = match column {
                Column::Number(number) if (1..=headings.len()).contains(number) => number - 1,
                Column::Number(number) => {
                    return Err(Fault::Column(
                        which,
                        format!(
                            "{} has no column {number}: its first line has {}",
                            quoted(&self.name),
                            headings.len()
                        ),
                        "columns count from 1; they are separated by `,`, `;` or tabs".to_owned(),
                    ));
                }
                Column::Name(name) => {
                    let mut found = headings.iter().enumerate();
                    let found = found.find(|(_, field)| field.text == name.trim());
                    let Some((index, _)) = found else {
                        let names: Vec<&str> = headings.iter().map(|f| f.text).collect();
                        let list: Vec<String> = names.iter().map(|n| quoted(n)).collect();
                        return Err(Fault::Column(
                            which,
                            format!("{} has no column {}", quoted(&self.name), quoted(name)),
                            suggestion(
                                name,
                                names.iter().copied(),
                                &format!("its first line has {}", list.join(", ")),
                            ),
                        ));
                    };
                    index
                }
            };
        }
        Ok(chosen)
    }

    fn row(
        &self,
        line: usize,
        fields: &[Field<'_>],
        chosen: [usize; 2],
        delimiter: char,
    ) -> Result<Row, Fault> {
        let mut row = Row {
            values: [0.0; 2],
            line,
            spans: [(1, 1); 2],
        };
        for (which, &index) in chosen.iter().enumerate() {
            let Some(field) = fields.get(index) else {
                return Err(self.fault(
                    (line, 1, 1),
                    format!(
                        "this line has {} columns, but column {} is needed",
                        fields.len(),
                        index + 1
                    ),
                    "complete the line, or put `#` before it",
                ));
            };
            let place = (line, field.column, field.length.max(1));
            let value = field.text.parse::<f64>().ok().filter(|v| v.is_finite());
            let Some(value) = value else {
                let comma = delimiter != ',' && field.text.contains(',');
                return Err(self.fault(
                    place,
                    match field.text {
                        "" => "here a number is missing".to_owned(),
                        text => format!("{} is no number", quoted(text)),
                    },
                    if comma {
                        "write decimals behind a point"
                    } else {
                        "write a number without unit; lines that are no data begin with `#`"
                    },
                ));
            };
            row.values[which] = value;
            row.spans[which] = (field.column, field.length.max(1));
        }
        Ok(row)
    }
}

/// What separates the fields of a line: the first of tab, `;`, `,` that is in it.
fn delimiter(line: &str) -> char {
    ['\t', ';']
        .into_iter()
        .find(|c| line.contains(*c))
        .unwrap_or(',')
}

/// The fields of a line; a delimiter between quotation marks separates nothing.
fn split(line: &str, delimiter: char) -> Vec<Field<'_>> {
    let mut fields = Vec::new();
    let (mut begin, mut column, mut quoted) = (0, 1, false);
    let mut first = 1;
    let ends = line.char_indices().map(Some).chain([None]);
    for end in ends {
        let at = match end {
            Some((_, '"')) => {
                quoted = !quoted;
                column += 1;
                continue;
            }
            Some((at, c)) if c == delimiter && !quoted => at,
            Some(_) => {
                column += 1;
                continue;
            }
            None => line.len(),
        };
        let whole = &line[begin..at];
        let blanks = whole.chars().take_while(|c| c.is_whitespace()).count();
        let text = whole.trim();
        fields.push(Field {
            text: text.trim_matches('"').trim(),
            column: first + blanks.min(whole.chars().count().saturating_sub(1)),
            length: text.chars().count(),
        });
        column += 1;
        first = column;
        begin = at + delimiter.len_utf8();
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str, wanted: [Column; 2]) -> Result<Vec<[f64; 2]>, String> {
        match Table::new("t.csv", text).unwrap().columns(&wanted) {
            Ok(rows) => Ok(rows.iter().map(|r| r.values).collect()),
            Err(Fault::Column(which, message, help)) => Err(format!("{which}: {message} ({help})")),
            Err(Fault::InFile(problem)) => Err(problem.line()),
        }
    }

    const FIRST: [Column; 2] = [Column::Number(1), Column::Number(2)];

    fn named(x: &str, y: &str) -> [Column; 2] {
        [Column::Name(x.into()), Column::Name(y.into())]
    }

    #[test]
    fn all_delimiters_headings_and_comments() {
        let rows = Ok(vec![[0.0, 1.5], [2e-3, -4.0]]);
        for text in [
            "0,1.5\n2e-3,-4\n",
            "\u{feff}time,ax\r\n0, 1.5\r\n2e-3 , -4\r\n",
            "# made by hand\ntime;ax\n\n0;1.5\n # in between\n0.002;-4",
            "\"time\"\t\"a, x\"\n0\t1.5\n.002\t-4.0\n",
        ] {
            assert_eq!(numbers(text, FIRST), rows, "{text:?}");
        }
        let text = "\"t [ms]\",\"a, y\",ax\n0,9,1.5\n2e-3,9,-4\n";
        assert_eq!(numbers(text, named("t [ms]", "ax")), rows);
        assert_eq!(
            numbers(text, named("ax", "a, y")),
            Ok(vec![[1.5, 9.0], [-4.0, 9.0]])
        );
        assert_eq!(
            numbers("1,2,3\n4,5,6", [Column::Number(3), Column::Number(1)]),
            Ok(vec![[3.0, 1.0], [6.0, 4.0]])
        );
    }

    #[test]
    fn faults_are_placed() {
        let of = |text: &str| numbers(text, FIRST).unwrap_err();
        assert_eq!(
            of("t,a\n0,1\n1,  x2\n"),
            "t.csv:3:5: \"x2\" is no number (help: write a number without unit; lines that are no data begin with `#`)"
        );
        assert!(
            of("t;a\n0;1,5\n1;2\n")
                .starts_with("t.csv:2:3: \"1,5\" is no number (help: write decimals")
        );
        assert!(of("0,1\n1\n").starts_with("t.csv:2:1: this line has 1 columns"));
        assert!(of("0,1\n1,\n").starts_with("t.csv:2:3: here a number is missing"));
        assert!(of("0,1\n1,inf\n").starts_with("t.csv:2:3: \"inf\" is no number"));
        assert!(of("t,a\n").contains("below the headings there are no numbers"));
        assert!(of("t,a\n0,1\n").contains("at least two points"));
        assert!(of("# nothing\n").contains("no numbers"));
        assert!(of("5\n6\n").starts_with("1: \"t.csv\" has no column 2: its first line has 1"));
        let wrong = numbers("time,ax\n0,1\n1,2\n", named("time", "az")).unwrap_err();
        assert_eq!(
            wrong,
            "1: \"t.csv\" has no column \"az\" (did you mean \"ax\"?)"
        );
    }

    #[test]
    fn too_many_points_are_refused() {
        let text: String = (0..=MAX_POINTS).map(|k| format!("{k},0\n")).collect();
        let problem = numbers(&text, FIRST).unwrap_err();
        assert!(
            problem.starts_with("t.csv:10001:1: the curve has more than"),
            "{problem}"
        );
    }
}
