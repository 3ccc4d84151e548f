//! Names, units and sizes of a model as owned values.

use crate::Info;

/// Everything known of a model without evaluating it: [`Info`] as owned values, without the curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Name of the model.
    pub name: String,
    /// SHA-256 of the YAML, hexadecimal.
    pub digest: String,
    /// 2 or 3.
    pub dimension: u32,
    /// Names of q.
    pub coordinates: Vec<String>,
    /// Names of v.
    pub velocities: Vec<String>,
    /// Names of the continuous states of force laws.
    pub auxiliaries: Vec<String>,
    /// Names of the discrete states of force laws.
    pub memory: Vec<String>,
    /// Names of the event functions.
    pub event_functions: Vec<String>,
    /// Names of the non-smooth switching functions of force laws.
    pub kinks: Vec<String>,
    /// Names of the effects that do work.
    pub powers: Vec<String>,
    /// Column headings and units.
    pub outputs: Vec<OutputHeader>,
    /// Names, units, bounds.
    pub parameters: Vec<ParameterHeader>,
    /// Length of a run \[s\] where the job gives none.
    pub duration: f64,
    /// Time between samples \[s\] where the job gives none.
    pub every: f64,
}

/// A column of the output table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputHeader {
    /// Heading.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
}

/// An adjustable number.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterHeader {
    /// Name.
    pub name: String,
    /// SI unit, "" where unknown.
    pub unit: String,
    /// Default (SI).
    pub default: f64,
    /// Smallest value allowed (SI), −∞ where unbounded.
    pub min: f64,
    /// Largest value allowed (SI), +∞ where unbounded.
    pub max: f64,
}

impl Header {
    /// The header of a model.
    pub fn of(info: &Info) -> Header {
        let names = |names: &[&str]| names.iter().map(|name| name.to_string()).collect();
        let outputs = info.outputs.iter().map(|output| OutputHeader {
            name: output.name.into(),
            unit: output.unit.into(),
        });
        let parameters = info.parameters.iter().map(|parameter| ParameterHeader {
            name: parameter.name.into(),
            unit: parameter.unit.into(),
            default: parameter.default,
            min: parameter.min,
            max: parameter.max,
        });
        Header {
            name: info.name.into(),
            digest: info.digest.into(),
            dimension: info.dimension.into(),
            coordinates: names(info.coordinates),
            velocities: names(info.velocities),
            auxiliaries: names(info.auxiliaries),
            memory: names(info.memory),
            event_functions: names(info.event_functions),
            kinks: names(info.kinks),
            powers: names(info.powers),
            outputs: outputs.collect(),
            parameters: parameters.collect(),
            duration: info.duration,
            every: info.every,
        }
    }
}
