//! The study: computes the reference, then runs each setting once for its error, and again repeatedly for its time.
//!
//! The study has a budget of time: a third for the reference, a third for errors, the rest for times. Time that one
//! part does not need goes to the next.
//!
//! Errors are computed on all processors at once, in the order of `schedule`: first the coarse end of each series, then
//! more points near the front of accuracy against time. A run that exceeds its time limit is stopped. Times are
//! measured one run after another, in rounds over the points, those nearest to the front first, so that a disturbance
//! of the machine slows all of them down.

use super::conclusion::bounded_by_stability;
use super::fastest_motion::{Fastest, fastest};
use super::front::Cost;
use super::plan::{self, ModelFeatures, Request, Series};
use super::point::{Done, Measure, Point, Status, Timing, orders};
use super::reading::Reading;
use super::reference::{self, Reference, ReferenceError};
use super::run;
use super::schedule::{self, Schedule, distance};
use super::setting::{Setting, time, two_digits};
use crate::equations::Engine;
use crate::interrupt;
use bryant_generator::model::Model;
use bryant_generator::{dynamics, program};
use bryant_runtime::program::{ErrorKind, Job};
use std::time::Instant;

/// The subject of a study.
pub struct Subject<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its equations, over every scalar.
    pub engine: &'a Engine,
    /// The settings that are the same in all runs: duration, sampling, parameters.
    pub job: Job,
    /// The values of all parameters, in the model's order.
    pub parameters: Vec<f64>,
}

/// The effort of a study.
#[derive(Clone, Debug)]
pub struct Effort {
    /// The settings that are run.
    pub request: Request,
    /// Number of repetitions for points with short runs.
    pub repetitions: usize,
    /// Time for all runs together, without the reference \[s\].
    pub budget: f64,
}

/// The result of a study.
#[derive(Clone, Debug)]
pub struct Study {
    /// Name of the model.
    pub model: String,
    /// Its digest.
    pub digest: String,
    /// The evaluation of equations: "machine code (AVX2)".
    pub engine: String,
    /// Length of the runs \[s\].
    pub duration: f64,
    /// Time between samples \[s\].
    pub every: f64,
    /// Parameters and their values (SI).
    pub parameters: Vec<(String, f64)>,
    /// The reference that errors are measured against.
    pub reference: Reference,
    /// The kind of error in the diagram and the sentence.
    pub of: Measure,
    /// The points, series by series, each from coarse to fine.
    pub points: Vec<Point>,
    /// The fastest motion, if stability limits the steps of a method.
    pub fastest: Option<Fastest>,
    /// True if Ctrl-C was pressed before the study was complete.
    pub interrupted: bool,
    /// Total time of the study \[s\].
    pub took: f64,
}

/// The stage of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The reference is computed.
    Reference,
    /// The errors are computed.
    Errors,
    /// The times are measured.
    Times,
}

/// Why a study could not be made.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// There is no reference to measure errors against.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// The requested kind of error does not exist.
    #[error("{0}")]
    Measure(String),
}

/// The share of the budget for the reference; and for reference and errors together.
const REFERENCE: f64 = 1.0 / 3.0;
const ERRORS: f64 = 2.0 / 3.0;

/// Time limit of one run: this share of the budget, or this multiple of the time of a usual run, if that is more.
const SHARE: f64 = 1.0 / 20.0;
const USUAL: f64 = 3.0;

/// Number of rounds with all points; later rounds have only points with short runs.
const ROUNDS_OF_ALL: usize = 3;

/// Length of a run below which it is repeated as often as requested \[s\]; the times of longer runs scatter little.
const SHORT: f64 = 20e-3;

