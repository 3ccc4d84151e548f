//! A run is checked by a second run: by another formula and at a tenth of the tolerance.
//!
//! A run at the default tolerance promises an error of at most [`PROMISED`] in every output, relative to the output's largest magnitude. If
//! the second run differs by more, in an output or in a response (relative to the response itself), the run is repeated, each time at a
//! tenth of the tolerance and by the other formula, until two successive runs agree. The sharper of the two is the result.
//!
//! A quantity that is exactly 0 shrinks with the tolerance and never agrees between two runs; the velocity of a ball at rest is an example.
//! An output is taken as such a quantity when it has fallen below a hundredth of its size in the first run. Its size in the sharpest run is
//! then its bound, and its relative error does not count. The same holds for an output that consists of [rounding
//! errors](super::conditioning).
//!
//! The second run changes to the Rosenbrock method where the scene is stiff, as the first one does: there both are of the same family, at a tenth of the
//! tolerance.
//!
//! If the user chose the method, the run makes no such promise. It is not repeated, and only a difference beyond [`FAR`] says that it
//! cannot be trusted.

use super::cause::{self, Cause};
use super::conditioning;
use super::run;
use super::setting::{Curves, Pace, Setting};
use super::target::{Difference, FINEST, SHRUNK, largest, rounded};
use crate::simulation::{self, Recording, Runs};
use bryant_runtime::Formula;
use bryant_runtime::batch::rows::Asked;
use bryant_runtime::program::{ErrorKind, Job, Scalar};
use bryant_runtime::response::Answer;
use std::time::{Duration, Instant};

/// The error of every output that a run promises unless the user asks for another accuracy, relative to the output's largest magnitude.
pub const PROMISED: f64 = 1e-3;
/// A run by any method is wrong if it differs from its check by more than this.
pub const FAR: f64 = 0.1;
/// The check and all sharper runs together may always take this time \[s\], and this many times the time of the first run. A check usually takes 1.6 times
/// the steps; one that takes far more has something to report, so it is waited for.
const LONGEST: [f64; 2] = [10.0, 5.0];
/// Below this tolerance kinks are located, which pays there.
const LOCATED: f64 = 1e-8;
/// Below this tolerance a method of order 8 is cheaper.
const HIGH: f64 = 1e-10;

/// A run and what its check says.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The run, or the sharpest one that took its place.
    pub recording: Recording,
    /// How it was computed.
    pub setting: Setting,
    /// How far the first run was from its check, if sharper runs followed.
    pub first: Option<Difference>,
    /// Number of all runs.
    pub runs: usize,
    /// The setting of the second run, and its verdict; `None` if the run failed.
    pub check: Option<(Setting, Verdict)>,
    /// The run cannot be trusted if it differs from its check by more than this.
    pub limit: f64,
    /// Whether there was not enough time for sharper runs.
    pub out_of_time: bool,
    /// Why the run is not as accurate as promised, although sharper runs followed.
    pub cause: Option<Cause>,
}

/// What a second run says.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// How far the two runs are apart.
    Apart(Difference),
    /// The second run failed, for this reason.
    Failed(String),
    /// The second run would have taken longer than this \[s\].
    TooLong(f64),
}

