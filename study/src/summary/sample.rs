//! Samples of rows, if there are too many rows: a hash of a row's index decides whether the row is in the sample.

use super::family::Family;
use crate::design::Sampler;
use crate::distribution::Distribution;
use crate::hash;
use crate::study::{Plan, Study};

/// Size of the sample for fits of polynomials and for pictures, in rows.
const MOST_ROWS: u64 = 8192;
/// Largest number of values that are sorted for quantiles, of all responses together.
const MOST_NUMBERS: u64 = 4_000_000;
/// Stream of the hash.
const THINNING: u64 = 9 << 32;

/// True if a row belongs to a sample of about `most` rows.
pub fn is_in(row: u64, rows: u64, most: u64) -> bool {
    rows <= most || hash::uniform(0, THINNING, row) * (rows as f64) < most as f64
}

/// Some rows with all their data.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    rows: u64,
    /// Functions of each parameter for polynomials; empty for designs that are not random.
    pub families: Vec<Family>,
    /// Points of the unit cube, row-major; empty for designs that are not random.
    pub points: Vec<f64>,
    /// Values of parameters, row-major, SI.
    pub values: Vec<f64>,
    /// Responses, row-major.
    pub responses: Vec<f64>,
    /// Number of rows in the sample.
    pub count: usize,
}

impl Sample {
    /// No rows yet.
    pub fn new(study: &Study) -> Sample {
        let distributions: &[Distribution] = match &study.plan {
            Plan::Random { distributions, .. } => distributions,
            _ => &[],
        };
        Sample {
            rows: study.rows,
            families: distributions.iter().map(Family::of).collect(),
            points: Vec::new(),
            values: Vec::new(),
            responses: Vec::new(),
            count: 0,
        }
    }

    /// Adds the next row of the study, if it belongs to the sample.
    pub fn add(&mut self, sampler: &Sampler<'_>, row: u64, values: &[f64], responses: &[f64]) {
        if !is_in(row, self.rows, MOST_ROWS) {
            return;
        }
        let start = self.points.len();
        self.points.resize(start + values.len(), 0.0);
        if sampler.point(row, &mut self.points[start..]).is_none() {
            self.points.clear();
        }
        self.values.extend_from_slice(values);
        self.responses.extend_from_slice(responses);
        self.count += 1;
    }
}

/// The values of every response, for their quantiles.
#[derive(Clone, Debug)]
pub struct Ranks {
    rows: u64,
    most: u64,
    columns: Vec<Vec<f64>>,
}

impl Ranks {
    /// No rows yet.
    pub fn new(study: &Study) -> Ranks {
        let width = study.responses.len();
        Ranks {
            rows: study.rows,
            most: MOST_NUMBERS / width.max(1) as u64,
            columns: vec![Vec::new(); width],
        }
    }

    /// Adds a row.
    pub fn add(&mut self, row: u64, responses: &[f64]) {
        if is_in(row, self.rows, self.most) {
            for (column, y) in self.columns.iter_mut().zip(responses) {
                column.extend(Some(*y).filter(|y| y.is_finite()));
            }
        }
    }

    /// The values with these shares of all values below them, interpolated between neighbours; and the number of values
    /// used.
    pub fn quantiles<const N: usize>(
        &self,
        response: usize,
        shares: [f64; N],
    ) -> ([f64; N], usize) {
        let mut sorted = self.columns[response].clone();
        sorted.sort_unstable_by(f64::total_cmp);
        (shares.map(|share| quantile(&sorted, share)), sorted.len())
    }
}

/// The quantile of sorted numbers; NaN if there are none.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share * last as f64;
    let below = place.floor() as usize;
    let (a, b) = (sorted[below], sorted[(below + 1).min(last)]);
    a + (place - below as f64) * (b - a)
}
