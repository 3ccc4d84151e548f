//! A setting is one way to compute a motion: formula, pace, scalar, kinks.

use bryant_runtime::program::{Job, RunError, Scalar};
use bryant_runtime::{Adaptive, Formula, Integrator, Report, Tolerances};

/// The setting of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The formula of a step.
    pub formula: Formula,
    /// True if the run changes to the Rosenbrock method where the scene is stiff.
    pub switches: bool,
    /// The length of steps.
    pub pace: Pace,
    /// The type of its numbers.
    pub scalar: Scalar,
    /// True if steps end at kinks of force laws.
    pub locate: bool,
}

/// The length of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// All steps have this length \[s\].
    Step(f64),
    /// Steps are chosen by error control with this relative tolerance.
    Tolerance(f64),
}

/// A formula, with or without changes to the Rosenbrock method where the scene is stiff.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// The formula at the beginning of a run.
    pub formula: Formula,
    /// True if a run changes to the Rosenbrock method where the scene is stiff.
    pub switches: bool,
}

impl Scheme {
    /// The default scheme of runs.
    pub const DEFAULT: Scheme = Scheme {
        formula: Formula::Dopri5,
        switches: true,
    };

    /// All schemes that are compared: every formula alone, and the default scheme.
    pub fn all() -> Vec<Scheme> {
        let alone = |formula| Scheme {
            formula,
            switches: false,
        };
        let formulas = Formula::ALL.into_iter().map(alone);
        formulas.chain([Scheme::DEFAULT]).collect()
    }

    /// The name in commands and files: "dopri5", "dopri5+rodas5".
    pub fn name(self) -> String {
        let more = match self.switches {
            true => format!("+{}", Formula::Rodas5.name()),
            false => String::new(),
        };
        format!("{}{more}", self.formula.name())
    }

    /// The name for people.
    pub fn title(self) -> String {
        let more = match self.switches {
            true => ", changed for Rosenbrock 5(4) where the scene is stiff",
            false => "",
        };
        format!("{}{more}", self.formula.title())
    }
}

impl Setting {
    /// Its scheme.
    pub fn scheme(&self) -> Scheme {
        Scheme {
            formula: self.formula,
            switches: self.switches,
        }
    }

    /// The setting that a run with this result used: without switching if the scene was not stiff.
    pub fn as_run(self, result: &Result<Report, RunError>) -> Setting {
        let stiff = result.as_ref().is_ok_and(|report| report.stiff > 0);
        Setting {
            switches: self.switches && (stiff || result.is_err()),
            ..self
        }
    }

    /// The setting of a job; kinks are passed unless the job says otherwise.
    pub fn of(job: &Job) -> Self {
        let method = job.method();
        Setting {
            formula: method.formula,
            switches: method.switches(),
            pace: match method.pace {
                bryant_runtime::Pace::Fixed(step) => Pace::Step(step),
                bryant_runtime::Pace::Adaptive(adaptive) => {
                    Pace::Tolerance(adaptive.tolerances.relative)
                }
            },
            scalar: job.scalar,
            locate: job.locate.unwrap_or(false),
        }
    }

    /// The method of a job.
    pub fn method(&self) -> Integrator {
        let pace = match self.pace {
            Pace::Step(step) => bryant_runtime::Pace::Fixed(step),
            Pace::Tolerance(relative) => bryant_runtime::Pace::Adaptive(Adaptive {
                switches: self.switches,
                ..Adaptive::of(Tolerances::of(relative).calm())
            }),
        };
        Integrator {
            formula: self.formula,
            pace,
        }
    }

    /// The job of a run with this setting; everything else is as in `job`.
    pub fn job(&self, job: &Job) -> Job {
        Job {
            method: Some(self.method()),
            locate: Some(self.locate),
            scalar: self.scalar,
            ..job.clone()
        }
    }

    /// True if the setting differs from another one only in the length of steps or the tolerance.
    pub fn same_series(&self, other: &Setting) -> bool {
        let kinds = [self.pace, other.pace].map(|pace| matches!(pace, Pace::Step(_)));
        kinds[0] == kinds[1]
            && Setting {
                pace: other.pace,
                ..*self
            } == *other
    }

    /// What it does at kinks: "located" or "passed".
    pub fn kinks(&self) -> &'static str {
        match self.locate {
            true => "located",
            false => "passed",
        }
    }

    /// The name of the setting: "dop853 at tolerance 3e-4 in f64"; properties with their usual values are left out.
    pub fn name(&self) -> String {
        let mut name = format!("{} at {}", self.scheme().name(), self.pace.name());
        if self.scalar != Scalar::F64 {
            name += &format!(" in {}", self.scalar.name());
        }
        if !self.locate {
            name += ", kinks passed";
        }
        name
    }
}

impl Pace {
    /// The name of the pace: "tolerance 3e-4", "steps of 0.1 ms"
    pub fn name(&self) -> String {
        match self {
            Pace::Step(step) => format!("steps of {}", time(*step)),
            Pace::Tolerance(tolerance) => format!("tolerance {tolerance:e}"),
        }
    }

    /// The step or the tolerance.
    pub fn value(&self) -> f64 {
        match self {
            Pace::Step(value) | Pace::Tolerance(value) => *value,
        }
    }
}

/// A length of time in the unit in which it is easiest to read, with at most four digits.
pub fn time(seconds: f64) -> String {
    let (value, unit) = match seconds.abs() {
        s if s >= 1.0 || s == 0.0 => (seconds, "s"),
        s if s >= 1e-3 => (seconds * 1e3, "ms"),
        s if s >= 1e-6 => (seconds * 1e6, "µs"),
        _ => (seconds * 1e9, "ns"),
    };
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded} {unit}")
}

/// The value rounded to two digits: times on a busy machine are not more precise.
pub fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
