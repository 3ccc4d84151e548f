//! Reads ISO-MME.

use super::is_code;
use super::lines::{Lines, NOVALUE};
use crate::{Channel, ReadError, Recording, Signal, unit};
use std::path::{Path, PathBuf};

/// Values of the key `Data status` for usable data. The standard also has `channel failed`, `no data`, `meaningless
/// data` and `questionable data`.
const SOUND: [&str; 5] = [
    "ok",
    "good",
    "valid",
    "scaling factor applied",
    "linearised data",
];

/// Reads a test by its file `TEST.mme`, or by a folder with one such file.
///
/// # Errors
/// A file is missing or has an error; the message has its line.
pub fn read(path: &Path) -> Result<Recording, ReadError> {
    let about = match path.is_dir() {
        true => the_only(path, "mme")?,
        false => path.to_owned(),
    };
    // an error in this file is reported first, before a missing file beside it
    Lines::read(&about)?;
    let folder = about.parent().unwrap_or(Path::new("."));
    let channels = in_any_case(folder, "Channel");
    let stem = about.file_stem().unwrap_or_default().to_owned();
    let mut files: Vec<(u32, PathBuf)> = Vec::new();
    for entry in entries(&channels)? {
        let number = entry.extension().and_then(|extension| extension.to_str());
        let number = number
            .filter(|text| text.len() >= 3)
            .and_then(|text| text.parse().ok());
        let same = entry
            .file_stem()
            .is_some_and(|other| other.eq_ignore_ascii_case(&stem));
        if let (Some(number), true) = (number, same) {
            files.push((number, entry));
        }
    }
    files.sort();
    let mut written = Vec::new();
    for (_, file) in &files {
        written.push(Written::read(file)?);
    }
    let mut found = Recording::default();
    for one in &written {
        if one.is_time() {
            continue;
        }
        found.channels.push(one.channel(&written)?);
    }
    match found.channels.is_empty() {
        true => Err(ReadError::content(
            &about,
            1,
            format!("there is no channel of this test in {}", channels.display()),
        )),
        false => Ok(found),
    }
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let failed = |error| ReadError::Io {
        path: folder.to_owned(),
        error,
    };
    let listed = std::fs::read_dir(folder).map_err(failed)?;
    listed
        .map(|entry| entry.map(|entry| entry.path()).map_err(failed))
        .collect()
}

/// The only file of a folder with this extension.
fn the_only(folder: &Path, extension: &str) -> Result<PathBuf, ReadError> {
    let has = |path: &PathBuf| {
        path.extension()
            .is_some_and(|other| other.eq_ignore_ascii_case(extension))
    };
    let found: Vec<PathBuf> = entries(folder)?.into_iter().filter(has).collect();
    match found.as_slice() {
        [one] => Ok(one.clone()),
        [] => Err(ReadError::content(
            folder,
            1,
            format!("there is no file .{extension} in this folder"),
        )),
        _ => Err(ReadError::content(
            folder,
            1,
            format!("there are several files .{extension} in this folder: name one"),
        )),
    }
}

/// The entry of a folder with this name, whose case does not matter; the name as given if there is none.
fn in_any_case(folder: &Path, name: &str) -> PathBuf {
    let same = |path: &PathBuf| {
        path.file_name()
            .is_some_and(|other| other.eq_ignore_ascii_case(name))
    };
    let entries = entries(folder).unwrap_or_default();
    entries
        .into_iter()
        .find(same)
        .unwrap_or_else(|| folder.join(name))
}

/// A channel file.
struct Written {
    path: PathBuf,
    lines: Lines,
    values: Vec<f64>,
}

