//! Reads the text of a URDF file into links and joints, each with its place in the text.
//!
//! The text must satisfy the parser of ROS (urdfdom), shapes and materials included: a file that it refuses is refused
//! here. In addition a moving joint needs an axis that is not zero.

use crate::description::tree::MAX_BYTES;
use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use crate::rotation::{IDENTITY, Matrix, Vector, length, of_quaternion, of_roll_pitch_yaw, scale};
use roxmltree::{Document, Node};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// A place in the text: line and column from 1, length.
pub type Place = (usize, usize, usize);

/// A robot, as written in the file.
pub struct Robot {
    pub name: String,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    /// Items that do not influence the motion, by kind, with their lines.
    pub left_out: BTreeMap<&'static str, Vec<usize>>,
    /// Lines with angles of orientations that are almost, but not exactly, multiples of 90°.
    pub almost_right: Vec<usize>,
}

pub struct Link {
    pub name: String,
    pub place: Place,
    pub inertial: Option<Inertial>,
}

/// Mass, and inertia tensor about the centre of mass in the axes of `frame`.
pub struct Inertial {
    pub place: Place,
    pub frame: Frame,
    pub mass: f64,
    pub tensor: Matrix,
    pub tensor_place: Place,
}

/// An `<origin>`: displacement and rotation, both zero if nothing is written.
#[derive(Clone, Copy)]
pub struct Frame {
    pub at: Vector,
    pub turn: Matrix,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
    Planar,
    Floating,
}

pub struct Joint {
    pub name: String,
    pub place: Place,
    pub kind: Kind,
    pub parent: usize,
    pub child: usize,
    pub origin: Frame,
    /// The axis, a unit vector in the frame of the child link.
    pub axis: Vector,
    /// Smallest and largest coordinate \[rad or m\].
    pub limits: Option<[f64; 2]>,
    pub damping: f64,
    pub friction: f64,
    /// The joint that it follows, if any.
    pub mimic: Option<Mimic>,
}

/// q = multiplier · q of the leader + offset.
#[derive(Clone)]
pub struct Mimic {
    /// Name of the leader.
    pub leader: String,
    /// The place of that name.
    pub place: Place,
    pub multiplier: f64,
    /// Offset \[rad or m\].
    pub offset: f64,
}

/// An angle this close to a multiple of 90° is meant to be that multiple \[rad\].
const ALMOST: f64 = 1e-3;

/// The reader of one text, with the problems found.
struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    /// Whether angles that are almost right angles are replaced by right angles.
    right_angles: bool,
    problems: RefCell<Vec<Diagnostic>>,
    almost_right: RefCell<Vec<usize>>,
}

/// Reads a URDF file.
pub fn read(file: &str, text: &str, right_angles: bool) -> Result<Robot, Diagnostics> {
    let fail = |place: Place, message: String, help: &str| {
        Diagnostics::from(Diagnostic::at(file, text, place, message, help))
    };
    if text.len() > MAX_BYTES {
        return Err(Diagnostic::of_file(
            file,
            format!("the file is larger than {} MiB", MAX_BYTES >> 20),
            "a URDF file of a robot is smaller; its shapes are files of their own",
        )
        .into());
    }
    let document = Document::parse(text).map_err(|error| {
        let position = error.pos();
        let place = (position.row as usize, position.col as usize, 1);
        fail(
            place,
            format!("this is no XML: {error}"),
            "mend the text here; a file with `xacro:` macros is expanded by xacro first",
        )
    })?;
    let reader = Reader {
        file,
        text,
        right_angles,
        problems: RefCell::default(),
        almost_right: RefCell::default(),
    };
    let root = document.root_element();
    let robot = reader.robot(root);
    let mut problems = reader.problems.into_inner();
    if problems.is_empty() {
        let mut almost_right = reader.almost_right.into_inner();
        almost_right.dedup();
        return Ok(Robot {
            almost_right,
            ..robot
        });
    }
    problems.sort_by_key(|p| (p.line, p.column));
    Err(Diagnostics { problems })
}

impl<'a> Reader<'a> {
    fn problem(&self, place: Place, message: impl Into<String>, help: impl Into<String>) {
        let problem = Diagnostic::at(self.file, self.text, place, message, help);
        self.problems.borrow_mut().push(problem);
    }

    /// The place where an element of the XML begins.
    fn place(&self, node: Node<'_, '_>) -> Place {
        let position = node.document().text_pos_at(node.range().start);
        let name = node.tag_name().name().len() + 1;
        (position.row as usize, position.col as usize, name)
    }

