//! child-seat against scipy's DOP853 and Radau: these integrators share neither code nor error control with ours.
//!
//! `reference/child_seat_scipy.py` made the solutions and documents this. It also gives the growth G of errors, for
//! each entry of the state and each output at each sample: the largest error there after a single step has erred in
//! every entry by 1 + |y|. An integrator that errs in each of n steps by τ (1 + |y|) is off by at most n τ G. Ours
//! allows this in every entry; scipy allows a root mean square of it over N entries, so √N times as much in one entry.
//! No number here was printed by a run.
//!
//! **Kinks that are passed.** The error estimate of a step over a kink is a difference that depends on the position of
//! the kink in the step, and this dependence has zeros. At a random position, such an estimate is too small by a factor
//! F with a probability of about 1/F; for that of DOP853, e₅²/√(e₅² + 0.01 e₃²), with 1/√F. Among K kinks, the most
//! hidden one errs like K steps, or K² for DOP853. K is the count of a run that locates kinks.

use bryant_generated::find;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Report, Tolerances};
use serde_json::Value;
use std::ops::ControlFlow;

/// A row for each sample.
type Rows = Vec<Vec<f64>>;

/// A solution by scipy.
struct Solution {
    name: &'static str,
    states: Rows,
    outputs: Rows,
    /// n τ √N up to each sample.
    allowed: Vec<f64>,
}

struct Data {
    times: Vec<f64>,
    solutions: [Solution; 2],
    state_growth: Rows,
    output_growth: Rows,
    /// Digest of the model that was integrated.
    digest: String,
    names: [Vec<String>; 2],
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn rows(value: &Value) -> Rows {
    let list = value.as_array().expect("a list");
    list.iter().map(numbers).collect()
}

fn data() -> Data {
    let json: Value = serde_json::from_str(include_str!("../reference/child-seat-scipy.json"))
        .expect("reference files are JSON");
    let solution = |name: &'static str| {
        let of = &json[name];
        let states = rows(&of["states"]);
        let tolerance = of["tolerance"].as_f64().expect("a number");
        let spread = f64::sqrt(states[0].len() as f64);
        let steps = numbers(&of["steps"]);
        Solution {
            name,
            outputs: rows(&of["outputs"]),
            allowed: steps.iter().map(|n| n * tolerance * spread).collect(),
            states,
        }
    };
    let names = |of: &str| {
        let list = json["names"][of].as_array().expect("a list");
        let name = |x: &Value| x.as_str().expect("a name").to_owned();
        list.iter().map(name).collect()
    };
    Data {
        times: numbers(&json["times"]),
        solutions: ["DOP853", "Radau"].map(solution),
        state_growth: rows(&json["growth"]["states"]),
        output_growth: rows(&json["growth"]["outputs"]),
        digest: json["digest"].as_str().expect("a digest").to_owned(),
        names: ["state", "outputs"].map(names),
    }
}

/// The place where two solutions differ most, relative to the allowed difference.
#[derive(Debug, Default)]
struct Worst {
    share: f64,
    what: String,
}

impl Worst {
    /// Compares the rows of all samples; a sample may differ by `allowed` times the growth.
    fn look(
        &mut self,
        names: &[String],
        times: &[f64],
        a: &Rows,
        b: &Rows,
        growth: &Rows,
        allowed: &[f64],
    ) {
        assert_eq!([a.len(), b.len(), growth.len()], [times.len(); 3]);
        // both have the same start
        for k in 1..times.len() {
            assert_eq!([a[k].len(), b[k].len(), growth[k].len()], [names.len(); 3]);
            for i in 0..names.len() {
                let (difference, bound) = ((a[k][i] - b[k][i]).abs(), allowed[k] * growth[k][i]);
                // an output that is 0 in both has no growth
                let share = if difference == 0.0 {
                    0.0
                } else {
                    difference / bound
                };
                if share.is_nan() || share > self.share {
                    self.share = share;
                    self.what = format!(
                        "{} at {} s: {} and {}, {difference:.1e} apart, allowed {bound:.1e}",
                        names[i], times[k], a[k][i], b[k][i]
                    );
                }
            }
        }
    }
}

fn compare(data: &Data, a: [&Rows; 2], b: [&Rows; 2], allowed: &[f64]) -> Worst {
    let mut worst = Worst::default();
    let growth = [&data.state_growth, &data.output_growth];
    for of in 0..2 {
        worst.look(
            &data.names[of],
            &data.times,
            a[of],
            b[of],
            growth[of],
            allowed,
        );
    }
    worst
}

