//! The settings of a run, and their check.

use crate::failure::Setting;
use crate::integrate::Formula;
use crate::{Info, Tolerances};

/// Settings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Time at which the run begins \[s\], that of its initial state: 0, unless the run continues another one.
    pub start: f64,
    /// Time at which the run ends \[s\], after `start`; the length of the run if that is 0.
    pub duration: f64,
    /// Time between samples \[s\], positive. There is a sample at the start, at every multiple of this time, and at the
    /// end: samples between are at the same times wherever the run begins.
    pub every: f64,
    /// Number of equal parts of the run at whose ends there are additional samples, from which signals can be read; 0
    /// for none. No step ends on them, so they do not affect the motion.
    pub parts: u64,
    /// The integrator, and the length of its steps.
    pub method: Integrator,
    /// Whether steps end on the kinks of force laws ([`Model::kinks`](crate::Model::kinks)): where a contact touches, a
    /// belt goes taut, a curve bends. Otherwise steps pass over them, and only the error control limits the error
    /// there.
    pub locate: bool,
    /// Limit on the number of steps, accepted and rejected.
    pub max_steps: u64,
}

/// An integrator: the formula of its steps, and their length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrator {
    /// The formula of its steps.
    pub formula: Formula,
    /// The length of its steps.
    pub pace: Pace,
}

/// The length of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// Fixed steps of at most this length \[s\]: shortened evenly so that steps end on samples and on kinks of curves
    /// of time.
    Fixed(f64),
    /// As long as the tolerances allow.
    Adaptive(Adaptive),
}

impl Integrator {
    /// An integrator with steps of a fixed length \[s\].
    pub const fn fixed(formula: Formula, step: f64) -> Integrator {
        let pace = Pace::Fixed(step);
        Integrator { formula, pace }
    }

    /// An integrator with steps as long as the tolerances allow, by this formula, and by [`Formula::Rodas5`] for as
    /// long as the scene is stiff ([`Adaptive::switches`]).
    pub const fn switching(formula: Formula, tolerances: Tolerances) -> Integrator {
        let pace = Pace::Adaptive(Adaptive {
            switches: true,
            ..Adaptive::of(tolerances)
        });
        Integrator { formula, pace }
    }

    /// Whether the integrator may change to the Rosenbrock method and back.
    pub const fn switches(&self) -> bool {
        match self.pace {
            Pace::Adaptive(adaptive) => adaptive.switches && self.formula.may_switch(),
            Pace::Fixed(_) => false,
        }
    }

    /// An integrator with steps as long as the tolerances allow, by one formula from the start to the end.
    pub const fn adaptive(formula: Formula, tolerances: Tolerances) -> Integrator {
        let pace = Pace::Adaptive(Adaptive::of(tolerances));
        Integrator { formula, pace }
    }
}

/// Settings of an adaptive method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// Error allowed in a step.
    pub tolerances: Tolerances,
    /// First step \[s\]; if `None`, it is derived from the first derivatives.
    pub first_step: Option<f64>,
    /// Largest step \[s\]; +∞ for none.
    pub largest_step: f64,
    /// Smallest step \[s\]: a run that needs a smaller one fails. Never less than 16 units in the last place of time.
    pub smallest_step: f64,
    /// Whether the run changes to [`Formula::Rodas5`] where the scene is stiff, and back where it is not. This has no
    /// effect on a formula that does not [estimate its error at the end of a step](Formula::may_switch), and on a model
    /// without its Jacobian. The run needs more workspace, see [`workspace_length`](crate::simulate::workspace_length).
    pub switches: bool,
}

impl Adaptive {
    /// Settings with these tolerances, steps of 10⁻¹⁴ s or more, and one formula.
    pub const fn of(tolerances: Tolerances) -> Adaptive {
        Adaptive {
            tolerances,
            first_step: None,
            largest_step: f64::INFINITY,
            smallest_step: 1e-14,
            switches: false,
        }
    }
}

