//! The lines of a file of ISO-MME.

use super::{NOVALUE, Wrong};
use crate::{Fault, Field};
use std::path::Path;

/// A line `key :value`.
#[derive(Clone, Debug)]
pub struct Pair {
    pub key: String,
    pub value: String,
    /// Line, column and length of the value, or of the key if the value is empty.
    pub place: (usize, usize, usize),
}

/// A file: its text, the lines with a key before the data, and the place of the data.
#[derive(Debug)]
pub struct Lines {
    pub text: String,
    pub pairs: Vec<Pair>,
    /// Lines before the data.
    head: usize,
}

impl Lines {
    pub fn of(text: String) -> Lines {
        let text = text.trim_start_matches('\u{feff}').to_owned();
        let mut pairs = Vec::new();
        let mut head = 0;
        // the data begin at the first line without a key; later colons do not matter
        for (index, line) in text.lines().enumerate() {
            match line.split_once(':') {
                Some((key, value)) => {
                    let (said, after) = (value.trim(), value.trim_start());
                    let before = line.chars().count() - after.chars().count();
                    pairs.push(Pair {
                        key: key.trim().to_owned(),
                        value: said.to_owned(),
                        place: match said {
                            "" => (index + 1, 1, key.trim_end().chars().count().max(1)),
                            said => (index + 1, before + 1, said.chars().count()),
                        },
                    });
                }
                None if line.trim().is_empty() => {}
                None => break,
            }
            head = index + 1;
        }
        Lines { text, pairs, head }
    }

    /// The lines of data that are not empty.
    pub fn data(&self) -> impl Iterator<Item = Field<'_>> {
        let lines = self.text.lines().enumerate().skip(self.head);
        let full = lines.filter(|(_, line)| !line.trim().is_empty());
        full.map(|(index, line)| Field {
            text: line.trim(),
            line: index + 1,
            column: 1 + line.chars().take_while(|c| c.is_whitespace()).count(),
            length: line.trim().chars().count(),
        })
    }

    /// The pair of a key, whose case does not matter; `None` if the key is missing or its value is unknown.
    ///
    /// # Errors
    /// The key has two values.
    pub fn pair(&self, path: &Path, key: &str) -> Result<Option<&Pair>, Wrong> {
        let known = |pair: &&Pair| !matches!(pair.value.as_str(), "" | NOVALUE);
        let same = |pair: &&Pair| pair.key.eq_ignore_ascii_case(key);
        let mut all = self.pairs.iter().filter(same).filter(known);
        let first = all.next();
        match all.find(|other| first.is_some_and(|first| first.value != other.value)) {
            None => Ok(first),
            Some(other) => {
                let message = format!("`{key}` has a second value");
                Err(self.wrong(path, other.place, message, "keep the one that is right"))
            }
        }
    }

    /// An error in this file.
    pub fn wrong(
        &self,
        path: &Path,
        (line, column, length): (usize, usize, usize),
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Wrong {
        Wrong::Content {
            path: path.to_owned(),
            text: self.text.clone(),
            fault: Fault {
                line,
                column,
                length: length.max(1),
                message: message.into(),
                help: help.into(),
            },
        }
    }
}
