//! Changes of the inertia of a robot that cannot be a model as it is written, each with a sentence about it.

use super::inertia::{nearest, norm, wrong_tensor};
use super::robot::{Frame, Inertial, JointType, Robot};
use super::tree::Repair;
use crate::diagnostic::quoted;
use crate::rotation::{IDENTITY, Matrix, add, scale};

/// The mass of each link of a robot without masses \[kg\].
const MASS: f64 = 1.0;
/// The mass of a link without one, as a part of that of the robot.
const PART: f64 = 1e-3;
/// The density of the ball whose moments a stand-in has \[kg/m³\]: that of water.
const DENSITY: f64 = 1000.0;

/// The moments of inertia of a ball of water: 2/5 m r², m = 4/3 π ρ r³.
pub fn ball(mass: f64) -> Matrix {
    let radius = libm::cbrt(mass / (4.0 / 3.0 * std::f64::consts::PI * DENSITY));
    IDENTITY.map(|row| scale(row, 0.4 * mass * radius * radius))
}

/// A number with three digits: a stand-in means no more.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Makes a change; returns what to say about it.
pub fn apply(robot: &mut Robot, repair: &Repair) -> Vec<String> {
    match repair {
        Repair::All => {
            let all = 0..robot.links.len();
            all.map(|link| give_mass(robot, link, MASS)).collect()
        }
        Repair::Mass(link) => {
            let masses = robot.links.iter().filter_map(|l| l.inertial.as_ref());
            let total: f64 = masses.map(|i| i.mass).sum();
            let mass = match total > 0.0 {
                true => rounded(PART * total),
                false => MASS,
            };
            vec![give_mass(robot, *link, mass)]
        }
        Repair::Tensor(links) => links
            .iter()
            .filter_map(|&l| give_tensor(robot, l))
            .collect(),
        Repair::Fixed(joints) => joints
            .iter()
            .map(|&joint| {
                let joint = &mut robot.joints[joint];
                joint.kind = JointType::Fixed;
                joint.mimic = None;
                format!(
                    "the joint {} moves no mass: it is fixed",
                    quoted(&joint.name)
                )
            })
            .collect(),
    }
}

/// Gives a link a mass, half way to what it carries, and the moments of a ball if it has none.
fn give_mass(robot: &mut Robot, link: usize, mass: f64) -> String {
    let carried = robot.joints.iter().filter(|j| j.parent == link);
    let places: Vec<_> = carried.map(|j| j.origin.at).collect();
    let sum = places.iter().fold([0.0; 3], |sum, at| add(sum, *at));
    let at = scale(sum, 0.5 / places.len().max(1) as f64);
    let own = &mut robot.links[link];
    let name = quoted(&own.name);
    match &mut own.inertial {
        Some(inertial) if inertial.tensor != [[0.0; 3]; 3] => {
            inertial.mass = mass;
            format!("{name} has the mass {mass} kg instead of none")
        }
        inertial => {
            let place = own.place;
            *inertial = Some(Inertial {
                place,
                frame: Frame { at, turn: IDENTITY },
                mass,
                tensor: ball(mass),
                tensor_place: place,
            });
            let [x, y, z] = at.map(|x| (x * 1e4).round() / 1e4);
            format!(
                "{name} has the mass {mass} kg at [{x}, {y}, {z}] of its frame, with the moments of a ball of water, instead of none"
            )
        }
    }
}

/// Replaces a tensor that no body has by the nearest that one has.
fn give_tensor(robot: &mut Robot, link: usize) -> Option<String> {
    let own = &mut robot.links[link];
    let inertial = own.inertial.as_mut()?;
    wrong_tensor(&inertial.tensor)?;
    let old = inertial.tensor;
    inertial.tensor = nearest(&old);
    let difference =
        std::array::from_fn(|i| std::array::from_fn(|j| inertial.tensor[i][j] - old[i][j]));
    Some(format!(
        "the tensor of {} (line {}), which no body has, becomes the nearest one of a body, {:.3} % of its Frobenius norm away",
        quoted(&own.name),
        inertial.tensor_place.0,
        100.0 * norm(&difference) / norm(&old)
    ))
}

/// Gives a link that turns without inertia the moments of a ball of its mass; `None` if it has moments.
pub fn give_moments(robot: &mut Robot, link: usize) -> Option<String> {
    let own = &mut robot.links[link];
    let inertial = own.inertial.as_mut().filter(|i| i.mass > 0.0)?;
    let new = ball(inertial.mass);
    if norm(&inertial.tensor) >= norm(&new) {
        return None;
    }
    inertial.tensor = new;
    Some(format!(
        "{} turns without inertia: it has the moments of a ball of water of its mass, {:.3e} kg·m²",
        quoted(&own.name),
        new[0][0]
    ))
}
