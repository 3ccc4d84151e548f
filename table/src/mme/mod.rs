//! Reads tests in ISO-MME (ISO/TS 13499): a file `TEST.mme` describes the test. Beside it, a folder `Channel` has the
//! list `TEST.chn` and a file for each channel, `TEST.001` and so on.
//!
//! A file has lines `key :value`. In a channel file, the lines without a key are the samples. `NOVALUE` stands for an
//! unknown value; as a sample it is NaN. The samples of a channel are at equal intervals from the time of the first one
//! (`implicit`), or at the times that another channel lists (`explicit`).
//!
//! Recordings and the curves of models are read by these rules. What contradicts itself is damage with its place: a
//! channel of the list without a file, a file with another code than in the list, a key with two values, a number of
//! samples that is not theirs, a gap between samples. A curve of a model is refused if any file of its test is damaged;
//! a recording goes without a channel that is damaged, as long as it is known which one that is.

mod lines;

use crate::unit::{Unit, product, spelled};
use crate::{Fault, Field};
use lines::{Lines, Pair};
use std::fmt;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The text for an unknown value.
pub const NOVALUE: &str = "NOVALUE";

/// Largest number of channels of a test, because the extension of a channel file has three digits.
pub const MOST_CHANNELS: usize = 999;

/// Values of the key `Data status` for usable data. The standard also has `channel failed`, `no data`, `meaningless
/// data` and `questionable data`.
const SOUND: [&str; 5] = [
    "ok",
    "good",
    "valid",
    "scaling factor applied",
    "linearised data",
];

/// Returns the text of a file.
pub type Loader<'l> = dyn Fn(&Path) -> io::Result<String> + 'l;

/// The text of a file of a test: UTF-8, or ISO 8859-1 if it is not valid UTF-8.
pub fn decoded(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap_or_else(|error| {
        // each byte of ISO 8859-1 is the character with the same number
        error.into_bytes().into_iter().map(char::from).collect()
    })
}

/// True if the name of a channel is a channel code: 16 capital letters and digits.
pub fn is_code(name: &str) -> bool {
    let fits = |byte: u8| byte.is_ascii_uppercase() || byte.is_ascii_digit();
    name.len() == 16 && name.bytes().all(fits)
}

/// Why a test or a channel cannot be read.
#[derive(Debug)]
pub enum Wrong {
    /// A file cannot be read.
    Io {
        /// The file.
        path: PathBuf,
        /// The error.
        error: io::Error,
    },
    /// The content of a file is wrong.
    Content {
        /// The file.
        path: PathBuf,
        /// Its text.
        text: String,
        /// The error, with its place and the remedy.
        fault: Fault,
    },
}

/// A damaged channel.
#[derive(Debug)]
pub struct Damage {
    /// The names that the channel may have: its code in its file, that in the list of channels, its title.
    pub names: Vec<String>,
    /// What is wrong.
    pub wrong: Wrong,
}

/// Why no channel could be found by a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoChannel {
    /// No channel has this name or title.
    Unknown,
    /// This many channels have the name or title.
    Several(usize),
}

impl std::error::Error for NoChannel {}

impl fmt::Display for NoChannel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoChannel::Unknown => f.write_str("no channel has this name"),
            NoChannel::Several(count) => write!(f, "{count} channels have this name"),
        }
    }
}

/// The index of the channel with this name; if there is none, that of the channel with this title. `all` are the names
/// and titles of the channels.
///
/// # Errors
/// There is no such channel, or there are several.
pub fn find(all: &[(&str, &str)], wanted: &str) -> Result<usize, NoChannel> {
    let by = |is: &dyn Fn(&(&str, &str)) -> bool| {
        let fitting = all.iter().enumerate().filter(|(_, one)| is(one));
        fitting.map(|(index, _)| index).collect::<Vec<usize>>()
    };
    let found = match by(&|one| one.0 == wanted) {
        found if found.is_empty() => by(&|one| one.1 == wanted),
        found => found,
    };
    match found.as_slice() {
        [] => Err(NoChannel::Unknown),
        [one] => Ok(*one),
        several => Err(NoChannel::Several(several.len())),
    }
}

/// The times of samples \[s\].
#[derive(Clone, Debug, PartialEq)]
pub enum Times {
    /// At equal intervals: the first time, and the positive interval.
    Even(f64, f64),
    /// Of a channel with times: one for each sample, increasing.
    Listed(Vec<f64>),
}

