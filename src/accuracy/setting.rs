//! One way to compute a motion: formula, pace, scalar, kinks, curves.

use bryant_runtime::program::{Job, Scalar};
use bryant_runtime::{Adaptive, Formula, Method, Tolerances};

/// How a run is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The formula of a step.
    pub formula: Formula,
    /// How long steps are.
    pub pace: Pace,
    /// The type of its numbers.
    pub scalar: Scalar,
    /// Whether steps end at kinks of force laws.
    pub locate: bool,
    /// Which curves the model has.
    pub curves: Curves,
}

/// How long steps are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// All steps have this length \[s\].
    Step(f64),
    /// Steps follow from this relative tolerance.
    Tolerance(f64),
}

/// Which curves the model has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curves {
    /// The curves that the model was written with.
    Written,
    /// Cubics for straight lines, and straight lines for cubics.
    Exchanged,
}

impl Setting {
    /// The setting of a job: what it says about method and kinks, and defaults for the rest.
    pub fn of(job: &Job) -> Self {
        let method = job.method.unwrap_or_default();
        Setting {
            formula: method.formula,
            pace: match method.pace {
                bryant_runtime::Pace::Fixed(step) => Pace::Step(step),
                bryant_runtime::Pace::Adaptive(adaptive) => {
                    Pace::Tolerance(adaptive.tolerances.relative)
                }
            },
            scalar: job.scalar,
            locate: job.locate.unwrap_or(false),
            curves: Curves::Written,
        }
    }

    /// The method of a job.
    pub fn method(&self) -> Method {
        let pace = match self.pace {
            Pace::Step(step) => bryant_runtime::Pace::Fixed(step),
            Pace::Tolerance(relative) => bryant_runtime::Pace::Adaptive(Adaptive {
                tolerances: Tolerances::of(relative),
                ..Adaptive::default()
            }),
        };
        Method {
            formula: self.formula,
            pace,
        }
    }

    /// The job that computes a run of this setting, everything else as in `job`.
    pub fn job(&self, job: &Job) -> Job {
        Job {
            method: Some(self.method()),
            locate: Some(self.locate),
            scalar: self.scalar,
            ..job.clone()
        }
    }

    /// Whether it differs from another setting only in the length of its steps or its tolerance.
    pub fn same_series(&self, other: &Setting) -> bool {
        let kinds = [self.pace, other.pace].map(|pace| matches!(pace, Pace::Step(_)));
        kinds[0] == kinds[1]
            && Setting {
                pace: other.pace,
                ..*self
            } == *other
    }

    /// "located" or "passed".
    pub fn kinks(&self) -> &'static str {
        match self.locate {
            true => "located",
            false => "passed",
        }
    }

    /// "dop853 at tolerance 3e-4 in f64"; settings that are not the usual ones follow.
    pub fn name(&self) -> String {
        let mut name = format!("{} at {}", self.formula.name(), self.pace.name());
        if self.scalar != Scalar::F64 {
            name += &format!(" in {}", self.scalar.name());
        }
        if !self.locate {
            name += ", kinks passed";
        }
        if self.curves == Curves::Exchanged {
            name += ", curves exchanged";
        }
        name
    }
}

impl Pace {
    /// "tolerance 3e-4", "steps of 0.1 ms"
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

impl Curves {
    /// "written" or "exchanged".
    pub fn name(self) -> &'static str {
        match self {
            Curves::Written => "written",
            Curves::Exchanged => "exchanged",
        }
    }
}

/// A length of time with the unit in which it has few digits, at most four.
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

/// Rounded to two digits: a time on a busy machine is not more precise.
pub fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
