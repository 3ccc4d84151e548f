//! Reads models. This is the front door: it knows all kinds of joints, all force laws, and models in YAML and in URDF.

use crate::description::load::{Loaded, read_file};
use crate::diagnostic::Diagnostics;
use crate::joint;
use crate::law::{self, ForceKind};
use crate::model::Model;
use crate::model::annotated_model::AnnotatedModel;
use crate::model::resolve::{self, Kinds, Resolved};
use crate::model_text::read_model;
use std::io;
use std::path::{Path, PathBuf};

/// All kinds of joints, and all force laws.
const KINDS: &Kinds = &Kinds {
    language: LANGUAGE,
    spellings: joint::SPELLINGS,
    words: joint::WORDS,
    laws: law::LAWS,
    outputs: |force| ForceKind::of(force).outputs(),
};

/// The language with all kinds of joints and all force laws.
pub const LANGUAGE: &crate::description::language::Language =
    &crate::description::language::Language {
        joint_keys: joint::KEYS,
        joint_words: joint::WRITTEN_WORDS,
        laws: law::KEYS,
    };

/// Reads a model and the files it includes.
///
/// Returns the model and every file read, the model's own first.
///
/// # Errors
/// Every problem found, with its place.
pub fn read(path: &Path) -> Result<(Model, Vec<PathBuf>), Diagnostics> {
    let read = read_model(path)?;
    read_str(&read.name, &read.text, &read_file).map_err(|found| read.in_file(found))
}

/// Reads a model from text. `loader` returns the text of included files.
///
/// `name` is the name of the file in messages. Paths of included files are relative to it: a model `models/sled.yaml`
/// that includes `data/child.yaml` asks `loader` for `models/data/child.yaml`. Returns the model and the names of the
/// files read.
///
/// # Errors
/// Every problem found, with its place.
pub fn read_str(
    name: &str,
    text: &str,
    loader: &dyn Fn(&Path) -> io::Result<String>,
) -> Result<(Model, Vec<PathBuf>), Diagnostics> {
    let (resolved, loaded) = resolve(name, text, loader, true)?;
    Ok((resolved.model, loaded.paths))
}

/// Reads a model from text that includes no files.
///
/// # Errors
/// Every problem found, with its place.
pub fn check_str(text: &str) -> Result<(), Diagnostics> {
    let nothing = |_: &Path| Err(io::ErrorKind::NotFound.into());
    read_str("model.yaml", text, &nothing).map(drop)
}

/// Like [`read`], but without the Rust files of user forces, which may be missing: for writing these files.
///
/// # Errors
/// Every other problem found, with its place.
pub fn read_without_sources(
    name: &str,
    text: &str,
    loader: &dyn Fn(&Path) -> io::Result<String>,
) -> Result<Model, Diagnostics> {
    resolve(name, text, loader, false).map(|(resolved, _)| resolved.model)
}

/// Reads a model like [`read`], together with the places of its parts.
///
/// # Errors
/// Every problem found, with its place.
pub fn read_annotated(path: &Path) -> Result<AnnotatedModel, Diagnostics> {
    let text = read_model(path)?;
    let mut scene = read_annotated_str(&text.name, &text.text, &read_file)
        .map_err(|found| text.in_file(found))?;
    scene.notes = text.notes().to_vec();
    if !text.is_of_file() {
        scene.turn_lines(|line| text.line_of_file(line));
    }
    Ok(scene)
}

/// Reads a model from text like [`read_str`], together with the places of its parts.
///
/// # Errors
/// Every problem found, with its place.
pub fn read_annotated_str(
    name: &str,
    text: &str,
    loader: &dyn Fn(&Path) -> io::Result<String>,
) -> Result<AnnotatedModel, Diagnostics> {
    let (resolved, loaded) = resolve(name, text, loader, true)?;
    Ok(AnnotatedModel::of(resolved, loaded))
}

fn resolve(
    name: &str,
    text: &str,
    loader: &dyn Fn(&Path) -> io::Result<String>,
    with_sources: bool,
) -> Result<(Resolved, Loaded), Diagnostics> {
    resolve::resolve(KINDS, name, text, loader, with_sources)
}
