//! The argument MODEL: the name of a bundled model, or the path of a YAML or URDF file.

use super::Error;
use super::terminal::Terminal;
use crate::bundled::{self, Bundled};
use bryant_generator::description::load::{beside, read_file, shown};
use bryant_generator::law::ForceKind;
use bryant_generator::model::Model;
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::units::UnitSystem;
use bryant_generator::model_text::read_model;
use std::path::{Path, PathBuf};

/// A model that was found, read and resolved.
pub struct Found {
    /// The model.
    pub model: Model,
    /// The description that was read: the model, its files, and the places of its items in the text.
    pub scene: AnnotatedModel,
    /// The files that it was read from; empty for a bundled model.
    pub files: Vec<PathBuf>,
}

/// Finds and reads a model.
pub fn find(argument: &str) -> Result<Found, Error> {
    if let Some(bundled) = bundled::find(argument) {
        let scene = bundled::scene(bundled).map_err(Error::Model)?;
        return Ok(Found::of(scene, Vec::new()));
    }
    let path = path_of(argument)?;
    if let Some(bundled) = meant(path) {
        return Err(Error::Input(format!(
            "there is no file {argument}\n  help: a model {bundled} is bundled: give its name without an ending; `bryant models {bundled} --copy .` writes its file here"
        )));
    }
    let scene = bryant_generator::read_annotated(path).map_err(Error::Model)?;
    let files = scene.read.clone();
    Ok(Found::of(scene, files))
}

impl Found {
    fn of(scene: AnnotatedModel, files: Vec<PathBuf>) -> Self {
        Found {
            model: scene.model.clone(),
            scene,
            files,
        }
    }

    /// Shows outputs in units of this system, except those with a unit of their own. `None` keeps the system of the
    /// model.
    pub fn show_in(&mut self, system: Option<UnitSystem>) {
        let system = system.unwrap_or(self.model.units.system);
        self.model.units.system = system;
        self.scene.model.units.system = system;
    }

    /// Prints the notes about the import of a URDF file.
    pub fn tell(&self, terminal: &mut Terminal) {
        for note in &self.scene.notes {
            terminal.note(note);
        }
    }

    /// The functions of user forces: the name of each file, as shown to the user, and its text. An error if a function
    /// is in a crate that is not available.
    pub fn user_sources(&self) -> Result<Vec<(String, String)>, Error> {
        let mut sources = Vec::new();
        let model = self
            .scene
            .read
            .first()
            .map_or(String::new(), |path| shown(path));
        for force in &self.model.forces {
            let ForceKind::User(user) = ForceKind::of(force) else {
                continue;
            };
            let Some(source) = &user.function.source else {
                return Err(Error::Input(format!(
                    "the user force \"{}\" calls {}, which exists only in the crate that is built with this model\n  \
                     help: run it there, or give the function in a file: `source: FILE.rs`",
                    force.name, user.function.name
                )));
            };
            let source = (shown(&beside(&model, &source.name)), source.text.clone());
            if !sources.contains(&source) {
                sources.push(source);
            }
        }
        Ok(sources)
    }
}

/// Reads a model; its Rust files may be missing.
pub fn find_without_sources(argument: &str) -> Result<Model, Error> {
    if let Some(bundled) = bundled::find(argument) {
        return bundled::model(bundled).map_err(Error::Model);
    }
    let path = path_of(argument)?;
    let read = read_model(path).map_err(Error::Model)?;
    bryant_generator::read_without_sources(&read.name, &read.text, &read_file)
        .map_err(|found| Error::Model(read.in_file(found)))
}

fn path_of(argument: &str) -> Result<&Path, Error> {
    let path = Path::new(argument);
    if !path.exists() && !looks_like_path(argument) {
        return Err(Error::Input(unknown(argument)));
    }
    Ok(path)
}

/// The bundled model that has the name of a missing file.
fn meant(path: &Path) -> Option<&'static str> {
    let name = path.file_stem()?.to_str()?;
    let bundled = bundled::find(name).filter(|_| !path.exists())?;
    Some(bundled.name)
}

/// The bundled model of this name, or an error that lists the bundled models.
pub fn find_bundled(name: &str) -> Result<&'static Bundled, Error> {
    bundled::find(name).ok_or_else(|| {
        let names: Vec<&str> = bundled::all().iter().map(|b| b.name).collect();
        let help = match nearest(name, &names) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => "`bryant models` lists them".to_owned(),
        };
        Error::Input(format!(
            "no bundled model is called \"{}\"\n  help: {help}",
            name.escape_debug()
        ))
    })
}

pub fn looks_like_path(argument: &str) -> bool {
    let extension = Path::new(argument).extension();
    argument.contains(['/', '\\'])
        || extension.is_some_and(|e| {
            ["yaml", "yml", "urdf", "xml"]
                .iter()
                .any(|known| e.eq_ignore_ascii_case(known))
        })
}

fn unknown(name: &str) -> String {
    let names: Vec<&str> = bundled::all().iter().map(|b| b.name).collect();
    let help = match nearest(name, &names) {
        Some(near) => format!("did you mean \"{near}\"? For"),
        None => format!("bundled are {}; for", names.join(", ")),
    };
    format!(
        "\"{}\" is neither a bundled model nor a file\n  help: {help} a file of your own, give its path",
        name.escape_debug()
    )
}

/// The candidate that is most similar to a word; `None` if no candidate is similar.
pub fn nearest<'a>(word: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let distance = |c: &str| strsim::damerau_levenshtein(&word.to_lowercase(), &c.to_lowercase());
    let allowed = word.chars().count().div_ceil(3).max(1);
    candidates
        .iter()
        .map(|c| (distance(c), *c))
        .filter(|(d, _)| *d <= allowed && word.len() < 100)
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}
