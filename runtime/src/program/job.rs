//! What to run: settings and parameters that differ from the model's own, and how they are written as words.

use crate::simulate::{Adaptive, Method, Settings};
use crate::{Info, Model, ParameterSet};
use std::fmt;

/// What to run. Whatever is `None` is as the model says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Job {
    /// Length of the run \[s\].
    pub duration: Option<f64>,
    /// Time between samples \[s\].
    pub every: Option<f64>,
    /// Which integrator.
    pub method: Option<Method>,
    /// Limit on the number of steps.
    pub max_steps: Option<u64>,
    /// Parameters by name, SI.
    pub parameters: Vec<(String, f64)>,
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
    /// An argument that is none of [`Job::WORDS`].
    Word {
        /// The argument.
        word: String,
        /// What is wrong with it.
        problem: &'static str,
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
    pub const WORDS: &str = "duration= every= method=dopri5|rk4 step= relative= absolute= absolute-velocity= \
                             first-step= largest-step= smallest-step= max-steps= parameter.NAME=";

    /// The settings of a run of the model with this job. What is wrong with them, the run will say.
    pub fn settings(&self, info: &Info) -> Settings {
        let of_model = Settings::of(info);
        Settings {
            duration: self.duration.unwrap_or(of_model.duration),
            every: self.every.unwrap_or(of_model.every),
            method: self.method.unwrap_or(of_model.method),
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
        match self.method {
            None => {}
            Some(Method::Rk4 { step }) => number("step", step),
            Some(Method::Dopri5(adaptive)) => {
                number("relative", adaptive.tolerances.relative);
                number("absolute", adaptive.tolerances.coordinates);
                number("absolute-velocity", adaptive.tolerances.velocities);
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
        match self.method {
            None => {}
            Some(Method::Rk4 { .. }) => words.push("method=rk4".into()),
            Some(Method::Dopri5(_)) => words.push("method=dopri5".into()),
        }
        if let Some(limit) = self.max_steps {
            words.push(format!("max-steps={limit}"));
        }
        words
    }

    /// The job written as arguments `key=value`, in any order.
    ///
    /// # Errors
    /// [`JobError::Word`]: an unknown key, a value that is no number, a key of the other method.
    pub fn from_words<W: AsRef<str>>(words: &[W]) -> Result<Job, JobError> {
        let mut job = Job::default();
        let mut adaptive = Adaptive::default();
        let (mut method, mut step, mut of_adaptive) = (None, None, None);
        for word in words {
            let word = word.as_ref();
            let wrong = |problem| JobError::Word {
                word: word.to_owned(),
                problem,
            };
            let (key, text) = word
                .split_once('=')
                .ok_or_else(|| wrong("it is not key=value"))?;
            if key == "method" {
                method = Some(match text {
                    "rk4" => true,
                    "dopri5" => false,
                    _ => return Err(wrong("the methods are dopri5 and rk4")),
                });
                continue;
            }
            if key == "max-steps" {
                job.max_steps = Some(
                    text.parse()
                        .map_err(|_| wrong("it is not a whole number"))?,
                );
                continue;
            }
            let value: f64 = text.parse().map_err(|_| wrong("it is not a number"))?;
            if let Some(name) = key.strip_prefix("parameter.") {
                job.parameters.push((name.to_owned(), value));
                continue;
            }
            match key {
                "duration" => job.duration = Some(value),
                "every" => job.every = Some(value),
                "step" => step = Some((word, value)),
                "relative" => adaptive.tolerances.relative = value,
                "absolute" => adaptive.tolerances.coordinates = value,
                "absolute-velocity" => adaptive.tolerances.velocities = value,
                "largest-step" => adaptive.largest_step = value,
                "smallest-step" => adaptive.smallest_step = value,
                "first-step" => adaptive.first_step = Some(value),
                _ => return Err(wrong("there is no such key")),
            }
            if !matches!(key, "duration" | "every" | "step") {
                of_adaptive = Some(word);
            }
        }
        let wrong = |word: &str, problem| {
            Err(JobError::Word {
                word: word.to_owned(),
                problem,
            })
        };
        job.method = match (method, step, of_adaptive) {
            (Some(true), Some((_, step)), None) => Some(Method::Rk4 { step }),
            (Some(true), None, _) => return wrong("method=rk4", "it needs step="),
            (Some(true), _, Some(word)) => return wrong(word, "it belongs to method=dopri5"),
            (_, Some((word, _)), _) => return wrong(word, "it belongs to method=rk4"),
            (Some(false), None, _) | (None, None, Some(_)) => Some(Method::Dopri5(adaptive)),
            (None, None, None) => None,
        };
        Ok(job)
    }
}

/// The parameters of a model: its defaults, and those named.
pub(super) fn parameters<M: Model<f64>>(
    named: &[(String, f64)],
) -> Result<M::Parameters, JobError> {
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
        if !(value.is_finite() && within && parameters.set(index, *value)) {
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

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
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
    use super::{Job, JobError, parameters};
    use crate::simulate::{Adaptive, Method};
    use crate::test_models::Oscillator;

    #[test]
    fn words_make_the_same_job() {
        let adaptive = Adaptive {
            first_step: Some(1e-7),
            ..Adaptive::default()
        };
        for method in [
            None,
            Some(Method::Rk4 { step: 1e-4 }),
            Some(Method::Dopri5(adaptive)),
        ] {
            let job = Job {
                duration: Some(0.1 + 0.2),
                every: Some(1.0 / 3.0),
                method,
                max_steps: Some(12),
                parameters: vec![("a".into(), -1e-300), ("b".into(), f64::INFINITY)],
            };
            assert_eq!(Job::from_words(&job.to_words()), Ok(job));
        }
        assert_eq!(Job::from_words::<&str>(&[]), Ok(Job::default()));
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
            (vec!["step=0.1"], "belongs to method=rk4"),
            (vec!["step=0.1", "method=dopri5"], "belongs to method=rk4"),
            (
                vec!["method=rk4", "step=0.1", "relative=1"],
                "belongs to method=dopri5",
            ),
        ] {
            let message = Job::from_words(&words).unwrap_err().to_string();
            assert!(message.contains(problem), "{message}");
        }
    }

    #[test]
    fn parameters_out_of_bounds_are_named_with_their_bounds() {
        let check = |name: &str, value: f64| {
            parameters::<Oscillator>(&[(name.to_owned(), value)]).map_err(|error| error.to_string())
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
        let error = parameters::<Oscillator>(&twice).unwrap_err();
        assert!(matches!(error, JobError::RepeatedParameter { .. }));
    }
}
