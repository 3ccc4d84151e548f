//! Compares runs of a job with sharper ones: what two runs must agree in, and how much sharper the next one is.
//!
//! Not every difference counts. A quantity that is exactly 0, such as the velocity of a ball at rest, decreases with
//! the tolerance, and two runs never agree on it. An output counts as such a quantity if its size has fallen below a
//! hundredth of that in the first run. The same holds for an output that consists of [rounding
//! errors](super::conditioning). Its size in the sharpest run is then an upper bound.

use super::conditioning;
use super::difference::{Difference, NOISE, SHRUNK, largest, largest_by_unit};
use super::setting::{Pace, Setting, two_digits};
use crate::simulation::{Recording, Runs};
use bryant_runtime::Tolerances;
use bryant_runtime::batch::rows::Asked;
use bryant_runtime::program::Job;
use bryant_runtime::response::Answer;

/// The error of each output, relative to its largest magnitude, that a run promises unless the user requests another
/// accuracy.
pub const PROMISED: f64 = 1e-3;
/// Smallest tolerance; rounding errors make smaller ones useless.
pub(super) const FINEST: f64 = 1e-13;

/// What is known of the outputs and responses of a job from its runs so far.
pub struct Comparison<'a> {
    model: &'a dyn Runs,
    job: &'a Job,
    /// The responses of the first run.
    first: Vec<Answer>,
    /// The size of each output below which its error does not count; empty if there is none.
    floors: Vec<f64>,
    /// The size of each output below which it may consist of rounding errors; empty until it is needed.
    pub rounding: Vec<f64>,
}

impl<'a> Comparison<'a> {
    /// Compares runs of `job`, of which the first one had these responses. Responses of signals that have fallen below
    /// a hundredth of their size in that run do not count; without responses all count.
    pub fn of(model: &'a dyn Runs, job: &'a Job, first: &[Answer]) -> Self {
        Comparison {
            model,
            job,
            first: first.to_vec(),
            floors: Vec::new(),
            rounding: Vec::new(),
        }
    }

    /// The difference of a run from a sharper one. If it exceeds `limit`, outputs are not counted any more that may
    /// consist of rounding errors at the states of one of them, the run `of` with its job.
    pub fn difference(
        &mut self,
        pair: [&Recording; 2],
        limit: f64,
        of: (&Job, &Recording),
    ) -> Difference {
        let difference = self.beyond_floors(pair);
        if difference.is_within(limit) || !self.rounding.is_empty() {
            return difference;
        }
        self.rounding = conditioning::reach(self.model, of.0, of.1, &difference.outputs);
        self.raise(&self.rounding.clone());
        self.beyond_floors(pair)
    }

    /// From now on, outputs do not count either that have fallen below a hundredth of their size in this run.
    pub fn leave_out_what_shrinks(&mut self, first: &Recording) {
        let outputs = first.table.columns.iter().skip(1);
        let shrunk = outputs.map(|output| SHRUNK * largest(&output.values));
        self.raise(&shrunk.collect::<Vec<f64>>());
    }

    fn raise(&mut self, to: &[f64]) {
        self.floors.resize(to.len(), 0.0);
        for (floor, to) in self.floors.iter_mut().zip(to) {
            *floor = floor.max(*to);
        }
    }

    /// The difference of two runs. Not counted are outputs that never exceed their floors, and responses of signals
    /// that are noise, that have fallen below a hundredth of their size in the first run, or that are a single output
    /// that never exceeds its floor.
    fn beyond_floors(&self, [coarse, sharp]: [&Recording; 2]) -> Difference {
        let asked = &self.job.reading.asked;
        let unit = |asked: &Asked| {
            let channel = asked.channel;
            let keeps = channel.combination.keeps_unit();
            let first = channel.outputs().first().filter(|_| keeps)?;
            Some(sharp.header.outputs.get(*first)?.unit.as_str())
        };
        // the largest value for each unit, in rows and in samples
        let columns = sharp.table.columns.iter().skip(1);
        let rows = columns.map(|column| (Some(column.unit.as_str()), largest(&column.values)));
        let samples = asked.iter().zip(&sharp.answers);
        let samples = samples.map(|(asked, answer)| (unit(asked), answer.largest));
        let scales = largest_by_unit(rows.chain(samples));
        let scale = |asked: &Asked| scales.get(&unit(asked)).copied().unwrap_or(0.0);
        let floor = |asked: &Asked| {
            let floor = asked.channel.plain().and_then(|i| self.floors.get(i));
            floor.copied().filter(|floor| *floor > 0.0)
        };
        let pairs = sharp.answers.iter().zip(&coarse.answers);
        let responses: Vec<f64> = pairs.map(|(sharp, coarse)| sharp.apart(coarse)).collect();
        let counts = |(index, asked): (usize, &Asked)| {
            let answer = sharp.answers.get(index)?;
            let both = [answer.value, coarse.answers.get(index)?.value];
            let size = answer.largest.max(coarse.answers[index].largest);
            let vanishes = self
                .first
                .get(index)
                .is_some_and(|first| answer.largest <= SHRUNK * first.largest);
            let negligible = size <= NOISE * scale(asked)
                || floor(asked).is_some_and(|floor| answer.largest <= floor);
            if negligible || vanishes || both.iter().all(|x| x.is_nan()) {
                return None;
            }
            let apart = responses[index];
            Some(if apart.is_nan() { f64::INFINITY } else { apart })
        };
        let worst_response = asked.iter().enumerate().filter_map(counts);
        Difference {
            worst_response: worst_response.fold(0.0, f64::max),
            responses,
            ..Difference::beyond(&coarse.table, &sharp.table, &self.floors)
        }
    }
}

/// A tenth of the tolerance of a setting, as far as rounding allows; 10⁻⁸ for fixed steps, whose accuracy is not known.
pub fn sharper(setting: &Setting) -> f64 {
    match setting.pace {
        Pace::Tolerance(tolerance) => two_digits(0.1 * tolerance).max(FINEST),
        Pace::Step(_) => 1e-8,
    }
}

/// True if sharper runs would have the same doubts as two successive ones: both are [beyond
/// help](Recording::is_beyond_help), and the sharper one, of this setting, has at most the default tolerance. A coarser
/// run may go where the motion does not.
pub fn doubt_lasts(runs: [&Recording; 2], sharper: &Setting) -> bool {
    let is_sharp = sharper.pace.value() <= Tolerances::default().relative;
    is_sharp && runs.iter().all(|run| run.is_beyond_help())
}
