//! Describes a run: settings and parameters that differ from those of the model.

#[cfg(doc)]
use super::ErrorKind;
use super::Named;
use super::Reading;
use crate::simulate::{Integrator, Settings};
use crate::{Adjustable, Formula, Info, Real, Tolerances};
use std::fmt;
use std::time::Duration;

/// A run to do. Where a field is `None`, the model decides.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Job {
    /// The state at which the run begins, and its time. `None`: the model's initial state, at time 0.
    pub start: Option<Start>,
    /// Time at which the run ends \[s\]. If the run begins at 0, this is its length.
    pub duration: Option<f64>,
    /// Time between samples \[s\].
    pub every: Option<f64>,
    /// The responses to evaluate over the whole run.
    pub reading: Reading,
    /// The integrator, and how it chooses its steps; see [`Job::method`].
    pub method: Option<Integrator>,
    /// Whether steps end on the kinks of force laws.
    pub locate: Option<bool>,
    /// Limit on the number of steps.
    pub max_steps: Option<u64>,
    /// Share of energy and of momentum that may be missing before a run is doubted. `None`:
    /// [`ENERGY_LIMIT`](crate::ENERGY_LIMIT); +∞: no limit.
    pub energy_limit: Option<f64>,
    /// Parameters by name, in SI units.
    pub parameters: Vec<(String, f64)>,
    /// The arithmetic.
    pub scalar: Scalar,
    /// Whether to compute everything but deliver no samples and no balance of energy, to measure how long a run takes.
    pub silent: bool,
    /// Limit on the computing time. The results up to then are delivered, and the run ends with [`ErrorKind::Time`].
    pub time_limit: Option<Duration>,
}

/// A state at which a run begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Its time \[s\].
    pub t: f64,
    /// Its entries, q, v, z, m, in the order and units of [`Info::state_name`].
    pub state: Vec<f64>,
}

/// The arithmetic of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// Double precision.
    #[default]
    F64,
    /// Single precision.
    F32,
    /// Double precision with faster, less accurate sines and cosines ([`crate::Fast`]).
    Fast,
    /// About 32 digits ([`crate::DoubleDouble`]).
    DoubleDouble,
}

impl Scalar {
    /// All of them.
    pub const ALL: [Scalar; 4] = [Scalar::F64, Scalar::F32, Scalar::Fast, Scalar::DoubleDouble];

    /// Its name in commands and files.
    pub const fn name(self) -> &'static str {
        match self {
            Scalar::F64 => "f64",
            Scalar::F32 => "f32",
            Scalar::Fast => "fast",
            Scalar::DoubleDouble => "double-double",
        }
    }

    /// The arithmetic of this name.
    pub fn named(name: &str) -> Option<Scalar> {
        Self::ALL.into_iter().find(|scalar| scalar.name() == name)
    }
}

/// A job that is invalid or does not fit the model.
#[derive(Clone, Debug, PartialEq)]
pub enum JobError {
    /// No parameter has this name.
    UnknownParameter {
        /// The name.
        name: String,
        /// The names that exist.
        known: Vec<String>,
    },
    /// A parameter is given twice.
    RepeatedParameter {
        /// The name.
        name: String,
    },
    /// A value that is not a number, infinite, or outside the bounds that the model sets.
    ParameterValue {
        /// The name.
        name: String,
        /// The value (SI).
        value: f64,
        /// Smallest allowed, −∞ where unbounded.
        min: f64,
        /// Largest allowed, +∞ where unbounded.
        max: f64,
        /// SI unit, "" where there is none.
        unit: String,
    },
    /// The parameters violate a condition of the model.
    Condition {
        /// The condition: "`mass` of man/head must be positive".
        condition: String,
        /// The parameters that were set, with their values (SI).
        parameters: Vec<(String, f64)>,
    },
    /// An entry of the given initial state is not on the manifold of states: a quaternion is not of length 1.
    State {
        /// Its name.
        name: String,
        /// The given value.
        value: f64,
        /// The value after normalization.
        normalized: f64,
    },
    /// A slice has the wrong length.
    Size {
        /// What the slice holds.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The correct length.
        expected: usize,
    },
}

impl Job {
    /// The method of a run with this job: if it says none, Dormand & Prince's pair at the default tolerances, which
    /// changes to the Rosenbrock method where the scene is stiff.
    pub fn method(&self) -> Integrator {
        let default = Integrator::switching(Formula::Dopri5, Tolerances::default());
        self.method.unwrap_or(default)
    }