/// The samples of a channel, with what its file says about them.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The unit as it is written; `None` if it is unknown.
    pub unit: Option<String>,
    /// The line of the unit, from 1.
    pub unit_line: usize,
    /// The status of the data, if it casts doubt on them.
    pub doubt: Option<String>,
    /// The times of the samples.
    pub times: Times,
    /// The samples. NaN stands for a missing one. There are none only if the data are in doubt.
    pub values: Vec<f64>,
    /// The line of the first sample, from 1; the others are in the lines below.
    pub line: usize,
}

/// A test: its channel files, without those that list times.
#[derive(Debug)]
pub struct Test {
    /// The file `TEST.mme`, and the list of channels if there is one.
    about: Vec<PathBuf>,
    files: Vec<File>,
    /// Indices of the files that are channels.
    channels: Vec<usize>,
    /// Channels whose files are missing, or contradict themselves or the list.
    damaged: Vec<Damage>,
}

/// A channel file.
#[derive(Debug)]
struct File {
    path: PathBuf,
    lines: Lines,
    /// The channel code, in capital letters; "" if there is none.
    code: String,
    name: String,
    title: String,
}

/// The list of channels: its file, and the channels with their numbers and codes.
struct List {
    path: PathBuf,
    lines: Lines,
    entries: Vec<(u32, String, Pair)>,
}

impl Test {
    /// Reads a test by its file `TEST.mme`: the list of channels and the heads of their files. The case of the name
    /// `Channel`, and of the names of the files in it, does not matter as long as it is the same for all letters.
    ///
    /// # Errors
    /// A file cannot be read, the list contradicts itself, or it is not known which channel is damaged.
    pub fn read(mme: &Path, loader: &Loader<'_>) -> Result<Test, Wrong> {
        let mut test = Test {
            about: vec![mme.to_owned()],
            files: Vec::new(),
            channels: Vec::new(),
            damaged: Vec::new(),
        };
        let lines = required(mme, loader)?;
        let (list, files) = found(mme, loader)?;
        let numbers: Vec<u32> = files.iter().map(|(number, ..)| *number).collect();
        for (number, path, text) in files {
            let listed = list.as_ref().and_then(|list| list.code(number));
            match File::of(path, text, listed) {
                Ok(file) => test.files.push(file),
                Err(damage) if damage.names.is_empty() => return Err(damage.wrong),
                Err(damage) => test.damaged.push(*damage),
            }
        }
        if let Some(list) = list {
            test.damaged.extend(list.missing(&numbers)?);
            test.about.push(list.path);
        }
        let is_time = |index: &usize| test.files[*index].code.get(2..6) == Some("TIRS");
        test.channels = (0..test.files.len()).filter(|i| !is_time(i)).collect();
        match test.channels.is_empty() {
            true if !test.damaged.is_empty() => Err(test.damaged.remove(0).wrong),
            true => Err(lines.wrong(
                mme,
                (1, 1, 1),
                "there is no channel of this test in the folder `Channel` beside it",
                "the files of its channels have its name and a number: TEST.001, TEST.002, …",
            )),
            false => Ok(test),
        }
    }

    /// The test, if no channel is damaged.
    ///
    /// # Errors
    /// A channel is damaged.
    pub fn whole(mut self) -> Result<Test, Wrong> {
        match self.damaged.is_empty() {
            true => Ok(self),
            false => Err(self.damaged.remove(0).wrong),
        }
    }

    /// Takes the channels whose files are missing, or contradict themselves or the list.
    pub fn take_damaged(&mut self) -> Vec<Damage> {
        std::mem::take(&mut self.damaged)
    }

    /// Names and titles of the channels. The name is the channel code; of a channel without one, the title or the name
    /// of its file.
    pub fn names(&self) -> Vec<(&str, &str)> {
        let files = self.channels.iter().map(|index| &self.files[*index]);
        files.map(|f| (f.name.as_str(), f.title.as_str())).collect()
    }

    /// The path and the text of the file of a channel, by the index of the channel.
    pub fn file(&self, index: usize) -> (&Path, &str) {
        let file = &self.files[self.channels[index]];
        (&file.path, &file.lines.text)
    }

    /// The files that a channel is read from, by the index of the channel.
    pub fn paths(&self, index: usize) -> Vec<&Path> {
        let file = &self.files[self.channels[index]];
        let times = file.times(&self.files).ok().flatten();
        let own = [Some(file), times].into_iter().flatten();
        let about = self.about.iter();
        about
            .chain(own.map(|file| &file.path))
            .map(PathBuf::as_path)
            .collect()
    }