/// Runs a job and checks it. `chosen` says that the user chose the method. `progress` is called with the number of runs before, and the time of
/// every sample.
pub fn run(
    model: &dyn Runs,
    job: &Job,
    chosen: bool,
    progress: &mut dyn FnMut(usize, f64),
) -> Checked {
    let mut checked = Checked {
        recording: simulation::run(model, job, &mut |t| progress(0, t)),
        setting: Setting::of(job),
        first: None,
        runs: 1,
        check: None,
        limit: if chosen { FAR } else { PROMISED },
        out_of_time: false,
        cause: None,
    };
    let Ok(report) = &checked.recording.result else {
        return checked;
    };
    checked.setting = checked.setting.as_run(report);
    let begin = Instant::now();
    let wall = checked.recording.wall.as_secs_f64();
    let end = LONGEST[0].max(LONGEST[1] * wall);
    let columns = checked.recording.table.columns.iter().skip(1);
    let shrunk: Vec<f64> = columns
        .map(|output| SHRUNK * largest(&output.values))
        .collect();
    let mut patience = end;
    let first = checked.recording.answers.clone();
    let asked = &job.reading.asked[..];
    let (mut floors, mut rounding) = (Vec::new(), Vec::new());
    loop {
        let opinion = sharper(&checked.setting);
        let mut hear = |t: f64| progress(checked.runs, t);
        let second = second(model, job, &opinion, patience, &mut hear);
        let opinion = second
            .result
            .as_ref()
            .map_or(opinion, |report| opinion.as_run(report));
        let answers = (asked, &first[..]);
        let mut verdict = Verdict::of(&checked.recording, &second, &floors, answers, patience);
        checked.runs += 1;
        let mut close = verdict.is_close();
        if let (false, true, Verdict::Apart(difference)) = (close, rounding.is_empty(), &verdict) {
            rounding = conditioning::reach(model, job, &checked.recording, &difference.outputs);
            let beyond = Verdict::of(&checked.recording, &second, &rounding, answers, patience);
            close = beyond.is_close();
            if close || chosen {
                verdict = beyond;
            }
        }
        let Verdict::Apart(difference) = &verdict else {
            // a sharper run that failed says nothing new; the comparison before it stands
            match checked.first {
                None => checked.check = Some((opinion, verdict)),
                Some(_) => checked.out_of_time = matches!(verdict, Verdict::TooLong(_)),
            }
            return checked;
        };
        let finest = matches!(opinion.pace, Pace::Tolerance(tolerance) if tolerance <= FINEST);
        if chosen || (close && checked.first.is_none()) {
            checked.check = Some((opinion, verdict));
            return checked;
        }
        checked.first.get_or_insert_with(|| difference.clone());
        checked.check = Some((checked.setting, verdict));
        (checked.recording, checked.setting) = (second, opinion);
        floors = shrunk.clone();
        for (floor, rounding) in floors.iter_mut().zip(&rounding) {
            *floor = floor.max(*rounding);
        }
        patience = end - begin.elapsed().as_secs_f64();
        checked.out_of_time = patience <= 0.0 && !close && !finest;
        if close || finest || checked.out_of_time {
            if let (false, Some((_, Verdict::Apart(difference)))) = (close, &checked.check) {
                let patience = Duration::try_from_secs_f64(end).unwrap_or(Duration::MAX);
                let job = checked.setting.job(job);
                let of = (&checked.recording, difference);
                checked.cause = Some(cause::find(model, &job, of, &rounding, patience));
            }
            return checked;
        }
    }
}

/// A run of another setting, which may take `patience` \[s\].
pub fn second(
    model: &dyn Runs,
    job: &Job,
    opinion: &Setting,
    patience: f64,
    progress: &mut dyn FnMut(f64),
) -> Recording {
    let mut job = Job {
        time_limit: run::limit(patience),
        // the limit on the steps of the run does not apply to its check
        max_steps: None,
        ..opinion.job(job)
    };
    // signals that are looked at in the run alone
    job.reading.kept.retain(|kept| kept.in_place_of.is_some());
    simulation::run(model, &job, progress)
}

impl Verdict {
    /// Whether the two runs are as close as promised, or nothing is known about that.
    fn is_close(&self) -> bool {
        !matches!(self, Verdict::Apart(d) if d.worst > PROMISED || d.worst_response > PROMISED)
    }

    /// The verdict of a second run, which was allowed to take `patience` \[s\]. Outputs that are nowhere larger than their floors do not
    /// count. Nor do responses of signals that shrink; `asked` and `first` are the responses and their answers in the first run.
    pub fn of(
        run: &Recording,
        second: &Recording,
        floors: &[f64],
        (asked, first): (&[Asked], &[Answer]),
        patience: f64,
    ) -> Self {
        match &second.result {
            Ok(_) => Verdict::Apart(
                Difference::beyond(&run.table, &second.table, floors).with_responses(
                    asked,
                    [run, second],
                    first,
                    floors,
                ),
            ),
            Err(error) if error.kind == ErrorKind::Time => Verdict::TooLong(patience),
            Err(error) => Verdict::Failed(error.message.clone()),
        }
    }
}

/// Another formula at a tenth of the tolerance.
fn sharper(setting: &Setting) -> Setting {
    let tolerance = match setting.pace {
        Pace::Tolerance(tolerance) => rounded(0.1 * tolerance).max(FINEST),
        // nobody knows the accuracy of a fixed step
        Pace::Step(_) => 1e-8,
    };
    let high = tolerance < HIGH;
    Setting {
        formula: match setting.formula {
            Formula::Tsit5 if high => Formula::Dop853,
            Formula::Tsit5 => Formula::Dopri5,
            _ => Formula::Tsit5,
        },
        // what takes the explicit method too long is done by the other one, where it can
        switches: true,
        pace: Pace::Tolerance(tolerance),
        scalar: Scalar::F64,
        locate: setting.locate || tolerance < LOCATED,
        curves: Curves::Written,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_is_by_another_formula_and_sharper() {
        for formula in Formula::ALL {
            for pace in [
                Pace::Tolerance(1e-3),
                Pace::Tolerance(1e-9),
                Pace::Step(1e-4),
            ] {
                let setting = Setting {
                    formula,
                    switches: false,
                    pace,
                    scalar: Scalar::F64,
                    locate: false,
                    curves: Curves::Written,
                };
                let check = sharper(&setting);
                assert_ne!(check.formula, formula);
                if let Pace::Tolerance(tolerance) = pace {
                    assert!(check.pace.value() < 0.11 * tolerance);
                }
            }
        }
    }
}
