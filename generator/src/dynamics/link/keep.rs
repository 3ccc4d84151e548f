//! Moves a part of the regrouped bodies back to a child, for the reference motion only.
//!
//! A point of mass μ on the axis of a hinge moves with both of its links. Let the joint to the hinge be at r on the parent. If a point of μ = h_k /
//! r_k is taken from the parent and given to the child, h_k of the parent is 0 and the child has m = μ. The part of the point that the parent's own
//! hinge does not feel is passed on to its parent.

use super::body::Body;
use super::frames::{Choice, Matrix};
use super::tree::{LinkJoint, Tree};
use crate::expression::vector::Vec3;

/// The constant properties of a link.
pub struct Constant<'g> {
    /// Its body, in its axes.
    pub body: Body<'g>,
    /// Its origin from the parent's origin, in the parent's axes.
    pub place: Vec3<'g>,
    /// The rotation from its axes to the parent's, without its own rotation about z.
    pub against: Matrix,
}

/// How many times as large the numbers of a first and of a second moment may become: larger ones of opposite signs lose that factor of their digits. Of
/// h 256 is little: some 50 roundings of 256 ε are 3e-12.
///
/// The numbers of a link, of sizes h and Σ, are those of a mass h²/Σ, so that |μ| ≤ 256 h²/Σ.
const LARGER: [f64; 2] = [256.0, 16.0];

/// Whether a child can keep h_k of its parent.
fn can_keep(tree: &Tree<'_>, parent: usize, child: usize, place: Vec3<'_>, k: usize) -> bool {
    let carries = match &tree.links[parent].joint {
        LinkJoint::Ball { .. } => parent == 0 && tree.free && tree.carrier.is_none(),
        joint => joint.is_hinge() && k < 2,
    };
    let along = place.0[k].as_constant();
    let known = place.0.iter().all(|r| r.as_constant().is_some());
    carries && known && tree.links[child].joint.is_hinge() && along.is_some_and(|r| r != 0.0)
}

/// The bodies for the reference motion.
pub fn kept<'g>(tree: &Tree<'g>, choice: &Choice, links: &[Constant<'g>]) -> Vec<Body<'g>> {
    let mut bodies: Vec<Body<'g>> = links.iter().map(|link| link.body).collect();
    for k in (0..links.len()).rev() {
        let Some((child, axis)) = choice.links[k].keep else {
            continue;
        };
        let place = links[child].place;
        if !can_keep(tree, k, child, place, axis) {
            continue;
        }
        if let Some(changed) = with_kept(tree, links, &bodies, (k, child, axis)) {
            bodies = changed;
        }
    }
    bodies
}

/// The bodies when a child of a link keeps a component of its first moment; `None` if numbers become too large.
fn with_kept<'g>(
    tree: &Tree<'g>,
    links: &[Constant<'g>],
    bodies: &[Body<'g>],
    (k, child, axis): (usize, usize, usize),
) -> Option<Vec<Body<'g>>> {
    let graph = tree.graph;
    let mut bodies = bodies.to_vec();
    let place = links[child].place;
    let too_large = |of: &Body<'g>, link: usize| {
        let own = links[link].body.sizes;
        (0..2).any(|i| of.sizes[i] > LARGER[i] * own[i])
    };
    let point = Body {
        mass: bodies[k].first.0[axis] / place.0[axis],
        ..Body::none(graph)
    };
    let [first, second] = links[k].body.sizes;
    if point.mass.as_constant()?.abs() * second > LARGER[0] * first * first {
        return None;
    }
    bodies[child] = bodies[child].plus(&point);
    let mut rest = bodies[k].minus(&point.moved(place));
    rest.first.0[axis] = graph.constant(0.0);
    // the part that the joint of the link does not feel is passed on
    let mut link = k;
    loop {
        // what is no number has no size that could be compared
        if !rest.is_constant() || too_large(&rest, link) {
            return None;
        }
        let joint = &tree.links[link].joint;
        if !joint.is_hinge() {
            bodies[link] = rest;
            return Some(bodies);
        }
        let unfelt = rest.unfelt_about_z();
        bodies[link] = rest.minus(&unfelt).felt(joint);
        match tree.links[link].parent {
            Some(parent) if parent > 0 || tree.carrier.is_none() => {
                let axes = links[link].against;
                let passed = unfelt.in_axes(&axes).moved(links[link].place);
                rest = bodies[parent].plus(&passed);
                link = parent;
            }
            _ => return Some(bodies),
        }
    }
}
