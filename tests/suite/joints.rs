//! Stops and locks of joints, flexion and torsion: against closed forms, planar models, and invariants of every torque.

use bryant::evaluation::functions;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Equations;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::Model;
use bryant_generator::read_str;
use bryant_runtime::program::Entry;
use bryant_tests::models;
use bryant_tests::runs::{Recording, run};
use bryant_tests::trees::{Random, random_state};
use serde_yaml::Value;
use std::f64::consts::PI;

const TOLERANCE: f64 = 1e-11;

/// Error of the integration if the largest rate of the mechanism is this \[1/s\], as in `laws`.
fn integration(run: &Recording, rate: f64) -> f64 {
    run.steps * TOLERANCE * rate.max(1.0)
}

fn close(what: &str, ours: f64, expected: f64, bound: f64) {
    let error = (ours - expected).abs();
    assert!(
        error <= bound,
        "{what}: {ours} instead of {expected}, off by {error:e}, allowed {bound:e}"
    );
}

fn stops() -> Entry {
    models::joint_stops::ENTRY
}

#[test]
fn a_stop_throws_back_with_the_restitution_of_its_damping() {
    let reference: Value = serde_yaml::from_str(include_str!("../reference/contact.yaml"))
        .expect("reference files are YAML");
    let numbers = |key: &str| -> Vec<f64> {
        let list = reference["linear_spring_dashpot"][key].as_sequence();
        let list = list.expect("a list");
        list.iter().filter_map(Value::as_f64).collect()
    };
    let omega = 20.0;
    let pairs = numbers("zeta")
        .into_iter()
        .zip(numbers("e_force_clamped_at_zero"));
    for (zeta, restitution) in pairs {
        let run = run(&stops(), &[("stop_damping", 2.0 * zeta * omega)], TOLERANCE);
        let rate = run.column("swing rate");
        let back = -rate[rate.len() - 1] / 2.0;
        let what = format!("restitution at ζ = {zeta}");
        close(&what, back, restitution, integration(&run, omega));
    }
}

#[test]
fn between_two_stops_nothing_is_lost() {
    let run = run(&stops(), &[], TOLERANCE);
    let (rate, low, high, omega) = (3.0, -0.3, 0.4, 30.0);
    // there, into the stop and out of it, and back
    let (way, turn) = ((high - low) / rate, PI / omega);
    let expected = |t: f64| {
        let mut phase = (t - high / rate).rem_euclid(2.0 * (way + turn));
        let depth = |phase: f64| rate / omega * (omega * phase).sin();
        if phase < turn {
            return high + depth(phase);
        }
        phase -= turn;
        if phase < way {
            return high - rate * phase;
        }
        phase -= way;
        if phase < turn {
            return low - depth(phase);
        }
        low + rate * (phase - turn)
    };
    for (t, angle) in run.times.iter().zip(run.column("between angle")) {
        close(
            &format!("angle at {t} s"),
            angle,
            expected(*t),
            integration(&run, omega),
        );
    }
}

#[test]
fn a_lock_holds_the_angle_that_there_was() {
    let run = run(&stops(), &[], TOLERANCE);
    let (stiffness, omega) = (100.0, 10.0);
    for (k, t) in run.times.iter().enumerate() {
        // released from the angle of the lock with the rate at that time
        let expected = match t - 0.1 {
            tau if tau <= 0.0 => *t,
            tau => 0.1 + (omega * tau).sin() / omega,
        };
        let error = integration(&run, omega);
        close("angle", run.column("held angle")[k], expected, error);
        let torque = if *t <= 0.1 {
            0.0
        } else {
            -stiffness * (expected - 0.1)
        };
        close(
            "torque",
            run.column("held torque")[k],
            torque,
            stiffness * error,
        );
    }
}

