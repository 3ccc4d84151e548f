//! The ways in which a run can fail, in the words of the model.

use crate::simulate::OutOfRange;
use crate::{Cause, Dynamics, Extrapolate, Formula, Info, Real};
use core::fmt;

/// A run that could not go on. All samples before [`Failure::t`] were delivered. Its names are those of the model of
/// the run, which it borrows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure<'a> {
    /// Time of the failure \[s\].
    pub t: f64,
    /// The reason.
    pub reason: Reason,
    /// The model, for its names.
    pub info: &'a Info<'a>,
}

/// Why a run could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The state, or its derivative, is infinite or not a number.
    NonFinite {
        /// Index of the entry, in the state y or in its derivative ẏ.
        index: usize,
        /// The quantity that is not finite.
        of: Quantity,
        /// The first output that is not finite there. It tells which force is to blame.
        output: Option<usize>,
        /// The known cause in the model.
        culprit: Culprit,
    },
    /// The tolerance asks for a step below the smallest allowed.
    StepTooSmall {
        /// The step asked for \[s\].
        step: f64,
        /// The entry of the state whose error forced this step.
        index: usize,
        /// The known cause in the model.
        culprit: Culprit,
    },
    /// The limit on the number of steps is reached.
    TooManySteps {
        /// The limit.
        limit: u64,
        /// The most frequent limit on the length of the last steps.
        cause: Cause,
        /// Length of the last step \[s\].
        step: f64,
    },
    /// A setting is invalid; nothing was computed.
    InvalidSettings(Setting),
    /// The parameters of the model are invalid; nothing was computed.
    Refused(Refusal),
    /// The method needs the Jacobian of the model, but the model was given without one.
    NoJacobian {
        /// The method.
        formula: Formula,
    },
}

/// Why parameters are refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// A parameter is infinite or not a number: its index in [`Info::parameters`], and its value.
    NotFinite(usize, f64),
    /// An input is outside of its limits: its index in [`Info::parameters`], and its value.
    OutOfLimits(usize, f64),
    /// The parameters violate a condition, an index in [`Info::conditions`].
    Condition(usize),
}

impl Refusal {
    /// Why the parameters of a model are refused; `None` where they are valid.
    pub fn of<T: Real>(model: &dyn Dynamics<T>) -> Option<Refusal> {
        for index in 0..model.info().parameters.len() {
            if let Some(value) = model.parameter(index).map(T::to_f64)
                && !value.is_finite()
            {
                return Some(Refusal::NotFinite(index, value));
            }
        }
        model.violated().map(Refusal::Condition)
    }

    /// Writes why parameters of a model are refused.
    pub fn write(self, info: &Info, f: &mut dyn fmt::Write) -> fmt::Result {
        let parameter = |index: usize| info.parameters.get(index);
        let name = |index| parameter(index).map_or("?", |of| of.name);
        match self {
            Refusal::NotFinite(index, value) => {
                let name = name(index);
                write!(f, "the parameter \"{name}\" is {value}, but must be finite")
            }
            Refusal::OutOfLimits(index, value) => {
                let [min, max] = parameter(index).map_or([0.0; 2], |of| [of.min, of.max]);
                let (name, unit) = (name(index), parameter(index).map_or("", |of| of.unit));
                write!(
                    f,
                    "the input \"{name}\" is {value} {unit}, which is out of its limits, {min} to {max}"
                )
            }
            Refusal::Condition(index) => {
                let condition = info.conditions.get(index).copied().unwrap_or("?");
                write!(f, "{condition}, which is not so with these parameters")
            }
        }
    }
}

/// The known cause of a failure, in the model, at a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Culprit {
    /// No cause is known.
    Unknown,
    /// The argument of a curve left the interval that it must not leave.
    Curve {
        /// Index of the curve in [`Info::curves`].
        curve: usize,
        /// Its argument.
        argument: f64,
    },
    /// The inertia of an element vanishes in this position, so its acceleration is not determined.
    Inertia {
        /// Index of the element in [`Info::pivots`].
        pivot: usize,
        /// The remaining share of the inertia. Rounding may make it negative.
        share: f64,
    },
}

/// A quantity that is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The initial state of the model.
    InitialState,
    /// The state y.
    State,
    /// Its derivative ẏ.
    Derivative,
    /// An output, where all of state and derivative are finite: the index is that of the output.
    Output,
}

