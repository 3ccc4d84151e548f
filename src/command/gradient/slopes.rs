//! The derivatives of responses: by dual numbers through the run, and by differences of runs for comparison.
//!
//! Dual numbers go through an explicit method in lanes. A stiff scene would take it too many steps; there the
//! derivatives are differences of runs by the method that changes ([`sweep::alone`]).

use super::table::AGREE;
use crate::accuracy::comparison::PROMISED;
use crate::command::Error;
use crate::command::progress::Progress;
use crate::equations::Engine;
use crate::interrupt;
use crate::sweep::{self, FEW};
use bryant_generator::model::Parameter;
use bryant_runtime::Tolerances;
use bryant_runtime::batch::rows::{Gradients, Job, Row};
use bryant_runtime::batch::{Doubt, Pace, Status};
use bryant_runtime::program::{ErrorKind, RunError};
use std::cell::Cell;
use std::time::Instant;

/// Tolerance if the user gives none.
pub(super) const TOLERANCE: f64 = 1e-8;
/// Tolerance of the runs for difference quotients, and the share of its size by which a parameter is changed to either
/// side. The error of a difference quotient has two parts: the square of the second, and the first divided by the
/// second.
const SHARP: f64 = 1e-12;
const MOVED: f64 = 1e-4;
/// Slopes that are smaller than this share of their response are measured by the response.
pub(super) const SMALL: f64 = 1e-2;
/// Events that happen at the same time are told apart by this share of the size of a parameter, to either side.
const NUDGE: f64 = 1e-7;

/// The size of a parameter's possible change: its value, or a share of the interval between its bounds.
pub(super) fn size(parameter: &Parameter, value: f64) -> f64 {
    match (parameter.min, parameter.max) {
        _ if value != 0.0 => value.abs(),
        (Some(min), Some(max)) if max > min => 0.1 * (max - min),
        _ => 1.0,
    }
}

/// Slopes along directions of these lengths, converted to derivatives.
pub(super) fn by_size(slopes: &[f64], sizes: &[f64], responses: usize) -> Vec<f64> {
    let of = slopes.chunks(responses).zip(sizes);
    of.flat_map(|(slopes, size)| slopes.iter().map(move |slope| slope / size))
        .collect()
}

/// Responses, and slopes along these directions. `None` if that takes more than [`FEW`] steps, where no more are
/// allowed.
fn ask(
    engine: &Engine,
    job: &Job,
    given: &[f64],
    directions: &[f64],
) -> Result<Option<Gradients>, Error> {
    let mut gradients = engine
        .gradients(job, given, directions)
        .map_err(Error::system)?;
    let stopped = |row: &Row| row.status == Status::TooManySteps;
    if job.settings.max_steps <= FEW && gradients.rows.iter().any(stopped) {
        return Ok(None);
    }
    let tied = |row: &Row| row.status == Status::Doubtful && row.doubt == Some(Doubt::Tied);
    for k in 0..gradients.rows.len() {
        if tied(&gradients.rows[k]) {
            let direction = &directions[k * given.len()..][..given.len()];
            untie(engine, job, given, direction, &mut gradients, k)?;
        }
    }
    check(engine, job, given, &gradients)?;
    Ok(Some(gradients))
}

/// Puts in place of a direction in which several events happen at the same time what its slopes are on both sides of
/// the point, where they do not. Events of systems that share nothing have the same effect in either order.
fn untie(
    engine: &Engine,
    job: &Job,
    given: &[f64],
    direction: &[f64],
    gradients: &mut Gradients,
    k: usize,
) -> Result<(), Error> {
    let mut sides = Vec::new();
    for side in [-NUDGE, NUDGE] {
        let moved = given.iter().zip(direction);
        let moved: Vec<f64> = moved.map(|(given, way)| given + side * way).collect();
        let found = engine.gradients(job, &moved, direction);
        let found = found.map_err(Error::system)?;
        // a parameter may be at its bound
        if found.rows[0].status != Status::Refused {
            check(engine, job, &moved, &found)?;
            sides.push(found);
        }
    }
    let ([one, ..], Some(other)) = (&sides[..], sides.last()) else {
        return Ok(());
    };
    if sides.len() < 2 || apart(one, other) > AGREE {
        return Err(Error::failed(
            "several events happen at the same time, and the derivatives are others just before and just after these values of the parameters\n  \
             help: change a parameter a little, so that the events follow each other"
                .into(),
        ));
    }
    let count = one.values.len();
    let mean = |a: &[f64], b: &[f64]| -> Vec<f64> {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| 0.5 * (a + b)).collect()
    };
    gradients.slopes[k * count..][..count].copy_from_slice(&mean(&one.slopes, &other.slopes));
    if k == 0 {
        gradients.values = mean(&one.values, &other.values);
    }
    gradients.rows[k] = one.rows[0];
    Ok(())
}

