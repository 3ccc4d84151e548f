//! Recordings as ISO-MME (ISO/TS 13499); [`bryant_table::mme`] has the rules by which it is read.
//!
//! The key of a line `key :value` is 28 columns wide. Numbers are written with all digits, so that they are read back
//! exactly.

mod write;

pub use bryant_table::mme::{MOST_CHANNELS, is_code};
pub use write::{About, write};

use crate::recording::Damaged;
use crate::recording::text_of;
use crate::{Channel, ReadError, Recording, Signal};
use bryant_table::mme::{Damage, Test, Times, Wrong};
use std::io;
use std::path::{Path, PathBuf};

/// Reads a test by its file `TEST.mme`, or by a folder with one such file. Explicit times must be at equal intervals. A
/// channel whose file is missing or has an error is [damaged](Recording::damaged).
///
/// # Errors
/// No channel is sound, the file of the test or its list has an error, or it is not known which channel is damaged; the
/// message has its line.
pub fn read(path: &Path) -> Result<Recording, ReadError> {
    let mme = match path.is_dir() {
        true => the_only(path)?,
        false => path.to_owned(),
    };
    let mut test = Test::read(&mme, &text_of).map_err(failed)?;
    let mut channels = Vec::new();
    let of = |damage: Damage| (damage.names, failed(damage.wrong));
    let mut damaged: Vec<(Vec<String>, ReadError)> =
        test.take_damaged().into_iter().map(of).collect();
    for (index, (name, title)) in test.names().into_iter().enumerate() {
        match channel(&test, index) {
            Ok(found) => channels.push(Channel {
                name: name.to_owned(),
                title: title.to_owned(),
                ..found
            }),
            Err(error) => {
                let mut names = vec![name.to_owned(), title.to_owned()];
                names.retain(|name| !name.is_empty());
                names.dedup();
                damaged.push((names, error));
            }
        }
    }
    if channels.is_empty() && !damaged.is_empty() {
        return Err(damaged.remove(0).1);
    }
    let damaged = damaged.into_iter().map(|(names, error)| Damaged {
        names,
        error: error.to_string(),
    });
    Ok(Recording {
        channels,
        damaged: damaged.collect(),
    })
}

/// The samples of a channel, with what its file says about them.
fn channel(test: &Test, index: usize) -> Result<Channel, ReadError> {
    let found = test.channel(index).map_err(failed)?;
    let signal = match found.times {
        Times::Even(first, interval) => Signal {
            first,
            interval,
            values: found.values,
        },
        Times::Listed(times) => Signal::of_samples(&times, &found.values).ok_or_else(|| {
            let message =
                "its times must be two or more, at equal intervals: sample the test evenly";
            ReadError::content(test.file(index).0, 1, message)
        })?,
    };
    Ok(Channel {
        unit: found.unit.unwrap_or_default(),
        doubt: found.doubt,
        ..Channel::of(signal)
    })
}

fn failed(wrong: Wrong) -> ReadError {
    match wrong {
        Wrong::Io { path, error } => ReadError::Io { path, error },
        Wrong::Content { path, fault, .. } => ReadError::fault(&path, &fault),
    }
}

/// The only file `.mme` of a folder.
fn the_only(folder: &Path) -> Result<PathBuf, ReadError> {
    let is_mme = |path: &PathBuf| {
        path.extension()
            .is_some_and(|other| other.eq_ignore_ascii_case("mme"))
    };
    let all = std::fs::read_dir(folder).and_then(|entries| {
        let all = entries.map(|entry| entry.map(|entry| entry.path()));
        all.collect::<io::Result<Vec<PathBuf>>>()
    });
    let mut found = all.map_err(|error| ReadError::io(folder, error))?;
    found.retain(is_mme);
    let message = match found.as_slice() {
        [one] => return Ok(one.clone()),
        [] => "there is no file .mme in this folder",
        _ => "there are several files .mme in this folder: name one",
    };
    Err(ReadError::content(folder, 1, message))
}

#[cfg(test)]
mod tests;