/// Carries out the study. `of` chooses the kind of error from the readings. `progress` is called with the stage and the
/// share of it that is done.
///
/// # Errors
/// There is no reference, or the requested kind of error does not exist.
pub fn study(
    subject: &Subject<'_>,
    effort: &Effort,
    of: impl FnOnce(&[Reading]) -> Result<Measure, StudyError>,
    progress: &mut dyn FnMut(Stage, f64),
) -> Result<Study, StudyError> {
    let start = Instant::now();
    let model = subject.model;
    progress(Stage::Reference, 0.0);
    let clock = Clock {
        start,
        budget: effort.budget,
    };
    let reference = reference::compute(subject.engine, &subject.job, clock.left(REFERENCE))?;
    progress(Stage::Reference, 1.0);
    let scene = ModelFeatures {
        kinks: reference.report.events > 0,
        sines: has_sines(model),
    };
    let of = of(&reference.readings)?;
    let bench = Bench {
        subject,
        reference: &reference,
        of,
        clock,
    };
    let mut points = bench.errors(&plan::series(&effort.request, scene), progress);
    bench.time(&mut points, effort, progress);
    let header = &reference.header;
    let parameters = header.parameters.iter().zip(&subject.parameters);
    let mut study = Study {
        model: model.name.clone(),
        digest: model.digest.clone(),
        engine: subject.engine.arithmetic().to_owned(),
        duration: subject.job.duration.unwrap_or(header.duration),
        every: subject.job.every.unwrap_or(header.every),
        parameters: parameters
            .map(|(p, value)| (p.name.clone(), *value))
            .collect(),
        of,
        points,
        took: 0.0,
        fastest: None,
        interrupted: interrupt::asked(),
        reference,
    };
    if !bounded_by_stability(&study).is_empty() && !study.interrupted {
        let patience = 0.1 * effort.budget;
        study.fastest = fastest(subject.engine, &subject.job, &subject.parameters, patience);
    }
    study.took = start.elapsed().as_secs_f64();
    Ok(study)
}

/// True if an evaluation of the derivative has sines or cosines.
fn has_sines(model: &Model) -> bool {
    let options = dynamics::Options {
        matrices: false,
        ..dynamics::Options::default()
    };
    let emitted = program::Options {
        matrices: false,
        ..program::Options::default()
    };
    let equations = dynamics::derive_with(model, options);
    let costs = program::costs_of(model, &equations, &emitted, Some(&["accelerations"]));
    costs
        .iter()
        .any(|(_, cost)| cost.total.sin + cost.total.cos > 0)
}

/// Runs settings and measures their errors and times.
struct Bench<'a> {
    subject: &'a Subject<'a>,
    reference: &'a Reference,
    of: Measure,
    clock: Clock,
}

