//! Generalised forces in the frames of links, by the recursive Newton–Euler algorithm.   \[Featherstone 2008, ch. 5\]
//!
//! From the leaves to the root, every link passes on the wrench that it and the links it carries need. The power of
//! this wrench per velocity is the generalised force. The effect of a field a that is the same everywhere follows from
//! the composite body of a link alone: (m a, h × a).

use super::body::Body;
use super::motion::LinkMotion;
use super::tree::{Carried, LinkJoint};
use super::turn::back_through;
use super::wrench::{Arrived, Written};
use crate::dynamics::spatial::Wrench;
use crate::expression::Expr;
use crate::expression::vector::Vec3;

/// The generalised forces by row; for a part of a tree also the wrenches that the part passes on to the rest.
pub struct Forces<'g> {
    /// Terms by row. Terms of the same row must be added.
    pub terms: Vec<(usize, Expr<'g>)>,
    /// The wrenches that a part of a tree passes on.
    pub passed: Vec<Wrench<'g>>,
}

/// The wrenches that the links need in the reference motion, minus the wrenches that act on them.
pub fn needed<'g>(written: &Written<'g, '_>, motions: &[LinkMotion<'g>]) -> Vec<Wrench<'g>> {
    let links = written.tree.links.iter().zip(&written.framed.links);
    let links = links.zip(&written.choice.links).zip(motions).enumerate();
    links
        .map(|(k, (((link, frame), chosen), motion))| {
            let needed = motion.inertia(&frame.in_reference, chosen.by_inertia);
            let load = frame.load(link, written.choice, k == 0 && written.tree.free);
            Wrench {
                force: needed.force - load.force,
                moment: needed.moment - load.moment,
            }
        })
        .collect()
}

/// The power of wrenches per velocity, by row: for each velocity the sum over all links that it moves. The wrenches are
/// in the axes of the links.
pub fn powers<'g>(
    written: &Written<'g, '_>,
    wrenches: Vec<Wrench<'g>>,
    name: &dyn Fn(usize) -> String,
) -> Forces<'g> {
    let (tree, graph) = (written.tree, written.tree.graph);
    let mut forces = Forces {
        terms: Vec::new(),
        passed: Vec::new(),
    };
    let mut in_link = wrenches;
    let mut absolute = vec![Wrench::none(graph); in_link.len()];
    for (k, link) in tree.links.iter().enumerate().rev() {
        graph.section(format!("element {}: forces", name(k)));
        if let Some(Carried::Composite { needed, .. }) = &link.carries {
            in_link[k] = in_link[k].plus(*needed);
        }
        if k == 0 && tree.carrier.is_some() {
            forces.passed.extend([in_link[0], absolute[0]]);
            continue;
        }
        let own = written.settled(k, Arrived::InLink(in_link[k]));
        let wrench = own.plus(absolute[k]);
        forces.terms.extend(written.powers(k, &wrench));
        match link.parent {
            Some(parent) => match written.on_parent(k, parent, wrench) {
                Arrived::InLink(passed) => in_link[parent] = in_link[parent].plus(passed),
                Arrived::Absolute(passed) => absolute[parent] = absolute[parent].plus(passed),
            },
            None => forces.terms.extend(written.on_base(&wrench)),
        }
    }
    forces
}

/// The generalised forces of a field that is the same everywhere, given in absolute axes, by row.
pub fn of_field<'g>(
    written: &Written<'g, '_>,
    composites: &[Body<'g>],
    field: Vec3<'g>,
) -> Vec<(usize, Expr<'g>)> {
    let (tree, unit) = (written.tree, written.choice.unit);
    let field = (1.0 / unit) * field;
    let mut seen: Vec<Vec3<'g>> = Vec::new();
    let mut forces = Vec::new();
    for (k, (link, frame)) in tree.links.iter().zip(&written.framed.links).enumerate() {
        let body = &composites[k];
        let here = match (&link.joint, link.parent) {
            (LinkJoint::Ball { .. }, _) => field,
            (LinkJoint::Axis { .. }, None) => {
                back_through(&frame.turns, tree.ground.axes.transposed_times(field))
            }
            (LinkJoint::Axis { .. }, Some(parent)) => {
                let carrier = match tree.links[parent].joint.is_ball() {
                    true => written.framed.links[parent]
                        .axes
                        .transposed_times(seen[parent]),
                    false => seen[parent],
                };
                back_through(&frame.turns, carrier)
            }
        };
        let first = match link.joint.is_ball() {
            true => frame.axes.times(body.first),
            false => body.first,
        };
        let wrench = Wrench {
            force: body.mass * here,
            moment: first.cross(here),
        };
        forces.extend(written.powers(k, &wrench));
        if k == 0 {
            forces.extend(written.on_base(&wrench));
        }
        seen.push(here);
    }
    forces
}
