//! Motion against closed forms and reference solutions.
//!
//! Comparisons use the error theory of one-step methods: each accepted step errs by at most the tolerance, and an error
//! grows until the time of comparison by the amplification of the motion itself, which is measured by a run from a
//! disturbed state. So: error ≤ steps · tolerance · amplification · size of the state.

use bryant_runtime::simulate::{Integrator, Settings, simulate_from};
use bryant_runtime::{Formula, Model, Tolerances, Vector};
use bryant_tests::models;
use serde_yaml::Value;
use std::ops::ControlFlow;

const TOLERANCE: f64 = 1e-11;

/// States and outputs at the sampling times of a run.
pub(crate) struct Motion {
    pub times: Vec<f64>,
    pub states: Vec<Vec<f64>>,
    pub outputs: Vec<Vec<f64>>,
    pub steps: f64,
}

fn run<M: Model<f64>>(every: f64, duration: f64, tolerance: f64, disturbance: f64) -> Motion {
    let model = M::new(<M::Parameters as bryant_runtime::ParameterSet<f64>>::defaults());
    let mut start = model.initial_state();
    for i in 0..M::State::LEN {
        start[i] += if i % 2 == 0 {
            disturbance
        } else {
            -disturbance
        };
    }
    model.normalize(&mut start);
    let method = Integrator::adaptive(Formula::Dopri5, Tolerances::uniform(tolerance));
    let settings = Settings {
        duration,
        every,
        method,
        ..Settings::of(M::INFO)
    };
    let mut motion = Motion {
        times: vec![],
        states: vec![],
        outputs: vec![],
        steps: 0.0,
    };
    let report = simulate_from(&model, start, &settings, &mut |sample| {
        motion.times.push(sample.t);
        motion.states.push(sample.state.to_vec());
        motion.outputs.push(sample.outputs.to_vec());
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|failure| panic!("{failure}"));
    motion.steps = report.steps as f64;
    motion
}

/// A run, and the bound of its error at each sample.
pub(crate) fn run_with_bound<M: Model<f64>>(every: f64, duration: f64) -> (Motion, Vec<f64>) {
    run_with_tolerance::<M>(every, duration, TOLERANCE)
}

fn run_with_tolerance<M: Model<f64>>(
    every: f64,
    duration: f64,
    tolerance: f64,
) -> (Motion, Vec<f64>) {
    const DISTURBANCE: f64 = 1e-7;
    let (motion, disturbed) = (
        run::<M>(every, duration, tolerance, 0.0),
        run::<M>(every, duration, tolerance, DISTURBANCE),
    );
    let mut amplification = 1.0f64;
    let bounds = motion
        .states
        .iter()
        .zip(&disturbed.states)
        .map(|(a, b)| {
            let growth = a
                .iter()
                .zip(b)
                .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()))
                / DISTURBANCE;
            amplification = amplification.max(growth);
            let size = a.iter().fold(1.0f64, |m, x| m.max(x.abs()));
            motion.steps * tolerance * amplification * size
        })
        .collect();
    (motion, bounds)
}

fn classic(name: &str) -> Value {
    let text = include_str!("../reference/classic.yaml");
    serde_yaml::from_str::<Value>(text).expect("reference files are YAML")[name].clone()
}

fn rows(value: &Value) -> Vec<Vec<f64>> {
    let numbers = |row: &Value| {
        row.as_sequence()
            .expect("a row")
            .iter()
            .map(|x| x.as_f64().expect("a number"))
            .collect()
    };
    value
        .as_sequence()
        .expect("rows")
        .iter()
        .map(numbers)
        .collect()
}

pub(crate) fn close(what: &str, t: f64, ours: f64, expected: f64, bound: f64) {
    let error = (ours - expected).abs();
    assert!(
        error <= bound,
        "{what} at {t} s: {ours} instead of {expected}, off by {error:e}, allowed {bound:e}"
    );
    // a bound that allows everything would prove nothing
    assert!(
        bound < 1e-3 * expected.abs().max(1.0),
        "{what} at {t} s: the bound {bound:e} is empty"
    );
}

/// Index of the sample at a time.
pub(crate) fn at(motion: &Motion, t: f64) -> usize {
    motion
        .times
        .iter()
        .position(|x| (x - t).abs() < 1e-9)
        .expect("a sample at this time")
}