/// Refuses runs that cannot be trusted.
fn check(engine: &Engine, job: &Job, given: &[f64], gradients: &Gradients) -> Result<(), Error> {
    for row in &gradients.rows {
        let what = match row.status {
            Status::Done => continue,
            Status::NonFinite => "something is not finite",
            Status::StepTooSmall => "the tolerance asks for steps below the smallest",
            Status::TooManySteps => "it takes too many steps",
            Status::Slow => {
                "the computation takes longer than --time-limit, or would take ten times as long at its present rate"
            }
            Status::Doubtful => {
                let why = sweep::doubt(engine, row.doubt);
                let why = why.unwrap_or_else(|| "its result is doubtful".to_owned());
                return Err(Error::failed(format!(
                    "the simulation cannot be trusted: {why}\n  help: `bryant run` with the same parameters says more"
                )));
            }
            Status::Refused => {
                let why = sweep::refusal(engine, job, given);
                let why = why.unwrap_or_else(|| "the parameters are refused".to_owned());
                return Err(Error::Input(format!(
                    "{why}, which is not so with these parameters"
                )));
            }
        };
        return Err(Error::Run(RunError {
            kind: ErrorKind::Run,
            t: Some(row.t),
            coordinate: None,
            cause: String::new(),
            message: format!(
                "the simulation failed at t = {} s: {what}\n  help: `bryant run` with the same parameters says more",
                row.t
            ),
        }));
    }
    Ok(())
}

/// What is differentiated: a model, its run, and the point at which the derivatives are taken.
pub(super) struct Problem<'a> {
    pub engine: &'a Engine,
    pub job: &'a Job,
    /// The parameters, in the order of the derivatives.
    pub parameters: &'a [&'a Parameter],
    /// Their values.
    pub row: &'a [f64],
    /// Whether the scene was found to be stiff.
    pub stiff: Cell<bool>,
}

/// Responses and their derivatives, with an estimate of their error.
pub(super) struct Accurate {
    /// The derivatives, one parameter after the other, each by the [`size`] of its parameter.
    pub gradients: Gradients,
    /// Their estimated error, relative to the largest slope of a response, or to 1 % of the response. NaN if the run
    /// for comparison failed; `None` if an interruption left it out.
    pub error: Option<f64>,
    /// The tolerance of the run.
    pub tolerance: f64,
}

/// Errors fall like the tolerance, at worst like its root: two runs whose tolerances are as 10 to 1 then differ by this
/// many times the error of the sharper one.
const SURELY: f64 = 2.16;
/// No sharper run begins after this time \[s\], or after this many times the time of the first.
const PATIENCE: [f64; 2] = [10.0, 5.0];

