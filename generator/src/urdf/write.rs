//! Writes the model as YAML.

use super::Options;
use super::robot::{Joint, JointType, Limits, Mesh, Mimic, Robot, TextPlace};
use super::tree::{Carried, Element, Forest, Freedom};
use crate::model::Triangles;
use crate::rotation::{Matrix, Vector, add, apply, bryant_angles, length, product, subtract};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Values below this part of the numbers from which they were computed are rounding errors.
const ROUNDING: f64 = 1e-15;

/// Gravity if the description gives none, along −z of the root link \[m/s²\].
const GRAVITY: f64 = 9.81;

/// The names of a list. Each is a valid word, and all are different.
struct Names {
    given: Vec<String>,
}

impl Names {
    fn of<'a>(written: impl Iterator<Item = &'a str>, otherwise: &str) -> Self {
        let mut taken = BTreeSet::new();
        let given = written.map(|name| {
            let word = word(name, '_', otherwise);
            let mut unique = word.clone();
            let mut number = 2;
            // identifiers have no dashes, and must also differ
            while !taken.insert(unique.clone()) {
                unique = format!("{word}_{number}");
                number += 1;
            }
            unique
        });
        Names {
            given: given.collect(),
        }
    }
}

/// A name as a word of lower-case letters and digits.
fn word(name: &str, separator: char, otherwise: &str) -> String {
    let mut word = String::new();
    for c in name.to_lowercase().chars() {
        match c.is_ascii_lowercase() || c.is_ascii_digit() {
            true => word.push(c),
            false if !word.ends_with(separator) && !word.is_empty() => word.push(separator),
            false => {}
        }
    }
    let mut word = word.trim_end_matches(separator).to_owned();
    if !word.starts_with(|c: char| c.is_ascii_lowercase())
        || crate::model::resolve::name::is_keyword(&word)
    {
        word = match word.is_empty() {
            true => otherwise.to_owned(),
            false => format!("{otherwise}{separator}{word}"),
        };
    }
    word.truncate(56);
    word.trim_end_matches(separator).to_owned()
}

/// A number with all digits that it needs.
fn number(value: f64) -> String {
    let value = if value == 0.0 { 0.0 } else { value };
    let plain = format!("{value}");
    let short = format!("{value:e}");
    match short.len() < plain.len() {
        true => short,
        false => plain,
    }
}

fn list(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|&v| number(v)).collect();
    format!("[{}]", numbers.join(", "))
}

/// A vector without components that are rounding errors relative to `size`.
fn vector(v: Vector, size: f64) -> String {
    list(&v.map(|c| without_rounding(c, size)))
}

/// The number with the fewest decimals that differs from a value only by the rounding of sums of numbers of size
/// `size`.
fn without_rounding(value: f64, size: f64) -> f64 {
    let decimals = (0..=17).map(|digits| format!("{value:.digits$}").parse().unwrap_or(value));
    let mut close = decimals.filter(|short: &f64| (short - value).abs() <= ROUNDING * size);
    close.next().unwrap_or(value)
}

/// `x`, `y` or `z`, or the vector.
fn axis(v: Vector) -> String {
    let clean = v.map(|c| if c.abs() <= ROUNDING { 0.0 } else { c });
    match clean {
        [1.0, 0.0, 0.0] => "x".to_owned(),
        [0.0, 1.0, 0.0] => "y".to_owned(),
        [0.0, 0.0, 1.0] => "z".to_owned(),
        _ => list(&clean),
    }
}

/// The key `stop` for limits; nothing where there are none, or where both are 0.
fn stop(limits: &Limits, stiffness: f64) -> String {
    let [from, to] = limits.range;
    if limits.are_empty() || (from.is_infinite() && to.is_infinite()) {
        return String::new();
    }
    let end = |key: &str, value: f64| match value.is_finite() {
        true => format!("{key}: {}, ", number(value)),
        false => String::new(),
    };
    let ends = end("from", from) + &end("to", to);
    format!(", stop: {{ {ends}stiffness: {} }}", number(stiffness))
}

