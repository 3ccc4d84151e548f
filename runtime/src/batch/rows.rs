//! Rows of parameters in, responses out: what a study needs of a model.
//!
//! Each row is run once as asked, and once more at ten times the tolerances, or with steps twice as long, where its error is to be
//! estimated. Under control of the error, that of a run falls like its tolerances, and at the worst, where kinks of force laws are crossed,
//! like their root: what the responses of both differ by is then about √10 − 1 times the error of the one that counts, or more. With fixed
//! steps of a method of order p, the errors are as c hᵖ and c (2h)ᵖ, and differ by 2ᵖ − 1 times the one that counts (Richardson 1911); of
//! models with kinks of force laws, over which steps go, no more is taken for granted than that the error falls like the step, p = 1. To
//! either comes what steps round off, half an ε each of what they lead to. It is an estimate and no bound: errors of both may cancel in a
//! difference, and a motion amplifies what was rounded.
//!
//! Where that estimate is above what is wanted ([`Job::wanted`]), or not known, a row under control of the error is run again at a tenth of the
//! tolerances, and compared with the run before; and so on, as long as that helps.

use super::models::{Doubles, Duals, Models, OfModels, Singles, Source, with_models};
use super::run::run_models;
use super::{Doubt, Ended, Fixed, Pace, Scenarios, Series, Settings, Status};
use crate::response::{Answer, Channel, Response, move_with_jumps, reduce, reduce_with_jumps};
use crate::{Compiled, Dual, Family, Info, Model, Real, Several, Task, Width};

/// What to run of each row.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// How to run.
    pub settings: Settings,
    /// Which parameters the numbers of a row are, by their index in [`Info::parameters`](crate::Info::parameters).
    pub varied: Vec<usize>,
    /// Parameters that have another value than their default in every row \[SI\].
    pub fixed: Vec<(usize, f64)>,
    /// What is asked of each run.
    pub responses: Vec<Asked>,
    /// Whether errors are estimated, for which every row is run twice.
    pub estimate: bool,
    /// The error that is wanted of the responses: rows whose estimate is above are run again, sharper; +∞ for any. With fixed steps none is.
    pub wanted: f64,
    /// The registers to use.
    pub width: Width,
}

/// A response of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Of which outputs it is; runs panic beyond the last of [`Info::outputs`](crate::Info::outputs).
    pub channel: Channel,
    /// What is asked of it.
    pub response: Response,
}

impl Asked {
    /// A response of an output as it is, by its index in [`Info::outputs`](crate::Info::outputs).
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
    /// Whether it reached its end.
    pub status: Status,
    /// Time reached \[s\].
    pub t: f64,
    /// Steps accepted.
    pub steps: u32,
    /// Steps rejected.
    pub rejected: u32,
    /// The step that would have come next \[s\]; of a run that gave up it says what kept it.
    pub step: f64,
    /// Estimated relative error of the responses, the largest; NaN where it is not known.
    pub error: f64,
    /// How often it was run again at a tenth of the tolerances, for its error was above what is wanted.
    pub sharpened: u32,
    /// Why a run that reached its end cannot be trusted; or of one that did not, that its steps were unstable.
    pub doubt: Option<Doubt>,
}

/// A row whose computation takes long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lingers {
    /// Which, an index in the rows given.
    pub row: usize,
    /// How long it has taken \[s\].
    pub seconds: f64,
    /// The time that its run has come to \[s\].
    pub t: f64,
}

/// What became of rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// How each ended.
    pub rows: Vec<Row>,
    /// The responses, row by row; NaN where a run did not reach its end, or cannot be trusted.
    pub responses: Vec<f64>,
}

/// A processor without the registers asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoSuchRegisters(pub Width);

impl core::fmt::Display for NoSuchRegisters {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let widths = Width::ALL.into_iter().filter(|width| width.there());
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

/// Rows and series of a generated model, so that a table can hold many.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// [`rows`]
    pub rows: fn(&Job, &[f64]) -> Result<Results, NoSuchRegisters>,
    /// [`series`]
    pub series: fn(&Job, &[f64], &[usize]) -> Sampled,
}

impl Entry {
    /// That of a model.
    pub const fn of<M: Model<f64>>() -> Entry {
        Entry {
            rows: |job, given| rows(&Compiled::<M>::new(), job, given),
            series: |job, row, outputs| series(&Compiled::<M>::new(), job, row, outputs),
        }
    }
}