    /// The place of the value of an attribute.
    fn place_of(&self, node: Node<'_, '_>, attribute: &str) -> Place {
        match node.attribute_node(attribute) {
            None => self.place(node),
            Some(found) => {
                let range = found.range_value();
                let position = node.document().text_pos_at(range.start);
                (
                    position.row as usize,
                    position.col as usize,
                    range.len().max(1),
                )
            }
        }
    }

    fn robot(&self, root: Node<'a, 'a>) -> Robot {
        let mut robot = Robot {
            name: String::new(),
            links: Vec::new(),
            joints: Vec::new(),
            left_out: BTreeMap::new(),
            almost_right: Vec::new(),
        };
        if root.tag_name().name() != "robot" {
            self.problem(
                self.place(root),
                format!(
                    "a URDF file begins with <robot>, this one with <{}>",
                    root.tag_name().name()
                ),
                "give the URDF file of a robot",
            );
            return robot;
        }
        robot.name = self.name(root, "a robot").unwrap_or_default();
        self.version(root);
        self.unknown_macros(root);
        let links = self.links(root, &mut robot);
        if robot.links.is_empty() && self.problems.borrow().is_empty() {
            self.problem(
                self.place(root),
                "the robot has no links",
                "add at least one `<link name=\"…\">`",
            );
        }
        let mut joints: BTreeMap<String, usize> = BTreeMap::new();
        for node in root.children().filter(|n| n.has_tag_name("joint")) {
            if let Some(joint) = self.joint(node, &links, &mut robot.left_out) {
                if let Some(earlier) = joints.insert(joint.name.clone(), joint.place.0) {
                    self.twice(node, "joint", &joint.name, earlier);
                }
                robot.joints.push(joint);
            }
        }
        for joint in &robot.joints {
            if let Some(Mimic { leader, place, .. }) = &joint.mimic
                && !joints.contains_key(leader)
            {
                self.problem(
                    *place,
                    format!(
                        "the joint {} that {} follows does not exist",
                        quoted(leader),
                        quoted(&joint.name)
                    ),
                    "give the name of a joint of this file",
                );
            }
        }
        robot
    }

    /// Reads the links, and notes what is left out; returns the index of each link by its name.
    fn links(&self, root: Node<'a, 'a>, robot: &mut Robot) -> BTreeMap<String, usize> {
        let mut links: BTreeMap<String, usize> = BTreeMap::new();
        let mut materials: BTreeMap<String, usize> = BTreeMap::new();
        for node in root.children().filter(Node::is_element) {
            let line = self.place(node).0;
            match node.tag_name().name() {
                "link" => {
                    if let Some(link) = self.link(node, &mut robot.left_out) {
                        if let Some(&first) = links.get(&link.name) {
                            let earlier = robot.links[first].place.0;
                            self.twice(node, "link", &link.name, earlier);
                        }
                        links.insert(link.name.clone(), robot.links.len());
                        robot.links.push(link);
                    }
                }
                "material" => {
                    robot.left_out.entry("materials").or_default().push(line);
                    if let Some(name) = self.name(node, "a material") {
                        if let Some(&earlier) = materials.get(&name) {
                            self.twice(node, "material", &name, earlier);
                        }
                        materials.insert(name, line);
                    }
                }
                "joint" => {}
                other => {
                    robot
                        .left_out
                        .entry(left_out(other))
                        .or_default()
                        .push(line);
                }
            }
        }
        links
    }

    fn twice(&self, node: Node<'_, '_>, what: &str, name: &str, earlier: usize) {
        self.problem(
            self.place_of(node, "name"),
            format!(
                "there are two {what}s {}; the first is in line {earlier}",
                quoted(name)
            ),
            "give each a name of its own",
        );
    }

    /// The attribute `name`, which must not be empty.
    fn name(&self, node: Node<'_, '_>, what: &str) -> Option<String> {
        let name = node.attribute("name").map(str::trim).unwrap_or_default();
        if name.is_empty() {
            self.problem(
                self.place(node),
                format!("{what} needs a name"),
                "add `name=\"…\"`",
            );
            return None;
        }
        Some(name.to_owned())
    }