impl Problem<'_> {
    /// The size of each parameter.
    pub fn sizes(&self) -> Vec<f64> {
        let values = self.parameters.iter().zip(self.row);
        values.map(|(p, value)| size(p, *value)).collect()
    }

    fn at(&self, tolerance: f64, progress: &Progress) -> Result<Gradients, Error> {
        let directions = each_alone(&self.sizes());
        let mut job = self.job.clone();
        job.settings.pace = Pace::Adaptive(Tolerances::of(tolerance));
        let most = job.settings.max_steps;
        if !self.stiff.get() {
            job.settings.max_steps = most.min(FEW);
            if let Some(found) = slopes(self.engine, &job, self.row, &directions, progress)? {
                return Ok(found);
            }
            job.settings.max_steps = most;
            self.stiff
                .set(sweep::alone(self.engine, &job, self.row).is_some());
        }
        match self.stiff.get() {
            true => self.by_differences(tolerance, progress),
            false => slopes(self.engine, &job, self.row, &directions, progress)?
                .ok_or_else(|| Error::failed("the runs take too many steps".to_owned())),
        }
    }

    /// Responses of a stiff scene at parameters that are moved, by a run alone.
    fn alone(&self, tolerance: f64, moved: &[f64]) -> Result<sweep::Alone, Error> {
        let mut job = self.job.clone();
        job.settings.pace = Pace::Adaptive(Tolerances::of(tolerance));
        let Some(alone) = sweep::alone(self.engine, &job, moved) else {
            return Err(Error::failed(
                "a run with parameters nearby does not come to its end\n  help: `bryant run` with --set says more".to_owned(),
            ));
        };
        match &alone.doubt {
            Some(why) => Err(Error::failed(format!(
                "the simulation cannot be trusted: {why}\n  help: `bryant run` with the same parameters says more"
            ))),
            None => Ok(alone),
        }
    }

    /// Slopes of a stiff scene by differences of runs at a thousandth of the tolerance.
    fn by_differences(&self, tolerance: f64, progress: &Progress) -> Result<Gradients, Error> {
        let tolerance = (1e-3 * tolerance).max(SHARP);
        let here = self.alone(tolerance, self.row)?;
        let done = Row {
            status: Status::Done,
            t: self.job.settings.duration,
            steps: u32::try_from(here.steps).unwrap_or(u32::MAX),
            rejected: 0,
            step: f64::NAN,
            error: f64::NAN,
            sharpened: 0,
            doubt: None,
        };
        let mut all = Gradients {
            rows: Vec::new(),
            values: here.responses,
            slopes: Vec::new(),
        };
        for (i, (parameter, size)) in self.parameters.iter().zip(self.sizes()).enumerate() {
            if interrupt::asked() {
                break;
            }
            let at = |by: f64| {
                let mut moved = self.row.to_vec();
                moved[i] += by;
                self.alone(tolerance, &moved).map(|alone| alone.responses)
            };
            let bounds = [parameter.min, parameter.max];
            let found = difference(at, self.row[i], MOVED * size, bounds)?;
            all.slopes.extend(found.iter().map(|slope| slope * size));
            all.rows.push(done);
            progress.set(all.rows.len() as f64);
        }
        Ok(all)
    }

    /// Slopes at a tolerance, compared with those at ten times the tolerance. If they are not as accurate as promised
    /// and the user gave no tolerance, sharper runs follow.
    pub fn accurately(&self, given: Option<f64>, progress: &Progress) -> Result<Accurate, Error> {
        let begin = Instant::now();
        let mut tolerance = given.unwrap_or(TOLERANCE);
        let mut gradients = self.at(tolerance, progress)?;
        let longest = PATIENCE[0].max(PATIENCE[1] * begin.elapsed().as_secs_f64());
        if interrupt::asked() {
            return Ok(Accurate {
                gradients,
                error: None,
                tolerance,
            });
        }
        // a tolerance must be below 1
        let other = match tolerance < 0.1 {
            true => 10.0 * tolerance,
            false => 0.1 * tolerance,
        };
        let coarse = self.at(other, progress);
        let mut error = coarse.map_or(f64::NAN, |coarse| apart(&gradients, &coarse) / SURELY);
        while (error.is_nan() || error > PROMISED)
            && given.is_none()
            && tolerance > SHARP
            && begin.elapsed().as_secs_f64() < longest
            && !interrupt::asked()
        {
            let Ok(sharper) = self.at(0.1 * tolerance, progress) else {
                break;
            };
            if sharper.rows.len() < gradients.rows.len() {
                break;
            }
            error = apart(&sharper, &gradients) / SURELY;
            (gradients, tolerance) = (sharper, 0.1 * tolerance);
        }
        Ok(Accurate {
            gradients,
            error: Some(error),
            tolerance,
        })
    }

    /// Derivatives by difference quotients of sharper runs, for as many parameters as time allows: central differences,
    /// or at a bound one-sided differences of the same order.
    pub fn differences(&self, progress: &Progress) -> Result<Vec<f64>, Error> {
        let mut job = self.job.clone();
        job.settings.pace = Pace::Adaptive(Tolerances::of(SHARP));
        let still = vec![0.0; self.row.len()];
        let mut slopes = Vec::new();
        for (i, (parameter, size)) in self.parameters.iter().zip(self.sizes()).enumerate() {
            let at = |by: f64| {
                let mut moved = self.row.to_vec();
                moved[i] += by;
                if self.stiff.get() {
                    return self.alone(SHARP, &moved).map(|alone| alone.responses);
                }
                let found = ask(self.engine, &job, &moved, &still)?;
                Ok(found.map_or_else(Vec::new, |found| found.values))
            };
            if interrupt::asked() {
                break;
            }
            let bounds = [parameter.min, parameter.max];
            // the derivatives of a stiff scene are differences themselves, over other steps
            let step = if self.stiff.get() {
                10.0 * MOVED
            } else {
                MOVED
            };
            slopes.extend(difference(at, self.row[i], step * size, bounds)?);
            progress.set((i + 1) as f64);
        }
        Ok(slopes)
    }
}