/// Runs rows of as many numbers as parameters are varied \[SI\], with models of a family. Several threads may share a family.
///
/// # Errors
/// A processor without the registers asked for.
pub fn rows(family: &impl Family, job: &Job, rows: &[f64]) -> Result<Results, NoSuchRegisters> {
    run_rows(family, job, rows, &|_| {})
}

/// The same; whoever listens is told of rows whose computation takes long, every ten seconds of each.
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

/// The same in single precision, with twice as many rows in a register: for tolerances from 10⁻⁴ up ([`run`](super::run())). Errors that
/// are estimated hold rounding too, where it is more than chance that both runs of a row are rounded alike.
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

/// The same, heard as [`rows_heard`].
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

/// The samples of outputs of a single row, output by output: for those to look at who wonder about a response.
///
/// # Errors
/// A processor without the registers asked for.
pub fn series(family: &impl Family, job: &Job, row: &[f64], outputs: &[usize]) -> Sampled {
    run_series(family, job, row, outputs)
}

/// The same in single precision, as [`rows_of_singles`].
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
/// Directions are combinations of the varied parameters, as many numbers each. Errors of derivatives are controlled like those of values,
/// so a direction is best as long as a parameter may change.
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
    /// Their derivatives, direction by direction; NaN where the run in that direction did not reach its end, or cannot be trusted.
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
        // what is not known has no derivative either
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

/// Rows as scenarios: one each, or two where errors are estimated. Lanes of all widths share the code for one of their scalars.
struct Table<'a, S> {
    job: &'a Job,
    rows: Vec<S>,
    defaults: Vec<S>,
    outputs: Vec<usize>,
    ended: Vec<Option<Ended>>,
    /// Row by row.
    responses: Vec<S>,
    errors: Vec<f64>,
    /// Of rows that are run twice, what is known of the run that counts, and of the coarser one.
    pairs: Vec<[Option<Judged>; 2]>,
    /// How often each row was run again, and the rows that are, one after the other as they are found.
    sharpened: Vec<u32>,
    again: Vec<usize>,
    /// What the last two comparisons of each row that is run again found, the last one first.
    before: Vec<[Apart; 2]>,
    scratch: Vec<S>,
    /// What both runs of a row differ by is about so many times the error of the finer one.
    surely: f64,
    /// Who is told of rows whose computation takes long.
    hear: Option<&'a dyn Fn(Lingers)>,
    /// Whether samples are kept.
    keeps: bool,
    kept: Vec<f64>,
    /// The distance from 1 to the next number.
    epsilon: f64,
    /// Computes a response with the instructions of the lanes.
    reduce: fn(Reduce<'_, S>) -> S,
}

/// The coarser run has so many times the tolerance, or steps so many times as long.
const COARSER: f64 = 10.0;
const LONGER: f64 = 2.0;
/// A coarser run that takes this many times the steps of the finer one is given up, for it would hold up its lane. The error of the row is
/// then not known. Of the 256 rows of the occupant's study (benches/scenes) two are.
const PATIENCE: u64 = 10;
/// A row is run again at so many times the tolerances, as often as this, as long as two of these runs take the difference of a response that is not
/// accurate enough to less than so much of what it was: at the worst it falls like the root of the tolerances. A motion that is smaller than what
/// tolerances let pass needs more than one. Differences are taken as they are, not relative to the response: of a response that goes to 0, they
/// go to 0 with it.
const SHARPER: f64 = 0.1;
const AGAIN: u32 = 5;
const HELPS: f64 = 0.5;
/// Tolerances below so many roundings are not asked for.
const ROUNDINGS: f64 = 500.0;
/// Of runs with tolerances, what both differ by is about so many times the error of the finer one, or more: √10 − 1.
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
        self.prepare(models.info());
        run_models(models, &self.job.settings, self);
    }

    /// What depends on the model.
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
        // every scenario ended; this is what a row would be that did not
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

    /// Those of a run that has none.
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

/// The responses of a run, and what their errors are judged by where they are estimated.
struct Reduced<S> {
    responses: Vec<S>,
    judged: Judged,
}

/// Of each response its value, and the least that a difference is taken relative to.
type Judged = Vec<Answer>;

/// What two runs of a row differ by: of each response, as it is and relatively; NaN where either has none.
type Apart = Vec<[f64; 2]>;

/// What two runs of a row differ by.
fn apart(fine: &Judged, coarse: &Judged) -> Apart {
    let pairs = fine.iter().zip(coarse);
    pairs
        .map(|(fine, coarse)| [(fine.value - coarse.value).abs(), fine.apart(coarse)])
        .collect()
}

