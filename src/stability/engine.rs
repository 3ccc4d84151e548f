//! Runs the scenes of hard cases in the same way as a user's models.

use crate::accuracy::run;
use crate::equations;
use crate::equations::Engine as Equations;
use crate::evaluation::functions;
use bryant_generator::model::Model;
use bryant_hard::{Call, CaseModel, Engine, Run, Trouble};
use bryant_runtime::program::Job;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Runs scenes; the equations of each are derived once.
#[derive(Default)]
pub struct Scenes {
    /// The equations by the digest of the model.
    equations: Mutex<BTreeMap<String, Arc<Equations>>>,
}

impl Scenes {
    /// An engine without any equations yet.
    pub fn new() -> Scenes {
        Scenes::default()
    }

    /// The equations of a scene.
    fn equations(&self, scene: &CaseModel) -> Result<Arc<Equations>, Trouble> {
        let model = scene
            .model()
            .map_err(|problems| Trouble::Refused(problems.to_string()))?;
        let known = || {
            self.equations
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        if let Some(found) = known().get(&model.digest) {
            return Ok(Arc::clone(found));
        }
        // two threads may derive the same equations at once, because neither waits for the other
        let made = equations::of(&model).map_err(|error| Trouble::System(error.to_string()))?;
        let made = Arc::new(made);
        known().insert(model.digest.clone(), Arc::clone(&made));
        Ok(made)
    }
}

impl Engine for Scenes {
    fn run(&self, scene: &CaseModel, job: &Job) -> Result<Run, Trouble> {
        let run = run::run(&*self.equations(scene)?, job);
        let states = run::states(&run);
        let mut columns = run.table.columns.into_iter();
        let times = columns.next().map_or_else(Vec::new, |times| times.values);
        let outputs: Vec<Vec<f64>> = columns.map(|output| output.values).collect();
        let sample = |i: usize| outputs.iter().map(|values| values[i]).collect();
        Ok(Run {
            header: run.header,
            outputs: (0..times.len()).map(sample).collect(),
            times,
            states,
            result: run.result,
            energy: run.energy,
            doubts: run.doubts,
        })
    }

    fn functions(&self, model: &Model) -> Box<Call> {
        Box::new(functions(model))
    }
}
