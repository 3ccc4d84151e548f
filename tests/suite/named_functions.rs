//! The functions that are asked for by name: identities on every bundled model, numbers of Pinocchio, and the same bits
//! from every target.

mod bits;
mod contacts;
mod derivatives;
mod identities;
mod pinocchio;
mod points;
mod refusals;
mod table;

use bryant_engine::{Engine, UserFunctions};
use bryant_generator::Config;
use bryant_generator::dynamics::functions::FUNCTIONS;
use bryant_generator::model::Model;
use bryant_runtime::Real;
use bryant_runtime::real::Form;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A stand-in for the functions of a user: identities hold with any forces.
#[derive(Debug)]
struct Nothing;

impl UserFunctions for Nothing {
    fn knows(&self, _: usize) -> bool {
        true
    }

    fn call(&self, _: usize, _: Form, _: &[f64], results: &mut [f64]) {
        results.fill(0.0);
    }
}

/// All functions that every model has, those of frames for each of these frames.
fn all(frames: &[String]) -> Vec<String> {
    let of =
        |function: &bryant_generator::dynamics::functions::Function| match function.is_of_frame() {
            true => frames
                .iter()
                .map(|frame| format!("{}({frame})", function.name))
                .collect(),
            false => vec![function.name.to_owned()],
        };
    let always = FUNCTIONS.iter().filter(|of| !of.may_be_impossible());
    always.flat_map(of).collect()
}

/// The models in these folders, in the order of their paths.
fn models(folders: &[&str]) -> Vec<Model> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in folders {
        let entries = std::fs::read_dir(root.join(folder)).expect("a folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        files.extend(paths.filter(|path| path.extension().is_some_and(|e| e == "yaml")));
    }
    files.sort();
    let read = |file: &PathBuf| bryant_generator::read(file).unwrap_or_else(|e| panic!("{e}"));
    files.iter().map(|file| read(file).0).collect()
}

/// The engine of a model with these functions.
fn engine(model: &Model, functions: &[String]) -> Engine {
    let lists = Config::new().functions(functions).lists(model);
    Engine::with_functions(lists, Some(Arc::new(Nothing))).expect("no function is missing")
}

/// The values of a function at a state.
fn values<T: Real>(
    engine: &Engine,
    machine: &bryant_engine::Evaluated<T>,
    name: &str,
    (t, y): (T, &[T]),
    accelerations: &[T],
) -> Vec<T> {
    let index = engine
        .function(name)
        .unwrap_or_else(|| panic!("there is no {name}"));
    let function = &engine.functions()[index];
    let mut results = vec![T::from_f64(0.0); function.rows.len() * function.columns.len()];
    machine.function(index, t, y, accelerations, &mut results);
    results
}
