//! Turns links and joints into systems of elements.
//!
//! All positions are measured in one frame: that of the root link, with all joints at 0. Links that are connected by fixed joints
//! are one body. The first of its links that has a mass is an element, its other links with mass are welded to it, and links
//! without mass are frames. A body without mass between two moving joints is no element; its joints become a list. For that their
//! axes must meet in one point.

use super::robot::{Frame, Joint, Kind, Link, Place, Robot};
use crate::diagnostic::quoted;
use crate::rotation::{
    IDENTITY, Matrix, Vector, add, apply, cross, dot, length, principal, product, scale, subtract,
    turned,
};

/// The largest distance by which the axes of a list may miss each other \[m\].
const MEET_TO: f64 = 1e-9;

/// The relative excess of a principal moment over the sum of the others that counts as rounding.
const ROUNDING: f64 = 1e-9;

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

/// A degree of freedom of a joint.
pub struct Freedom {
    pub joint: usize,
    pub slides: bool,
    pub axis: Vector,
    /// Appended to the name of the joint, if that has several degrees of freedom.
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
    /// Links that become one element with the name of the first, because some of them are physically impossible bodies.
    pub merged: Vec<(usize, Vec<usize>)>,
}

/// A problem: its place, the error, and the remedy.
pub type Problem = (Place, String, String);

/// What carries an element.
#[derive(Clone, Copy)]
enum Carrier {
    Frame,
    Element(usize, usize),
}

/// Inertia of a link, in the axes of the root link.
struct Part {
    link: usize,
    mass: f64,
    center: Vector,
    /// Inertia tensor about the centre of mass.
    tensor: Matrix,
}

/// The reason why no body can have this inertia, if there is one.
fn wrong_with(part: &Part) -> Option<String> {
    let (moments, _) = principal(&part.tensor);
    let sum: f64 = moments.iter().sum();
    let largest = moments.iter().copied().fold(f64::MIN, f64::max);
    let smallest = moments.iter().copied().fold(f64::MAX, f64::min);
    let shown = moments.map(|m| format!("{m:.4e}")).join(", ");
    if part.mass <= 0.0 {
        Some("has no mass".to_owned())
    } else if smallest < -ROUNDING * largest.abs() {
        Some(format!("has a negative principal moment: {shown} kg·m²"))
    } else if 2.0 * largest > sum * (1.0 + ROUNDING) {
        Some(format!(
            "is that of no body: of its principal moments {shown} kg·m² one is above the sum of the other two"
        ))
    } else {
        None
    }
}

/// The inertia of all parts together (parallel axis theorem).
fn together(link: usize, parts: &[Part]) -> Part {
    let mass: f64 = parts.iter().map(|p| p.mass).sum();
    let moment = parts
        .iter()
        .fold([0.0; 3], |sum, p| add(sum, scale(p.center, p.mass)));
    let center = match mass > 0.0 {
        true => scale(moment, 1.0 / mass),
        false => [0.0; 3],
    };
    let mut tensor = [[0.0; 3]; 3];
    for part in parts {
        let d = subtract(part.center, center);
        for (i, row) in tensor.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let square = if i == j { dot(d, d) } else { 0.0 };
                *entry += part.tensor[i][j] + part.mass * (square - d[i] * d[j]);
            }
        }
    }
    Part {
        link,
        mass,
        center,
        tensor,
    }
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
    problems: Vec<Problem>,
}

/// The systems of a robot, or all problems that prevent them.
pub fn forest(robot: &Robot, base: Base, uncouple: bool) -> Result<Forest, Vec<Problem>> {
    let root = root(robot)?;
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
        },
        uncouple,
        problems: Vec::new(),
    };
    builder.place(root);
    match base {
        Base::Fixed => builder.body(root, Carrier::Frame, Vec::new()),
        Base::Free => builder.free(root, robot.links[root].place),
    }
    if !uncouple {
        builder.follow();
    }
    if builder.problems.is_empty() && builder.forest.systems.is_empty() {
        let help =
            "a robot that stands still has no motion; with `--base free` its root link moves";
        let message = "nothing moves in this robot: its root link is fixed, and so are all joints";
        builder
            .problems
            .push((robot.links[root].place, message.to_owned(), help.to_owned()));
    }
    match builder.problems.is_empty() {
        true => Ok(builder.forest),
        false => Err(builder.problems),
    }
}

