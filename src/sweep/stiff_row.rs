//! Runs a row of a stiff scene alone, because it would take too long in lanes; the method can change to an implicit
//! one.
//!
//! The error is estimated as for a row in lanes ([`rows`](bryant_runtime::batch::rows)): by a run at ten times the
//! tolerances, and by runs at a tenth of the tolerances as long as these are needed and help.

use super::refusal::parameters;
use crate::accuracy::setting::{Pace as OfSetting, Scheme, Setting};
use crate::equations::Engine;
use crate::simulation::{self, Recording};
use bryant_runtime::batch::Pace;
use bryant_runtime::batch::rows::Job;
use bryant_runtime::program::{Job as Single, Reading, Scalar};
use bryant_runtime::response::Answer;

/// The result of a row that was run alone.
pub struct Alone {
    /// The responses; NaN if the run cannot be trusted.
    pub responses: Vec<f64>,
    /// Number of accepted steps.
    pub steps: u64,
    /// Estimated relative error, the largest of all responses; NaN if it is not known or was not requested.
    pub error: f64,
    /// How many times the tolerances were divided by ten.
    pub sharpened: u32,
    /// The reason why the run cannot be trusted.
    pub doubt: Option<String>,
}

/// The factor between the tolerances of two runs that are compared; and the ratio of their difference to the error of
/// the finer run, at least √10 − 1 (as in lanes).
const APART: f64 = 10.0;
const SURELY: f64 = 2.16;
/// Largest number of times that the tolerances are divided by ten.
const AGAIN: u32 = 5;

/// Runs a row alone. `None` if its steps are fixed, its scene is not stiff, or the run does not reach its end.
pub fn alone(engine: &Engine, job: &Job, row: &[f64]) -> Option<Alone> {
    let Pace::Adaptive(tolerances) = job.settings.pace else {
        return None;
    };
    let at = |tolerance: f64| run(engine, job, row, tolerance);
    let mut fine = at(tolerances.relative)?;
    let (mut error, mut sharpened) = (f64::NAN, 0);
    if job.estimate {
        let mut coarse = at(APART * tolerances.relative);
        loop {
            error = coarse
                .as_ref()
                .map_or(f64::NAN, |coarse| apart(&fine, coarse) / SURELY);
            let good = error <= job.wanted || job.wanted == f64::INFINITY;
            if good || sharpened == AGAIN || !fine.doubts.is_empty() {
                break;
            }
            let tolerance = tolerances.relative / libm::pow(APART, f64::from(sharpened) + 1.0);
            let Some(sharper) = at(tolerance) else {
                break;
            };
            coarse = Some(std::mem::replace(&mut fine, sharper));
            sharpened += 1;
        }
    }
    let report = fine.result.as_ref().ok()?;
    let doubt = fine.doubts.first().map(|doubt| doubt.message.clone());
    let value = |answer: &Answer| {
        if doubt.is_none() {
            answer.value
        } else {
            f64::NAN
        }
    };
    Some(Alone {
        responses: match fine.answers.is_empty() {
            true => vec![f64::NAN; job.responses.len()],
            false => fine.answers.iter().map(value).collect(),
        },
        steps: report.steps,
        error,
        sharpened,
        doubt,
    })
}

/// A run at a tolerance; `None` if it did not reach its end, or never used the implicit method.
fn run(engine: &Engine, job: &Job, row: &[f64], tolerance: f64) -> Option<Recording> {
    let settings = &job.settings;
    let setting = Setting {
        formula: Scheme::DEFAULT.formula,
        switches: Scheme::DEFAULT.switches,
        pace: OfSetting::Tolerance(tolerance),
        scalar: Scalar::F64,
        locate: settings.locate,
    };
    let names = engine
        .info()
        .parameters
        .iter()
        .map(|one| one.name.to_owned());
    let single = setting.job(&Single {
        duration: Some(settings.duration),
        // the rows of the table are not used
        every: Some(settings.duration),
        max_steps: Some(settings.max_steps.into()),
        time_limit: settings.time_limit,
        energy_limit: Some(settings.energy_limit),
        parameters: names.zip(parameters(engine, job, row)).collect(),
        reading: Reading {
            intervals: settings.samples as u64 - 1,
            asked: job.responses.clone(),
            ..Reading::default()
        },
        ..Single::default()
    });
    let recording = simulation::run(engine, &single, &mut |_| {});
    let stiff = matches!(&recording.result, Ok(report) if report.stiff > 0);
    stiff.then_some(recording)
}

/// The largest relative difference of the responses; NaN if one of them is NaN.
fn apart(fine: &Recording, coarse: &Recording) -> f64 {
    let pairs = fine.answers.iter().zip(&coarse.answers);
    pairs
        .map(|(fine, coarse)| fine.apart(coarse))
        .fold(0.0, |worst, apart| match apart <= worst {
            true => worst,
            false => apart,
        })
}
