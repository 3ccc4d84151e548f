//! Reads the joints of a URDF file.

use super::inspect::misspelt;
use super::reader::Reader;
use super::robot::{Joint, JointType, Limits, Mimic, Why};
use crate::diagnostic::quoted;
use crate::rotation::{Vector, length, scale};
use roxmltree::Node;
use std::collections::BTreeMap;

impl<'a> Reader<'a> {
    /// A joint, without its rotors.
    pub fn joint(&self, node: Node<'a, 'a>, links: &BTreeMap<String, usize>) -> Option<Joint> {
        let name = self.name(node, "a joint")?;
        let kind = self.kind(node, &name)?;
        let parent = self.link_of_joint(node, "parent", &name, links);
        let outboard = self.link_of_joint(node, "child", &name, links);
        let axis = self.axis(node, kind, &name);
        let limits = self.limits(self.xml.child(node, "limit"), kind, &name, node);
        if let Some(controller) = self.xml.child(node, "safety_controller") {
            self.required(controller, "k_velocity");
        }
        self.without_use(node, kind);
        let [damping, friction] = self.dynamics(node, &name);
        let mimic = self
            .xml
            .child(node, "mimic")
            .and_then(|mimic| self.mimic(mimic, &name));
        Some(Joint {
            place: self.xml.place_of(node, "name"),
            kind,
            parent: parent?,
            child: outboard?,
            origin: self.origin(node),
            axis,
            limits,
            damping,
            friction,
            armature: 0.0,
            mimic,
            name,
        })
    }

    /// Lists the elements of a joint that its type has no use for.
    fn without_use(&self, node: Node<'a, 'a>, kind: JointType) {
        let tags: &[(&str, Why, &str)] = match kind {
            JointType::Fixed => &[
                ("dynamics", Why::Idle, "<dynamics> of fixed joints"),
                ("mimic", Why::Idle, "<mimic> of fixed joints"),
            ],
            JointType::Floating => &[
                ("dynamics", Why::Missing, "<dynamics> of floating joints"),
                ("mimic", Why::Missing, "<mimic> of floating joints"),
            ],
            JointType::Continuous | JointType::Planar => {
                let limit = self.xml.child(node, "limit");
                if let Some(limit) =
                    limit.filter(|l| l.attribute("lower").or(l.attribute("upper")).is_some())
                {
                    let what = "`lower` and `upper` of joints that have no limits";
                    self.leave_out(limit, self.xml.place(limit), Why::Idle, what);
                }
                &[]
            }
            JointType::Revolute | JointType::Prismatic => &[],
        };
        for (tag, why, what) in tags {
            if let Some(found) = self.xml.child(node, tag) {
                self.leave_out(found, self.xml.place(found), *why, what);
            }
        }
    }

    /// The type of a joint.
    fn kind(&self, node: Node<'_, '_>, joint: &str) -> Option<JointType> {
        let message = match node.attribute("type") {
            Some("fixed") => return Some(JointType::Fixed),
            Some("revolute") => return Some(JointType::Revolute),
            Some("continuous") => return Some(JointType::Continuous),
            Some("prismatic") => return Some(JointType::Prismatic),
            Some("planar") => return Some(JointType::Planar),
            Some("floating") => return Some(JointType::Floating),
            Some(other) => format!("there is no type of joint {}", quoted(other)),
            None => format!("the joint {} has no type", quoted(joint)),
        };
        let kinds = [
            "revolute",
            "continuous",
            "prismatic",
            "fixed",
            "floating",
            "planar",
        ];
        let near = misspelt(
            node.attribute("type").unwrap_or_default(),
            kinds.into_iter(),
        );
        let help = match near {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("a `type` is one of {}", kinds.join(", ")),
        };
        self.problem(self.xml.place_of(node, "type"), message, help);
        None
    }

    /// The link that `<parent>` or `<child>` names.
    fn link_of_joint(
        &self,
        node: Node<'a, 'a>,
        tag: &'static str,
        joint: &str,
        links: &BTreeMap<String, usize>,
    ) -> Option<usize> {
        let Some(found) = self.xml.child(node, tag) else {
            self.problem(
                self.xml.place(node),
                format!("the joint {} has no {tag}", quoted(joint)),
                format!("add `<{tag} link=\"…\"/>`"),
            );
            return None;
        };
        let named = found.attribute("link").map(str::trim).unwrap_or_default();
        let index = links.get(named).copied();
        if index.is_none() {
            self.problem(
                self.xml.place_of(found, "link"),
                format!(
                    "the {tag} {} of the joint {} does not exist",
                    quoted(named),
                    quoted(joint)
                ),
                "give the name of a link of this file",
            );
        }
        index
    }

