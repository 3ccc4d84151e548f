//! Tables of numbers as text (CSV) and tests in ISO-MME, for curves and recordings, which are read by the same rules.
//!
//! A table has a line for each row, with fields between tabs, `;` or `,`. Empty lines, lines that begin with `#`, and a
//! byte order mark are skipped. A field may be in quotation marks. The first line may have headings such as `ax [g]`,
//! with the unit of the column.
//!
//! [`mod@mme`] reads tests in ISO-MME; [`mod@unit`] has all units, with their sizes and dimensions.
//!
//! What could be read in two ways is refused: a line with more or fewer fields than the first one, and a decimal comma.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod heading;
pub mod mme;
pub mod unit;

pub use heading::Heading;

/// An error in a table, with its place and a remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Line, from 1.
    pub line: usize,
    /// The first wrong character in the line, from 1.
    pub column: usize,
    /// Number of wrong characters, at least 1.
    pub length: usize,
    /// The error.
    pub message: String,
    /// The remedy.
    pub help: String,
}

/// A field of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field<'t> {
    /// The text, without quotation marks and blanks around it.
    pub text: &'t str,
    /// Line, from 1.
    pub line: usize,
    /// First character in the line, from 1.
    pub column: usize,
    /// Number of characters.
    pub length: usize,
}

impl Field<'_> {
    /// The number; `None` if the field is empty. It may be infinite or NaN if the text says so.
    ///
    /// # Errors
    /// The text is no number.
    pub fn number(&self) -> Result<Option<f64>, Fault> {
        if self.text.is_empty() {
            return Ok(None);
        }
        self.text.parse().map(Some).map_err(|_| {
            let help = match has_decimal_comma(self.text) {
                true => "its comma is a decimal mark: write decimals behind a point",
                false => "write a number without unit; lines that are no data begin with `#`",
            };
            self.fault(format!("\"{}\" is no number", shortened(self.text)), help)
        })
    }

    /// A fault of this field.
    pub fn fault(&self, message: impl Into<String>, help: impl Into<String>) -> Fault {
        Fault {
            line: self.line,
            column: self.column,
            length: self.length.max(1),
            message: message.into(),
            help: help.into(),
        }
    }
}

/// The first 40 characters of a text, for a message.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// True if a text is a number with a decimal comma.
fn has_decimal_comma(text: &str) -> bool {
    text.matches(',').count() == 1 && text.replace(',', ".").parse::<f64>().is_ok()
}

/// A table: its text, the delimiter of fields, and the fields of the first line.
#[derive(Clone, Debug)]
pub struct Table<'t> {
    text: &'t str,
    delimiter: char,
    first: Vec<Field<'t>>,
}

impl<'t> Table<'t> {
    /// Reads a table; `None` if the text has no line with content.
    ///
    /// # Errors
    /// A quotation mark in the first line is not closed.
    pub fn of(text: &'t str) -> Result<Option<Table<'t>>, Fault> {
        let text = text.trim_start_matches('\u{feff}');
        let mut lines = contents(text);
        let Some(first) = lines.next() else {
            return Ok(None);
        };
        let delimiter = delimiter(first, lines.next());
        let first = split(first, delimiter)?;
        Ok(Some(Table {
            text,
            delimiter,
            first,
        }))
    }

    /// The fields of the first line.
    pub fn first(&self) -> &[Field<'t>] {
        &self.first
    }

    /// The headings in the first line. Units in round brackets or behind a stroke, as in `ax (g)` and `ax/g`, are
    /// recognised only if `is_unit` is true for them.
    pub fn headings(&self, is_unit: &dyn Fn(&str) -> bool) -> Vec<Heading<'t>> {
        let each = self.first.iter();
        each.map(|field| Heading::of(*field, is_unit)).collect()
    }

    /// True if the first line has headings: its field `index` is neither a number nor a number with a decimal comma.
    pub fn is_headed(&self, index: usize) -> bool {
        let text = self.first.get(index).map_or("", |field| field.text);
        text.parse::<f64>().is_err() && !has_decimal_comma(text)
    }

