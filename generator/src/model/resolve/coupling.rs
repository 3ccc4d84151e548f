//! Freedoms that follow others: which, by how much, and that none follows itself.

use super::Resolver;
use super::quantity::{ANGLE, ANGLE_PER_LENGTH, LENGTH, LENGTH_PER_ANGLE, PURE};
use crate::description::joint::{
    Follows as Written, Freedom as WrittenFreedom, Joint as WrittenJoint,
};
use crate::description::place::At;
use crate::diagnostic::{quoted, suggestion};
use crate::model::{Element, Follows, Joint, Number};
use std::collections::BTreeMap;

/// A freedom: its element, and which of the element's joint it is.
type Place = (usize, usize);

impl Resolver<'_> {
    /// Couples the freedoms of a system, whose joints are as written by element.
    pub fn couple(
        &self,
        system: &str,
        joints: &[(Option<&WrittenJoint>, At<'_>)],
        elements: &mut [Element],
    ) {
        let mut coupled: BTreeMap<Place, (Follows, At<'_>)> = BTreeMap::new();
        for (k, (joint, at)) in joints.iter().enumerate() {
            let written: Vec<(&WrittenFreedom, At<'_>)> = match joint {
                Some(WrittenJoint::One(one)) => vec![(one, *at)],
                Some(WrittenJoint::List(list)) => {
                    let items = list.iter().enumerate();
                    items.map(|(i, one)| (one, at.item(i))).collect()
                }
                _ => continue,
            };
            let mut first = 0;
            for (one, at) in written {
                let place = at.key("follows");
                if let (Some(follows), 1) = (&one.follows, width(one))
                    && first < elements[k].joint.freedoms().len()
                    && let Some(follows) = self.leader(system, follows, place, (k, first), elements)
                {
                    coupled.insert((k, first), (follows, place));
                }
                first += width(one);
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
                // q = a (b q' + c) + d
                let Follows { ratio, offset, .. } = follows;
                let shift = Number::product(ratio.clone(), next.offset.clone());
                follows = Follows {
                    ratio: Number::product(ratio, next.ratio.clone()),
                    offset: Number::sum(shift, offset),
                    ..next.clone()
                };
            }
            if coupled.contains_key(&(follows.element, follows.freedom)) {
                // a circle is reported once, by its first freedom; what leads into it is not one of its own
                let circle = seen
                    .iter()
                    .position(|s| *s == (follows.element, follows.freedom));
                if circle == Some(0) && seen.iter().min() == Some(&(k, j)) {
                    self.problems.add(at.problem(
                        match seen.len() {
                            1 => "this freedom follows itself".to_owned(),
                            n => format!("{n} freedoms follow each other in a circle"),
                        },
                        "remove `follows` from one of them: it is the one that all follow",
                    ));
                }
                continue;
            }
            if let Joint::Freedoms(freedoms) = &mut elements[k].joint {
                freedoms[j].follows = Some(follows);
            }
        }
    }

    fn leader(
        &self,
        system: &str,
        written: &Written,
        at: At<'_>,
        (element, freedom): Place,
        elements: &[Element],
    ) -> Option<Follows> {
        let Some(leader) = elements.iter().position(|e| e.name == written.joint) else {
            self.problems.add(at.key("joint").problem(
                format!(
                    "the system {} has no element {}",
                    quoted(system),
                    quoted(&written.joint)
                ),
                suggestion(
                    &written.joint,
                    elements.iter().map(|e| e.name.as_str()),
                    "it has no elements",
                ),
            ));
            return None;
        };
        let path = format!("{system}/{}", elements[leader].name);
        if elements[leader].joint == Joint::Ball {
            self.problems.add(at.key("joint").problem(
                format!("{} is on a joint without a coordinate of its own", quoted(&path)),
                "follow a hinge with an axis, a slider or a screw: in the plane write `joint: { hinge: y }` there",
            ));
            return None;
        }
        let freedoms = elements[leader].joint.freedoms();
        let followed = self.freedom_named(written.freedom.as_deref(), &path, freedoms, at)?;
        let own = &elements[element].joint.freedoms()[freedom].kind;
        let ratio = match (own.turns(), freedoms[followed].kind.turns()) {
            (true, false) => ANGLE_PER_LENGTH,
            (false, true) => LENGTH_PER_ANGLE,
            _ => PURE,
        };
        let offset = if own.turns() { ANGLE } else { LENGTH };
        Some(Follows {
            element: leader,
            freedom: followed,
            ratio: match &written.ratio {
                Some(written) => self.number(written, at.key("ratio"), ratio),
                None => Number::Constant(1.0),
            },
            offset: match &written.offset {
                Some(written) => self.number(written, at.key("offset"), offset),
                None => Number::ZERO,
            },
        })
    }

    /// Where the freedoms that follow others start, and how fast.
    pub fn start_followers(&self, elements: &mut [Element]) {
        let of = |freedom: &crate::model::Freedom| {
            let follows = freedom.follows.as_ref()?;
            let leader = &elements[follows.element].joint.freedoms()[follows.freedom];
            let times = |n: &Number| Number::product(follows.ratio.clone(), n.clone());
            let position = Number::sum(times(&leader.position), follows.offset.clone());
            Some((position, times(&leader.rate)))
        };
        let starts: Vec<Vec<_>> = (elements.iter())
            .map(|e| e.joint.freedoms().iter().map(of).collect())
            .collect();
        for (element, starts) in elements.iter_mut().zip(starts) {
            let Joint::Freedoms(freedoms) = &mut element.joint else {
                continue;
            };
            for (freedom, start) in freedoms.iter_mut().zip(starts) {
                if let Some(start) = start {
                    (freedom.position, freedom.rate) = start;
                }
            }
        }
    }
}

/// How many freedoms a joint as written stands for.
fn width(written: &WrittenFreedom) -> usize {
    match (&written.universal, &written.cylinder, &written.planar) {
        (Some(_), _, _) | (_, Some(_), _) => 2,
        (_, _, Some(_)) => 3,
        _ => 1,
    }
}
