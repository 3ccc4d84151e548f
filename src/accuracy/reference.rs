//! The reference: a motion that is so accurate that the errors of all other runs can be measured against it.
//!
//! The reference is computed by Dormand–Prince 8(5,3) in double-double arithmetic with kinks located, at decreasing
//! tolerances until the allowed time is over. The difference of the last two solutions bounds the error of the coarser
//! one, and is reported as the error of the reference. If double-doubles would take too long, judged by the measured
//! time of an evaluation, the reference is computed in `f64`; errors below its own are then not known, and the
//! statement says so.

use super::norm::{Names, Norm, StateError};
use super::point::Own;
use super::reading::{self, Reading};
use super::run::{self, states};
use super::setting::{Pace, Setting, time, two_digits};
use crate::equations::Engine;
use crate::orientation::WithoutCharts;
use crate::simulation::Recording;
use bryant_runtime::program::{ErrorKind, Header, Job, RunError, Scalar};
use bryant_runtime::{Adjustable, Formula, Real, Report};
use std::hint::black_box;
use std::time::Instant;

/// A reference with its own errors.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Names and units of the model.
    pub header: Header,
    /// The states of its samples.
    pub states: Vec<Vec<f64>>,
    /// Compares states with the reference.
    norm: Norm,
    /// The readings of the reference.
    pub readings: Vec<Reading>,
    /// The errors of the reference.
    pub own: Own,
    /// A sentence that says how the reference was computed.
    pub statement: String,
    /// The cost of the solution.
    pub report: Report,
    /// The time of its first run, in doubles at a usual tolerance \[s\].
    pub usual: f64,
}

/// Why a reference could not be computed.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    /// The run failed.
    #[error(
        "there is nothing to measure errors against: the reference ({setting}) failed: {}\n  help: {}",
        .error.message, remedy(.error)
    )]
    Run {
        /// The setting of the run.
        setting: String,
        /// The error of the run.
        error: Box<RunError>,
    },
    /// Sharper solutions do not converge.
    #[error(
        "there is nothing to measure errors against: solutions at tolerances {} and {} in double-double differ by {difference:.1e} in \
         the state ({entry})\n  help: the motion depends on its start more sharply than can be computed, or a force jumps where nothing \
         locates it; a shorter --duration may help", .tolerances[0], .tolerances[1]
    )]
    Apart {
        /// Tolerances of the two solutions.
        tolerances: [f64; 2],
        /// Their difference in the state.
        difference: f64,
        /// The entry with this difference.
        entry: String,
    },
}

/// The remedy if the run of the reference failed.
fn remedy(error: &RunError) -> &'static str {
    match error.kind {
        ErrorKind::Time => {
            "give more time with --budget (a third of it is for the reference), or a shorter --duration"
        }
        _ => {
            "`bryant run` with the same options shows how far the scene runs; give a --duration that ends before that"
        }
    }
}

/// Tolerances in double-double arithmetic, from coarse to fine.
const TOLERANCES: [f64; 4] = [1e-9, 1e-12, 1e-15, 1e-18];

/// Tolerances in `f64`, from coarse to fine. The run with the first one shows how many evaluations the scene needs.
const OF_DOUBLES: [f64; 4] = [1e-6, 1e-9, 1e-11, 1e-13];

/// The order of the method: the number of steps is inversely proportional to this root of the tolerance.
const ORDER: f64 = 8.0;

/// Number of evaluations that are timed to find the speed of an arithmetic.
const TRIED: u32 = 20;

/// Largest difference of two solutions that make a reference.
const APART: f64 = 1e-3;

/// A smaller difference is due to rounding of the samples.
const SAMPLE: f64 = 2.0 * f64::EPSILON;

