//! Checks the places that a command writes to: no two results go to one place, no result to a file that the command
//! reads, and none to a file that this program did not write, unless the user forces this.

use super::Error;
use crate::files;
use crate::picture::Format;
use crate::signature::{self, ContentKind};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::{Component, Path, PathBuf};

/// The places that are already taken.
#[derive(Debug, Default)]
pub struct Outputs {
    taken: Vec<(PathBuf, String)>,
    read: Vec<PathBuf>,
    replacing: Replacing,
}

/// Whether any file may be replaced.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct Replacing {
    /// Replace files that bryant did not write, too
    #[arg(long)]
    pub force: bool,
}

/// The file that discards everything that is written to it.
pub const NOWHERE: &str = match cfg!(windows) {
    true => "NUL",
    false => "/dev/null",
};

impl Outputs {
    /// Begins with no places taken, for a command that reads the files `read`.
    pub fn of<'a>(read: impl IntoIterator<Item = &'a PathBuf>, replacing: Replacing) -> Self {
        Outputs {
            taken: Vec::new(),
            read: read.into_iter().map(|path| files::place(path)).collect(),
            replacing,
        }
    }

    /// Reserves the place of a page that `--report` writes.
    ///
    /// # Errors
    /// As for [`take`](Self::take); a page is not printed.
    pub fn take_report(&mut self, path: &Path) -> Result<(), Error> {
        if is_standard(path) {
            return Err(Error::Input(
                "--report -: a report is a page for a browser and is not printed\n  help: name a file, as --report run.html".into(),
            ));
        }
        self.take("--report", path, ContentKind::Report)
    }

    /// Reserves the place of a result, which is the value of `option` or its default. Must be called before results are
    /// computed.
    ///
    /// # Errors
    /// Another result goes to this place, the command reads this file, or this program did not write the file.
    pub fn take(&mut self, option: &str, path: &Path, kind: ContentKind) -> Result<(), Error> {
        let place = match is_standard(path) {
            true => PathBuf::from("-"),
            false => files::place(path),
        };
        if place == Path::new(NOWHERE) || path == Path::new(NOWHERE) {
            return Ok(());
        }
        if cfg!(windows) {
            exists_on_windows(option, path)?;
        }
        if let Some((_, other)) = self.taken.iter().find(|(taken, _)| *taken == place) {
            let what = match is_standard(path) {
                true => "standard output".to_owned(),
                false => path.display().to_string(),
            };
            return Err(Error::Input(format!(
                "{other} and {option} both write to {what}\n  help: choose one of them, or give each a place of its own"
            )));
        }
        if self.read.contains(&place) {
            return Err(Error::Input(format!(
                "{option} would write to {}, which is read\n  help: name another file",
                path.display()
            )));
        }
        if kind.contradicts(path) {
            return Err(Error::Input(format!(
                "{option} writes {}, and the name {} says otherwise\n  help: let the name end in .{}",
                kind.name(),
                path.display(),
                kind.endings()[0]
            )));
        }
        self.may_replace(option, path, kind)?;
        self.taken.push((place, option.to_owned()));
        Ok(())
    }

    fn may_replace(&self, option: &str, path: &Path, kind: ContentKind) -> Result<(), Error> {
        if self.replacing.force || is_standard(path) {
            return Ok(());
        }
        let may = signature::may_replace(path, kind).map_err(|error| {
            Error::System(format!("cannot look at {}: {error}", path.display()))
        })?;
        match may {
            true => Ok(()),
            false => Err(Error::Input(format!(
                "{option} would replace {}, which bryant did not write{}\n  help: name another file, or give --force",
                path.display(),
                match kind {
                    ContentKind::Model => ", or which was changed since",
                    _ => "",
                }
            ))),
        }
    }
}

/// Refuses a name that Windows does not allow for files.
pub fn exists_on_windows(option: &str, path: &Path) -> Result<(), Error> {
    for part in path.components() {
        let Component::Normal(name) = part else {
            continue;
        };
        if let Some(reason) = files::refusal_of_windows(&name.to_string_lossy()) {
            return Err(Error::Input(format!(
                "{option} would write to {}, and \"{}\" {reason}\n  help: name another file",
                path.display(),
                name.to_string_lossy().escape_debug()
            )));
        }
    }
    Ok(())
}

/// True if a path stands for standard output.
pub fn is_standard(path: &Path) -> bool {
    // other names of standard output lead to standard error here, because standard output was moved out of reach of
    // user forces
    ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"]
        .iter()
        .any(|name| path == Path::new(name))
}

/// Reads the format of pictures.
pub fn format() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::ALL.map(Format::ending))
        .map(|name| Format::named(&name).unwrap_or_default())
}

/// Reads the path of a picture; its extension determines the format.
pub fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match is_standard(&path) || Format::of(&path).is_some() {
        true => Ok(path),
        false => Err(
            "a picture is written as .svg or as .png\n  help: name a file that ends so, or - for SVG on standard output".into(),
        ),
    }
}
