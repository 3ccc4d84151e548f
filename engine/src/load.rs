//! Makes engines from files and texts: reads the description, derives the equations.

use crate::engine_file::KeptError;
use crate::model::{Engine, Error};
use bryant_generator::Config;
use bryant_generator::diagnostic::{Diagnostic, Diagnostics};
use bryant_generator::model::Model;
use std::io;
use std::path::Path;

/// Why a model could not be loaded.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum LoadError {
    /// The description is wrong, or a file could not be read: every problem with its place and remedy.
    Description(Diagnostics),
    /// The engine could not be made.
    Engine(Error),
    /// A kept engine could not be read.
    Kept(KeptError),
}

impl std::fmt::Display for LoadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LoadError::Description(problems) => problems.fmt(f),
            LoadError::Engine(error) => error.fmt(f),
            LoadError::Kept(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for LoadError {}

impl From<Diagnostics> for LoadError {
    fn from(problems: Diagnostics) -> Self {
        LoadError::Description(problems)
    }
}

impl From<Error> for LoadError {
    fn from(error: Error) -> Self {
        LoadError::Engine(error)
    }
}

impl From<KeptError> for LoadError {
    fn from(error: KeptError) -> Self {
        LoadError::Kept(error)
    }
}

impl Engine {
    /// The engine of a file: YAML or URDF, with S, r_s and r_k, or an engine that was [kept](Self::keep), whose file
    /// name ends in `.bryant`.
    ///
    /// # Errors
    /// All problems of the description; a force that is a function of the user, which needs a compiler; a kept engine
    /// that is damaged or of another version.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, LoadError> {
        let path = path.as_ref();
        if path.extension().is_some_and(|ending| ending == "bryant") {
            let content = std::fs::read(path).map_err(|error| unreadable(path, &error))?;
            return Ok(Self::of_kept(&content)?);
        }
        let (model, _) = bryant_generator::read(path)?;
        Self::of(&model, &Config::new())
    }

    /// The engine of a text in YAML that includes no files, with S, r_s and r_k. `name` stands for the file in
    /// messages.
    ///
    /// # Errors
    /// Those of [`Engine::load`].
    pub fn of_text(name: &str, text: &str) -> Result<Self, LoadError> {
        let nothing = |_: &Path| Err(io::ErrorKind::NotFound.into());
        let (model, _) = bryant_generator::read_str(name, text, &nothing)?;
        Self::of(&model, &Config::new())
    }

    /// The engine of a model that was read, with what the options ask for.
    ///
    /// # Errors
    /// A force that is a function of the user, which needs a compiler.
    pub fn of(model: &Model, options: &Config) -> Result<Self, LoadError> {
        Ok(Self::new(options.lists(model))?)
    }
}

fn unreadable(path: &Path, error: &io::Error) -> LoadError {
    let problem = Diagnostic::of_file(
        path.display().to_string(),
        format!("it cannot be read: {error}"),
        "give the path of a file that can be read",
    );
    LoadError::Description(Diagnostics {
        problems: vec![problem],
    })
}
