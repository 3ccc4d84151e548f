//! Checks a run by a second run, which uses another formula and a tenth of the tolerance.
//!
//! A run at the default tolerance promises an error of at most [`PROMISED`] in every output, relative to the output's
//! largest magnitude. If the second run differs by more, in an output or in a response (relative to the response
//! itself), the run is repeated, each time at a tenth of the tolerance and by the other formula, until two successive
//! runs agree. The sharper of the two is the result.
//!
//! Where the scene is stiff, the second run changes to the Rosenbrock method, as the first one does. There both use the
//! same formula, but the second has a tenth of the tolerance.
//!
//! A doubt that more accuracy does not remove, such as a law that is singular where the motion goes, ends this as soon
//! as two runs have it ([`doubt_lasts`]).
//!
//! If the user chose the method, the run promises nothing. It is not repeated, and cannot be trusted only if the
//! difference exceeds [`FAR`].

use super::cause::{self, Cause};
use super::comparison::{Comparison, FINEST, PROMISED, doubt_lasts, sharper};
use super::difference::Difference;
use super::run;
use super::setting::{Pace, Setting};
use super::target::second_opinion;
use crate::simulation::{self, Recording, Runs};
use bryant_runtime::Formula;
use bryant_runtime::program::{ErrorKind, Job, Scalar};
use std::time::{Duration, Instant};

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

/// A run, and what other runs of its job tell about its error.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The run, or the sharpest run, which replaces it.
    pub recording: Recording,
    /// What is known about its error.
    pub certainty: Certainty,
}

/// What is known about the error of a run.
#[derive(Clone, Debug)]
pub struct Certainty {
    /// The setting of the run, if the program chose it.
    pub setting: Option<Setting>,
    /// The error that the user allows.
    pub wanted: Option<f64>,
    /// Number of all runs.
    pub runs: usize,
    /// The error, estimated by sharper and sharper runs; `None` if no two of them could be compared.
    pub estimate: Option<Difference>,
    /// The difference of the first run from its check, if sharper runs followed.
    pub first: Option<Difference>,
    /// The setting of the second run, and its verdict; `None` if there is none.
    pub check: Option<(Setting, Verdict)>,
    /// The run cannot be trusted if it differs from its check by more than this share.
    pub limit: f64,
    /// True if there was not enough time for sharper runs.
    pub out_of_time: bool,
    /// The reason why the run is less accurate than promised, although sharper runs followed.
    pub cause: Option<Cause>,
}

impl Certainty {
    /// Nothing is known about the error of the first run, which must not differ from a check by more than `limit`.
    pub fn none(limit: f64) -> Self {
        Certainty {
            setting: None,
            wanted: None,
            runs: 1,
            estimate: None,
            first: None,
            check: None,
            limit,
            out_of_time: false,
            cause: None,
        }
    }
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
    let mut recording = simulation::run(model, job, &mut |t| progress(0, t));
    let mut known = Certainty::none(if chosen { FAR } else { PROMISED });
    if recording.result.is_ok() {
        let of = (&mut recording, &mut known);
        sharpen(model, job, chosen, of, progress);
    }
    Checked {
        recording,
        certainty: known,
    }
}

/// Checks a run, and replaces it by sharper ones until two of them agree.
fn sharpen(
    model: &dyn Runs,
    job: &Job,
    chosen: bool,
    (recording, known): (&mut Recording, &mut Certainty),
    progress: &mut dyn FnMut(usize, f64),
) {
    let mut setting = Setting::of(job).as_run(&recording.result);
    let begin = Instant::now();
    let wall = recording.wall.as_secs_f64();
    let end = LONGEST[0].max(LONGEST[1] * wall);
    let mut patience = end;
    let mut comparison = Comparison::of(model, job, &recording.answers);
    loop {
        let opinion = opinion(&setting);
        let mut hear = |t: f64| progress(known.runs, t);
        let second = second(model, job, &opinion, patience, &mut hear);
        let opinion = opinion.as_run(&second.result);
        let verdict = Verdict::of(&mut comparison, (job, recording), &second, patience);
        known.runs += 1;
        let Verdict::Apart(difference) = &verdict else {
            // a sharper run that failed says nothing new: the comparison before it remains valid
            match known.first {
                None => known.check = Some((opinion, verdict)),
                Some(_) => known.out_of_time = matches!(verdict, Verdict::TooLong(_)),
            }
            return;
        };
        let close = difference.is_within(PROMISED);
        let lasts = doubt_lasts([recording, &second], &opinion);
        if chosen || lasts || (close && known.first.is_none()) {
            known.check = Some((opinion, verdict));
            return;
        }
        if known.first.is_none() {
            known.first = Some(difference.clone());
            comparison.leave_out_what_shrinks(recording);
        }
        known.check = Some((setting, verdict));
        (*recording, setting) = (second, opinion);
        known.setting = Some(setting);
        let finest = opinion.pace.value() <= FINEST;
        patience = end - begin.elapsed().as_secs_f64();
        known.out_of_time = patience <= 0.0 && !close && !finest;
        if close || finest || known.out_of_time {
            if let (false, Some((_, Verdict::Apart(difference)))) = (close, &known.check) {
                let patience = Duration::try_from_secs_f64(end).unwrap_or(Duration::MAX);
                let job = setting.job(job);
                let of = (&*recording, difference);
                known.cause = Some(cause::find(model, &job, of, &comparison.rounding, patience));
            }
            return;
        }
    }
}

/// Checks the run of a setting by a far sharper one, however long that takes. `made_by` is the job of the run.
pub fn verify(
    model: &dyn Runs,
    (made_by, run): (&Job, &Recording),
    progress: &mut dyn FnMut(f64),
) -> (Setting, Verdict) {
    let opinion = second_opinion(&Setting::of(made_by));
    let patience = f64::INFINITY;
    let second = second(model, made_by, &opinion, patience, progress);
    let mut comparison = Comparison::of(model, made_by, &[]);
    let verdict = Verdict::of(&mut comparison, (made_by, run), &second, patience);
    (opinion.as_run(&second.result), verdict)
}

/// Runs the job with another setting, for at most `patience` \[s\].
fn second(
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
    /// The verdict of a second run, which had the time limit `patience` \[s\]; `run` is the first one with its job.
    fn of(
        comparison: &mut Comparison<'_>,
        run: (&Job, &Recording),
        second: &Recording,
        patience: f64,
    ) -> Self {
        match &second.result {
            Ok(_) => Verdict::Apart(comparison.difference([run.1, second], PROMISED, run)),
            Err(error) if error.kind == ErrorKind::Time => Verdict::TooLong(patience),
            Err(error) => Verdict::Failed(error.message.clone()),
        }
    }
}

/// The setting with the other formula, and a tenth of the tolerance.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn opinion(setting: &Setting) -> Setting {
    let tolerance = sharper(setting);
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
    }
}
