//! Several channels of one test or run.

use crate::Signal;
use bryant_table::Fault;
use bryant_table::mme::{self, NoChannel};
use std::io;
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

/// A channel of a test that cannot be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Damaged {
    /// The names that it may have: channel codes, its title.
    pub names: Vec<String>,
    /// What is wrong, with its place and the remedy.
    pub error: String,
}

/// Several channels of one test or run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The channels, in their order.
    pub channels: Vec<Channel>,
    /// Channels that cannot be read. Nothing may be said of a test where one of them might have been used.
    pub damaged: Vec<Damaged>,
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
        error: io::Error,
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
    pub(crate) fn io(path: &Path, error: io::Error) -> Self {
        ReadError::Io {
            path: path.to_owned(),
            error,
        }
    }

    /// An error in a table or a file of a test.
    pub(crate) fn fault(path: &Path, fault: &Fault) -> Self {
        let message = format!("{}\n  help: {}", fault.message, fault.help);
        ReadError::content(path, fault.line as u64, message)
    }

    pub(crate) fn content(path: &Path, line: u64, message: impl Into<String>) -> Self {
        ReadError::Content {
            path: path.to_owned(),
            line,
            message: message.into(),
        }
    }
}

/// The text of a regular file: UTF-8, or ISO 8859-1 if it is not valid UTF-8.
pub(crate) fn text_of(path: &Path) -> io::Result<String> {
    match std::fs::metadata(path)?.is_file() {
        true => std::fs::read(path).map(mme::decoded),
        false => Err(io::Error::other("this is no regular file")),
    }
}

impl Recording {
    /// Reads a recording: a CSV file, or an ISO-MME file `.mme` with its folder `Channel`, or a folder with one `.mme`
    /// file.
    ///
    /// # Errors
    /// A file cannot be read, or its content is wrong. Of a test in ISO-MME, channels that cannot be read are
    /// [damaged](Recording::damaged), as long as others can.
    pub fn read(path: &Path) -> Result<Recording, ReadError> {
        let is_mme = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("mme"));
        match path.is_dir() || is_mme {
            true => crate::mme::read(path),
            false => crate::table::read(path),
        }
    }

    /// The damaged channel that may have this name.
    pub fn damaged(&self, name: &str) -> Option<&Damaged> {
        let has = |one: &&Damaged| one.names.iter().any(|other| other == name);
        self.damaged.iter().find(has)
    }

    /// The channel with this name; if there is none, the channel with this title.
    ///
    /// # Errors
    /// There is no such channel, or there are several.
    pub fn channel(&self, name: &str) -> Result<&Channel, NoChannel> {
        let channels = self.channels.iter();
        let all: Vec<(&str, &str)> = channels
            .map(|c| (c.name.as_str(), c.title.as_str()))
            .collect();
        mme::find(&all, name).map(|index| &self.channels[index])
    }
}
