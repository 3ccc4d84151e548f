//! Takes rows of parameters and returns responses: what a study needs of a model.
//!
//! **Estimate of the error.** Each row is run once as asked, and, if its error is to be estimated, once more at ten
//! times the tolerances, or with steps twice as long. Under error control, the error of a run falls like the
//! tolerances, or, at worst, where kinks of force laws are crossed, like their root. So the responses of both runs
//! differ by about √10 − 1 times the error of the finer run, or more. With fixed steps of a method of order p, the
//! errors are c hᵖ and c (2h)ᵖ, and differ by 2ᵖ − 1 times that of the finer run (Richardson 1911); for models with
//! kinks of force laws, over which steps go, the error is only assumed to fall like the step, p = 1. To both, the
//! rounding of steps is added, half an ε of their result each. This is an estimate and no bound: errors of both runs
//! may cancel in the difference, and a motion amplifies rounding.
//!
//! If the estimate is above the wanted error ([`Job::wanted`]), or unknown, a row under error control is run again at a
//! tenth of the tolerances, and compared with the run before; this is repeated as long as it helps.

use super::models::{Doubles, Duals, Models, OfModels, Singles, Source, with_models};
use super::run::run_models;
use super::{Doubt, Ended, Fixed, Pace, Scenarios, Series, Settings, Status};
use crate::response::{Answer, Channel, Response, move_with_jumps, reduce, reduce_with_jumps};
use crate::{Compiled, Dual, Family, Info, Model, Real, Several, Task, Width};

/// What to run for each row.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// The settings of the runs.
    pub settings: Settings,
    /// The parameters that the numbers of a row are, by their index in [`Info::parameters`](crate::Info::parameters).
    pub varied: Vec<usize>,
    /// Parameters with a value other than their default in every row \[SI\].
    pub fixed: Vec<(usize, f64)>,
    /// The responses to compute for each run.
    pub responses: Vec<Asked>,
    /// Whether errors are estimated; every row is then run twice.
    pub estimate: bool,
    /// The wanted error of the responses: rows whose estimate is above are run again with sharper tolerances; +∞ for no
    /// limit. With fixed steps no row is run again.
    pub wanted: f64,
    /// The registers to use.
    pub width: Width,
}

/// A response of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// The signal; runs panic for an output beyond the last of [`Info::outputs`](crate::Info::outputs).
    pub channel: Channel,
    /// The response.
    pub response: Response,
}

impl Asked {
    /// A response of a single unfiltered output, by its index in [`Info::outputs`](crate::Info::outputs).
    pub const fn of(output: usize, response: Response) -> Asked {
        Asked {
            channel: Channel::output(output),
            response,
        }
    }
}

/// How a row ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Whether the run reached its end.
    pub status: Status,
    /// Time reached \[s\].
    pub t: f64,
    /// Steps accepted.
    pub steps: u32,
    /// Steps rejected.
    pub rejected: u32,
    /// The length of the next step, had the run gone on \[s\]; for a run that was given up, it shows what slowed the
    /// run down.
    pub step: f64,
    /// The largest estimated relative error of the responses; NaN if unknown.
    pub error: f64,
    /// How often the row was run again at a tenth of the tolerances, because its error was above the wanted one.
    pub sharpened: u32,
    /// Why a run that reached its end cannot be trusted; for a run that did not, [`Doubt::Unstable`] if its steps were
    /// unstable.
    pub doubt: Option<Doubt>,
}

/// A row whose computation takes long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lingers {
    /// The row, an index in the rows given.
    pub row: usize,
    /// The computing time so far \[s\].
    pub seconds: f64,
    /// The time that its run has reached \[s\].
    pub t: f64,
}

/// The results of rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// How each row ended.
    pub rows: Vec<Row>,
    /// The responses, row by row; NaN where a run did not reach its end, or cannot be trusted.
    pub responses: Vec<f64>,
}

/// A processor without the registers asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoSuchRegisters(pub Width);

impl core::fmt::Display for NoSuchRegisters {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let widths = Width::ALL.into_iter().filter(|width| width.is_available());
        let there: Vec<&str> = widths.map(Width::name).collect();
        let there = there.join(", ");
        write!(
            f,
            "this processor has no registers for {} lanes: there are {there}",
            self.0.name()
        )
    }
}

