//! The summary of the results: numbers about each response, and the parameters that it depends on.
//!
//! The summary takes one pass over the blocks in their order, and is the same whoever makes it. Quantiles, polynomials and pictures need
//! many values at once; if there are too many rows, they use a sample of rows that is drawn by a hash of the index.

pub mod chaos;
pub mod errors;
pub mod family;
pub mod index;
pub mod moments;
pub mod saltelli;
pub mod sample;
pub mod text;

use crate::results::{Results, ResultsError};
use crate::study::{Plan, RandomDesign};
use errors::Errors;
use index::Sensitivity;
use moments::{Correlation, Moments};
use saltelli::Groups;
use sample::Sample;
use serde::Serialize;
use std::collections::BTreeMap;

/// The summary of a study's results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The identity of the results.
    pub identity: String,
    /// Number of runs.
    pub runs: u64,
    /// Number of runs for each end that occurred.
    pub ends: Vec<(&'static str, u64)>,
    /// The reasons why runs have no result or cannot be trusted, with their numbers of runs; runs whose end says everything are not
    /// included.
    pub reasons: Vec<(String, u64)>,
    /// The first runs whose computation took too long.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub slow: Vec<u64>,
    /// The accuracy of the finished rows.
    pub errors: Errors,
    /// One entry for each response.
    pub responses: Vec<About>,
}

/// Numbers about a response. An undefined number is NaN, and null in JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct About {
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
    /// Number of runs that have it.
    pub count: u64,
    /// Number of runs without it.
    pub missing: u64,
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the sample.
    pub deviation: f64,
    /// Least value.
    pub minimum: f64,
    /// Largest value.
    pub maximum: f64,
    /// Values with 5, 50 and 95 % of the runs below them.
    pub quantiles: [f64; 3],
    /// Number of runs used for the quantiles: all, or a sample.
    pub quantiles_of: usize,
    /// Correlation with each parameter.
    pub correlations: Vec<f64>,
    /// The parameters that its variance comes from; `None` if the design does not allow this, or the response does not vary.
    pub sensitivity: Option<Sensitivity>,
}

/// Shares of runs below the quantiles.
pub const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// Number of runs that are named if all runs of a kind are counted.
const NAMED: usize = 5;

/// Summarises results. Pictures are drawn from the sample.
///
/// # Errors
/// A block cannot be read.
pub fn summarize(results: &Results<'_>) -> Result<(Summary, Sample), ResultsError> {
    let study = results.study;
    let (d, width) = (study.varied.len(), study.responses.len());
    let mut ends = [0u64; crate::engine::Status::ALL.len()];
    let mut slow = Vec::new();
    let mut reasons: BTreeMap<String, u64> = BTreeMap::new();
    let mut errors = Errors::new(study);
    let mut moments = vec![Moments::default(); width];
    let mut correlations = vec![Correlation::default(); width * d];
    let mut sample = Sample::new(study);
    let mut ranks = sample::Ranks::new(study);
    let mut groups = match &study.plan {
        Plan::Random {
            design: RandomDesign::Saltelli,
            ..
        } => Some(Groups::new(study)),
        _ => None,
    };
    for batch in results.batches() {
        let batch = batch?;
        for (k, run) in batch.outcomes.runs.iter().enumerate() {
            let row = batch.first + k as u64;
            let (x, y) = (&batch.values[k * d..(k + 1) * d], batch.outcomes.of(k));
            ends[run.status as usize] += 1;
            if run.status == crate::engine::Status::Slow && slow.len() < NAMED {
                slow.push(row);
            }
            if run.status == crate::engine::Status::Done {
                errors.add(row, run.error);
            }
            match batch.outcomes.reason(k) {
                "" => {}
                reason => match reasons.get_mut(reason) {
                    Some(count) => *count += 1,
                    None => drop(reasons.insert(reason.to_owned(), 1)),
                },
            }
            for (response, y) in y.iter().enumerate().filter(|(_, y)| y.is_finite()) {
                moments[response].add(*y);
                for (pair, x) in correlations[response * d..].iter_mut().zip(x) {
                    pair.add(*x, *y);
                }
            }
            sample.add(&results.sampler, row, x, y);
            ranks.add(row, y);
            if let Some(groups) = &mut groups {
                groups.add(y);
            }
        }
    }
    let random = matches!(&study.plan, Plan::Random { .. });
    let about = |response: usize| {
        let of = &study.responses[response];
        let moments = &moments[response];
        let sensitivity = match &groups {
            Some(groups) => groups.indices(response),
            None if random => chaos::indices(&sample, response),
            None => None,
        };
        let (quantiles, quantiles_of) = ranks.quantiles(response, SHARES);
        About {
            name: of.name.clone(),
            unit: of.unit.clone(),
            count: moments.count,
            missing: study.rows - moments.count,
            mean: moments.mean(),
            deviation: moments.deviation(),
            minimum: moments.minimum,
            maximum: moments.maximum,
            quantiles,
            quantiles_of,
            correlations: correlations[response * d..][..d]
                .iter()
                .map(Correlation::value)
                .collect(),
            sensitivity,
        }
    };
    let summary = Summary {
        identity: results.folder.identity().identity.clone(),
        runs: study.rows,
        ends: crate::engine::Status::ALL
            .iter()
            .map(|status| (status.word(), ends[*status as usize]))
            .filter(|(_, count)| *count > 0)
            .collect(),
        reasons: reasons.into_iter().collect(),
        slow,
        errors: errors.finish(),
        responses: (0..width).map(about).collect(),
    };
    Ok((summary, sample))
}
