//! Decides in which order the settings of a study are run, and how long each run may take.
//!
//! A study has series of settings that differ only in their step or tolerance, from coarse to fine. A free processor
//! takes the next setting of a series. The coarse end of the default method comes first: it is what a user has without
//! a study. Then come series without an error below 100 % so far; then the series whose last point is nearest to the
//! front of accuracy against time; of several, the one with the fewest points. So a study that ends early has the
//! front, and lacks points far from it.

use super::front::Cost;
use super::plan::Series;
use super::point::{Point, Status};
use super::setting::{Pace, Setting, time, two_digits};
use crate::interrupt;
use std::sync::mpsc::channel;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Ratio of the time limit of a run to its predicted time; predictions from a coarser neighbour are rarely worse.
const PATIENCE: f64 = 5.0;

/// The reason for a setting that was not run because of Ctrl-C.
pub const INTERRUPTED: &str = "not reached: interrupted by Ctrl-C";

/// Is added to the rank of a setting that is run again; it exceeds the distance of any cost from the front.
const LATER: f64 = 1e3;

/// Time limit of a run whose time cannot be predicted: this share of the limit of any run, or this multiple of the time
/// of a usual run, if that is more.
const FIRST: f64 = 0.25;
const USUAL: f64 = 1.5;

/// Number of settings of the default method that come before all others.
const OF_DEFAULT: usize = 6;

/// Runs the settings of a study within limits of time.
pub struct Schedule<'a> {
    series: &'a [Series],
    /// Time limit of one run \[s\].
    limit: f64,
    /// Time limit of a run whose time cannot be predicted \[s\].
    first: f64,
    begin: Instant,
    /// Time after `begin` at which the last run may begin \[s\].
    all: f64,
    /// Number of simultaneous runs.
    workers: usize,
}

/// The result of a setting, and its cost.
pub type Ran = (Status, Cost);

/// The progress of a series.
struct Line {
    settings: Vec<Setting>,
    points: Vec<Point>,
    costs: Vec<Cost>,
    /// True while one of its settings is being run.
    busy: bool,
    /// Time limit of its next setting \[s\], if that setting took longer than predicted and will be run again.
    allowance: Option<f64>,
}