impl core::error::Error for NoSuchRegisters {}

/// How a row ended, and samples of its outputs, output by output.
pub type Sampled = Result<(Row, Vec<f64>), NoSuchRegisters>;

/// The functions [`rows`] and [`series`] of a generated model, so that a table can hold many models.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// [`rows`]
    pub rows: fn(&Job, &[f64]) -> Result<Results, NoSuchRegisters>,
    /// [`series`]
    pub series: fn(&Job, &[f64], &[usize]) -> Sampled,
}

impl Entry {
    /// The entry of a model.
    pub const fn of<M: Model<f64>>() -> Entry {
        Entry {
            rows: |job, given| rows(&Compiled::<M>::new(), job, given),
            series: |job, row, outputs| series(&Compiled::<M>::new(), job, row, outputs),
        }
    }
}

/// Runs rows with models of a family. Each row has one number per varied parameter \[SI\]. Several threads may share a
/// family.
///
/// # Errors
/// A processor without the registers asked for.
pub fn rows(family: &impl Family, job: &Job, rows: &[f64]) -> Result<Results, NoSuchRegisters> {
    run_rows(family, job, rows, &|_| {})
}

/// [`rows`], with a listener that is told every ten seconds of each row whose computation takes long.
///
/// # Errors
/// A processor without the registers asked for.
pub fn rows_heard(
    family: &impl Family,
    job: &Job,
    rows: &[f64],
    hear: &dyn Fn(Lingers),
) -> Result<Results, NoSuchRegisters> {
    run_rows(family, job, rows, hear)
}

/// [`rows`] in single precision, with twice as many rows in a register: for tolerances of 10⁻⁴ and more
/// ([`run`](super::run())). Estimated errors include rounding, unless both runs of a row happen to be rounded alike.
///
/// # Errors
/// A processor without the registers asked for.
pub fn rows_of_singles(
    family: &impl Family,
    job: &Job,
    rows: &[f64],
) -> Result<Results, NoSuchRegisters> {
    run_rows_of_singles(family, job, rows, &|_| {})
}

/// [`rows_of_singles`] with a listener, as [`rows_heard`].
///
/// # Errors
/// A processor without the registers asked for.
pub fn rows_of_singles_heard(
    family: &impl Family,
    job: &Job,
    rows: &[f64],
    hear: &dyn Fn(Lingers),
) -> Result<Results, NoSuchRegisters> {
    run_rows_of_singles(family, job, rows, hear)
}

/// The samples of outputs of a single row, output by output: to examine a surprising response.
///
/// # Errors
/// A processor without the registers asked for.
pub fn series(family: &impl Family, job: &Job, row: &[f64], outputs: &[usize]) -> Sampled {
    run_series(family, job, row, outputs)
}

/// [`series`] in single precision, as [`rows_of_singles`].
///
/// # Errors
/// A processor without the registers asked for.
pub fn series_of_singles(
    family: &impl Family,
    job: &Job,
    row: &[f64],
    outputs: &[usize],
) -> Sampled {
    run_series_of_singles(family, job, row, outputs)
}

/// Responses of a row, and their derivatives in some directions, a lane for each.
///
/// A direction is a combination of the varied parameters, with one number for each. The errors of derivatives are
/// controlled like those of values, so a direction is best chosen as long as a parameter may change.
///
/// # Errors
/// A processor without the registers asked for.
pub fn gradients(
    family: &impl Family,
    job: &Job,
    row: &[f64],
    directions: &[f64],
) -> Result<Gradients, NoSuchRegisters> {
    gradients_of_doubles(family, job, row, directions)
}

// These are not generic, so they and the time loops in them are compiled in this crate alone.

#[inline(never)]
fn run_rows(
    source: &dyn Source<Doubles>,
    job: &Job,
    rows: &[f64],
    hear: &dyn Fn(Lingers),
) -> Result<Results, NoSuchRegisters> {
    let task = Values { job, rows, hear };
    with_models(job.width, source, task).ok_or(NoSuchRegisters(job.width))
}

