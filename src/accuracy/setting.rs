//! One way to compute a motion: formula, pace, scalar, kinks, curves.

use bryant_runtime::program::{Job, Scalar};
use bryant_runtime::{Adaptive, Formula, Method, Report, Tolerances};

/// How a run is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The formula of a step.
    pub formula: Formula,
    /// Whether runs change to the Rosenbrock method where the scene is stiff.
    pub switches: bool,
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

/// A formula, or a formula that changes to the Rosenbrock method where the scene is stiff.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// The formula that it begins with.
    pub formula: Formula,
    /// Whether it changes.
    pub switches: bool,
}

impl Scheme {
    /// The one that runs have by default.
    pub const DEFAULT: Scheme = Scheme {
        formula: Formula::Dopri5,
        switches: true,
    };

    /// All that are compared: every formula, and the one that runs have by default.
    pub fn all() -> Vec<Scheme> {
        let alone = |formula| Scheme {
            formula,
            switches: false,
        };
        let formulas = Formula::ALL.into_iter().map(alone);
        formulas.chain([Scheme::DEFAULT]).collect()
    }

    /// Its name in commands and files: "dopri5", "dopri5+rodas5".
    pub fn name(self) -> String {
        let more = match self.switches {
            true => format!("+{}", Formula::Rodas5.name()),
            false => String::new(),
        };
        format!("{}{more}", self.formula.name())
    }

    /// Its name for people.
    pub fn title(self) -> String {
        let more = match self.switches {
            true => ", changed for Rosenbrock 5(4) where the scene is stiff",
            false => "",
        };
        format!("{}{more}", self.formula.title())
    }
}

impl Setting {
    /// Its formula, and whether it changes.
    pub fn scheme(&self) -> Scheme {
        Scheme {
            formula: self.formula,
            switches: self.switches,
        }
    }

    /// The setting as a run by it turned out: a run that had no reason to change its formula is one by its formula alone.
    pub fn as_run(self, report: &Report) -> Setting {
        Setting {
            switches: self.switches && report.stiff > 0,
            ..self
        }
    }

    /// The setting of a job: what it says about method and kinks, and defaults for the rest.
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
            curves: Curves::Written,
        }
    }

    /// The method of a job.
    pub fn method(&self) -> Method {
        let pace = match self.pace {
            Pace::Step(step) => bryant_runtime::Pace::Fixed(step),
            Pace::Tolerance(relative) => bryant_runtime::Pace::Adaptive(Adaptive {
                switches: self.switches,
                ..Adaptive::of(Tolerances::of(relative))
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
        let mut name = format!("{} at {}", self.scheme().name(), self.pace.name());
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
