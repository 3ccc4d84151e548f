//! Sobol' indices: the shares of a response's variance that come from a parameter alone (main), and from it and all that it takes
//! part in (total) \[I. M. Sobol', 1993\].

use serde::Serialize;

/// Which parameters the variance of a response comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// How that is known.
    pub method: Method,
    /// One per parameter varied.
    pub parameters: Vec<Indices>,
}

/// How indices are known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// From the groups of a Saltelli design.
    Groups {
        /// Groups that were complete.
        groups: u64,
    },
    /// From a polynomial through a sample of the runs.
    Polynomial {
        /// Its total degree.
        degree: usize,
        /// Its terms.
        terms: usize,
        /// Runs it was fitted to.
        runs: usize,
        /// Share of the variance of runs that were left out of the fit, one at a time, that it explains. Indices say nothing
        /// about the rest.
        explained: f64,
    },
}

/// Indices of one parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Indices {
    /// By itself.
    pub main: Estimate,
    /// With all that it takes part in.
    pub total: Estimate,
}

/// A number and the interval that it lies in with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}
