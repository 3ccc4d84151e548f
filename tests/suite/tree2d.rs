//! The planar tree of `reference/tree2d.yaml`: S, right-hand side, accelerations, and the motion from there.
//!
//! The reference uses an x–y plane with counter-clockwise angles α. With z = y and φ = −α all vectors stay the same,
//! and the rows and columns of the angles change sign: S = D S' D, r = D r', D = diag(1, 1, −1, −1, −1, −1).

use crate::motion::{at, close, run_with_bound};
use bryant::evaluation::{self, State};
use bryant_engine::Engine;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Route;
use bryant_generator::program::{self, lists};
use bryant_tests::models::{self, MODELS};
use serde_yaml::Value;

const SIGNS: [f64; 6] = [1.0, 1.0, -1.0, -1.0, -1.0, -1.0];

fn reference() -> Value {
    serde_yaml::from_str(include_str!("../reference/tree2d.yaml"))
        .expect("reference files are YAML")
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_sequence().expect("a list");
    list.iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// Numbers of the reference (coordinates, velocities or both), in our convention.
fn turned(value: &Value) -> Vec<f64> {
    numbers(value)
        .iter()
        .zip(SIGNS.iter().cycle())
        .map(|(x, sign)| sign * x)
        .collect()
}

fn close_to(what: &str, ours: &[f64], expected: &[f64]) {
    assert_eq!(ours.len(), expected.len(), "{what}");
    let scale = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (i, (ours, expected)) in ours.iter().zip(expected).enumerate() {
        let error = (ours - expected).abs() / scale;
        assert!(error <= 1e-12, "{what}[{i}]: {ours} instead of {expected}");
    }
}

#[test]
fn mass_matrix_and_accelerations_are_those_of_the_reference() {
    let reference = reference();
    let compiled = MODELS.iter().find(|m| m.entry.info.name == "tree2d");
    let model = compiled.expect("a test model").model();
    let start = turned(&reference["y0"]);
    let (q, v) = start.split_at(6);
    let state = State {
        t: 0.0,
        q: q.to_vec(),
        v: v.to_vec(),
        z: vec![],
        m: vec![],
        a: vec![],
    };
    for route in [Route::Elimination, Route::MassMatrix] {
        let equations = derive_with(
            &model,
            Options {
                matrices: true,
                route: Some(route),
            },
        );
        let lists = lists(&model, &equations, &program::Options::default());
        let engine = Engine::new(lists).expect("no function of a user");
        let ours = evaluation::at(&engine, &[], &state).expect("six coordinates");
        let rows = reference["S"].as_sequence().expect("rows");
        let matrix: Vec<f64> = rows
            .iter()
            .zip(SIGNS)
            .flat_map(|(row, sign)| turned(row).into_iter().map(move |x| sign * x))
            .collect();
        close_to("S", &ours.mass_matrix.concat(), &matrix);
        let right: Vec<f64> = ours.r_s.iter().zip(&ours.r_k).map(|(s, k)| s + k).collect();
        close_to("r_s + r_k", &right, &turned(&reference["rhs"]));
        close_to(
            "accelerations",
            &ours.acceleration,
            &turned(&reference["qdd"]),
        );
    }
}

#[test]
fn the_tree_falls_as_computed_elsewhere() {
    let reference = reference();
    let (motion, bounds) = run_with_bound::<models::tree2d::Mechanism<f64>>(0.05, 0.5);
    for (ours, expected) in motion.states[0].iter().zip(turned(&reference["y0"])) {
        assert_eq!(*ours, expected, "start");
    }
    for row in reference["final"].as_sequence().expect("rows") {
        let t = row["t"].as_f64().expect("a time");
        let k = at(&motion, t);
        for (ours, expected) in motion.states[k].iter().zip(turned(&row["y"])) {
            close("state", t, *ours, expected, bounds[k]);
        }
    }
    // at the start and at all later times: T + Σm g z with 14 kg
    let energy = reference["energy0"].as_f64().expect("a number");
    for (k, outputs) in motion.outputs.iter().enumerate() {
        let ours = outputs[0] + 14.0 * 9.81 * outputs[1];
        // an error of the height changes it by m g = 137 N, an error of a velocity of at most 5 m/s by m v = 70 kg m/s
        close(
            "energy",
            motion.times[k],
            ours,
            energy,
            140.0 * bounds[k] + 1e-12 * energy,
        );
    }
}
