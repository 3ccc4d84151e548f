//! A checked study: every number is in SI units, and every name belongs to the model.

use crate::distribution::Distribution;
use crate::facts::ModelFacts;
use crate::response::Response;
use bryant_generator::description::shape::words;
use bryant_generator::model::units::Unit;
use bryant_runtime::response::filter::{Class, Filter};
use serde::Serialize;
use sha2::{Digest, Sha256};

/// Largest number of rows of a study.
pub const MOST_ROWS: u64 = 1_000_000_000;

/// Columns of the table besides parameters and responses; no parameter or response may have these names.
pub const OWN_COLUMNS: [&str; 6] = [
    "run",
    "status",
    "steps",
    "reached",
    "error estimate",
    "reason",
];

/// The runs of a study, and the responses that are computed from them. `store` decides which parts affect the results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    /// The model as the file names it: a bundled model, or a path relative to the file.
    #[serde(skip)]
    pub model: String,
    /// Number of runs, at least 1.
    pub rows: u64,
    /// The parameters that differ between runs, in the order of the file.
    pub varied: Vec<Varied>,
    /// Parameters that have the same value in all runs, instead of that of the model.
    pub fixed: Vec<Fixed>,
    /// The values of the parameters.
    pub plan: Plan,
    /// The settings of each run.
    pub run: RunSettings,
    /// The responses that are read off each run, at least one.
    pub responses: Vec<Response>,
    /// Runs whose time series are kept.
    #[serde(skip)]
    pub keep: Keep,
    /// Formats of the tables that are written.
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
    /// The unit in which its values are shown to people: that of the study's text, or the SI unit if the text has none.
    #[serde(skip)]
    pub shown: String,
}

/// A parameter with one value for all runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fixed {
    /// Its name in the model.
    pub name: String,
    /// Value, SI.
    pub value: f64,
}

/// The plan of the values of all rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Plan {
    /// All combinations of these values; the last parameter changes fastest.
    Grid(Vec<Levels>),
    /// Rows from a list.
    List(Listed),
    /// Random rows.
    Random {
        /// How points are spread.
        design: RandomDesign,
        /// The seed of all random numbers.
        seed: u64,
        /// One distribution for each parameter.
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
        /// Number of values, both ends included, at least 2.
        count: u64,
    },
    /// Values from a list.
    Values(Vec<f64>),
}

impl Levels {
    /// Number of values.
    pub fn count(&self) -> u64 {
        match self {
            Levels::Steps { count, .. } => *count,
            Levels::Values(values) => values.len() as u64,
        }
    }

    /// Value `k`, counted from 0.
    pub fn value(&self, k: u64) -> f64 {
        match self {
            Levels::Steps { from, to, count } => {
                // the weighted mean meets both ends exactly
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
    /// Latin hypercube: the range of each parameter has n parts of equal probability, with one point in each.
    LatinHypercube,
    /// A scrambled Sobol' sequence.
    Sobol,
    /// Independent points.
    MonteCarlo,
    /// Saltelli's groups for Sobol' indices: A and B are scrambled Sobol' points, and AB_i is A with coordinate i of B.
    Saltelli,
}

/// Rows from a list: row-major, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed(pub Vec<f64>);

/// A list is stored by its digest, because it may be long.
impl Serialize for Listed {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut digest = Sha256::new();
        for value in &self.0 {
            digest.update(value.to_le_bytes());
        }
        serializer.serialize_str(&crate::digest::hexadecimal(&digest.finalize()))
    }
}

/// Settings of each run; for a setting that is not given, that of the model holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RunSettings {
    /// Length of a run \[s\].
    pub duration: Option<f64>,
    /// Requested relative error of the responses.
    pub accuracy: Option<f64>,
    /// Time between the samples that responses are computed from \[s\].
    pub sampling: Option<f64>,
    /// Fixed steps; `None` if the steps follow from the accuracy.
    pub step: Option<FixedSteps>,
    /// Largest share of energy and of momentum that may be missing in runs with fixed steps; `None` for the default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_limit: Option<f64>,
    /// The precision of the numbers.
    #[serde(skip_serializing_if = "Precision::is_double")]
    pub precision: Precision,
}

impl Study {
    /// The time between the samples of responses \[s\]: that of the study, else the shortest that the model and the
    /// filters need.
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
    /// The accuracy that determines the steps: 0.1 % by default.
    pub fn accuracy(&self) -> f64 {
        self.accuracy.unwrap_or(1e-3)
    }
}

/// Steps of one length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FixedSteps {
    /// Largest length \[s\].
    pub length: f64,
    /// The method.
    pub method: LaneFormula,
}

/// The formulas of fixed steps, those of `bryant_runtime::batch::LaneFormula`; a type of this crate is read as a key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LaneFormula {
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

words! {
    impl LaneFormula {
        Heun = "heun",
        Rk4 = "rk4",
        Merson = "merson",
        Dopri5 = "dopri5",
    }
}

impl LaneFormula {
    /// All methods, by order.
    pub const ALL: [LaneFormula; 4] = [
        LaneFormula::Heun,
        LaneFormula::Rk4,
        LaneFormula::Merson,
        LaneFormula::Dopri5,
    ];
}

/// The precision of the numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// Double precision, 53 bits.
    #[default]
    Double,
    /// Single precision, 24 bits; twice as many numbers fit side by side.
    Single,
}

words! {
    impl Precision {
        Double = "double",
        Single = "single",
    }
}

impl Precision {
    // serde requires this signature
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands out references"
    )]
    fn is_double(&self) -> bool {
        matches!(self, Precision::Double)
    }
}

/// Runs whose time series are kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keep {
    /// Indices of such runs, in increasing order.
    pub runs: Vec<u64>,
    /// Also runs 0, n, 2 n, ….
    pub every: Option<u64>,
    /// The outputs that are kept.
    pub outputs: Vec<KeptOutput>,
    /// The unit of the times; `None` for seconds.
    pub time: Option<Unit>,
}

/// An output whose time series is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptOutput {
    /// Index among the model's outputs.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// The unit in which it is kept.
    pub unit: Unit,
}

/// Formats of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableKind {
    /// Apache Parquet.
    Parquet,
    /// Comma-separated values.
    Csv,
}

words! {
    impl TableKind {
        Parquet = "parquet",
        Csv = "csv",
    }
}
