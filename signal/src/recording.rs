//! Several channels of one test or run.

use crate::Signal;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// One channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// What it is called: the output of a run, the channel code of a test.
    pub name: String,
    /// What it is called besides, if anything: the name of the channel in words.
    pub title: String,
    /// Its unit as it is spelled; empty where none is said.
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
    /// The file system says no.
    #[error("{path}: {error}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// A file holds something else than it should.
    #[error("{path}:{line}: {message}")]
    Content {
        /// The file.
        path: PathBuf,
        /// The line, from 1 on.
        line: u64,
        /// What is wrong, with the remedy.
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

/// A regular file as bytes.
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
    /// The channels of a CSV file, or of an ISO-MME file `.mme`, with its folder `Channel`; of a folder, those of the one `.mme` file in it.
    ///
    /// # Errors
    /// Where a file cannot be read, or holds something else.
    pub fn read(path: &Path) -> Result<Recording, ReadError> {
        let is_mme = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("mme"));
        match path.is_dir() || is_mme {
            true => crate::mme::read(path),
            false => crate::table::read(path),
        }
    }

    /// The channel of this name, or else of this title.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        let by = |of: fn(&Channel) -> &str| self.channels.iter().find(|one| of(one) == name);
        by(|one| &one.name).or_else(|| by(|one| &one.title))
    }
}
