//! No step passes a corner of a force curve and comes back unnoticed. The scene is a soft layer over hard ground, with
//! a motion that turns near the corner.
//!
//! x is a penetration, an angle or an elongation. ẍ = −g − F(x), where F has the slope 10⁻³ up to x = 1 and 10⁵ behind
//! it. Without the hard ground the motion would turn a little behind the corner, and a step of a tenth of a second
//! would pass over all of that. On each side of the corner x is a harmonic oscillation about a point, so its closed
//! form is known.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::{self, Ended, Scenarios, Series};
use bryant_runtime::real::lanes::{OfAnyWidth, Width, with_width};
use bryant_runtime::{
    Adjustable, Dynamics, Family, Formula, Integrator, Settings, Several, Tolerances, Watch,
    simulate,
};
use std::ops::ControlFlow;

const FORMULAS: [Formula; 5] = [
    Formula::Dopri5,
    Formula::Tsit5,
    Formula::Dop853,
    Formula::Rodas5,
    Formula::Merson,
];
const TOLERANCES: [f64; 5] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// Times between samples of single runs \[s\].
const EVERY: [f64; 2] = [0.75, 0.01];
const DURATION: f64 = 0.75;

const GRAVITY: f64 = 9.81;
const START: f64 = 0.2;
/// Slopes of the force before and behind the corner at x = 1.
const SLOPES: [f64; 2] = [1e-3, (1000.0 - 1e-3) / (1.01 - 1.0)];

/// Speeds at the start \[m/s\]: most reach the corner, the last two do not.
fn speeds(count: usize) -> Vec<f64> {
    // the speed at the corner if there were no force; the smallest are turned back within a trifle
    let at_corner = (0..count).map(|i| 0.1 * 5f64.powf(i as f64 / (count - 1) as f64));
    let reach = 2.0 * GRAVITY * (1.0 - START);
    let mut speeds: Vec<f64> = at_corner.map(|v| (reach + v * v).sqrt()).collect();
    // and some that do not reach the corner
    speeds.extend([0.99, 0.9].map(|share| share * reach.sqrt()));
    speeds
}

/// x after a time from the start, with the slopes before and behind the corner.
fn closed_form(speed: f64, slopes: [f64; 2]) -> f64 {
    let (mut x, mut v, mut left) = (START, speed, DURATION);
    let mut behind = false;
    loop {
        let (slope, force_at_corner) = (slopes[usize::from(behind)], slopes[0]);
        let omega = slope.sqrt();
        // the position of rest, where F = F(1) + slope (x − 1) is −g
        let rest = 1.0 - (GRAVITY + force_at_corner) / slope;
        // x = rest + size cos(ωt − phase)
        let (a, b) = (x - rest, v / omega);
        let (size, phase) = (a.hypot(b), b.atan2(a));
        let turn = (1.0 - rest) / size;
        let until = match turn < 1.0 {
            // upwards through the corner before the turn, downwards after it
            true if behind => (phase + turn.acos()) / omega,
            true if v > 0.0 => (phase - turn.acos()) / omega,
            _ => f64::INFINITY,
        };
        let time = until.min(left);
        let angle = omega * time - phase;
        (x, v) = (rest + size * angle.cos(), -size * omega * angle.sin());
        left -= time;
        if left <= 0.0 {
            return x;
        }
        (x, behind) = (1.0, !behind);
    }
}

const CURVE: &str = "{ points: [[0, 0], [1, 0.001], [1.01, 1000]], extrapolate: linear }";
const BALL: &str = "
model: corner
dimension: 2
parameters: { speed: 4 m/s }
systems:
  - name: ball
    elements: [{ name: body, mass: 1 kg, cg: [0, 0], inertia: 1e-3 }]
    start: { position: [0, 1.2], velocity: [0, speed] }
forces:
  - { field: down, acceleration: [0, -9.81] }
  - LAW
outputs: [{ name: z, of: ball/body, what: position, component: z }]
run: { duration: 0.75 s, every: 0.75 s }
";
const WHEEL: &str = "
model: corner
dimension: 2
parameters: { speed: 4 rad/s }
systems:
  - name: wheel
    reference: fixed
    elements: [{ name: wheel, mass: 1 kg, cg: [0, 0], inertia: 1 kg*m^2 }]
    start: { angles: { wheel: 0.2 rad }, rates: { wheel: speed } }
