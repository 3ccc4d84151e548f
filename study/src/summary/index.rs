//! Sobol' indices: the share of a response's variance that is due to a parameter alone (main), and to this parameter
//! with all its interactions (total) \[I. M. Sobol', 1993\].

use serde::Serialize;

/// The shares of the parameters in the variance of a response.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// The method of estimation.
    pub method: Estimator,
    /// One entry for each varied parameter.
    pub parameters: Vec<Indices>,
}

/// The method of estimation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// From the groups of a Saltelli design.
    Groups {
        /// Number of complete groups.
        groups: u64,
    },
    /// From a polynomial that is fitted to a sample of the runs.
    Polynomial {
        /// Total degree.
        degree: usize,
        /// Number of terms.
        terms: usize,
        /// Number of runs that it was fitted to.
        runs: usize,
        /// Share of the variance that it explains in cross-validation. The indices say nothing about the rest.
        explained: f64,
    },
}

/// Indices of one parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Indices {
    /// Share of the parameter alone.
    pub main: Estimate,
    /// Share of the parameter with all its interactions.
    pub total: Estimate,
}

/// A number and its interval of 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}