/// The largest relative difference; NaN where one is.
fn largest(apart: &Apart) -> f64 {
    apart.iter().fold(0.0, |worst, [_, difference]| {
        // a difference that is no number stays one
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
            (Turn::First, _) => 1.0,
            (Turn::Coarser, Pace::Adaptive(_)) => COARSER,
            (Turn::Coarser, Pace::Fixed(_)) => LONGER,
            (Turn::Sharper, _) => whole_power(SHARPER, self.sharpened[row] + 1),
        }
    }

    /// Not of the two runs whose difference is the estimate: it says what their accelerations are wrong by, and the sharper runs that follow
    /// where it is too large have them under control.
    fn controls_accelerations(&self, scenario: usize) -> bool {
        let (_, turn) = self.which(scenario);
        turn == Turn::Sharper || !self.job.estimate
    }

    fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    fn wants_jumps(&self) -> bool {
        // when a jump is matters to a derivative by all that is gained or lost, to a value by no more than sampling does
        S::SLOPES
    }

    fn gives_up(&self, scenario: usize, steps: u64) -> bool {
        let (row, turn) = self.which(scenario);
        let before = self.ended[row].filter(|_| turn != Turn::First);
        before.is_some_and(|before| {
            let taken = u64::from(before.steps) + u64::from(before.rejected);
            steps > PATIENCE * taken
        })
    }

    fn lingers(&mut self, scenario: usize, seconds: f64, t: f64) {
        if let Some(hear) = self.hear {
            let (row, turn) = self.which(scenario);
            // of the two that are under way side by side, one
            if turn == Turn::Coarser && self.ended[row].is_none() {
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
        // a coarser run in fixed steps is there to be compared with, whatever is to be said of it
        let coarse = turn == Turn::Coarser && matches!(self.job.settings.pace, Pace::Fixed(_));
        let done = ended.status == Status::Done || coarse && ended.status == Status::Doubtful;
        if turn == Turn::Sharper && !done {
            self.pairs[row] = [None, None];
            // what was there before stays, unless the better run says that the row cannot be trusted
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
        if turn != Turn::Coarser {
            self.ended[row] = Some(*ended);
            let start = row * responses.len();
            self.responses[start..start + responses.len()].copy_from_slice(&responses);
        }
        if self.job.estimate {
            self.estimate(row, turn, judged);
        }
    }
}

/// Which of the runs of a row it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    /// As asked for.
    First,
    /// At ten times the tolerances, or with steps twice as long.
    Coarser,
    /// Again, at a tenth of the tolerances of the run before.
    Sharper,
}

impl<S: Real> Table<'_, S> {
    /// The row of a scenario, and which of its runs it is.
    fn which(&self, scenario: usize) -> (usize, Turn) {
        let rows = self.ended.len();
        match self.job.estimate {
            false => (scenario, Turn::First),
            true if scenario < 2 * rows => match scenario.is_multiple_of(2) {
                true => (scenario / 2, Turn::First),
                false => (scenario / 2, Turn::Coarser),
            },
            true => (self.again[scenario - 2 * rows], Turn::Sharper),
        }
    }

    /// Takes what is known of a run of a row for the estimate of its error, once there are two of them.
    fn estimate(&mut self, row: usize, turn: Turn, judged: Judged) {
        let pair = &mut self.pairs[row];
        match turn {
            Turn::First => pair[0] = Some(judged),
            Turn::Coarser => pair[1] = Some(judged),
            Turn::Sharper => *pair = [Some(judged), pair[0].take()],
        }
        let [Some(fine), Some(coarse)] = pair else {
            return;
        };
        // of the run that counts, which has ended if both have
        let Some(ended) = self.ended[row] else {
            return;
        };
        let rounded = 0.5 * self.epsilon * f64::from(ended.steps);
        let apart = apart(fine, coarse);
        let error_of = |difference: f64| difference / self.surely + rounded;
        let error = error_of(largest(&apart));
        self.errors[row] = error;
        pair[1] = None;
        self.sharpened[row] += u32::from(turn == Turn::Sharper);
        let wanted = self.job.wanted;
        // what is not known helps, and is not good enough
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

    /// Whether a row may be run again at a tenth of the tolerances.
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

/// A whole power, by products in one order.
fn whole_power(base: f64, exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |power, _| power * base)
}
