//! Data in a folder of results that allow merging without other files: the study as it was given, the file with its
//! rows if there is one, and the facts about its model.

use bryant_generator::description::load::read_bytes;
use bryant_generator::diagnostic::Diagnostics;
use bryant_study::facts::ModelFacts;
use bryant_study::file::StudyFile;
use bryant_study::store::MOST_BYTES;
use bryant_study::store::identity::{Identity, Program};
use bryant_study::store::write::{WriteError, at, replace};
use bryant_study::study::Study;
use std::io;
use std::path::{Component, Path, PathBuf};

/// The study and the program of a folder of results.
#[derive(Debug)]
pub struct Kept {
    /// The study.
    pub study: Study,
    /// The program that computed the results.
    pub program: Program,
}

/// Why a study cannot be read from a folder, or stored in it.
#[derive(Debug, thiserror::Error)]
pub enum KeptError {
    /// The folder has no results.
    #[error("{} is not a folder of results: it has no study.json\n  help: name the folder that `bryant sweep` was given by --out", .0.display())]
    NoResults(PathBuf),
    /// The process that created the folder ended before it stored the study.
    #[error("{} is missing: the command that began here ended before it wrote the file\n  help: run the study on this folder again; what is done stays", .0.display())]
    Lost(PathBuf),
    /// A file cannot be read.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// The content of a file is wrong.
    #[error("{} cannot be understood: {reason}\n  help: run the study again into another folder", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The file with the rows is outside the folder of the study.
    #[error(
        "the rows of the study are in {0}, outside of its folder, so that its results could not be merged without it\n  help: put that file beside the study, and name it without .."
    )]
    Outside(String),
    /// The study does not fit its model.
    #[error("{0}")]
    Study(Diagnostics),
}

const STUDY: &str = "study.yaml";
const FACTS: &str = "facts.json";

/// The directory in a folder of results where the study is stored.
fn place(folder: &Path) -> PathBuf {
    folder.join("study")
}

/// Stores a study with its results, unless it is already there.
///
/// # Errors
/// A file cannot be read or written, or the file with the rows is outside the folder of the study.
pub fn keep(
    folder: &Path,
    file: &StudyFile,
    text: &str,
    facts: &ModelFacts,
    directory: &Path,
) -> Result<(), KeptError> {
    let place = place(folder);
    if let Some(rows) = file.rows_from() {
        let path = Path::new(&rows);
        let plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if path.is_relative() {
            if !path.components().all(plain) {
                return Err(KeptError::Outside(rows));
            }
            let from = directory.join(path);
            let bytes = read_bytes(&from, MOST_BYTES);
            let bytes = bytes.map_err(|source| KeptError::Read { path: from, source })?;
            put(&place.join(path), &bytes)?;
        }
    }
    let facts_path = place.join(FACTS);
    let facts = serde_json::to_string_pretty(facts).map_err(|error| KeptError::Damaged {
        path: facts_path.clone(),
        reason: error.to_string(),
    })?;
    put(&facts_path, format!("{facts}\n").as_bytes())?;
    put(&place.join(STUDY), text.as_bytes())?;
    Ok(())
}

/// Writes a file, unless it exists with the same bytes: a study can then continue in a folder whose existing files
/// cannot be written.
fn put(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    if read_bytes(path, bytes.len() as u64).is_ok_and(|there| there == bytes) {
        return Ok(());
    }
    if let Some(directory) = path.parent() {
        at(directory, std::fs::create_dir_all(directory))?;
    }
    replace(path, |out| at(path, out.write_all(bytes)))
}

impl Kept {
    /// Reads the study of a folder of results.
    ///
    /// # Errors
    /// There are no results, or a file is damaged.
    pub fn read(folder: &Path) -> Result<Kept, KeptError> {
        let identity_path = folder.join("study.json");
        if !identity_path.is_file() {
            return Err(KeptError::NoResults(folder.to_owned()));
        }
        let text = |path: &Path| {
            let bytes = read_bytes(path, MOST_BYTES);
            let text = bytes.and_then(|bytes| String::from_utf8(bytes).map_err(io::Error::other));
            text.map_err(|source| match source.kind() {
                io::ErrorKind::NotFound => KeptError::Lost(path.to_owned()),
                _ => KeptError::Read {
                    path: path.to_owned(),
                    source,
                },
            })
        };
        let damaged = |path: &Path, error: serde_json::Error| KeptError::Damaged {
            path: path.to_owned(),
            reason: error.to_string(),
        };
        let identity: Identity = serde_json::from_str(&text(&identity_path)?)
            .map_err(|error| damaged(&identity_path, error))?;
        let place = place(folder);
        let facts_path = place.join(FACTS);
        let facts: ModelFacts = serde_json::from_str(&text(&facts_path)?)
            .map_err(|error| damaged(&facts_path, error))?;
        let study_path = place.join(STUDY);
        let name = study_path.display().to_string();
        let study = StudyFile::parse(&name, &text(&study_path)?)
            .and_then(|file| file.resolve(&facts, &place))
            .map_err(KeptError::Study)?;
        Ok(Kept {
            study,
            program: Program {
                model: identity.model,
                version: identity.version,
                arithmetic: identity.arithmetic,
            },
        })
    }
}