#[test]
fn no_torque_jumps_where_damping_fades_in() {
    let run = run(&stops(), &[], TOLERANCE);
    let (stiffness, damping, fade) = (400.0, 50.0, 2.0 * PI / 180.0);
    let torque = run.column("soft torque");
    let rate = run.column("soft rate");
    let most = torque.iter().fold(0.0f64, |m, q| m.max(q.abs()));
    assert!(most > 20.0, "{most}");
    for k in 1..torque.len() {
        let jump = (torque[k] - torque[k - 1]).abs();
        let speed = rate[k].abs().max(rate[k - 1].abs());
        // k θ̇ + d (θ̇²/fade + θ̈), with θ̈ = Q, over 1 ms
        let steepest = stiffness * speed + damping * (speed * speed / fade + most);
        // the lock may begin, and the force may end, at once
        let switched = [0.5, 0.9]
            .iter()
            .any(|t| (run.times[k] - t - 1e-3).abs() < 1e-9);
        assert!(
            jump <= 1e-3 * steepest || switched,
            "{jump} N m at {} s",
            run.times[k]
        );
    }
    // after the end of the lock nothing acts
    assert_eq!(torque[torque.len() - 1], 0.0);
}

#[test]
fn a_bent_spring_stores_what_it_takes_and_turns_nothing() {
    let run = run(&models::bending::ENTRY, &[], TOLERANCE);
    // the faster pair swings with the square root of its stiffness over the smallest inertia
    let error = integration(&run, f64::sqrt(45.0 / 0.004));
    let energy = |k: usize| {
        let [kinetic, bend, twist] =
            ["kinetic energy", "bend", "twist"].map(|name| run.column(name)[k]);
        kinetic + 0.5 * (5.0 * bend * bend + 3.0 * twist * twist)
    };
    for k in 0..run.times.len() {
        let bend = run.column("bend")[k];
        assert!((0.0..PI).contains(&bend), "{bend}");
        // energies of a few joules; an error of a velocity changes them by its momentum
        close("energy", energy(k), energy(0), 10.0 * error);
        for name in ["lx", "ly", "lz", "rough lx", "rough ly", "rough lz"] {
            let momentum = run.column(name);
            close(name, momentum[k], momentum[0], error);
        }
    }
    // the other pair is clamped on the way
    let clamped = run.column("clamped");
    assert_eq!((clamped[0], clamped[clamped.len() - 1]), (0.0, 1.0));
}

/// A model of two bodies and one joint force.
fn pair(dimension: usize, geometry: [&str; 2], joint: &str) -> (Model, Equations) {
    let [base, arm] = geometry;
    let outputs = match dimension {
        3 => ["flexion", "torsion", "x", "y", "z"]
            .map(|about| {
                format!("  - {{ name: angle {about}, of: joint pair/arm, what: angle, about: {about} }}\n  - {{ name: rate {about}, of: joint pair/arm, what: rate, about: {about} }}\n")
            })
            .concat(),
        _ => "  - { name: angle, of: joint pair/arm, what: angle }\n".into(),
    };
    let text = format!(
        "model: pair\ndimension: {dimension}\nsystems:\n  - name: pair\n    elements:\n      - {{ name: base, {base} }}\n      - {{ name: arm, on: base, {arm} }}\nforces:\n  - {{ joint: pair/arm, {joint} }}\noutputs:\n{outputs}"
    );
    let nothing = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = read_str("pair.yaml", &text, &nothing).unwrap_or_else(|e| panic!("{e}"));
    let equations = derive_with(
        &model,
        Options {
            matrices: false,
            route: None,
        },
    );
    (model, equations)
}