/// Whether a number is a limit of a motor: zeros are none.
fn is_limit(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// A comment on the limits of a joint: those of its coordinate unless they are stops, and those of its motor unless it
/// is an input.
fn limits(joint: &Joint, are_stops: bool, is_input: bool) -> Option<String> {
    let limits = joint.limits?;
    let (unit, effort) = match joint.kind {
        JointType::Prismatic => ("m", "N"),
        _ => ("rad", "N·m"),
    };
    let mut parts = Vec::new();
    let [from, to] = limits.range;
    if !are_stops && (from.is_finite() || to.is_finite()) {
        parts.push(format!(
            "has the limits {} and {} {unit}",
            number(from),
            number(to)
        ));
    }
    if !is_input && is_limit(limits.effort) {
        parts.push(format!(
            "has a motor of at most {} {effort}",
            number(limits.effort)
        ));
    }
    if is_limit(limits.velocity) {
        parts.push(format!(
            "moves at {} {unit}/s at most",
            number(limits.velocity)
        ));
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// Writes the model. Also returns its lines that come from a link or a joint, with the places of these.
pub fn yaml(
    file: &str,
    robot: &Robot,
    forest: &Forest,
    options: &Options,
    changes: &[String],
) -> (String, Vec<(usize, TextPlace)>) {
    let writer = Writer {
        robot,
        forest,
        links: Names::of(robot.links.iter().map(|l| l.name.as_str()), "link"),
        joints: Names::of(robot.joints.iter().map(|j| j.name.as_str()), "joint"),
        name: word(&robot.name, '_', "robot"),
        origins: RefCell::default(),
    };
    let mut text = String::new();
    // writing to a String never fails
    let _ = writer.write(file, options, changes, &mut text);
    (text, writer.origins.into_inner())
}

struct Writer<'a> {
    robot: &'a Robot,
    forest: &'a Forest,
    links: Names,
    joints: Names,
    name: String,
    origins: RefCell<Vec<(usize, TextPlace)>>,
}

impl Writer<'_> {
    /// Records that the current line of the text comes from this place.
    fn origin(&self, text: &str, place: TextPlace) {
        let line = text.matches('\n').count() + 1;
        self.origins.borrow_mut().push((line, place));
    }

    fn write(
        &self,
        file: &str,
        options: &Options,
        changes: &[String],
        text: &mut String,
    ) -> std::fmt::Result {
        // the text does not depend on where the file is
        let file = file.rsplit(['/', '\\']).next().unwrap_or(file);
        writeln!(
            text,
            "# Imported from {}.\n#",
            file.replace(char::is_control, " ")
        )?;
        writeln!(
            text,
            "# The frames of all elements are parallel to that of the root link while all joints are at 0, with the origin in the joint."
        )?;
        writeln!(
            text,
            "# Elements have the names of links, freedoms the names of joints."
        )?;
        self.renamed(text)?;
        if !changes.is_empty() {
            writeln!(text, "#\n# Changed by --repair-inertias:")?;
        }
        for change in changes {
            writeln!(text, "#   {}", change.replace(char::is_control, " "))?;
        }
        writeln!(
            text,
            "model: {}\ndimension: 3",
            word(&self.robot.name, '-', "robot")
        )?;
        self.inputs(options, text)?;
        let at_rest = self.meshes(None, [0.0; 3]);
        if !at_rest.is_empty() {
            writeln!(text, "mesh:")?;
        }
        for (link, mesh) in at_rest {
            self.origin(text, self.robot.links[link].place);
            writeln!(text, "  - {mesh}")?;
        }
        writeln!(text, "systems:")?;
        for (index, system) in self.forest.systems.iter().enumerate() {
            writeln!(text, "  - name: {}", self.system(index))?;
            writeln!(
                text,
                "    reference: {}",
                if system.free { "free" } else { "fixed" }
            )?;
            writeln!(text, "    elements:")?;
            for element in &system.elements {
                self.element(&system.elements, element, options.uncouple, text)?;
            }
            if let Some(root) = system.elements.first()
                && root.origin != [0.0; 3]
            {
                writeln!(
                    text,
                    "    start: {{ position: {} }}",
                    vector(root.origin, length(root.origin))
                )?;
            }
        }
        writeln!(
            text,
            "forces:\n  - {{ field: gravity, acceleration: [0, 0, -{GRAVITY}] }}"
        )?;
        for (index, system) in self.forest.systems.iter().enumerate() {
            for element in &system.elements {
                if let Carried::Joint(freedoms) = &element.carried {
                    self.forces(index, element, freedoms, options, text)?;
                }
            }
        }
        writeln!(text, "outputs:")?;
        for (index, system) in self.forest.systems.iter().enumerate() {
            for element in &system.elements {
                self.outputs(index, element, text)?;
            }
        }
        writeln!(text, "run: {{ duration: 1 s, every: 10 ms }}")?;
        self.frames(text)
    }

    /// The inputs of all motors, with the limits of their effort.
    fn inputs(&self, options: &Options, text: &mut String) -> std::fmt::Result {
        let elements = self
            .forest
            .systems
            .iter()
            .flat_map(|system| &system.elements);
        let freedoms = elements.flat_map(|element| match &element.carried {
            Carried::Joint(freedoms) => &freedoms[..],
            Carried::Weld | Carried::Freely => &[],
        });
        let mut first = true;
        for freedom in freedoms {
            let Some(name) = self.input(freedom, options) else {
                continue;
            };
            if std::mem::take(&mut first) {
                writeln!(text, "inputs:")?;
            }
            let joint = &self.robot.joints[freedom.joint];
            self.origin(text, joint.place);
            let unit = if freedom.slides { "N" } else { "N*m" };
            let effort = joint.limits.map_or(0.0, |limits| limits.effort);
            match is_limit(effort) {
                true => {
                    let most = number(effort);
                    writeln!(
                        text,
                        "  {name}: {{ value: 0 {unit}, min: -{most} {unit}, max: {most} {unit} }}"
                    )?;
                }
                false => writeln!(text, "  {name}: 0 {unit}")?,
            }
        }
        Ok(())
    }

    /// The name of the input of a motor; `None` if the freedom has no motor.
    fn input(&self, freedom: &Freedom, options: &Options) -> Option<String> {
        let joint = &self.robot.joints[freedom.joint];
        let moves = matches!(
            joint.kind,
            JointType::Revolute | JointType::Continuous | JointType::Prismatic
        );
        let follows = joint.mimic.is_some() && !options.uncouple;
        let what = if freedom.slides { "force" } else { "torque" };
        (options.inputs && moves && !follows)
            .then(|| format!("{}_{what}", self.joints.given[freedom.joint]))
    }

    /// Outputs for the coordinates of a joint, by the names of the joints; for a free root, its position.
    fn outputs(&self, system: usize, element: &Element, text: &mut String) -> std::fmt::Result {
        let (system, name) = (self.system(system), &self.links.given[element.link]);
        let freedoms = match &element.carried {
            Carried::Weld => return Ok(()),
            Carried::Freely => {
                return writeln!(
                    text,
                    "  - {{ name: {name}, of: {system}/{name}, what: position, component: [x, y, z] }}"
                );
            }
            Carried::Joint(freedoms) => freedoms,
        };
        for freedom in freedoms {
            let joint = self.freedom_name(freedom);
            let of = match freedoms.len() {
                1 => String::new(),
                _ => format!(", freedom: {joint}"),
            };
            let what = if freedom.slides { "position" } else { "angle" };
            writeln!(
                text,
                "  - {{ name: {joint}, of: joint {system}/{name}{of}, what: {what} }}"
            )?;
        }
        Ok(())
    }

    /// A comment on the names that differ from those of the description.
    fn renamed(&self, text: &mut String) -> std::fmt::Result {
        let links = self
            .robot
            .links
            .iter()
            .map(|l| &l.name)
            .zip(&self.links.given);
        let joints = self
            .robot
            .joints
            .iter()
            .map(|j| &j.name)
            .zip(&self.joints.given);
        let mut first = true;
        for (written, given) in links
            .chain(joints)
            .filter(|(written, given)| written != given)
        {
            if first {
                writeln!(text, "#\n# Names that are written otherwise here:")?;
                first = false;
            }
            writeln!(
                text,
                "#   {given}: {}",
                written.replace(char::is_control, " ")
            )?;
        }
        Ok(())
    }

    fn system(&self, index: usize) -> String {
        match &self.forest.systems[..] {
            [_] => self.name.clone(),
            all => match all[index].elements.first() {
                Some(root) => self.links.given[root.link].clone(),
                None => self.name.clone(),
            },
        }
    }

    fn element(
        &self,
        elements: &[Element],
        element: &Element,
        uncouple: bool,
        text: &mut String,
    ) -> std::fmt::Result {
        self.origin(text, self.robot.links[element.link].place);
        write!(text, "      - {{ name: {}", self.links.given[element.link])?;
        if let Some(parent) = element.on {
            let parent = &elements[parent];
            let at = subtract(element.origin, parent.origin);
            let size = length(element.origin).max(length(parent.origin));
            write!(
                text,
                ", on: {}, at: {}",
                self.links.given[parent.link],
                vector(at, size)
            )?;
        }
        match &element.carried {
            Carried::Freely if element.on.is_none() => {}
            Carried::Freely => write!(text, ", joint: free")?,
            Carried::Weld => write!(text, ", joint: weld")?,
            Carried::Joint(freedoms) => {
                let written: Vec<String> = freedoms
                    .iter()
                    .map(|f| self.freedom(elements, f, uncouple))
                    .collect();
                match &written[..] {
                    [one] => write!(text, ", joint: {one}")?,
                    all => write!(text, ", joint: [{}]", all.join(", "))?,
                }
            }
        }
        let center = subtract(element.center, element.origin);
        let size = length(element.center).max(length(element.origin));
        write!(
            text,
            ", mass: {}, cg: {}",
            number(element.mass),
            vector(center, size)
        )?;
        let t = &element.tensor;
        let largest = t[0][0].abs().max(t[1][1].abs()).max(t[2][2].abs());
        let entry = |p: f64| without_rounding(p, largest);
        let products = [t[0][1], t[0][2], t[1][2]].map(entry);
        let moments = [t[0][0], t[1][1], t[2][2]].map(entry);
        match products == [0.0; 3] {
            true => write!(text, ", inertia: {}", list(&moments))?,
            false => write!(text, ", inertia: {}", list(&[moments, products].concat()))?,
        }
        let shown = self.meshes(Some(element.link), element.origin);
        let shown: Vec<String> = shown.into_iter().map(|(_, mesh)| mesh).collect();
        match &shown[..] {
            [] => {}
            [one] => write!(text, ", mesh: {one}")?,
            all => write!(text, ", mesh: [{}]", all.join(", "))?,
        }
        let points = self.points(element);
        if !points.is_empty() {
            write!(text, ", points: [{}]", points.join(", "))?;
        }
        writeln!(text, " }}")
    }

    /// The links that are parts of an element, as points: those without mass that are fixed to it, and those that are
    /// not a body by themselves.
    fn points(&self, element: &Element) -> Vec<String> {
        let systems = &self.forest.systems;
        let is_here = |(s, e): (usize, usize)| systems[s].elements[e].link == element.link;
        let markers = self.forest.markers.iter();
        let here = markers.filter(|marker| marker.on.is_some_and(is_here));
        let merged = self.forest.merged.iter();
        let merged = merged.filter(|(main, _)| *main == element.link);
        let merged = merged.flat_map(|(_, others)| others.iter().copied());
        let text = |link: usize| {
            let name = &self.links.given[link];
            let placed = &self.forest.placed[link];
            let frame = frame(placed.at, &placed.turn, element.origin);
            format!("{{ name: {name}{frame} }}")
        };
        here.map(|marker| marker.link)
            .chain(merged)
            .map(text)
            .collect()
    }

    /// The meshes of all links of an element, which has the name of this link, or of all links at rest, each with its
    /// link.
    fn meshes(&self, element: Option<usize>, origin: Vector) -> Vec<(usize, String)> {
        let links = self.robot.links.iter().enumerate();
        let shown = links.filter(|(_, link)| !link.meshes.is_empty());
        let of = shown.filter(|(link, _)| self.carrier(*link) == Some(element));
        let each = of.flat_map(|(link, of)| of.meshes.iter().map(move |mesh| (link, mesh)));
        let text = |(link, mesh): (usize, &Mesh)| {
            let placed = &self.forest.placed[link];
            let place = add(placed.at, apply(&placed.turn, mesh.frame.at));
            let frame = frame(place, &product(&placed.turn, &mesh.frame.turn), origin);
            let mut text = match &mesh.of {
                Triangles::File(file) => {
                    let file = file.replace(['"', '\\'], "/");
                    let file = file.replace(char::is_control, " ");
                    format!("{{ file: \"{file}\"")
                }
                Triangles::Solid(solid) => format!("{{ shape: {}", solid.word()),
            };
            match &mesh.of {
                Triangles::Solid(_) => text += &format!(", size: {}", list(&mesh.scale)),
                Triangles::File(_) if mesh.scale == [1.0; 3] => {}
                Triangles::File(_) => text += &format!(", scale: {}", list(&mesh.scale)),
            }
            (link, text + &frame + " }")
        };
        each.map(text).collect()
    }

    /// The link whose name the element has that a link moves with, `Some(None)` of a link at rest, and `None` of one
    /// that is no part of an element.
    fn carrier(&self, link: usize) -> Option<Option<usize>> {
        let systems = &self.forest.systems;
        let mut elements = systems.iter().flat_map(|system| &system.elements);
        if elements.any(|element| element.link == link) {
            return Some(Some(link));
        }
        let merged = &self.forest.merged;
        if let Some((main, _)) = merged.iter().find(|(_, others)| others.contains(&link)) {
            return Some(Some(*main));
        }
        if let Some(marker) = self.forest.markers.iter().find(|m| m.link == link) {
            return Some(marker.on.map(|(s, e)| systems[s].elements[e].link));
        }
        self.forest.still.contains(&link).then_some(None)
    }

    fn freedom_name(&self, freedom: &Freedom) -> String {
        format!("{}{}", self.joints.given[freedom.joint], freedom.suffix)
    }

    fn freedom(&self, elements: &[Element], freedom: &Freedom, uncouple: bool) -> String {
        let kind = if freedom.slides { "slider" } else { "hinge" };
        let joint = &self.robot.joints[freedom.joint];
        let armature = match joint.armature {
            0.0 => String::new(),
            armature => format!(", armature: {}", number(armature)),
        };
        let follows = match &joint.mimic {
            Some(mimic) if !uncouple => self.follows(elements, mimic),
            _ => String::new(),
        };
        format!(
            "{{ {kind}: {}, name: {}{armature}{follows} }}",
            axis(freedom.axis),
            self.freedom_name(freedom)
        )
    }

    /// The key `follows` of a freedom whose leader is in the same system.
    fn follows(&self, elements: &[Element], mimic: &Mimic) -> String {
        let freedoms = elements.iter().flat_map(|element| {
            let freedoms = match &element.carried {
                Carried::Joint(freedoms) => &freedoms[..],
                Carried::Weld | Carried::Freely => &[],
            };
            freedoms
                .iter()
                .map(move |freedom| (element, freedoms, freedom))
        });
        let is_leader = |f: &Freedom| self.robot.joints[f.joint].name == mimic.leader;
        let mut leaders = freedoms.filter(|(_, _, freedom)| is_leader(freedom));
        let Some((element, all, leader)) = leaders.next() else {
            return String::new();
        };
        let mut text = format!(", follows: {{ joint: {}", self.links.given[element.link]);
        if all.len() > 1 {
            text += &format!(", freedom: {}", self.freedom_name(leader));
        }
        if mimic.multiplier != 1.0 {
            text += &format!(", ratio: {}", number(mimic.multiplier));
        }
        if mimic.offset != 0.0 {
            text += &format!(", offset: {}", number(mimic.offset));
        }
        text + " }"
    }

    /// Damping, friction and limits of the joints that carry an element.
    fn forces(
        &self,
        system: usize,
        element: &Element,
        freedoms: &[Freedom],
        options: &Options,
        text: &mut String,
    ) -> std::fmt::Result {
        for freedom in freedoms {
            let joint: &Joint = &self.robot.joints[freedom.joint];
            let mut law = String::new();
            if joint.damping != 0.0 {
                write!(law, ", damping: {}", number(joint.damping))?;
            }
            // the friction and damping of a planar joint apply to each freedom
            if joint.friction != 0.0 {
                write!(law, ", friction: {}", number(joint.friction))?;
            }
            if let (Some(limits), Some(stiffness)) = (joint.limits, options.stops) {
                law += &stop(&limits, stiffness);
            }
            let input = self.input(freedom, options);
            if let Some(input) = &input {
                write!(law, ", motor: {input}")?;
            }
            let written = format!(
                "joint: {}/{}",
                self.system(system),
                self.links.given[element.link]
            );
            let which = match freedoms.len() {
                1 => String::new(),
                _ => format!(", freedom: {0}, name: {0}", self.freedom_name(freedom)),
            };
            if !law.is_empty() {
                self.origin(text, joint.place);
                writeln!(text, "  - {{ {written}{which}{law} }}")?;
            }
            if let Some(comment) = limits(joint, options.stops.is_some(), input.is_some()) {
                writeln!(text, "  # {} {comment}", self.joints.given[freedom.joint])?;
            }
        }
        Ok(())
    }

    /// Links that are at rest.
    fn frames(&self, text: &mut String) -> std::fmt::Result {
        let at_rest = self
            .forest
            .markers
            .iter()
            .filter(|marker| marker.on.is_none());
        for marker in at_rest {
            writeln!(
                text,
                "# A link without mass that stands still: {}, at {}",
                self.links.given[marker.link],
                vector(marker.at, 1.0)
            )?;
        }
        if !self.forest.still.is_empty() {
            let names: Vec<&str> = self
                .forest
                .still
                .iter()
                .map(|&l| self.links.given[l].as_str())
                .collect();
            writeln!(
                text,
                "# Links that stand still, whose mass has no influence: {}",
                names.join(", ")
            )?;
        }
        Ok(())
    }
}

/// The place of a frame from an origin, and the angles of its axes; nothing for what is 0.
fn frame(place: Vector, turn: &Matrix, origin: Vector) -> String {
    let size = length(place).max(length(origin));
    let (at, mut text) = (vector(subtract(place, origin), size), String::new());
    if at != list(&[0.0; 3]) {
        text += &format!(", at: {at}");
    }
    let angles = bryant_angles(turn).map(|angle| without_rounding(angle, 1.0));
    if angles != [0.0; 3] {
        text += &format!(", angles: {}", list(&angles));
    }
    text
}