/// The only link that is not a child.
fn root(robot: &Robot) -> Result<usize, Vec<Problem>> {
    let mut problems: Vec<Problem> = Vec::new();
    let mut inboard: Vec<Option<usize>> = vec![None; robot.links.len()];
    for (index, joint) in robot.joints.iter().enumerate() {
        match inboard[joint.child] {
            None => inboard[joint.child] = Some(index),
            Some(first) => problems.push((
                joint.place,
                format!(
                    "the link {} is a child twice, of {} and of {}",
                    quoted(&robot.links[joint.child].name),
                    quoted(&robot.joints[first].name),
                    quoted(&joint.name)
                ),
                "URDF describes trees: one joint carries a link".to_owned(),
            )),
        }
    }
    let roots: Vec<usize> = (0..robot.links.len())
        .filter(|&l| inboard[l].is_none())
        .collect();
    if let [first, others @ ..] = &roots[..] {
        for &other in others {
            problems.push((
                robot.links[other].place,
                format!(
                    "there are two root links, {} and {}",
                    quoted(&robot.links[*first].name),
                    quoted(&robot.links[other].name)
                ),
                "add the joint that carries one of them".to_owned(),
            ));
        }
    }
    // a walk inwards that is longer than the number of links goes in a circle
    for link in 0..robot.links.len() {
        let mut at = link;
        for _ in 0..robot.links.len() {
            match inboard[at] {
                Some(joint) => at = robot.joints[joint].parent,
                None => break,
            }
            if at == link {
                let joint = &robot.joints[inboard[link].unwrap_or(0)];
                problems.push((
                    joint.place,
                    format!(
                        "the link {} carries itself",
                        quoted(&robot.links[link].name)
                    ),
                    "URDF describes trees: remove a joint of the circle".to_owned(),
                ));
                return Err(problems);
            }
        }
    }
    match (problems.is_empty(), roots.first()) {
        (true, Some(&root)) => Ok(root),
        _ => Err(problems),
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

    /// Checks joints that follow others: the leader must be in the same system, and there must be no circle.
    fn follow(&mut self) {
        let joints = &self.robot.joints;
        // for each joint, its system and number of degrees of freedom
        let mut freedoms: Vec<Option<(usize, usize)>> = vec![None; joints.len()];
        for (s, system) in self.forest.systems.iter().enumerate() {
            for element in &system.elements {
                if let Carried::Joint(list) = &element.carried {
                    for freedom in list {
                        let count = freedoms[freedom.joint].map_or(0, |(_, count)| count);
                        freedoms[freedom.joint] = Some((s, count + 1));
                    }
                }
            }
        }
        for (index, joint) in joints.iter().enumerate() {
            let (Some(mimic), Some((system, own))) = (&joint.mimic, freedoms[index]) else {
                continue;
            };
            let name = quoted(&joint.name);
            let leader = quoted(&mimic.leader);
            let wrong = match self.leader(joint).map(|leader| freedoms[leader]) {
                _ if own > 1 => Some("has several freedoms, and only one can follow".to_owned()),
                None | Some(None) => Some(format!("follows {leader}, which does not move")),
                Some(Some((_, 2..))) => {
                    Some(format!("follows {leader}, which has several freedoms"))
                }
                Some(Some((other, _))) if other != system => Some(format!(
                    "follows {leader}, which nothing that moves joins to it: they are systems of their own"
                )),
                Some(Some(_)) if self.is_in_circle(index) => {
                    Some(format!("follows {leader}, and so itself"))
                }
                Some(Some(_)) => None,
            };
            if let Some(wrong) = wrong {
                self.problems.push((
                    mimic.place,
                    format!("the joint {name} {wrong}"),
                    "with `--uncouple` it moves by itself; or make its type `fixed`".to_owned(),
                ));
            }
        }
    }

    fn leader(&self, joint: &Joint) -> Option<usize> {
        let name = &joint.mimic.as_ref()?.leader;
        self.robot.joints.iter().position(|j| j.name == *name)
    }

    /// Whether going from leader to leader leads back to a joint.
    fn is_in_circle(&self, joint: usize) -> bool {
        let joints = &self.robot.joints;
        let mut at = joint;
        for _ in 0..joints.len() {
            match self.leader(&joints[at]) {
                Some(leader) if leader == joint => return true,
                Some(leader) => at = leader,
                None => return false,
            }
        }
        false
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
                if joint.kind == Kind::Fixed {
                    held.push(joint.child);
                }
            }
            next += 1;
        }
        held
    }

    /// Adds a system of its own, starting with the body of a link.
    fn free(&mut self, link: usize, place: Place) {
        if self.held(link).iter().all(|&l| self.mass(l) == 0.0) {
            let message = format!(
                "{} moves freely and has no mass",
                quoted(&self.link(link).name)
            );
            self.problems
                .push((place, message, "give it a mass".to_owned()));
            return;
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
            (false, true) => {
                let Some(origin) = self.meeting_point(&joints) else {
                    return;
                };
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
            (false, false) => self.without_mass(&held, on, joints),
        }
    }

    /// Adds a body without mass between moving joints.
    fn without_mass(&mut self, held: &[usize], on: Carrier, joints: Vec<usize>) {
        let outboard: Vec<usize> = self.moving(held);
        let last = &self.robot.joints[joints[joints.len() - 1]];
        let name = quoted(&self.link(last.child).name);
        if let Some(part) = held.iter().find_map(|&l| self.part(l)) {
            let link = self.link(part.link);
            let place = link.inertial.as_ref().map_or(link.place, |i| i.place);
            let message = format!("{} has an inertia and no mass", quoted(&link.name));
            self.problems.push((
                place,
                message,
                "give it the mass that the inertia is of, or make both 0".to_owned(),
            ));
            return;
        }
        match outboard[..] {
            [only] if self.robot.joints[only].kind != Kind::Floating => {
                let child = self.robot.joints[only].child;
                let mut joints = joints;
                joints.push(only);
                self.body(child, on, joints);
            }
            [] if !self.uncouple && joints.iter().all(|&j| self.robot.joints[j].mimic.is_some()) => {
                self.forest.idle.extend(joints);
            }
            [] => self.problems.push((
                last.place,
                format!("{name} moves on the joint {} and has no mass: nothing says how fast", quoted(&last.name)),
                "give the link a mass and an inertia, or make the joint fixed".to_owned(),
            )),
            _ => self.problems.push((
                last.place,
                format!("{name} has no mass, and carries {} joints that move", outboard.len()),
                "give the link a mass and an inertia; without, it can stand between two joints only".to_owned(),
            )),
        }
    }

    /// The moving joints whose parents are these links.
    fn moving(&self, held: &[usize]) -> Vec<usize> {
        let all = held.iter().flat_map(|&l| &self.outboard[l]);
        let moving = all.filter(|&&j| self.robot.joints[j].kind != Kind::Fixed);
        moving.copied().collect()
    }

    /// Adds everything that moves on these links.
    fn outwards(&mut self, held: &[usize], on: Carrier) {
        for index in self.moving(held) {
            let joint = &self.robot.joints[index];
            match (joint.kind, on) {
                (Kind::Floating, Carrier::Frame) => self.free(joint.child, joint.place),
                (Kind::Floating, Carrier::Element(..)) => self.problems.push((
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
        let parts: Vec<Part> = held.iter().filter_map(|&l| self.part(l)).collect();
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
        if let Some(wrong) = wrong_with(&whole) {
            let inertial = self.link(main).inertial.as_ref();
            let place = inertial.map_or(self.link(main).place, |i| i.tensor_place);
            let name = quoted(&self.link(main).name);
            let what = match parts.len() {
                1 => name,
                _ => format!("{name}, with what is fixed to it,"),
            };
            let help = "give the tensor of a body: about the centre of mass, each principal moment at most the sum of the other two";
            self.problems.push((
                place,
                format!("the inertia of {what} {wrong}"),
                help.to_owned(),
            ));
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
            Kind::Revolute | Kind::Continuous => vec![along(joint.axis, false, "")],
            Kind::Prismatic => vec![along(joint.axis, true, "")],
            Kind::Planar => {
                let (first, second) = across(joint.axis);
                vec![
                    along(first, true, "_x"),
                    along(second, true, "_y"),
                    along(joint.axis, false, ""),
                ]
            }
            Kind::Fixed | Kind::Floating => Vec::new(),
        }
    }

    /// The point in which all axes of rotation of a list of joints meet, with all joints at 0.
    fn meeting_point(&mut self, joints: &[usize]) -> Option<Vector> {
        let robot = self.robot;
        let turns: Vec<usize> = joints
            .iter()
            .copied()
            .filter(|&j| robot.joints[j].kind != Kind::Prismatic)
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
                let problem = (
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
                self.problems.push(problem);
                return None;
            }
        }
        Some(point)
    }
}

/// Two directions perpendicular to an axis: x and y of a plane with the normal z, otherwise the next axes in cyclic order.
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