    /// Reads a channel by its index.
    ///
    /// # Errors
    /// Its file, or that of its times, is wrong.
    pub fn channel(&self, index: usize) -> Result<Channel, Wrong> {
        self.files[self.channels[index]].channel(&self.files)
    }
}

/// The lines of a file that must be there.
fn required(path: &Path, loader: &Loader<'_>) -> Result<Lines, Wrong> {
    let text = loader(path).map_err(|error| Wrong::Io {
        path: path.to_owned(),
        error,
    })?;
    Ok(Lines::of(text))
}

/// The text of a file; `None` if there is no such file.
fn optional(path: &Path, loader: &Loader<'_>) -> Result<Option<String>, Wrong> {
    match loader(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Wrong::Io {
            path: path.to_owned(),
            error,
        }),
    }
}

/// The channel files of a test, with their numbers and texts.
type Files = Vec<(u32, PathBuf, String)>;

/// The list and the channel files of a test, in the spelling that there is.
fn found(mme: &Path, loader: &Loader<'_>) -> Result<(Option<List>, Files), Wrong> {
    let folder = mme.parent().unwrap_or(Path::new(""));
    let stem = mme.file_stem().unwrap_or_default().to_string_lossy();
    let mut stems = vec![stem.to_string(), stem.to_uppercase(), stem.to_lowercase()];
    stems.dedup();
    for inner in ["Channel", "CHANNEL", "channel"] {
        for stem in &stems {
            let beside = |ending: &str| folder.join(inner).join(format!("{stem}.{ending}"));
            let mut list = None;
            for ending in ["chn", "CHN"] {
                if list.is_none()
                    && let Some(text) = optional(&beside(ending), loader)?
                {
                    list = Some(List::of(beside(ending), text)?);
                }
            }
            let mut files = Vec::new();
            for number in 1..=MOST_CHANNELS as u32 {
                let path = beside(&format!("{number:03}"));
                if let Some(text) = optional(&path, loader)? {
                    files.push((number, path, text));
                }
            }
            if list.is_some() || !files.is_empty() {
                return Ok((list, files));
            }
        }
    }
    Ok((None, Vec::new()))
}

impl List {
    fn of(path: PathBuf, text: String) -> Result<List, Wrong> {
        let lines = Lines::of(text);
        let mut list = List {
            path,
            lines,
            entries: Vec::new(),
        };
        for pair in &list.lines.pairs {
            let key = pair.key.to_ascii_lowercase();
            let Some(number) = key.strip_prefix("name of channel") else {
                continue;
            };
            let wrong = |message: String| {
                let help =
                    "the list has a line `Name of channel 001 :CODE / words` for each channel";
                list.lines.wrong(&list.path, pair.place, message, help)
            };
            let number: u32 = number
                .trim()
                .parse()
                .map_err(|_| wrong(format!("`{}` has no number", pair.key)))?;
            if list.entries.iter().any(|(other, ..)| *other == number) {
                return Err(wrong(format!("the list has the channel {number:03} twice")));
            }
            let code = pair.value.split('/').next().unwrap_or_default().trim();
            list.entries
                .push((number, code.to_ascii_uppercase(), pair.clone()));
        }
        Ok(list)
    }

    /// The code of the channel with this number; `None` if the list does not say one.
    fn code(&self, number: u32) -> Option<&str> {
        let entry = self.entries.iter().find(|(other, ..)| *other == number);
        entry
            .map(|(_, code, _)| code.as_str())
            .filter(|code| is_code(code))
    }

    /// The channels of the list of which there is no file; `there` are the numbers of the files.
    fn missing(&self, there: &[u32]) -> Result<Vec<Damage>, Wrong> {
        let help = "look whether the test is complete, or take what is not there off the list";
        let wrong =
            |pair: &Pair, message: String| self.lines.wrong(&self.path, pair.place, message, help);
        let mut damaged = Vec::new();
        for (number, code, pair) in &self.entries {
            if !there.contains(number) {
                let wrong = wrong(
                    pair,
                    format!("there is no file .{number:03} of this channel"),
                );
                match is_code(code) {
                    true => damaged.push(Damage {
                        names: vec![code.clone()],
                        wrong,
                    }),
                    false => return Err(wrong),
                }
            }
        }
        let Some(pair) = self.lines.pair(&self.path, "Number of channels")? else {
            return Ok(damaged);
        };
        // those that the list names are counted
        let (files, known) = (there.len(), there.len() + damaged.len());
        match pair.value.parse::<usize>() {
            Ok(count) if count > known => Err(wrong(
                pair,
                format!("the list has {count} channels, but there are {files} files"),
            )),
            _ => Ok(damaged),
        }
    }
}

