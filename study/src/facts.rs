//! The facts that a study must know about a model: its parameters, its outputs, and the run settings that the study
//! does not give.

use bryant_generator::diagnostic::{quoted, suggestion};
use bryant_generator::law::ForceKind;
use bryant_generator::law::types::Field;
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::units::{Unit, UnitSystem};
use bryant_generator::model::{Body, Dimension, FieldComponent, Model, PointQuantity, Quantity};
use bryant_runtime::response::STANDARD_GRAVITY;
use bryant_runtime::response::filter::Standard;
use serde::{Deserialize, Serialize};

/// Number of samples between two rows of the model's own table, by default.
const FINER: f64 = 20.0;

/// Parameters and outputs of a model, in the model's order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelFacts {
    /// The parameters that may be varied.
    pub parameters: Vec<ParameterFact>,
    /// The outputs that responses may be read off.
    pub outputs: Vec<OutputFact>,
    /// Declared parameters that have no effect, with the reason.
    #[serde(default)]
    pub unused: Vec<(String, String)>,
    /// The settings of its runs.
    #[serde(default)]
    pub run: RunFact,
    /// True if nothing moves along y.
    #[serde(default)]
    pub planar: bool,
    /// The criteria that its runs are judged by.
    #[serde(default)]
    pub criteria: Option<CriteriaFact>,
    /// The unit in which times are shown; `None` for seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<Unit>,
}

/// The SI unit of time.
const TIME: &str = "s";

/// The criteria that the runs of a model are judged by.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CriteriaFact {
    /// The regulation.
    pub standard: String,
    /// The dummy.
    pub dummy: String,
    /// True if filters follow SAE J211-1 instead of ISO 6487.
    #[serde(default)]
    pub sae: bool,
    /// Test object and position of the occupant, if the outputs have channel codes of several.
    #[serde(default)]
    pub occupant: Option<String>,
    /// Places of the dummy with the outputs at them.
    pub places: Vec<(String, String)>,
}

/// The settings of a model's runs that a study does not give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunFact {
    /// Length of a run \[s\].
    pub duration: f64,
    /// Time between samples \[s\].
    pub sampling: f64,
}

/// For results from versions that did not keep these settings.
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
    /// Its default value, SI.
    pub default: f64,
    /// Least value allowed, SI.
    pub min: Option<f64>,
    /// Largest value allowed, SI.
    pub max: Option<f64>,
}

/// An output.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OutputFact {
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
    /// The unit in which it is shown; `None` for the SI unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shown: Option<Unit>,
    /// Its channel code of ISO-MME.
    #[serde(default)]
    pub code: Option<String>,
    /// The filter with which it is shown, by its name.
    #[serde(default)]
    pub filter: Option<String>,
    /// For kinematics of a body: true for the length of a vector, false for one of its components.
    #[serde(default)]
    pub resultant: Option<bool>,
    /// True if it has the axes and signs of SAE J211-1 and ISO 6487.
    #[serde(default)]
    pub standard: bool,
    /// A remark on the place where it measures.
    #[serde(default)]
    pub remark: Option<String>,
    /// The reason why no instrument can measure it, for such an acceleration.
    #[serde(default)]
    pub unread: Option<String>,
}

impl CriteriaFact {
    /// The standard that defines the coefficients of the filters.
    pub fn standard_of_filters(&self) -> Standard {
        match self.sae {
            true => Standard::SaeJ211,
            false => Standard::Iso6487,
        }
    }
}

impl ModelFacts {
    /// The facts about a model.
    pub fn of(scene: &AnnotatedModel) -> ModelFacts {
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
            shown: Some(model.unit_of(output)).filter(|unit| unit.name != output.unit),
            code: output.code.clone(),
            filter: output.filter.map(str::to_owned),
            resultant: match &output.quantity {
                Quantity::Point { .. } | Quantity::Rotation { .. } => {
                    Some(output.quantity.is_resultant())
                }
                _ => None,
            },
            standard: output.channel.is_some(),
            remark: (output.channel.and_then(|channel| channel.remark)).map(str::to_owned),
            unread: unread(model, &output.quantity),
        });
        let criteria = scene.criteria.as_ref().map(|criteria| CriteriaFact {
            standard: criteria.standard.clone(),
            dummy: criteria.dummy.clone(),
            sae: criteria.sae,
            occupant: criteria.occupant.clone(),
            places: criteria.places.clone(),
        });
        ModelFacts {
            planar: model.dimension == Dimension::Plane,
            criteria,
            time: Some(model.units.system.unit(TIME)).filter(|unit| unit.name != TIME),
            parameters: parameters.collect(),
            outputs: outputs.collect(),
            unused: scene.unused_parameters(),
            run: RunFact {
                duration: model.run.duration,
                sampling: model.run.every / FINER,
            },
        }
    }

    /// The message for a parameter that cannot be varied, and the remedy.
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

    /// The unit in which times are shown.
    pub fn unit_of_time(&self) -> Unit {
        let shown = self.time.clone();
        shown.unwrap_or_else(|| UnitSystem::Si.unit(TIME))
    }

    /// The unit in which a response of an output is shown. One of another unit than the output, as an integral over
    /// time, is a time or is shown in SI.
    pub fn unit_for(&self, si: &str, output: &OutputFact) -> Unit {
        match si {
            si if si == output.unit => output.unit_shown(),
            TIME => self.unit_of_time(),
            si => UnitSystem::Si.unit(si),
        }
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

impl OutputFact {
    /// The unit in which it is shown.
    pub fn unit_shown(&self) -> Unit {
        let shown = self.shown.clone();
        shown.unwrap_or_else(|| UnitSystem::Si.unit(&self.unit))
    }
}

/// A field is gravity if it is constant, points down within this slope, and has no more than this many times standard
/// gravity.
const SLOPE: f64 = 0.6;
const LARGEST: f64 = 1.1;

/// The reason why no instrument can measure an acceleration: a field other than gravity acts on the element, or the
/// observer moves; `None` if there is no such reason.
fn unread(model: &Model, quantity: &Quantity) -> Option<String> {
    let Quantity::Point {
        body,
        what: PointQuantity::Acceleration,
        relative_to,
        ..
    } = quantity
    else {
        return None;
    };
    if *relative_to != Body::Frame {
        return Some("it is an `acceleration` relative to another body".to_owned());
    }
    let Body::Element(id) = body else { return None };
    let defaults: Vec<f64> = model.parameters.iter().map(|one| one.default).collect();
    let field = model
        .forces
        .iter()
        .find(|force| match ForceKind::of(force) {
            ForceKind::Field(field) => field.on.contains(id) && !is_gravity(field, &defaults),
            _ => false,
        })?;
    Some(format!(
        "it is an `acceleration`, and the field {} acts there, which no instrument feels",
        quoted(&field.name)
    ))
}

fn is_gravity(field: &Field, defaults: &[f64]) -> bool {
    let constant = field
        .acceleration
        .each_ref()
        .map(|component| match component {
            FieldComponent::Constant(number) => number.value(defaults),
            FieldComponent::Curve(_) => f64::NAN,
        });
    let [x, y, z] = constant;
    let across = libm::hypot(x, y);
    libm::hypot(across, z) <= LARGEST * STANDARD_GRAVITY && across <= SLOPE * -z
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

    /// True if all values of an interval are allowed.
    pub fn allows(&self, [low, high]: [f64; 2]) -> bool {
        self.min.is_none_or(|min| low >= min) && self.max.is_none_or(|max| high <= max)
    }
}
