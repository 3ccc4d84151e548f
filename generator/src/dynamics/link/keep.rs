//! Moves a part of the regrouped bodies back to a child, for the reference motion only.
//!
//! A point of mass μ on the axis of a hinge moves with both of its links. Let the joint to the hinge be at r on the parent. If a point of μ = h_k /
//! r_k is taken from the parent and given to the child, h_k of the parent is 0 and the child has m = μ. The part of the point that the parent's own
//! hinge does not feel is passed on to its parent.

use super::body::{Body, Numbers, numbers};
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
    let mut keeper = Keeper {
        tree,
        links,
        numbers: links.iter().map(|link| Numbers::of(&link.body)).collect(),
        points: vec![0.0; links.len()],
    };
    let mut changed = vec![false; links.len()];
    for k in (0..links.len()).rev() {
        let Some((child, axis)) = choice.links[k].keep else {
            continue;
        };
        if !can_keep(tree, k, child, links[child].place, axis) {
            continue;
        }
        let mut before = Vec::new();
        let point = keeper.keep((k, child, axis), &mut before);
        for (link, own) in before.into_iter().rev() {
            match point {
                Some(_) => changed[link] = true,
                None => keeper.numbers[link] = Some(own),
            }
        }
        keeper.points[child] = point.unwrap_or(0.0);
    }
    let graph = tree.graph;
    let body = |k: usize| match keeper.numbers[k] {
        Some(numbers) if changed[k] => numbers.body(graph),
        Some(_) => links[k].body,
        // a body with parameters takes the point as it is
        None => links[k]
            .body
            .plus(&Numbers::point(keeper.points[k]).body(graph)),
    };
    (0..links.len()).map(body).collect()
}

/// Moves points between bodies, as numbers: a trial does so for every link of a part, and each change goes through all links that carry it.
struct Keeper<'a, 'g> {
    tree: &'a Tree<'g>,
    links: &'a [Constant<'g>],
    /// The bodies; `None` for those that are no numbers.
    numbers: Vec<Option<Numbers>>,
    /// The mass of the point that each link keeps \[kg\].
    points: Vec<f64>,
}

impl Keeper<'_, '_> {
    /// Gives a component of the first moment of link `k` to a child. Returns the mass of the point, or `None` if something is no number or too large. `before`
    /// gets the bodies that were changed.
    fn keep(
        &mut self,
        (k, child, axis): (usize, usize, usize),
        before: &mut Vec<(usize, Numbers)>,
    ) -> Option<f64> {
        let (tree, links) = (self.tree, self.links);
        let too_large = |of: &Numbers, link: usize| {
            let own = links[link].body.sizes;
            (0..2).any(|i| of.sizes[i] > LARGER[i] * own[i])
        };
        let place = numbers(links[child].place)?;
        let body = self.numbers[k]?;
        let mass = body.first[axis] / place[axis];
        let [first, second] = links[k].body.sizes;
        if mass.abs() * second > LARGER[0] * first * first {
            return None;
        }
        let point = Numbers::point(mass);
        if let Some(own) = self.numbers[child] {
            self.set(child, own.plus(&point), before);
        }
        let mut rest = body.minus(&point.moved(place));
        rest.first[axis] = 0.0;
        // the part that the joint of the link does not feel is passed on
        let mut link = k;
        loop {
            if too_large(&rest, link) {
                return None;
            }
            if !tree.links[link].joint.is_hinge() {
                self.set(link, rest, before);
                return Some(mass);
            }
            let unfelt = rest.unfelt_about_z();
            self.set(link, rest.minus(&unfelt).felt(true), before);
            match tree.links[link].parent {
                Some(parent) if parent > 0 || tree.carrier.is_none() => {
                    let place = numbers(links[link].place)?;
                    let passed = unfelt.in_axes(&links[link].against).moved(place);
                    // what is no number has no size that could be compared
                    rest = self.numbers[parent]?.plus(&passed);
                    link = parent;
                }
                _ => return Some(mass),
            }
        }
    }

    fn set(&mut self, link: usize, body: Numbers, before: &mut Vec<(usize, Numbers)>) {
        before.extend(self.numbers[link].replace(body).map(|own| (link, own)));
    }
}
