//! The inertia of rotors, which transmissions give.
//!
//! ROS writes `<motorInertia>` and `<mechanicalReduction>`, Drake `<drake:rotor_inertia value="…"/>` and
//! `<drake:gear_ratio value="…"/>`. A rotor of the inertia J whose angle is i times the coordinate of the joint adds ½
//! J i² q̇² to the kinetic energy: the `armature` of the freedom is J i².

use super::inspect::misspelt;
use super::reader::Reader;
use super::robot::{Joint, JointType, Why};
use crate::diagnostic::quoted;
use roxmltree::Node;

const INERTIAS: [&str; 3] = ["motorInertia", "rotor_inertia", "drake:rotor_inertia"];
const RATIOS: [&str; 2] = ["mechanicalReduction", "drake:gear_ratio"];

impl<'a> Reader<'a> {
    /// Adds the rotors of a transmission to its joint.
    pub fn transmission(&self, node: Node<'a, 'a>, joints: &mut [Joint]) {
        let all = INERTIAS.iter().chain(&RATIOS).copied();
        for inside in node.descendants().filter(|n| n.is_element() && *n != node) {
            let tag = self.xml.tag(inside);
            if !all.clone().any(|of| of == tag)
                && let Some(near) = misspelt(tag, all.clone())
            {
                let message = format!("URDF has no <{tag}> in transmissions");
                self.problem(
                    self.xml.place(inside),
                    message,
                    format!("did you mean `{near}`?"),
                );
            }
        }
        let actuators: Vec<Node<'_, '_>> = self.xml.children(node, "actuator").collect();
        let of_joint = self.xml.child(node, "joint");
        let places = actuators.iter().copied().chain([node]);
        let mut armature = None;
        for place in places {
            let Some(inertia) = self.one_of(place, &INERTIAS) else {
                continue;
            };
            let outer = [Some(place), of_joint, Some(node)];
            let mut ratios = outer.iter().flatten().map(|n| self.one_of(*n, &RATIOS));
            let ratio = ratios.find_map(|found| found).unwrap_or(1.0);
            *armature.get_or_insert(0.0) += inertia * ratio * ratio;
        }
        let place = self.xml.place(node);
        match armature {
            None => self.leave_out(node, place, Why::Idle, "transmissions"),
            Some(armature) => self.rotor(node, armature, joints),
        }
    }

    /// Gives an armature to the joint of a transmission.
    fn rotor(&self, node: Node<'a, 'a>, armature: f64, joints: &mut [Joint]) {
        let place = self.xml.place(node);
        let named: Vec<Node<'_, '_>> = self.xml.children(node, "joint").collect();
        let [of] = named[..] else {
            let what = "rotors of transmissions with none or several joints";
            return self.leave_out(node, place, Why::Missing, what);
        };
        let name = of.attribute("name").unwrap_or_default().trim();
        let Some(joint) = joints.iter_mut().find(|j| j.name == name) else {
            return self.problem(
                self.xml.place_of(of, "name"),
                format!(
                    "the joint {} of this transmission does not exist",
                    quoted(name)
                ),
                "give the name of a joint of this file",
            );
        };
        match joint.kind {
            JointType::Revolute | JointType::Continuous | JointType::Prismatic => {
                joint.armature += armature
            }
            JointType::Fixed | JointType::Planar | JointType::Floating => self.leave_out(
                node,
                place,
                Why::Missing,
                "rotors of joints with none or several freedoms",
            ),
        }
    }

    /// The number of the first of these elements in an element: its attribute `value`, or its text.
    fn one_of(&self, node: Node<'a, 'a>, tags: &[&str]) -> Option<f64> {
        let found = tags.iter().find_map(|tag| self.xml.child(node, tag))?;
        let text = found
            .attribute("value")
            .or(found.text())
            .unwrap_or_default();
        let value = super::reader::number(text)
            .filter(|v| *v >= 0.0 || RATIOS.contains(&self.xml.tag(found)));
        if value.is_none() {
            self.problem(
                self.xml.place(found),
                format!(
                    "<{}> is {}, which it cannot be",
                    self.xml.tag(found),
                    quoted(text.trim())
                ),
                "give the inertia in kg·m², the ratio without unit",
            );
        }
        value
    }
}
