//! Computes the keyframes of an animation. They must be close together, because players rotate a body the shorter way
//! from one keyframe to the next.

use super::super::Error;
use super::super::error_report::ErrorReport;
use super::super::model_argument::Found;
use super::super::prepare::prepare_model;
use super::super::terminal::Terminal;
use super::report::kept;
use super::scene::Shown;
use crate::accuracy::setting::Setting;
use crate::animation::{glb, turns};
use crate::scene::Scene;
use crate::simulation::{self, Recording};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, TAU};

/// Largest number of keyframes of an animation; each takes 28 bytes for each body.
const MOST_KEYFRAMES: usize = 20_000;
/// The largest rotation of a body between two keyframes \[rad\]: the one that is aimed at, and the one that is
/// accepted.
const WANTED: f64 = FRAC_PI_3;
const MOST: f64 = FRAC_PI_2;
/// Factor by which a second scene has more keyframes, to detect whole turns between keyframes. No power of the factor
/// is a whole number.
const CLOSER: f64 = 1.3;
/// The total rotation of a body counts as equal in two scenes if it differs by at most this share, plus a tenth of a
/// turn.
const SAME: f64 = 0.02;

/// The animation of a run. Keyframes are at its rows; if bodies rotate too fast for this, the run is computed again
/// with more rows.
///
/// # Errors
/// The run has fewer than two samples.
pub fn animation(
    shown: &Shown<'_>,
    (recording, errors): (&Recording, &ErrorReport),
    terminal: &mut Terminal,
) -> Result<Vec<u8>, Error> {
    let Shown { found, job, .. } = *shown;
    let name = &found.model.name;
    let at_rows = kept(recording);
    let rows = at_rows.len();
    let span = recording.last_time() - recording.first_time();
    let wanted = (span * recording.turning / WANTED).ceil() as usize;
    let slow = rows < 2 || wanted < rows && widest(&shown.bare(recording, &at_rows)?) < MOST;
    if rows < 2 || slow && turns_by_itself(found) || recording.result.is_err() {
        if !slow {
            tell(terminal);
        }
        let scene = shown.scene(recording, &at_rows, terminal)?;
        return glb(name, &scene).map_err(Error::failed);
    }
    let engine = prepare_model(found, &found.model, terminal)?;
    let mut by = errors.setting().unwrap_or(Setting::of(job)).job(job);
    by.reading = Default::default();
    let mut again = |frames: usize| {
        by.every = Some(span / frames as f64);
        let run = simulation::run_with_poses(&*engine, &by, 2 * MOST_KEYFRAMES, &mut |_| {});
        shown.bare(&run, &run.instants).map(|scene| (scene, run))
    };
    let mut frames = wanted.max(rows - 1);
    let (mut told, mut last) = (false, None);
    while frames <= MOST_KEYFRAMES && !told {
        let (scene, run) = again(frames)?;
        let (closer, _) = again((CLOSER * frames as f64).ceil() as usize)?;
        told = widest(&scene) < MOST && alike(&scene, &closer);
        last = Some(run);
        frames *= 2;
    }
    if !told {
        tell(terminal);
    }
    let scene = match &last {
        Some(run) => shown.scene(run, &run.instants, terminal)?,
        None => shown.scene(recording, &at_rows, terminal)?,
    };
    glb(name, &scene).map_err(Error::failed)
}

fn tell(terminal: &mut Terminal) {
    terminal.note(
        "the animation cannot show how fast bodies turn: they turn by more than 90° from one keyframe to the next, and players turn them the \
         shorter way\n  help: shorten the run by --duration, or give it more rows by --every",
    );
}

/// True if angular velocities in the state are the only rotations: there are no vehicles, and no joints follow others.
fn turns_by_itself(found: &Found) -> bool {
    let systems = &found.model.systems;
    let elements = || systems.iter().flat_map(|system| &system.elements);
    found.model.vehicles.is_empty()
        && elements().all(|element| element.joint.freedoms().iter().all(|f| f.follows.is_none()))
}

/// The largest rotation of a body from one keyframe to the next, as players show it \[rad\].
fn widest(scene: &Scene) -> f64 {
    turns(scene)
        .iter()
        .flatten()
        .fold(0.0, |most, angle| angle.max(most))
}

/// True if the total rotation of every body is equal in both scenes.
fn alike(a: &Scene, b: &Scene) -> bool {
    let sums = |scene: &Scene| {
        let mut sums: Vec<f64> = Vec::new();
        for angles in turns(scene) {
            sums.resize(angles.len(), 0.0);
            for (sum, angle) in sums.iter_mut().zip(angles) {
                *sum += angle;
            }
        }
        sums
    };
    let pairs = sums(a).into_iter().zip(sums(b));
    pairs
        .into_iter()
        .all(|(a, b)| (a - b).abs() <= SAME * a.max(b) + 0.1 * TAU)
}