#[test]
fn pendulum_moves_as_the_elliptic_functions_say() {
    let (motion, bounds) = run_with_bound::<models::pendulum::Mechanism<f64>>(0.01, 10.0);
    for row in rows(&classic("pendulum_iftomm_A01")["rows"]) {
        let k = at(&motion, row[0]);
        close("x", row[0], motion.outputs[k][0], row[2], bounds[k]);
        close("z", row[0], motion.outputs[k][1], row[3], bounds[k]);
    }
}

#[test]
fn double_pendulums_move_as_computed_elsewhere() {
    fn check<M: Model<f64>>(name: &str) {
        let (motion, bounds) = run_with_bound::<M>(0.25, 3.0);
        for row in rows(&classic(name)["rows"]) {
            let k = at(&motion, row[0]);
            // Angles of the reference grow from the downward vertical towards +x, ours about +y in the other direction.
            for i in 0..4 {
                close(name, row[0], -motion.states[k][i], row[i + 1], bounds[k]);
            }
        }
    }
    check::<models::double_pendulum_points::Mechanism<f64>>("double_pendulum_point_masses");
    check::<models::double_pendulum_rods::Mechanism<f64>>("double_pendulum_uniform_rods");
}

/// Rotation of a quaternion (w, x, y, z).
fn rotation(q: &[f64]) -> nalgebra::Rotation3<f64> {
    nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]))
        .to_rotation_matrix()
}

fn in_body(q: &[f64], vector: &[f64]) -> [f64; 3] {
    (rotation(q).inverse() * nalgebra::Vector3::from_column_slice(vector)).into()
}

#[test]
fn a_free_asymmetric_top_turns_as_the_elliptic_functions_say() {
    let (motion, bounds) = run_with_bound::<models::free_top::Mechanism<f64>>(0.5, 10.0);
    for row in rows(&classic("asymmetric_free_top")["rows"]) {
        let k = at(&motion, row[0]);
        let y = &motion.states[k];
        for (i, omega) in in_body(&y[3..7], &y[10..13]).into_iter().enumerate() {
            close("ω in the body", row[0], omega, row[i + 1], bounds[k]);
        }
    }
}

#[test]
fn a_heavy_top_moves_as_computed_elsewhere() {
    // a spin of 150 rad/s converts an error of the state to a large error of the phase
    let (motion, bounds) =
        run_with_tolerance::<models::heavy_top::Mechanism<f64>>(0.05, 0.5, 1e-14);
    let reference = classic("heavy_top_terze");
    for row in reference["rows"].as_sequence().expect("rows") {
        let t = row["t"].as_f64().expect("a time");
        let k = at(&motion, t);
        let numbers = |key: &str| -> Vec<f64> {
            row[key]
                .as_sequence()
                .expect("numbers")
                .iter()
                .filter_map(Value::as_f64)
                .collect()
        };
        for (ours, expected) in motion.outputs[k].iter().zip(numbers("com")) {
            close("centre of gravity", t, *ours, expected, bounds[k]);
        }
        let y = &motion.states[k];
        for (ours, expected) in in_body(&y[0..4], &y[4..7])
            .into_iter()
            .zip(numbers("omega_body"))
        {
            close("ω in the body", t, ours, expected, bounds[k]);
        }
    }
}

#[test]
fn kovalevskayas_top_moves_as_computed_elsewhere() {
    let (motion, bounds) = run_with_bound::<models::kovalevskaya::Mechanism<f64>>(1.0, 7.0);
    for row in classic("kovalevskaya")["rows"].as_sequence().expect("rows") {
        let t = row["t"].as_f64().expect("a time");
        let expected: Vec<f64> = row["y"]
            .as_sequence()
            .expect("numbers")
            .iter()
            .filter_map(Value::as_f64)
            .collect();
        let k = at(&motion, t);
        let y = &motion.states[k];
        let ours = [
            in_body(&y[0..4], &y[4..7]),
            in_body(&y[0..4], &[0.0, 0.0, 1.0]),
        ]
        .concat();
        for (ours, expected) in ours.iter().zip(expected) {
            close(
                "ω and the vertical in the body",
                t,
                *ours,
                expected,
                bounds[k],
            );
        }
    }
}

