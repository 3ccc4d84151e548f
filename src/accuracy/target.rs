//! Computes a run of a requested accuracy, with an estimate of its error.
//!
//! The error is that of the printed numbers: for each output, the largest difference over all samples, relative to the
//! output's largest magnitude in the run. A run at tolerance τ is compared with one at τ/10, this one with one at
//! τ/100, and so on. The sharpest run is the result, and its difference from the run before is the estimate of its
//! error. If the error is proportional to the tolerance, the true error of the result is a ninth of the estimate. This
//! margin is for kinks and friction, with which errors decrease unevenly. A difference may be small by accident: across
//! a kink of a force the error decreases at least like the root of the tolerance. So an estimate is never less than the
//! one before over √10, and there always is one before.
//!
//! The method is chosen by the diagrams of `bryant accuracy` for the bundled models: Tsitouras 5(4) is on the front
//! down to about 1e-7, Dormand–Prince 8(5,3) with kinks located below. Where the scene is stiff, both change to the
//! Rosenbrock method.

use super::check::{Certainty, Checked};
use super::comparison::{Comparison, PROMISED, doubt_lasts, sharper};
use super::setting::{Pace, Setting};
use crate::simulation::{self, Recording, Runs};
use crate::table::{Column, Table};
use bryant_runtime::Formula;
use bryant_runtime::program::{ErrorKind, Job, RunError, Scalar};
use std::collections::HashMap;
use std::hash::Hash;

/// Smallest tolerance; rounding errors make smaller ones useless.
pub(super) const FINEST: f64 = 1e-13;
/// Largest tolerance of the first run.
const COARSEST: f64 = 0.1;
/// Least ratio of an estimate to the one before: 1/√10.
const LEAST: f64 = 0.316;
/// Accuracy below which the method of order 8 is cheapest.
const HIGH: f64 = 1e-7;
/// Size below which an output is noise whose error does not matter, as a share of the largest output with the same
/// unit.
pub(super) const NOISE: f64 = 1e-9;
/// A signal whose size has fallen to this share of that in the first run counts as decreasing with the tolerance.
pub(super) const SHRUNK: f64 = 1e-2;
/// An output whose difference is smaller is known, even if the output is small.
const NEGLIGIBLE: f64 = 1e-3;

/// The difference of two runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The difference of each output, relative to its largest magnitude; 0 for noise.
    pub outputs: Vec<f64>,
    /// The largest of the differences of outputs.
    pub worst: f64,
    /// Name of the output with the largest difference, "" if there is none.
    pub output: String,
    /// The difference of each requested response, relative to itself; empty if one of the runs has no responses. They
    /// do not affect [`Difference::worst`].
    pub responses: Vec<f64>,
    /// The largest of the differences of responses, without responses of signals that are noise or vanish.
    pub worst_response: f64,
    /// Outputs that differ, but are below their floors.
    pub vanishing: Vec<Vanishing>,
}

/// An output of which only a bound is known, such as one that is exactly 0 and decreases with the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Vanishing {
    /// Its name.
    pub output: String,
    /// Unit of the bound.
    pub unit: String,
    /// Its largest magnitude.
    pub bound: f64,
}

impl Difference {
    /// The difference of the outputs of a run from those of a sharper run; infinite if one of them has fewer samples.
    pub fn of(coarse: &Table, sharp: &Table) -> Difference {
        Self::beyond(coarse, sharp, &[])
    }

    /// The difference of the outputs as [`Difference::of`] computes it, with floors: an output that never exceeds its
    /// floor is vanishing, and its error does not count.
    pub fn beyond(coarse: &Table, sharp: &Table, floors: &[f64]) -> Difference {
        // the first column is the time
        let columns: Vec<(&Column, &Column)> =
            coarse.columns.iter().zip(&sharp.columns).skip(1).collect();
        let size = |(a, b): &(&Column, &Column)| largest(&a.values).max(largest(&b.values));
        let sizes: Vec<f64> = columns.iter().map(size).collect();
        let units = columns.iter().map(|(_, sharp)| sharp.unit.as_str());
        let scales = largest_by_unit(units.zip(sizes.iter().copied()));
        let mut vanishing = Vec::new();
        let outputs: Vec<f64> = columns
            .iter()
            .enumerate()
            .map(|(index, (coarse, sharp))| {
                if coarse.values.len() != sharp.values.len() {
                    return f64::INFINITY;
                }
                if sizes[index] <= NOISE * scales[sharp.unit.as_str()] {
                    return 0.0;
                }
                let own = largest(&sharp.values);
                let both = coarse.values.iter().zip(&sharp.values);
                let error = both.fold(0.0f64, |m, (a, b)| m.max(apart(*a, *b))) / own;
                let counts = floors.get(index).is_none_or(|floor| own > *floor);
                if counts || error <= NEGLIGIBLE {
                    return error;
                }
                vanishing.push(Vanishing {
                    output: sharp.name.clone(),
                    unit: sharp.unit.clone(),
                    bound: own,
                });
                0.0
            })
            .collect();
        let worst = outputs.iter().fold(0.0f64, |m, x| m.max(*x));
        let index = outputs.iter().position(|error| *error == worst);
        let output = index.and_then(|index| sharp.columns.get(index + 1));
        Difference {
            output: output.map_or(String::new(), |column| column.name.clone()),
            outputs,
            worst,
            responses: Vec::new(),
            worst_response: 0.0,
            vanishing,
        }
    }

