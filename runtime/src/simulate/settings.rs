//! How to run, and which settings make sense.

use crate::failure::Setting;
use crate::{Info, Tolerances};

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Length of the run \[s\], positive.
    pub duration: f64,
    /// Time between samples \[s\], positive. Where the duration is no multiple of it, the last sample comes early.
    pub every: f64,
    /// Which integrator.
    pub method: Method,
    /// Limit on the number of steps, accepted and rejected.
    pub max_steps: u64,
}

/// Which integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The classical method of order 4 with fixed steps.
    Rk4 {
        /// Largest step \[s\]; shortened evenly so that samples and kinks are met.
        step: f64,
    },
    /// Dormand & Prince's pair 5(4) with control of the step and an interpolant of order 4.
    Dopri5(Adaptive),
}

/// Settings of an adaptive method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// Error allowed in a step.
    pub tolerances: Tolerances,
    /// First step \[s\]; `None`: found from the first derivatives.
    pub first_step: Option<f64>,
    /// Largest step \[s\]; +∞ for none.
    pub largest_step: f64,
    /// Smallest step \[s\]: a run that needs a smaller one fails. Never less than 16 units in the last place of time.
    pub smallest_step: f64,
}

impl Default for Adaptive {
    /// [`Tolerances::default`], steps from 10⁻¹⁴ s upwards.
    fn default() -> Self {
        Adaptive {
            tolerances: Tolerances::default(),
            first_step: None,
            largest_step: f64::INFINITY,
            smallest_step: 1e-14,
        }
    }
}

impl Default for Method {
    fn default() -> Self {
        Method::Dopri5(Adaptive::default())
    }
}

impl Settings {
    /// Duration and sampling as the model says, the adaptive method at its default tolerances, ten million steps.
    pub const fn of(info: &Info) -> Settings {
        Settings {
            duration: info.duration,
            every: info.every,
            method: Method::Dopri5(Adaptive {
                tolerances: Tolerances {
                    relative: 1e-6,
                    coordinates: 1e-8,
                    velocities: 1e-6,
                },
                first_step: None,
                largest_step: f64::INFINITY,
                smallest_step: 1e-14,
            }),
            max_steps: 10_000_000,
        }
    }

    /// Whether the settings make sense.
    pub(super) fn check(&self) -> Result<(), Setting> {
        let positive = |name, value: f64| {
            let good = value > 0.0 && value.is_finite();
            if good {
                Ok(())
            } else {
                Err(Setting {
                    name,
                    value,
                    must: "positive and finite",
                })
            }
        };
        positive("duration", self.duration)?;
        positive("every", self.every)?;
        if self.duration / self.every > MAX_SAMPLES {
            let must = "at least a billionth of the duration";
            return Err(Setting {
                name: "every",
                value: self.every,
                must,
            });
        }
        if self.max_steps == 0 {
            return Err(Setting {
                name: "limit on steps",
                value: 0.0,
                must: "positive",
            });
        }
        match self.method {
            Method::Rk4 { step } => positive("step", step),
            Method::Dopri5(adaptive) => {
                positive("relative tolerance", adaptive.tolerances.relative)?;
                positive(
                    "absolute tolerance of coordinates",
                    adaptive.tolerances.coordinates,
                )?;
                positive(
                    "absolute tolerance of velocities",
                    adaptive.tolerances.velocities,
                )?;
                positive("smallest step", adaptive.smallest_step)?;
                if let Some(step) = adaptive.first_step {
                    positive("first step", step)?;
                }
                let largest = adaptive.largest_step;
                if largest.is_nan() || largest < adaptive.smallest_step {
                    let must = "no smaller than the smallest step";
                    return Err(Setting {
                        name: "largest step",
                        value: largest,
                        must,
                    });
                }
                Ok(())
            }
        }
    }
}

/// More samples than this are a mistake in `every`, not a wish.
const MAX_SAMPLES: f64 = 1e9;