/// An invalid setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What it should be.
    pub must: &'static str,
}

impl<'a> Failure<'a> {
    /// The same failure with the names of `info`, which may live longer than the model of the run: for a function that
    /// makes a [`Direct`](crate::Direct) and returns the failure of its run, [`Model::INFO`](crate::Model::INFO).
    ///
    /// # Panics
    /// If `info` has another [digest](Info::digest), so is of another model.
    pub fn with_info<'b>(self, info: &'b Info<'b>) -> Failure<'b> {
        assert_eq!(
            self.info.digest, info.digest,
            "the failure is not one of {}",
            info.name
        );
        let Failure { t, reason, .. } = self;
        Failure { t, reason, info }
    }

    /// Name of the coordinate or velocity that failed, if there is one.
    pub fn coordinate(&self) -> Option<&'a str> {
        match self.reason {
            Reason::NonFinite {
                of: Quantity::Output,
                ..
            } => None,
            Reason::NonFinite { index, .. } | Reason::StepTooSmall { index, .. } => {
                self.info.state_name(index)
            }
            Reason::TooManySteps {
                cause: Cause::Tolerance(index),
                ..
            } => self.info.state_name(index),
            Reason::TooManySteps { .. }
            | Reason::InvalidSettings(_)
            | Reason::Refused(_)
            | Reason::NoJacobian { .. } => None,
        }
    }

    /// The known cause at the state of the failure.
    fn culprit(&self) -> Culprit {
        match self.reason {
            Reason::NonFinite { culprit, .. } | Reason::StepTooSmall { culprit, .. } => culprit,
            _ => Culprit::Unknown,
        }
    }

    /// The likely cause and what to do about it.
    pub fn cause(&self) -> &'static str {
        match self.culprit() {
            Culprit::Unknown => {}
            Culprit::Curve { .. } => {
                return "the motion goes further than the curve is known; give it more points, or `extrapolate: linear` or `hold`";
            }
            Culprit::Inertia { .. } => {
                return "no moment of inertia resists one of its rotations in this position; give it moments that are not 0";
            }
        }
        // whether there is a curve that must not be left
        let curves = self.info.curves.iter();
        let error = |curve: &crate::CurveInfo<'_>| curve.extrapolate == Extrapolate::Error;
        let curves = self.info.time_ends || curves.into_iter().any(error);
        match self.reason {
            Reason::NonFinite {
                of: Quantity::InitialState,
                ..
            } => {
                "a parameter has a value for which the start of the model is not defined, for instance a pretension \
                 that the curve of its belt never reaches"
            }
            Reason::NonFinite {
                of: Quantity::Output,
                ..
            } => {
                "numbers so large that results overflow, or a curve with `extrapolate: error` that left its range"
            }
            Reason::NonFinite {
                output: Some(_), ..
            } if curves => {
                "a curve with `extrapolate: error` left its range; give it more points, or `linear` or `hold`"
            }
            Reason::NonFinite { .. } if curves => {
                "a curve with `extrapolate: error` left its range, or a fixed step is too large for the stiffest force"
            }
            Reason::NonFinite { .. } => {
                "a fixed step is too large for the stiffest force, or a user force is not defined there"
            }
            Reason::StepTooSmall { .. } => {
                "a force too stiff for the mass it acts on, a friction tolerance near zero, or an error tolerance near \
                 rounding"
            }
            Reason::TooManySteps { .. } => {
                "a force too stiff for the mass it acts on (the method rodas5 takes long steps there), a tight tolerance, or a limit too low for \
                 so long a run"
            }
            Reason::InvalidSettings(_) => "the settings of the run",
            Reason::Refused(_) => "the parameters of the run",
            Reason::NoJacobian { .. } => {
                "the model was given without its derivatives; give it as `Differentiable`, as `simulate_stiff` does, or take \
                 another method"
            }
        }
    }
}

impl<'a> Failure<'a> {
    /// "coordinate", "velocity" or another noun, and the name of an entry of the state.
    fn entry(&self, index: usize) -> (&'static str, &'a str) {
        let name = self.info.state_name(index).unwrap_or("?");
        (self.info.state_noun(index), name)
    }