    /// True if no output and no response differs by more than `limit`.
    pub fn is_within(&self, limit: f64) -> bool {
        self.worst <= limit && self.worst_response <= limit
    }

    /// Raises each error to at least the share `share` of the error in `other`.
    fn at_least(mut self, other: Option<&Difference>, share: f64) -> Difference {
        let Some(other) = other else { return self };
        for (error, other) in self.outputs.iter_mut().zip(&other.outputs) {
            *error = error.max(share * other);
        }
        for (error, other) in self.responses.iter_mut().zip(&other.responses) {
            *error = error.max(share * other);
        }
        self.worst_response = self.worst_response.max(share * other.worst_response);
        if self.worst < share * other.worst {
            self.worst = share * other.worst;
            self.output.clone_from(&other.output);
        }
        self
    }
}

/// The difference of two values; infinite if exactly one of them is NaN.
fn apart(a: f64, b: f64) -> f64 {
    match a == b || (a.is_nan() && b.is_nan()) {
        true => 0.0,
        false => Some((a - b).abs())
            .filter(|d| !d.is_nan())
            .unwrap_or(f64::INFINITY),
    }
}

/// The largest size for each unit.
pub(super) fn largest_by_unit<U: Eq + Hash>(
    sizes: impl Iterator<Item = (U, f64)>,
) -> HashMap<U, f64> {
    let mut scales = HashMap::new();
    for (unit, size) in sizes {
        let scale = scales.entry(unit).or_insert(0.0f64);
        *scale = scale.max(size);
    }
    scales
}

/// The largest magnitude of some values.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |m, x| m.max(x.abs()))
}

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
        pace: Pace::Tolerance(rounded(wanted).clamp(100.0 * FINEST, COARSEST)),
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
        pace: Pace::Tolerance(rounded(1e-2 * tolerance).clamp(FINEST, 1e-6)),
        scalar: Scalar::F64,
        locate: true,
    }
}

/// The tolerance rounded to two digits.
pub(super) fn rounded(tolerance: f64) -> f64 {
    format!("{tolerance:.1e}").parse().unwrap_or(tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(columns: &[(&str, &str, &[f64])]) -> Table {
        let column = |(name, unit, values): &(&str, &str, &[f64])| Column {
            name: name.to_string(),
            unit: unit.to_string(),
            values: values.to_vec(),
        };
        Table {
            columns: columns.iter().map(column).collect(),
        }
    }

    #[test]
    fn differences_are_relative_to_the_largest_of_each_output() {
        let coarse = table(&[
            ("time", "s", &[0.0, 1.0]),
            ("force", "N", &[0.0, 101.0]),
            ("angle", "rad", &[0.5, -0.25]),
            ("noise", "N", &[1e-9, 0.0]),
        ]);
        let sharp = table(&[
            ("time", "s", &[0.0, 1.0]),
            ("force", "N", &[0.0, 100.0]),
            ("angle", "rad", &[0.5, -0.26]),
            ("noise", "N", &[0.0, 1e-9]),
        ]);
        let difference = Difference::of(&coarse, &sharp);
        for (found, expected) in difference.outputs.iter().zip([0.01, 0.02, 0.0]) {
            assert!((found - expected).abs() < 1e-15, "{difference:?}");
        }
        assert_eq!(difference.output, "angle");
        let lucky = Difference::of(&sharp, &sharp).at_least(Some(&difference), 0.1);
        assert!((lucky.worst - 0.002).abs() < 1e-15 && lucky.output == "angle");
    }

    #[test]
    fn what_one_run_alone_has_seen_is_no_noise() {
        let hit = table(&[("time", "s", &[0.0, 1.0]), ("force", "N", &[0.0, 9.0])]);
        let miss = table(&[("time", "s", &[0.0, 1.0]), ("force", "N", &[0.0, 0.0])]);
        assert_eq!(Difference::of(&hit, &miss).worst, f64::INFINITY);
        assert_eq!(Difference::of(&miss, &hit).worst, 1.0);
        assert_eq!(Difference::of(&miss, &miss).worst, 0.0);
        let wrong = table(&[("time", "s", &[0.0, 1.0]), ("force", "N", &[0.0, f64::NAN])]);
        assert_eq!(Difference::of(&wrong, &hit).worst, f64::INFINITY);
        assert_eq!(Difference::of(&hit, &wrong).worst, f64::INFINITY);
    }

    #[test]
    fn runs_of_different_lengths_have_nothing_in_common() {
        let long = table(&[("time", "s", &[0.0, 1.0]), ("x", "m", &[0.0, 1.0])]);
        let short = table(&[("time", "s", &[0.0]), ("x", "m", &[0.0])]);
        assert_eq!(Difference::of(&short, &long).worst, f64::INFINITY);
    }

    #[test]
    fn a_second_opinion_is_another_method() {
        for formula in Formula::ALL {
            let setting = Setting {
                formula,
                switches: false,
                pace: Pace::Tolerance(1e-4),
                scalar: Scalar::F64,
                locate: false,
            };
            let opinion = second_opinion(&setting);
            assert!(opinion.formula != formula && opinion.locate);
            assert_eq!(opinion.pace, Pace::Tolerance(1e-6));
        }
    }
}
