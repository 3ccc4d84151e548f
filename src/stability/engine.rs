//! Runs scenes by compiling them on demand, each once.

use crate::accuracy::program;
use crate::build_on_demand::{self, BuildError, Unit};
use crate::evaluation::functions;
use bryant_generator::Config;
use bryant_generator::expression::Function;
use bryant_generator::model::Model;
use bryant_hard::{Engine, Run, Scene, Trouble};
use bryant_runtime::program::{Job, Scalar};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// A scene's program, once it is compiled; whoever wants it meanwhile waits.
type Place = Arc<Mutex<Option<PathBuf>>>;

/// Compiles scenes and runs them, each run in a process of its own, so that none can take another along.
#[derive(Debug, Default)]
pub struct Compiler {
    programs: Mutex<BTreeMap<(String, &'static str), Place>>,
}

impl Compiler {
    /// With the runtime compiled already, which all scenes need.
    ///
    /// # Errors
    /// There is no compiler, or no place to keep what it makes.
    pub fn new() -> Result<Compiler, BuildError> {
        build_on_demand::prepare(&mut |_| {})?;
        Ok(Compiler::default())
    }

    /// The program around a scene, with this arithmetic.
    fn program(&self, scene: &Scene, scalar: Scalar) -> Result<PathBuf, Trouble> {
        let model = scene
            .model()
            .map_err(|problems| Trouble::Refused(problems.to_string()))?;
        let place = {
            let mut programs = self.programs.lock().unwrap_or_else(PoisonError::into_inner);
            let key = (model.digest.clone(), scalar.name());
            Arc::clone(programs.entry(key).or_default())
        };
        let mut place = place.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(program) = &*place {
            return Ok(program.clone());
        }
        let unit = Unit {
            name: &model.name,
            digest: &model.digest,
            texts: &[],
        };
        let source = &mut || Config::new().matrices(false).source(&model);
        let built = match scalar {
            Scalar::F64 => build_on_demand::program(unit, source, &mut |_| {}),
            Scalar::F32 => build_on_demand::program_in_single_precision(unit, source, &mut |_| {}),
            Scalar::Fast | Scalar::DoubleDouble => {
                build_on_demand::program_of_all_scalars(unit, source, &mut |_| {})
            }
        };
        let program = built.map_err(|error| Trouble::System(error.to_string()))?;
        *place = Some(program.clone());
        Ok(program)
    }
}

impl Engine for Compiler {
    fn run(&self, scene: &Scene, job: &Job) -> Result<Run, Trouble> {
        let program = self.program(scene, job.scalar)?;
        let outcome =
            program::run(&program, job).map_err(|error| Trouble::System(error.to_string()))?;
        Ok(Run {
            header: outcome.header,
            times: outcome.trajectory.times,
            states: outcome.trajectory.states,
            outputs: outcome.trajectory.outputs,
            result: outcome.result,
            energy: outcome.energy,
            doubts: outcome.doubts,
        })
    }

    fn call(&self, model: &Model, function: Function, arguments: &[f64]) -> f64 {
        functions(model)(function, arguments)
    }
}
