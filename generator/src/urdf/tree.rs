//! Turns links and joints into systems of elements.
//!
//! All positions are measured in one frame: that of the root link, with all joints at 0. Links that are connected by
//! fixed joints are one body. The first of its links that has a mass is an element, its other links with mass are
//! welded to it, and links without mass are frames. A body without mass between two moving joints is no element; its
//! joints become a list. For that their axes must meet in one point.

use super::coupling;
use super::inertia::{Part, together, wrong_tensor, wrong_with};
use super::massless_bodies::{self, Massless, shape_only};
use super::robot::{Frame, Joint, JointType, Link, Robot, TextPlace};
use super::root::root;
use crate::diagnostic::quoted;
use crate::rotation::{
    IDENTITY, Matrix, Vector, add, apply, cross, dot, length, product, scale, subtract, turned,
};

/// The largest distance by which the axes of a list may miss each other \[m\].
const MEET_TO: f64 = 1e-9;

/// The motion of the root link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Base {
    /// It is at rest.
    #[default]
    Fixed,
    /// It moves freely.
    Free,
}

/// A system with its elements; each comes after its parent.
pub struct System {
    pub free: bool,
    pub elements: Vec<Element>,
}

/// An element. Points and axes are given in the frame of the root link, with all joints at 0.
pub struct Element {
    pub link: usize,
    /// Index of its carrier in the system.
    pub on: Option<usize>,
    pub origin: Vector,
    pub carried: Carried,
    pub mass: f64,
    pub center: Vector,
    /// Inertia tensor about the centre of mass.
    pub tensor: Matrix,
}

/// How an element is carried.
pub enum Carried {
    Weld,
    /// By nothing: it is the root of a free system.
    Freely,
    Joint(Vec<Freedom>),
}

/// A freedom of a joint.
pub struct Freedom {
    pub joint: usize,
    pub slides: bool,
    pub axis: Vector,
    /// Appended to the name of the joint, if that has several freedoms.
    pub suffix: &'static str,
}

/// A link without mass, as a frame on an element or on the absolute frame.
pub struct Marker {
    pub link: usize,
    /// Its system and element; `None` for the absolute frame.
    pub on: Option<(usize, usize)>,
    pub at: Vector,
}

/// All systems of a robot.
pub struct Forest {
    pub systems: Vec<System>,
    pub markers: Vec<Marker>,
    /// Links with a mass that are at rest.
    pub still: Vec<usize>,
    /// Joints that follow others but move no mass.
    pub idle: Vec<usize>,
    /// Position and orientation of each link.
    pub placed: Vec<Frame>,
    /// Links that become one element with the name of the first, because some of them are physically impossible bodies.
    pub merged: Vec<(usize, Vec<usize>)>,
}

/// Why a robot cannot be a model.
pub struct Problem {
    pub place: TextPlace,
    pub message: String,
    pub help: String,
    /// The changes of the inertia of the robot that remove the problem; none if there are none.
    pub repairs: Vec<Repair>,
}

/// A change of the inertia of a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Repair {
    /// Every link gets a mass.
    All,
    /// This link, which moves and has no mass, gets one.
    Mass(usize),
    /// These links get a tensor that a body can have.
    Tensor(Vec<usize>),
    /// These joints, which move no mass, become fixed.
    Fixed(Vec<usize>),
}

impl Problem {
    /// A problem that no change of the inertia removes.
    pub fn new(place: TextPlace, message: impl Into<String>, help: impl Into<String>) -> Self {
        Problem {
            place,
            message: message.into(),
            help: help.into(),
            repairs: Vec::new(),
        }
    }

    pub fn with(self, repairs: Vec<Repair>) -> Self {
        Problem {
            help: format!(
                "{}; `bryant import --repair-inertias` puts something in its place",
                self.help
            ),
            repairs,
            ..self
        }
    }
}

/// What carries an element.
#[derive(Clone, Copy)]
enum Carrier {
    Frame,
    Element(usize, usize),
}

