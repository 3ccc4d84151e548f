//! Several channels of one test or run.

use crate::Signal;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// One channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name: the name of an output of a run, or the channel code of a test.
    pub name: String,
    /// A second name, such as the channel in words; empty if there is none.
    pub title: String,
    /// Its unit as it is written; empty if there is none.
    pub unit: String,
    /// The status in its file that casts doubt on its data, such as `channel failed`.
    pub doubt: Option<String>,
    /// Its samples.
    pub signal: Signal,
}

impl Channel {
    /// A channel with these samples, without a name.
    pub fn of(signal: Signal) -> Channel {
        Channel {
            name: String::new(),
            title: String::new(),
            unit: String::new(),
            doubt: None,
            signal,
        }
    }
}

/// Several channels of one test or run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The channels, in their order.
    pub channels: Vec<Channel>,
}

/// Why a recording cannot be read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// An error of the file system.
    #[error("{path}: {error}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The error.
        error: std::io::Error,
    },
    /// The content of a file is wrong.
    #[error("{path}:{line}: {message}")]
    Content {
        /// The file.
        path: PathBuf,
        /// The line, from 1 on.
        line: u64,
        /// The error, with the remedy.
        message: String,
    },
}

impl ReadError {
    pub(crate) fn content(path: &Path, line: u64, message: impl Into<String>) -> Self {
        ReadError::Content {
            path: path.to_owned(),
            line,
            message: message.into(),
        }
    }
}

/// The bytes of a regular file.
fn bytes_of(path: &Path) -> Result<Vec<u8>, ReadError> {
    let failed = |error| ReadError::Io {
        path: path.to_owned(),
        error,
    };
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(failed(std::io::Error::other("this is no regular file")));
    }
    std::fs::read(path).map_err(failed)
}

/// The text of a regular file: UTF-8, or ISO 8859-1 if it is not valid UTF-8.
pub(crate) fn text_of(path: &Path) -> Result<String, ReadError> {
    Ok(match String::from_utf8(bytes_of(path)?) {
        Ok(text) => text,
        // each byte of ISO 8859-1 is the character with the same number
        Err(error) => error.into_bytes().into_iter().map(char::from).collect(),
    })
}

impl Recording {
    /// Reads a recording: a CSV file, or an ISO-MME file `.mme` with its folder `Channel`, or a folder with one `.mme`
    /// file.
    ///
    /// # Errors
    /// A file cannot be read, or its content is wrong.
    pub fn read(path: &Path) -> Result<Recording, ReadError> {
        let is_mme = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("mme"));
        match path.is_dir() || is_mme {
            true => crate::mme::read(path),
            false => crate::table::read(path),
        }
    }

    /// The channel with this name; if there is none, the channel with this title.
    ///
    /// # Errors
    /// There is no such channel, or there are several.
    pub fn channel(&self, name: &str) -> Result<&Channel, NoChannel> {
        let by = |of: fn(&Channel) -> &str| {
            let all = self.channels.iter().filter(|one| of(one) == name);
            all.collect::<Vec<&Channel>>()
        };
        let found = match by(|one| &one.name) {
            found if found.is_empty() => by(|one| &one.title),
            found => found,
        };
        match found.as_slice() {
            [] => Err(NoChannel::Unknown),
            [one] => Ok(one),
            several => Err(NoChannel::Several(several.len())),
        }
    }
}

/// Why no channel could be found by a name.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum NoChannel {
    /// No channel has this name or title.
    #[error("no channel has this name")]
    Unknown,
    /// This many channels have the name or title.
    #[error("{0} channels have this name")]
    Several(usize),
}
