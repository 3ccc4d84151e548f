//! Computes a run of a requested accuracy, with an estimate of its error.
//!
//! The error is that of the printed numbers: for each output, the largest difference over all samples, relative to the
//! output's largest magnitude in the run. The first run has the tolerance τ: the wanted accuracy, but at most 10⁻⁵. It
//! is compared with one at τ/10, this one with one at τ/100, and so on. The sharpest run is the result, and its
//! difference from the run before is the estimate of its error. If the error is proportional to the tolerance, the true
//! error of the result is a ninth of the estimate. This margin is for kinks and friction, with which errors decrease
//! unevenly. A difference may be small by accident: across a kink of a force the error decreases at least like the root
//! of the tolerance. So an estimate is never less than the one before over √10, and there always is one before.
//!
//! The method is chosen by the diagrams of `bryant accuracy` for the bundled models: Tsitouras 5(4) is on the front
//! down to about 1e-7, Dormand–Prince 8(5,3) with kinks located below. Where the scene is stiff, both change to the
//! Rosenbrock method.

use super::check::{Certainty, Checked};
use super::comparison::{Comparison, FINEST, PROMISED, doubt_lasts, sharper};
use super::setting::{Pace, Setting, two_digits};
use crate::simulation::{self, Recording, Runs};
use bryant_runtime::Formula;
use bryant_runtime::program::{ErrorKind, Job, RunError, Scalar};

/// Largest tolerance of the first run. Above it the steps of a stiff scene become no longer, and two runs may have the
/// same error ([`Tolerances::calm`](bryant_runtime::Tolerances::calm)).
const COARSEST: f64 = 1e-5;
/// Least ratio of an estimate to the one before: 1/√10.
const LEAST: f64 = 0.316;
/// Accuracy below which the method of order 8 is cheapest.
const HIGH: f64 = 1e-7;
/// Runs a job until the estimated error of its outputs and responses is at most `wanted`. `progress` is called with the
/// share of a run that is done. If a run fails, the recording has the reason.
pub fn run(model: &dyn Runs, job: &Job, wanted: f64, progress: &mut dyn FnMut(f64)) -> Checked {
    let mut setting = Setting {
        formula: if wanted < HIGH {
            Formula::Dop853
        } else {
            Formula::Tsit5
        },
        switches: true,
        pace: Pace::Tolerance(two_digits(wanted).clamp(100.0 * FINEST, COARSEST)),
        scalar: Scalar::F64,
        locate: wanted < HIGH,
    };
    let mut recording = simulation::run(model, &setting.job(job), progress);
    let mut comparison = Comparison::of(model, job, &recording.answers);
    let mut comparisons = 0;
    let mut known = Certainty {
        wanted: Some(wanted),
        ..Certainty::none(wanted.max(PROMISED))
    };
    loop {
        let refused = matches!(
            &recording.result,
            Err(RunError {
                kind: ErrorKind::Job | ErrorKind::Stopped,
                ..
            })
        );
        let close = known.estimate.as_ref().is_some_and(|e| e.is_within(wanted));
        let good = comparisons > 1 && close;
        if refused || good || setting.pace.value() <= FINEST {
            break;
        }
        let next = Setting {
            pace: Pace::Tolerance(sharper(&setting)),
            ..setting
        };
        let sharper = simulation::run(model, &next.job(job), progress);
        if interrupted(&sharper) {
            // the user stopped the sharper run; the run before is complete
            break;
        }
        known.runs += 1;
        known.estimate = match (&recording.result, &sharper.result) {
            (Ok(_), Ok(_)) => {
                let made_by = (&next.job(job), &sharper);
                let apart = comparison.difference([&recording, &sharper], wanted, made_by);
                comparisons += 1;
                Some(apart.at_least(known.estimate.as_ref(), LEAST))
            }
            _ => {
                comparisons = 0;
                None
            }
        };
        let lasts = doubt_lasts([&recording, &sharper], &next);
        (recording, setting) = (sharper, next);
        if lasts {
            break;
        }
    }
    known.setting = Some(setting);
    Checked {
        recording,
        certainty: known,
    }
}

/// True if the user stopped the run.
fn interrupted(recording: &Recording) -> bool {
    matches!(&recording.result, Err(error) if error.kind == ErrorKind::Stopped)
}

/// A setting for a check of a run: sharper, by another formula, with kinks located.
pub fn second_opinion(setting: &Setting) -> Setting {
    let tolerance = match setting.pace {
        Pace::Tolerance(tolerance) => tolerance,
        // the accuracy of a fixed step is not known
        Pace::Step(_) => 1e-6,
    };
    Setting {
        formula: match setting.formula {
            Formula::Dop853 => Formula::Tsit5,
            _ => Formula::Dop853,
        },
        switches: true,
        pace: Pace::Tolerance(two_digits(1e-2 * tolerance).clamp(FINEST, 1e-6)),
        scalar: Scalar::F64,
        locate: true,
    }
}