struct Builder<'a> {
    robot: &'a Robot,
    /// For each link, the joints whose parent it is, in the order of the text.
    outboard: Vec<Vec<usize>>,
    /// Position and orientation of each link.
    placed: Vec<Frame>,
    forest: Forest,
    /// Whether joints that follow others move independently.
    uncouple: bool,
    /// Bodies that move and have no mass, in the order in which they are met.
    massless: Vec<Massless>,
    problems: Vec<Problem>,
}

/// The systems of a robot, or all problems that prevent them.
pub fn forest(robot: &Robot, base: Base, uncouple: bool) -> Result<Forest, Vec<Problem>> {
    let root = root(robot)?;
    if let Some(problem) = shape_only(robot) {
        return Err(vec![problem]);
    }
    let mut outboard = vec![Vec::new(); robot.links.len()];
    for (index, joint) in robot.joints.iter().enumerate() {
        outboard[joint.parent].push(index);
    }
    let still = Frame {
        at: [0.0; 3],
        turn: IDENTITY,
    };
    let mut builder = Builder {
        robot,
        outboard,
        placed: vec![still; robot.links.len()],
        forest: Forest {
            systems: Vec::new(),
            markers: Vec::new(),
            still: Vec::new(),
            merged: Vec::new(),
            idle: Vec::new(),
            placed: Vec::new(),
        },
        uncouple,
        massless: Vec::new(),
        problems: Vec::new(),
    };
    builder.place(root);
    builder.forest.placed = builder.placed.clone();
    match base {
        Base::Fixed => builder.body(root, Carrier::Frame, Vec::new()),
        Base::Free => builder.free(root, None),
    }
    builder
        .problems
        .extend(massless_bodies::problem(robot, &builder.massless));
    if !uncouple && builder.problems.is_empty() {
        let part = builder.part(root).filter(|part| wrong_with(part).is_none());
        coupling::join(robot, &mut builder.forest, root, part);
        builder.problems = coupling::problems(robot, &builder.forest);
    }
    if builder.problems.is_empty() && builder.forest.systems.is_empty() {
        builder.problems.push(Problem::new(
            robot.links[root].place,
            "nothing moves in this robot: its root link is fixed, and so are all joints",
            "a robot that stands still has no motion; with `bryant import --base free` its root link moves",
        ));
    }
    match builder.problems.is_empty() {
        true => Ok(builder.forest),
        false => Err(builder.problems),
    }
}

