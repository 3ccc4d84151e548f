//! The default accuracy of a run: better than 0.1 % in every output.

use crate::estimates::engine_of;
use crate::share::share;
use bryant::accuracy::difference::Difference;
use bryant::{bundled, simulation};
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};

/// The promise of the README and of docs/accuracy.md, at the sampling that the models ask for.
const PROMISED: f64 = 1e-3;

#[test]
fn bundled_models_err_by_less_than_a_thousandth_by_default() {
    for bundled in share(3, bundled::all()) {
        let model = bundled::model(bundled).expect("bundled models are right");
        let engine = engine_of(&model);
        let run = |job: &Job| simulation::run(&engine, job, &mut |_| {});
        let default = run(&Job::default());
        // two different methods, both far sharper, show the error
        let [one, other] = [Formula::Dop853, Formula::Tsit5].map(|formula| {
            run(&Job {
                method: Some(Integrator::adaptive(formula, Tolerances::of(1e-10))),
                locate: Some(formula == Formula::Dop853),
                ..Job::default()
            })
        });
        let name = bundled.name;
        let apart = Difference::of(&other.table, &one.table);
        assert!(apart.worst < 0.01 * PROMISED, "{name}: {apart:?}");
        let error = Difference::of(&default.table, &one.table);
        assert!(error.worst < PROMISED, "{name}: {error:?}");
    }
}

/// The belts of this scene turn from loading to unloading in every step if an oscillation may grow as the tolerance
/// alone says.
#[test]
fn a_loose_tolerance_takes_no_more_steps_than_the_usual_one() {
    let bundled = bundled::find("belt-sled").expect("a bundled model");
    let model = bundled::model(bundled).expect("bundled models are right");
    let engine = engine_of(&model);
    let steps = |tolerance: f64| {
        let tolerances = Tolerances::of(tolerance).calm();
        let job = Job {
            method: Some(Integrator::switching(Formula::Dopri5, tolerances)),
            // the belt is loaded, and lets go
            duration: Some(0.08),
            ..Job::default()
        };
        let run = simulation::run(&engine, &job, &mut |_| {});
        run.result.expect("a run").steps
    };
    let usual = steps(1e-7);
    for tolerance in [1e-1, 1e-2, 1e-3, 1e-4] {
        let loose = steps(tolerance);
        assert!(loose <= usual, "{loose} at {tolerance}, {usual} at 1e-7");
    }
}
