//! Jobs as several cases ask for them, and what a check calls them.

use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Method, Tolerances};

/// Steps of this length \[s\]; all else as the scene says.
pub fn fixed(formula: Formula, step: f64) -> Job {
    Job {
        method: Some(Method::fixed(formula, step)),
        ..Job::default()
    }
}

/// So many steps of this length \[s\], with so many samples at even distances.
pub fn many(formula: Formula, step: f64, count: f64, samples: f64) -> Job {
    Job {
        duration: Some(step * count),
        every: Some(step * count / samples),
        // a few more are taken where rounding leaves a rest
        max_steps: Some(2 * count as u64),
        ..fixed(formula, step)
    }
}

/// Steps under control of their error; all else as the scene says.
pub fn adaptive(formula: Formula, tolerances: Tolerances) -> Job {
    Job {
        method: Some(Method::adaptive(formula, tolerances)),
        ..Job::default()
    }
}

/// The same, with kinks of force laws located or passed.
pub fn with_kinks(formula: Formula, tolerances: Tolerances, locate: bool) -> Job {
    Job {
        locate: Some(locate),
        ..adaptive(formula, tolerances)
    }
}

/// "dopri5 at 1e-9".
pub fn name(formula: Formula, tolerance: f64) -> String {
    format!("{formula} at {tolerance:e}")
}

/// "dopri5 at 1e-9, kinks located".
pub fn name_with_kinks(formula: Formula, tolerance: f64, locate: bool) -> String {
    let kinks = if locate { "located" } else { "passed" };
    format!("{}, kinks {kinks}", name(formula, tolerance))
}
