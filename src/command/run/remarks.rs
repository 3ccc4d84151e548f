//! Remarks about a run beside its results: about its start, declarations without effect, and switches that did not
//! fire.

use super::super::caution::start::{self, Start};
use super::super::model_argument::Found;
use crate::orientation::WithoutCharts;
use crate::pose::{Layout, Pose};
use crate::simulation::Recording;
use bryant_generator::model::Model;
use bryant_runtime::program::Job;

/// The pose at the last sample of a run.
fn last_pose(model: &Model, job: &Job, recording: &Recording) -> Option<Pose> {
    let layout = Layout::new(model, &recording.coordinates).ok()?;
    let last = recording.instants.last()?;
    let parameters = recording.parameters(job);
    Pose::new(model, &layout, &parameters, last.time, &last.coordinates)
}

/// If a ball joint is rotated by nearly 90°, names it as the cause of a failure, because it makes all forces look
/// stiff.
pub fn look_for_right_angle(model: &Model, job: &Job, recording: &mut Recording) {
    let pose = last_pose(model, job, recording);
    let found = pose.and_then(|pose| start::near_right_angle(model, &pose));
    if let (Some(cause), Err(error)) = (found, &mut recording.result) {
        error.cause = cause.join("; ");
    }
}

/// Adds remarks about the start, about declarations without effect, and about switches that did not fire.
pub fn remark(found: &Found, job: &Job, recording: &mut Recording) {
    let model = &found.model;
    let parameters = recording.parameters(job);
    let mut notes: Vec<String> = start_of(model, &parameters, job, recording)
        .iter()
        .flat_map(|from| from.cautions(&found.scene))
        .chain(start::unused(&found.scene))
        .map(|caution| format!("warning: {caution}"))
        .collect();
    if recording.result.is_ok() {
        let header = &recording.header;
        let before = header.coordinates.len() + header.velocities.len() + header.auxiliaries.len();
        let memory = |name: &str| {
            let index = header.memory.iter().position(|one| one == name)?;
            recording.last_state.get(before + index).copied()
        };
        let nearest = |name: &str| {
            let index = header.event_functions.iter().position(|one| one == name)?;
            recording.nearest.get(index).copied()
        };
        let end = recording.last_time();
        let idle = start::unfired(model, &parameters, memory, nearest, end);
        notes.extend(idle);
    }
    recording.notes.splice(0..0, notes);
}

/// The start of a run; `None` if the run starts with a state from within a motion, that is, at a time other than 0.
fn start_of<'a>(
    model: &'a Model,
    parameters: &'a [f64],
    job: &Job,
    recording: &Recording,
) -> Option<Start<'a>> {
    let Some(read) = &job.start else {
        return Start::of_model(model, parameters);
    };
    if read.t != 0.0 {
        // the state is from within a motion
        return None;
    }
    let layout = Layout::new(model, &recording.coordinates).ok()?;
    let q = WithoutCharts::of(&recording.header).q(&read.state);
    let pose = |t: f64| Pose::new(model, &layout, parameters, t, &q);
    let header = &recording.header;
    let first = header.coordinates.len();
    let velocity = |name: String| {
        let index = header.velocities.iter().position(|one| *one == name)?;
        read.state.get(first + index).copied()
    };
    let velocities = model.systems.iter().map(|system| {
        let along = |axis: &str| velocity(format!("{}.v{axis}", system.name));
        Some([along("x")?, along("y").unwrap_or(0.0), along("z")?])
    });
    Some(Start {
        model,
        parameters,
        pose: pose(0.0)?,
        later: pose(start::LATER)?,
        velocities: velocities.collect(),
        is_read: true,
    })
}