    /// The lines with numbers: without the first line if it is `headed`. Each has as many fields as the first line.
    pub fn rows(&self, headed: bool) -> impl Iterator<Item = Result<Vec<Field<'t>>, Fault>> + '_ {
        let lines = contents(self.text).skip(usize::from(headed));
        lines.map(move |line| self.row(line, headed))
    }

    fn row(&self, line: (usize, &'t str), headed: bool) -> Result<Vec<Field<'t>>, Fault> {
        let mut fields = split(line, self.delimiter)?;
        let expected = self.first.len();
        // a delimiter at the end of a line is ignored
        while fields.len() > expected && fields.last().is_some_and(|last| last.text.is_empty()) {
            fields.pop();
        }
        if fields.len() == expected {
            return Ok(fields);
        }
        let whole = |line: usize, text: &str, message: String, help: &str| Fault {
            line,
            column: 1,
            length: text.chars().count().max(1),
            message,
            help: help.to_owned(),
        };
        let first = match headed {
            true => "the line of headings",
            false => "the first line",
        };
        let message = format!(
            "this line has {}, but {first} has {expected}",
            match fields.len() {
                1 => "1 field".to_owned(),
                count => format!("{count} fields"),
            }
        );
        let help = match (fields.len() > expected, self.delimiter) {
            (false, _) => "complete the line, or put `#` before it",
            (true, ',') => "if a comma is a decimal mark here, write decimals behind a point",
            (true, _) => "remove what is too much, or add its heading",
        };
        Err(whole(line.0, line.1, message, help))
    }
}

/// The lines that are neither empty nor comments, with their numbers from 1.
fn contents(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.lines().enumerate();
    lines
        .map(|(index, line)| (index + 1, line))
        .filter(|(_, line)| {
            let line = line.trim_start();
            !line.is_empty() && !line.starts_with('#')
        })
}

/// The delimiter of fields: the first of tab, `;` and `,` that gives the same number of fields in the first and the
/// second line, at least two. If there is none, the first of them that occurs in the first line, else `,`.
fn delimiter(first: (usize, &str), second: Option<(usize, &str)>) -> char {
    let count = |line, delimiter| split(line, delimiter).map_or(1, |fields| fields.len());
    let all = ['\t', ';', ','];
    let divides = |delimiter: &char| count(first, *delimiter) > 1;
    let agrees = |delimiter: &char| {
        divides(delimiter)
            && second.is_some_and(|second| count(first, *delimiter) == count(second, *delimiter))
    };
    let found = all.into_iter().find(agrees);
    found
        .or_else(|| all.into_iter().find(divides))
        .unwrap_or(',')
}

/// The fields of a line. A delimiter in quotation marks does not count.
fn split((line, text): (usize, &str), delimiter: char) -> Result<Vec<Field<'_>>, Fault> {
    let mut fields = Vec::new();
    let (mut begin, mut first, mut column) = (0, 1, 1);
    let mut quoted = None;
    for end in text.char_indices().map(Some).chain([None]) {
        let at = match end {
            Some((_, '"')) => {
                quoted = match quoted {
                    Some(_) => None,
                    None => Some(column),
                };
                column += 1;
                continue;
            }
            Some((at, c)) if c == delimiter && quoted.is_none() => at,
            Some(_) => {
                column += 1;
                continue;
            }
            None => text.len(),
        };
        let whole = &text[begin..at];
        let blanks = whole.chars().take_while(|c| c.is_whitespace()).count();
        let trimmed = whole.trim();
        fields.push(Field {
            text: unquoted(trimmed),
            line,
            column: first + blanks.min(whole.chars().count().saturating_sub(1)),
            length: trimmed.chars().count(),
        });
        column += 1;
        first = column;
        begin = (at + delimiter.len_utf8()).min(text.len());
    }
    match quoted {
        None => Ok(fields),
        Some(column) => Err(Fault {
            line,
            column,
            length: 1,
            message: "a quotation mark does not end in its line".to_owned(),
            help: "write `\"` before and behind a field, or nowhere".to_owned(),
        }),
    }
}

/// A text without the quotation marks around it.
fn unquoted(text: &str) -> &str {
    let inside = text
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    inside.unwrap_or(text).trim()
}

#[cfg(test)]
mod tests;
