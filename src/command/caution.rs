//! Warnings about valid models: likely problems in their runs.

pub mod singular;
pub mod start;

use crate::scene::mesh::{missing, place};
use bryant_generator::law::ForceKind;
use bryant_generator::law::types::{Direction, JointTorque};
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::{Active, Dimension, Model, Shown};
use start::Start;
use std::f64::consts::FRAC_PI_2;

/// The middle one of three relative angles is critical within this distance from ±90°: 10° \[rad\].
const NEAR: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// The warnings, each a sentence with a remedy.
pub fn cautions(scene: &AnnotatedModel) -> Vec<String> {
    let model = &scene.model;
    let mut all = middle_angles(model);
    all.extend(bushings(model));
    all.extend(singular::cautions(model));
    all.extend(thinned(model));
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let start = Start::of_model(model, &defaults);
    all.extend(start.iter().flat_map(|start| start.cautions(scene)));
    all.extend(start::unused(scene));
    all.extend(meshes(scene));
    all
}

/// Warnings about meshes that are not shown, because they have no file or are on a vehicle that nothing uses.
pub fn meshes(scene: &AnnotatedModel) -> Vec<String> {
    let caution = |shown: &Shown| {
        let Shown::Mesh(written) = shown else {
            return None;
        };
        let why = match scene.model.shown.iter().any(|other| match other {
            Shown::Mesh(used) => {
                (used.line, &used.source, &used.of) == (written.line, &written.source, &written.of)
            }
            _ => false,
        }) {
            true => missing(written)?,
            false => "nothing is fixed to its vehicle, which is left out".to_owned(),
        };
        Some(format!(
            "{}: the mesh is not shown: {why}\n  help: the motion is the same without it; paths are relative to the file that names them",
            place(written)
        ))
    };
    scene.written.shown.iter().filter_map(caution).collect()
}

/// Notes about curves whose files have too many points: the deviation of the points that were left out.
pub fn thinned(model: &Model) -> Vec<String> {
    let each = model.curves.iter().filter_map(|curve| {
        let thinned = curve.thinned?;
        let heights = || curve.points.iter().map(|point| point[1]);
        let range = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
        Some(format!(
            "curve \"{}\" has {} points in its file, and {} of them are used: the others differ from it by {:.2e} in SI units at most, \
             {:.2} % of its range\n  help: filter the measurement and leave points out; each point ends a step",
            curve.name,
            thinned.points,
            curve.points.len(),
            thinned.error,
            1e2 * thinned.error / range.max(f64::MIN_POSITIVE)
        ))
    });
    each.collect()
}

/// Warnings about laws of the three relative angles of a ball joint whose middle angle may come near ±90°.
fn middle_angles(model: &Model) -> Vec<String> {
    if model.dimension == Dimension::Plane {
        return Vec::new();
    }
    let joints = || {
        model
            .forces
            .iter()
            .filter_map(|force| match ForceKind::of(force) {
                ForceKind::Joint(law) => Some((force, law)),
                _ => None,
            })
    };
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let none = JointTorque::default();
    joints()
        .filter_map(|(force, law)| {
            let name = &force.name;
            let [first, middle, last] = law.order.0;
            if law.about[first] == none && law.about[last] == none {
                return None;
            }
            let axes = [first, middle, last].map(|axis| ["x", "y", "z"][axis]);
            let [first, axis, last] = axes;
            // the rotation may be ended by this law, or by another law of the joint that always acts
            let always = joints().filter(|(other, its)| {
                its.child == law.child && other.active == Active::default()
            });
            let mut ends = vec![&law.about[middle]];
            ends.extend(always.map(|(_, its)| &its.about[middle]));
            let reaches = ends.iter().map(|y| middle_angle(y, &defaults));
            let reaches = reaches.reduce(|a, b| Some(a?.min(b?))).flatten()?;
            let way = match reaches.is_finite() {
                true => format!("its stops let the angle about {axis} come to {:.0}°", reaches.to_degrees()),
                false => format!("nothing ends the rotation about {axis}"),
            };
            Some(format!(
                "joint \"{name}\" has laws about {first} or {last}, and {way}: near ±90° these have no direction, and steps become very small\n  \
                 help: end the rotation about {axis} by stops within ±80°, or let another rotation be the middle one of the three \
                 (`about: {{ order: yxz, … }}`), or use `flexion` and `torsion`"
            ))
        })
        .collect()
}

/// Warnings about bushings with laws about x or z, if no elastic law ends the rotation about y.
fn bushings(model: &Model) -> Vec<String> {
    if model.dimension == Dimension::Plane {
        return Vec::new();
    }
    let none = Direction::default();
    let mut all = Vec::new();
    for force in &model.forces {
        let ForceKind::Bushing(bushing) = ForceKind::of(force) else {
            continue;
        };
        let [x, y, z] = &bushing.about;
        if (*x != none || *z != none) && y.elastic.is_none() {
            all.push(format!(
                "bushing \"{}\" has laws about x or z, and nothing ends the rotation about y: at ±90° these have no direction\n  \
                 help: give it a stiffness about y, or turn its frames so that the widest rotation is about x or z; a law that is the same about all axes \
                 is `about: {{ turn: … }}`",
                force.name
            ));
        }
    }
    all
}

/// The largest distance of the middle angle from 0 \[rad\], infinite if nothing ends the rotation; `None` if it stays
/// within ±80°. Without a stop, an elastic torque is assumed to end the rotation.
fn middle_angle(law: &JointTorque, defaults: &[f64]) -> Option<f64> {
    let stop = law.stop.as_ref();
    let open = if law.elastic.is_some() {
        0.0
    } else {
        f64::INFINITY
    };
    let to = stop.and_then(|stop| stop.to.as_ref());
    let from = stop.and_then(|stop| stop.from.as_ref());
    let ends = [
        to.map_or(open, |to| to.value(defaults)),
        from.map_or(open, |from| -from.value(defaults)),
    ];
    let far = ends[0].max(ends[1]);
    // 80° counts as 80° in spite of rounding
    (far > FRAC_PI_2 - NEAR + 1e-9).then_some(far)
}
