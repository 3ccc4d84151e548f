//! Checks a run by a second run, which uses another formula and a tenth of the tolerance.
//!
//! A run at the default tolerance promises an error of at most [`PROMISED`] in every output, relative to the output's
//! largest magnitude. If the second run differs by more, in an output or in a response (relative to the response
//! itself), the run is repeated, each time at a tenth of the tolerance and by the other formula, until two successive
//! runs agree. The sharper of the two is the result.
//!
//! A quantity that is exactly 0, such as the velocity of a ball at rest, decreases with the tolerance, and two runs
//! never agree on it. An output counts as such a quantity if its size has fallen below a hundredth of that in the first
//! run. Its size in the sharpest run is then an upper bound, and its relative error does not count. The same holds for
//! an output that consists of [rounding errors](super::conditioning).
//!
//! Where the scene is stiff, the second run changes to the Rosenbrock method, as the first one does. There both use the
//! same formula, but the second has a tenth of the tolerance.
//!
//! A doubt about the run that more accuracy cannot remove, such as a law that is singular where the motion goes, ends
//! this at once.
//!
//! If the user chose the method, the run promises nothing. It is not repeated, and cannot be trusted only if the
//! difference exceeds [`FAR`].

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

/// The error of each output, relative to its largest magnitude, that a run promises unless the user requests another
/// accuracy.
pub const PROMISED: f64 = 1e-3;
/// A run by any method is wrong if it differs from its check by more than this share.
pub const FAR: f64 = 0.1;
/// Time limit of the check and all sharper runs together: the larger of this time \[s\], and this multiple of the time
/// of the first run. A check usually takes 1.6 times the steps. A check that takes far more shows a problem, so the
/// limit is generous.
const LONGEST: [f64; 2] = [10.0, 5.0];
/// Tolerance below which kinks are located, because this then saves time.
const LOCATED: f64 = 1e-8;
/// Tolerance below which a method of order 8 is cheaper.
const HIGH: f64 = 1e-10;

/// A run and the result of its check.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The run, or the sharpest run, which replaces it.
    pub recording: Recording,
    /// The setting of this run.
    pub setting: Setting,
    /// The difference of the first run from its check, if sharper runs followed.
    pub first: Option<Difference>,
    /// Number of all runs.
    pub runs: usize,
    /// The setting of the second run, and its verdict; `None` if the run failed.
    pub check: Option<(Setting, Verdict)>,
    /// The run cannot be trusted if it differs from its check by more than this share.
    pub limit: f64,
    /// True if there was not enough time for sharper runs.
    pub out_of_time: bool,
    /// The reason why the run is less accurate than promised, although sharper runs followed.
    pub cause: Option<Cause>,
}

/// The result of a second run.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The difference of the two runs.
    Apart(Difference),
    /// The second run failed; the reason.
    Failed(String),
    /// The second run was stopped at this time limit \[s\].
    TooLong(f64),
}

/// Runs a job and checks it. `chosen` is true if the user chose the method. `progress` is called with the number of
/// earlier runs, and the time of each sample.
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
    if checked.recording.is_beyond_help() {
        return checked;
    }
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
            // a sharper run that failed says nothing new: the comparison before it remains valid
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
        if checked.recording.is_beyond_help() {
            return checked;
        }
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

/// Runs the job with another setting, for at most `patience` \[s\].
pub fn second(
    model: &dyn Runs,
    job: &Job,
    opinion: &Setting,
    patience: f64,
    progress: &mut dyn FnMut(f64),
) -> Recording {
    let mut job = Job {
        time_limit: run::limit(patience),
        // the limit of steps holds for the run, but not for its check
        max_steps: None,
        ..opinion.job(job)
    };
    // leaves out signals that are kept only for the run itself
    job.reading.kept.retain(|kept| kept.in_place_of.is_some());
    simulation::run(model, &job, progress)
}

impl Verdict {
    /// True unless the two runs are known to differ by more than promised.
    fn is_close(&self) -> bool {
        !matches!(self, Verdict::Apart(d) if d.worst > PROMISED || d.worst_response > PROMISED)
    }

    /// The verdict of a second run, which had the time limit `patience` \[s\]. Not counted are outputs that never
    /// exceed their floors, and responses of signals that decrease with the tolerance. `asked` and `first` are the
    /// responses and their answers in the first run.
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

/// The setting with the other formula, and a tenth of the tolerance.
fn sharper(setting: &Setting) -> Setting {
    let tolerance = match setting.pace {
        Pace::Tolerance(tolerance) => rounded(0.1 * tolerance).max(FINEST),
        // the accuracy of a fixed step is not known
        Pace::Step(_) => 1e-8,
    };
    let high = tolerance < HIGH;
    Setting {
        formula: match setting.formula {
            Formula::Tsit5 if high => Formula::Dop853,
            Formula::Tsit5 => Formula::Dopri5,
            _ => Formula::Tsit5,
        },
        // changes to the Rosenbrock method if the explicit method would take too long, if possible
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
