//! The scene of a run, with forces between bodies. These are computed at the states of the run, by additional outputs.

use super::super::model_argument::Found;
use super::super::prepare::{Prepared, prepare_model};
use super::super::terminal::Terminal;
use super::super::{Error, caution};
use crate::picture::Instant;
use crate::scene::mesh::{Mesh, meshes};
use crate::scene::{Scene, with_forces};
use crate::simulation::Recording;
use bryant_generator::model::Model;
use bryant_runtime::dynamics::Family;
use bryant_runtime::program::Job;
use std::cell::{OnceCell, RefCell};

/// An output counts as equal if it differs by at most `SAME` times the largest value plus `SMALL` \[SI\].
const SAME: f64 = 1e-3;
const SMALL: f64 = 1e-9;

/// The note that there are no forces.
pub const APART: &str = "forces between bodies are not shown: other outputs, computed beside them, differ from those of the run";

/// The meshes of a model, and the notes about them.
pub fn meshes_of(found: &Found) -> (Vec<Mesh>, Vec<String>) {
    let (meshes, notes) = meshes(&found.model);
    let cautions = caution::meshes(&found.scene).into_iter();
    let cautions = cautions.map(|caution| format!("warning: {caution}"));
    (meshes, cautions.chain(notes).collect())
}

/// Makes scenes of runs of one model.
pub struct Shown<'a> {
    /// The model.
    pub found: &'a Found,
    /// The run.
    pub job: &'a Job,
    model: Model,
    /// Its meshes, read when a scene first needs them.
    meshes: OnceCell<Vec<Mesh>>,
    /// Notes about meshes and forces that were not printed yet.
    pub notes: RefCell<Vec<String>>,
    /// Its equations, prepared when a scene first needs them.
    engine: OnceCell<Prepared>,
}

impl<'a> Shown<'a> {
    /// Nothing is read or prepared yet.
    pub fn new(found: &'a Found, job: &'a Job) -> Self {
        Shown {
            found,
            job,
            model: with_forces(&found.model),
            meshes: OnceCell::new(),
            notes: RefCell::default(),
            engine: OnceCell::new(),
        }
    }

    /// The scene at these instants of a run. If outputs at a state differ from those of the run, the scene has no
    /// forces, and a note says so.
    ///
    /// # Errors
    /// The equations cannot be prepared, or a user function fails.
    pub fn scene(
        &self,
        recording: &Recording,
        instants: &[Instant],
        terminal: &Terminal,
    ) -> Result<Scene, Error> {
        let forces = self.forces(recording, instants, terminal)?;
        self.scene_of(recording, instants, &forces)
    }

    /// The scene without forces, which is faster.
    ///
    /// # Errors
    /// The recording is that of another model.
    pub fn bare(&self, recording: &Recording, instants: &[Instant]) -> Result<Scene, Error> {
        self.scene_of(recording, instants, &[])
    }

    /// Prints the notes about meshes and forces, once.
    pub fn tell(&self, terminal: &mut Terminal) {
        let notes = self.notes.take();
        notes.iter().for_each(|note| terminal.note(note));
    }

    fn scene_of(
        &self,
        recording: &Recording,
        instants: &[Instant],
        forces: &[Vec<f64>],
    ) -> Result<Scene, Error> {
        let parameters = recording.parameters(self.job);
        let model = &self.found.model;
        let scene = Scene::new(model, &recording.coordinates, &parameters, instants, forces);
        let mut scene = scene.map_err(Error::system)?;
        let meshes = self.meshes.get_or_init(|| {
            let (meshes, notes) = meshes_of(self.found);
            self.notes.borrow_mut().extend(notes);
            meshes
        });
        scene.meshes.clone_from(meshes);
        Ok(scene)
    }

    /// The additional outputs that the scene needs, one column for each; empty if the forces would not be those of the
    /// run.
    fn forces(
        &self,
        recording: &Recording,
        instants: &[Instant],
        terminal: &Terminal,
    ) -> Result<Vec<Vec<f64>>, Error> {
        let own = self.found.model.outputs.len();
        if self.model.outputs.len() == own {
            return Ok(Vec::new());
        }
        if self.engine.get().is_none() {
            let prepared = prepare_model(self.found, &self.model, terminal)?;
            let _ = self.engine.set(prepared);
        }
        let Some(engine) = self.engine.get() else {
            return Ok(Vec::new());
        };
        let mut model = Family::over::<f64>(&**engine);
        model.set_parameters(&recording.parameters(self.job));
        let mut outputs = vec![0.0; self.model.outputs.len()];
        let mut forces = vec![Vec::with_capacity(instants.len()); self.model.outputs.len() - own];
        for instant in instants {
            if !instant.coordinates.iter().all(|q| q.is_finite()) {
                continue;
            }
            model.outputs(instant.time, &instant.state, &mut outputs);
            // shows no forces rather than those of different equations; the motion of the run is shown in any case
            if !self.is_of_run(recording, instant.time, &outputs[..own]) {
                let mut notes = self.notes.borrow_mut();
                if !notes.iter().any(|note| note == APART) {
                    notes.push(APART.to_owned());
                }
                return Ok(Vec::new());
            }
            for (column, force) in forces.iter_mut().zip(&outputs[own..]) {
                column.push(*force);
            }
        }
        engine.check()?;
        Ok(forces)
    }

    /// True if the run has the same outputs at this time, within rounding, which differs because these equations have
    /// more outputs. Filtered outputs are not compared.
    fn is_of_run(&self, recording: &Recording, time: f64, outputs: &[f64]) -> bool {
        let [times, columns @ ..] = recording.table.columns.as_slice() else {
            return true;
        };
        let row = times.values.partition_point(|t| *t < time);
        let outputs = outputs.iter().zip(&self.found.model.outputs).zip(columns);
        let mut compared = outputs.filter(|((_, output), _)| output.filter.is_none());
        compared.all(|((value, _), column)| {
            let largest = column
                .values
                .iter()
                .fold(0.0, |most: f64, x| x.abs().max(most));
            let far = |written: &f64| (written - value).abs() > SAME * largest + SMALL;
            !column.values.get(row).is_some_and(far)
        })
    }
}
