//! The study: the reference, every setting once for its error, then again and again for its time.
//!
//! Errors are computed on all processors at once. Times are not: one run after the other, in rounds over all points, so that
//! whatever slows the machine down slows all of them down. A point whose run would take longer than the share of the budget
//! that is its is skipped; how long it would take is predicted from its coarser neighbours.

use super::closed_form::ClosedForm;
use super::environment::Environment;
use super::operations::Operations;
use super::plan::{self, Request, Scene, Series};
use super::point::{Done, Measure, Own, Point, Status, Timing, orders};
use super::program;
use super::reading::Reading;
use super::reference::{self, Reference, ReferenceError};
use super::setting::{Curves, Pace, Setting, time, two_digits};
use crate::parallel;
use crate::simulation::ProgramError;
use bryant_generator::model::Model;
use bryant_runtime::program::Job;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What is studied.
#[derive(Clone, Debug)]
pub struct Subject<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its program for every scalar.
    pub program: PathBuf,
    /// The program of the model with its curves exchanged, where there is such a one.
    pub exchanged: Option<PathBuf>,
    /// What is the same in all runs: duration, sampling, parameters.
    pub job: Job,
    /// The values of all parameters, in the model's order.
    pub parameters: Vec<f64>,
}

/// How much is done.
#[derive(Clone, Debug)]
pub struct Effort {
    /// What is run.
    pub request: Request,
    /// Repetitions of a point whose run is short.
    pub repetitions: usize,
    /// How long the runs may take, all together, without the reference \[s\].
    pub budget: f64,
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Study {
    /// Name of the model.
    pub model: String,
    /// Its digest.
    pub digest: String,
    /// Where and by what.
    pub environment: Environment,
    /// Length of the runs \[s\].
    pub duration: f64,
    /// Time between samples \[s\].
    pub every: f64,
    /// Parameters, their values (SI) and units.
    pub parameters: Vec<(String, f64, String)>,
    /// What errors are measured against.
    pub reference: Reference,
    /// The same for the model with its curves exchanged.
    pub exchanged: Option<Exchanged>,
    /// Operations of one evaluation of the derivative.
    pub operations: Operations,
    /// What the diagram and the sentence are about.
    pub of: Measure,
    /// From series to series, from coarse to fine.
    pub points: Vec<Point>,
    /// Time that it all took \[s\].
    pub took: f64,
}

/// The model with its curves exchanged.
#[derive(Clone, Debug)]
pub struct Exchanged {
    /// Its own reference.
    pub reference: Reference,
    /// What the two models differ by in the state.
    pub state: f64,
    /// And in each reading.
    pub readings: Vec<f64>,
}

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The reference is computed.
    Reference,
    /// The errors.
    Errors,
    /// The times.
    Times,
}

/// Why there is no study.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// There is nothing to measure errors against.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// There is no error of what is asked for.
    #[error("{0}")]
    Measure(String),
    /// A program did not do its work.
    #[error(transparent)]
    Program(#[from] ProgramError),
}

/// A run may take this part of the budget: some hundred points, each a few times.
const SHARE: f64 = 1.0 / 400.0;

/// Part of the budget that one solution of the reference may take.
const REFERENCE: f64 = 0.25;

/// Rounds in which all points take part; in further ones only those whose run is short.
const ROUNDS_OF_ALL: usize = 3;

/// A run shorter than this \[s\] is repeated as often as asked for: the scatter of longer ones is small.
const SHORT: f64 = 20e-3;

/// Steps of a run whose neighbour is not known; more are too many for any share.
const FIRST_STEPS: u64 = 200_000;

/// Does the study. `progress` hears of the stage and the part of it that is done.
///
/// # Errors
/// No reference; a program that does not run.
pub fn study(
    subject: &Subject<'_>,
    environment: Environment,
    effort: &Effort,
    of: impl FnOnce(&[Reading]) -> Result<Measure, StudyError>,
    progress: &mut dyn FnMut(Stage, f64),
) -> Result<Study, StudyError> {
    let start = Instant::now();
    let model = subject.model;
    let operations = Operations::of(model);
    progress(Stage::Reference, 0.0);
    let patience = (REFERENCE * effort.budget).max(0.1);
    let closed = ClosedForm::of(model, &subject.parameters);
    let reference = reference::compute(&subject.program, &subject.job, closed, patience)?;
    progress(Stage::Reference, 0.5);
    let exchanged = match &subject.exchanged {
        Some(program) => {
            let own = reference::compute(program, &subject.job, None, patience)?;
            Some(Exchanged::of(&reference, own))
        }
        None => None,
    };
    progress(Stage::Reference, 1.0);
    let scene = Scene {
        kinks: reference.report.events > 0,
        sines: operations.sines > 0,
        curves: exchanged.is_some(),
    };
    let of = of(&reference.readings)?;
    let bench = Bench {
        subject,
        reference: &reference,
        exchanged: exchanged.as_ref(),
        operations,
        limit: SHARE * effort.budget,
    };
    let mut points = bench.errors(&plan::series(&effort.request, scene), progress)?;
    bench.time(&mut points, effort, progress)?;
    let header = &reference.header;
    let parameters = header.parameters.iter().zip(&subject.parameters);
    Ok(Study {
        model: model.name.clone(),
        digest: model.digest.clone(),
        environment,
        duration: subject.job.duration.unwrap_or(header.duration),
        every: subject.job.every.unwrap_or(header.every),
        parameters: parameters
            .map(|(p, value)| (p.name.clone(), *value, p.unit.clone()))
            .collect(),
        operations,
        of,
        points,
        took: start.elapsed().as_secs_f64(),
        exchanged,
        reference,
    })
}

