//! Links and joints of a URDF file, each with its place in the text.
//!
//! The text must satisfy the parser of ROS (urdfdom), shapes and materials included: a file that it refuses is refused
//! here. In addition a moving joint needs an axis that is not zero.

use super::reader::Reader;
use super::xml::Xml;
use crate::description::tree::MAX_BYTES;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Triangles;
use crate::rotation::{Matrix, Vector};
use roxmltree::Document;

/// A place in the text: line and column from 1, length.
pub type TextPlace = (usize, usize, usize);

/// A robot, as written in the file.
pub struct Robot {
    pub name: String,
    pub place: TextPlace,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    /// What is not taken over, in the order of the text.
    pub left_out: Vec<LeftOut>,
    /// Lines with angles of orientations that are almost, but not exactly, multiples of 90°.
    pub almost_right: Vec<usize>,
    /// What was changed within the digits of the file.
    pub rounded: Vec<String>,
}

/// A part of the file that is not taken over.
pub struct LeftOut {
    pub why: Why,
    pub what: String,
    pub line: usize,
    pub name: Option<String>,
}

/// Why a part is not taken over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Why {
    /// No model has it, but the motion depends on it.
    Missing,
    /// URDF does not know it.
    Unknown,
    /// It has no influence on the motion.
    Idle,
}

pub struct Link {
    pub name: String,
    pub place: TextPlace,
    pub inertial: Option<Inertial>,
    /// By which it is shown.
    pub meshes: Vec<Mesh>,
}

/// Triangles, in a frame of a link.
pub struct Mesh {
    pub of: Triangles,
    pub frame: Frame,
    /// Factors on the numbers of a file, or the lengths of a shape.
    pub scale: Vector,
}

impl Mesh {
    /// True if it has a size along each axis. A file may be mirrored by a negative factor.
    pub fn is_seen(&self) -> bool {
        let seen = |factor: &f64| match self.of {
            Triangles::Solid(_) => *factor > 0.0,
            Triangles::File(_) => *factor != 0.0,
        };
        self.scale
            .iter()
            .all(|factor| factor.is_finite() && seen(factor))
    }
}

/// Mass, and inertia tensor about the centre of mass in the axes of `frame`.
pub struct Inertial {
    pub place: TextPlace,
    pub frame: Frame,
    pub mass: f64,
    pub tensor: Matrix,
    pub tensor_place: TextPlace,
}

/// An `<origin>`: displacement and rotation, both zero if nothing is written.
#[derive(Clone, Copy)]
pub struct Frame {
    pub at: Vector,
    pub turn: Matrix,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointType {
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
    Planar,
    Floating,
}

pub struct Joint {
    pub name: String,
    pub place: TextPlace,
    pub kind: JointType,
    pub parent: usize,
    pub child: usize,
    pub origin: Frame,
    /// The axis, a unit vector in the frame of the child link.
    pub axis: Vector,
    pub limits: Option<Limits>,
    pub damping: f64,
    pub friction: f64,
    /// Inertia of its rotors, times the squares of their gear ratios \[kg·m² or kg\].
    pub armature: f64,
    /// The joint that it follows, if any.
    pub mimic: Option<Mimic>,
}

/// What a joint may reach.
#[derive(Clone, Copy)]
pub struct Limits {
    /// Smallest and largest coordinate \[rad or m\], which may be infinite.
    pub range: [f64; 2],
    /// Largest torque or force of its motor \[N·m or N\].
    pub effort: f64,
    /// Largest speed \[rad/s or m/s\].
    pub velocity: f64,
}

impl Limits {
    /// Whether there is no room between both ends: exporters write two zeros where nobody entered limits.
    pub fn are_empty(&self) -> bool {
        self.range[0] == self.range[1]
    }
}

/// q = multiplier · q of the leader + offset.
#[derive(Clone)]
pub struct Mimic {
    /// Name of the leader.
    pub leader: String,
    /// The place of that name.
    pub place: TextPlace,
    pub multiplier: f64,
    /// Offset \[rad or m\].
    pub offset: f64,
}

/// Reads a URDF file.
///
/// # Errors
/// What the file is instead, or all its problems, with their places.
pub fn read(file: &str, text: &str, right_angles: bool) -> Result<Robot, Diagnostics> {
    if text.len() > MAX_BYTES {
        return Err(Diagnostic::of_file(
            file,
            format!("the file is larger than {} MiB", MAX_BYTES >> 20),
            "a URDF file of a robot is smaller; its shapes are files of their own",
        )
        .into());
    }
    let xml = Xml::of(file, text)?;
    let document = Document::parse(&xml.text).map_err(|error| {
        Diagnostics::from(Diagnostic::of_file(
            file,
            error.to_string(),
            "mend the text",
        ))
    })?;
    Reader::new(file, text, &xml, right_angles).read(document.root_element())
}
