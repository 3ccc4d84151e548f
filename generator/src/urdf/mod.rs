//! Robots from URDF, the description format of ROS.
//!
//! [`import`] turns the text of a URDF file into the text of a model: links become elements, joints become joints, and
//! damping, friction and limits become joint forces. A URDF file has no forces, no initial state and no gravity. So gravity of
//! 9.81 m/s² along −z is added, and all joints start at 0.
//!
//! `robot.rs` reads the file, `tree.rs` turns it into systems, and `write.rs` writes these.

mod robot;
mod tree;
mod write;

pub use robot::Place;
pub use tree::Base;

use crate::diagnostic::{Diagnostic, Diagnostics, quoted};

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
}

/// The model of a robot.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The text of the model.
    pub yaml: String,
    /// What was left out and what the user should know, one sentence each.
    pub notes: Vec<String>,
    /// Lines of the model, from 1, in their order, each with the place in the URDF file of the link or joint that it comes
    /// from.
    pub origins: Vec<(usize, Place)>,
}

impl Imported {
    /// The place in the URDF file from which a line of the model comes.
    pub fn origin(&self, line: usize) -> Option<Place> {
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
    let robot = robot::read(name, text, options.right_angles)?;
    let forest = tree::forest(&robot, options.base, options.uncouple).map_err(|problems| {
        let at = |(place, message, help)| Diagnostic::at(name, text, place, message, help);
        let mut problems: Vec<Diagnostic> = problems.into_iter().map(at).collect();
        problems.sort_by_key(|p| (p.line, p.column));
        Diagnostics { problems }
    })?;
    let mut notes = Vec::new();
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
    let uncoupled = robot
        .joints
        .iter()
        .filter(|j| options.uncouple && j.mimic.is_some());
    for joint in uncoupled {
        notes.push(format!(
            "the joint {} does not follow another: it moves by itself",
            quoted(&joint.name)
        ));
    }
    for (what, lines) in &robot.left_out {
        notes.push(format!(
            "not taken over: {what} ({}), {}",
            lines.len(),
            in_lines(lines)
        ));
    }
    if options.stops.is_none() && robot.joints.iter().any(|j| j.limits.is_some()) {
        notes.push(
            "the limits of joints do not act; `bryant import --stops STIFFNESS` makes stops of them".to_owned(),
        );
    }
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
    let (yaml, origins) = write::yaml(name, &robot, &forest, options);
    Ok(Imported {
        yaml,
        notes,
        origins,
    })
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
