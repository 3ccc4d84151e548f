//! The functions of a model's user forces: compiled as a library that this process loads and calls.

use super::exports::{Source, exports_of_functions, library, unusable};
use super::guard::{self, Inside, What};
use super::library::{Function, Functions, Panic};
use super::message::place_in_texts;
use super::{BuildError, Rustc, Stage, Text};
use bryant_engine::UserFunctions;
use bryant_generator::diagnostic::{Diagnostic, Diagnostics};
use bryant_generator::law::ForceKind;
use bryant_generator::model::Model;
use bryant_generator::target::rust::Apart;
use bryant_runtime::real::{Base, Form};
use std::sync::OnceLock;

/// The functions of a model's user forces.
#[derive(Debug)]
pub struct UserForces {
    library: Functions,
    /// For each force of the model its function; `None` for forces of other kinds.
    forces: Vec<Option<Force>>,
    /// The compiled module, which contains the user's texts; the places of panics refer to it.
    module: String,
    texts: Vec<(String, String)>,
    failure: OnceLock<UserFailure>,
}

#[derive(Debug)]
struct Force {
    name: String,
    what: &'static What,
    /// The file, as shown to the user.
    file: String,
    /// The compiled functions by base and order of the scalar.
    functions: [[Option<Function>; 2]; Base::ALL.len()],
}

/// A user function failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problems}")]
pub struct UserFailure {
    /// The force.
    pub force: String,
    /// The problem and its place.
    pub problems: Diagnostics,
}

impl UserForces {
    /// Compiles the functions of a model, unless they are in the cache, and loads them; `None` if the model has none.
    /// `sources` are the names, as shown to the user, and the texts of their files. `stage` is called before each step
    /// that takes time.
    pub fn of(
        model: &Model,
        sources: Vec<(String, String)>,
        stage: &mut dyn FnMut(Stage),
    ) -> Result<Option<Self>, BuildError> {
        let Some(apart) = bryant_generator::target::rust::apart(model) else {
            return Ok(None);
        };
        let texts: Vec<Text<'_>> = sources
            .iter()
            .map(|(name, text)| Text { name, text })
            .collect();
        let source = Source {
            name: &model.name,
            module: &apart.text,
            exports: &exports_of_functions(&apart),
            texts: &texts,
        };
        let path = library(&Rustc::find_portable()?, &source, stage)?;
        let library = Functions::open(&path).map_err(|error| unusable(&path, error))?;
        guard::watch();
        let forces = forces(model, &apart, &sources, &library);
        Ok(Some(Self {
            library,
            forces,
            module: apart.text,
            texts: sources,
            failure: OnceLock::new(),
        }))
    }

    /// The first failure, if there was one; all values that were computed later are NaN.
    pub fn failure(&self) -> Option<&UserFailure> {
        self.failure.get()
    }

    /// Returns the first failure and forgets it, before another run.
    pub fn take_failure(&mut self) -> Option<UserFailure> {
        self.failure.take()
    }

    #[cold]
    fn fail(&self, force: &Force, panic: &Panic) {
        self.failure.get_or_init(|| {
            let message = format!("the user force \"{}\" panicked: {}", force.name, panic.message);
            let message = message.replace('\n', " ");
            let help = "a user function must return a number for every state; where there is none, return `T::from_f64(f64::NAN)`";
            let texts: Vec<Text<'_>> = self
                .texts
                .iter()
                .map(|(name, text)| Text { name, text })
                .collect();
            let place = panic.file.ends_with("model.rs").then_some(panic.line);
            let place = place.and_then(|line| place_in_texts(&self.module, &texts, line));
            let problem = match place {
                Some((text, line)) => Diagnostic::at(
                    text.name,
                    text.text,
                    (line, panic.column, usize::MAX / 2),
                    message,
                    help,
                ),
                None => Diagnostic::of_file(&force.file, message, help),
            };
            UserFailure {
                force: force.name.clone(),
                problems: problem.into(),
            }
        });
    }
}

fn forces(
    model: &Model,
    apart: &Apart,
    sources: &[(String, String)],
    library: &Functions,
) -> Vec<Option<Force>> {
    let forces = model.forces.iter().zip(&apart.forces);
    let forces = forces.map(|(force, function)| {
        let (ForceKind::User(user), Some(index)) = (ForceKind::of(force), *function) else {
            return None;
        };
        let text = user.function.source.as_ref().map(|source| &source.text);
        let file = sources.iter().find(|(_, of)| Some(of) == text);
        let file = file.map_or(user.function.name.clone(), |(name, _)| name.clone());
        let adapter = &apart.functions[index];
        let lengths = (adapter.arguments, adapter.results);
        let functions = Base::ALL.map(|base| {
            let value = Form::of(base);
            [value, value.dual()].map(|form| library.function(index, lengths, form))
        });
        Some(Force {
            name: force.name.clone(),
            what: What::new(format!("the user force \"{}\" ({file})", force.name)),
            file,
            functions,
        })
    });
    forces.collect()
}

impl UserFunctions for UserForces {
    fn knows(&self, force: usize) -> bool {
        self.forces.get(force).is_some_and(Option::is_some)
    }

    fn call(&self, force: usize, form: Form, arguments: &[f64], results: &mut [f64]) {
        let force = self.forces.get(force).and_then(Option::as_ref);
        let function = force.and_then(|force| {
            let function = force.functions[form.base as usize].get(form.order as usize);
            Some((force, (*function?)?))
        });
        // a function is missing only for scalars that no run uses
        let Some((force, function)) = function else {
            results.fill(f64::NAN);
            return;
        };
        let given = (arguments.len() / form.lanes).max(1);
        let returned = (results.len() / form.lanes).max(1);
        let _inside = Inside::of(force.what);
        let lanes = arguments.chunks_exact(given);
        for (arguments, results) in lanes.zip(results.chunks_exact_mut(returned)) {
            if let Err(panic) = self.library.call(function, arguments, results) {
                self.fail(force, &panic);
                results.fill(f64::NAN);
            }
        }
    }
}
