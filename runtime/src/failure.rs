//! How a run can fail, in the words of the model.

use crate::{Formula, Info};
use core::fmt;

/// A run that could not go on. Every sample before [`Failure::t`] has been delivered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// Time at which it happened \[s\].
    pub t: f64,
    /// What happened.
    pub reason: Reason,
    /// The model, for names.
    pub info: &'static Info,
}

/// Why a run could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The state, or its derivative, is infinite or not a number.
    NonFinite {
        /// Where in the state y, or in ẏ.
        index: usize,
        /// Which of the two.
        of: Quantity,
        /// The first output that is not finite there: it tells which force is to blame.
        output: Option<usize>,
    },
    /// The tolerance asks for a step below the smallest allowed.
    StepTooSmall {
        /// The step asked for \[s\].
        step: f64,
        /// The entry of the state whose error forced it.
        index: usize,
    },
    /// The limit on the number of steps is reached.
    TooManySteps {
        /// The limit.
        limit: u64,
    },
    /// A setting makes no sense; nothing was computed.
    InvalidSettings(Setting),
    /// The method was left out when the model was compiled; nothing was computed.
    NotCompiled {
        /// Which.
        formula: Formula,
    },
}

/// What is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The state that the model starts with.
    InitialState,
    /// The state y.
    State,
    /// Its derivative ẏ.
    Derivative,
}

/// A setting that makes no sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What it should be.
    pub must: &'static str,
}

impl Failure {
    /// Name of the coordinate or velocity at fault, where one is.
    pub fn coordinate(&self) -> Option<&'static str> {
        match self.reason {
            Reason::NonFinite { index, .. } | Reason::StepTooSmall { index, .. } => {
                self.info.state_name(index)
            }
            Reason::TooManySteps { .. }
            | Reason::InvalidSettings(_)
            | Reason::NotCompiled { .. } => None,
        }
    }

    /// The likely cause and what to do about it.
    pub fn cause(&self) -> &'static str {
        match self.reason {
            Reason::NonFinite {
                of: Quantity::InitialState,
                ..
            } => {
                "a parameter has a value for which the start of the model is not defined, for instance a pretension \
                 that the curve of its belt never reaches"
            }
            Reason::NonFinite {
                output: Some(_), ..
            } => {
                "a curve with `extrapolate: error` left its range; give it more points, or `linear` or `hold`"
            }
            Reason::NonFinite { .. } => {
                "a curve with `extrapolate: error` left its range, or a fixed step is too large for the stiffest force"
            }
            Reason::StepTooSmall { .. } => {
                "a force too stiff for the mass it acts on, a friction tolerance near zero, or an error tolerance near \
                 rounding"
            }
            Reason::TooManySteps { .. } => {
                "a force too stiff for the mass it acts on, a tight tolerance, or a limit too low for so long a run"
            }
            Reason::InvalidSettings(_) => "the settings of the run",
            Reason::NotCompiled { .. } => "a table of models compiled with few methods",
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let info = self.info;
        let entry = |index: usize| {
            let kind = if index < info.coordinates.len() {
                "coordinate"
            } else {
                "velocity"
            };
            (kind, info.state_name(index).unwrap_or("?"))
        };
        match self.reason {
            Reason::InvalidSettings(Setting { name, value, must }) => {
                return write!(f, "{name} is {value}, but must be {must}");
            }
            Reason::NotCompiled { formula } => {
                return write!(
                    f,
                    "the model has not been compiled with the method {formula}"
                );
            }
            Reason::NonFinite { index, of, output } => {
                let (kind, name) = entry(index);
                match of {
                    Quantity::InitialState => write!(f, "at the start the {kind} \"{name}\"")?,
                    Quantity::State => write!(f, "at t = {} s the {kind} \"{name}\"", self.t)?,
                    Quantity::Derivative => {
                        write!(f, "at t = {} s the rate of the {kind} \"{name}\"", self.t)?;
                    }
                }
                write!(f, " is not finite")?;
                if let Some(output) = output.and_then(|i| info.outputs.get(i)) {
                    write!(f, ", nor is the output \"{}\"", output.name)?;
                }
            }
            Reason::StepTooSmall { step, index } => {
                let (kind, name) = entry(index);
                let t = self.t;
                write!(
                    f,
                    "at t = {t} s the {kind} \"{name}\" asks for a step of {step:e} s"
                )?;
            }
            Reason::TooManySteps { limit } => {
                write!(
                    f,
                    "at t = {} s the limit of {limit} steps is reached",
                    self.t
                )?;
            }
        }
        write!(f, "; likely cause: {}", self.cause())
    }
}

impl core::error::Error for Failure {}

#[cfg(test)]
mod tests {
    use super::{Failure, Quantity, Reason};
    use crate::{Info, OutputInfo};

    const QUATERNION: Info = Info {
        name: "top",
        digest: "",
        dimension: 3,
        coordinates: &["top.w", "top.x", "top.y", "top.z"],
        velocities: &["top.p", "top.q", "top.r"],
        kinds: &[],
        auxiliaries: &[],
        memory: &[],
        guards: &[],
        kinks: &[],
        powers: &[],
        free: false,
        outputs: &[OutputInfo {
            name: "lap belt force",
            unit: "N",
        }],
        parameters: &[],
        breakpoints: &[],
        duration: 1.0,
        every: 0.1,
    };
    const BRYANT: Info = Info {
        coordinates: &["top.angle1", "top.angle2", "top.angle3"],
        ..QUATERNION
    };

    fn failure(info: &'static Info, reason: Reason) -> Failure {
        let t = 0.25;
        Failure { t, reason, info }
    }

    #[test]
    fn a_small_step_names_time_velocity_and_stiffness() {
        let reason = Reason::StepTooSmall {
            step: 1e-15,
            index: 5,
        };
        let failed = failure(&QUATERNION, reason);
        assert_eq!(failed.coordinate(), Some("top.q"));
        let text = failed.to_string();
        assert!(
            text.starts_with("at t = 0.25 s the velocity \"top.q\" asks for a step of 1e-15 s"),
            "{text}"
        );
        assert!(text.contains("too stiff"), "{text}");
    }

    #[test]
    fn bryant_angles_are_not_to_blame() {
        // their chart changes before they are singular
        let reason = Reason::StepTooSmall {
            step: 1e-15,
            index: 1,
        };
        let [angles, quaternion] = [&BRYANT, &QUATERNION].map(|info| failure(info, reason).cause());
        assert_eq!(angles, quaternion);
    }

    #[test]
    fn what_is_not_finite_names_the_output_that_shares_it() {
        let reason = Reason::NonFinite {
            index: 0,
            of: Quantity::Derivative,
            output: Some(0),
        };
        let text = failure(&QUATERNION, reason).to_string();
        assert!(text.contains("rate of the coordinate \"top.w\""), "{text}");
        assert!(text.contains("output \"lap belt force\""), "{text}");
        assert!(text.contains("left its range"), "{text}");
    }

    #[test]
    fn an_index_beyond_the_state_is_no_panic() {
        let reason = Reason::StepTooSmall {
            step: 1e-15,
            index: 99,
        };
        assert_eq!(failure(&BRYANT, reason).coordinate(), None);
        assert!(!failure(&BRYANT, reason).to_string().is_empty());
    }
}