/// v̇, the outputs and q̇ at a state.
fn at(model: &Model, equations: &Equations, q: &[f64], v: &[f64]) -> [Vec<f64>; 3] {
    let inputs = Inputs {
        time: 0.0,
        coordinates: q,
        velocities: v,
        parameters: &[],
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    [
        &equations.accelerations,
        &equations.outputs,
        &equations.coordinate_rates,
    ]
    .map(|roots| evaluate(&equations.graph, roots, &inputs, &functions(model)))
}

const IN_SPACE: [&str; 2] = [
    "mass: 2, cg: [0.02, 0.01, -0.1], inertia: [0.02, 0.03, 0.025]",
    "at: [0.05, -0.02, 0.1], mass: 1, cg: [0.03, 0.02, 0.12], inertia: [0.008, 0.009, 0.004]",
];

#[test]
fn rates_are_those_of_their_angles() {
    for axis in ["x", "y", "z"] {
        let law = format!("axis: {axis}, flexion: {{ damping: 1 }}");
        let (model, equations) = pair(3, IN_SPACE, &law);
        let mut random = Random::new(7);
        for _ in 0..20 {
            let (q, v) = random_state(&mut random, &model);
            let [_, outputs, rates] = at(&model, &equations, &q, &v);
            let angles = |h: f64| {
                let moved: Vec<f64> = q.iter().zip(&rates).map(|(q, rate)| q + h * rate).collect();
                at(&model, &equations, &moved, &v)[1].clone()
            };
            let slope = |h: f64, i: usize| {
                let turn = angles(h)[i] - angles(-h)[i];
                // an angle may pass from π to −π in between
                (turn - 2.0 * PI * (turn / (2.0 * PI)).round()) / (2.0 * h)
            };
            for i in (0..outputs.len()).step_by(2) {
                // central differences err by h²: the error of the finer one is a third of its difference from the
                // coarser one, plus rounding
                let (coarse, fine) = (slope(2e-5, i), slope(1e-5, i));
                let bound = (coarse - fine).abs() + 1e-9;
                close(
                    &format!("rate {i}, axis {axis}"),
                    outputs[i + 1],
                    fine,
                    bound,
                );
                assert!(bound < 1e-3, "{bound:e}");
            }
        }
    }
}

const ALL: &str = "axis: z, flexion: { elastic: { points: [[0, 0], [1, 2]], extrapolate: linear }, damping: 0.2, friction: 0.5, stop: { to: 25 deg, stiffness: 10, damping: 0.5 } }, torsion: { elastic: { points: [[-1, -3], [1, 3]], extrapolate: linear }, neutral: 5 deg, damping: 0.3, friction: 0.2, stop: { from: -20 deg, to: 10 deg, stiffness: 6, damping: 0.1 } }";

type Quaternion = [f64; 4];

fn product([a, b, c, d]: Quaternion, [w, x, y, z]: Quaternion) -> Quaternion {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

fn rotated([w, x, y, z]: Quaternion, vector: &[f64]) -> [f64; 3] {
    let turned = product(
        product([w, x, y, z], [0.0, vector[0], vector[1], vector[2]]),
        [w, -x, -y, -z],
    );
    [turned[1], turned[2], turned[3]]
}

#[test]
fn a_joint_does_not_know_where_the_frame_is() {
    let (model, equations) = pair(3, IN_SPACE, ALL);
    let mut random = Random::new(11);
    for _ in 0..20 {
        let (q, v) = random_state(&mut random, &model);
        let turn: Quaternion = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        let length = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        let turn = turn.map(|x| x / length);
        // the position may be anything
        let mut moved: Vec<f64> = rotated(turn, &q[..3]).iter().map(|x| x + 2.5).collect();
        for orientation in q[3..].as_chunks::<4>().0 {
            moved.extend(product(turn, *orientation));
        }
        let turned = |vectors: &[f64]| -> Vec<f64> {
            let vectors = vectors.as_chunks::<3>().0.iter();
            vectors.flat_map(|v| rotated(turn, v)).collect()
        };
        let [here, outputs, _] = at(&model, &equations, &q, &v);
        let [there, same, _] = at(&model, &equations, &moved, &turned(&v));
        // a condition of S of at most 1e3, and about ten roundings
        let size = here.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let bound = 1e4 * f64::EPSILON * size;
        for (ours, expected) in there.iter().zip(turned(&here)) {
            close("acceleration", *ours, expected, bound);
        }
        for (ours, expected) in same.iter().zip(&outputs) {
            close("output", *ours, *expected, 1e4 * f64::EPSILON);
        }
    }
}

#[test]
fn bending_in_a_plane_is_a_hinge() {
    let flat = [
        "mass: 2, cg: [0.02, -0.1], inertia: 0.03",
        "at: [0.05, 0.1], mass: 1, cg: [0.03, 0.12], inertia: 0.009",
    ];
    let deep = [
        "mass: 2, cg: [0.02, 0, -0.1], inertia: [0.02, 0.03, 0.025]",
        "at: [0.05, 0, 0.1], mass: 1, cg: [0.03, 0, 0.12], inertia: [0.008, 0.009, 0.004]",
    ];
    let (planar, in_plane) = pair(
        2,
        flat,
        "elastic: { points: [[-1, -2], [1, 2]], extrapolate: linear }, damping: 0.2, friction: 0.5, stop: { from: -25 deg, to: 25 deg, stiffness: 10, damping: 0.5 }",
    );
    let (spatial, in_space) = pair(3, deep, ALL);
    let mut random = Random::new(5);
    let mut stopped = 0;
    for _ in 0..40 {
        let first = random.uniform(-3.0, 3.0);
        let angles = [first, first + random.uniform(-0.8, 0.8)];
        let q = [&[0.3, -0.2], &angles[..]].concat();
        let v: Vec<f64> = (0..4).map(|_| random.uniform(-2.0, 2.0)).collect();
        let [of_hinge, ..] = at(&planar, &in_plane, &q, &v);
        let mut deep_q = vec![0.3, 0.0, -0.2];
        for angle in angles {
            deep_q.extend([(angle / 2.0).cos(), 0.0, (angle / 2.0).sin(), 0.0]);
        }
        let deep_v = [v[0], 0.0, v[1], 0.0, v[2], 0.0, 0.0, v[3], 0.0];
        let [ours, outputs, _] = at(&spatial, &in_space, &deep_q, &deep_v);
        let size = of_hinge.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let bound = 1e4 * f64::EPSILON * size;
        for (row, expected) in [(0, 0), (2, 1), (4, 2), (7, 3)] {
            close("acceleration", ours[row], of_hinge[expected], bound);
        }
        let bend = (angles[1] - angles[0]).abs();
        close("flexion", outputs[0], bend, 1e-14);
        stopped += usize::from(bend > 25.0 * PI / 180.0);
        // there is no twist, but its neutral angle is not 0: that angle is about z, and so only out of the plane
        close("torsion", outputs[2], 0.0, 1e-14);
    }
    assert!(stopped > 5);
}

#[test]
fn a_straight_joint_twists_about_its_long_axis() {
    let straight = [
        "mass: 2, cg: [0, 0, -0.1], inertia: [0.02, 0.02, 0.025]",
        "at: [0, 0, 0.1], mass: 1, cg: [0, 0, 0.12], inertia: [0.008, 0.008, 0.004]",
    ];
    let law = "flexion: { elastic: { points: [[0, 0], [1, 2]] }, damping: 0.2, friction: 0.5 }, torsion: { elastic: { points: [[-1, -3], [1, 3]], extrapolate: linear }, damping: 0.3 }";
    let (model, equations) = pair(3, straight, law);
    for twist in [-2.5f64, -0.3, 0.0, 1.1, 3.0] {
        let about_z = |angle: f64| [(angle / 2.0).cos(), 0.0, 0.0, (angle / 2.0).sin()];
        let q = [&[0.0; 3], &about_z(0.4)[..], &about_z(0.4 + twist)].concat();
        let rates = [0.7, -1.1];
        let v = [0.0, 0.0, 0.0, 0.0, 0.0, rates[0], 0.0, 0.0, rates[1]];
        let [acceleration, outputs, _] = at(&model, &equations, &q, &v);
        let torque = -3.0 * twist - 0.3 * (rates[1] - rates[0]);
        let mut expected = [0.0; 9];
        (expected[5], expected[8]) = (-torque / 0.025, torque / 0.004);
        let bound = 1e3 * f64::EPSILON * expected[8].abs().max(1.0);
        for (ours, expected) in acceleration.iter().zip(expected) {
            close("acceleration", *ours, expected, bound);
        }
        close("torsion", outputs[2], twist, 1e-14);
        close("flexion", outputs[0], 0.0, 1e-15);
    }
}

#[test]
fn a_joint_bent_back_on_itself_stays_finite() {
    let (model, equations) = pair(3, IN_SPACE, ALL);
    for angle in [PI, PI - 1e-9, PI + 1e-13, 0.0, 1e-12] {
        let q = [
            &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0][..],
            &[
                (angle / 2.0f64).cos(),
                0.6 * (angle / 2.0).sin(),
                0.8 * (angle / 2.0).sin(),
                0.0,
            ],
        ]
        .concat();
        let v = [0.1, 0.2, 0.3, 1.0, -2.0, 0.5, -0.3, 0.4, 1.5];
        let [acceleration, outputs, _] = at(&model, &equations, &q, &v);
        let finite = acceleration.iter().chain(&outputs).all(|x| x.is_finite());
        assert!(finite, "{angle}: {acceleration:?} {outputs:?}");
    }
}
