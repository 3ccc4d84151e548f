//! The summary of the results: statistics of each response, and the parameters that it depends on.
//!
//! The summary takes one pass over the blocks in their order, and is the same whoever makes it. Quantiles, polynomials
//! and pictures need many values at once; if there are too many rows, they use a sample of rows that is drawn by a hash
//! of the index.

pub mod chaos;
pub mod errors;
pub mod family;
pub mod index;
pub mod moments;
pub mod saltelli;
pub mod sample;
pub mod text;

use crate::engine::{Outcomes, Status};
use crate::results::{Results, ResultsError};
use crate::study::{Plan, RandomDesign, Study};
use errors::Errors;
use index::Sensitivity;
use moments::{Correlation, Moments};
use saltelli::Groups;
use sample::{Ranks, Sample};
use serde::Serialize;
use std::collections::BTreeMap;

/// The summary of a study's results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The identity of the results.
    pub identity: String,
    /// Number of runs.
    pub runs: u64,
    /// Number of runs by the way in which they ended; only ways that occurred.
    pub ends: Vec<(&'static str, u64)>,
    /// The reasons why runs have no result or cannot be trusted, with their numbers of runs; without runs whose status
    /// says enough.
    pub reasons: Vec<(String, u64)>,
    /// The first runs that exceeded their time limit.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub slow: Vec<u64>,
    /// The accuracy of the finished rows.
    pub errors: Errors,
    /// One entry for each response.
    pub responses: Vec<About>,
}

/// Statistics of a response. An undefined number is NaN, and null in JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct About {
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
    /// Number of runs with a value.
    pub count: u64,
    /// Number of runs without a value.
    pub missing: u64,
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the sample.
    pub deviation: f64,
    /// Least value.
    pub minimum: f64,
    /// Largest value.
    pub maximum: f64,
    /// Quantiles at 5, 50 and 95 %.
    pub quantiles: [f64; 3],
    /// Number of runs used for the quantiles: all, or a sample.
    pub quantiles_of: usize,
    /// Correlation with each parameter.
    pub correlations: Vec<f64>,
    /// The shares of the parameters in its variance; `None` if the design does not allow this, or the response does not
    /// vary.
    pub sensitivity: Option<Sensitivity>,
}

/// Probabilities of the quantiles.
pub const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// Largest number of runs that are listed by their indices.
const NAMED: usize = 5;

/// Summarises results; also returns the sample, from which pictures are drawn.
///
/// # Errors
/// A block cannot be read.
pub fn summarize(results: &Results<'_>) -> Result<(Summary, Sample), ResultsError> {
    let d = results.study.varied.len();
    let mut totals = Totals::new(results.study);
    for batch in results.batches() {
        let batch = batch?;
        for k in 0..batch.outcomes.runs.len() {
            let x = &batch.values[k * d..(k + 1) * d];
            totals.add(results, batch.first + k as u64, x, &batch.outcomes, k);
        }
    }
    Ok(totals.finish(results))
}

/// Counts and sums of one pass over the runs.
struct Totals<'s> {
    study: &'s Study,
    /// Number of runs by [`Status`].
    ends: [u64; Status::ALL.len()],
    reasons: BTreeMap<String, u64>,
    slow: Vec<u64>,
    errors: Errors,
    /// One for each response.
    moments: Vec<Moments>,
    /// One for each response and parameter, response by response.
    correlations: Vec<Correlation>,
    sample: Sample,
    ranks: Ranks,
    /// Sums for Saltelli's design.
    groups: Option<Groups>,
}

impl<'s> Totals<'s> {
    fn new(study: &'s Study) -> Self {
        let (d, width) = (study.varied.len(), study.responses.len());
        let saltelli = matches!(
            &study.plan,
            Plan::Random {
                design: RandomDesign::Saltelli,
                ..
            }
        );
        Totals {
            study,
            ends: [0; Status::ALL.len()],
            reasons: BTreeMap::new(),
            slow: Vec::new(),
            errors: Errors::new(study),
            moments: vec![Moments::default(); width],
            correlations: vec![Correlation::default(); width * d],
            sample: Sample::new(study),
            ranks: Ranks::new(study),
            groups: saltelli.then(|| Groups::new(study)),
        }
    }

    /// Adds the run of a row: its parameters `x`, and the outcome with index `k`.
    fn add(&mut self, results: &Results<'_>, row: u64, x: &[f64], outcomes: &Outcomes, k: usize) {
        let (run, y) = (&outcomes.runs[k], outcomes.of(k));
        self.ends[run.status as usize] += 1;
        if run.status == Status::Slow && self.slow.len() < NAMED {
            self.slow.push(row);
        }
        if run.status == Status::Done {
            self.errors.add(row, run.error);
        }
        match outcomes.reason(k) {
            "" => {}
            reason => match self.reasons.get_mut(reason) {
                Some(count) => *count += 1,
                None => drop(self.reasons.insert(reason.to_owned(), 1)),
            },
        }
        for (response, y) in y.iter().enumerate().filter(|(_, y)| y.is_finite()) {
            self.moments[response].add(*y);
            let pairs = self.correlations[response * x.len()..].iter_mut();
            for (pair, x) in pairs.zip(x) {
                pair.add(*x, *y);
            }
        }
        self.sample.add(&results.sampler, row, x, y);
        self.ranks.add(row, y);
        if let Some(groups) = &mut self.groups {
            groups.add(y);
        }
    }

    /// The statistics of a response.
    fn about(&self, response: usize) -> About {
        let d = self.study.varied.len();
        let of = &self.study.responses[response];
        let moments = &self.moments[response];
        let sensitivity = match (&self.groups, &self.study.plan) {
            (Some(groups), _) => groups.indices(response),
            (None, Plan::Random { .. }) => chaos::indices(&self.sample, response),
            (None, _) => None,
        };
        let (quantiles, quantiles_of) = self.ranks.quantiles(response, SHARES);
        About {
            name: of.name.clone(),
            unit: of.unit.name.clone(),
            count: moments.count,
            missing: self.study.rows - moments.count,
            mean: moments.mean(),
            deviation: moments.deviation(),
            minimum: moments.minimum,
            maximum: moments.maximum,
            quantiles,
            quantiles_of,
            correlations: self.correlations[response * d..][..d]
                .iter()
                .map(Correlation::value)
                .collect(),
            sensitivity,
        }
    }

    fn finish(self, results: &Results<'_>) -> (Summary, Sample) {
        let responses = (0..self.study.responses.len()).map(|response| self.about(response));
        let summary = Summary {
            identity: results.folder.identity().identity.clone(),
            runs: self.study.rows,
            responses: responses.collect(),
            ends: Status::ALL
                .iter()
                .map(|status| (status.word(), self.ends[*status as usize]))
                .filter(|(_, count)| *count > 0)
                .collect(),
            reasons: self.reasons.into_iter().collect(),
            slow: self.slow,
            errors: self.errors.finish(),
        };
        (summary, self.sample)
    }
}