    fn version(&self, root: Node<'_, '_>) {
        let Some(version) = root.attribute("version") else {
            return;
        };
        let parts: Vec<Option<u32>> = version.split('.').map(|p| p.parse().ok()).collect();
        if !matches!(parts[..], [Some(1), Some(0..=2)]) {
            self.problem(
                self.place_of(root, "version"),
                format!("{} is no version of URDF that can be read", quoted(version)),
                "versions 1.0, 1.1 and 1.2 can; without `version` it is 1.0",
            );
        }
    }

    /// Reports macros that were not expanded.
    fn unknown_macros(&self, root: Node<'_, '_>) {
        let of_xacro = |n: &Node<'_, '_>| {
            n.tag_name()
                .namespace()
                .is_some_and(|space| space.contains("xacro"))
        };
        if let Some(node) = root.descendants().find(|n| n.is_element() && of_xacro(n)) {
            self.problem(
                self.place(node),
                format!(
                    "the macro <xacro:{}> is not expanded",
                    node.tag_name().name()
                ),
                "expand the file first: `xacro robot.urdf.xacro > robot.urdf`",
            );
        }
    }

    fn link(
        &self,
        node: Node<'a, 'a>,
        left_out: &mut BTreeMap<&'static str, Vec<usize>>,
    ) -> Option<Link> {
        let name = self.name(node, "a link")?;
        let mut inertial = None;
        for child in node.children().filter(Node::is_element) {
            let line = self.place(child).0;
            match child.tag_name().name() {
                "inertial" => inertial = self.inertial(child, &name),
                "visual" => {
                    self.shape(child);
                    left_out.entry("visual shapes").or_default().push(line);
                }
                "collision" => {
                    self.shape(child);
                    left_out.entry("collision shapes").or_default().push(line);
                }
                _ => left_out
                    .entry("extensions of links")
                    .or_default()
                    .push(line),
            }
        }
        Some(Link {
            name,
            place: self.place_of(node, "name"),
            inertial,
        })
    }

    fn inertial(&self, node: Node<'a, 'a>, link: &str) -> Option<Inertial> {
        let (Some(mass), Some(inertia)) = (child(node, "mass"), child(node, "inertia")) else {
            self.problem(
                self.place(node),
                format!("the inertia of {} is not complete", quoted(link)),
                "an <inertial> has <mass value=\"…\"/> and <inertia ixx=\"…\" ixy=\"…\" ixz=\"…\" iyy=\"…\" iyz=\"…\" izz=\"…\"/>",
            );
            return None;
        };
        let value = self.required(mass, "value")?;
        let [xx, xy, xz, yy, yz, zz] =
            ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].map(|key| self.required(inertia, key));
        let (xx, xy, xz, yy, yz, zz) = (xx?, xy?, xz?, yy?, yz?, zz?);
        if value < 0.0 {
            self.problem(
                self.place_of(mass, "value"),
                format!("the mass of {} is negative", quoted(link)),
                "give it in kg",
            );
        }
        Some(Inertial {
            place: self.place_of(mass, "value"),
            frame: self.origin(node),
            mass: value,
            tensor: [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
            tensor_place: self.place(inertia),
        })
    }

    /// Checks that a shape is written correctly; it is not imported.
    fn shape(&self, node: Node<'a, 'a>) {
        self.origin(node);
        let geometry = child(node, "geometry");
        let shape = geometry.and_then(|g| g.children().find(Node::is_element));
        let Some(shape) = shape else {
            self.problem(
                self.place(node),
                "a shape needs a <geometry> with one of box, sphere, cylinder, capsule, mesh",
                "add it, or remove the shape: its form has no influence",
            );
            return;
        };
        match shape.tag_name().name() {
            "box" => drop(self.numbers::<3>(shape, "size")),
            "sphere" => drop(self.required(shape, "radius")),
            "cylinder" | "capsule" => {
                self.required(shape, "radius");
                self.required(shape, "length");
            }
            "mesh" => {
                if shape.attribute("filename").is_none() {
                    self.problem(
                        self.place(shape),
                        "a mesh needs a file",
                        "add `filename=\"…\"`; it is not read",
                    );
                }
            }
            other => self.problem(
                self.place(shape),
                format!("there is no shape <{other}>"),
                "a <geometry> is one of box, sphere, cylinder, capsule, mesh",
            ),
        }
    }

