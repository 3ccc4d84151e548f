//! Prepares the equations of a model for evaluation, and shows progress while this takes time.

use super::Error;
use super::model_argument::Found;
use super::progress::{Progress, Whole};
use super::terminal::Terminal;
use crate::build_on_demand::{BuildError, RustcModel, Stage, Text, Unit, UserForces};
use crate::equations::{self, Engine};
use bryant_generator::Config;
use bryant_generator::model::Model;
use std::ops::Deref;
use std::sync::Arc;

/// The equations of a model, with the functions of its user forces.
pub struct Prepared {
    engine: Engine,
    users: Option<Arc<UserForces>>,
}

impl Deref for Prepared {
    type Target = Engine;
    fn deref(&self) -> &Engine {
        &self.engine
    }
}

impl Prepared {
    /// Fails if a user function has failed in a run.
    pub fn check(&self) -> Result<(), Error> {
        let failure = self.users.as_ref().and_then(|users| users.failure());
        match failure {
            Some(failure) => Err(Error::User(failure.problems.clone())),
            None => Ok(()),
        }
    }
}

/// Prepares the equations of a model. Only functions of user forces are compiled.
pub fn prepare(found: &Found, terminal: &Terminal) -> Result<Prepared, Error> {
    prepare_model(found, &found.model, terminal)
}

/// Prepares the equations of `model`, which may differ from the model of `found` in numbers, curves and effects.
pub fn prepare_model(found: &Found, model: &Model, terminal: &Terminal) -> Result<Prepared, Error> {
    prepare_with(found, model, Config::new().matrices(false), terminal)
}

/// Prepares the equations of `model` as [`prepare_model`] does, with the functions and options of `config`.
pub fn prepare_with(
    found: &Found,
    model: &Model,
    config: &Config,
    terminal: &Terminal,
) -> Result<Prepared, Error> {
    let users = users_of(found, model, terminal)?;
    let progress = Progress::deriving(terminal, &model.name);
    let engine = equations::of_lists(config.lists(model), users.clone()).map_err(Error::system);
    drop(progress);
    Ok(Prepared {
        engine: engine?,
        users,
    })
}

/// The functions of a model's user forces, which are compiled if they are not in the cache; `None` if the model has
/// none.
pub fn users_of(
    found: &Found,
    model: &Model,
    terminal: &Terminal,
) -> Result<Option<Arc<UserForces>>, Error> {
    let sources = found.user_sources()?;
    let users = match sources.is_empty() {
        true => Ok(None),
        false => {
            let progress = Progress::new(terminal, "reading user forces".into(), Whole::Unknown);
            let names: Vec<String> = sources.iter().map(|(name, _)| name.clone()).collect();
            UserForces::of(model, sources, &mut |stage| {
                if stage == Stage::Compiling {
                    progress.say(&format!(
                        "compiling {}: Rust that a model names is a program, and runs with your rights",
                        names.join(", ")
                    ));
                }
                let what = match stage {
                    Stage::Runtime => "compiling the runtime (once for all user forces)",
                    Stage::Generating | Stage::Compiling => {
                        "compiling user forces (kept for the next run)"
                    }
                };
                progress.next(what.into(), Whole::Unknown);
            })
        }
    };
    match users {
        Ok(users) => Ok(users.map(Arc::new)),
        Err(BuildError::User(problems)) => Err(Error::Model(problems)),
        Err(error) => Err(Error::system(error)),
    }
}

/// The model of `found`, generated as Rust and compiled as a whole by rustc, for comparison with the engine. A Jacobian
/// is needed by rodas5 and makes compilation three times as long.
pub fn by_rustc<'e>(
    found: &Found,
    engine: &'e Engine,
    jacobian: bool,
    terminal: &Terminal,
) -> Result<RustcModel<'e>, Error> {
    let model = &found.model;
    let sources = found.user_sources()?;
    let texts: Vec<Text<'_>> = sources
        .iter()
        .map(|(name, text)| Text { name, text })
        .collect();
    let unit = Unit {
        name: &model.name,
        digest: &model.digest,
        texts: &texts,
    };
    let progress = Progress::deriving(terminal, &model.name);
    let source = &mut || Config::new().matrices(false).source(model);
    let compiled = RustcModel::of(unit, engine.info(), jacobian, source, &mut |stage| {
        let what = match stage {
            Stage::Runtime => "compiling the runtime (once for all models)",
            Stage::Generating => "writing the equations",
            Stage::Compiling => "compiling the equations by rustc (kept for the next run)",
        };
        progress.next(what.into(), Whole::Unknown);
    });
    drop(progress);
    compiled.map_err(|error| match error {
        BuildError::User(problems) => Error::Model(problems),
        error => Error::System(format!(
            "{error}; without --engine rustc nothing is compiled"
        )),
    })
}