forces:
  - { load: back, on: wheel/wheel, moment: -9.81 }
  - LAW
outputs: [{ name: angle, of: wheel/wheel, what: angle }]
run: { duration: 0.75 s, every: 0.75 s }
";
/// The place of the body is x + 1; for the wheel, x is the angle.
const SHAPES: [(&str, &str, &str, f64); 4] = [
    (
        "contact",
        BALL,
        "{ contact: layer, ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [1, 1] }, plane: { on: frame, at: [0, 2], normal: [0, -1] }, elastic: CURVE }",
        1.0,
    ),
    (
        "belt",
        BALL,
        "{ belt: leash, from: { on: frame, at: [0, 0] }, to: { on: ball/body, at: [0, 0] }, length: 1 m, force: CURVE }",
        1.0,
    ),
    (
        "spring",
        BALL,
        "{ spring: leash, from: { on: frame, at: [0, 0] }, to: { on: ball/body, at: [0, 0] }, length: 1 m, elastic: CURVE }",
        1.0,
    ),
    (
        "joint",
        WHEEL,
        "{ joint: wheel/wheel, elastic: CURVE }",
        0.0,
    ),
];

fn engine(scene: &str, law: &str) -> Engine {
    let text = scene.replace("LAW", law).replace("CURVE", CURVE);
    let loader = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let scene =
        bryant_generator::read_annotated_str("corner", &text, &loader).expect("scenes are right");
    Engine::new(Config::new().lists(&scene.model)).expect("no functions")
}

/// The smallest change of the end of a run by a corner that was missed.
const MISSED: f64 = 0.03;

/// What is wrong with the end of a run, if anything is. Errors of a run are far smaller than the effect of a missed
/// corner.
fn judged(speed: f64, end: f64, tolerance: f64) -> Option<String> {
    let exact = closed_form(speed, SLOPES);
    let away = (end - exact).abs();
    let wrong = away.is_nan() || away > MISSED / 4.0;
    wrong.then(|| format!("at {speed} m/s, {tolerance:e}: {end}, not {exact}"))
}

fn none(wrong: &[String], of: usize) {
    assert!(
        wrong.is_empty(),
        "{} of {of} wrong\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn what_would_be_missed_is_far_more_than_errors() {
    for speed in speeds(24) {
        let [hard, soft] = [SLOPES, [SLOPES[0]; 2]].map(|slopes| closed_form(speed, slopes));
        let meets = speed * speed > 2.0 * GRAVITY * (1.0 - START);
        assert_eq!(
            (hard - soft).abs() > MISSED,
            meets,
            "{speed}: {hard} {soft}"
        );
    }
}

#[test]
fn no_run_passes_a_corner_unseen() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, scene, law, offset) in SHAPES {
        let engine = engine(scene, law);
        let mut model = engine.over::<f64>();
        for speed in speeds(24) {
            model.set_parameters(&[speed]);
            let mut start = vec![0.0; model.info().state_length()];
            model.initial_state(&mut start);
            for (k, formula) in FORMULAS.into_iter().enumerate() {
                for tolerance in TOLERANCES {
                    let settings = Settings {
                        every: EVERY[k % EVERY.len()],
                        method: Integrator::adaptive(formula, Tolerances::of(tolerance)),
                        ..Settings::of(model.info())
                    };
                    let mut end = f64::NAN;
                    let done = simulate::run(&model, &start, &settings, None, &mut |sample| {
                        end = sample.outputs[0];
                        ControlFlow::Continue(())
                    });
                    let mistake = match done {
                        Ok(_) => judged(speed, end - offset, tolerance),
                        Err(failure) => Some(failure.to_string()),
                    };
                    count += 1;
                    wrong.extend(mistake.map(|mistake| format!("{name} by {formula} {mistake}")));
                }
            }
        }
    }
    none(&wrong, count);
}

/// Fixed steps \[s\]: one as long as the run, and some within which the hard ground turns the motion. With ω² = 10⁵
/// 1/s² the last one resolves it: ω h = 0.03.
const STEPS: [f64; 5] = [0.75, 0.2, 0.05, 0.01, RESOLVED];
const RESOLVED: f64 = 1e-4;

