//! Switches fire at the times of closed forms, and forces that wait for them act from then on.
//!
//! The ball of `models/switches.yaml` moves with piecewise constant accelerations: polynomials of the second degree,
//! which the integrator and its interpolant follow exactly. The error is rounding, of order ε for each step, and the
//! width to which an event is located, 1e-13 of a step, divided by the rate at which the quantity passes its threshold.

use bryant_runtime::program::{Entry, Job};
use bryant_runtime::{Formula, Integrator};
use bryant_tests::models;
use bryant_tests::runs::{Recording, run};
use std::ops::ControlFlow;

const TOLERANCE: f64 = 1e-9;

fn entry() -> Entry {
    models::switches::ENTRY
}

fn last(run: &Recording, name: &str) -> f64 {
    let column = run.column(name);
    column[column.len() - 1]
}

/// A bound on the rounding of a run over numbers of order 1: 8 roundings for each step, and the location of an event in
/// a step, which is at most as long as the run of 1 s.
fn rounding(run: &Recording) -> f64 {
    8.0 * f64::EPSILON * run.steps + 1e-13
}

fn close(what: &str, ours: f64, expected: f64, bound: f64) {
    let error = (ours - expected).abs();
    assert!(
        error <= bound,
        "{what}: {ours} instead of {expected}, off by {error:e}, allowed {bound:e}"
    );
}

#[test]
fn switches_fire_by_time_height_speed_acceleration_and_switch() {
    let run = run(&entry(), &[], TOLERANCE);
    let bound = rounding(&run);
    close("ignition", last(&run, "ignition"), 0.11, bound);
    // 4 t − 5 t² = 0.6, passed with 2 m/s
    close("high", last(&run, "high"), 0.2, bound);
    close("high delayed", last(&run, "high delayed"), 0.23, bound);
    // −10 m/s² up to there, −6 from there on: 1.7 m/s − 6 m/s² t = −1 m/s
    close("falling", last(&run, "falling"), 0.68, bound);
    // the thrust causes 3 m/s² at once, and the acceleration is observed from its beginning
    close("hard", last(&run, "hard"), 0.11, bound);
    close("after hard", last(&run, "after hard"), 0.11, bound);
    // 3 m/s² between 0.11 s and 0.2 s
    close("speed", last(&run, "vx"), 1.27, bound);
    let way = 1.0 + 0.5 * 3.0 * 0.09 * 0.09 + 3.0 * 0.09 * 0.8;
    close("way", last(&run, "x"), way, bound);
    close("spin", last(&run, "spin"), 0.89, bound);

    for (t, (on, high)) in run
        .times
        .iter()
        .zip(run.column("on").into_iter().zip(run.column("high")))
    {
        // the time of an event that has happened is known, otherwise it is −1; for an event at a sample, rounding
        // decides
        if (t - 0.68).abs() <= bound {
            continue;
        }
        assert_eq!(on, if *t > 0.68 { 1.0 } else { 0.0 }, "at {t} s");
        assert_eq!(high == -1.0, *t <= 0.2, "{high} at {t} s");
    }
}

#[test]
fn what_is_true_at_the_start_fires_there() {
    let set = [("ignition", 0.0), ("height", -1.0), ("delay", 0.0)];
    let run = run(&entry(), &set, TOLERANCE);
    for name in ["ignition", "high", "high delayed"] {
        assert_eq!(run.column(name)[0], 0.0, "{name}");
    }
    // high at once: the thrust never acts, and the other load always does
    assert_eq!(last(&run, "vx"), 1.0);
    assert_eq!(last(&run, "hard"), -1.0);
    close("vz", last(&run, "vz"), 4.0 - 6.0, rounding(&run));
}

#[test]
fn two_switches_may_fire_in_one_instant() {
    let run = run(&entry(), &[("ignition", 0.2)], TOLERANCE);
    let bound = rounding(&run);
    close("ignition", last(&run, "ignition"), 0.2, bound);
    close("high", last(&run, "high"), 0.2, bound);
    // whatever their order, the thrust had no time to act
    close("speed", last(&run, "vx"), 1.0, 3.0 * bound);
}

#[test]
fn a_delay_may_be_longer_than_the_run() {
    let run = run(&entry(), &[("delay", 0.9)], TOLERANCE);
    assert_eq!(last(&run, "high delayed"), -1.0);
    close("vz", last(&run, "vz"), 4.0 - 10.0, rounding(&run));
}

#[test]
fn fixed_steps_end_at_a_switch_too() {
    let step = 1e-3;
    let job = Job {
        method: Some(Integrator::fixed(Formula::Rk4, step)),
        ..Job::default()
    };
    let entry = entry();
    let column = |name: &str| entry.info.outputs.iter().position(|o| o.name == name);
    let (high, delayed) = (column("high").unwrap(), column("high delayed").unwrap());
    let mut row = Vec::new();
    entry
        .run(&job, &mut |_, _, outputs| {
            row = outputs.to_vec();
            ControlFlow::Continue(())
        })
        .unwrap_or_else(|error| panic!("{}", error.message));
    for (found, crossing) in [(row[high], 0.2), (row[delayed], 0.23)] {
        // the motion is a parabola, which the interpolant follows up to rounding
        assert!((found - crossing).abs() < 1e-12, "{found}");
    }
}