impl<'a> Schedule<'a> {
    /// A schedule for these series. One run may take `limit` \[s\], and all of them together `all` \[s\] from now on.
    pub fn new(series: &'a [Series], limit: f64, all: f64) -> Self {
        Schedule {
            series,
            limit,
            first: FIRST * limit,
            begin: Instant::now(),
            all,
            workers: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }

    /// The schedule for a scene of which a usual run takes this time \[s\].
    pub fn expecting(self, usual: f64) -> Self {
        let first = self.first.max(USUAL * usual).min(self.limit);
        Schedule { first, ..self }
    }

    /// The schedule with this number of simultaneous runs, instead of one for each processor.
    pub fn on(self, workers: usize) -> Self {
        Schedule { workers, ..self }
    }

    /// Runs the settings and returns their points, series by series, from coarse to fine. `run` gets a setting and its
    /// time limit \[s\].
    pub fn carry_out(
        &self,
        run: &(dyn Fn(&Setting, f64) -> Ran + Sync),
        progress: &mut dyn FnMut(f64),
    ) -> Vec<Point> {
        let lines = self.series.iter().map(|series| Line {
            settings: series.settings().collect(),
            points: Vec::new(),
            costs: Vec::new(),
            busy: false,
            allowance: None,
        });
        let lines: Vec<Line> = lines.collect();
        let settings: usize = lines.iter().map(|line| line.settings.len()).sum();
        let lines = Mutex::new(lines);
        let (tell, hear) = channel();
        std::thread::scope(|scope| {
            for _ in 0..self.workers {
                let (tell, lines) = (tell.clone(), &lines);
                scope.spawn(move || {
                    while let Some((index, setting, limit)) = self.next(lines) {
                        let (status, cost) = run(&setting, limit);
                        let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                        let line = &mut lines[index];
                        line.busy = false;
                        if matches!(status, Status::Skipped(_)) && limit < self.limit {
                            // the prediction was wrong: the setting may be run again, with more time
                            line.allowance = Some(PATIENCE * limit);
                            continue;
                        }
                        line.points.push(Point { setting, status });
                        line.costs.push(cost);
                        line.allowance = None;
                        let _ = tell.send(());
                    }
                });
            }
            drop(tell);
            for (done, ()) in hear.iter().enumerate() {
                let used = self.begin.elapsed().as_secs_f64() / self.all.max(1e-3);
                progress(
                    ((done + 1) as f64 / settings.max(1) as f64)
                        .max(used)
                        .min(1.0),
                );
            }
        });
        let lines = lines.into_inner().unwrap_or_else(PoisonError::into_inner);
        lines.into_iter().flat_map(Line::complete).collect()
    }

    /// The next series, its next setting and the time limit for it \[s\]. Settings that would take too long are
    /// skipped.
    fn next(&self, lines: &Mutex<Vec<Line>>) -> Option<(usize, Setting, f64)> {
        loop {
            let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
            if self.begin.elapsed().as_secs_f64() >= self.all || interrupt::asked() {
                return None;
            }
            let all: Vec<Cost> = lines.iter().flat_map(|line| &line.costs).copied().collect();
            let waiting = lines
                .iter()
                .enumerate()
                .filter(|(_, line)| !line.busy && line.points.len() < line.settings.len());
            let nearest = waiting.min_by(|(_, a), (_, b)| {
                let ranks = a.rank(&all).total_cmp(&b.rank(&all));
                ranks.then(a.points.len().cmp(&b.points.len()))
            });
            let Some((index, _)) = nearest else {
                // the series that are left are being run by other threads, which continue them
                return None;
            };
            let limit = self.limit;
            let line = &mut lines[index];
            let setting = line.settings[line.points.len()];
            let predicted = line.predict(&setting);
            if predicted == Some(f64::INFINITY) {
                line.skip("a coarser setting already takes too long (--budget)".to_owned());
                continue;
            }
            if let Some(predicted) = predicted.filter(|predicted| *predicted > limit) {
                line.skip(format!(
                    "would take about {}, more than the {} that a run may take (--budget)",
                    time(two_digits(predicted)),
                    time(two_digits(limit))
                ));
                continue;
            }
            line.busy = true;
            let allowed = predicted.map_or(self.first, |predicted| PATIENCE * predicted);
            let allowed = line.allowance.unwrap_or(allowed);
            return Some((index, setting, allowed.max(0.02 * limit).min(limit)));
        }
    }
}

impl Line {
    /// Predicted time of a run \[s\], from its coarser neighbour: proportional to the number of fixed steps, or by the
    /// order of the method. `None` if it cannot be predicted.
    fn predict(&self, setting: &Setting) -> Option<f64> {
        let (point, cost) = (self.points.last()?, self.costs.last()?);
        if !cost.time.is_finite() {
            // the neighbour was stopped or failed: if it was stopped, a finer run takes at least as long; if it failed,
            // nothing is known about a finer run
            return matches!(point.status, Status::Skipped(_)).then_some(f64::INFINITY);
        }
        let finer = point.setting.pace.value() / setting.pace.value();
        let order = f64::from(setting.formula.order());
        Some(match setting.pace {
            Pace::Step(_) => cost.time * finer,
            Pace::Tolerance(_) => cost.time * libm::pow(finer, 1.0 / order),
        })
    }

    /// The rank of the series: the one with the lowest rank is continued first.
    fn rank(&self, all: &[Cost]) -> f64 {
        if let Some(allowance) = self.allowance {
            // a setting that took longer than predicted is run after all others
            return LATER + allowance;
        }
        if self.settings[0].switches && self.points.len() < OF_DEFAULT {
            return -3.0 + 1e-3 * self.points.len() as f64;
        }
        let begun = self.costs.iter().rev().find(|cost| cost.time.is_finite());
        match begun {
            // the coarse end of each series, those with the fewest points first
            None => -2.0 + 1e-3 * self.points.len() as f64,
            Some(cost) if cost.error >= 1.0 => -1.0 + 1e-3 * self.points.len() as f64,
            Some(cost) => far(all, *cost),
        }
    }

    /// Skips its next setting; `why` is the reason.
    fn skip(&mut self, why: String) {
        let setting = self.settings[self.points.len()];
        self.points.push(Point {
            setting,
            status: Status::Skipped(why),
        });
        self.costs.push(NONE);
    }

    /// All its points; those that were not reached get a reason.
    fn complete(mut self) -> Vec<Point> {
        let why = match interrupt::asked() {
            true => INTERRUPTED,
            false => "not reached: the time was used up (--budget)",
        };
        while self.points.len() < self.settings.len() {
            self.skip(why.to_owned());
        }
        self.points
    }
}

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub const NONE: Cost = Cost {
    error: f64::INFINITY,
    time: f64::INFINITY,
};

/// The distance of a cost from the front: ln of its time over that of the fastest run with at most the same error; 0 on
/// the front.
fn far(all: &[Cost], cost: Cost) -> f64 {
    let as_accurate = all.iter().filter(|other| other.error <= cost.error);
    let fastest = as_accurate.fold(f64::INFINITY, |least, other| least.min(other.time));
    match cost.time.is_finite() {
        true => libm::log(cost.time / fastest),
        false => f64::INFINITY,
    }
}

/// The distance of the cost `index` from the front of all costs; 0 on the front.
pub fn distance(all: &[Cost], index: usize) -> f64 {
    far(all, all[index])
}
