//! Mirror images of joints with coordinates of their own.
//!
//! A mirror M reverses one axis. The image of a sliding along d is one along M d; the image of a turn about n is one by
//! the same angle about −M n, for n is axial; what does both gets the other hand, and the numbers that say its hand
//! change sign. With these axes the image has the coordinates of its element: the same start, the same laws.

use super::{Expander, Node, mirror::negated};
use crate::description::joint::Coordinate;
use crate::description::tree::{Entry, NodeKind};
use crate::diagnostic::quoted;

const NAMES: [&str; 3] = ["x", "y", "z"];

impl Expander<'_> {
    /// The image of a joint of a system, with the freedoms of the joint in their order.
    pub fn mirrored_joint(&mut self, system: &str, joint: &Node) -> Node {
        let plain = |word: &str| Node::plain(word, joint.span);
        let directions: &[usize] = if self.planar { &[0, 2] } else { &[0, 1, 2] };
        let turns: &[usize] = if self.planar { &[1] } else { &[0, 1, 2] };
        let along = |file: &Self, axes: &[usize]| -> Vec<Node> {
            let axes = axes
                .iter()
                .map(|&axis| file.mirrored_axis(&plain(NAMES[axis]), false));
            axes.map(|axis| one("slider", axis)).collect()
        };
        let freedoms: Vec<Node> = match (&joint.kind, joint.text()) {
            (NodeKind::List(list), _) => {
                let each = list
                    .iter()
                    .map(|freedom| self.mirrored_freedom(system, freedom));
                each.collect::<Vec<_>>().concat()
            }
            (NodeKind::Map(_), _) => self.mirrored_freedom(system, joint),
            (_, Some("translation")) => along(self, directions),
            (_, Some("free")) => {
                let hinges = turns
                    .iter()
                    .map(|&axis| self.mirrored_axis(&plain(NAMES[axis]), true));
                let hinges: Vec<Node> = hinges.map(|axis| one("hinge", axis)).collect();
                [along(self, directions), hinges].concat()
            }
            _ => return joint.clone(),
        };
        match (&joint.kind, &freedoms[..]) {
            (NodeKind::Map(_), [single]) => single.clone(),
            _ => Node {
                span: joint.span,
                kind: NodeKind::List(freedoms),
            },
        }
    }

    /// The image of one joint as written; several where the image of a short form is none.
    fn mirrored_freedom(&mut self, system: &str, freedom: &Node) -> Vec<Node> {
        if let Some(axes) = freedom.get("universal") {
            let axes = axes
                .items()
                .iter()
                .map(|axis| self.mirrored_axis(axis, true));
            return axes.map(|axis| one("hinge", axis)).collect();
        }
        if let Some(axis) = freedom.get("cylinder") {
            return vec![
                one("slider", self.mirrored_axis(axis, false)),
                one("hinge", self.mirrored_axis(axis, true)),
            ];
        }
        if let Some(normal) = freedom.get("planar") {
            let Some(word) = normal.text() else {
                self.problem(
                    normal.span,
                    "the mirror image of a planar joint is known of the normals x, y and z"
                        .to_owned(),
                    "write `planar: z`, or a list of two sliders and a hinge".to_owned(),
                );
                return vec![freedom.clone()];
            };
            let across = NAMES.into_iter().filter(|axis| *axis != word);
            let sliders = across.map(|axis| {
                let axis = Node::plain(axis, normal.span);
                one("slider", self.mirrored_axis(&axis, false))
            });
            let mut all: Vec<Node> = sliders.collect();
            all.push(one("hinge", self.mirrored_axis(normal, true)));
            return all;
        }
        let mut image = freedom.clone();
        for spelling in self.problems.language.joint_keys {
            let turns = spelling.coordinates == [Coordinate::Angle];
            image.change(spelling.key.name, |axis| self.mirrored_axis(axis, turns));
            for key in spelling.handed {
                image.change(key, negated);
            }
        }
        if let Some(follows) = image.get_mut("follows")
            && let Some(leader) = follows.get("joint").cloned()
        {
            let name = leader.text().unwrap_or_default();
            let path = self.known.images.get(&format!("{system}/{name}"));
            match path.map(|path| path[system.len() + 1..].to_owned()) {
                Some(name) => follows.set("joint", leader.with_text(name)),
                None => self.problem(
                    leader.span,
                    format!(
                        "{} has no mirror image, so that it is not known how the image follows",
                        quoted(name)
                    ),
                    "write the element of the other side out, with the ratio that it has there"
                        .to_owned(),
                ),
            }
        }
        vec![image]
    }

    /// The image of an axis that something slides along, or turns about.
    fn mirrored_axis(&self, axis: &Node, turns: bool) -> Node {
        let Some(word) = axis.text() else {
            return match turns {
                true => self.axial(axis),
                false => self.polar(axis),
            };
        };
        let (name, opposite) = match word.strip_prefix('-') {
            Some(name) => (name, true),
            None => (word, false),
        };
        let reverses = (NAMES.get(self.words.axis) == Some(&name)) != turns;
        match reverses != opposite {
            true => axis.with_text(format!("-{name}")),
            false => axis.with_text(name),
        }
    }
}

/// A mapping with one key.
fn one(key: &str, value: Node) -> Node {
    Node {
        span: value.span,
        kind: NodeKind::Map(vec![Entry {
            key: key.to_owned(),
            span: value.span,
            value,
        }]),
    }
}
