//! Jobs that several cases use, and their names.

use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};

/// A job with fixed steps of this length \[s\], and otherwise the settings of the scene.
pub fn fixed(formula: Formula, step: f64) -> Job {
    Job {
        method: Some(Integrator::fixed(formula, step)),
        ..Job::default()
    }
}

/// A job with `count` fixed steps of this length \[s\], and `samples` samples at equal intervals.
pub fn many(formula: Formula, step: f64, count: f64, samples: f64) -> Job {
    Job {
        duration: Some(step * count),
        every: Some(step * count / samples),
        // rounding may cause a few more steps
        max_steps: Some(2 * count as u64),
        ..fixed(formula, step)
    }
}

/// A job with steps by error control, and otherwise the settings of the scene.
pub fn adaptive(formula: Formula, tolerances: Tolerances) -> Job {
    Job {
        method: Some(Integrator::adaptive(formula, tolerances)),
        ..Job::default()
    }
}

/// A job with steps by error control in which kinks of force laws are located (`locate`) or passed.
pub fn with_kinks(formula: Formula, tolerances: Tolerances, locate: bool) -> Job {
    Job {
        locate: Some(locate),
        ..adaptive(formula, tolerances)
    }
}

/// The name of a job: "dopri5 at 1e-9".
pub fn name(formula: Formula, tolerance: f64) -> String {
    format!("{formula} at {tolerance:e}")
}

/// The name of a job: "dopri5 at 1e-9, kinks located".
pub fn name_with_kinks(formula: Formula, tolerance: f64, locate: bool) -> String {
    let kinks = if locate { "located" } else { "passed" };
    format!("{}, kinks {kinks}", name(formula, tolerance))
}
