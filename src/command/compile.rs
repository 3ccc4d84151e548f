//! A model that is not bundled, compiled, with what takes time said meanwhile.

use super::Error;
use super::model_argument::Found;
use super::terminal::Terminal;
use crate::build_on_demand::{BuildError, Stage, Text, Unit};
use bryant_generator::Config;
use std::path::PathBuf;

/// Compiles a model by `build`, which is given the unit, its source and who hears of stages.
pub fn compile(
    found: &Found,
    terminal: &Terminal,
    build: impl FnOnce(
        Unit<'_>,
        &mut dyn FnMut() -> String,
        &mut dyn FnMut(Stage),
    ) -> Result<PathBuf, BuildError>,
) -> Result<PathBuf, Error> {
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
    let spinner = terminal.spinner();
    let path = build(
        unit,
        &mut || Config::new().matrices(false).source(model),
        &mut |stage| {
            spinner.set_message(match stage {
                Stage::Runtime => "compiling the runtime (once for all models)".to_owned(),
                Stage::Generating => format!("deriving the equations of {}", model.name),
                Stage::Compiling => format!("compiling {} (kept for the next run)", model.name),
            });
        },
    );
    spinner.finish_and_clear();
    path.map_err(|error| match error {
        BuildError::User(problems) => Error::Model(problems),
        error => Error::system(error),
    })
}
