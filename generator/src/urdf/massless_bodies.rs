//! Bodies that move and have no mass: which they are, and what to do.

use super::robot::{Joint, JointType, Link, Robot};
use super::tree::{Problem, Repair};
use crate::diagnostic::quoted;

/// A body that moves and has no mass.
pub struct Massless {
    pub link: usize,
    /// The joints between it and its carrier; none where it moves freely.
    pub joints: Vec<usize>,
    /// The number of moving joints that it carries.
    pub outboard: usize,
}

/// The problem of a robot without any mass, if something of it moves.
pub fn shape_only(robot: &Robot) -> Option<Problem> {
    let moving: Vec<&Joint> = robot
        .joints
        .iter()
        .filter(|j| j.kind != JointType::Fixed)
        .collect();
    if moving.is_empty() || robot.links.iter().any(|link| !is_frame(link)) {
        return None;
    }
    let names = moving.iter().map(|j| quoted(&robot.links[j.child].name));
    let message = format!(
        "no link of this robot has a mass: the file describes its shape and its joints only; {} of its {} links move: {}",
        moving.len(),
        robot.links.len(),
        listed(names.collect())
    );
    let help = "look for a description of this robot with <inertial>; `bryant import --repair-inertias` gives each link a mass of 1 kg to try things out";
    Some(Problem {
        repairs: vec![Repair::All],
        ..Problem::new(robot.place, message, help)
    })
}

/// Whether a link has neither mass nor inertia.
fn is_frame(link: &Link) -> bool {
    let inertial = link.inertial.as_ref();
    inertial.is_none_or(|i| i.mass == 0.0 && i.tensor.as_flattened().iter().all(|&t| t == 0.0))
}

/// Names with commas, at most twenty.
fn listed(names: Vec<String>) -> String {
    const SHOWN: usize = 20;
    match names.len().checked_sub(SHOWN) {
        None | Some(0) => names.join(", "),
        Some(more) => format!("{} and {more} more", names[..SHOWN].join(", ")),
    }
}

/// Says which bodies have no mass: one by what is wrong with it, several by their names.
pub fn problem(robot: &Robot, massless: &[Massless]) -> Option<Problem> {
    let first = massless.first()?;
    let link = |index: usize| &robot.links[index];
    let names: Vec<String> = massless
        .iter()
        .map(|m| {
            format!(
                "{} (line {})",
                quoted(&link(m.link).name),
                link(m.link).place.0
            )
        })
        .collect();
    let repairs = massless.iter().map(|m| repair(robot, m)).collect();
    let name = quoted(&link(first.link).name);
    let joint = first.joints.last().map(|&j| &robot.joints[j]);
    let place = joint.map_or(link(first.link).place, |joint| joint.place);
    let problem = match (massless, joint) {
        ([_, _, ..], _) => Problem::new(
            place,
            format!(
                "{} links move and have no mass: {}",
                massless.len(),
                listed(names)
            ),
            "give each a mass and an inertia, or make its joint fixed",
        ),
        (_, Some(joint)) if first.outboard == 0 && joint.kind != JointType::Floating => {
            Problem::new(
                place,
                format!(
                    "{name} moves on the joint {} and has no mass: nothing says how fast",
                    quoted(&joint.name)
                ),
                "give the link a mass and an inertia, or make the joint fixed",
            )
        }
        (_, Some(joint)) if joint.kind != JointType::Floating => Problem::new(
            place,
            format!(
                "{name} has no mass, and carries {} joints that move",
                first.outboard
            ),
            "give the link a mass and an inertia; without, it can stand between two joints only",
        ),
        _ => Problem::new(
            place,
            format!("{name} moves freely and has no mass"),
            "give it a mass",
        ),
    };
    Some(problem.with(repairs))
}

/// What removes the problem of a body without mass: an end that nothing follows is fixed, others get a mass.
fn repair(robot: &Robot, massless: &Massless) -> Repair {
    let joints = &robot.joints;
    let leads = |&j: &usize| {
        let mut followers = joints.iter().filter_map(|other| other.mimic.as_ref());
        followers.any(|mimic| mimic.leader == joints[j].name)
    };
    match massless.outboard == 0
        && !massless.joints.is_empty()
        && !massless.joints.iter().any(leads)
    {
        true => Repair::Fixed(massless.joints.clone()),
        false => Repair::Mass(massless.link),
    }
}
