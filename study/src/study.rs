//! A study, checked: every number in SI units, every name one of the model's.

use crate::distribution::Distribution;
use crate::facts::ModelFacts;
use crate::response::Response;
use bryant_runtime::response::filter::{Class, Filter};
use serde::Serialize;
use sha2::{Digest, Sha256};

/// Rows that a study may have.
pub const MOST_ROWS: u64 = 1_000_000_000;

/// Columns of the table beside parameters and responses, none of which has such a name.
pub const OWN_COLUMNS: [&str; 6] = [
    "run",
    "status",
    "steps",
    "reached",
    "error estimate",
    "reason",
];

/// What runs, and what is asked of it. What of it decides about results is its identity (see `store`).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    /// The model as the file names it: a bundled one, or a path relative to the file.
    #[serde(skip)]
    pub model: String,
    /// Runs, at least 1.
    pub rows: u64,
    /// The parameters that differ between runs, in the order of the file.
    pub varied: Vec<Varied>,
    /// Parameters that have another value than the model's in all runs.
    pub fixed: Vec<Fixed>,
    /// Which values.
    pub plan: Plan,
    /// How a row is run.
    pub run: RunSettings,
    /// What is read off each run, at least one.
    pub responses: Vec<Response>,
    /// Runs whose time series are kept.
    #[serde(skip)]
    pub keep: Keep,
    /// Tables that are written.
    #[serde(skip)]
    pub tables: Vec<TableKind>,
}

/// A parameter that differs between runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Varied {
    /// Its name in the model.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
}

/// A parameter with one value for all runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fixed {
    /// Its name in the model.
    pub name: String,
    /// SI.
    pub value: f64,
}

/// How the values of all rows come about.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Plan {
    /// All combinations of these values, per parameter; the last parameter changes fastest.
    Grid(Vec<Levels>),
    /// As written.
    List(Listed),
    /// By chance.
    Random {
        /// How points are spread.
        design: RandomDesign,
        /// Decides about all that is random.
        seed: u64,
        /// Per parameter.
        distributions: Vec<Distribution>,
    },
}

/// The values of a parameter in a grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Levels {
    /// From one end to the other in equal steps.
    Steps {
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// Values, both ends included, at least 2.
        count: u64,
    },
    /// As written.
    Values(Vec<f64>),
}

impl Levels {
    /// Values there are.
    pub fn count(&self) -> u64 {
        match self {
            Levels::Steps { count, .. } => *count,
            Levels::Values(values) => values.len() as u64,
        }
    }

    /// Value `k`, from 0.
    pub fn value(&self, k: u64) -> f64 {
        match self {
            Levels::Steps { from, to, count } => {
                // the weighted mean meets both ends
                let part = k as f64 / (count - 1) as f64;
                from * (1.0 - part) + to * part
            }
            Levels::Values(values) => values[k as usize],
        }
    }
}

/// Ways to spread points over the unit cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RandomDesign {
    /// One point in each of n equal parts of each parameter.
    LatinHypercube,
    /// A scrambled Sobol' sequence.
    Sobol,
    /// Independent points.
    MonteCarlo,
    /// Groups A, B, AB₁ … AB_d of two scrambled Sobol' points each, for the indices of Sobol'.
    Saltelli,
}

/// Rows that were written down: row-major, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed(pub Vec<f64>);

/// By their digest: a list may be long.
impl Serialize for Listed {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut digest = Sha256::new();
        for value in &self.0 {
            digest.update(value.to_le_bytes());
        }
        serializer.serialize_str(&crate::digest::hexadecimal(&digest.finalize()))
    }
}

/// Settings of each run; what is not given, the model decides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RunSettings {
    /// \[s\]
    pub duration: Option<f64>,
    /// Error of the responses that is aimed at, relative.
    pub accuracy: Option<f64>,
    /// Time between the samples that responses are read off \[s\].
    pub sampling: Option<f64>,
    /// Fixed steps, in place of steps that follow from the accuracy.
    pub step: Option<FixedSteps>,
    /// Share of energy and of momentum that may be missing in fixed steps; the usual one where nothing is said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_limit: Option<f64>,
    /// What numbers are computed with.
    #[serde(skip_serializing_if = "Precision::is_double")]
    pub precision: Precision,
}

impl Study {
    /// The time between the samples that responses are read off \[s\]: as the study says, or what the model and the filters need.
    pub fn sampling(&self, facts: &ModelFacts) -> f64 {
        let needed = crate::file::sampling(&self.run, facts, &self.responses);
        let kept = self.kept_filters(facts).map(Class::longest_interval);
        self.run.sampling.unwrap_or(kept.fold(needed, f64::min))
    }

    /// The filters of outputs whose time series are kept.
    pub fn kept_filters(&self, facts: &ModelFacts) -> impl Iterator<Item = Class> {
        let kept = self.keep.outputs.iter();
        kept.filter_map(|kept| {
            let filter = facts.outputs.get(kept.index)?.filter.as_deref()?;
            Filter::named(filter).map(|filter| filter.class)
        })
    }
}

impl RunSettings {
    /// The accuracy that steps follow from: 0.1 % where nothing is said.
    pub fn accuracy(&self) -> f64 {
        self.accuracy.unwrap_or(1e-3)
    }
}

/// Steps of one length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FixedSteps {
    /// At most so long \[s\].
    pub length: f64,
    /// By which method.
    pub method: Method,
}

/// Methods of fixed steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Modified Euler, of order 2.
    Heun,
    /// The classical Runge–Kutta method, of order 4.
    #[default]
    Rk4,
    /// Merson's, of order 4.
    Merson,
    /// Dormand & Prince's, of order 5.
    Dopri5,
}

impl Method {
    /// All of them, by order.
    pub const ALL: [Method; 4] = [Method::Heun, Method::Rk4, Method::Merson, Method::Dopri5];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Heun => "heun",
            Method::Rk4 => "rk4",
            Method::Merson => "merson",
            Method::Dopri5 => "dopri5",
        }
    }
}

/// What numbers are computed with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// Doubles, of 53 bits.
    #[default]
    Double,
    /// Singles, of 24 bits, and twice as many side by side.
    Single,
}

impl Precision {
    // as serde asks
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands out references"
    )]
    fn is_double(&self) -> bool {
        matches!(self, Precision::Double)
    }
}

/// Runs whose time series are kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Keep {
    /// These, in increasing order.
    pub runs: Vec<u64>,
    /// And runs 0, n, 2 n, ….
    pub every: Option<u64>,
    /// The outputs that are kept.
    pub outputs: Vec<KeptOutput>,
}

/// An output whose time series is kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptOutput {
    /// Index among the model's outputs.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
}

/// Formats of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableKind {
    /// Apache Parquet.
    Parquet,
    /// Comma-separated values.
    Csv,
}
