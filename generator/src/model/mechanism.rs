//! The model as a whole.

use super::body::Body;
use super::curve::Curve;
use super::dimension::{Coordinates, Dimension};
use super::force::Force;
use super::output::Output;
use super::surface::Shown;
use super::switch::Switch;
use super::system::{System, Vehicle};
use super::units::{Unit, Units};
use serde::Serialize;

/// A whole scene: systems of elements, the forces between them, and outputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Model {
    /// Name of the model, kebab-case as in the YAML.
    pub name: String,
    /// One sentence for listings; empty if the YAML has none.
    pub title: String,
    /// Motion in the x–z plane or in space.
    pub dimension: Dimension,
    /// The coordinates that describe orientation.
    pub coordinates: Coordinates,
    /// Numbers that the YAML leaves adjustable.
    pub parameters: Vec<Parameter>,
    /// Piecewise functions of one variable.
    pub curves: Vec<Curve>,
    /// Bodies whose motion is prescribed.
    pub vehicles: Vec<Vehicle>,
    /// Systems of elements, each a tree.
    pub systems: Vec<System>,
    /// Forces that act on the systems.
    pub forces: Vec<Force>,
    /// Events that happen at most once, and that forces wait for.
    pub switches: Vec<Switch>,
    /// The outputs of the scene, in the order of the table's columns.
    pub outputs: Vec<Output>,
    /// Duration and sampling of a run.
    pub run: Run,
    /// Surfaces that take part in no contact, and meshes: for pictures only, at the default parameters.
    #[serde(skip)]
    pub shown: Vec<Shown>,
    /// The units in which outputs are shown.
    #[serde(skip)]
    pub units: Units,
    /// SHA-256, in lower-case hexadecimal, of all of the above that affects a motion or an output. It depends on the
    /// meaning of the text, not on the way in which it is written. See [`Model::sha256`](super::Model::sha256).
    #[serde(skip)]
    pub digest: String,
}

/// A number that may be changed without recompiling.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// A Rust identifier in snake case.
    pub name: String,
    /// Value unless the user sets another (SI).
    pub default: f64,
    /// Smallest value allowed (SI).
    pub min: Option<f64>,
    /// Largest value allowed (SI).
    pub max: Option<f64>,
    /// SI unit as text; "" if the number has none or it is unknown.
    pub unit: String,
    /// True for an input: it may change during a run.
    #[serde(skip_serializing_if = "is_false")]
    pub input: bool,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands out references"
)]
fn is_false(input: &bool) -> bool {
    !input
}

/// Duration and sampling of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Duration \[s\], positive.
    pub duration: f64,
    /// Time between samples \[s\], positive.
    pub every: f64,
}

impl Model {
    /// The name of a body, as `on` has it: "arm/hand", a vehicle, "frame".
    pub fn name_of(&self, body: Body) -> String {
        match body {
            Body::Frame => "frame".to_owned(),
            Body::Vehicle(index) => self.vehicles[index].name.clone(),
            Body::Element(id) => {
                let system = &self.systems[id.system];
                format!("{}/{}", system.name, system.elements[id.element].name)
            }
        }
    }

    /// The unit in which an output is shown.
    pub fn unit_of(&self, output: &Output) -> Unit {
        let own = self.units.own.iter().find(|(name, _)| *name == output.name);
        match own {
            Some((_, unit)) => unit.clone(),
            None => self.units.system.unit(&output.unit),
        }
    }
}
