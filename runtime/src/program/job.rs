//! What to run: settings and parameters that differ from the model's own, and how they are written as words.

use crate::simulate::{Adaptive, Method, Pace, Settings};
use crate::{Formula, Info, Model, ParameterSet, Real};
use std::fmt;

/// What to run. Whatever is `None` is as the model says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Job {
    /// Length of the run \[s\].
    pub duration: Option<f64>,
    /// Time between samples \[s\].
    pub every: Option<f64>,
    /// Which integrator, and how long its steps.
    pub method: Option<Method>,
    /// Whether steps end on the kinks of force laws.
    pub locate: Option<bool>,
    /// Limit on the number of steps.
    pub max_steps: Option<u64>,
    /// Share of energy and of momentum that may be missing before a run is doubted, [`ENERGY_LIMIT`](crate::ENERGY_LIMIT) where
    /// nothing is said; +∞: any.
    pub energy_limit: Option<f64>,
    /// Parameters by name, SI.
    pub parameters: Vec<(String, f64)>,
    /// The arithmetic.
    pub scalar: Scalar,
    /// Compute everything, deliver no samples and no balance of energy: to see how long a run takes.
    pub silent: bool,
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
    /// Some 32 digits ([`crate::DoubleDouble`]).
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

/// A job that does not fit.
#[derive(Clone, Debug, PartialEq)]
pub enum JobError {
    /// No parameter has this name.
    UnknownParameter {
        /// The name.
        name: String,
        /// The names there are.
        known: Vec<&'static str>,
    },
    /// The same parameter twice.
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
        unit: &'static str,
    },
    /// Parameters that make something of the model that cannot be.
    Condition {
        /// What does not hold: "the mass of man/head is positive".
        condition: &'static str,
        /// The parameters that were set, with their values (SI).
        parameters: Vec<(String, f64)>,
    },
    /// An argument that is none of [`Job::WORDS`].
    Word {
        /// The argument.
        word: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The program around the model has not been compiled for this arithmetic.
    Scalar {
        /// Which.
        scalar: Scalar,
    },
    /// A slice of the wrong length.
    Size {
        /// Of what.
        what: &'static str,
        /// Its length.
        given: usize,
        /// What it should be.
        expected: usize,
    },
}

impl Job {
    /// The arguments that [`Job::from_words`] understands.
    pub const WORDS: &str = "duration= every= method=NAME step= relative= positions= angles= velocities= \
                             angular-velocities= laws= first-step= largest-step= smallest-step= kinks=located|passed \
                             max-steps= energy-limit= parameter.NAME= scalar=f64|f32|fast|double-double silent=";

    /// The settings of a run of the model with this job. What is wrong with them, the run will say.
    pub fn settings(&self, info: &Info) -> Settings {
        let of_model = Settings::of(info);
        Settings {
            duration: self.duration.unwrap_or(of_model.duration),
            every: self.every.unwrap_or(of_model.every),
            method: self.method.unwrap_or(of_model.method),
            locate: self.locate.unwrap_or(of_model.locate),
            max_steps: self.max_steps.unwrap_or(of_model.max_steps),
        }
    }

    /// The job as arguments, from which [`Job::from_words`] makes the same job.
    pub fn to_words(&self) -> Vec<String> {
        let mut words = Vec::new();
        // {:?} writes the shortest text that reads back as the same number
        let mut number = |key: &str, value: f64| words.push(format!("{key}={value:?}"));
        if let Some(duration) = self.duration {
            number("duration", duration);
        }
        if let Some(every) = self.every {
            number("every", every);
        }
        if let Some(limit) = self.energy_limit {
            number("energy-limit", limit);
        }
        match self.method.map(|method| method.pace) {
            None => {}
            Some(Pace::Fixed(step)) => number("step", step),
            Some(Pace::Adaptive(adaptive)) => {
                let tolerances = &adaptive.tolerances;
                number("relative", tolerances.relative);
                number("positions", tolerances.positions);
                number("angles", tolerances.angles);
                number("velocities", tolerances.velocities);
                number("angular-velocities", tolerances.angular_velocities);
                number("laws", tolerances.laws);
                number("largest-step", adaptive.largest_step);
                number("smallest-step", adaptive.smallest_step);
                if let Some(step) = adaptive.first_step {
                    number("first-step", step);
                }
            }
        }
        for (name, value) in &self.parameters {
            number(&format!("parameter.{name}"), *value);
        }
        if let Some(method) = self.method {
            words.push(format!("method={}", method.formula));
        }
        if let Some(locate) = self.locate {
            let kinks = if locate { "located" } else { "passed" };
            words.push(format!("kinks={kinks}"));
        }
        if self.scalar != Scalar::F64 {
            words.push(format!("scalar={}", self.scalar.name()));
        }
        if self.silent {
            words.push("silent=yes".into());
        }
        if let Some(limit) = self.max_steps {
            words.push(format!("max-steps={limit}"));
        }
        words
    }

