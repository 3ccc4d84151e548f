//! Robots from URDF, the description format of ROS.
//!
//! [`import`] turns the text of a URDF file into the text of a model: links become elements, joints become joints, and
//! damping, friction and limits become joint forces. A URDF file has no forces, no initial state and no gravity. So
//! gravity of 9.81 m/s² along −z is added, and all joints start at 0.
//!
//! `xml.rs` makes XML of the text, `reader.rs`, `joint.rs` and `rotor.rs` read it into the links and joints of
//! `robot.rs`, and `inspect.rs` lists what they do not read, by the table in `vocabulary.rs`. `tree.rs` turns links and
//! joints into systems, `repair.rs` changes their inertia on demand, and `write.rs` writes the systems.

mod coupling;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod inertia;
mod inspect;
mod joint;
mod kind;
mod massless_bodies;
mod vocabulary;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod reader;
mod repair;
mod robot;
mod root;
mod rotor;
mod tree;
mod write;
mod xml;

pub use kind::{decoded, is_xml};

pub use robot::TextPlace;
pub use tree::Base;

use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use robot::{Joint, JointType, LeftOut, Limits, Robot, Why};
use std::collections::BTreeMap;
use tree::Forest;

/// Tells what reading finds wrong with the text of a model.
pub type CheckText = fn(&str) -> Result<(), Diagnostics>;

/// The options of an import.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// The motion of the root link.
    pub base: Base,
    /// Whether angles within 0.001 rad of a multiple of 90° are replaced by that multiple.
    pub right_angles: bool,
    /// Stiffness of stops at the limits of joints \[N·m/rad or N/m\]; `None`: there are no stops.
    pub stops: Option<f64>,
    /// Whether joints that follow others (`<mimic>`) move independently.
    pub uncouple: bool,
    /// Whether each joint gets a motor whose torque or force is an input, `JOINT_torque` or `JOINT_force`, within the
    /// limit of effort. Joints that follow others, planar and floating joints get none.
    pub inputs: bool,
    /// Masses and tensors that no mechanism can have are replaced if this function is given, which reads the text of a
    /// model ([`check_str`](crate::read::check_str)); each change is a note.
    pub repair_inertias: Option<CheckText>,
}

/// The model of a robot.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The text of the model.
    pub yaml: String,
    /// What was left out and what the user should know, one sentence each.
    pub notes: Vec<String>,
    /// Lines of the model, from 1, in their order, each with the place in the URDF file of the link or joint that it
    /// comes from.
    pub origins: Vec<(usize, TextPlace)>,
}

impl Imported {
    /// The place in the URDF file from which a line of the model comes.
    pub fn origin(&self, line: usize) -> Option<TextPlace> {
        let origins = self.origins.iter();
        let mut same = origins.filter(|(of, _)| *of == line);
        same.next().map(|(_, place)| *place)
    }
}

/// Makes a model from the text of a URDF file. `name` is the name of the file in messages.
///
/// # Errors
/// All problems of the text, with their places, and everything in it that a model cannot have.
pub fn import(name: &str, text: &str, options: &Options) -> Result<Imported, Diagnostics> {
    let mut robot = robot::read(name, text, options.right_angles)?;
    let mut changes = Vec::new();
    // each round repairs a link or a joint, which then needs no repair of this kind again
    for _ in 0..=3 * (robot.links.len() + robot.joints.len()) {
        let forest = match tree::forest(&robot, options.base, options.uncouple) {
            Ok(forest) => forest,
            Err(problems) => {
                let none = problems.iter().any(|p| p.repairs.is_empty());
                if none || options.repair_inertias.is_none() {
                    return Err(refused(name, text, problems));
                }
                for repair in problems.iter().flat_map(|p| &p.repairs) {
                    changes.extend(repair::apply(&mut robot, repair));
                }
                continue;
            }
        };
        let (yaml, origins) = write::yaml(name, &robot, &forest, options, &changes);
        let imported = Imported {
            yaml,
            notes: notes(&robot, &forest, options, &changes),
            origins,
        };
        let more = match options.repair_inertias.map(|check| check(&imported.yaml)) {
            Some(Err(found)) => without_inertia(&mut robot, &imported, &found),
            Some(Ok(())) | None => Vec::new(),
        };
        if more.is_empty() {
            return Ok(imported);
        }
        changes.extend(more);
    }
    Err(Diagnostic::of_file(
        name,
        "the inertia of this robot cannot be repaired",
        "mend it in the file: import it without `--repair-inertias` for a list of what is wrong",
    )
    .into())
}

/// Problems as messages, in the order of the text.
fn refused(name: &str, text: &str, problems: Vec<tree::Problem>) -> Diagnostics {
    let at = |p: tree::Problem| Diagnostic::at(name, text, p.place, p.message, p.help);
    let mut problems: Vec<Diagnostic> = problems.into_iter().map(at).collect();
    problems.sort_by_key(|p| (p.line, p.column));
    Diagnostics { problems }
}

