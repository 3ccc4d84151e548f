//! Runs a model and records the run: the samples of the table, poses for pictures, and the cost.

use crate::build_on_demand::RustcModel;
use crate::equations::Engine;
use crate::interrupt;
use crate::orientation::WithoutCharts;
use crate::picture::Instant;
use crate::table::{Column, Table};
use bryant_runtime::program::{
    Energy, Finding, Header, History, Job, Observer, Outcome, Reading, RunError, SampleWriter,
    run_model_observed,
};
use bryant_runtime::response::{Answer, reduce};
use bryant_runtime::{Info, Report, Response};
use std::ops::ControlFlow;
use std::time::{Duration, Instant as Clock};

/// The result of a run, complete or failed.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Names and units.
    pub header: Header,
    /// Time and outputs of every sample.
    pub table: Table,
    /// Names of the coordinates of poses: those of the model, with quaternions instead of Bryant angles.
    pub coordinates: Vec<String>,
    /// Poses of samples, evenly spread, with the first and the last.
    pub instants: Vec<Instant>,
    /// An upper bound of the angular velocity of bodies at samples \[rad/s\]: the largest sum of the angular velocities
    /// in a system. Does not include rotations of vehicles, and of joints that follow others.
    pub turning: f64,
    /// The state of the last sample: q, v, z, m, as in [`Info::state_name`]; empty if there is no sample.
    pub last_state: Vec<f64>,
    /// The cost of the run, or its failure.
    pub result: Result<Report, RunError>,
    /// [Responses](bryant_runtime::program::Reading) that the job requests; empty if the run did not reach its end or
    /// cannot be trusted.
    pub answers: Vec<Answer>,
    /// Samples of the channels that the job wants [kept](bryant_runtime::program::Kept); empty if the run did not reach
    /// its end.
    pub kept: Vec<Vec<f64>>,
    /// Works of effects over time, if the job requests them.
    pub history: Option<History>,
    /// The balance of energy; `None` if the run did not start.
    pub energy: Option<Energy>,
    /// The reasons why the run cannot be trusted.
    pub doubts: Vec<Finding>,
    /// Notes about the run.
    pub notes: Vec<String>,
    /// The smallest value of each event function, in the order of the header; empty if the run did not start.
    pub nearest: Vec<f64>,
    /// Time of the computation, including the writing of machine code in the first run of an engine, without deriving,
    /// starting and printing.
    pub wall: Duration,
}

/// Largest number of poses that are kept; no picture needs more.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub const MOST_INSTANTS: usize = 4096;

/// A model that can run jobs, whatever evaluates its equations.
pub trait Runs {
    /// Names, units and sizes.
    fn info(&self) -> &Info<'_>;
    /// Runs a job: [`Engine::run`].
    fn run(&self, job: &Job, writer: &mut SampleWriter<'_>, observer: &mut Observer<'_>)
    -> Outcome;
}

impl Runs for Engine {
    fn info(&self) -> &Info<'_> {
        Engine::info(self)
    }

    fn run(
        &self,
        job: &Job,
        writer: &mut SampleWriter<'_>,
        observer: &mut Observer<'_>,
    ) -> Outcome {
        Engine::run(self, job, writer, observer)
    }
}

/// Always runs in double precision.
impl Runs for RustcModel<'_> {
    fn info(&self) -> &Info<'_> {
        RustcModel::info(self)
    }

    fn run(
        &self,
        job: &Job,
        writer: &mut SampleWriter<'_>,
        observer: &mut Observer<'_>,
    ) -> Outcome {
        run_model_observed(self.model(), job, writer, observer)
    }
}

/// Runs a job until its end, or until an [interrupt]; `progress` is called from time to time with the time reached
/// \[s\].
pub fn run(model: &dyn Runs, job: &Job, progress: &mut dyn FnMut(f64)) -> Recording {
    run_with_poses(model, job, MOST_INSTANTS, progress)
}

/// Runs a job as [`run`] does, and keeps at most `most` poses, and the last.
pub fn run_with_poses(
    model: &dyn Runs,
    job: &Job,
    most: usize,
    progress: &mut dyn FnMut(f64),
) -> Recording {
    let mut recorder = Recorder::new(Header::of(model.info()), Turning::of(model.info()), most);
    let start = Clock::now();
    let mut outcome = model.run(
        job,
        &mut |t, state, outputs| {
            recorder.add(t, state, outputs);
            ControlFlow::Continue(())
        },
        &mut |t| {
            progress(t);
            interrupt::unless_asked()
        },
    );
    let kept = std::mem::take(&mut outcome.kept);
    let mut recording = recorder.finish(outcome, start.elapsed());
    recording.show(&job.reading, kept);
    recording
}

impl Recording {
    /// True if there is a doubt about where the motion goes, which is not one about its accuracy.
    pub fn is_beyond_help(&self) -> bool {
        self.doubts.iter().any(|doubt| doubt.lasts)
    }

    /// Replaces the values of filtered outputs in the table by those of the filtered samples. A filter needs the whole
    /// run, so these values are unknown if the run did not reach its end.
    fn show(&mut self, reading: &Reading, kept: Vec<Vec<f64>>) {
        let times = self.table.columns[0].values.clone();
        let ends = [times.first(), times.last()].map(|t| t.copied().unwrap_or(0.0));
        let every = (ends[1] - ends[0]) / reading.intervals.max(1) as f64;
        for (index, one) in reading.kept.iter().enumerate() {
            let Some(column) = one
                .in_place_of
                .map(|output| &mut self.table.columns[1 + output])
            else {
                continue;
            };
            let samples = kept.get(index).map_or(&[][..], |samples| &samples[..]);
            let at = |t: &f64| {
                let value = Response::Value { at: t - ends[0] };
                reduce(value, samples, every, &mut [])
            };
            column.values = times.iter().map(at).collect();
        }
        self.kept = kept;
    }
}

