//! What a study must know of a model: its parameters, its outputs, and how it runs where the study does not say.

use bryant_generator::diagnostic::{quoted, suggestion};
use bryant_generator::model::scene::Scene;
use bryant_generator::model::{Dimension, Quantity};
use bryant_runtime::response::filter::Standard;
use serde::{Deserialize, Serialize};

/// Samples between two rows of the model's own table, where nothing is said.
const FINER: f64 = 20.0;

/// Parameters and outputs of a model, in its order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelFacts {
    /// What may be varied.
    pub parameters: Vec<ParameterFact>,
    /// What responses may be read off.
    pub outputs: Vec<OutputFact>,
    /// Parameters that are declared, but on which nothing depends, and why.
    #[serde(default)]
    pub unused: Vec<(String, String)>,
    /// How it runs.
    #[serde(default)]
    pub run: RunFact,
    /// Whether nothing moves along y.
    #[serde(default)]
    pub planar: bool,
    /// By what its runs are judged.
    #[serde(default)]
    pub criteria: Option<CriteriaFact>,
}

/// By what the runs of a model are judged.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CriteriaFact {
    /// The regulation.
    pub standard: String,
    /// The dummy.
    pub dummy: String,
    /// Whether filters are those of SAE J211-1, and not of ISO 6487.
    #[serde(default)]
    pub sae: bool,
    /// Places of the dummy with the outputs that are there.
    pub places: Vec<(String, String)>,
}

/// How a model runs where a study does not say.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunFact {
    /// Length of a run \[s\].
    pub duration: f64,
    /// Time between samples \[s\].
    pub sampling: f64,
}

/// As if nothing were known: of results from before this was kept.
impl Default for RunFact {
    fn default() -> Self {
        RunFact {
            duration: f64::MAX,
            sampling: f64::MIN_POSITIVE,
        }
    }
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
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputFact {
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
    /// Channel code of ISO-MME.
    #[serde(default)]
    pub code: Option<String>,
    /// The filter that it is shown with, by its name.
    #[serde(default)]
    pub filter: Option<String>,
    /// Of the kinematics of a body: whether it is the length of a vector, or one of its components.
    #[serde(default)]
    pub resultant: Option<bool>,
}

impl CriteriaFact {
    /// Whose coefficients filters have.
    pub fn standard_of_filters(&self) -> Standard {
        match self.sae {
            true => Standard::SaeJ211,
            false => Standard::Iso6487,
        }
    }
}

impl ModelFacts {
    /// Of a model.
    pub fn of(scene: &Scene) -> ModelFacts {
        let model = &scene.model;
        let parameters = model.parameters.iter().map(|parameter| ParameterFact {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            default: parameter.default,
            min: parameter.min,
            max: parameter.max,
        });
        let outputs = model.outputs.iter().map(|output| OutputFact {
            name: output.name.clone(),
            unit: output.unit.clone(),
            code: output.code.clone(),
            filter: output.filter.map(str::to_owned),
            resultant: match &output.quantity {
                Quantity::Point { .. } | Quantity::Rotation { .. } => {
                    Some(output.quantity.is_resultant())
                }
                _ => None,
            },
        });
        let criteria = scene.criteria.as_ref().map(|criteria| CriteriaFact {
            standard: criteria.standard.clone(),
            dummy: criteria.dummy.clone(),
            sae: criteria.sae,
            places: criteria.places.clone(),
        });
        ModelFacts {
            planar: model.dimension == Dimension::Plane,
            criteria,
            parameters: parameters.collect(),
            outputs: outputs.collect(),
            unused: scene.unused_parameters(),
            run: RunFact {
                duration: model.run.duration,
                sampling: model.run.every / FINER,
            },
        }
    }

    /// Why there is no parameter of this name to vary, and what to do.
    pub fn no_parameter(&self, name: &str) -> (String, String) {
        if let Some((_, why)) = self.unused.iter().find(|(unused, _)| unused == name) {
            let message = format!("the parameter {} changes nothing: {why}", quoted(name));
            return (
                message,
                "leave it out; `bryant effects` lists what is out, and why".into(),
            );
        }
        let names = self.parameters.iter().map(|p| p.name.as_str());
        (
            format!("the model has no parameter {}", quoted(name)),
            suggestion(name, names, "it has no parameters at all"),
        )
    }

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
