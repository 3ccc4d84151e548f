//! The accuracy of the rows, by the error estimate of each.

use super::sample::{is_in, quantile};
use crate::study::Study;
use serde::Serialize;
use std::fmt::Write as _;

/// Largest number of estimates from which the median is computed.
const MOST: u64 = 100_000;

/// Estimated relative errors of the finished rows, see docs/studies.md.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// The requested accuracy; `None` for fixed steps.
    pub asked: Option<f64>,
    /// Number of rows with an estimate.
    pub known: u64,
    /// Number of finished rows without an estimate.
    pub unknown: u64,
    /// Median, NaN if there are no estimates.
    pub median: f64,
    /// Largest estimate, NaN if there are none.
    pub largest: f64,
    /// The run with the largest estimate, counted from 0.
    pub largest_run: u64,
    /// Number of rows whose estimate is above the requested accuracy.
    pub above: u64,
    #[serde(skip)]
    sample: Vec<f64>,
    #[serde(skip)]
    rows: u64,
}

impl Errors {
    /// No rows yet.
    pub fn new(study: &Study) -> Errors {
        let asked = match study.run.step {
            None => Some(study.run.accuracy()),
            Some(_) => None,
        };
        Errors::none(asked, study.rows)
    }

    /// No rows yet; `rows` are to come.
    // Public for the tests in `tests/it`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn none(asked: Option<f64>, rows: u64) -> Errors {
        Errors {
            asked,
            known: 0,
            unknown: 0,
            median: f64::NAN,
            largest: f64::NAN,
            largest_run: 0,
            above: 0,
            sample: Vec::new(),
            rows,
        }
    }

    /// Adds a finished row; `error` is NaN if it is not known.
    pub fn add(&mut self, row: u64, error: f64) {
        if error.is_nan() {
            self.unknown += 1;
            return;
        }
        self.known += 1;
        if self.largest.is_nan() || error > self.largest {
            (self.largest, self.largest_run) = (error, row);
        }
        self.above += u64::from(self.asked.is_some_and(|asked| error > asked));
        if is_in(row, self.rows, MOST) {
            self.sample.push(error);
        }
    }

    /// Computes the median after the last row.
    pub fn finish(mut self) -> Errors {
        self.sample.sort_unstable_by(f64::total_cmp);
        self.median = quantile(&std::mem::take(&mut self.sample), 0.5);
        self
    }

    /// A line for people; empty if no row is finished.
    pub fn text(&self) -> String {
        let mut text = String::new();
        match (self.known, self.unknown) {
            (0, 0) => return text,
            (0, _) => return "estimated error: not known of any run\n".to_owned(),
            _ => {}
        }
        let _ = write!(
            text,
            "estimated error: median {}, largest {} (run {})",
            percent(self.median),
            percent(self.largest),
            self.largest_run
        );
        if let (Some(asked), 1..) = (self.asked, self.above) {
            let are = if self.above == 1 {
                "run is"
            } else {
                "runs are"
            };
            let _ = write!(
                text,
                "; {} {are} above the {} that was asked for",
                self.above,
                percent(asked)
            );
        }
        if self.unknown > 0 {
            let runs = if self.unknown == 1 { "run" } else { "runs" };
            let _ = write!(text, "; not known of {} {runs}", self.unknown);
        }
        text.push('\n');
        text
    }
}

/// A relative error in percent with two digits.
fn percent(error: f64) -> String {
    let percent = 100.0 * error;
    if percent != 0.0 && !(1e-4..1e4).contains(&percent) {
        return format!("{percent:.1e} %");
    }
    let digits = match percent {
        0.0 => 0,
        _ => (1 - libm::log10(percent).floor() as i32).clamp(0, 6) as usize,
    };
    format!("{percent:.digits$} %")
}