    /// The settings of a run of the model with this job. The run itself checks them.
    pub fn settings(&self, info: &Info) -> Settings {
        let of_model = Settings::of(info);
        Settings {
            start: self.start.as_ref().map_or(of_model.start, |start| start.t),
            duration: self.duration.unwrap_or(of_model.duration),
            every: self.every.unwrap_or(of_model.every),
            parts: self.reading.parts(),
            method: self.method(),
            locate: self.locate.unwrap_or(of_model.locate),
            max_steps: self.max_steps.unwrap_or(of_model.max_steps),
        }
    }
}

/// The index and value (SI) of each named parameter of a model.
fn parameters(info: &Info, named: &[Named]) -> Result<Vec<(usize, f64)>, JobError> {
    let mut parameters = Vec::new();
    for (i, (name, value)) in named.iter().enumerate() {
        if named[..i].iter().any(|(earlier, _)| earlier == name) {
            return Err(JobError::RepeatedParameter { name: name.clone() });
        }
        let mut known = info.parameters.iter().enumerate();
        let Some((index, parameter)) = known.find(|(_, parameter)| parameter.name == name) else {
            let known = info
                .parameters
                .iter()
                .map(|parameter| parameter.name.to_owned());
            return Err(JobError::UnknownParameter {
                name: name.clone(),
                known: known.collect(),
            });
        };
        let within = (parameter.min..=parameter.max).contains(value);
        if !(value.is_finite() && within) {
            return Err(JobError::ParameterValue {
                name: name.clone(),
                value: *value,
                min: parameter.min,
                max: parameter.max,
                unit: parameter.unit.to_owned(),
            });
        }
        parameters.push((index, *value));
    }
    Ok(parameters)
}

/// Sets the named parameters of a model that has its default values.
pub(super) fn adjust<T: Real>(
    model: &mut dyn Adjustable<T>,
    named: &[Named],
) -> Result<(), JobError> {
    if !named.is_empty() {
        let info = model.info();
        let mut values: Vec<T> = info
            .parameters
            .iter()
            .map(|parameter| T::from_f64(parameter.default))
            .collect();
        for (index, value) in parameters(info, named)? {
            values[index] = T::from_f64(value);
        }
        model.set_parameters(&values);
    }
    let violated = model.violated();
    match violated.and_then(|index| model.info().conditions.get(index)) {
        None => Ok(()),
        Some(condition) => Err(JobError::Condition {
            condition: (*condition).to_owned(),
            parameters: named.to_vec(),
        }),
    }
}

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            JobError::Condition {
                condition,
                parameters,
            } => {
                let values = parameters
                    .iter()
                    .map(|(name, value)| format!("{name} = {value}"));
                let values: Vec<String> = values.collect();
                let with = match values.is_empty() {
                    true => "the defaults of its parameters".to_owned(),
                    false => values.join(", "),
                };
                write!(f, "{condition}, which is not so with {with}")
            }
            JobError::UnknownParameter { name, known } if known.is_empty() => {
                write!(f, "there is no parameter \"{name}\": the model has none")
            }
            JobError::UnknownParameter { name, known } => {
                write!(
                    f,
                    "there is no parameter \"{name}\"; there is {}",
                    known.join(", ")
                )
            }
            JobError::RepeatedParameter { name } => {
                write!(f, "the parameter \"{name}\" is given twice")
            }
            JobError::ParameterValue {
                name,
                value,
                min,
                max,
                unit,
            } => {
                let space = if unit.is_empty() { "" } else { " " };
                write!(
                    f,
                    "the parameter \"{name}\" is {value}{space}{unit}, but must be "
                )?;
                match (min.is_finite(), max.is_finite()) {
                    (true, true) => write!(f, "between {min} and {max}")?,
                    (true, false) => write!(f, "finite and at least {min}")?,
                    (false, true) => write!(f, "finite and at most {max}")?,
                    (false, false) => return f.write_str("finite"),
                }
                write!(f, "{space}{unit}")
            }
            JobError::State {
                name,
                value,
                normalized,
            } => {
                write!(
                    f,
                    "the initial state is invalid: its {name} is {value}, but {normalized} when quaternions have length 1"
                )
            }
            JobError::Size {
                what,
                given,
                expected,
            } => {
                write!(f, "{given} numbers where the {what} has {expected}")
            }
        }
    }
}

impl std::error::Error for JobError {}