    fn joint(
        &self,
        node: Node<'a, 'a>,
        links: &BTreeMap<String, usize>,
        left_out: &mut BTreeMap<&'static str, Vec<usize>>,
    ) -> Option<Joint> {
        let name = self.name(node, "a joint")?;
        let kind = self.kind(node, &name)?;
        let parent = self.link_of_joint(node, "parent", &name, links);
        let outboard = self.link_of_joint(node, "child", &name, links);
        let axis = self.axis(node, kind, &name);
        let limits = self.limits(child(node, "limit"), kind, &name, node);
        if let Some(controller) = child(node, "safety_controller") {
            left_out
                .entry("safety controllers")
                .or_default()
                .push(self.place(controller).0);
            self.required(controller, "k_velocity");
        }
        if let Some(calibration) = child(node, "calibration") {
            left_out
                .entry("calibrations")
                .or_default()
                .push(self.place(calibration).0);
        }
        let [damping, friction] = self.dynamics(node, &name);
        let mimic = child(node, "mimic").and_then(|mimic| self.mimic(mimic, &name));
        Some(Joint {
            place: self.place_of(node, "name"),
            kind,
            parent: parent?,
            child: outboard?,
            origin: self.origin(node),
            axis,
            limits,
            damping,
            friction,
            mimic,
            name,
        })
    }