impl File {
    /// A channel file, whose code in the list is `listed`.
    fn of(path: PathBuf, text: String, listed: Option<&str>) -> Result<File, Box<Damage>> {
        let lines = Lines::of(text);
        let damage = |names: &[&str], wrong: Wrong| {
            let names = names.iter().filter(|name| !name.is_empty());
            let mut names: Vec<String> = names.map(|name| (*name).to_owned()).collect();
            names.dedup();
            Box::new(Damage { names, wrong })
        };
        let own = lines.pair(&path, "Channel code");
        let own = own.map_err(|wrong| damage(&[listed.unwrap_or_default()], wrong))?;
        let code = match own {
            // some programs write codes in lower case
            Some(pair) if is_code(&pair.value.to_ascii_uppercase()) => {
                pair.value.to_ascii_uppercase()
            }
            Some(pair) => pair.value.clone(),
            None => listed.unwrap_or_default().to_owned(),
        };
        if let (Some(pair), Some(listed)) = (own, listed)
            && is_code(&code)
            && code != listed
        {
            let wrong = lines.wrong(
                &path,
                pair.place,
                format!("the file says that this is {code}, and the list of channels {listed}"),
                "look whether files were exchanged, and correct the one that is wrong",
            );
            return Err(damage(&[&code, listed], wrong));
        }
        let title = match lines.pair(&path, "Customer channel code") {
            Ok(None) => lines.pair(&path, "Name of the channel"),
            found => found,
        };
        let title = title.map_err(|wrong| damage(&[&code], wrong))?;
        let title = title.map_or(String::new(), |pair| pair.value.clone());
        let name = match (code.as_str(), title.as_str()) {
            ("", "") => path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            ("", title) => title.to_owned(),
            (code, _) => code.to_owned(),
        };
        Ok(File {
            path,
            lines,
            code,
            name,
            title,
        })
    }

    fn pair(&self, key: &str) -> Result<Option<&Pair>, Wrong> {
        self.lines.pair(&self.path, key)
    }

    fn wrong(
        &self,
        place: (usize, usize, usize),
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Wrong {
        self.lines.wrong(&self.path, place, message, help)
    }

    /// The finite number of a key that must be there.
    fn number(&self, key: &str) -> Result<f64, Wrong> {
        let help = "samples at equal intervals need the time of the first one and the interval [s]";
        let Some(pair) = self.pair(key)? else {
            return Err(self.wrong((1, 1, 1), format!("`{key}` must be there"), help));
        };
        let number = pair.value.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| {
            let message = format!("`{key}` is `{}`, which is not a number", pair.value);
            self.wrong(pair.place, message, help)
        })
    }

    /// The status of the data, if it casts doubt on them.
    fn doubt(&self) -> Result<Option<String>, Wrong> {
        let status = self.pair("Data status")?.map(|pair| pair.value.as_str());
        let sound = |status: &&str| SOUND.iter().any(|one| one.eq_ignore_ascii_case(status));
        Ok(status.filter(|status| !sound(status)).map(str::to_owned))
    }

    /// The samples, with the line of the first one.
    fn samples(&self) -> Result<(Vec<f64>, usize), Wrong> {
        let data: Vec<Field<'_>> = self.lines.data().collect();
        let mut values = Vec::with_capacity(data.len());
        for (index, field) in data.iter().enumerate() {
            let place = (field.line, field.column, field.length);
            if field.line != data[0].line + index {
                let message = "the line above is empty, so that a sample may be missing";
                let help = "remove the line, or write NOVALUE for a sample that is missing";
                return Err(self.wrong(place, message, help));
            }
            values.push(match field.text {
                NOVALUE => f64::NAN,
                text => match field.number() {
                    Ok(Some(number)) if !number.is_infinite() => number,
                    Err(fault) if text.contains(',') => {
                        return Err(self.wrong(place, fault.message, fault.help));
                    }
                    _ => {
                        let message =
                            format!("`{text}` is neither a number nor a line `key :value`");
                        let help = "behind the lines `key :value`, each line has one sample";
                        return Err(self.wrong(place, message, help));
                    }
                },
            });
        }
        if let Some(pair) = self.pair("Number of samples")?
            && pair.value.parse() != Ok(values.len() as f64)
        {
            let message = format!(
                "the file says that it has {} samples, but has {}",
                pair.value,
                values.len()
            );
            let help = "look whether the file is whole";
            return Err(self.wrong(pair.place, message, help));
        }
        Ok((values, data.first().map_or(1, |field| field.line)))
    }