impl Written {
    fn read(path: &Path) -> Result<Written, ReadError> {
        let lines = Lines::read(path)?;
        let mut values = Vec::with_capacity(lines.data.len());
        for (line, text) in &lines.data {
            values.push(match text.as_str() {
                NOVALUE => f64::NAN,
                text => text.parse().map_err(|_| {
                    ReadError::content(
                        path,
                        *line,
                        format!("`{text}` is neither a number nor a line `key :value`"),
                    )
                })?,
            });
        }
        let written = Written {
            path: path.to_owned(),
            lines,
            values,
        };
        if let Some(count) = written.number("Number of samples")?
            && count != written.values.len() as f64
        {
            let message = format!(
                "the file says that it has {count} samples, but has {}",
                written.values.len()
            );
            return Err(written.wrong(message));
        }
        Ok(written)
    }

    fn wrong(&self, message: impl Into<String>) -> ReadError {
        ReadError::content(&self.path, 1, message)
    }

    fn number(&self, key: &str) -> Result<Option<f64>, ReadError> {
        let parsed = self.lines.value(key).map(|text| {
            let wrong = || self.wrong(format!("`{key}` is `{text}`, which is not a number"));
            text.parse::<f64>().map_err(|_| wrong())
        });
        parsed.transpose()
    }

    fn code(&self) -> &str {
        self.lines.value("Channel code").unwrap_or_default()
    }

    /// True if the channel lists the times of other channels.
    fn is_time(&self) -> bool {
        self.code().get(2..6) == Some("TIRS")
    }

    fn channel(&self, all: &[Written]) -> Result<Channel, ReadError> {
        let explicit = self
            .lines
            .value("Reference channel")
            .is_some_and(|value| value.eq_ignore_ascii_case("explicit"));
        let signal = match explicit {
            false => self.evenly()?,
            true => {
                let name = self
                    .lines
                    .value("Reference channel name")
                    .unwrap_or_default();
                let times = all.iter().find(|other| other.code() == name);
                let times = times.ok_or_else(|| {
                    self.wrong(format!(
                        "its times are those of the channel `{name}`, which does not exist"
                    ))
                })?;
                let signal = Signal::of_samples(&times.times()?, &self.values);
                signal.ok_or_else(|| {
                    self.wrong(
                        "its times are not as many as its samples, or not at equal intervals",
                    )
                })?
            }
        };
        let own = self.lines.value("Customer channel code");
        let title = own.or_else(|| self.lines.value("Name of the channel"));
        let file = self.path.file_name().unwrap_or_default().to_string_lossy();
        let name = match self.code() {
            "" => title.map_or(file.into_owned(), str::to_owned),
            // some programs write codes in lower case
            code if is_code(&code.to_ascii_uppercase()) => code.to_ascii_uppercase(),
            code => code.to_owned(),
        };
        Ok(Channel {
            name,
            title: title.unwrap_or_default().to_owned(),
            unit: self.lines.value("Unit").unwrap_or_default().to_owned(),
            doubt: self.doubt(),
            signal,
        })
    }

    /// The samples as times in seconds.
    fn times(&self) -> Result<Vec<f64>, ReadError> {
        let code = self.code();
        if let Some(doubt) = self.doubt() {
            return Err(self.wrong(format!("the times of {code} cannot be used: {doubt}")));
        }
        let said = self.lines.value("Unit").unwrap_or("s");
        let factor = unit::factor(said, "s").ok_or_else(|| {
            self.wrong(format!(
                "the unit of the times of {code} is `{said}`, which is no unit of time"
            ))
        })?;
        Ok(self.values.iter().map(|time| time * factor).collect())
    }

    /// The status of the data, if it casts doubt on them.
    fn doubt(&self) -> Option<String> {
        let status = self.lines.value("Data status")?;
        let sound = SOUND.iter().any(|sound| sound.eq_ignore_ascii_case(status));
        (!sound).then(|| status.to_owned())
    }

    fn evenly(&self) -> Result<Signal, ReadError> {
        let interval = self.number("Sampling interval")?;
        let interval = interval.filter(|interval| *interval > 0.0 && interval.is_finite());
        Ok(Signal {
            first: self.number("Time of first sample")?.unwrap_or(0.0),
            interval: interval
                .ok_or_else(|| self.wrong("`Sampling interval` must be there and positive [s]"))?,
            values: self.values.clone(),
        })
    }
}