impl Exchanged {
    fn of(written: &Reference, mut own: Reference) -> Exchanged {
        // Read off as the written one is, so that errors stand in the same columns.
        let again = |reading: &Reading| reading.again(&own.trajectory);
        let readings: Vec<Reading> = written.readings.iter().map(again).collect();
        let errors = own.own.readings.iter().copied().fold(0.0, f64::max);
        own.own.readings = readings.iter().map(|_| errors).collect();
        own.readings = readings;
        let difference = |reading: &Reading| {
            let error = reading.error(&written.trajectory, &own.trajectory);
            error.value
        };
        Exchanged {
            state: written
                .norm
                .error(&written.trajectory, &own.trajectory)
                .error,
            readings: written.readings.iter().map(difference).collect(),
            reference: own,
        }
    }
}

impl Study {
    /// The reference of a point's curves, and its own errors.
    pub fn own(&self, curves: Curves) -> &Own {
        match (&self.exchanged, curves) {
            (Some(exchanged), Curves::Exchanged) => &exchanged.reference.own,
            _ => &self.reference.own,
        }
    }
}

/// What all runs are measured with.
struct Bench<'a> {
    subject: &'a Subject<'a>,
    reference: &'a Reference,
    exchanged: Option<&'a Exchanged>,
    operations: Operations,
    /// How long a run may take \[s\].
    limit: f64,
}

