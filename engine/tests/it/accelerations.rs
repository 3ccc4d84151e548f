//! Accelerations under the control of the step alone, without a second run: what rests on a stiff spring stays at rest,
//! and small motions keep their amplitudes, in single runs and in lanes.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{self, Pace, Status};
use bryant_runtime::response::Response;
use bryant_runtime::simulate;
use bryant_runtime::{Dynamics, Formula, Integrator, Settings, Tolerances, Width};
use std::ops::ControlFlow;

/// The accuracy of outputs that is promised at the default tolerance.
const PROMISE: f64 = 1e-3;
const GRAVITY: f64 = 9.81;
const CONTROLLED: [Formula; 4] = [
    Formula::Dopri5,
    Formula::Tsit5,
    Formula::Dop853,
    Formula::Merson,
];

fn engine_of(text: &str) -> Engine {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("scene.yaml", text, &none)
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// A gram on a plate of the stiffness k \[N/m\], which begins `above` its depth of rest \[m\].
fn on_a_plate(k: f64, above: f64) -> String {
    let height = 0.01 - 1e-3 * GRAVITY / k + above;
    format!(
        "model: ball
dimension: 2
systems:
  - name: man
    elements: [{{ name: ball, mass: 1e-3, cg: [0, 0], inertia: 1e-9 }}]
    start: {{ position: [0, {height:e}] }}
forces:
  - {{ field: g, acceleration: [0, -{GRAVITY}] }}
  - contact: floor
    ellipsoid: {{ on: man/ball, center: [0, 0], semi_axes: [0.01, 0.01] }}
    plane: {{ on: frame, at: [0, 0], normal: [0, 1] }}
    elastic: {{ points: [[0, 0], [1, {k:e}]], extrapolate: linear }}
outputs: [{{ name: force, of: contact floor, what: force }}]
run: {{ duration: 0.2 s, every: 1 ms }}
"
    )
}

/// Two bodies that a stiff spring keeps apart against two soft ones, without gravity: the forces that cancel are those
/// of springs.
fn between_springs() -> String {
    "model: pressed
dimension: 2
systems:
  - name: a
    elements: [{ name: body, mass: 0.1, cg: [0, 0], inertia: 1e-4 }]
    start: { position: [-0.1, 0] }
  - name: b
    elements: [{ name: body, mass: 0.1, cg: [0, 0], inertia: 1e-4 }]
    start: { position: [0.1, 0] }
forces:
  - spring: stiff
    from: { on: a/body, at: [0, 0] }
    to: { on: b/body, at: [0, 0] }
    length: 0.2000001
    stiffness: 1e9
  - spring: left
    from: { on: a/body, at: [0, 0] }
    to: { on: frame, at: [1.9, 0] }
    length: 1
    stiffness: 100
  - spring: right
    from: { on: b/body, at: [0, 0] }
    to: { on: frame, at: [-1.9, 0] }
    length: 1
    stiffness: 100
outputs: [{ name: force, of: spring stiff, what: force }]
run: { duration: 50 ms, every: 1 ms }
"
    .to_owned()
}

/// The first output at all samples, and the number of steps, accepted or not.
fn run(engine: &Engine, method: Integrator) -> (Vec<f64>, u64) {
    let model = engine.over::<f64>();
    let info = model.info();
    let mut state = vec![0.0; info.state_length()];
    model.initial_state(&mut state);
    let settings = Settings {
        method,
        ..Settings::of(info)
    };
    let mut values = Vec::new();
    let report = simulate::run(&model, &state, &settings, None, &mut |sample| {
        values.push(sample.outputs[0]);
        ControlFlow::Continue(())
    });
    let report = report.expect("the run reaches its end");
    (values, report.steps + report.rejected)
}

/// How far values are from this one, as a share of it.
fn off(values: &[f64], exact: f64) -> f64 {
    let off = values.iter().map(|value| (value / exact - 1.0).abs());
    off.fold(0.0, f64::max)
}

#[test]
fn what_rests_on_a_stiff_spring_stays_at_rest() {
    for k in [1e4, 1e6, 1e8] {
        let engine = engine_of(&on_a_plate(k, 0.0));
        for formula in CONTROLLED {
            let method = Integrator::adaptive(formula, Tolerances::default());
            let (forces, steps) = run(&engine, method);
            let off = off(&forces, 1e-3 * GRAVITY);
            assert!(off < PROMISE, "{formula}, {k:e} N/m: {off:e}");
            // h ω = 0.5 in all steps, and twice as many because some are rejected
            let most = 4.0 * 0.2 * (k / 1e-3_f64).sqrt();
            assert!(
                (steps as f64) < most.max(100.0),
                "{formula}, {k:e} N/m: {steps}"
            );
        }
    }
}

#[test]
fn springs_that_press_against_each_other_stay_at_rest() {
    let engine = engine_of(&between_springs());
    for formula in CONTROLLED {
        let method = Integrator::adaptive(formula, Tolerances::default());
        let (forces, _) = run(&engine, method);
        // 100 N of each soft spring
        let off = off(&forces, -100.0).min(off(&forces, 100.0));
        assert!(off < PROMISE, "{formula}: {off:e}");
    }
}

#[test]
fn small_motions_keep_their_amplitude() {
    for amplitude in [1.0, 1e-3, 1e-6, 1e-12] {
        let text = format!(
            "model: micro
dimension: 2
systems:
  - name: osc
    reference: fixed
    elements: [{{ name: body, mass: 1, cg: [0, 0], inertia: 1 }}]
    start: {{ angles: {{ body: {amplitude:e} }} }}
forces: [{{ joint: osc/body, elastic: {{ points: [[-1, -1], [1, 1]], extrapolate: linear }} }}]
outputs: [{{ name: torque, of: joint osc/body, what: torque }}]
run: {{ duration: 20 s, every: 0.1 s }}
"
        );
        let engine = engine_of(&text);
        // merson damps what is too fast for its steps
        for formula in [Formula::Dopri5, Formula::Tsit5, Formula::Dop853] {
            if formula == Formula::Dop853 && amplitude < 1e-6 {
                // its samples are within steps of half a period
                continue;
            }
            let method = Integrator::adaptive(formula, Tolerances::default());
            let (torques, _) = run(&engine, method);
            let errors = torques.iter().enumerate().map(|(i, torque)| {
                let exact = -amplitude * (0.1 * i as f64).cos();
                (torque - exact).abs() / amplitude
            });
            let off = errors.fold(0.0, f64::max);
            assert!(off < PROMISE, "{formula}, {amplitude:e} rad: {off:e}");
        }
    }
}

#[test]
fn lanes_stay_at_rest_as_single_runs_do() {
    let weight = 1e-3 * GRAVITY;
    for k in [1e4, 1e6, 1e8] {
        let engine = engine_of(&on_a_plate(k, 0.0));
        let settings = batch::Settings {
            duration: 0.2,
            samples: 201,
            pace: Pace::Adaptive(Tolerances::default()),
            locate: false,
            max_steps: 10_000_000,
            time_limit: None,
            energy_limit: f64::INFINITY,
        };
        let job = Job {
            settings,
            varied: Vec::new(),
            fixed: Vec::new(),
            responses: [Response::Peak, Response::Minimum]
                .map(|response| Asked::of(0, response))
                .to_vec(),
            estimate: false,
            wanted: f64::INFINITY,
            width: Width::widest(),
        };
        let table = engine.rows(&job, &[]).expect("registers");
        assert_eq!(table.rows[0].status, Status::Done, "{k:e} N/m");
        let off = off(&table.responses[..2], weight);
        assert!(off < PROMISE, "{k:e} N/m: {off:e}");
    }
}