#[test]
fn a_spherical_pendulum_moves_as_computed_elsewhere() {
    let (motion, bounds) = run_with_bound::<models::spherical_pendulum::Mechanism<f64>>(0.5, 5.0);
    for row in rows(&classic("spherical_pendulum")["rows"]) {
        let k = at(&motion, row[0]);
        for i in 0..3 {
            close("bob", row[0], motion.outputs[k][i], row[5 + i], bounds[k]);
        }
    }
}

#[test]
fn a_belt_is_a_spring() {
    let (motion, bounds) = run_with_bound::<models::belt_spring::Mechanism<f64>>(0.05, 3.0);
    for ((&t, outputs), &bound) in motion.times.iter().zip(&motion.outputs).zip(&bounds) {
        // m z̈ = −m g + k (L − L₀): about −1.2 m with ω² = k/m
        let z = -1.2 - 0.1 * (f64::sqrt(100.0 / 2.0) * t).cos();
        close("z", t, outputs[0], z, bound);
        close("tension", t, outputs[1], 100.0 * (-z - 1.0), 100.0 * bound);
    }
}

#[test]
fn springs_about_the_three_angles_of_a_joint_conserve_energy() {
    const STIFFNESS: [f64; 3] = [4.0, 6.0, 3.0];
    let motion = run::<models::elastic_joint::Mechanism<f64>>(0.05, 2.0, TOLERANCE, 0.0);
    let energy = |outputs: &[f64]| {
        let springs = STIFFNESS.iter().zip(&outputs[1..4]);
        outputs[0]
            + springs
                .map(|(k, angle)| 0.5 * k * angle * angle)
                .sum::<f64>()
    };
    let first = &motion.outputs[0];
    // as for free trees: errors of the steps times a mass of 3 kg, a lever arm of 0.3 m and a rate of 5 rad/s;
    // stiffnesses up to 6
    let bound = motion.steps * TOLERANCE * (3.0 * 0.3 * 5.0 + 6.0);
    for (&t, outputs) in motion.times.iter().zip(&motion.outputs) {
        close("energy", t, energy(outputs), energy(first), bound);
        for axis in 4..7 {
            close("angular momentum", t, outputs[axis], first[axis], bound);
        }
    }
    // all three springs have worked
    for angle in 1..4 {
        let largest = motion
            .outputs
            .iter()
            .fold(0.0f64, |m, o| m.max(o[angle].abs()));
        assert!(largest > 0.1, "angle {angle} hardly moved: {largest}");
    }
}

#[test]
fn free_trees_conserve_energy_and_momentum() {
    fn check<M: Model<f64>>() {
        let motion = run::<M>(0.1, 2.0, TOLERANCE, 0.0);
        for k in 0..motion.times.len() {
            // The motion cannot amplify errors of a conserved quantity: the errors of the steps add up, times the
            // derivative of the quantity with respect to the state: at most a mass of 6.5 kg, a lever arm of 3 m and a
            // speed of 5 m/s.
            let size = motion.states[k].iter().fold(1.0f64, |m, x| m.max(x.abs()));
            let bound = motion.steps * TOLERANCE * size * 6.5 * 3.0 * 5.0;
            for (i, (now, before)) in motion.outputs[k].iter().zip(&motion.outputs[0]).enumerate() {
                close(
                    M::INFO.outputs[i].name,
                    motion.times[k],
                    *now,
                    *before,
                    bound,
                );
            }
        }
    }
    check::<models::free_tree::Mechanism<f64>>();
    check::<models::free_tree_bryant::Mechanism<f64>>();
    // both are the same motion, each within its own bound; the tolerance is smaller because this motion amplifies
    // errors
    let (quaternion, bounds) =
        run_with_tolerance::<models::free_tree::Mechanism<f64>>(0.1, 2.0, 1e-13);
    let (bryant, bounds_bryant) =
        run_with_tolerance::<models::free_tree_bryant::Mechanism<f64>>(0.1, 2.0, 1e-13);
    for (k, &t) in quaternion.times.iter().enumerate() {
        let (ours, expected) = (&bryant.states[k], &quaternion.states[k]);
        for i in 0..3 {
            close("hub", t, ours[i], expected[i], bounds[k] + bounds_bryant[k]);
        }
    }
}
