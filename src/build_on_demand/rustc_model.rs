//! A model whose generated Rust was compiled by rustc, for comparison with the engine.

use super::exports::{Source, exports_of_model, library, unusable};
use super::guard::{self, Inside, What as Named};
use super::library::{Compiled, CompiledModel, Panic};
use super::{BuildError, Rustc, Stage, Unit};
use bryant_runtime::ffi::What;
use bryant_runtime::{Adjustable, Dynamics, Info, Section};
use std::sync::OnceLock;

/// A model over `f64`, compiled by rustc and loaded. It borrows the facts of the model from an engine or from generated
/// code.
#[derive(Debug)]
pub struct RustcModel<'i> {
    library: Compiled,
    info: &'i Info<'i>,
    /// The name of its user forces for messages.
    what: &'static Named,
    name: String,
    failure: OnceLock<String>,
}

impl<'i> RustcModel<'i> {
    /// Compiles a model for this machine's processor, unless it is in the cache, and loads it. `source` writes the
    /// generated module; `info` belongs to the same model. A Jacobian is needed by Rosenbrock methods, and makes
    /// compilation three times as long. `stage` is called before each step that takes time.
    pub fn of(
        unit: Unit<'_>,
        info: &'i Info<'i>,
        jacobian: bool,
        source: &mut dyn FnMut() -> String,
        stage: &mut dyn FnMut(Stage),
    ) -> Result<Self, BuildError> {
        stage(Stage::Generating);
        let source = Source {
            name: unit.name,
            module: &source(),
            exports: &exports_of_model(jacobian),
            texts: unit.texts,
        };
        let path = library(&Rustc::find()?, &source, stage)?;
        let library = Compiled::open(&path).map_err(|error| unusable(&path, error))?;
        guard::watch();
        Ok(Self {
            library,
            info,
            what: Named::new(format!("a user force of the model {}", unit.name)),
            name: unit.name.to_owned(),
            failure: OnceLock::new(),
        })
    }

    /// Names, units and sizes.
    pub fn info(&self) -> &'i Info<'i> {
        self.info
    }

    /// The model at the default values of its parameters.
    pub fn model(&self) -> Box<dyn Adjustable<f64> + '_> {
        Box::new(At {
            of: self,
            model: self.library.model(),
        })
    }

    /// The first failure, if there was one; all values that were computed later are NaN.
    pub fn failure(&self) -> Option<&str> {
        self.failure.get().map(String::as_str)
    }

    #[cold]
    fn fail(&self, panic: &Panic) {
        self.failure.get_or_init(|| {
            format!(
                "a user force of the model {} panicked: {}",
                self.name, panic.message
            )
        });
    }
}

/// The model with one set of parameters.
struct At<'a> {
    of: &'a RustcModel<'a>,
    model: CompiledModel<'a>,
}

impl At<'_> {
    /// Writes the results of a method; false if the model does not have it.
    fn fill(&self, what: What, t: f64, y: &[f64], results: &mut [f64]) -> bool {
        let _inside = Inside::of(self.of.what);
        match self.model.evaluate(what, t, y, results) {
            Ok(told) => told,
            Err(panic) => {
                self.of.fail(&panic);
                results.fill(f64::NAN);
                true
            }
        }
    }

    /// The results of a method as an array; `None` if the model does not have it.
    fn some<const N: usize>(&self, what: What, t: f64, y: &[f64]) -> Option<[f64; N]> {
        let mut results = [f64::NAN; N];
        self.fill(what, t, y, &mut results).then_some(results)
    }
}

impl Dynamics<f64> for At<'_> {
    fn info(&self) -> &Info<'_> {
        self.of.info
    }

    fn parameter(&self, index: usize) -> Option<f64> {
        let [value] = self.some(What::Parameter, index as f64, &[])?;
        Some(value)
    }

    fn initial_state(&self, y: &mut [f64]) {
        self.fill(What::InitialState, 0.0, &[], y);
    }

    fn derivative(&self, t: f64, y: &[f64], rate: &mut [f64]) {
        self.fill(What::Derivative, t, y, rate);
    }

    fn coordinate_rates(&self, y: &[f64], rate: &mut [f64]) {
        self.fill(What::CoordinateRates, 0.0, y, rate);
    }

    fn jacobian(&self, t: f64, y: &[f64], by_state: &mut [f64], by_time: &mut [f64]) -> bool {
        // columns of memory are not written, so the present values are passed
        let mut results = [&*by_state, &*by_time].concat();
        let told = self.fill(What::Jacobian, t, y, &mut results);
        let (of_state, of_time) = results.split_at(by_state.len());
        by_state.copy_from_slice(of_state);
        by_time.copy_from_slice(of_time);
        told
    }

    fn normalize(&self, y: &mut [f64]) {
        self.fill(What::Normalize, 0.0, &[], y);
    }

    fn smallest_pivot(&self, t: f64, y: &[f64]) -> Option<(usize, f64)> {
        let [index, pivot] = self.some(What::SmallestPivot, t, y)?;
        Some((index as usize, pivot))
    }

    fn violated(&self) -> Option<usize> {
        let [index] = self.some(What::Violated, 0.0, &[])?;
        Some(index as usize)
    }

    fn kink_after(&self, t: f64) -> f64 {
        let [time] = self.some(What::KinkAfter, t, &[]).unwrap_or([f64::NAN]);
        time
    }

    fn section(&self, section: Section, t: f64, y: &[f64], results: &mut [f64]) {
        self.fill(What::Section(section), t, y, results);
    }
}

impl Adjustable<f64> for At<'_> {
    fn set_parameters(&mut self, values: &[f64]) {
        if let Err(panic) = self.model.set_parameters(values) {
            self.of.fail(&panic);
        }
    }
}