    /// The file with the times of this channel; `None` if its samples are at equal intervals.
    fn times<'f>(&self, all: &'f [File]) -> Result<Option<&'f File>, Wrong> {
        let kind = self.pair("Reference channel")?;
        let name = self.pair("Reference channel name")?;
        let is = |word: &str| kind.is_some_and(|kind| kind.value.eq_ignore_ascii_case(word));
        let help = "`Reference channel` is `implicit`, or `explicit` with the code of the channel of times as `Reference channel name`";
        let name = match (kind, name) {
            (None, None) => return Ok(None),
            _ if is("implicit") => return Ok(None),
            (Some(kind), _) if !is("explicit") => {
                let message = format!("`Reference channel` is `{}`", kind.value);
                return Err(self.wrong(kind.place, message, help));
            }
            (_, Some(name)) => name,
            (Some(kind), None) => {
                let message = "it is not said which channel has the times";
                return Err(self.wrong(kind.place, message, help));
            }
        };
        let fits = |file: &&File| file.code.eq_ignore_ascii_case(&name.value);
        let found: Vec<&File> = all.iter().filter(fits).collect();
        let message = match found.as_slice() {
            [one] => return Ok(Some(one)),
            [] => format!(
                "its times are those of the channel `{}`, which does not exist",
                name.value
            ),
            _ => format!(
                "its times are those of the channel `{}`, and {} channels have this code",
                name.value,
                found.len()
            ),
        };
        Err(self.wrong(name.place, message, help))
    }

    fn channel(&self, all: &[File]) -> Result<Channel, Wrong> {
        let doubt = self.doubt()?;
        let (values, line) = self.samples()?;
        if values.is_empty() && doubt.is_none() {
            let help = "look whether the file is whole";
            return Err(self.wrong((1, 1, 1), "the channel has no samples", help));
        }
        let times = match self.times(all)? {
            None => {
                let (first, interval) = (
                    self.number("Time of first sample")?,
                    self.number("Sampling interval")?,
                );
                if interval <= 0.0 {
                    let place = self
                        .pair("Sampling interval")?
                        .map_or((1, 1, 1), |p| p.place);
                    let message = format!("the sampling interval is {interval} s");
                    let help = "write the time from one sample to the next, in seconds";
                    return Err(self.wrong(place, message, help));
                }
                Times::Even(first, interval)
            }
            Some(file) => {
                let times = file.seconds()?;
                if times.len() != values.len() {
                    let (own, given) = (values.len(), times.len());
                    let message = format!(
                        "its samples are {own}, and its times in {} {given}",
                        file.code
                    );
                    let help = "look whether both files are whole";
                    return Err(self.wrong((1, 1, 1), message, help));
                }
                Times::Listed(times)
            }
        };
        let unit = self.pair("Unit")?;
        Ok(Channel {
            unit: unit.map(|pair| pair.value.clone()),
            unit_line: unit.map_or(1, |pair| pair.place.0),
            doubt,
            times,
            values,
            line,
        })
    }

    /// The samples as times in seconds.
    fn seconds(&self) -> Result<Vec<f64>, Wrong> {
        if let Some(doubt) = self.doubt()? {
            let place = self.pair("Data status")?.map_or((1, 1, 1), |p| p.place);
            let message = format!("these times cannot be used: `{doubt}`");
            let help = "if you know that they are sound, write `Data status :ok`";
            return Err(self.wrong(place, message, help));
        }
        let factor = match self.pair("Unit")? {
            None => 1.0,
            Some(pair) => {
                let of_time = |unit: Unit| unit.dimension.name() == "s";
                let unit = product(spelled(&pair.value)).filter(|unit| of_time(*unit));
                let unit = unit.ok_or_else(|| {
                    let message = format!("`{}` is no unit of time", pair.value);
                    self.wrong(
                        pair.place,
                        message,
                        "write the unit of the times: `Unit :ms`",
                    )
                })?;
                unit.factor
            }
        };
        let (values, line) = self.samples()?;
        let times: Vec<f64> = values.iter().map(|time| time * factor).collect();
        // a missing time is not later than another one
        let is_later = |i: usize| i == 0 || times[i] > times[i - 1];
        match (0..times.len()).find(|i| times[*i].is_nan() || !is_later(*i)) {
            None => Ok(times),
            Some(index) => Err(self.wrong(
                (line + index, 1, 1),
                "this time is missing, or not later than the one above",
                "times increase from sample to sample",
            )),
        }
    }
}
