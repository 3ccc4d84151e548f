//! Several channels of one test or run.

use crate::Signal;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// One channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name: the name of an output of a run, or the channel code of a test.
    pub name: String,
    /// An additional name, if there is one: the name of the channel in words.
    pub title: String,
    /// Its unit as it is written; empty if it is not given.
    pub unit: String,
    /// Its samples.
    pub signal: Signal,
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
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>, ReadError> {
    let failed = |error| ReadError::Io {
        path: path.to_owned(),
        error,
    };
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(failed(std::io::Error::other("this is no regular file")));
    }
    std::fs::read(path).map_err(failed)
}

impl Recording {
    /// The channels of a CSV file, or of an ISO-MME file `.mme` with its folder `Channel`, or of a folder with one `.mme` file.
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

    /// The channel with this name, or else the one with this title.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        let by = |of: fn(&Channel) -> &str| self.channels.iter().find(|one| of(one) == name);
        by(|one| &one.name).or_else(|| by(|one| &one.title))
    }
}