    /// The type of a joint.
    fn kind(&self, node: Node<'_, '_>, joint: &str) -> Option<Kind> {
        let message = match node.attribute("type") {
            Some("fixed") => return Some(Kind::Fixed),
            Some("revolute") => return Some(Kind::Revolute),
            Some("continuous") => return Some(Kind::Continuous),
            Some("prismatic") => return Some(Kind::Prismatic),
            Some("planar") => return Some(Kind::Planar),
            Some("floating") => return Some(Kind::Floating),
            Some(other) => format!("there is no type of joint {}", quoted(other)),
            None => format!("the joint {} has no type", quoted(joint)),
        };
        self.problem(
            self.place_of(node, "type"),
            message,
            "a `type` is one of revolute, continuous, prismatic, fixed, floating, planar",
        );
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
        let Some(found) = child(node, tag) else {
            self.problem(
                self.place(node),
                format!("the joint {} has no {tag}", quoted(joint)),
                format!("add `<{tag} link=\"…\"/>`"),
            );
            return None;
        };
        let named = found.attribute("link").unwrap_or_default();
        let index = links.get(named).copied();
        if index.is_none() {
            self.problem(
                self.place_of(found, "link"),
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
    fn axis(&self, node: Node<'a, 'a>, kind: Kind, joint: &str) -> Vector {
        const X: Vector = [1.0, 0.0, 0.0];
        let moves = !matches!(kind, Kind::Fixed | Kind::Floating);
        let Some(axis) = child(node, "axis").filter(|_| moves) else {
            return X;
        };
        let written = self.numbers::<3>(axis, "xyz").unwrap_or(X);
        let norm = length(written);
        if !(norm > 0.0 && norm.is_finite()) {
            self.problem(
                self.place_of(axis, "xyz"),
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
        let Some(dynamics) = child(node, "dynamics") else {
            return [0.0; 2];
        };
        if KEYS.iter().all(|key| dynamics.attribute(*key).is_none()) {
            self.problem(
                self.place(dynamics),
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
                    self.place_of(dynamics, key),
                    format!("the {key} of the joint {} is negative", quoted(joint)),
                    "give 0 or more",
                );
            }
            value
        })
    }

    /// The joint that a joint follows; none where it is not named.
    fn mimic(&self, mimic: Node<'_, '_>, joint: &str) -> Option<Mimic> {
        let leader = mimic.attribute("joint").unwrap_or_default().to_owned();
        if leader.is_empty() {
            self.problem(
                self.place(mimic),
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
        let place = self.place_of(mimic, "joint");
        (!leader.is_empty()).then_some(Mimic {
            leader,
            place,
            multiplier,
            offset,
        })
    }

    fn limits(
        &self,
        limit: Option<Node<'a, 'a>>,
        kind: Kind,
        joint: &str,
        node: Node<'_, '_>,
    ) -> Option<[f64; 2]> {
        let needs = matches!(kind, Kind::Revolute | Kind::Prismatic);
        let Some(limit) = limit else {
            if needs {
                self.problem(self.place(node), format!("the joint {} has no limits", quoted(joint)), "add `<limit lower=\"…\" upper=\"…\" effort=\"…\" velocity=\"…\"/>`, or make it continuous");
            }
            return None;
        };
        self.required(limit, "effort");
        self.required(limit, "velocity");
        let end = |key: &str| match limit.attribute(key) {
            Some(_) => self.required(limit, key).unwrap_or(0.0),
            None => 0.0,
        };
        let (lower, upper) = (end("lower"), end("upper"));
        if needs && lower > upper {
            self.problem(
                self.place_of(limit, "lower"),
                format!(
                    "the lower limit of the joint {} is above the upper one",
                    quoted(joint)
                ),
                "exchange them",
            );
        }
        needs.then_some([lower, upper])
    }

    fn origin(&self, node: Node<'a, 'a>) -> Frame {
        let mut frame = Frame {
            at: [0.0; 3],
            turn: IDENTITY,
        };
        let Some(origin) = child(node, "origin") else {
            return frame;
        };
        if origin.attribute("xyz").is_some() {
            frame.at = self.numbers(origin, "xyz").unwrap_or_default();
        }
        let both = origin.attribute("rpy").is_some() && origin.attribute("quat_xyzw").is_some();
        if both {
            self.problem(
                self.place_of(origin, "quat_xyzw"),
                "an origin has either `rpy` or `quat_xyzw`",
                "remove one of them",
            );
        }
        if origin.attribute("rpy").is_some() {
            let angles = self.numbers::<3>(origin, "rpy").unwrap_or_default();
            frame.turn = of_roll_pitch_yaw(angles.map(|angle| self.angle(angle, origin)));
        }
        if origin.attribute("quat_xyzw").is_some() {
            let quaternion = self
                .numbers(origin, "quat_xyzw")
                .unwrap_or([0.0, 0.0, 0.0, 1.0]);
            frame.turn = of_quaternion(quaternion).unwrap_or_else(|| {
                self.problem(
                    self.place_of(origin, "quat_xyzw"),
                    "this quaternion has no direction",
                    "give one that is not zero",
                );
                IDENTITY
            });
        }
        frame
    }

    /// An angle as written, or the right angle that it almost is.
    fn angle(&self, angle: f64, node: Node<'_, '_>) -> f64 {
        let quarter = std::f64::consts::FRAC_PI_2;
        let near = (angle / quarter).round() * quarter;
        let off = (angle - near).abs();
        if off > ALMOST || off <= 1e-15 * near.abs().max(1.0) {
            return angle;
        }
        if self.right_angles {
            return near;
        }
        // shapes have no influence
        if !node
            .ancestors()
            .any(|n| n.has_tag_name("visual") || n.has_tag_name("collision"))
        {
            self.almost_right.borrow_mut().push(self.place(node).0);
        }
        angle
    }

    /// A required number.
    fn required(&self, node: Node<'_, '_>, key: &str) -> Option<f64> {
        let Some(text) = node.attribute(key) else {
            self.problem(
                self.place(node),
                format!("<{}> has no `{key}`", node.tag_name().name()),
                format!("add `{key}=\"…\"`"),
            );
            return None;
        };
        let value = number(text);
        if value.is_none() {
            self.problem(
                self.place_of(node, key),
                format!("{} is no number", quoted(text)),
                "write one finite number, such as 0.25 or 1e-3",
            );
        }
        value
    }

    /// `N` numbers between spaces.
    fn numbers<const N: usize>(&self, node: Node<'_, '_>, key: &str) -> Option<[f64; N]> {
        let Some(text) = node.attribute(key) else {
            self.problem(
                self.place(node),
                format!("<{}> has no `{key}`", node.tag_name().name()),
                format!("add `{key}=\"…\"`"),
            );
            return None;
        };
        let values: Option<Vec<f64>> = text.split_whitespace().map(number).collect();
        let values = values.and_then(|v| <[f64; N]>::try_from(v).ok());
        if values.is_none() {
            self.problem(
                self.place_of(node, key),
                format!("`{key}` is not {N} numbers: {}", quoted(text)),
                format!("write {N} numbers with spaces between them"),
            );
        }
        values
    }
}

/// The first child with this tag.
fn child<'a>(node: Node<'a, 'a>, tag: &'static str) -> Option<Node<'a, 'a>> {
    node.children().find(|n| n.has_tag_name(tag))
}

/// A finite number in the notation of C.
fn number(text: &str) -> Option<f64> {
    let value: f64 = text.trim().parse().ok()?;
    value.is_finite().then_some(value)
}

/// The name of an item that is not imported.
fn left_out(tag: &str) -> &'static str {
    match tag {
        "transmission" => "transmissions",
        "sensor" => "sensors",
        "gazebo" => "settings of Gazebo",
        "ros2_control" => "settings of ros2_control",
        _ => "extensions",
    }
}