#[inline(never)]
fn run_rows_of_singles(
    source: &dyn Source<Singles>,
    job: &Job,
    rows: &[f64],
    hear: &dyn Fn(Lingers),
) -> Result<Results, NoSuchRegisters> {
    let task = Values { job, rows, hear };
    with_models(job.width, source, task).ok_or(NoSuchRegisters(job.width))
}

#[inline(never)]
fn run_series(source: &dyn Source<Doubles>, job: &Job, row: &[f64], outputs: &[usize]) -> Sampled {
    let task = Samples { job, row, outputs };
    with_models(job.width, source, task).ok_or(NoSuchRegisters(job.width))
}

#[inline(never)]
fn run_series_of_singles(
    source: &dyn Source<Singles>,
    job: &Job,
    row: &[f64],
    outputs: &[usize],
) -> Sampled {
    let task = Samples { job, row, outputs };
    with_models(job.width, source, task).ok_or(NoSuchRegisters(job.width))
}

#[inline(never)]
fn gradients_of_doubles(
    source: &dyn Source<Duals<Doubles>>,
    job: &Job,
    row: &[f64],
    directions: &[f64],
) -> Result<Gradients, NoSuchRegisters> {
    let task = Slopes {
        job,
        row,
        directions,
    };
    with_models(job.width, source, task).ok_or(NoSuchRegisters(job.width))
}

/// Responses and their derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradients {
    /// How the run in each direction ended.
    pub rows: Vec<Row>,
    /// The responses of the first; NaN where its run did not reach its end, or cannot be trusted.
    pub values: Vec<f64>,
    /// Their derivatives, direction by direction; NaN where the run in that direction did not reach its end, or cannot
    /// be trusted.
    pub slopes: Vec<f64>,
}

struct Values<'a> {
    job: &'a Job,
    rows: &'a [f64],
    hear: &'a dyn Fn(Lingers),
}

impl<S: Real> OfModels<S> for Values<'_> {
    type Output = Results;
    fn run<T: Several<One = S>>(self, models: Models<'_, T>) -> Results {
        let mut table = Table::over::<T>(self.job, self.rows, |_, value| S::from_f64(value));
        table.hear = Some(self.hear);
        table.run(models);
        table.results()
    }
}

struct Samples<'a> {
    job: &'a Job,
    row: &'a [f64],
    outputs: &'a [usize],
}

impl<S: Real> OfModels<S> for Samples<'_> {
    type Output = (Row, Vec<f64>);
    fn run<T: Several<One = S>>(self, models: Models<'_, T>) -> (Row, Vec<f64>) {
        let job = Job {
            responses: Vec::new(),
            estimate: false,
            wanted: f64::INFINITY,
            ..self.job.clone()
        };
        let mut table = Table::over::<T>(&job, self.row, |_, value| S::from_f64(value));
        table.outputs = self.outputs.to_vec();
        table.keeps = true;
        table.run(models);
        (table.row(0), table.kept)
    }
}

struct Slopes<'a> {
    job: &'a Job,
    row: &'a [f64],
    directions: &'a [f64],
}

impl<S: Real> OfModels<Dual<S>> for Slopes<'_> {
    type Output = Gradients;
    fn run<T: Several<One = Dual<S>>>(self, models: Models<'_, T>) -> Gradients {
        let across = self.job.varied.len().max(1);
        let directions = self.directions.len() / across;
        // the same row for each direction
        let rows = self.row.repeat(directions);
        let seed = |index: usize, value| Dual {
            value: S::from_f64(value),
            slope: S::from_f64(self.directions[index]),
        };
        let mut table = Table::over::<T>(self.job, &rows, seed);
        table.run(models);
        let asked = self.job.responses.len();
        let all = &table.responses;
        let first = all.get(..asked).unwrap_or(&[]);
        // an unknown response has no derivative either
        let slope = |response: &Dual<S>| match response.value.to_f64() {
            value if value.is_nan() => f64::NAN,
            _ => response.slope.to_f64(),
        };
        Gradients {
            rows: (0..directions).map(|row| table.row(row)).collect(),
            values: first.iter().map(|all| all.value.to_f64()).collect(),
            slopes: all.iter().map(slope).collect(),
        }
    }
}