impl Bench<'_> {
    fn program(&self, curves: Curves) -> &Path {
        match (curves, &self.subject.exchanged) {
            (Curves::Exchanged, Some(program)) => program,
            _ => &self.subject.program,
        }
    }

    fn reference(&self, curves: Curves) -> &Reference {
        match (curves, self.exchanged) {
            (Curves::Exchanged, Some(exchanged)) => &exchanged.reference,
            _ => self.reference,
        }
    }

    /// Every setting once, series by series on all processors.
    fn errors(
        &self,
        all: &[Series],
        progress: &mut dyn FnMut(Stage, f64),
    ) -> Result<Vec<Point>, StudyError> {
        let series = |series: &Series| self.series(series);
        let points = parallel::map(all, series, &mut |part| progress(Stage::Errors, part));
        let mut flat = Vec::new();
        for series in points {
            flat.extend(series?);
        }
        Ok(flat)
    }

    /// One series, from coarse to fine.
    fn series(&self, series: &Series) -> Result<Vec<Point>, ProgramError> {
        let mut points: Vec<Point> = Vec::new();
        let mut history = History::default();
        for setting in series.settings() {
            let predicted = history.predict(&setting);
            let status = match predicted {
                Some(predicted) if predicted > self.limit => Status::Skipped(format!(
                    "would take about {}, more than the {} that a run may take (--budget)",
                    time(two_digits(predicted)),
                    time(self.limit)
                )),
                _ => self.run(&setting, &mut history)?,
            };
            points.push(Point { setting, status });
        }
        let own = &self.reference(series.of.curves).own;
        let orders = orders(&points.iter().collect::<Vec<_>>(), own);
        for (point, order) in points.iter_mut().zip(orders) {
            if let Status::Done(done) = &mut point.status {
                done.order = order;
            }
        }
        Ok(points)
    }

    fn run(&self, setting: &Setting, history: &mut History) -> Result<Status, ProgramError> {
        let most = history.most_steps(self.limit);
        let job = Job {
            max_steps: Some(most),
            ..setting.job(&self.subject.job)
        };
        let outcome = program::run(self.program(setting.curves), &job)?;
        let report = match outcome.result {
            Ok(report) => report,
            // The limit is this study's, no fault of the setting.
            Err(error) if error.message.contains(&format!("{most} steps")) => {
                return Ok(Status::Skipped(format!(
                    "takes more than {most} steps, which would be more than the {} that a run may take (--budget)",
                    time(self.limit)
                )));
            }
            Err(error) => return Ok(Status::Failed(error.message)),
        };
        history.last = Some(Past {
            pace: setting.pace,
            took: outcome.took.as_secs_f64(),
            steps: report.steps + report.rejected,
        });
        let reference = self.reference(setting.curves);
        let state = reference
            .norm
            .error(&reference.trajectory, &outcome.trajectory);
        let error = |reading: &Reading| reading.error(&reference.trajectory, &outcome.trajectory);
        let header = &reference.header;
        let entries = header.coordinates.len() + header.velocities.len() + header.auxiliaries.len();
        Ok(Status::Done(Box::new(Done {
            state,
            readings: reference.readings.iter().map(error).collect(),
            momentum: outcome
                .energy
                .as_ref()
                .and_then(|energy| energy.momentum_gap),
            energy: outcome.energy.map(|energy| energy.relative_gap()),
            operations: self.operations.of_run(&report, entries),
            report,
            order: None,
            // Until it is timed alone.
            timing: Timing::of(&[outcome.took.as_secs_f64()]),
        })))
    }

    /// Repeats every point that is done, in rounds over all of them.
    fn time(
        &self,
        points: &mut [Point],
        effort: &Effort,
        progress: &mut dyn FnMut(Stage, f64),
    ) -> Result<(), StudyError> {
        let start = Instant::now();
        let mut times: Vec<Vec<f64>> = vec![Vec::new(); points.len()];
        let rounds = effort.repetitions.max(1);
        'rounds: for round in 0..rounds {
            for (point, times) in points.iter().zip(&mut times) {
                let Some(done) = point.done() else { continue };
                let short = times.first().copied().unwrap_or(done.timing.median) < SHORT;
                if round >= ROUNDS_OF_ALL && !short {
                    continue;
                }
                // The first round is complete, whatever it takes.
                if round > 0 && start.elapsed().as_secs_f64() > effort.budget {
                    break 'rounds;
                }
                let job = Job {
                    silent: true,
                    max_steps: None,
                    ..point.setting.job(&self.subject.job)
                };
                let outcome = program::run(self.program(point.setting.curves), &job)?;
                times.push(outcome.took.as_secs_f64());
            }
            progress(Stage::Times, (round + 1) as f64 / rounds as f64);
        }
        for (point, times) in points.iter_mut().zip(&times) {
            if let Status::Done(done) = &mut point.status {
                done.timing = Timing::of(times);
            }
        }
        progress(Stage::Times, 1.0);
        Ok(())
    }
}

/// What the coarser points of a series took.
#[derive(Default)]
struct History {
    last: Option<Past>,
}

struct Past {
    pace: Pace,
    took: f64,
    steps: u64,
}

impl History {
    /// How long a run will take \[s\]: in proportion to the number of fixed steps; with control of the error at least as long,
    /// and no longer where stability and not accuracy bounds the steps.
    fn predict(&self, setting: &Setting) -> Option<f64> {
        let past = self.last.as_ref()?;
        Some(match setting.pace {
            Pace::Step(step) => past.took * past.pace.value() / step,
            Pace::Tolerance(_) => past.took,
        })
    }

    /// Steps after which a run is broken off: those of ten times the limit, as fast as the last one.
    fn most_steps(&self, limit: f64) -> u64 {
        match &self.last {
            Some(past) if past.took > 0.0 && past.steps > 0 => {
                let rate = past.steps as f64 / past.took;
                (10.0 * limit * rate).max(1000.0) as u64
            }
            _ => FIRST_STEPS,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bryant_runtime::Formula;
    use bryant_runtime::program::Scalar;

    fn setting(formula: Formula, pace: Pace) -> Setting {
        Setting {
            formula,
            pace,
            scalar: Scalar::F64,
            locate: true,
            curves: Curves::Written,
        }
    }

    #[test]
    fn times_are_predicted_from_the_coarser_neighbour() {
        let mut history = History::default();
        assert_eq!(
            history.predict(&setting(Formula::Rk4, Pace::Step(1e-4))),
            None
        );
        history.last = Some(Past {
            pace: Pace::Step(1e-3),
            took: 2e-3,
            steps: 100,
        });
        let fixed = history.predict(&setting(Formula::Rk4, Pace::Step(1e-4)));
        assert!((fixed.unwrap() - 2e-2).abs() < 1e-15);
        history.last = Some(Past {
            pace: Pace::Tolerance(1e-2),
            took: 2e-3,
            steps: 100,
        });
        // stability may bound the steps at both tolerances
        let adaptive = history.predict(&setting(Formula::Dop853, Pace::Tolerance(1e-10)));
        assert_eq!(adaptive, Some(2e-3));
        assert_eq!(history.most_steps(0.1), 50_000);
    }
}
