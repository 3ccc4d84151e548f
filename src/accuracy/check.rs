//! The check of a run by a second one, by another formula and at a tenth of the tolerance.
//!
//! A run at the default tolerance promises an error of at most [`PROMISED`] in every output, relative to the output's largest magnitude. Where
//! the second run differs by more, in an output or in a response of itself, the run is repeated, each time at a tenth of the tolerance and by
//! the other formula, until two runs that follow each other agree. The sharper of the two is the result.
//!
//! What is 0 in truth shrinks with the tolerance and never agrees: the velocity of a ball at rest. An output that has fallen below a hundredth
//! of its size in the first run is such a one; its size in the sharpest run bounds it, and its relative error does not count. The same holds for an
//! output that consists of [rounding errors](super::conditioning).
//!
//! A run by a method that somebody chose promises nothing of the kind. It is not repeated, and only a difference beyond [`FAR`] says that it
//! cannot be trusted.

use super::conditioning;
use super::run;
use super::setting::{Curves, Pace, Setting};
use super::target::{Difference, FINEST, SHRUNK, largest, rounded};
use crate::simulation::{self, Recording, Runs};
use bryant_runtime::Formula;
use bryant_runtime::batch::rows::Asked;
use bryant_runtime::program::{ErrorKind, Job, Scalar};
use bryant_runtime::response::Answer;
use std::time::Instant;

/// The error of an output that a run promises unless something else is asked for, relative to the output's largest magnitude.
pub const PROMISED: f64 = 1e-3;
/// A difference beyond this says that a run by any method is wrong.
pub const FAR: f64 = 0.1;
/// How long the check and all sharper runs may take together at least \[s\], and of the time of the first run in any case. A check takes 1.6 times the
/// steps where all is well; one that takes far more has something to tell, and is waited for.
const LONGEST: [f64; 2] = [10.0, 5.0];
/// Kinks are located below this tolerance, where that pays.
const LOCATED: f64 = 1e-8;
/// A method of order 8 is cheaper below this tolerance.
const HIGH: f64 = 1e-10;

/// A run and what its check says.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The run, or the sharpest one that took its place.
    pub recording: Recording,
    /// How it was computed.
    pub setting: Setting,
    /// How far the first run was from its check, where sharper ones followed.
    pub first: Option<Difference>,
    /// Runs in all.
    pub runs: usize,
    /// What it was compared with, and what came of that; `None` of a run that failed.
    pub check: Option<(Setting, Verdict)>,
    /// The difference beyond which it is not to be trusted.
    pub limit: f64,
    /// Whether sharper runs would have taken too long.
    pub out_of_time: bool,
}

/// What a second run says.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// How far the two are apart.
    Apart(Difference),
    /// It failed, and why.
    Failed(String),
    /// It would have taken longer than this \[s\].
    TooLong(f64),
}

/// Runs a job and checks it. `chosen` says that somebody chose the method. `progress` hears of the time of every sample.
pub fn run(model: &dyn Runs, job: &Job, chosen: bool, progress: &mut dyn FnMut(f64)) -> Checked {
    let mut checked = Checked {
        recording: simulation::run(model, job, progress),
        setting: Setting::of(job),
        first: None,
        runs: 1,
        check: None,
        limit: if chosen { FAR } else { PROMISED },
        out_of_time: false,
    };
    if checked.recording.result.is_err() {
        return checked;
    }
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
        let second = second(model, job, &opinion, patience, &mut |_| {});
        let answers = (asked, &first[..]);
        let mut verdict = Verdict::of(&checked.recording, &second, &floors, answers, patience);
        checked.runs += 1;
        let mut close = verdict.is_close();
        if !close && rounding.is_empty() {
            rounding = conditioning::reach(model, job, &checked.recording);
            let beyond = Verdict::of(&checked.recording, &second, &rounding, answers, patience);
            close = beyond.is_close();
            if close || chosen {
                verdict = beyond;
            }
        }
        let Verdict::Apart(difference) = &verdict else {
            // what a sharper run does not tell, the comparison before it has told
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
            return checked;
        }
    }
}

/// A run of another setting, which may take so long \[s\].
pub fn second(
    model: &dyn Runs,
    job: &Job,
    opinion: &Setting,
    patience: f64,
    progress: &mut dyn FnMut(f64),
) -> Recording {
    let job = Job {
        time_limit: run::limit(patience),
        // a limit on the steps of a run is none on its check
        max_steps: None,
        ..opinion.job(job)
    };
    simulation::run(model, &job, progress)
}

impl Verdict {
    /// Whether the two are as close as promised, or nothing is known of that.
    fn is_close(&self) -> bool {
        !matches!(self, Verdict::Apart(d) if d.worst > PROMISED || d.worst_response > PROMISED)
    }

    /// What a second run, which might take so long \[s\], says of a run. Outputs that are nowhere larger than their floors do not count, nor
    /// responses, which are given by what they are asked of and their answers of the first run, of signals that shrink.
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
        // what a fixed step is worth nobody knows
        Pace::Step(_) => 1e-8,
    };
    let high = tolerance < HIGH;
    Setting {
        formula: match setting.formula {
            Formula::Tsit5 if high => Formula::Dop853,
            Formula::Tsit5 => Formula::Dopri5,
            _ => Formula::Tsit5,
        },
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
