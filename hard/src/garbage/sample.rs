//! Valid models to start from; together they have every kind of force, motion, switch and output.

use crate::case_model::CaseModel;
use bryant_generator::Diagnostics;
use bryant_generator::model::Model;
use bryant_generator::read_str;
use std::io;
use std::path::Path;

include!(concat!(env!("OUT_DIR"), "/samples.rs"));

/// All models as scenes.
pub fn scenes() -> impl Iterator<Item = CaseModel> {
    ALL.iter().map(|(name, text)| CaseModel::new(*name, *text))
}

/// Reads text as a model, which may include `data/pulse.csv`.
pub fn read(text: &str) -> Result<Model, Diagnostics> {
    let loader = |path: &Path| match path.ends_with("data/pulse.csv") {
        true => Ok(PULSE.to_owned()),
        false => Err(io::Error::from(io::ErrorKind::NotFound)),
    };
    read_str("garbage.yaml", text, &loader).map(|(model, _)| model)
}
