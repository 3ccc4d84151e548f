//! For a stiff model, the method for stiff models is by far the cheapest: a hand is pressed against a stop of 1e6
//! N·m/rad while the arm that carries it swings slowly (`models/joint-stop.yaml`).
//!
//! Work is counted in evaluations of the derivative, not timed. A Jacobian takes an evaluation over dual numbers for
//! each of the n entries of the state and one for the time. A product of dual numbers is three products and a sum, and
//! a sine also needs its cosine: each of these evaluations counts as four. Each step, including rejected ones, factors
//! a matrix and solves for eight stages, which takes n³/3 + 8 n² products and as many sums; the accelerations of this
//! model take 42 operations and 4 sines or cosines, at least 46.
//!
//! The error of an output is the largest over the samples, relative to its largest magnitude; the error of a run is the
//! worst of its outputs. For explicit methods, the cheapest setting that happens to reach an accuracy counts. For the
//! method for stiff models, the cheapest setting counts from which on all smaller tolerances reach it, too, because a
//! user does not know the solution.

use bryant_runtime::simulate::{Integrator, Report, Settings};
use bryant_runtime::{
    Differentiable, Formula, Model, ParameterSet, Sample, Tolerances, Vector, simulate,
};
use bryant_tests::models::joint_stop::Mechanism;
use std::ops::ControlFlow;

type Arm = Mechanism<f64>;
type State = <Arm as Model<f64>>::State;

/// n
const ENTRIES: u64 = <State as Vector<f64>>::LEN as u64;
/// An evaluation over dual numbers counts as this many evaluations.
const DUAL: u64 = 4;
/// The linear algebra of a step counts as this many evaluations.
const LINEAR_ALGEBRA: u64 = 2 * (ENTRIES.pow(3) / 3 + 8 * ENTRIES.pow(2)) / 46 + 1;

const TOLERANCES: [f64; 7] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// From the time between samples down to a fortieth of the period with which the hand would oscillate against the stop.
const STEPS: [f64; 7] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5];

/// From this sample on, the hand lies against the stop.
const PRESSED: usize = 10;

/// A run to the end.
struct Run {
    states: Vec<State>,
    outputs: Vec<Vec<f64>>,
    report: Report,
}

impl Run {
    fn work(&self) -> u64 {
        let report = &self.report;
        let steps = match report.jacobians {
            0 => 0,
            _ => report.steps + report.rejected,
        };
        report.evaluations + report.jacobians * (ENTRIES + 1) * DUAL + steps * LINEAR_ALGEBRA
    }
}

/// Runs from the start, or from a later state, to the end.
fn run(method: Integrator, locate: bool, from: Option<(&State, f64)>) -> Result<Run, String> {
    let model = Arm::new(<<Arm as Model<f64>>::Parameters as ParameterSet<f64>>::defaults());
    let (start, passed) = from.map_or((model.initial_state(), 0.0), |(y, t)| (*y, t));
    let settings = Settings {
        method,
        locate,
        duration: Arm::INFO.duration - passed,
        ..Settings::of(Arm::INFO)
    };
    let (mut states, mut outputs) = (vec![], vec![]);
    let sink = &mut |sample: Sample<'_, f64>| {
        states.push(*State::of(sample.state));
        outputs.push(sample.outputs.to_vec());
        ControlFlow::Continue(())
    };
    let model = Differentiable(&model);
    let report = simulate::run(&model, &start, &settings, None, sink);
    let report = report.map_err(|failure| failure.to_string())?;
    Ok(Run {
        states,
        outputs,
        report,
    })
}

fn sharp(formula: Formula, tolerance: f64) -> Run {
    let method = Integrator::adaptive(formula, Tolerances::of(tolerance));
    run(method, true, None).unwrap_or_else(|failure| panic!("{failure}"))
}

/// The reference.
fn reference() -> Run {
    sharp(Formula::Dop853, 1e-12)
}

/// The largest magnitude of a column.
fn size<R: AsRef<[f64]>>(rows: &[R], column: usize) -> f64 {
    let magnitudes = rows.iter().map(|row| row.as_ref()[column].abs());
    magnitudes.fold(0.0, f64::max)
}

/// The largest difference in a column; infinite where a sample is missing or not finite.
fn difference<R: AsRef<[f64]>>(expected: &[R], found: &[R], column: usize) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    let of = |(a, b): (&R, &R)| (a.as_ref()[column] - b.as_ref()[column]).abs();
    let differences = expected.iter().zip(found).map(of);
    differences.fold(0.0, |m, x| if x <= m { m } else { x.min(f64::INFINITY) })
}

/// The worst error of an output.
fn error(reference: &[Vec<f64>], outputs: &[Vec<f64>]) -> f64 {
    let columns = 0..reference[0].len();
    let errors = columns.map(|k| difference(reference, outputs, k) / size(reference, k));
    errors.fold(0.0, f64::max)
}

/// All settings of a formula, from coarse to fine, with kinks located or passed.
fn settings(formula: Formula, locate: bool) -> [Vec<(Integrator, bool)>; 2] {
    let adaptive = TOLERANCES.map(|t| Integrator::adaptive(formula, Tolerances::of(t)));
    let adaptive = adaptive.into_iter().filter(|_| formula.estimates_error());
    let fixed = STEPS
        .map(|step| Integrator::fixed(formula, step))
        .into_iter();
    [
        adaptive.map(|method| (method, locate)).collect(),
        fixed.map(|method| (method, locate)).collect(),
    ]
}