    /// The job written as arguments `key=value`, in any order.
    ///
    /// # Errors
    /// [`JobError::Word`]: an unknown key, a value that is no number, a step and tolerances together.
    pub fn from_words<W: AsRef<str>>(words: &[W]) -> Result<Job, JobError> {
        let mut job = Job::default();
        let mut adaptive = Adaptive::default();
        let (mut formula, mut step, mut of_adaptive) = (None, None, None);
        for word in words {
            let word = word.as_ref();
            let wrong = |problem| JobError::Word {
                word: word.to_owned(),
                problem,
            };
            let (key, text) = word
                .split_once('=')
                .ok_or_else(|| wrong("it is not key=value"))?;
            match key {
                "method" => {
                    let known = Formula::named(text);
                    formula = Some(known.ok_or_else(|| wrong(METHODS))?);
                    continue;
                }
                "kinks" => {
                    job.locate = Some(match text {
                        "located" => true,
                        "passed" => false,
                        _ => return Err(wrong("kinks are located or passed")),
                    });
                    continue;
                }
                "scalar" => {
                    let known = Scalar::named(text);
                    let problem = "the scalars are f64, f32, fast, double-double";
                    job.scalar = known.ok_or_else(|| wrong(problem))?;
                    continue;
                }
                "silent" => {
                    job.silent = match text {
                        "yes" => true,
                        "no" => false,
                        _ => return Err(wrong("it is yes or no")),
                    };
                    continue;
                }
                "max-steps" => {
                    let limit = text.parse();
                    job.max_steps = Some(limit.map_err(|_| wrong("it is not a whole number"))?);
                    continue;
                }
                _ => {}
            }
            let value: f64 = text.parse().map_err(|_| wrong("it is not a number"))?;
            if let Some(name) = key.strip_prefix("parameter.") {
                job.parameters.push((name.to_owned(), value));
                continue;
            }
            match key {
                "duration" => job.duration = Some(value),
                "every" => job.every = Some(value),
                "energy-limit" => job.energy_limit = Some(value),
                "step" => step = Some((word, value)),
                "relative" => adaptive.tolerances.relative = value,
                "positions" => adaptive.tolerances.positions = value,
                "angles" => adaptive.tolerances.angles = value,
                "velocities" => adaptive.tolerances.velocities = value,
                "angular-velocities" => adaptive.tolerances.angular_velocities = value,
                "laws" => adaptive.tolerances.laws = value,
                "largest-step" => adaptive.largest_step = value,
                "smallest-step" => adaptive.smallest_step = value,
                "first-step" => adaptive.first_step = Some(value),
                _ => return Err(wrong("there is no such key")),
            }
            if !matches!(key, "duration" | "every" | "step" | "energy-limit") {
                of_adaptive = Some(word);
            }
        }
        let wrong = |word: &str, problem| {
            Err(JobError::Word {
                word: word.to_owned(),
                problem,
            })
        };
        job.method = match (formula, step, of_adaptive) {
            (_, Some((word, _)), Some(_)) => {
                return wrong(word, "steps are fixed or have tolerances, not both");
            }
            (Some(formula), Some((_, step)), None) => Some(Method::fixed(formula, step)),
            (None, Some((word, _)), None) => return wrong(word, "it needs method="),
            (Some(formula), None, None) if !formula.estimates_error() => {
                let word = format!("method={formula}");
                return wrong(&word, "it needs step=, for it does not estimate its error");
            }
            (None, None, None) => None,
            (formula, None, _) => Some(Method {
                formula: formula.unwrap_or(Method::default().formula),
                pace: Pace::Adaptive(adaptive),
            }),
        };
        Ok(job)
    }
}

/// What there is where a method is not known.
const METHODS: &str =
    "the methods are semi-implicit-euler, heun, rk4, merson, dopri5, tsit5, dop853, rodas5";