    /// The axis of a joint, at unit length; x where none is written or the joint has none.
    fn axis(&self, node: Node<'a, 'a>, kind: JointType, joint: &str) -> Vector {
        const X: Vector = [1.0, 0.0, 0.0];
        let moves = !matches!(kind, JointType::Fixed | JointType::Floating);
        let Some(axis) = self.xml.child(node, "axis").filter(|_| moves) else {
            return X;
        };
        let written = self.numbers::<3>(axis, "xyz").unwrap_or(X);
        let norm = length(written);
        if !(norm > 0.0 && norm.is_finite()) {
            self.problem(
                self.xml.place_of(axis, "xyz"),
                format!("the axis of the joint {} has no direction", quoted(joint)),
                "give a vector that is not zero",
            );
        }
        // an axis whose length is 1 up to rounding is kept as it is written
        match (norm - 1.0).abs() < 1e-15 {
            true => written,
            false => scale(written, 1.0 / norm),
        }
    }

    /// The coefficients of damping and friction of a joint.
    fn dynamics(&self, node: Node<'a, 'a>, joint: &str) -> [f64; 2] {
        const KEYS: [&str; 2] = ["damping", "friction"];
        let Some(dynamics) = self.xml.child(node, "dynamics") else {
            return [0.0; 2];
        };
        if KEYS.iter().all(|key| dynamics.attribute(*key).is_none()) {
            self.problem(
                self.xml.place(dynamics),
                "<dynamics> says neither damping nor friction",
                "give one, or remove the element",
            );
        }
        KEYS.map(|key| {
            if dynamics.attribute(key).is_none() {
                return 0.0;
            }
            let value = self.required(dynamics, key).unwrap_or(0.0);
            if value < 0.0 {
                self.problem(
                    self.xml.place_of(dynamics, key),
                    format!("the {key} of the joint {} is negative", quoted(joint)),
                    "give 0 or more",
                );
            }
            value
        })
    }

    /// The joint that a joint follows; none where it is not named.
    fn mimic(&self, mimic: Node<'_, '_>, joint: &str) -> Option<Mimic> {
        let leader = mimic
            .attribute("joint")
            .map(str::trim)
            .unwrap_or_default()
            .to_owned();
        if leader.is_empty() {
            self.problem(
                self.xml.place(mimic),
                format!(
                    "the joint {} follows a joint that is not named",
                    quoted(joint)
                ),
                "add `joint=\"…\"`",
            );
        }
        let number = |key: &str, otherwise: f64| match mimic.attribute(key) {
            Some(_) => self.required(mimic, key).unwrap_or(otherwise),
            None => otherwise,
        };
        let (multiplier, offset) = (number("multiplier", 1.0), number("offset", 0.0));
        let place = self.xml.place_of(mimic, "joint");
        (!leader.is_empty()).then_some(Mimic {
            leader,
            place,
            multiplier,
            offset,
        })
    }

    /// The limits of a joint; those of its coordinate are infinite where its type has none.
    fn limits(
        &self,
        limit: Option<Node<'a, 'a>>,
        kind: JointType,
        joint: &str,
        node: Node<'_, '_>,
    ) -> Option<Limits> {
        let needs = matches!(kind, JointType::Revolute | JointType::Prismatic);
        let Some(limit) = limit else {
            if needs {
                self.problem(self.xml.place(node), format!("the joint {} has no limits", quoted(joint)), "add `<limit lower=\"…\" upper=\"…\" effort=\"…\" velocity=\"…\"/>`, or make it continuous");
            }
            return None;
        };
        let [effort, velocity] = ["effort", "velocity"].map(|key| self.limit(limit, key));
        let end = |key: &str| match limit.attribute(key) {
            Some(_) => self.limit(limit, key).unwrap_or(0.0),
            None => 0.0,
        };
        let (lower, upper) = (end("lower"), end("upper"));
        if needs && lower > upper {
            self.problem(
                self.xml.place_of(limit, "lower"),
                format!(
                    "the lower limit of the joint {} is above the upper one",
                    quoted(joint)
                ),
                "exchange them",
            );
        }
        Some(Limits {
            range: match needs {
                true => [lower, upper],
                false => [f64::NEG_INFINITY, f64::INFINITY],
            },
            effort: effort?,
            velocity: velocity?,
        })
    }

    /// A number of a limit, which may be infinite: there is none.
    fn limit(&self, node: Node<'_, '_>, key: &str) -> Option<f64> {
        let infinite = node
            .attribute(key)
            .and_then(|text| text.trim().parse().ok());
        match infinite.filter(|value: &f64| value.is_infinite()) {
            Some(value) => Some(value),
            None => self.required(node, key),
        }
    }
}
