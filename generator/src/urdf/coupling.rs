//! Joints that follow others: they are of one system.

use super::inertia::Part;
use super::repair::ball;
use super::robot::{Joint, Robot};
use super::tree::{Carried, Element, Forest, Problem, System};
use crate::diagnostic::quoted;

/// For each joint, its system and number of freedoms.
fn freedoms(robot: &Robot, forest: &Forest) -> Vec<Option<(usize, usize)>> {
    let mut freedoms: Vec<Option<(usize, usize)>> = vec![None; robot.joints.len()];
    for (s, system) in forest.systems.iter().enumerate() {
        for element in &system.elements {
            if let Carried::Joint(list) = &element.carried {
                for freedom in list {
                    let count = freedoms[freedom.joint].map_or(0, |(_, count)| count);
                    freedoms[freedom.joint] = Some((s, count + 1));
                }
            }
        }
    }
    freedoms
}

fn leader(robot: &Robot, joint: &Joint) -> Option<usize> {
    let name = &joint.mimic.as_ref()?.leader;
    robot.joints.iter().position(|j| j.name == *name)
}

/// Whether going from leader to leader leads back to a joint.
fn is_in_circle(robot: &Robot, joint: usize) -> bool {
    let joints = &robot.joints;
    let mut at = joint;
    for _ in 0..joints.len() {
        match leader(robot, &joints[at]) {
            Some(leader) if leader == joint => return true,
            Some(leader) => at = leader,
            None => return false,
        }
    }
    false
}

/// Joints that cannot follow: the leader must have one freedom, and there must be no circle.
pub fn problems(robot: &Robot, forest: &Forest) -> Vec<Problem> {
    let freedoms = freedoms(robot, forest);
    let mut problems = Vec::new();
    for (index, joint) in robot.joints.iter().enumerate() {
        let (Some(mimic), Some((_, own))) = (&joint.mimic, freedoms[index]) else {
            continue;
        };
        let name = quoted(&joint.name);
        let other = quoted(&mimic.leader);
        let wrong = match leader(robot, joint).map(|leader| freedoms[leader]) {
            _ if own > 1 => Some("has several freedoms, and only one can follow".to_owned()),
            None | Some(None) => Some(format!("follows {other}, which does not move")),
            Some(Some((_, 2..))) => Some(format!("follows {other}, which has several freedoms")),
            Some(Some(_)) if is_in_circle(robot, index) => {
                Some(format!("follows {other}, and so itself"))
            }
            Some(Some(_)) => None,
        };
        if let Some(wrong) = wrong {
            problems.push(Problem::new(
                mimic.place,
                format!("the joint {name} {wrong}"),
                "with `bryant import --uncouple` it moves by itself; or make its type `fixed`",
            ));
        }
    }
    problems
}

/// Makes one system of all systems in which a joint follows one of another system: freedoms of different systems cannot
/// be coupled. What carried their roots becomes its root, an element that rests. Its mass has no influence; it is that
/// of its part, or a stand-in.
pub fn join(robot: &Robot, forest: &mut Forest, root: usize, part: Option<Part>) {
    let freedoms = freedoms(robot, forest);
    let mut coupled = vec![false; forest.systems.len()];
    for (index, joint) in robot.joints.iter().enumerate() {
        let of_leader = leader(robot, joint).and_then(|leader| freedoms[leader]);
        if let (Some((own, _)), Some((other, _))) = (freedoms[index], of_leader)
            && own != other
        {
            (coupled[own], coupled[other]) = (true, true);
        }
    }
    let Some(first) = coupled.iter().position(|c| *c) else {
        return;
    };
    if part.is_some() {
        forest.still.retain(|&link| link != root);
    }
    let palm = part.unwrap_or(Part {
        link: root,
        mass: 1.0,
        center: [0.0; 3],
        tensor: ball(1.0),
    });
    let mut joined = vec![Element {
        link: root,
        on: None,
        origin: [0.0; 3],
        carried: Carried::Weld,
        mass: palm.mass,
        center: palm.center,
        tensor: palm.tensor,
    }];
    let mut systems: Vec<System> = Vec::new();
    // for each system, where it is now and how many elements are before its own
    let mut moved = Vec::new();
    for (index, system) in std::mem::take(&mut forest.systems).into_iter().enumerate() {
        if index == first {
            systems.push(System {
                free: false,
                elements: Vec::new(),
            });
        }
        if coupled[index] {
            let before = joined.len();
            moved.push((first, before));
            joined.extend(system.elements.into_iter().map(|element| Element {
                on: Some(element.on.map_or(0, |on| on + before)),
                ..element
            }));
        } else {
            moved.push((systems.len(), 0));
            systems.push(system);
        }
    }
    systems[first].elements = joined;
    forest.systems = systems;
    for marker in &mut forest.markers {
        marker.on = marker.on.map(|(system, element)| {
            let (now, before) = moved[system];
            (now, element + before)
        });
    }
}
