//! A point of the study: one setting and its result.

use super::norm::StateError;
use super::reading::Reading;
use super::setting::{Pace, Setting};
use bryant_runtime::Report;
use bryant_study::summary::sample::quantile;

/// One setting and its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The setting of the run.
    pub setting: Setting,
    /// Its result.
    pub status: Status,
}

/// The result of a setting.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// The run reached its end.
    Done(Box<Done>),
    /// The run failed; the reason.
    Failed(String),
    /// The setting was not run; the reason.
    Skipped(String),
}

/// A run that reached its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Done {
    /// The error of the state, with its entry.
    pub state: StateError,
    /// Errors of the readings of the study, in its order.
    pub readings: Vec<f64>,
    /// The gap in the balance of energy, relative to the energy exchanged.
    pub energy: Option<f64>,
    /// The change of momentum that no force explains, relative to the total momentum; `None` if it is not known.
    pub momentum: Option<f64>,
    /// The cost of the run.
    pub report: Report,
    /// The order, estimated from this point and the coarser point before it.
    pub order: Option<f64>,
    /// Time of the run.
    pub timing: Timing,
}

/// Time of a run, from several repetitions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// Median of the repetitions \[s\].
    pub median: f64,
    /// 95th percentile of the repetitions \[s\].
    pub late: f64,
    /// Number of repetitions.
    pub repetitions: usize,
}

/// The kind of error that the user wants to see: one number for each run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The error of the state.
    State,
    /// The largest error of all readings.
    Worst,
    /// The error of one reading, by its index.
    Reading(usize),
}

/// An error that cannot be known below that of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// The error of the run, or that of the reference if this is larger.
    pub error: f64,
    /// True if the error of the run is not larger than that of the reference, so that [`Known::error`] is only a bound.
    pub at_most: bool,
}

/// The errors of the reference itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Own {
    /// Error of the state.
    pub state: f64,
    /// Error of each reading.
    pub readings: Vec<f64>,
}

impl Own {
    /// The error of the reference, as this kind of error.
    pub fn of(&self, measure: Measure) -> f64 {
        match measure {
            Measure::State => self.state,
            Measure::Worst => self.readings.iter().copied().fold(0.0, f64::max),
            Measure::Reading(index) => self.readings.get(index).copied().unwrap_or(0.0),
        }
    }
}

impl Timing {
    /// The timing from times in any order \[s\], at least one.
    pub fn of(times: &[f64]) -> Timing {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let [median, late] = [0.5, 0.95].map(|part| quantile(&sorted, part));
        Timing {
            median,
            late,
            repetitions: times.len(),
        }
    }
}

impl Done {
    /// The error of the run, as this kind of error, at least that of the reference.
    pub fn error(&self, of: Measure, own: &Own) -> Known {
        let known = |error: f64, own: f64| Known {
            error: error.max(own),
            at_most: error <= own,
        };
        let reading = |index: usize| {
            let error = self.readings.get(index).copied().unwrap_or(f64::INFINITY);
            known(error, own.readings.get(index).copied().unwrap_or(0.0))
        };
        match of {
            Measure::State => known(self.state.error, own.state),
            Measure::Reading(index) => reading(index),
            Measure::Worst => {
                let all = (0..self.readings.len()).map(reading);
                // of equal errors, the one that is known exactly counts as the worse
                all.reduce(|a, b| {
                    let worse = b.error > a.error || b.error == a.error && a.at_most;
                    if worse { b } else { a }
                })
                .unwrap_or_else(|| known(self.state.error, own.state))
            }
        }
    }
}

impl Measure {
    /// The name of the kind of error: "the state", "peak lap belt force", "the worst of 12 readings"
    pub fn name(self, readings: &[Reading]) -> String {
        match self {
            Measure::State => "the state".to_owned(),
            Measure::Worst => format!("the worst of {} readings", readings.len()),
            Measure::Reading(index) => {
                let name = readings.get(index).map(|reading| reading.name.clone());
                name.unwrap_or_default()
            }
        }
    }
}

impl Point {
    /// The result of a run that reached its end.
    pub fn done(&self) -> Option<&Done> {
        match &self.status {
            Status::Done(done) => Some(done),
            _ => None,
        }
    }
}

/// Orders of the points of one series, from coarse to fine, each estimated with the point before:
/// log(e₁/e₂)/log(h₁/h₂), with the errors e of the state, and with h the steps taken, or the tolerances. `None` for the
/// first point, and if one of the errors is not known or not above that of the reference.
pub fn orders(points: &[&Point], own: &Own) -> Vec<Option<f64>> {
    let known = |point: &Point| {
        let done = point.done()?;
        let error = done.error(Measure::State, own);
        let size = match point.setting.pace {
            Pace::Step(_) => done.report.largest_step,
            Pace::Tolerance(tolerance) => tolerance,
        };
        let usable = !error.at_most && error.error.is_finite() && error.error > 0.0;
        usable.then_some((error.error, size))
    };
    let mut before: Option<(f64, f64)> = None;
    points
        .iter()
        .map(|point| {
            let now = known(point);
            let order = before.zip(now).and_then(|((e1, h1), (e2, h2))| {
                // an error as large as the motion itself says nothing about the order
                (h1 > h2 && e1 < 1.0).then(|| libm::log(e1 / e2) / libm::log(h1 / h2))
            });
            before = now;
            order
        })
        .collect()
}
