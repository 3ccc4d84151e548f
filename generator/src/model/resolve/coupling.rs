//! Freedoms that follow others, like gears.
//!
//! q = ratio · q of the leader + offset,   q̇ = ratio · q̇ of the leader
//!
//! A follower has no coordinate. With its own column H, it adds ratio · H to the motion of its element per velocity of
//! the leader. If the leader follows another one, the follower follows the first: q = a (b q' + c) + d = a b q' + (a
//! c + d).

use super::Resolver;
use super::joint::{freedom_named, spellings};
use crate::description::joint::{
    Follows as Written, Freedom as WrittenFreedom, Joint as WrittenJoint,
};
use crate::description::place::At;
use crate::diagnostic::{quoted, suggestion};
use crate::model::{Element, Follows, Number};
use crate::model::{Freedom, Joint};
use std::collections::BTreeMap;

/// A freedom: its element, and its index in the joint of the element.
type FreedomIndex = (usize, usize);

/// Couples the freedoms of a system, given the joints as written, by element.
pub(crate) fn couple(
    resolver: &Resolver<'_>,
    system: &str,
    joints: &[(Option<&WrittenJoint>, At<'_>)],
    elements: &mut [Element],
) {
    let mut coupled: BTreeMap<FreedomIndex, (Follows, At<'_>)> = BTreeMap::new();
    for (k, (joint, at)) in joints.iter().enumerate() {
        let Some(joint) = joint else { continue };
        let mut first = 0;
        for (one, at) in joint.each(*at) {
            let place = at.key("follows");
            if let (Some(follows), 1) = (&one.follows, width(resolver, one))
                && first < elements[k].joint.freedoms().len()
                && let Some(follows) =
                    leader(resolver, system, follows, place, (k, first), elements)
            {
                coupled.insert((k, first), (follows, place));
            }
            first += width(resolver, one);
        }
    }
    for (&(k, j), (_, at)) in &coupled {
        let mut seen = vec![(k, j)];
        let mut follows = coupled[&(k, j)].0.clone();
        while let Some((next, _)) = coupled.get(&(follows.element, follows.freedom)) {
            let leader = (follows.element, follows.freedom);
            if seen.contains(&leader) {
                break;
            }
            seen.push(leader);
            follows = next.clone().followed(follows.ratio, follows.offset);
        }
        if coupled.contains_key(&(follows.element, follows.freedom)) {
            // a circle is reported once, by its first member; freedoms that follow a member of it are not
            // part of it
            let circle = seen
                .iter()
                .position(|s| *s == (follows.element, follows.freedom));
            if circle == Some(0) && seen.iter().min() == Some(&(k, j)) {
                resolver.problems.add(at.problem(
                    match seen.len() {
                        1 => "this freedom follows itself".to_owned(),
                        n => format!("{n} freedoms follow each other in a circle"),
                    },
                    "remove `follows` from one of them: it is the one that all follow",
                ));
            }
            continue;
        }
        elements[k].joint.freedoms_mut()[j].follows = Some(follows);
    }
}

/// The leader of a freedom, with ratio and offset.
fn leader(
    resolver: &Resolver<'_>,
    system: &str,
    written: &Written,
    at: At<'_>,
    (element, freedom): FreedomIndex,
    elements: &[Element],
) -> Option<Follows> {
    let Some(leader) = elements.iter().position(|e| e.name == written.joint) else {
        let place = at.key("joint");
        let message = format!(
            "the system {} has no element {}",
            quoted(system),
            quoted(&written.joint)
        );
        let foreign = written.joint.contains('/') || resolver.has_element_elsewhere(&written.joint);
        resolver.problems.add(match foreign {
            true => place.problem(
                format!("{message}, and a freedom follows one of its own system alone"),
                "describe both as one system, on a root that rests: `joint: weld` with `reference: fixed`",
            ),
            false => place.problem(
                message,
                suggestion(
                    &written.joint,
                    elements.iter().map(|e| e.name.as_str()),
                    "it has no elements",
                ),
            ),
        });
        return None;
    };
    let path = format!("{system}/{}", elements[leader].name);
    if elements[leader].joint == Joint::Ball {
        resolver.problems.add(at.key("joint").problem(
            format!(
                "{} is on a joint without a coordinate of its own",
                quoted(&path)
            ),
            match resolver.planar {
                true => "write `joint: { hinge: y }` there",
                false => "follow a hinge, a slider or a freedom of a list: there is no ratio to an orientation",
            },
        ));
        return None;
    }
    let freedoms = elements[leader].joint.freedoms();
    let followed = freedom_named(resolver, written.freedom.as_deref(), &path, freedoms, at)?;
    let own = elements[element].joint.freedoms()[freedom]
        .kind
        .coordinate();
    let ratio = own.per(freedoms[followed].kind.coordinate());
    Some(Follows {
        element: leader,
        freedom: followed,
        ratio: match &written.ratio {
            Some(written) => resolver.number_in(written, at.key("ratio"), ratio),
            None => Number::Constant(1.0),
        },
        offset: match &written.offset {
            Some(written) => resolver.number_in(written, at.key("offset"), own.value()),
            None => Number::ZERO,
        },
    })
}

/// Sets the positions and rates at the start for freedoms that follow others.
pub(crate) fn start_followers(elements: &mut [Element]) {
    let of = |freedom: &Freedom| Some(freedom.follows.as_ref()?.start(elements));
    let starts: Vec<Vec<_>> = (elements.iter())
        .map(|e| e.joint.freedoms().iter().map(of).collect())
        .collect();
    for (element, starts) in elements.iter_mut().zip(starts) {
        for (freedom, start) in element.joint.freedoms_mut().iter_mut().zip(starts) {
            if let Some(start) = start {
                [freedom.position, freedom.rate] = start;
            }
        }
    }
}

/// The number of freedoms of a joint as written.
fn width(resolver: &Resolver<'_>, written: &WrittenFreedom) -> usize {
    let spellings = spellings(resolver, written);
    spellings
        .first()
        .map_or(1, |spelling| spelling.written.coordinates.len())
}