/// Gives moments to the links that the model refuses because they turn without inertia.
fn without_inertia(robot: &mut Robot, imported: &Imported, found: &Diagnostics) -> Vec<String> {
    let places = found
        .problems
        .iter()
        .filter_map(|p| imported.origin(p.line));
    let links: Vec<usize> = places
        .filter_map(|place| robot.links.iter().position(|l| l.place == place))
        .collect();
    let changes = links.into_iter();
    changes
        .filter_map(|link| repair::give_moments(robot, link))
        .collect()
}

/// What the user should know, a sentence each.
fn notes(robot: &Robot, forest: &Forest, options: &Options, changes: &[String]) -> Vec<String> {
    let mut notes: Vec<String> = changes.iter().map(|c| format!("repaired: {c}")).collect();
    notes.extend(robot.rounded.iter().cloned());
    let name_of = |link: usize| quoted(&robot.links[link].name);
    for (main, others) in &forest.merged {
        let others: Vec<String> = others.iter().map(|&l| name_of(l)).collect();
        let main = name_of(*main);
        notes.push(format!(
            "{main} is one element with {}: not each is a body by itself",
            others.join(", ")
        ));
    }
    for &joint in &forest.idle {
        notes.push(format!(
            "the joint {} follows another and moves no mass: it is left out",
            quoted(&robot.joints[joint].name)
        ));
    }
    for joint in robot
        .joints
        .iter()
        .filter(|j| options.uncouple && j.mimic.is_some())
    {
        notes.push(format!(
            "the joint {} does not follow another: it moves by itself",
            quoted(&joint.name)
        ));
    }
    notes.extend(left_out(robot));
    notes.extend(of_limits(robot, options));
    if !robot.almost_right.is_empty() {
        notes.push(format!(
            "almost right angles, {}; `bryant import --right-angles` makes them exact, which saves operations",
            in_lines(&robot.almost_right)
        ));
    }
    if options.base == Base::Fixed && !forest.still.is_empty() {
        notes.push(
            "the root link stands still; `bryant import --base free` lets it move".to_owned(),
        );
    }
    notes
}

/// What is not taken over, by kind, with lines and names.
fn left_out(robot: &Robot) -> Vec<String> {
    let mut kinds: BTreeMap<(Why, &str), Vec<&LeftOut>> = BTreeMap::new();
    for item in &robot.left_out {
        kinds.entry((item.why, &item.what)).or_default().push(item);
    }
    let note = |((why, what), items): (&(Why, &str), &Vec<&LeftOut>)| {
        let lines: Vec<usize> = items.iter().map(|item| item.line).collect();
        let lines = in_lines(&lines);
        let count = items.len();
        match why {
            Why::Idle => format!("not taken over: {what} ({count}), {lines}"),
            Why::Unknown => {
                format!("not taken over, because URDF does not know it: {what} ({count}), {lines}")
            }
            Why::Missing => {
                let names: Vec<String> = items
                    .iter()
                    .filter_map(|i| Some(quoted(i.name.as_ref()?)))
                    .take(8)
                    .collect();
                let names = match names.is_empty() {
                    true => String::new(),
                    false => format!(": {}", names.join(", ")),
                };
                format!(
                    "not taken over, although the motion depends on it: {what} ({count}), {lines}{names}"
                )
            }
        }
    };
    kinds.iter().map(note).collect()
}

/// What becomes of the limits of joints.
fn of_limits(robot: &Robot, options: &Options) -> Vec<String> {
    let mut notes = Vec::new();
    let limited: Vec<(&Joint, Limits)> = robot
        .joints
        .iter()
        .filter_map(|joint| Some((joint, joint.limits?)))
        .filter(|(joint, _)| joint.kind != JointType::Fixed)
        .collect();
    let ends = limited
        .iter()
        .any(|(_, l)| l.range.iter().any(|end| end.is_finite()));
    if options.stops.is_none() && ends {
        notes.push(
            "the limits of joints do not act; `bryant import --stops STIFFNESS` makes stops of them".to_owned(),
        );
    }
    for (joint, limits) in limited
        .iter()
        .filter(|(_, l)| options.stops.is_some() && l.are_empty())
    {
        notes.push(format!(
            "the limits of the joint {}, line {}, are both {}, as exporters write where nobody entered any: it gets no stop; make it `fixed` if it is held there",
            quoted(&joint.name),
            joint.place.0,
            limits.range[0]
        ));
    }
    let any = |limit: fn(&Limits) -> f64| limited.iter().any(|(_, of)| limit(of) > 0.0);
    let left_out = match (
        !options.inputs && any(|of| of.effort),
        any(|of| of.velocity),
    ) {
        (true, true) => "effort and speed",
        (true, false) => "effort",
        (false, true) => "speed",
        (false, false) => return notes,
    };
    notes.push(format!(
        "the limits of {left_out} of joints do not act; they stand in the model as comments"
    ));
    notes
}

/// "line 3" or "lines 3, 5 and 7", with at most eight line numbers.
fn in_lines(lines: &[usize]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = lines.iter().take(SHOWN).map(usize::to_string).collect();
    match (lines.len(), &shown[..]) {
        (1, _) => format!("line {}", shown[0]),
        (n, _) if n > SHOWN => format!("lines {}, … {}", shown.join(", "), lines[n - 1]),
        (_, [first @ .., last]) => format!("lines {} and {last}", first.join(", ")),
        (_, []) => String::new(),
    }
}