/// Rows as scenarios: one for each row, or two if errors are estimated. Lanes of all widths that have the same scalar
/// share this code.
struct Table<'a, S> {
    job: &'a Job,
    rows: Vec<S>,
    defaults: Vec<S>,
    outputs: Vec<usize>,
    ended: Vec<Option<Ended>>,
    /// The responses, row by row.
    responses: Vec<S>,
    errors: Vec<f64>,
    /// For rows that are run twice, the answers of the run that counts, and of the coarser one.
    pairs: Vec<[Option<Judged>; 2]>,
    /// How often each row was run again, and the rows to run again, in the order in which they are found.
    sharpened: Vec<u32>,
    again: Vec<usize>,
    /// The differences in the last two comparisons of each row that is run again, the last one first.
    before: Vec<[Apart; 2]>,
    scratch: Vec<S>,
    /// The assumed ratio of the difference of both runs of a row to the error of the finer one.
    surely: f64,
    /// The listener for rows whose computation takes long.
    hear: Option<&'a dyn Fn(Lingers)>,
    /// Whether samples are kept.
    keeps: bool,
    kept: Vec<f64>,
    /// The machine epsilon of the scalar.
    epsilon: f64,
    /// Computes a response with the instructions of the lanes.
    reduce: fn(Reduce<'_, S>) -> S,
}

/// Factors of the coarser run: on the tolerances, and on the length of fixed steps.
const COARSER: f64 = 10.0;
const LONGER: f64 = 2.0;
/// A coarser run that takes this many times the steps of the finer one is given up, because it would hold up its lane.
/// The error of the row is then unknown. This concerns two of the 256 rows of the occupant's study (benches/scenes).
const PATIENCE: u64 = 10;
/// A row is run again with the tolerances times SHARPER, at most AGAIN times, as long as two such runs reduce the
/// difference of a response that is not accurate enough to less than HELPS of its former value: at worst, the
/// difference falls like the root of the tolerances. A motion smaller than the tolerances needs more than one such run.
/// Differences are absolute, not relative to the response: for a response that goes to 0, they go to 0 with it.
const SHARPER: f64 = 0.1;
const AGAIN: u32 = 5;
const HELPS: f64 = 0.5;
/// Tolerances below this many roundings are not used.
const ROUNDINGS: f64 = 500.0;
/// The difference between two runs under error control, over the error of the finer one, at least: √10 − 1.
const SURELY: f64 = 2.16;

impl<'a, S: Real> Table<'a, S> {
    /// Rows for lanes of `T`.
    fn over<T: Several<One = S>>(
        job: &'a Job,
        rows: &[f64],
        seed: impl Fn(usize, f64) -> S,
    ) -> Self {
        let rows = rows.iter().enumerate().map(|(i, x)| seed(i, *x)).collect();
        Self::new(job, rows, T::EPSILON, |task| T::dispatch(task))
    }

