//! Chains of elements as models: makes their YAML and random states.

use crate::case_model::CaseModel;
use crate::random::Random;
use bryant_generator::model::{ElementId, Model};
use bryant_generator::motion::Layout;
use bryant_generator::motion::ball::Orientation;
use std::fmt::Write;

/// An element of a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// The position of its joint on the element before, in the frame of that element \[m\].
    pub at: [f64; 3],
    /// \[kg\]
    pub mass: f64,
    /// Centre of gravity, local frame \[m\].
    pub cg: [f64; 3],
    /// Principal moments about the centre of gravity \[kg m²\]; in the plane only the second counts.
    pub inertia: [f64; 3],
    /// Bryant angles of the principal axes \[rad\]; not used in the plane.
    pub axes: [f64; 3],
}

/// Dimension and coordinates of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChainKind {
    /// Motion in the x–z plane.
    Plane,
    /// In space, orientation by unit quaternions.
    Quaternion,
    /// In space, orientation by Bryant angles.
    Bryant,
}

impl ChainKind {
    /// All kinds.
    pub const ALL: [ChainKind; 3] = [ChainKind::Plane, ChainKind::Quaternion, ChainKind::Bryant];

    /// The name for people.
    pub fn name(self) -> &'static str {
        match self {
            ChainKind::Plane => "plane",
            ChainKind::Quaternion => "space, quaternions",
            ChainKind::Bryant => "space, Bryant angles",
        }
    }
}

/// The settings of a chain of links.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Dimension and coordinates.
    pub kind: ChainKind,
    /// True if the first joint is free; else it is fixed.
    pub free: bool,
    /// True if a force and a moment act on the last element. An element without loads is eliminated in a cheaper way.
    pub loaded: bool,
}

/// A general element with this mass: a solid ellipsoid with semi-axes of 3 to 20 cm, rotated in its frame, with its
/// centre of gravity and its joint at random positions.
pub fn general(random: &mut Random, mass: f64) -> Link {
    let squares = [0, 1, 2].map(|_| random.uniform(0.03, 0.2f64).powi(2));
    let sum: f64 = squares.iter().sum();
    Link {
        at: random.vector(0.4),
        mass,
        cg: random.vector(0.2),
        inertia: squares.map(|square| mass / 5.0 * (sum - square)),
        axes: random.vector(3.0),
    }
}

/// The model of a chain under gravity.
pub fn scene(setting: Setting, links: &[Link]) -> CaseModel {
    let mut text = tree(setting, links);
    let vector = |v| vector(setting.kind, v);
    let gravity = vector([0.0, 0.0, -9.81]);
    let _ = write!(
        text,
        "forces:\n  - {{ field: gravity, acceleration: {gravity} }}\n"
    );
    if setting.loaded {
        let last = links.len() - 1;
        let moment = match setting.kind {
            ChainKind::Plane => "0.7".to_owned(),
            _ => vector([0.3, 0.7, -0.4]),
        };
        let (at, force) = (vector([0.1, -0.05, 0.2]), vector([3.0, -2.0, 5.0]));
        let _ = writeln!(
            text,
            "  - {{ load: pull, on: chain/e{last}, at: {at}, force: {force}, moment: {moment} }}"
        );
    }
    CaseModel::new(format!("chain of {}", links.len()), text)
}

/// The model of a free chain without any force, with these angular velocities at the start.
pub fn afloat(links: &[Link], rates: &[[f64; 3]]) -> CaseModel {
    let setting = Setting {
        kind: ChainKind::Quaternion,
        free: true,
        loaded: false,
    };
    let mut text = tree(setting, links);
    text.push_str("    start:\n      rates:\n");
    for (k, rate) in rates.iter().enumerate() {
        let _ = writeln!(text, "        e{k}: {}", vector(setting.kind, *rate));
    }
    CaseModel::new(format!("chain of {} afloat", links.len()), text)
}

/// A vector with two or three components, depending on the dimension; "{:?}" of a number reads back exactly.
fn vector(kind: ChainKind, [x, y, z]: [f64; 3]) -> String {
    match kind {
        ChainKind::Plane => format!("[{x:?}, {z:?}]"),
        _ => format!("[{x:?}, {y:?}, {z:?}]"),
    }
}

/// The text of the model up to the elements of its only system.
fn tree(setting: Setting, links: &[Link]) -> String {
    let vector = |v| vector(setting.kind, v);
    let planar = setting.kind == ChainKind::Plane;
    let (dimension, coordinates) = match setting.kind {
        ChainKind::Plane => (2, ""),
        ChainKind::Quaternion => (3, "coordinates: quaternion\n"),
        ChainKind::Bryant => (3, "coordinates: bryant\n"),
    };
    let reference = if setting.free { "free" } else { "fixed" };
    let mut text = format!(
        "model: chain\ndimension: {dimension}\n{coordinates}systems:\n  - name: chain\n    reference: {reference}\n    elements:\n"
    );
    for (k, link) in links.iter().enumerate() {
        let mut line = format!("      - {{ name: e{k}");
        if k > 0 {
            let _ = write!(line, ", on: e{}, at: {}", k - 1, vector(link.at));
        }
        let _ = write!(line, ", mass: {:?}, cg: {}", link.mass, vector(link.cg));
        match planar {
            true => {
                let _ = write!(line, ", inertia: {:?}", link.inertia[1]);
            }
            false => {
                let _ = write!(line, ", inertia: {}", vector(link.inertia));
                if link.axes != [0.0; 3] {
                    let _ = write!(line, ", axes: {}", vector(link.axes));
                }
            }
        }
        line.push_str(" }\n");
        text.push_str(&line);
    }
    text
}

/// A random state: positions within a metre, any orientation, rates of a few per second. Bryant angles are kept away
/// from their singularity, because it does not depend on masses.
pub fn random_state(random: &mut Random, model: &Model) -> (Vec<f64>, Vec<f64>) {
    let layout = Layout::of(model);
    let mut q: Vec<f64> = (layout.coordinates.iter())
        .map(|_| random.uniform(-1.0, 1.0))
        .collect();
    for (s, system) in model.systems.iter().enumerate() {
        for element in 0..system.elements.len() {
            let range = layout.element_coordinates(ElementId { system: s, element });
            match layout.orientation {
                Orientation::Angle => q[range.start] = random.uniform(-3.0, 3.0),
                Orientation::Bryant => {
                    q[range.start] = random.uniform(-3.0, 3.0);
                    q[range.start + 1] = random.uniform(-1.2, 1.2);
                    q[range.start + 2] = random.uniform(-3.0, 3.0);
                }
                Orientation::Quaternion => {
                    let norm = q[range.clone()].iter().map(|a| a * a).sum::<f64>().sqrt();
                    q[range].iter_mut().for_each(|a| *a /= norm);
                }
            }
        }
    }
    let v = (layout.velocities.iter())
        .map(|_| random.uniform(-4.0, 4.0))
        .collect();
    (q, v)
}
