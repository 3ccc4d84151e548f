//! A force of the user's own: which function, what it looks at, what it acts on.

use crate::model::{Attachment, Dimension, ElementId, FieldComponent, Number, ScaledCurve};

/// A force computed by a Rust function of the user's.
#[derive(Clone, Debug, PartialEq)]
pub struct User {
    /// What is called.
    pub function: UserFunction,
    /// Whether its vectors are those of the plane or of space, whatever the motion is.
    pub dimension: Dimension,
    /// The longest step \[s\], positive; `None` is the time between samples.
    pub scale: Option<f64>,
    /// Points: position and velocity in, force out.
    pub points: Vec<Port<Attachment>>,
    /// Elements: orientation and angular velocity in, moment out.
    pub bodies: Vec<Port<ElementId>>,
    /// Lines: length and its rate in, tension out.
    pub lines: Vec<Port<UserLine>>,
    /// Joints, by the element that they carry: relative angles and rates in, torques out.
    pub joints: Vec<Port<ElementId>>,
    /// Freedoms of joints: coordinate and rate in, torque or force along it out.
    pub freedoms: Vec<Port<UserFreedom>>,
    /// State variables: value in, rate out.
    pub states: Vec<Port<UserState>>,
}

/// A function, and what it is given whatever the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct UserFunction {
    /// Its name in its source; its path (`crate::aero::drag`) where there is none; empty where it is left out.
    pub name: String,
    /// The text with the function; `None` where the crate that includes the module has it.
    pub source: Option<UserSource>,
    /// Numbers and curves of time.
    pub parameters: Vec<Port<UserParameter>>,
    /// Curves to look up; `None` where the curve is zero everywhere.
    pub curves: Vec<Port<Option<ScaledCurve>>>,
}

/// Rust text of the user's.
#[derive(Clone, Debug, PartialEq)]
pub struct UserSource {
    /// Path of the file, relative to that of the model.
    pub name: String,
    /// Its text, lines ended by `\n`.
    pub text: String,
}

/// Something under a name that the user gave it; the name, dashes as underscores, is an identifier.
#[derive(Clone, Debug, PartialEq)]
pub struct Port<T> {
    /// As in the YAML.
    pub name: String,
    /// What it is.
    pub value: T,
}

/// A straight line between two points.
#[derive(Clone, Debug, PartialEq)]
pub struct UserLine {
    /// One end.
    pub from: Attachment,
    /// The other end.
    pub to: Attachment,
}

/// A freedom of a joint with coordinates of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct UserFreedom {
    /// The element that the joint carries.
    pub element: ElementId,
    /// Index into its freedoms.
    pub freedom: usize,
    /// Whether it turns; else it slides.
    pub turns: bool,
}

/// A number or a curve of time, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct UserParameter {
    /// The value.
    pub value: FieldComponent,
    /// SI unit, "" where the number has none or it is unknown.
    pub unit: String,
}

/// A state variable.
#[derive(Clone, Debug, PartialEq)]
pub struct UserState {
    /// Value at the start of a run.
    pub initial: Number,
    /// SI unit, "" where the number has none.
    pub unit: &'static str,
    /// SI unit of its rate.
    pub rate_unit: &'static str,
}

impl User {
    /// Names of what the function returns, in its order: per point a force, per body a moment, per line a tension, per
    /// joint torques, per freedom an effort, per state a rate; vectors by component, of which those that the plane has not are left out.
    pub fn results(&self) -> Vec<String> {
        let vector: &[&str] = match self.dimension {
            Dimension::Plane => &["_x", "_z"],
            Dimension::Space => &["_x", "_y", "_z"],
        };
        let rotation: &[&str] = match self.dimension {
            Dimension::Plane => &[""],
            Dimension::Space => &["_x", "_y", "_z"],
        };
        let mut results = Vec::new();
        let mut add = |name: &str, what: &str, components: &[&str]| {
            let name = name.replace('-', "_");
            results.extend(components.iter().map(|c| format!("{name}_{what}{c}")));
        };
        for point in &self.points {
            add(&point.name, "force", vector);
        }
        for body in &self.bodies {
            add(&body.name, "moment", rotation);
        }
        for line in &self.lines {
            add(&line.name, "tension", &[""]);
        }
        for joint in &self.joints {
            add(&joint.name, "torque", rotation);
        }
        for freedom in &self.freedoms {
            add(&freedom.name, "effort", &[""]);
        }
        for state in &self.states {
            add(&state.name, "rate", &[""]);
        }
        results
    }

    /// Number of things that it acts on.
    pub fn ports(&self) -> usize {
        self.points.len()
            + self.bodies.len()
            + self.lines.len()
            + self.joints.len()
            + self.freedoms.len()
    }
}