/// The difference of the slopes and responses of two runs, relative to the largest slope of each response, or to 1 % of
/// the response if that is larger.
fn apart(fine: &Gradients, coarse: &Gradients) -> f64 {
    let responses = fine.values.len();
    let mut worst = 0.0;
    for k in 0..responses {
        let of = |g: &Gradients| -> Vec<f64> {
            g.slopes
                .iter()
                .skip(k)
                .step_by(responses)
                .copied()
                .collect()
        };
        let [a, b] = [of(fine), of(coarse)];
        let largest = a
            .iter()
            .chain(&b)
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        let value = fine.values[k].abs().max(coarse.values[k].abs());
        let size = largest.max(SMALL * value).max(f64::MIN_POSITIVE);
        let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs() / size);
        let of_value =
            (fine.values[k] - coarse.values[k]).abs() / value.max(largest).max(f64::MIN_POSITIVE);
        for difference in differences.chain([of_value]) {
            // a NaN stays
            if difference.is_nan() || difference > worst {
                worst = difference;
            }
        }
    }
    worst
}

/// A direction for each parameter: along this parameter only, with its size as the length.
fn each_alone(sizes: &[f64]) -> Vec<f64> {
    let mut directions = vec![0.0; sizes.len() * sizes.len()];
    for (i, size) in sizes.iter().enumerate() {
        directions[i * sizes.len() + i] = *size;
    }
    directions
}

/// Responses, and slopes in as many of the directions as time allows, `None` as [`ask`]; as many run side by side as a
/// register holds.
fn slopes(
    engine: &Engine,
    job: &Job,
    row: &[f64],
    directions: &[f64],
    progress: &Progress,
) -> Result<Option<Gradients>, Error> {
    let mut all = Gradients {
        rows: Vec::new(),
        values: Vec::new(),
        slopes: Vec::new(),
    };
    for some in directions.chunks(job.width.lanes() * row.len()) {
        if interrupt::asked() {
            break;
        }
        let Some(found) = ask(engine, job, row, some)? else {
            return Ok(None);
        };
        all.values = found.values;
        all.rows.extend(found.rows);
        all.slopes.extend(found.slopes);
        progress.set(all.rows.len() as f64);
    }
    Ok(Some(all))
}

/// Difference quotients of the function `at` of a parameter's change, of second order in the step, within the bounds of
/// the parameter.
pub fn difference(
    at: impl Fn(f64) -> Result<Vec<f64>, Error>,
    value: f64,
    step: f64,
    [min, max]: [Option<f64>; 2],
) -> Result<Vec<f64>, Error> {
    let allowed = |by: f64| {
        min.is_none_or(|min| value + by >= min) && max.is_none_or(|max| value + by <= max)
    };
    if allowed(step) && allowed(-step) {
        let (right, left) = (at(step)?, at(-step)?);
        let pairs = right.iter().zip(&left);
        return Ok(pairs
            .map(|(right, left)| (right - left) / (2.0 * step))
            .collect());
    }
    let step = if allowed(step) { step } else { -step };
    let (here, near, far) = (at(0.0)?, at(step)?, at(2.0 * step)?);
    let triples = here.iter().zip(&near).zip(&far);
    Ok(triples
        .map(|((here, near), far)| (4.0 * near - 3.0 * here - far) / (2.0 * step))
        .collect())
}