/// The error, if a run in fixed steps ended as if the hard ground that it met did not exist, to within 2 % of its
/// effect. How well a run resolves the ground that it notices depends on its steps. Without the ground all methods are
/// exact, except for 10⁻³ N/m.
fn unseen(speed: f64, end: f64) -> Option<String> {
    let [hard, soft] = [SLOPES, [SLOPES[0]; 2]].map(|slopes| closed_form(speed, slopes));
    let meets = (hard - soft).abs() > MISSED;
    let wrong = meets && (end - soft).abs() < 0.02 * (hard - soft).abs();
    wrong.then(|| format!("at {speed} m/s: {end}, as without the ground, not {hard}"))
}

#[test]
fn fixed_steps_tell_of_what_they_do_not_see() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, scene, law, offset) in SHAPES {
        let engine = engine(scene, law);
        let mut model = engine.over::<f64>();
        for (i, speed) in speeds(24).into_iter().enumerate() {
            model.set_parameters(&[speed]);
            let mut start = vec![0.0; model.info().state_length()];
            model.initial_state(&mut start);
            for (k, step) in STEPS.into_iter().enumerate() {
                let formula = [Formula::Rk4, Formula::Dopri5][(i + k) % 2];
                let settings = Settings {
                    method: Integrator::fixed(formula, step),
                    ..Settings::of(model.info())
                };
                let mut watch = Watch::new(model.info(), 0.02);
                let mut end = f64::NAN;
                let watched = Some(&mut watch);
                let done = simulate::run(&model, &start, &settings, watched, &mut |sample| {
                    end = sample.outputs[0];
                    ControlFlow::Continue(())
                });
                let told = done.is_err() || watch.diagnostics().next().is_some();
                let mistake = match (told, step == RESOLVED) {
                    (true, true) => Some(format!("{speed} m/s: told for nothing")),
                    (true, false) => None,
                    (false, true) => judged(speed, end - offset, step),
                    (false, false) => unseen(speed, end - offset),
                };
                count += 1;
                wrong.extend(
                    mistake.map(|mistake| format!("{name} by {formula}, {step} s: {mistake}")),
                );
            }
        }
    }
    none(&wrong, count);
}

/// The scenes of a shape as rows of a batch.
struct Rows {
    speeds: Vec<f64>,
    offset: f64,
    tolerance: f64,
    wrong: Vec<String>,
}

impl Scenarios<f64> for Rows {
    fn count(&self) -> usize {
        self.speeds.len()
    }
    fn parameter(&self, scenario: usize, _: usize) -> f64 {
        self.speeds[scenario]
    }
    fn level(&self, _: usize) -> f64 {
        1.0
    }
    fn outputs(&self) -> &[usize] {
        &[0]
    }
    fn ended(&mut self, scenario: usize, ended: &Ended, series: &Series<f64>) {
        let end = series.of(0).last().copied().unwrap_or(f64::NAN);
        let mistake = match ended.status {
            batch::Status::Done => judged(self.speeds[scenario], end - self.offset, self.tolerance),
            status => Some(format!("{status:?}")),
        };
        self.wrong.extend(mistake);
    }
}

struct Batch<'a> {
    engine: &'a Engine,
    rows: &'a mut Rows,
}

impl OfAnyWidth for Batch<'_> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        let settings = batch::Settings {
            duration: DURATION,
            samples: 2,
            pace: batch::Pace::Adaptive(Tolerances::of(self.rows.tolerance)),
            locate: false,
            max_steps: 100_000,
            time_limit: None,
            energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        };
        batch::run::<T>(self.engine, &settings, self.rows);
    }
}

#[test]
fn no_lane_passes_a_corner_unseen() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, scene, law, offset) in SHAPES {
        let engine = engine(scene, law);
        assert_eq!(Family::info(&engine).corners, 1, "{name}");
        for tolerance in TOLERANCES {
            let mut rows = Rows {
                speeds: speeds(60),
                offset,
                tolerance,
                wrong: Vec::new(),
            };
            let widths = [Width::Four, Width::One];
            let done = widths.into_iter().find_map(|width| {
                let (engine, rows) = (&engine, &mut rows);
                with_width(width, Batch { engine, rows })
            });
            assert!(done.is_some());
            count += rows.count();
            let mistakes = rows.wrong.iter();
            wrong.extend(mistakes.map(|mistake| format!("{name} {mistake}")));
        }
    }
    none(&wrong, count);
}
