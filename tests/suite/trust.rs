//! Trust in runs: values that no law can have are refused, all other values give finite results, each law is that of
//! its page, and a run is doubted only if there is a reason.

mod doubts;
mod law_combinations;
mod mounts;
mod pages;
mod refusals;
use bryant::equations::{self, Engine};
use bryant::simulation::{self, Recording};
use bryant_generator::model::Model;
use bryant_generator::read_str;
use bryant_runtime::program::Job;
use std::io;
use std::path::Path;

/// The model of a text, or its problems, one sentence each.
fn read(text: &str) -> Result<Model, Vec<String>> {
    let nothing = |_: &Path| Err(io::ErrorKind::NotFound.into());
    match read_str("scene.yaml", text, &nothing) {
        Ok((model, _)) => Ok(model),
        Err(found) => Err(found.problems.into_iter().map(|p| p.message).collect()),
    }
}

/// The model of a valid text, and its equations.
fn sound(text: &str) -> (Model, Engine) {
    let model = read(text).unwrap_or_else(|problems| panic!("{problems:#?}\n{text}"));
    let engine = equations::of(&model).unwrap_or_else(|error| panic!("{error}\n{text}"));
    (model, engine)
}

/// A run with these parameters.
fn run(engine: &Engine, parameters: &[(&str, f64)]) -> Recording {
    let named = parameters.iter();
    let job = Job {
        parameters: named
            .map(|(name, value)| (name.to_string(), *value))
            .collect(),
        max_steps: Some(100_000),
        ..Job::default()
    };
    simulation::run(engine, &job, &mut |_| ())
}
