//! Engines in files: the derived lists of a model, so that loading needs neither the description nor a derivation.
//!
//! A file is a line with the version, the form of lists and the length of the rest, the SHA-256 of the rest, and the
//! rest: [`Lists`] as [postcard](https://postcard.jamesmunns.com/wire-format).

use crate::model::{Engine, Error};
use bryant_generator::program::{FORM, Lists};
use sha2::{Digest, Sha256};

/// The first line of a file, without the version.
const HEAD: &str = "bryant engine ";

/// The version whose files this one reads: lists differ from version to version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Length of a SHA-256.
const DIGEST: usize = 32;

/// Why the content of a file is not an engine.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum KeptError {
    /// It does not begin as [`Engine::keep`] writes it.
    Other,
    /// It was written by another version of this program, or by another build of this version, whose lists may have
    /// another form.
    Version {
        /// The version.
        written_by: String,
    },
    /// It is incomplete, or something has changed it.
    Damaged,
    /// The engine could not be made.
    Engine(Error),
}

impl std::fmt::Display for KeptError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            KeptError::Other => write!(f, "this is no kept engine"),
            KeptError::Version { written_by } if written_by == VERSION => write!(
                f,
                "the engine was kept by another build of version {VERSION}: keep it again from its model"
            ),
            KeptError::Version { written_by } => write!(
                f,
                "the engine was kept by version {written_by}, and this is {VERSION}: keep it again from its model"
            ),
            KeptError::Damaged => write!(
                f,
                "the kept engine is damaged: keep it again from its model"
            ),
            KeptError::Engine(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for KeptError {}

impl Engine {
    /// The engine as the content of a file that [`Engine::of_kept`] reads. Functions of the user are not in it.
    pub fn keep(&self) -> Vec<u8> {
        let lists = postcard::to_allocvec(self.lists())
            .unwrap_or_else(|error| unreachable!("lists are plain data: {error}"));
        let mut content = format!("{HEAD}{VERSION} {FORM:016x} {}\n", lists.len()).into_bytes();
        content.extend(Sha256::digest(&lists));
        content.extend(lists);
        content
    }

    /// The engine that was kept, with its functions. A file that someone has made on purpose may do anything, like any
    /// program: take it only from where you would take a program.
    ///
    /// # Errors
    /// Another content, one of another version, a damaged one; a model with functions of the user, which need a
    /// compiler.
    pub fn of_kept(content: &[u8]) -> Result<Self, KeptError> {
        match <[Self; 1]>::try_from(Self::all_of_kept(content)?) {
            Ok([engine]) => Ok(engine),
            Err(_) => Err(KeptError::Damaged),
        }
    }

    /// The engines in a file of several, one behind the other.
    ///
    /// # Errors
    /// Those of [`of_kept`](Self::of_kept).
    pub fn all_of_kept(mut content: &[u8]) -> Result<Vec<Self>, KeptError> {
        let mut engines = Vec::new();
        while !content.is_empty() || engines.is_empty() {
            let lists;
            (lists, content) = first(content)?;
            engines.push(Self::new(lists).map_err(KeptError::Engine)?);
        }
        Ok(engines)
    }
}

/// The lists at the beginning of a file, and what is behind them.
fn first(content: &[u8]) -> Result<(Lists, &[u8]), KeptError> {
    let rest = content.strip_prefix(HEAD.as_bytes());
    let rest = rest.ok_or(KeptError::Other)?;
    let end = rest.iter().position(|&byte| byte == b'\n');
    let (line, rest) = rest.split_at(end.ok_or(KeptError::Damaged)?);
    let line = String::from_utf8_lossy(line);
    let mut words = line.split(' ');
    let mut word = || words.next().unwrap_or_default();
    let (version, form, length) = (word(), word(), word());
    if version != VERSION || form != format!("{FORM:016x}") {
        return Err(KeptError::Version {
            written_by: version.to_owned(),
        });
    }
    let parts = || {
        let (digest, rest) = rest[1..].split_at_checked(DIGEST)?;
        let (lists, behind) = rest.split_at_checked(length.parse().ok()?)?;
        let whole = digest == &Sha256::digest(lists)[..];
        whole.then(|| {
            postcard::from_bytes(lists)
                .ok()
                .map(|lists| (lists, behind))
        })?
    };
    parts().ok_or(KeptError::Damaged)
}
