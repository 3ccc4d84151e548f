//! The root of the tree of links.

use super::robot::Robot;
use super::tree::Problem;
use crate::diagnostic::quoted;

/// The only link that is not a child.
pub fn root(robot: &Robot) -> Result<usize, Vec<Problem>> {
    let mut problems: Vec<Problem> = Vec::new();
    let mut inboard: Vec<Option<usize>> = vec![None; robot.links.len()];
    for (index, joint) in robot.joints.iter().enumerate() {
        match inboard[joint.child] {
            None => inboard[joint.child] = Some(index),
            Some(first) => problems.push(Problem::new(
                joint.place,
                format!(
                    "the link {} is a child twice, of {} and of {}",
                    quoted(&robot.links[joint.child].name),
                    quoted(&robot.joints[first].name),
                    quoted(&joint.name)
                ),
                "URDF describes trees: one joint carries a link".to_owned(),
            )),
        }
    }
    let roots: Vec<usize> = (0..robot.links.len())
        .filter(|&l| inboard[l].is_none())
        .collect();
    if let [first, others @ ..] = &roots[..] {
        for &other in others {
            problems.push(Problem::new(
                robot.links[other].place,
                format!(
                    "there are two root links, {} and {}",
                    quoted(&robot.links[*first].name),
                    quoted(&robot.links[other].name)
                ),
                "add the joint that carries one of them".to_owned(),
            ));
        }
    }
    // a walk inwards that is longer than the number of links goes in a circle
    for link in 0..robot.links.len() {
        let mut at = link;
        for _ in 0..robot.links.len() {
            match inboard[at] {
                Some(joint) => at = robot.joints[joint].parent,
                None => break,
            }
            if at == link {
                let joint = &robot.joints[inboard[link].unwrap_or(0)];
                problems.push(Problem::new(
                    joint.place,
                    format!(
                        "the link {} carries itself",
                        quoted(&robot.links[link].name)
                    ),
                    "URDF describes trees: remove a joint of the circle".to_owned(),
                ));
                return Err(problems);
            }
        }
    }
    match (problems.is_empty(), roots.first()) {
        (true, Some(&root)) => Ok(root),
        _ => Err(problems),
    }
}