    /// Writes why a run was refused before it began; `None` for a run that began.
    fn write_refusal(&self, f: &mut fmt::Formatter<'_>) -> Option<fmt::Result> {
        let info = self.info;
        Some(match self.reason {
            Reason::InvalidSettings(Setting { name, value, must }) => {
                write!(f, "{name} is {value}, but must be {must}")
            }
            Reason::Refused(refusal) => refusal.write(info, f),
            _ => return None,
        })
    }

    /// Writes what is not finite. `index` is that of an entry of the state, or of an output.
    fn write_non_finite(
        &self,
        f: &mut fmt::Formatter<'_>,
        of: Quantity,
        index: usize,
    ) -> fmt::Result {
        let (t, (kind, name)) = (self.t, self.entry(index));
        match of {
            Quantity::InitialState => write!(f, "at the start the {kind} \"{name}\"")?,
            Quantity::State => write!(f, "at t = {t} s the {kind} \"{name}\"")?,
            Quantity::Derivative => write!(f, "at t = {t} s the rate of the {kind} \"{name}\"")?,
            Quantity::Output => {
                let outputs = self.info.outputs;
                let name = outputs.get(index).map_or("?", |output| output.name);
                write!(f, "at t = {t} s the output \"{name}\"")?;
            }
        }
        f.write_str(" is not finite")
    }

    /// Writes what limited the last steps of a run that took too many.
    fn write_limit(&self, f: &mut fmt::Formatter<'_>, cause: Cause, step: f64) -> fmt::Result {
        let name = |names: &[&'a str], index: usize| names.get(index).copied().unwrap_or("?");
        match cause {
            Cause::Tolerance(index) => {
                let (kind, name) = self.entry(index);
                write!(
                    f,
                    "; the error of the {kind} \"{name}\" keeps steps at {step:.1e} s"
                )
            }
            Cause::Kink(index) => {
                let name = name(self.info.kinks, index);
                write!(f, "; the kink \"{name}\" keeps steps at {step:.1e} s")
            }
            Cause::EventFunction(index) => {
                let name = name(self.info.event_functions, index);
                write!(f, "; the event \"{name}\" ends steps after {step:.1e} s")
            }
            Cause::Fixed => write!(f, "; the step is {step:e} s"),
            _ => write!(f, "; the last step is {step:.1e} s"),
        }
    }

    /// Writes the known cause in the model, if there is one.
    fn write_culprit(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.culprit() {
            Culprit::Unknown => Ok(()),
            Culprit::Curve { curve, argument } => match self.info.curves.get(curve) {
                Some(curve) => write!(f, ": {}", OutOfRange { curve, argument }),
                None => Ok(()),
            },
            Culprit::Inertia { pivot, share } => {
                let name = self.info.pivots.get(pivot).copied().unwrap_or("?");
                write!(
                    f,
                    ": the inertia of \"{name}\" vanishes in this position ({share:.0e} of it is left)"
                )
            }
        }
    }
}

impl fmt::Display for Failure<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(written) = self.write_refusal(f) {
            return written;
        }
        let t = self.t;
        match self.reason {
            Reason::InvalidSettings(_) | Reason::Refused(_) => {}
            Reason::NoJacobian { formula } => {
                write!(
                    f,
                    "the method {formula} needs the Jacobian of the model, which this model does not have"
                )?;
            }
            Reason::NonFinite {
                index, of, output, ..
            } => {
                self.write_non_finite(f, of, index)?;
                let output = output.filter(|_| of != Quantity::Output);
                if let Some(output) = output.and_then(|i| self.info.outputs.get(i)) {
                    write!(f, ", nor is the output \"{}\"", output.name)?;
                }
            }
            Reason::StepTooSmall { step, index, .. } => {
                let (kind, name) = self.entry(index);
                write!(
                    f,
                    "at t = {t} s the {kind} \"{name}\" asks for a step of {step:e} s"
                )?;
            }
            Reason::TooManySteps { limit, cause, step } => {
                write!(f, "at t = {t} s the limit of {limit} steps is reached")?;
                self.write_limit(f, cause, step)?;
            }
        }
        self.write_culprit(f)?;
        write!(f, "; likely cause: {}", self.cause())
    }
}

impl core::error::Error for Failure<'_> {}