    fn new(job: &'a Job, rows: Vec<S>, epsilon: f64, reduce: fn(Reduce<'_, S>) -> S) -> Self {
        let across = job.varied.len().max(1);
        let count = match job.varied.len() {
            0 => 1,
            _ => rows.len() / across,
        };
        let of = |asked: &'a Asked| asked.channel.outputs();
        let mut outputs: Vec<usize> = job.responses.iter().flat_map(of).copied().collect();
        outputs.sort_unstable();
        outputs.dedup();
        let scratch = |asked: &Asked| asked.response.scratch(job.settings.samples);
        let scratch = job.responses.iter().map(scratch).max().unwrap_or(0);
        let nan = S::from_f64(f64::NAN);
        Table {
            rows,
            epsilon,
            reduce,
            defaults: Vec::new(),
            ended: vec![None; count],
            responses: vec![nan; count * job.responses.len()],
            errors: vec![f64::NAN; count],
            pairs: vec![[const { None }; 2]; if job.estimate { count } else { 0 }],
            scratch: vec![nan; scratch],
            sharpened: vec![0; if job.estimate { count } else { 0 }],
            again: Vec::new(),
            before: vec![Default::default(); if job.estimate { count } else { 0 }],
            surely: f64::NAN,
            hear: None,
            keeps: false,
            kept: Vec::new(),
            job,
            outputs,
        }
    }

    fn run<T: Several<One = S>>(&mut self, models: Models<'_, T>) {
        self.prepare(models.info);
        run_models(models, &self.job.settings, self);
    }

    /// Sets what depends on the model: defaults and `surely`.
    fn prepare(&mut self, info: &Info) {
        let defaults = info.parameters.iter();
        self.defaults = defaults
            .map(|parameter| S::from_f64(parameter.default))
            .collect();
        for (index, value) in &self.job.fixed {
            if let Some(place) = self.defaults.get_mut(*index) {
                *place = S::from_f64(*value);
            }
        }
        let settings = self.job.settings;
        self.surely = match settings.pace {
            Pace::Adaptive(_) => SURELY,
            Pace::Fixed(Fixed { method, .. }) => {
                let smooth = info.kinks.is_empty();
                let order = if smooth { method.formula().order() } else { 1 };
                whole_power(LONGER, order) - 1.0
            }
        };
    }

    fn row(&self, row: usize) -> Row {
        // every scenario has ended; this default stands for one that has not
        let none = Ended {
            status: Status::Refused,
            t: 0.0,
            steps: 0,
            rejected: 0,
            step: f64::NAN,
            doubt: None,
        };
        let ended = self.ended.get(row).copied().flatten().unwrap_or(none);
        Row {
            status: ended.status,
            t: ended.t,
            steps: ended.steps,
            rejected: ended.rejected,
            step: ended.step,
            error: self.errors.get(row).copied().unwrap_or(f64::NAN),
            sharpened: self.sharpened.get(row).copied().unwrap_or(0),
            doubt: ended.doubt,
        }
    }

    fn results(&self) -> Results {
        Results {
            rows: (0..self.ended.len()).map(|row| self.row(row)).collect(),
            responses: self.responses.iter().map(|x| x.to_f64()).collect(),
        }
    }

    /// The responses of a run that has none: NaN.
    fn nothing(&self) -> Reduced<S> {
        let duration = self.job.settings.duration;
        let nothing = |asked: &Asked| Answer::new(asked.response, f64::NAN, 0.0, duration);
        Reduced {
            responses: vec![S::from_f64(f64::NAN); self.job.responses.len()],
            judged: self.job.responses.iter().map(nothing).collect(),
        }
    }

    /// The responses of a run.
    fn reduced(&mut self, series: &Series<S>) -> Reduced<S> {
        let every = self.job.settings.duration / (self.job.settings.samples - 1) as f64;
        let duration = self.job.settings.duration;
        let outputs = &self.outputs;
        let place = |output: usize| outputs.binary_search(&output).unwrap_or(0);
        let scratch = &mut self.scratch;
        let mut reduced = Reduced {
            responses: Vec::with_capacity(self.job.responses.len()),
            judged: Vec::new(),
        };
        for asked in &self.job.responses {
            let response = asked.response;
            let mut of_samples = |samples: &[S]| {
                (self.reduce)(Reduce {
                    response,
                    samples,
                    every,
                    scratch: &mut *scratch,
                })
            };
            let formed;
            let (value, samples) = match asked.channel.plain() {
                Some(output) => {
                    let samples = series.of(place(output));
                    let jumps: Vec<_> = series.jumps_of(place(output)).collect();
                    let value = match jumps.is_empty() {
                        true => of_samples(samples),
                        false => reduce_with_jumps(response, samples, &jumps, every),
                    };
                    (value, samples)
                }
                None => {
                    let samples = |output: usize| {
                        let mut samples = series.of(place(output)).to_vec();
                        move_with_jumps(&mut samples, series.jumps_of(place(output)), every);
                        samples
                    };
                    formed = asked.channel.form(samples, every).unwrap_or_default();
                    (of_samples(&formed), &formed[..])
                }
            };
            if self.job.estimate {
                let sizes = samples.iter().map(|sample| sample.to_f64().abs());
                let largest = sizes.fold(0.0, f64::max);
                let answer = Answer::new(response, value.to_f64(), largest, duration);
                reduced.judged.push(answer);
            }
            reduced.responses.push(value);
        }
        reduced
    }
}