impl Builder<'_> {
    fn link(&self, index: usize) -> &Link {
        &self.robot.links[index]
    }

    /// Computes the positions of all links, outwards from the root.
    fn place(&mut self, root: usize) {
        let mut left = vec![root];
        while let Some(link) = left.pop() {
            let here = self.placed[link];
            for &index in &self.outboard[link] {
                let joint = &self.robot.joints[index];
                self.placed[joint.child] = Frame {
                    at: add(here.at, apply(&here.turn, joint.origin.at)),
                    turn: product(&here.turn, &joint.origin.turn),
                };
                left.push(joint.child);
            }
        }
    }

    fn mass(&self, link: usize) -> f64 {
        self.link(link).inertial.as_ref().map_or(0.0, |i| i.mass)
    }

    /// The links that fixed joints connect to a link, starting with the link itself.
    fn held(&self, link: usize) -> Vec<usize> {
        let mut held = vec![link];
        let mut next = 0;
        while next < held.len() {
            for &joint in &self.outboard[held[next]] {
                let joint = &self.robot.joints[joint];
                if joint.kind == JointType::Fixed {
                    held.push(joint.child);
                }
            }
            next += 1;
        }
        held
    }

    /// Adds a system of its own, starting with the body of a link; `joint` is the floating one, if there is one.
    fn free(&mut self, link: usize, joint: Option<usize>) {
        if self.held(link).iter().all(|&l| self.mass(l) == 0.0) {
            let outboard = self.moving(&self.held(link)).len();
            let joints = joint.into_iter().collect();
            self.massless.push(Massless {
                link,
                joints,
                outboard,
            });
        }
        self.forest.systems.push(System {
            free: true,
            elements: Vec::new(),
        });
        self.elements(link, None, Carried::Freely, None);
    }

    /// Adds a body; `joints` lie between it and its carrier.
    fn body(&mut self, link: usize, on: Carrier, joints: Vec<usize>) {
        let held = self.held(link);
        let massive = held.iter().any(|&l| self.mass(l) > 0.0);
        match (joints.is_empty(), massive) {
            // a body that is fixed to a fixed base is at rest
            (true, _) => {
                for &link in &held {
                    match self.mass(link) > 0.0 {
                        true => self.forest.still.push(link),
                        false => self.mark(link, None),
                    }
                }
                self.outwards(&held, Carrier::Frame);
            }
            (false, true) => self.moved(link, on, &joints),
            (false, false) => self.without_mass(link, &held, on, joints),
        }
    }

    /// Adds a body that moves on joints against its carrier.
    fn moved(&mut self, link: usize, on: Carrier, joints: &[usize]) {
        let origin = self.meeting_point(joints);
        let freedoms = joints.iter().flat_map(|&j| self.freedoms(j)).collect();
        let parent = match on {
            Carrier::Element(system, element) => {
                debug_assert_eq!(system + 1, self.forest.systems.len());
                Some(element)
            }
            Carrier::Frame => {
                self.forest.systems.push(System {
                    free: false,
                    elements: Vec::new(),
                });
                None
            }
        };
        self.elements(link, parent, Carried::Joint(freedoms), Some(origin));
    }

    /// Adds a body without mass between moving joints.
    fn without_mass(&mut self, link: usize, held: &[usize], on: Carrier, mut joints: Vec<usize>) {
        let outboard: Vec<usize> = self.moving(held);
        if let Some(part) = held.iter().find_map(|&l| self.part(l)) {
            let own = self.link(part.link);
            let place = own.inertial.as_ref().map_or(own.place, |i| i.place);
            let problem = Problem::new(
                place,
                format!("{} has an inertia and no mass", quoted(&own.name)),
                "give it the mass that the inertia is of, or make both 0",
            );
            self.problems
                .push(problem.with(vec![Repair::Mass(part.link)]));
            return self.moved(link, on, &joints);
        }
        let all_follow = joints.iter().all(|&j| self.robot.joints[j].mimic.is_some());
        match outboard[..] {
            [only] if self.robot.joints[only].kind != JointType::Floating => {
                joints.push(only);
                self.body(self.robot.joints[only].child, on, joints);
            }
            [] if !self.uncouple && all_follow => self.forest.idle.extend(joints),
            // said with all others; what it carries is looked at as if it had a mass
            _ => {
                self.moved(link, on, &joints);
                self.massless.push(Massless {
                    link,
                    joints,
                    outboard: outboard.len(),
                });
            }
        }
    }

    /// The moving joints whose parents are these links.
    fn moving(&self, held: &[usize]) -> Vec<usize> {
        let all = held.iter().flat_map(|&l| &self.outboard[l]);
        let moving = all.filter(|&&j| self.robot.joints[j].kind != JointType::Fixed);
        moving.copied().collect()
    }

    /// Adds everything that moves on these links.
    fn outwards(&mut self, held: &[usize], on: Carrier) {
        for index in self.moving(held) {
            let joint = &self.robot.joints[index];
            match (joint.kind, on) {
                (JointType::Floating, Carrier::Frame) => self.free(joint.child, Some(index)),
                (JointType::Floating, Carrier::Element(..)) => self.problems.push(Problem::new(
                    joint.place,
                    format!("the joint {} floats, and {} moves: only what is on a base that stands still can float", quoted(&joint.name), quoted(&self.link(joint.parent).name)),
                    "describe what floats in a file of its own".to_owned(),
                )),
                _ => self.body(joint.child, on, vec![index]),
            }
        }
    }

    /// Adds the elements of a body to the last system, with everything that they carry.
    fn elements(
        &mut self,
        link: usize,
        on: Option<usize>,
        carried: Carried,
        origin: Option<Vector>,
    ) {
        let system = self.forest.systems.len() - 1;
        let held = self.held(link);
        let mut parts: Vec<Part> = held.iter().filter_map(|&l| self.part(l)).collect();
        if parts.is_empty() {
            // it is refused for that; here it stands for what carries other elements
            parts.push(Part {
                link,
                mass: 1.0,
                center: self.placed[link].at,
                tensor: IDENTITY,
            });
        }
        let (element, frames) = match parts.iter().all(|p| wrong_with(p).is_none()) {
            true => (self.welded(system, &parts, on, carried, origin), held),
            false => (self.merged(system, &parts, on, carried, origin), held),
        };
        for &other in &frames {
            if parts.iter().all(|p| p.link != other) {
                self.mark(other, Some((system, element)));
            }
        }
        self.outwards(&frames, Carrier::Element(system, element));
    }

    /// An element for each part: the first one, with the others welded to it.
    fn welded(
        &mut self,
        system: usize,
        parts: &[Part],
        on: Option<usize>,
        carried: Carried,
        origin: Option<Vector>,
    ) -> usize {
        let elements = &mut self.forest.systems[system].elements;
        let first = elements.len();
        let mut carried = Some((on, carried, origin));
        for part in parts {
            let (on, carried, origin) =
                carried.take().unwrap_or((Some(first), Carried::Weld, None));
            let origin = origin.unwrap_or(self.placed[part.link].at);
            elements.push(Element {
                link: part.link,
                on,
                origin,
                carried,
                mass: part.mass,
                center: part.center,
                tensor: part.tensor,
            });
        }
        first
    }

    /// One element for all parts, named after the heaviest: some parts are physically impossible bodies by themselves.
    fn merged(
        &mut self,
        system: usize,
        parts: &[Part],
        on: Option<usize>,
        carried: Carried,
        origin: Option<Vector>,
    ) -> usize {
        let heaviest = parts.iter().max_by(|a, b| a.mass.total_cmp(&b.mass));
        let main = heaviest.map_or(0, |p| p.link);
        let whole = together(main, parts);
        // a body without mass has been refused for that
        if whole.mass > 0.0
            && let Some(wrong) = wrong_with(&whole)
        {
            let inertial = self.link(main).inertial.as_ref();
            let place = inertial.map_or(self.link(main).place, |i| i.tensor_place);
            let name = quoted(&self.link(main).name);
            let what = match parts.len() {
                1 => name,
                _ => format!("{name}, with what is fixed to it,"),
            };
            let help = "give the tensor of a body: about the centre of mass, each principal moment at most the sum of the other two";
            let problem = Problem::new(place, format!("the inertia of {what} {wrong}"), help);
            let wrong = parts.iter().filter(|p| wrong_tensor(&p.tensor).is_some());
            let repair = Repair::Tensor(wrong.map(|p| p.link).collect());
            self.problems.push(problem.with(vec![repair]));
        } else {
            let names = parts
                .iter()
                .map(|p| p.link)
                .filter(|&l| l != main)
                .collect();
            self.forest.merged.push((main, names));
        }
        let elements = &mut self.forest.systems[system].elements;
        elements.push(Element {
            link: main,
            on,
            origin: origin.unwrap_or(self.placed[main].at),
            carried,
            mass: whole.mass,
            center: whole.center,
            tensor: whole.tensor,
        });
        elements.len() - 1
    }

    /// The inertia of a link; `None` for a frame.
    fn part(&self, link: usize) -> Option<Part> {
        let here = self.placed[link];
        let inertial = self.link(link).inertial.as_ref()?;
        if inertial.mass == 0.0 && inertial.tensor.as_flattened().iter().all(|&i| i == 0.0) {
            return None;
        }
        Some(Part {
            link,
            mass: inertial.mass,
            center: add(here.at, apply(&here.turn, inertial.frame.at)),
            tensor: turned(&product(&here.turn, &inertial.frame.turn), &inertial.tensor),
        })
    }

    fn mark(&mut self, link: usize, on: Option<(usize, usize)>) {
        let at = self.placed[link].at;
        let origin = on.map_or([0.0; 3], |(s, e)| self.forest.systems[s].elements[e].origin);
        self.forest.markers.push(Marker {
            link,
            on,
            at: subtract(at, origin),
        });
    }

    fn axis(&self, joint: &Joint, axis: Vector) -> Vector {
        apply(&self.placed[joint.child].turn, axis)
    }

    fn freedoms(&self, index: usize) -> Vec<Freedom> {
        let joint = &self.robot.joints[index];
        let along = |axis, slides, suffix| Freedom {
            joint: index,
            slides,
            axis: self.axis(joint, axis),
            suffix,
        };
        match joint.kind {
            JointType::Revolute | JointType::Continuous => vec![along(joint.axis, false, "")],
            JointType::Prismatic => vec![along(joint.axis, true, "")],
            JointType::Planar => {
                let (first, second) = across(joint.axis);
                vec![
                    along(first, true, "_x"),
                    along(second, true, "_y"),
                    along(joint.axis, false, ""),
                ]
            }
            JointType::Fixed | JointType::Floating => Vec::new(),
        }
    }

    /// The point in which all axes of rotation of a list of joints meet, with all joints at 0; it is a problem if they
    /// do not.
    fn meeting_point(&mut self, joints: &[usize]) -> Vector {
        let robot = self.robot;
        let turns: Vec<usize> = joints
            .iter()
            .copied()
            .filter(|&j| robot.joints[j].kind != JointType::Prismatic)
            .collect();
        let line = |j: usize| {
            let joint = &robot.joints[j];
            (self.placed[joint.child].at, self.axis(joint, joint.axis))
        };
        let last = self.placed[robot.joints[joints[joints.len() - 1]].child].at;
        let point = match turns[..] {
            [] => last,
            [only] => line(only).0,
            [first, second, ..] => {
                let ((p, a), (q, b)) = (line(first), line(second));
                let normal = cross(a, b);
                let square = dot(normal, normal);
                // parallel axes meet only if they coincide
                match square < 1e-12 {
                    true => p,
                    false => add(p, scale(a, dot(cross(subtract(q, p), b), normal) / square)),
                }
            }
        };
        for &j in &turns {
            let (p, a) = line(j);
            if length(cross(subtract(point, p), a)) > MEET_TO {
                let joint = &robot.joints[j];
                let names: Vec<String> = joints
                    .iter()
                    .map(|&j| quoted(&robot.joints[j].name))
                    .collect();
                let problem = Problem::new(
                    joint.place,
                    format!(
                        "the joints {} have no mass between them, and their axes do not meet in one point",
                        names.join(", ")
                    ),
                    format!(
                        "give {} a mass and an inertia",
                        quoted(&self.link(joint.parent).name)
                    ),
                );
                let between = joints[1..]
                    .iter()
                    .map(|&j| Repair::Mass(robot.joints[j].parent));
                self.problems.push(problem.with(between.collect()));
                break;
            }
        }
        point
    }
}

/// Two directions perpendicular to an axis: x and y of a plane with the normal z, otherwise the next axes in cyclic
/// order.
fn across(axis: Vector) -> (Vector, Vector) {
    let unit = |i: usize| -> Vector { std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }) };
    let largest = (0..3)
        .max_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs()))
        .unwrap_or(2);
    let first = unit((largest + 1) % 3);
    let first = subtract(first, scale(axis, dot(axis, first)));
    let first = scale(first, 1.0 / length(first));
    (first, cross(axis, first))
}