impl Default for Adaptive {
    /// [`Adaptive::of`] the default tolerances.
    fn default() -> Self {
        Adaptive::of(Tolerances::default())
    }
}

impl Default for Integrator {
    /// Dormand & Prince's pair 5(4) at the default tolerances.
    fn default() -> Self {
        Integrator::adaptive(Formula::Dopri5, Tolerances::default())
    }
}

impl Settings {
    /// Settings with start 0, duration and sampling as the model says, the default method, kinks passed over, and at
    /// most ten million steps.
    pub fn of(info: &Info) -> Settings {
        Settings {
            start: 0.0,
            duration: info.duration,
            every: info.every,
            parts: 0,
            method: Integrator::default(),
            locate: false,
            max_steps: 10_000_000,
        }
    }

    /// Fails if a setting is invalid.
    pub(super) fn check(&self) -> Result<(), Setting> {
        positive("duration", self.duration)?;
        within(
            (0.0..self.duration).contains(&self.start),
            ("start", self.start),
            "0 or more, and before the end of the run",
        )?;
        positive("every", self.every)?;
        within(
            self.duration / self.every <= MAX_SAMPLES,
            ("every", self.every),
            "at least a billionth of the duration",
        )?;
        within(
            self.parts as f64 <= MAX_SAMPLES,
            ("number of parts", self.parts as f64),
            "a billion at most",
        )?;
        within(self.max_steps > 0, ("limit on steps", 0.0), "positive")?;
        match self.method.pace {
            Pace::Fixed(step) => {
                positive("step", step)?;
                within(
                    step <= self.duration - self.start,
                    ("step", step),
                    "at most as long as the run",
                )
            }
            Pace::Adaptive(adaptive) => {
                within(
                    self.method.formula.estimates_error(),
                    ("tolerance", adaptive.tolerances.relative),
                    "left away where the method does not estimate its error, as semi-implicit Euler and \
                     Runge–Kutta 4 do not: give a step instead",
                )?;
                adaptive.check()
            }
        }
    }
}

impl Adaptive {
    /// Fails if a setting is invalid.
    fn check(&self) -> Result<(), Setting> {
        let tolerances = &self.tolerances;
        share("relative tolerance", tolerances.relative)?;
        positive("absolute tolerance of positions", tolerances.positions)?;
        share("absolute tolerance of angles", tolerances.angles)?;
        positive("absolute tolerance of velocities", tolerances.velocities)?;
        positive(
            "absolute tolerance of angular velocities",
            tolerances.angular_velocities,
        )?;
        positive(
            "absolute tolerance of states of force laws",
            tolerances.laws,
        )?;
        positive("smallest step", self.smallest_step)?;
        if let Some(step) = self.first_step {
            positive("first step", step)?;
        }
        within(
            self.largest_step >= self.smallest_step,
            ("largest step", self.largest_step),
            "no smaller than the smallest step",
        )
    }
}

/// Fails with a setting of this name and value, and with what it must be, unless it is `good`.
fn within(
    good: bool,
    (name, value): (&'static str, f64),
    must: &'static str,
) -> Result<(), Setting> {
    match good {
        true => Ok(()),
        false => Err(Setting { name, value, must }),
    }
}

fn positive(name: &'static str, value: f64) -> Result<(), Setting> {
    let good = value > 0.0 && value.is_finite();
    within(good, (name, value), "positive and finite")
}

/// Fails unless a value is positive and below 1, as relative tolerances must be.
fn share(name: &'static str, value: f64) -> Result<(), Setting> {
    positive(name, value)?;
    within(
        value < 1.0,
        (name, value),
        "below 1, where all of a value may be wrong: 1e-3 is coarse, 1e-10 fine",
    )
}

/// Limit of samples: a larger number is taken as a mistake in `every`.
const MAX_SAMPLES: f64 = 1e9;
