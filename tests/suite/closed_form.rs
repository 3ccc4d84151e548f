//! The reference of `bryant accuracy` against motions in closed form: its true error is not above the one that it
//! states for itself.
//!
//! One body on a hinge in a uniform field swings or rotates by θ̈ = −κ sin θ: Jacobi's elliptic functions \[Whittaker,
//! Analytical Dynamics, § 44\]. One free body in the plane has its centre of gravity on a parabola.

use crate::elliptic::{amplitude, first_kind};
use crate::estimates::engine_of;
use bryant::accuracy::reference::{self, Reference};
use bryant_generator::read_str;
use bryant_runtime::program::Job;

/// The body: its centre of gravity [m], mass [kg], moment of inertia [kg m²]; the field [m/s²]; along x and z.
const CG: [f64; 2] = [0.1, -0.4];
const MASS: f64 = 2.0;
const INERTIA: f64 = 0.05;
const FIELD: [f64; 2] = [1.5, -9.81];

fn reference(hinge: &str, start: &str) -> Reference {
    let ([x, z], [along, up]) = (CG, FIELD);
    let text = format!(
        "model: one\ndimension: 2\nsystems:\n  - name: a\n    reference: {hinge}\n    elements:\n      \
         - {{ name: b, mass: {MASS}, cg: [{x}, {z}], inertia: {INERTIA} }}\n    start: {{ {start} }}\nforces:\n  \
         - {{ field: earth, acceleration: [{along}, {up}] }}\nrun: {{ duration: 1 s, every: 0.1 s }}\n"
    );
    let none = |_: &std::path::Path| Err(std::io::Error::from(std::io::ErrorKind::NotFound));
    let (model, _) = read_str("one.yaml", &text, &none).unwrap_or_else(|e| panic!("{e}"));
    reference::compute(&engine_of(&model), &Job::default(), 60.0).unwrap()
}

/// φ and φ̇ of the pendulum, a tenth of a second apart, for φ and φ̇ ≥ 0 at the start; and √κ.
fn pendulum(start: f64, rate: f64) -> (Vec<[f64; 2]>, f64) {
    let arm = CG[0].hypot(CG[1]);
    let frequency = (MASS * arm * FIELD[0].hypot(FIELD[1]) / (INERTIA + MASS * arm * arm)).sqrt();
    let theta = start + CG[0].atan2(CG[1]) - FIELD[0].atan2(FIELD[1]);
    let equilibrium = start - theta;
    let (half, swing) = ((0.5 * theta).sin(), 0.5 * rate / frequency);
    let modulus = half.hypot(swing);
    let state = |i: u32| {
        let t = 0.1 * f64::from(i);
        if modulus < 1.0 {
            // sin θ/2 = k sn(√κ t + u₀, k)
            let am = amplitude(
                frequency * t + first_kind(half.atan2(swing), modulus),
                modulus,
            );
            let theta = 2.0 * (modulus * am.sin()).asin();
            [equilibrium + theta, 2.0 * modulus * frequency * am.cos()]
        } else {
            // θ/2 = am(k √κ t + u₀, 1/k)
            let inverse = 1.0 / modulus;
            let am = amplitude(
                frequency * t / inverse + first_kind(0.5 * theta, inverse),
                inverse,
            );
            let dn = (1.0 - (inverse * am.sin()).powi(2)).sqrt();
            [equilibrium + 2.0 * am, 2.0 * frequency / inverse * dn]
        }
    };
    ((0..=10).map(state).collect(), frequency)
}

/// The state differs from the closed form by no more than the reference states for itself, relative to the extent of
/// each entry, and the rounding of the closed form: some roundings of functions, and one of the phase.
fn assert_near(reference: &Reference, exact: &[Vec<f64>], phase: f64, name: &str) {
    let rounding = (64.0 + 16.0 * phase) * f64::EPSILON;
    assert!(reference.own.state < 1e-14, "{name}: {:?}", reference.own);
    assert_eq!(reference.states.len(), exact.len());
    for (found, expected) in reference.states.iter().zip(exact) {
        for (i, (a, b)) in found.iter().zip(expected).enumerate() {
            let size = exact.iter().fold(0.0f64, |size, y| size.max(y[i].abs()));
            let bound = (reference.own.state + rounding) * size;
            assert!((a - b).abs() <= bound, "{name}, {i}: {a} {b} {bound:e}");
        }
    }
}

#[test]
fn swings_and_rotations_are_elliptic_functions() {
    for (angle, rate) in [(30.0, 0.0), (100.0, 2.0), (-120.0, 1.0), (20.0, 25.0)] {
        let name = format!("angles: {{ b: {angle} deg }}, rates: {{ b: {rate} }}");
        let (states, frequency) = pendulum(f64::to_radians(angle), rate);
        let exact: Vec<Vec<f64>> = states.into_iter().map(Vec::from).collect();
        assert_near(
            &reference("fixed", &name),
            &exact,
            frequency.max(rate),
            &name,
        );
    }
}

#[test]
fn a_free_body_flies_on_a_parabola() {
    let name = "position: [1, 2], velocity: [3, 4], angles: { b: 50 deg }, rates: { b: 6 }";
    let (angle, rate) = (50f64.to_radians(), 6.0);
    // the vector from the reference joint to the centre of gravity in absolute axes: a rotation by φ about y
    let arm = |phi: f64| {
        let (sin, cos) = phi.sin_cos();
        [CG[0] * cos + CG[1] * sin, CG[1] * cos - CG[0] * sin]
    };
    // the velocity of the centre of gravity relative to the joint: ω × c
    let turn = |[x, z]: [f64; 2]| [rate * z, -rate * x];
    let first = arm(angle);
    let state = |i: u32| {
        let t = 0.1 * f64::from(i);
        let here = arm(angle + rate * t);
        let along = |i: usize| {
            let velocity = [3.0, 4.0][i] + turn(first)[i];
            let way = t * (velocity + 0.5 * FIELD[i] * t);
            let place = [1.0, 2.0][i] + first[i] + way - here[i];
            [place, velocity + FIELD[i] * t - turn(here)[i]]
        };
        let [[x, vx], [z, vz]] = [along(0), along(1)];
        vec![x, z, angle + rate * t, vx, vz, rate]
    };
    let exact: Vec<Vec<f64>> = (0..=10).map(state).collect();
    assert_near(&reference("free", name), &exact, rate, name);
}