/// The responses of a run, and the answers by which their errors are judged, if errors are estimated.
struct Reduced<S> {
    responses: Vec<S>,
    judged: Judged,
}

/// For each response its value, and the smallest value that a difference is taken relative to.
type Judged = Vec<Answer>;

/// The differences between two runs of a row: for each response, the absolute and the relative one; NaN if either run
/// has none.
type Apart = Vec<[f64; 2]>;

/// The differences between two runs of a row.
fn apart(fine: &Judged, coarse: &Judged) -> Apart {
    let pairs = fine.iter().zip(coarse);
    pairs
        .map(|(fine, coarse)| [(fine.value - coarse.value).abs(), fine.apart(coarse)])
        .collect()
}

/// The largest relative difference; NaN if any is NaN.
fn largest(apart: &Apart) -> f64 {
    apart.iter().fold(0.0, |worst, [_, difference]| {
        // NaN stays NaN
        match *difference {
            difference if difference <= worst => worst,
            difference => difference,
        }
    })
}

impl<S: Real> Scenarios<S> for Table<'_, S> {
    fn count(&self) -> usize {
        self.ended.len() * (1 + usize::from(self.job.estimate)) + self.again.len()
    }

    fn parameter(&self, scenario: usize, index: usize) -> S {
        let (row, _) = self.which(scenario);
        let across = self.job.varied.len();
        match self.job.varied.iter().position(|varied| *varied == index) {
            Some(place) => self.rows[row * across + place],
            None => self.defaults[index],
        }
    }

    fn level(&self, scenario: usize) -> f64 {
        let (row, turn) = self.which(scenario);
        match (turn, self.job.settings.pace) {
            (RunKind::First, _) => 1.0,
            (RunKind::Coarser, Pace::Adaptive(_)) => COARSER,
            (RunKind::Coarser, Pace::Fixed(_)) => LONGER,
            (RunKind::Sharper, _) => whole_power(SHARPER, self.sharpened[row] + 1),
        }
    }

    /// False for the two runs whose difference is the estimate: the estimate includes the error of their accelerations,
    /// and if it is too large, the sharper runs that follow control accelerations.
    fn controls_accelerations(&self, scenario: usize) -> bool {
        let (_, turn) = self.which(scenario);
        turn == RunKind::Sharper || !self.job.estimate
    }

    fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    fn wants_jumps(&self) -> bool {
        // the time of a jump affects a derivative by the full height of the jump, but a value by no more than sampling
        // does
        S::SLOPES
    }

    fn gives_up(&self, scenario: usize, steps: u64) -> bool {
        let (row, turn) = self.which(scenario);
        let before = self.ended[row].filter(|_| turn != RunKind::First);
        before.is_some_and(|before| {
            let taken = u64::from(before.steps) + u64::from(before.rejected);
            steps > PATIENCE * taken
        })
    }

    fn lingers(&mut self, scenario: usize, seconds: f64, t: f64) {
        if let Some(hear) = self.hear {
            let (row, turn) = self.which(scenario);
            // report only one of the two runs that are computed side by side
            if turn == RunKind::Coarser && self.ended[row].is_none() {
                return;
            }
            hear(Lingers { row, seconds, t });
        }
    }

    fn ended(&mut self, scenario: usize, ended: &Ended, series: &Series<S>) {
        let (row, turn) = self.which(scenario);
        if self.keeps {
            let samples = (0..self.outputs.len()).flat_map(|place| series.of(place));
            self.kept = samples.map(|sample| sample.to_f64()).collect();
        }
        // a coarser run with fixed steps serves the comparison only, whether it is doubtful or not
        let coarse = turn == RunKind::Coarser && matches!(self.job.settings.pace, Pace::Fixed(_));
        let done = ended.status == Status::Done || coarse && ended.status == Status::Doubtful;
        if turn == RunKind::Sharper && !done {
            self.pairs[row] = [None, None];
            // earlier results stay, unless the sharper run shows that the row cannot be trusted
            if ended.status == Status::Doubtful {
                let nothing = self.nothing().responses;
                let start = row * nothing.len();
                self.responses[start..start + nothing.len()].copy_from_slice(&nothing);
                self.ended[row] = Some(*ended);
                self.errors[row] = f64::NAN;
            }
            return;
        }
        let Reduced { responses, judged } = match done {
            true => self.reduced(series),
            false => self.nothing(),
        };
        if turn != RunKind::Coarser {
            self.ended[row] = Some(*ended);
            let start = row * responses.len();
            self.responses[start..start + responses.len()].copy_from_slice(&responses);
        }
        if self.job.estimate {
            self.estimate(row, turn, judged);
        }
    }
}