#[test]
fn scipys_solutions_agree_with_each_other() {
    let data = data();
    let [a, b] = &data.solutions;
    let allowed: Vec<f64> = a
        .allowed
        .iter()
        .zip(&b.allowed)
        .map(|(a, b)| a + b)
        .collect();
    let worst = compare(
        &data,
        [&a.states, &a.outputs],
        [&b.states, &b.outputs],
        &allowed,
    );
    println!("{worst:?}");
    assert!(worst.share <= 1.0, "{worst:?}");
}

/// A run of child-seat, sampled as the data are.
struct Run {
    states: Rows,
    outputs: Rows,
    report: Report,
}

fn run(times: &[f64], formula: Formula, tolerance: f64, locate: bool, friction: f64) -> Run {
    let entry = find("child-seat").expect("a bundled model").entry;
    let job = Job {
        method: Some(Integrator::adaptive(
            formula,
            Tolerances::uniform(tolerance),
        )),
        locate: Some(locate),
        every: Some(times[1]),
        parameters: vec![("friction".into(), friction)],
        ..Job::default()
    };
    let (mut ours, mut states, mut outputs) = (Vec::new(), Rows::new(), Rows::new());
    let report = entry
        .run(&job, &mut |t, y, o| {
            ours.push(t);
            states.push(y.to_vec());
            outputs.push(o.to_vec());
            ControlFlow::Continue(())
        })
        .unwrap_or_else(|error| panic!("{formula} at {tolerance:e}: {}", error.message));
    assert_eq!(ours.len(), times.len());
    for (ours, theirs) in ours.iter().zip(times) {
        // the times are products in one and decimals in the other
        assert!((ours - theirs).abs() <= f64::EPSILON, "{ours} {theirs}");
    }
    Run {
        states,
        outputs,
        report,
    }
}

/// A run against a solution by scipy; our error is this many tolerances.
fn against(data: &Data, solution: &Solution, run: &Run, tolerances: f64) -> Worst {
    let allowed: Vec<f64> = solution
        .allowed
        .iter()
        .map(|theirs| tolerances + theirs)
        .collect();
    let ours = [&run.states, &run.outputs];
    compare(data, ours, [&solution.states, &solution.outputs], &allowed)
}

/// As the model says.
const FRICTION: f64 = 0.3;

#[test]
fn every_method_agrees_with_scipy_on_child_seat() {
    let data = data();
    let digest = find("child-seat")
        .expect("a bundled model")
        .entry
        .info
        .digest;
    // Heun's method, of order 2, needs so many steps that n τ G is no useful bound at tolerances that it can reach
    let sharp = |f: &Formula| f.estimates_error() && *f != Formula::Heun;
    let at_one = Formula::ALL.into_iter().filter(sharp).map(|f| (f, 1e-9));
    for (formula, tolerance) in at_one.chain([(Formula::Dop853, 1e-11)]) {
        let located = run(&data.times, formula, tolerance, true, FRICTION);
        let passed = run(&data.times, formula, tolerance, false, FRICTION);
        let kinks = located.report.events as f64;
        assert!(kinks > 0.0, "{formula} has met no kink");
        let hidden = match formula {
            Formula::Dop853 => kinks * kinks,
            _ => kinks,
        };
        for (kinks, run, more) in [("located", located, 0.0), ("passed", passed, hidden)] {
            let allowed = (run.report.steps as f64 + more) * tolerance;
            for solution in &data.solutions {
                let worst = against(&data, solution, &run, allowed);
                println!(
                    "{formula} at {tolerance:e}, kinks {kinks}, {} steps, {}: {worst:?}",
                    run.report.steps, solution.name
                );
                assert!(
                    worst.share <= 1.0,
                    "{formula} at {tolerance:e}, kinks {kinks}, against {}: {worst:?}\n\
                     the model was {}, it is {digest}",
                    solution.name,
                    data.digest
                );
            }
        }
    }
}

#[test]
fn a_little_more_friction_does_not_agree() {
    let data = data();
    let (formula, tolerance) = (Formula::Dop853, 1e-11);
    // a ten-thousandth of the friction on the cushion
    let other = run(&data.times, formula, tolerance, true, 1.0001 * FRICTION);
    let allowed = other.report.steps as f64 * tolerance;
    for solution in &data.solutions {
        let worst = against(&data, solution, &other, allowed);
        println!("{worst:?}");
        assert!(worst.share > 1.0, "{}: {worst:?}", solution.name);
    }
}