/// Finds out how fast bodies rotate.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub struct Turning {
    /// The angular velocities of each system, as indices of the state.
    pub systems: Vec<Vec<usize>>,
    /// The largest sum of their magnitudes so far \[rad/s\].
    pub fastest: f64,
}

impl Turning {
    fn of(info: &Info) -> Self {
        let mut systems: Vec<(&str, Vec<usize>)> = Vec::new();
        let first = info.coordinates.len();
        for (i, name) in info.velocities.iter().enumerate() {
            if info.state_unit(first + i) != Some("rad/s") {
                continue;
            }
            let system = name.split(['/', '.']).next().unwrap_or_default();
            match systems.iter_mut().find(|(known, _)| *known == system) {
                Some((_, all)) => all.push(first + i),
                None => systems.push((system, vec![first + i])),
            }
        }
        Turning {
            systems: systems.into_iter().map(|(_, all)| all).collect(),
            fastest: 0.0,
        }
    }

    fn look_at(&mut self, state: &[f64]) {
        for system in &self.systems {
            let sum: f64 = system.iter().map(|i| state[*i].abs()).sum();
            self.fastest = self.fastest.max(sum);
        }
    }
}

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub struct Recorder {
    header: Header,
    without_charts: WithoutCharts,
    times: Vec<f64>,
    outputs: Vec<Vec<f64>>,
    instants: Vec<Instant>,
    /// Largest number of instants that are kept, and number of samples for each.
    most: usize,
    stride: usize,
    turning: Turning,
    latest: Option<Instant>,
}

impl Recorder {
    pub fn new(header: Header, turning: Turning, most: usize) -> Self {
        Self {
            times: Vec::new(),
            outputs: vec![Vec::new(); header.outputs.len()],
            instants: Vec::new(),
            most,
            stride: 1,
            turning,
            latest: None,
            without_charts: WithoutCharts::of(&header),
            header,
        }
    }

    pub fn add(&mut self, t: f64, state: &[f64], outputs: &[f64]) {
        let mut instant = self.latest.take().unwrap_or(Instant {
            time: t,
            coordinates: Vec::new(),
            state: Vec::new(),
        });
        instant.time = t;
        instant.coordinates = self.without_charts.q(state);
        instant.state.clear();
        instant.state.extend_from_slice(state);
        if self.times.len().is_multiple_of(self.stride) {
            self.instants.push(instant.clone());
            if self.instants.len() > self.most {
                let mut index = 0;
                self.instants.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.stride *= 2;
            }
        }
        self.latest = Some(instant);
        self.turning.look_at(state);
        self.times.push(t);
        for (column, value) in self.outputs.iter_mut().zip(outputs) {
            column.push(*value);
        }
    }

    pub fn finish(mut self, outcome: Outcome, wall: Duration) -> Recording {
        let last_state = self.latest.as_ref().map(|i| i.state.clone());
        if let Some(latest) = self.latest
            && self.instants.last().is_some_and(|i| i.time < latest.time)
        {
            self.instants.push(latest);
        }
        let time = Column {
            name: "time".into(),
            unit: "s".into(),
            values: self.times,
        };
        let outputs = self.header.outputs.iter().zip(self.outputs);
        let outputs = outputs.map(|(output, values)| Column {
            name: output.name.clone(),
            unit: output.unit.clone(),
            values,
        });
        Recording {
            table: Table {
                columns: std::iter::once(time).chain(outputs).collect(),
            },
            coordinates: self.without_charts.coordinates,
            instants: self.instants,
            header: self.header,
            last_state: last_state.unwrap_or_default(),
            turning: self.turning.fastest,
            result: outcome.result,
            answers: outcome.answers,
            kept: Vec::new(),
            history: outcome.history,
            energy: outcome.energy,
            doubts: outcome.doubts,
            notes: outcome.notes,
            nearest: outcome.nearest,
            wall,
        }
    }
}

impl Recording {
    /// Times of the samples \[s\].
    fn times(&self) -> &[f64] {
        self.table.columns.first().map_or(&[], |c| &c.values)
    }

    /// Time of the first sample \[s\].
    pub fn first_time(&self) -> f64 {
        self.times().first().copied().unwrap_or(0.0)
    }

    /// Time of the last sample \[s\].
    pub fn last_time(&self) -> f64 {
        self.times().last().copied().unwrap_or(0.0)
    }

    /// Parameters of the run, in the model's order (SI).
    pub fn parameters(&self, job: &Job) -> Vec<f64> {
        let value = |p: &bryant_runtime::program::ParameterHeader| {
            let set = job.parameters.iter().find(|(name, _)| *name == p.name);
            set.map_or(p.default, |(_, value)| *value)
        };
        self.header.parameters.iter().map(value).collect()
    }

    /// The poses that are nearest to these times, without repetitions.
    pub fn at(&self, times: &[f64]) -> Vec<Instant> {
        let mut chosen: Vec<Instant> = Vec::with_capacity(times.len());
        for time in times {
            let distance = |i: &Instant| (i.time - time).abs();
            let nearest = self
                .instants
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(nearest) = nearest
                && chosen.last().is_none_or(|last| last.time < nearest.time)
            {
                chosen.push(nearest.clone());
            }
        }
        chosen
    }
}