/// The kind of a run of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunKind {
    /// The run with the settings asked for.
    First,
    /// The run at ten times the tolerances, or with steps twice as long.
    Coarser,
    /// A further run, at a tenth of the tolerances of the run before.
    Sharper,
}

impl<S: Real> Table<'_, S> {
    /// The row of a scenario, and the kind of the run.
    fn which(&self, scenario: usize) -> (usize, RunKind) {
        let rows = self.ended.len();
        match self.job.estimate {
            false => (scenario, RunKind::First),
            true if scenario < 2 * rows => match scenario.is_multiple_of(2) {
                true => (scenario / 2, RunKind::First),
                false => (scenario / 2, RunKind::Coarser),
            },
            true => (self.again[scenario - 2 * rows], RunKind::Sharper),
        }
    }

    /// Takes the answers of a run of a row, and estimates the error once there are two runs.
    fn estimate(&mut self, row: usize, turn: RunKind, judged: Judged) {
        let pair = &mut self.pairs[row];
        match turn {
            RunKind::First => pair[0] = Some(judged),
            RunKind::Coarser => pair[1] = Some(judged),
            RunKind::Sharper => *pair = [Some(judged), pair[0].take()],
        }
        let [Some(fine), Some(coarse)] = pair else {
            return;
        };
        // the run that counts has ended if both have
        let Some(ended) = self.ended[row] else {
            return;
        };
        let rounded = 0.5 * self.epsilon * f64::from(ended.steps);
        let apart = apart(fine, coarse);
        let error_of = |difference: f64| difference / self.surely + rounded;
        let error = error_of(largest(&apart));
        self.errors[row] = error;
        pair[1] = None;
        self.sharpened[row] += u32::from(turn == RunKind::Sharper);
        let wanted = self.job.wanted;
        // an unknown difference counts as helping, and as not good enough
        let [_, twice_before] = &self.before[row];
        let helps = |([now, relative], [then, _]): (&[f64; 2], &[f64; 2])| {
            let unknown = then.is_nan() || *then == 0.0;
            error_of(*relative) > wanted && (unknown || *now < HELPS * then)
        };
        let helps =
            error.is_nan() || twice_before.is_empty() || apart.iter().zip(twice_before).any(helps);
        let sharper = helps && wanted < f64::INFINITY && (error.is_nan() || error > wanted);
        if sharper && ended.status == Status::Done && self.may_be_sharper(row) {
            let [before, twice_before] = &mut self.before[row];
            *twice_before = core::mem::replace(before, apart);
            self.again.push(row);
        } else {
            self.before[row] = Default::default();
            self.pairs[row] = [None, None];
        }
    }

    /// True if a row may be run again at a tenth of the tolerances.
    fn may_be_sharper(&self, row: usize) -> bool {
        let often = self.sharpened[row];
        match self.job.settings.pace {
            Pace::Fixed(_) => false,
            Pace::Adaptive(tolerances) => {
                let sharper = tolerances.relative * whole_power(SHARPER, often + 1);
                often < AGAIN && sharper >= ROUNDINGS * self.epsilon
            }
        }
    }
}

struct Reduce<'a, S> {
    response: Response,
    samples: &'a [S],
    every: f64,
    scratch: &'a mut [S],
}

impl<S: Real> Task for Reduce<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run(self) -> S {
        reduce(self.response, self.samples, self.every, self.scratch)
    }
}

/// An integer power, by products in a fixed order.
fn whole_power(base: f64, exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |power, _| power * base)
}