/// The parameters of a model: its defaults, and those named.
fn parameters<T: Real, M: Model<T>>(named: &[(String, f64)]) -> Result<M::Parameters, JobError> {
    let known = M::INFO.parameters;
    let mut parameters = M::Parameters::defaults();
    for (i, (name, value)) in named.iter().enumerate() {
        if named[..i].iter().any(|(earlier, _)| earlier == name) {
            return Err(JobError::RepeatedParameter { name: name.clone() });
        }
        let index = known.iter().position(|parameter| parameter.name == name);
        let Some((index, parameter)) = index.map(|index| (index, &known[index])) else {
            let known = known.iter().map(|parameter| parameter.name).collect();
            return Err(JobError::UnknownParameter {
                name: name.clone(),
                known,
            });
        };
        let within = (parameter.min..=parameter.max).contains(value);
        if !(value.is_finite() && within && parameters.set(index, T::from_f64(*value))) {
            return Err(JobError::ParameterValue {
                name: name.clone(),
                value: *value,
                min: parameter.min,
                max: parameter.max,
                unit: parameter.unit,
            });
        }
    }
    Ok(parameters)
}

/// The model with the parameters named, if they make one.
pub(super) fn model<T: Real, M: Model<T>>(named: &[(String, f64)]) -> Result<M, JobError> {
    let model = M::new(parameters::<T, M>(named)?);
    match model
        .violated()
        .and_then(|index| M::INFO.conditions.get(index))
    {
        None => Ok(model),
        Some(condition) => Err(JobError::Condition {
            condition,
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
                write!(
                    f,
                    "with {with} it does not hold that {condition}, and so the model cannot move"
                )
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
            JobError::Scalar { scalar } => {
                let name = scalar.name();
                write!(
                    f,
                    "this program has not been compiled for the scalar {name}"
                )
            }
            JobError::Word { word, problem } => write!(f, "argument \"{word}\": {problem}"),
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

#[cfg(test)]
mod tests {
    use super::{Job, JobError, Scalar, parameters};
    use crate::Formula;
    use crate::simulate::{Adaptive, Method, Pace};
    use crate::test_models::Oscillator;

    #[test]
    fn words_make_the_same_job() {
        let adaptive = Adaptive {
            first_step: Some(1e-7),
            ..Adaptive::default()
        };
        let mut methods = vec![None];
        for formula in Formula::ALL {
            methods.push(Some(Method::fixed(formula, 1e-4)));
            if formula.estimates_error() {
                let pace = Pace::Adaptive(adaptive);
                methods.push(Some(Method { formula, pace }));
            }
        }
        for (i, method) in methods.into_iter().enumerate() {
            let job = Job {
                duration: Some(0.1 + 0.2),
                every: Some(1.0 / 3.0),
                method,
                locate: [None, Some(true), Some(false)][i % 3],
                max_steps: Some(12),
                energy_limit: [None, Some(0.05), Some(f64::INFINITY)][i % 3],
                parameters: vec![("a".into(), -1e-300), ("b".into(), f64::INFINITY)],
                scalar: Scalar::ALL[i % 4],
                silent: i % 2 == 0,
            };
            assert_eq!(Job::from_words(&job.to_words()), Ok(job));
        }
        assert_eq!(Job::from_words::<&str>(&[]), Ok(Job::default()));
    }

    #[test]
    fn every_method_is_named_where_one_is_not_known() {
        for formula in Formula::ALL {
            assert!(super::METHODS.contains(formula.name()));
        }
    }

    #[test]
    fn wrong_words_are_named() {
        for (words, problem) in [
            (vec!["hello"], "not key=value"),
            (vec!["durations=1"], "no such key"),
            (vec!["duration=long"], "not a number"),
            (vec!["max-steps=1.5"], "not a whole number"),
            (vec!["method=euler"], "methods are"),
            (vec!["method=rk4"], "needs step="),
            (vec!["step=0.1"], "needs method="),
            (vec!["kinks=no"], "located or passed"),
            (vec!["scalar=f16"], "the scalars are"),
            (vec!["method=rk4", "step=0.1", "relative=1"], "not both"),
        ] {
            let message = Job::from_words(&words).unwrap_err().to_string();
            assert!(message.contains(problem), "{message}");
        }
    }

    #[test]
    fn parameters_out_of_bounds_are_named_with_their_bounds() {
        let check = |name: &str, value: f64| {
            parameters::<f64, Oscillator>(&[(name.to_owned(), value)])
                .map_err(|error| error.to_string())
        };
        assert!(check("stiffness", 100.0).is_ok());
        for value in [-1.0, 100.5, f64::NAN, f64::INFINITY] {
            let message = check("stiffness", value).unwrap_err();
            assert!(message.contains("\"stiffness\""), "{message}");
            assert!(message.ends_with("between 0 and 100 N/m"), "{message}");
        }
        assert!(
            check("mass", 1.0)
                .unwrap_err()
                .ends_with("there is stiffness")
        );
        let twice = [("stiffness".to_owned(), 1.0), ("stiffness".to_owned(), 2.0)];
        let error = parameters::<f64, Oscillator>(&twice).unwrap_err();
        assert!(matches!(error, JobError::RepeatedParameter { .. }));
    }
}
