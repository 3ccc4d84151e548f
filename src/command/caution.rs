//! Warnings about likely problems in the runs of a valid model.

pub mod singular;

use bryant_generator::model::{Active, Dimension, Direction, ForceKind, JointTorque, Model};
use std::f64::consts::FRAC_PI_2;

/// The middle one of three relative angles is critical within this distance of ±90°: 10° \[rad\].
const NEAR: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// The warnings, each a sentence with a remedy.
pub fn cautions(model: &Model) -> Vec<String> {
    let mut all = middle_angles(model);
    all.extend(bushings(model));
    all.extend(singular::cautions(model));
    all
}

/// Warns of laws about the three relative angles of a ball joint if the middle angle may come near ±90°.
fn middle_angles(model: &Model) -> Vec<String> {
    if model.dimension == Dimension::Plane {
        return Vec::new();
    }
    let joints = || {
        model.forces.iter().filter_map(|force| match &force.kind {
            ForceKind::Joint(law) => Some((force, law.child, &law.about)),
            _ => None,
        })
    };
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let none = JointTorque::default();
    joints()
        .filter_map(|(force, child, [x, y, z])| {
            let name = &force.name;
            if *x == none && *z == none {
                return None;
            }
            // a law of any force ends the rotation of this joint if it always acts about y
            let always = joints().filter(|(other, element, _)| {
                *element == child && other.active == Active::default()
            });
            let mut ends = vec![y];
            ends.extend(always.map(|(_, _, [_, y, _])| y));
            let reaches = ends.iter().map(|y| middle_angle(y, &defaults));
            let reaches = reaches.reduce(|a, b| Some(a?.min(b?))).flatten()?;
            let way = match reaches.is_finite() {
                true => format!("its stops let the angle about y come to {:.0}°", reaches.to_degrees()),
                false => "nothing ends the rotation about y".to_owned(),
            };
            Some(format!(
                "joint \"{name}\" has laws about x or z, and {way}: near ±90° these have no direction, and steps become very small\n  \
                 help: end the rotation about y by stops within ±80°, or turn the frames so that the widest rotation is about x or z, or \
                 use `flexion` and `torsion`"
            ))
        })
        .collect()
}

/// Warns of bushings with laws about x or z if nothing elastic ends the rotation about y.
fn bushings(model: &Model) -> Vec<String> {
    if model.dimension == Dimension::Plane {
        return Vec::new();
    }
    let none = Direction::default();
    let mut all = Vec::new();
    for force in &model.forces {
        let ForceKind::Bushing(bushing) = &force.kind else {
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

/// How far from 0 the middle angle may go \[rad\]; `None` if that is not within 10° of ±90°, infinite if nothing ends the rotation. If
/// there is no stop, an elastic torque is assumed to end it.
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
    // an angle that is 80° but for rounding counts as 80°
    (far > FRAC_PI_2 - NEAR + 1e-9).then_some(far)
}