impl Bench<'_> {
    /// Runs each setting once, as far as the budget allows. The points are in the order of the series, each from coarse
    /// to fine.
    fn errors(&self, all: &[Series], progress: &mut dyn FnMut(Stage, f64)) -> Vec<Point> {
        let end = self.clock.left(ERRORS);
        let usual = self.reference.usual;
        let limit = (SHARE * self.clock.budget).max(USUAL * usual);
        let schedule = Schedule::new(all, limit, end).expecting(usual);
        let run = |setting: &Setting, limit: f64| {
            let status = self.run(setting, limit);
            let cost = self.cost(&status);
            (status, cost)
        };
        let mut points = schedule.carry_out(&run, &mut |part| progress(Stage::Errors, part));
        for series in points.chunk_by_mut(|a, b| a.setting.same_series(&b.setting)) {
            let orders = orders(&series.iter().collect::<Vec<_>>(), &self.reference.own);
            for (point, order) in series.iter_mut().zip(orders) {
                if let Status::Done(done) = &mut point.status {
                    done.order = order;
                }
            }
        }
        points
    }

    /// The error and the time of a run; infinite if the run has no result.
    fn cost(&self, status: &Status) -> Cost {
        match status {
            Status::Done(done) => Cost {
                error: done.error(self.of, &self.reference.own).error,
                time: done.timing.median,
            },
            _ => Cost {
                error: f64::INFINITY,
                time: f64::INFINITY,
            },
        }
    }

    /// Runs a setting with this time limit \[s\].
    fn run(&self, setting: &Setting, limit: f64) -> Status {
        let job = Job {
            time_limit: run::limit(limit),
            ..setting.job(&self.subject.job)
        };
        let outcome = run::run(self.subject.engine, &job);
        let report = match &outcome.result {
            Ok(report) => *report,
            // the time limit is due to the budget, so the setting counts as skipped instead of failed
            Err(error) if error.kind == ErrorKind::Time => {
                return Status::Skipped(format!(
                    "stopped after {}, its share of the time (--budget)",
                    time(two_digits(limit))
                ));
            }
            Err(error) if error.kind == ErrorKind::Stopped => {
                return Status::Skipped(schedule::INTERRUPTED.to_owned());
            }
            Err(error) => return Status::Failed(error.message.clone()),
        };
        let (state, readings) = self.reference.errors(&outcome);
        Status::Done(Box::new(Done {
            state,
            readings,
            momentum: outcome
                .energy
                .as_ref()
                .and_then(|energy| energy.momentum_gap),
            energy: outcome.energy.map(|energy| energy.relative_gap()),
            report,
            order: None,
            // a first value, until the run is timed alone
            timing: Timing::of(&[outcome.wall.as_secs_f64()]),
        }))
    }

    /// Measures the times of the points that are done, in rounds, those nearest to the front first.
    fn time(&self, points: &mut [Point], effort: &Effort, progress: &mut dyn FnMut(Stage, f64)) {
        let costs: Vec<Cost> = points
            .iter()
            .map(|point| self.cost(&point.status))
            .collect();
        let mut order: Vec<usize> = (0..points.len())
            .filter(|&i| points[i].done().is_some())
            .collect();
        order.sort_by(|&a, &b| distance(&costs, a).total_cmp(&distance(&costs, b)));
        let mut times: Vec<Vec<f64>> = vec![Vec::new(); points.len()];
        let rounds = effort.repetitions.max(1);
        'rounds: for round in 0..rounds {
            for (place, &index) in order.iter().enumerate() {
                let point = &points[index];
                let Some(done) = point.done() else { continue };
                let took = times[index].first().copied();
                let took = took.unwrap_or(done.timing.median);
                if round >= ROUNDS_OF_ALL && took >= SHORT {
                    continue;
                }
                let rest = self.clock.rest(1.0);
                if took > rest || interrupt::asked() {
                    break 'rounds;
                }
                let job = Job {
                    silent: true,
                    time_limit: run::limit(rest),
                    ..point.setting.job(&self.subject.job)
                };
                let outcome = run::run(self.subject.engine, &job);
                if interrupt::asked() {
                    break 'rounds;
                }
                // the run failed this time: the earlier measurements remain
                if outcome.result.is_err() {
                    continue;
                }
                times[index].push(outcome.wall.as_secs_f64());
                let part = (place + 1) as f64 / order.len() as f64;
                progress(Stage::Times, (round as f64 + part) / rounds as f64);
            }
        }
        for (point, times) in points.iter_mut().zip(&times) {
            if let Status::Done(done) = &mut point.status
                && !times.is_empty()
            {
                done.timing = Timing::of(times);
            }
        }
        progress(Stage::Times, 1.0);
    }
}

/// The budget and the time when it began.
#[derive(Clone, Copy, Debug)]
struct Clock {
    start: Instant,
    /// The whole budget \[s\].
    budget: f64,
}

impl Clock {
    /// The time that is left of the share `part` of the budget \[s\]; negative if more was used.
    fn rest(&self, part: f64) -> f64 {
        part * self.budget - self.start.elapsed().as_secs_f64()
    }

    /// The time that is left of the share `part` of the budget \[s\], but at least a hundredth of the whole budget.
    fn left(&self, part: f64) -> f64 {
        self.rest(part).max(0.01 * self.budget)
    }
}