/// Runs with all settings, or why they failed.
type Runs = Vec<Result<Run, String>>;

fn all(settings: &[(Integrator, bool)]) -> Runs {
    let runs = settings
        .iter()
        .map(|(method, locate)| run(*method, *locate, None));
    runs.collect()
}

#[test]
fn two_methods_agree_on_the_reference() {
    let (explicit, implicit) = (reference(), sharp(Formula::Rodas5, 1e-11));
    // at the compared accuracies, two digits and more below
    let apart = error(&explicit.outputs, &implicit.outputs);
    assert!(apart < 1e-5, "{apart:e}");
}

#[test]
fn a_hand_pressed_on_a_stop_is_cheapest_by_the_stiff_method() {
    let reference = reference().outputs;
    let runs: Vec<(Formula, [Runs; 4])> = Formula::ALL
        .into_iter()
        .map(|formula| {
            let [located, passed] = [true, false].map(|locate| settings(formula, locate));
            let [[a, b], [c, d]] = [located, passed];
            (formula, [a, b, c, d].map(|settings| all(&settings)))
        })
        .collect();
    for accuracy in [1e-2, 1e-3] {
        let meets = |run: &Result<Run, String>| {
            let run = run.as_ref().ok();
            run.is_some_and(|run| error(&reference, &run.outputs) <= accuracy)
        };
        let work = |run: &Result<Run, String>| run.as_ref().ok().map(Run::work);
        let least = |series: &[Runs; 4]| {
            let accurate = series.iter().flatten().filter(|run| meets(run));
            accurate.filter_map(work).min()
        };
        let confirmed = |series: &[Runs; 4]| {
            let confirmed = series.iter().flat_map(|runs| {
                let refuted = runs.iter().rposition(|run| !meets(run));
                &runs[refuted.map_or(0, |i| i + 1)..]
            });
            confirmed.filter_map(work).min()
        };
        let (stiff, explicit): (Vec<_>, Vec<_>) = runs
            .iter()
            .partition(|(formula, _)| *formula == Formula::Rodas5);
        let stiff = confirmed(&stiff[0].1).expect("an accurate run");
        for (formula, series) in explicit {
            let explicit = least(series).expect("an accurate run");
            println!("{formula:20} {accuracy:e}: {explicit} instead of {stiff}");
            assert!(stiff < explicit, "{formula} at {accuracy:e}");
        }
    }
}

#[test]
fn steps_of_the_stiff_method_on_the_stop_are_100_times_longer() {
    let reference = reference();
    let every = Arm::INFO.every;
    let from = (&reference.states[PRESSED], PRESSED as f64 * every);
    let steps = |formula| {
        let method = Integrator::adaptive(formula, Tolerances::of(1e-3));
        let run = run(method, true, Some(from)).unwrap_or_else(|failure| panic!("{failure}"));
        println!(
            "{formula:20} {} steps, {} rejected",
            run.report.steps, run.report.rejected
        );
        run.report.steps + run.report.rejected
    };
    let stiff = steps(Formula::Rodas5);
    for formula in Formula::ALL.into_iter().filter(|f| f.estimates_error()) {
        if formula != Formula::Rodas5 {
            let explicit = steps(formula);
            assert!(explicit > 100 * stiff, "{formula}: {explicit}, {stiff}");
        }
    }
}

/// A step may err in an angle by the tolerance, relative to its magnitude. The motion does not diverge, so some hundred
/// such errors add up in the angles, as in any other run. In the rates there is ω_n times one error: the stop throws
/// the hand back with no more than the speed that the error of an angle presses it in with, where ω_n² = k (M₁₁ + 2
/// M₁₂ + M₂₂)/(M₁₁ M₂₂ − M₁₂²), and the damping removes this before the next error.
#[test]
fn no_tolerance_lets_a_method_run_away_from_a_stop() {
    const SUM: f64 = 100.0;
    // M₁₁ = 0.12 + 4·0.3² + 0.5·0.6², M₁₂ = 0.5·0.6·0.08·cos 30°, M₂₂ = 0.001 + 0.5·0.08²
    let [m11, m12, m22] = [0.66, 0.024 * 30f64.to_radians().cos(), 0.0042f64];
    let omega = (1e6 * (m11 + 2.0 * m12 + m22) / (m11 * m22 - m12 * m12)).sqrt();
    let reference = reference().states;
    let angle = size(&reference, 0).max(size(&reference, 1));
    for formula in Formula::ALL.into_iter().filter(|f| f.estimates_error()) {
        for locate in [true, false] {
            for tolerance in TOLERANCES {
                let method = Integrator::adaptive(formula, Tolerances::of(tolerance));
                let run = run(method, locate, None)
                    .unwrap_or_else(|e| panic!("{formula} {locate} {tolerance:e}: {e}"));
                for entry in 0..ENTRIES as usize {
                    let factor = if entry < 2 { SUM } else { omega };
                    let error = difference(&reference, &run.states, entry);
                    assert!(
                        error <= factor * tolerance * angle,
                        "{formula} {locate} {tolerance:e}: {error:e} in entry {entry}"
                    );
                }
            }
        }
    }
}
