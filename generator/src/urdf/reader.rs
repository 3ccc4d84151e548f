//! Reads the elements of a URDF file: links with their inertia and shapes, origins, numbers.

use super::inertia;
use super::robot::{Frame, Inertial, LeftOut, Link, Mesh, Mimic, Robot, TextPlace, Why};
use super::vocabulary::ROBOT;
use super::xml::{XACRO, Xml};
use crate::description::mesh::Solid;
use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use crate::model::Triangles;
use crate::rotation::{IDENTITY, Matrix, add, apply, of_quaternion, of_roll_pitch_yaw};
use roxmltree::Node;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// An angle this close to a multiple of 90° is meant to be that multiple \[rad\].
const ALMOST: f64 = 1e-3;

/// The largest part of a tensor that is taken for rounding of its digits.
const ROUNDED: f64 = 1e-4;

/// The reader of one text, with what it found.
pub struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    pub xml: &'a Xml<'a>,
    /// Whether angles that are almost right angles are replaced by right angles.
    right_angles: bool,
    /// The minor number of the version: 1.x.
    minor: Cell<u32>,
    problems: RefCell<Vec<Diagnostic>>,
    almost_right: RefCell<Vec<usize>>,
    rounded: RefCell<Vec<String>>,
    pub left_out: RefCell<Vec<LeftOut>>,
}

impl<'a> Reader<'a> {
    pub fn new(file: &'a str, text: &'a str, xml: &'a Xml<'a>, right_angles: bool) -> Self {
        Reader {
            file,
            text,
            xml,
            right_angles,
            minor: Cell::new(0),
            problems: RefCell::default(),
            almost_right: RefCell::default(),
            rounded: RefCell::default(),
            left_out: RefCell::default(),
        }
    }

    /// Reads the whole file.
    pub fn read(self, root: Node<'a, 'a>) -> Result<Robot, Diagnostics> {
        let robot = self.robot(root);
        let mut problems = self.problems.into_inner();
        if problems.is_empty() {
            let mut almost_right = self.almost_right.into_inner();
            almost_right.dedup();
            return Ok(Robot {
                almost_right,
                left_out: self.left_out.into_inner(),
                rounded: self.rounded.into_inner(),
                ..robot
            });
        }
        problems.sort_by_key(|p| (p.line, p.column));
        Err(Diagnostics { problems })
    }

    pub fn problem(&self, place: TextPlace, message: impl Into<String>, help: impl Into<String>) {
        let problem = Diagnostic::at(self.file, self.text, place, message, help);
        self.problems.borrow_mut().push(problem);
    }

    fn robot(&self, root: Node<'a, 'a>) -> Robot {
        let mut robot = Robot {
            name: String::new(),
            place: self.xml.place(root),
            links: Vec::new(),
            joints: Vec::new(),
            left_out: Vec::new(),
            almost_right: Vec::new(),
            rounded: Vec::new(),
        };
        if self.xml.tag(root) != ROBOT.tag {
            self.problem(
                robot.place,
                format!(
                    "a URDF file begins with <robot>, this one with <{}>",
                    self.xml.tag(root)
                ),
                "give the URDF file of a robot",
            );
            return robot;
        }
        robot.name = self.name(root, "a robot").unwrap_or_default();
        self.version(root);
        if self.has_macros(root) {
            return robot;
        }
        self.inspect(root, &ROBOT);
        let links = self.links(root, &mut robot);
        if robot.links.is_empty() && self.problems.borrow().is_empty() {
            let (message, help) = match self
                .xml
                .child(root, "disable_collisions")
                .or(self.xml.child(root, "group"))
            {
                Some(_) => (
                    "this is SRDF, the groups of joints of a robot, which has no links",
                    "give the URDF file beside it",
                ),
                None => (
                    "the robot has no links",
                    "add at least one `<link name=\"…\">`",
                ),
            };
            self.problem(robot.place, message, help);
        }
        let mut joints: BTreeMap<String, usize> = BTreeMap::new();
        for node in self.xml.children(root, "joint") {
            if let Some(joint) = self.joint(node, &links) {
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
                let message = format!(
                    "the joint {} that {} follows does not exist",
                    quoted(leader),
                    quoted(&joint.name)
                );
                self.problem(*place, message, "give the name of a joint of this file");
            }
        }
        for node in self.xml.children(root, "transmission") {
            self.transmission(node, &mut robot.joints);
        }
        robot
    }

