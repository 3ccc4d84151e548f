//! The lines of a file of ISO-MME.

use crate::ReadError;
use crate::recording::text_of;
use std::path::Path;

/// The text for an unknown value.
pub const NOVALUE: &str = "NOVALUE";
/// Width of a key in columns.
const WIDTH: usize = 28;

/// A file: pairs of key and value, and lines without a key.
pub struct Lines {
    /// Keys and values.
    pub pairs: Vec<(String, String)>,
    /// Lines without a key, with their numbers from 1 on.
    pub data: Vec<(u64, String)>,
}

impl Lines {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Lines, ReadError> {
        let text = text_of(path)?;
        let mut lines = Lines {
            pairs: Vec::new(),
            data: Vec::new(),
        };
        for (index, line) in text.lines().enumerate() {
            let line = line.trim_start_matches('\u{feff}').trim_end();
            // the data begin at the first line without a key; later colons do not matter
            let pair = if lines.data.is_empty() {
                line.split_once(':')
            } else {
                None
            };
            match pair {
                Some((key, value)) => {
                    let pair = (key.trim().to_owned(), value.trim().to_owned());
                    lines.pairs.push(pair);
                }
                None if line.trim().is_empty() => {}
                None => lines.data.push((index as u64 + 1, line.trim().to_owned())),
            }
        }
        Ok(lines)
    }

    /// The value of a key, whose case does not matter; `None` if the key is missing or has no value.
    pub fn value(&self, key: &str) -> Option<&str> {
        let found = self
            .pairs
            .iter()
            .find(|(other, _)| other.eq_ignore_ascii_case(key));
        let value = found?.1.as_str();
        (!value.is_empty() && value != NOVALUE).then_some(value)
    }
}

/// A line with a key and its value.
pub fn line(key: &str, value: &str) -> String {
    format!("{key:<WIDTH$}:{value}\n")
}
