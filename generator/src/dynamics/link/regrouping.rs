//! For the reference motion only, moves a part of the regrouped bodies from a link back to its child.
//!
//! A point mass μ on the axis of a hinge moves with both links of the hinge, so it may be counted to either. Let the
//! hinge be at r on the parent. If a point mass μ = h_k / r_k is moved from the parent to the child, h_k of the parent
//! becomes 0 and the child gets m = μ. The part of the change that the parent's own hinge does not feel is passed on to
//! the parent's parent.

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
    /// The constant rotation from the link's axes to the parent's, without the joint's rotation about z.
    pub against: Matrix,
}

/// How many times larger the numbers of a first and of a second moment may become. Large numbers of opposite signs lose
/// this factor of their accuracy. For h, 256 is harmless: some 50 roundings of 256 ε are 3e-12.
///
/// A body with the sizes h and Σ has about the mass h²/Σ, so the bound on the point mass is |μ| ≤ 256 h²/Σ.
const LARGER: [f64; 2] = [256.0, 16.0];

/// True if a child can keep h_k of its parent.
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
        // a body with parameters gets the point mass as nodes
        None => links[k]
            .body
            .plus(&Numbers::point(keeper.points[k]).body(graph)),
    };
    (0..links.len()).map(body).collect()
}

/// Moves point masses between bodies in numbers. A trial does so for every link of a part, and each change passes
/// through all links inboard.
struct Keeper<'a, 'g> {
    tree: &'a Tree<'g>,
    links: &'a [Constant<'g>],
    /// The bodies; `None` for those with entries that are not numbers.
    numbers: Vec<Option<Numbers>>,
    /// The point mass that each link keeps \[kg\].
    points: Vec<f64>,
}

impl Keeper<'_, '_> {
    /// Gives a component of the first moment of link `k` to a child. Returns the point mass, or `None` if an entry is
    /// not a number or becomes too large. Appends the bodies before their change to `before`.
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
            let passive = rest.not_resisting_about_z();
            self.set(link, rest.minus(&passive).regrouped(true), before);
            match tree.links[link].parent {
                Some(parent) if parent > 0 || tree.carrier.is_none() => {
                    let place = numbers(links[link].place)?;
                    let passed = passive.in_axes(&links[link].against).moved(place);
                    // a body that is not in numbers has no size for the comparison
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