    /// Reads the links and the materials; returns the index of each link by its name.
    fn links(&self, root: Node<'a, 'a>, robot: &mut Robot) -> BTreeMap<String, usize> {
        let mut links: BTreeMap<String, usize> = BTreeMap::new();
        for node in self.xml.children(root, "link") {
            if let Some(link) = self.link(node) {
                if let Some(&first) = links.get(&link.name) {
                    let earlier = robot.links[first].place.0;
                    self.twice(node, "link", &link.name, earlier);
                }
                links.insert(link.name.clone(), robot.links.len());
                robot.links.push(link);
            }
        }
        let mut materials: BTreeMap<String, usize> = BTreeMap::new();
        for node in self.xml.children(root, "material") {
            if let Some(name) = self.name(node, "a material") {
                if let Some(&earlier) = materials.get(&name) {
                    self.twice(node, "material", &name, earlier);
                }
                materials.insert(name, self.xml.place(node).0);
            }
        }
        links
    }

    fn twice(&self, node: Node<'_, '_>, what: &str, name: &str, earlier: usize) {
        self.problem(
            self.xml.place_of(node, "name"),
            format!(
                "there are two {what}s {}; the first is in line {earlier}",
                quoted(name)
            ),
            "give each a name of its own",
        );
    }

    /// The attribute `name`, which must not be empty.
    pub fn name(&self, node: Node<'_, '_>, what: &str) -> Option<String> {
        let name = node.attribute("name").map(str::trim).unwrap_or_default();
        if name.is_empty() {
            self.problem(
                self.xml.place(node),
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
        match parts[..] {
            [Some(1), Some(minor @ 0..=2)] => self.minor.set(minor),
            _ => self.problem(
                self.xml.place_of(root, "version"),
                format!("{} is no version of URDF that can be read", quoted(version)),
                "versions 1.0, 1.1 and 1.2 can; without `version` it is 1.0",
            ),
        }
    }

    /// Reports macros that were not expanded.
    fn has_macros(&self, root: Node<'_, '_>) -> bool {
        let mut elements = root.descendants().filter(Node::is_element);
        let Some(node) = elements.find(|n| self.xml.tag(*n).starts_with("xacro:")) else {
            return false;
        };
        let tag = self.xml.tag(node);
        let message =
            format!("the macro <{tag}> is not expanded: this is xacro, from which URDF is made");
        self.problem(self.xml.place(node), message, XACRO);
        true
    }

    fn link(&self, node: Node<'a, 'a>) -> Option<Link> {
        let name = self.name(node, "a link")?;
        for tag in ["visual", "collision"] {
            for shape in self.xml.children(node, tag) {
                self.shape(shape);
            }
        }
        let inertial = self.xml.child(node, "inertial");
        Some(Link {
            place: self.xml.place_of(node, "name"),
            inertial: inertial.and_then(|inertial| self.inertial(inertial, &name)),
            meshes: (self.xml.children(node, "visual"))
                .flat_map(|shape| self.meshes(shape))
                .collect(),
            name,
        })
    }

    fn inertial(&self, node: Node<'a, 'a>, link: &str) -> Option<Inertial> {
        let [mass, inertia] = ["mass", "inertia"].map(|tag| self.xml.child(node, tag));
        let (Some(mass), Some(inertia)) = (mass, inertia) else {
            self.problem(
                self.xml.place(node),
                format!("the inertia of {} is not complete", quoted(link)),
                "an <inertial> has <mass value=\"…\"/> and <inertia ixx=\"…\" ixy=\"…\" ixz=\"…\" iyy=\"…\" iyz=\"…\" izz=\"…\"/>",
            );
            return None;
        };
        let value = self.required(mass, "value")?;
        let keys = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
        let [xx, xy, xz, yy, yz, zz] = keys.map(|key| self.required(inertia, key));
        let (xx, xy, xz, yy, yz, zz) = (xx?, xy?, xz?, yy?, yz?, zz?);
        for (lower, entry) in [("iyx", xy), ("izx", xz), ("izy", yz)] {
            let other = inertia
                .attribute(lower)
                .map(|_| self.required(inertia, lower));
            if other.flatten().is_some_and(|other| other != entry) {
                let what = "entries of tensors below the diagonal, which differ from those above";
                self.leave_out(node, self.xml.place_of(inertia, lower), Why::Missing, what);
            }
        }
        if value < 0.0 {
            self.problem(
                self.xml.place_of(mass, "value"),
                format!("the mass of {} is negative", quoted(link)),
                "give it in kg",
            );
        }
        // off the diagonal an entry stands twice
        let units = keys.map(|key| half_unit(inertia.attribute(key).unwrap_or_default()));
        let both = [1.0, 2.0, 2.0, 1.0, 2.0, 1.0];
        let squares = units
            .iter()
            .zip(both)
            .map(|(unit, times)| times * unit * unit);
        let tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let place = self.xml.place(inertia);
        Some(Inertial {
            place: self.xml.place_of(mass, "value"),
            frame: self.origin(node),
            mass: value,
            tensor: self.within_digits(tensor, squares.sum::<f64>().sqrt(), link, place),
            tensor_place: place,
        })
    }

    /// The tensor, or the nearest of a body, if that differs by no more than the last digits that are written can tell.
    fn within_digits(&self, tensor: Matrix, digits: f64, link: &str, place: TextPlace) -> Matrix {
        if inertia::wrong_tensor(&tensor).is_none() {
            return tensor;
        }
        let nearest = inertia::nearest(&tensor);
        let size = inertia::norm(&tensor);
        let far = inertia::norm(&std::array::from_fn(|i| {
            std::array::from_fn(|j| nearest[i][j] - tensor[i][j])
        }));
        if far > digits.min(ROUNDED * size) {
            return tensor;
        }
        self.rounded.borrow_mut().push(format!(
            "the last digits of the tensor of {}, line {}, make it that of no body: it is taken as the nearest of a body, {:.1e} of it away",
            quoted(link),
            place.0,
            far / size
        ));
        nearest
    }

    /// What a link is shown by.
    fn meshes(&self, node: Node<'a, 'a>) -> Vec<Mesh> {
        let geometry = self.xml.child(node, "geometry");
        let shape = geometry.and_then(|geometry| geometry.children().find(Node::is_element));
        // what is wrong is already reported
        let mut meshes = shape
            .and_then(|shape| self.meshes_of(shape, self.origin(node)))
            .unwrap_or_default();
        let all = meshes.len();
        // exporters write a box of no size where a link has nothing to show
        meshes.retain(Mesh::is_seen);
        if all > 0 && meshes.is_empty() {
            let place = self.xml.place(node);
            self.leave_out(node, place, Why::Idle, "visual shapes without size");
        }
        meshes
    }

    fn meshes_of(&self, shape: Node<'a, 'a>, frame: Frame) -> Option<Vec<Mesh>> {
        let number = |key: &str| shape.attribute(key)?.trim().parse::<f64>().ok();
        let solid = |of, scale, frame| Mesh {
            of: Triangles::Solid(of),
            frame,
            scale,
        };
        Some(match self.xml.tag(shape) {
            "mesh" => {
                let scale = shape
                    .attribute("scale")
                    .map(|_| self.numbers(shape, "scale"));
                vec![Mesh {
                    of: Triangles::File(shape.attribute("filename")?.to_owned()),
                    frame,
                    scale: scale.map_or([1.0; 3], Option::unwrap_or_default),
                }]
            }
            "box" => {
                let size = shape.attribute("size")?.split_whitespace();
                let size: Vec<f64> = size.map_while(|word| word.parse().ok()).collect();
                vec![solid(Solid::Box, size.try_into().ok()?, frame)]
            }
            "sphere" => vec![solid(Solid::Sphere, [2.0 * number("radius")?; 3], frame)],
            form @ ("cylinder" | "capsule") => {
                let (across, length) = (2.0 * number("radius")?, number("length")?);
                let mut all = vec![solid(Solid::Cylinder, [across, across, length], frame)];
                if form == "capsule" {
                    all.extend([-0.5, 0.5].map(|end| {
                        let along = apply(&frame.turn, [0.0, 0.0, end * length]);
                        let at = add(frame.at, along);
                        solid(Solid::Sphere, [across; 3], Frame { at, ..frame })
                    }));
                }
                all
            }
            _ => return None,
        })
    }

    /// Checks that a shape is written correctly.
    fn shape(&self, node: Node<'a, 'a>) {
        self.origin(node);
        let geometry = self.xml.child(node, "geometry");
        let shape = geometry.and_then(|g| g.children().find(Node::is_element));
        let Some(shape) = shape else {
            self.problem(
                self.xml.place(node),
                "a shape needs a <geometry> with one of box, sphere, cylinder, capsule, mesh",
                "add it, or remove the shape: its form has no influence",
            );
            return;
        };
        match self.xml.tag(shape) {
            "box" => drop(self.numbers::<3>(shape, "size")),
            "sphere" => drop(self.required(shape, "radius")),
            "cylinder" | "capsule" => {
                self.required(shape, "radius");
                self.required(shape, "length");
            }
            "mesh" => {
                if shape.attribute("filename").is_none() {
                    self.problem(
                        self.xml.place(shape),
                        "a mesh needs a file",
                        "add `filename=\"…\"`",
                    );
                }
            }
            other => self.problem(
                self.xml.place(shape),
                format!("there is no shape <{other}>"),
                "a <geometry> is one of box, sphere, cylinder, capsule, mesh",
            ),
        }
    }

    pub fn origin(&self, node: Node<'a, 'a>) -> Frame {
        let mut frame = Frame {
            at: [0.0; 3],
            turn: IDENTITY,
        };
        let Some(origin) = self.xml.child(node, "origin") else {
            return frame;
        };
        if origin.attribute("xyz").is_some() {
            frame.at = self.numbers(origin, "xyz").unwrap_or_default();
        }
        let both = origin.attribute("rpy").is_some() && origin.attribute("quat_xyzw").is_some();
        if both {
            self.problem(
                self.xml.place_of(origin, "quat_xyzw"),
                "an origin has either `rpy` or `quat_xyzw`",
                "remove one of them",
            );
        }
        if origin.attribute("rpy").is_some() {
            let angles = self.numbers::<3>(origin, "rpy").unwrap_or_default();
            frame.turn = of_roll_pitch_yaw(angles.map(|angle| self.angle(angle, origin)));
        }
        if !both && origin.attribute("quat_xyzw").is_some() && self.minor.get() == 0 {
            self.problem(
                self.xml.place_of(origin, "quat_xyzw"),
                "`quat_xyzw` is read from version 1.1 on, and this file is of version 1.0: readers of ROS ignore it there",
                "write `version=\"1.1\"` into <robot>, or `rpy` instead",
            );
        }
        if origin.attribute("quat_xyzw").is_some() {
            let quaternion = self
                .numbers(origin, "quat_xyzw")
                .unwrap_or([0.0, 0.0, 0.0, 1.0]);
            frame.turn = of_quaternion(quaternion).unwrap_or_else(|| {
                self.problem(
                    self.xml.place_of(origin, "quat_xyzw"),
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
            .any(|n| n.is_element() && matches!(self.xml.tag(n), "visual" | "collision"))
        {
            self.almost_right.borrow_mut().push(self.xml.place(node).0);
        }
        angle
    }

    /// A required number.
    pub fn required(&self, node: Node<'_, '_>, key: &str) -> Option<f64> {
        let Some(text) = node.attribute(key) else {
            self.problem(
                self.xml.place(node),
                format!("<{}> has no `{key}`", self.xml.tag(node)),
                format!("add `{key}=\"…\"`"),
            );
            return None;
        };
        let value = number(text);
        if value.is_none() {
            self.problem(
                self.xml.place_of(node, key),
                format!("{} is no number", quoted(text)),
                number_help(text, "write one finite number, such as 0.25 or 1e-3"),
            );
        }
        value
    }

    /// `N` numbers between spaces.
    pub fn numbers<const N: usize>(&self, node: Node<'_, '_>, key: &str) -> Option<[f64; N]> {
        let Some(text) = node.attribute(key) else {
            self.problem(
                self.xml.place(node),
                format!("<{}> has no `{key}`", self.xml.tag(node)),
                format!("add `{key}=\"…\"`"),
            );
            return None;
        };
        let values: Option<Vec<f64>> = text.split_whitespace().map(number).collect();
        let values = values.and_then(|v| <[f64; N]>::try_from(v).ok());
        if values.is_none() {
            self.problem(
                self.xml.place_of(node, key),
                format!("`{key}` is not {N} numbers: {}", quoted(text)),
                number_help(text, &format!("write {N} numbers with spaces between them")),
            );
        }
        values
    }
}

/// A finite number in the notation of C.
pub fn number(text: &str) -> Option<f64> {
    let value: f64 = text.trim().parse().ok()?;
    value.is_finite().then_some(value)
}

/// What to write instead of a text that is no number: macros have expressions there.
fn number_help(text: &str, help: &str) -> String {
    if text.contains("${") || text.contains("$(") {
        XACRO.to_owned()
    } else {
        help.to_owned()
    }
}

/// Half a unit of the last digit of a number as it is written; 0 of whole numbers, which are exact.
pub fn half_unit(text: &str) -> f64 {
    let text = text.trim();
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (Some((_, decimals)), Ok(exponent)) = (mantissa.split_once('.'), exponent.parse::<i32>())
    else {
        return 0.0;
    };
    let is_zero = !mantissa.contains(|c: char| ('1'..='9').contains(&c));
    let last = exponent.saturating_sub(i32::try_from(decimals.len()).unwrap_or(i32::MAX));
    if is_zero {
        0.0
    } else {
        0.5 * crate::description::unit::whole_power(10.0, last)
    }
}
