//! What a study must know of a model: its parameters and its outputs.

use serde::{Deserialize, Serialize};

/// Parameters and outputs of a model, in its order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelFacts {
    /// What may be varied.
    pub parameters: Vec<ParameterFact>,
    /// What responses may be read off.
    pub outputs: Vec<OutputFact>,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterFact {
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
    /// Its value where nothing else is said, SI.
    pub default: f64,
    /// Least value allowed, SI.
    pub min: Option<f64>,
    /// Largest value allowed, SI.
    pub max: Option<f64>,
}

/// An output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputFact {
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
}

impl ModelFacts {
    /// A parameter by its name.
    pub fn parameter(&self, name: &str) -> Option<&ParameterFact> {
        self.parameters.iter().find(|p| p.name == name)
    }

    /// An output and its index by its name.
    pub fn output(&self, name: &str) -> Option<(usize, &OutputFact)> {
        self.outputs
            .iter()
            .enumerate()
            .find(|(_, o)| o.name == name)
    }
}

impl ParameterFact {
    /// The bounds in words: "from 0 to 0.1 m", "at least 0 m".
    pub fn bounds(&self) -> String {
        let unit = if self.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", self.unit)
        };
        match (self.min, self.max) {
            (Some(min), Some(max)) => format!("from {min} to {max}{unit}"),
            (Some(min), None) => format!("at least {min}{unit}"),
            (None, Some(max)) => format!("at most {max}{unit}"),
            (None, None) => "not bounded".into(),
        }
    }

    /// Whether all of an interval is allowed.
    pub fn allows(&self, [low, high]: [f64; 2]) -> bool {
        self.min.is_none_or(|min| low >= min) && self.max.is_none_or(|max| high <= max)
    }
}