/// Computes the reference of a scene.
///
/// `job` has the settings that are the same in all runs; `patience` is the time limit of one solution \[s\].
///
/// # Errors
/// No reference can be computed; the error says why.
pub fn compute(engine: &Engine, job: &Job, patience: f64) -> Result<Reference, ReferenceError> {
    let start = Instant::now();
    let solve = |scalar: Scalar, tolerance: f64| -> Result<Solution, ReferenceError> {
        let setting = setting(scalar, tolerance);
        let job = Job {
            time_limit: run::limit(2.0 * patience),
            ..setting.job(job)
        };
        let run = run::run(engine, &job);
        match run.result.clone() {
            Ok(report) => Ok(Solution {
                tolerance,
                report,
                run,
            }),
            Err(error) => Err(ReferenceError::Run {
                setting: setting.name(),
                error: Box::new(error),
            }),
        }
    };
    let first = solve(Scalar::F64, OF_DOUBLES[0])?;
    let usual = first.run.wall.as_secs_f64();
    let evaluations = first.report.evaluations as f64;
    let finer = |to: f64| libm::pow(OF_DOUBLES[0] / to, 1.0 / ORDER);
    let of_pair = finer(TOLERANCES[0]) + finer(TOLERANCES[1]);
    let in_double_double = of_pair * evaluations * time_of_evaluation(&*engine.in_double_double());
    let (scalar, tolerances, mut last) = match in_double_double <= patience {
        true => {
            let first = solve(Scalar::DoubleDouble, TOLERANCES[0])?;
            (Scalar::DoubleDouble, &TOLERANCES[1..], first)
        }
        false => (Scalar::F64, &OF_DOUBLES[1..], first),
    };
    let mut check: Option<Solution> = None;
    for &tolerance in tolerances {
        let growth = libm::pow(last.tolerance / tolerance, 1.0 / ORDER);
        let left = patience - start.elapsed().as_secs_f64();
        if check.is_some() && last.run.wall.as_secs_f64() * growth > left {
            break;
        }
        match (solve(scalar, tolerance), &check) {
            (Ok(sharper), _) => check = Some(std::mem::replace(&mut last, sharper)),
            // steps became too small, or the time is over: the solution before is used
            (Err(_), Some(_)) => break,
            (Err(error), None) => return Err(error),
        }
    }
    let check = check.expect("the first of several tolerances is solved for, or an error");
    let mut reference = Reference {
        usual,
        ..assess(last, &check, scalar)?
    };
    if scalar == Scalar::F64 {
        reference.statement += &format!(
            "; double-doubles would take about {}",
            time(two_digits(in_double_double))
        );
    }
    Ok(reference)
}

/// Time of one evaluation of the derivative at the start of a run \[s\].
fn time_of_evaluation<T: Real>(model: &dyn Adjustable<T>) -> f64 {
    let zero = T::from_f64(0.0);
    let mut y = vec![zero; model.info().state_length()];
    let mut rate = y.clone();
    model.initial_state(&mut y);
    model.derivative(zero, &y, &mut rate);
    let start = Instant::now();
    for _ in 0..TRIED {
        model.derivative(zero, black_box(&y), &mut rate);
        black_box(&rate);
    }
    start.elapsed().as_secs_f64() / f64::from(TRIED)
}

/// A run of the reference that reached its end.
struct Solution {
    tolerance: f64,
    report: Report,
    run: Recording,
}

/// The setting of a solution.
fn setting(scalar: Scalar, tolerance: f64) -> Setting {
    Setting {
        formula: Formula::Dop853,
        switches: false,
        pace: Pace::Tolerance(tolerance),
        scalar,
        locate: true,
    }
}

/// The reference that a solution is, judged by a coarser one.
fn assess(
    solution: Solution,
    check: &Solution,
    scalar: Scalar,
) -> Result<Reference, ReferenceError> {
    let [fine, coarse] = [solution.tolerance, check.tolerance];
    let Solution { report, run, .. } = solution;
    let without_charts = WithoutCharts::of(&run.header);
    let names = Names {
        coordinates: &without_charts.coordinates,
        velocities: &without_charts.velocities,
        auxiliaries: &run.header.auxiliaries,
    };
    let states = states(&run);
    let mut reference = Reference {
        norm: Norm::of(names, &states),
        states,
        readings: reading::of(&run.table),
        own: Own::default(),
        statement: String::new(),
        usual: 0.0,
        header: run.header,
        report,
    };
    let (difference, readings) = reference.errors(&check.run);
    if difference.error > APART {
        return Err(ReferenceError::Apart {
            tolerances: [coarse, fine],
            difference: difference.error,
            entry: difference.entry,
        });
    }
    reference.own = Own {
        state: difference.error.max(SAMPLE),
        readings: readings.iter().map(|error| error.max(SAMPLE)).collect(),
    };
    reference.statement = format!(
        "dop853 in {} at tolerance {fine:e}, {} steps, kinks located; at tolerance {coarse:e} it differs by {:.1e} in the state",
        scalar.name(),
        reference.report.steps,
        difference.error
    );
    Ok(reference)
}

impl Reference {
    /// The errors of a run: that of its state, and those of the readings.
    pub fn errors(&self, run: &Recording) -> (StateError, Vec<f64>) {
        let readings = self.readings.iter();
        (
            self.norm.error(&self.states, &states(run)),
            readings.map(|reading| reading.error(&run.table)).collect(),
        )
    }
}
