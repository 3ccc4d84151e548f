//! How far a run in fixed steps errs, as estimated along with it: neither a false alarm nor silence, of every method,
//! in single runs and in lanes.
//!
//! A run of each scene in each of several steps is compared with a reference. Its true error E is the largest of a
//! velocity, or of a coordinate, relative to the largest of its kind: what the run cannot be trusted beyond ([`OFF`]
//! times the energy limit). Where the motion is smooth, nothing may be said of an error with the threshold at 3 E, and
//! with the threshold at E/3 it must be. Where steps go over touches, the error depends on where in a step a touch is,
//! and may be small by chance: there the default threshold counts, nothing may be said at a third of it, and something
//! must be said at three times it.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{self, Doubt, Fixed, Pace, Status};
use bryant_runtime::response::Response;
use bryant_runtime::simulate::{self, ENERGY_LIMIT, Problem, Watch};
use bryant_runtime::{
    Dynamics, Family, Formula, Info, Integrator, Settings, StateKind, Tolerances, Width,
};
use std::ops::ControlFlow;

/// The threshold over the energy limit: 5 % where that is 2 %.
const OFF: f64 = 2.5;
/// What the estimate may be wrong by.
const FACTOR: f64 = 3.0;
/// Errors that are looked at: more than an engineer asks for, and less than all of the motion.
const LEAST: f64 = 5e-3;
const MOST: f64 = 0.3;
/// The ratio of one step to the next that is tried, and how many are tried.
const SHORTER: f64 = 1.6;
const STEPS: usize = 12;

/// A mass on a slider.
const CART: &str = "model: cart
dimension: 2
systems:
  - name: cart
    reference: fixed
    elements: [{ name: body, joint: { slider: x }, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { START }
forces:
  - { joint: cart/body, LAW }
outputs: [{ name: v, of: joint cart/body, what: rate }]
run: { duration: 1 s, every: 1 s }
";

/// Rods that swing.
const RODS: &str = "model: rods
dimension: 2
curves: { pulse: { points: [[0, 0], [0.1, 10], [0.4, 10], [0.5, 0]] } }
systems:
  - name: rods
    reference: fixed
    elements:
      - { name: a, mass: 1, cg: [0, -0.5], inertia: 0.1 }
      MORE
    start: { angles: { a: 2 } }
forces: [{ field: g, acceleration: [FIELD, -9.81] }]
outputs: [{ name: angle, of: rods/a, what: angle }]
run: { duration: 1 s, every: 1 s }
";

/// A free body that turns about its middle axis.
const TOP: &str = "model: top
dimension: 3
systems:
  - name: top
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [0.01, 0.02, 0.026] }]
    start: { rates: { body: [0.1, 10, 0.2] } }
outputs: [{ name: vx, of: top/body, what: velocity, component: x }]
run: { duration: 1 s, every: 1 s }
";

/// A ball on a stiff plate: ω = √(k/m) = 141 1/s.
const BALL: &str = "model: ball
dimension: 2
systems:
  - name: man
    elements: [{ name: ball, mass: 5 kg, cg: [0, 0], inertia: 0.02 }]
    start: { START }
forces:
  - { field: g, acceleration: [0, -9.81] }
  - contact: shelf
    ellipsoid: { on: man/ball, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { points: [[0, 0], [1, 1e5]], extrapolate: linear }
    damping: 100
    damping_depth: 1e-3
outputs: [{ name: z, of: man/ball, what: position, component: z }]
run: { duration: 1 s, every: 1 s }
";

/// A car that brakes to a stop, with a body that swings on it and one that it pulls.
const CAR: &str = "model: car
dimension: 2
vehicles:
  - { name: car, acceleration: [-3.1, 0], stops: true, start: { position: [0, 0], velocity: [15.3, 0] } }
systems:
  - name: hook
    reference: { on: car, at: [0, 1] }
    elements: [{ name: link, mass: 2 kg, cg: [0, -0.3], inertia: 0.05 }]
    start: { angles: { link: 0.1 } }
  - name: block
    elements: [{ name: body, mass: 3 kg, cg: [0, 0], inertia: 0.05 }]
    start: { position: [1.5, 0.1], velocity: [10, 0] }
forces:
  - { field: gravity, acceleration: [0, -9.81], on: [hook] }
  - spring: tie
    from: { on: block/body, at: [0, 0] }
    to: { on: car, at: [1, 0] }
    length: 0.5 m
    stiffness: 40 N/m
    damping: 5
outputs: [{ name: x, of: car, what: position, component: x }]
run: { duration: 4 s, every: 4 s }
";

/// A scene with its duration and the longest step to try.
struct Case {
    name: &'static str,
    /// Whether no step goes over a touch.
    smooth: bool,
    text: String,
    duration: f64,
    longest: f64,
}

fn scenes() -> Vec<Case> {
    let cart = |start: &str, law: &str| CART.replace("START", start).replace("LAW", law);
    let rods = |more: &str, field: &str| RODS.replace("MORE", more).replace("FIELD", field);
    let second = "- { name: b, on: a, at: [0, -1], mass: 1, cg: [0, -0.5], inertia: 0.1 }";
    let stop = "stop: { from: -0.05, to: 0.05, stiffness: 3000, damping: 5, damping_angle: 0.005 }";
    let touches = ["stop", "bounce", "rest", "car"];
    let of = |name, text: String, duration, longest| Case {
        name,
        smooth: !touches.contains(&name),
        text,
        duration,
        longest,
    };
    let out = "joints: { body: 0.1 }";
    vec![
        of("oscillator", cart(out, "stiffness: 100"), 2.0, 0.3),
        of("damped", cart(out, "stiffness: 100, damping: 2"), 2.0, 0.3),
        of("creeps", cart(out, "stiffness: 100, damping: 40"), 1.0, 0.1),
        of(
            "friction",
            cart(out, "stiffness: 100, friction: 2, friction_speed: 0.3"),
            1.0,
            0.3,
        ),
        of(
            "stop",
            cart(
                "joint_rates: { body: 1 }",
                &format!("stiffness: 10, {stop}"),
            ),
            0.5,
            0.05,
        ),
        of("pendulum", rods("", "0"), 3.0, 0.8),
        of("pushed", rods("", "pulse"), 2.0, 0.8),
        of("double pendulum", rods(second, "0"), 2.0, 0.4),
        of("top", TOP.to_owned(), 2.0, 0.4),
        of(
            "bounce",
            BALL.replace("START", "position: [0, 0.11], velocity: [0, -3]"),
            0.06,
            6e-3,
        ),
        of(
            "rest",
            BALL.replace("START", "position: [0, 0.0985]"),
            0.2,
            0.01,
        ),
        of("car", CAR.to_owned(), 4.0, 0.5),
    ]
}

impl Case {
    /// Thresholds at which nothing may be said of an error, and at which it must be.
    fn thresholds(&self, error: f64) -> [Option<f64>; 2] {
        let usual = OFF * ENERGY_LIMIT;
        match self.smooth {
            true => [Some(FACTOR * error), Some(error / FACTOR)],
            false => [
                Some(usual).filter(|_| FACTOR * error <= usual),
                Some(usual).filter(|_| error >= FACTOR * usual),
            ],
        }
    }
}

fn engine_of(text: &str) -> Engine {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("scene.yaml", text, &none)
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// States at samples as far apart as steps are, and whether they are said to err by too much where the energy limit is
/// such; `None` of a run that failed.
fn run(
    engine: &Engine,
    method: Integrator,
    [duration, every]: [f64; 2],
    limit: f64,
) -> Option<(Vec<Vec<f64>>, bool)> {
    let model = engine.over::<f64>();
    let info = model.info();
    let mut state = vec![0.0; info.state_length()];
    model.initial_state(&mut state);
    let settings = Settings {
        method,
        duration,
        every,
        locate: matches!(method.pace, simulate::Pace::Adaptive(_)),
        ..Settings::of(info)
    };
    let mut states = Vec::new();
    let mut watch = Watch::new(info, limit);
    simulate::run(&model, &state, &settings, Some(&mut watch), &mut |sample| {
        states.push(sample.state.to_vec());
        ControlFlow::Continue(())
    })
    .ok()?;
    let errs = |doubt: simulate::Diagnostic| matches!(doubt.problem, Problem::Error { .. });
    let told = watch.diagnostics().any(errs);
    Some((states, told))
}

/// The largest difference of velocities, angular velocities and the coordinates of either, relative to the largest of
/// its kind.
fn apart(info: &Info, run: &[Vec<f64>], reference: &[Vec<f64>]) -> f64 {
    let least = Tolerances::default();
    let mut largest = [
        least.velocities,
        least.angular_velocities,
        least.positions,
        least.angles,
    ];
    let mut apart = [0.0_f64; 4];
    let coordinates = info.coordinates.len();
    for (state, exact) in run.iter().zip(reference) {
        for i in 0..coordinates + info.velocities.len() {
            let straight = matches!(info.kind(i), StateKind::Velocity | StateKind::Position);
            let kind = usize::from(!straight) + 2 * usize::from(i < coordinates);
            let size = match i < coordinates {
                true => state[i] - run[0][i],
                false => state[i],
            };
            largest[kind] = largest[kind].max(size.abs());
            apart[kind] = apart[kind].max((state[i] - exact[i]).abs());
        }
    }
    let shares = apart.iter().zip(largest).map(|(apart, size)| apart / size);
    shares.fold(0.0, f64::max)
}

/// The steps of a method at which a run errs by something worth looking at, with that error.
fn errors(engine: &Engine, scene: &Case, formula: Formula) -> Vec<(f64, f64)> {
    let info = Family::info(engine);
    let mut found = Vec::new();
    let mut step = scene.longest;
    for _ in 0..STEPS {
        let every = scene.duration / (scene.duration / step).ceil();
        let lengths = [scene.duration, every];
        let of = |method| run(engine, method, lengths, f64::INFINITY);
        if let Some((states, _)) = of(Integrator::fixed(formula, every)) {
            let exact = Integrator::adaptive(Formula::Dop853, Tolerances::of(1e-11));
            let (exact, _) = of(exact).expect("the reference reaches its end");
            let error = apart(info, &states, &exact);
            if (LEAST..MOST).contains(&error) {
                found.push((every, error));
            }
            if error < LEAST {
                break;
            }
        }
        step /= SHORTER;
    }
    found
}

#[test]
fn the_error_is_told_where_it_is_and_only_there() {
    for scene in scenes() {
        let engine = engine_of(&scene.text);
        let mut looked_at = 0;
        for formula in Formula::ALL {
            for (step, error) in errors(&engine, &scene, formula) {
                let name = scene.name;
                for (threshold, expected) in scene.thresholds(error).into_iter().zip([false, true])
                {
                    let Some(threshold) = threshold else {
                        continue;
                    };
                    looked_at += 1;
                    let method = Integrator::fixed(formula, step);
                    let lengths = [scene.duration, step];
                    let (_, told) = run(&engine, method, lengths, threshold / OFF).expect("it ran");
                    assert_eq!(
                        told, expected,
                        "{name} {formula} {step}: an error of {error:.1e}"
                    );
                }
            }
        }
        // most methods have a step with an error worth looking at
        assert!(
            looked_at >= Formula::ALL.len(),
            "{}: {looked_at}",
            scene.name
        );
    }
}

#[test]
fn the_error_is_told_of_lanes_as_well() {
    let mut told_as_an_error = [0; batch::LaneFormula::ALL.len()];
    for scene in scenes() {
        let engine = engine_of(&scene.text);
        for (place, method) in batch::LaneFormula::ALL.into_iter().enumerate() {
            for (step, error) in errors(&engine, &scene, method.formula()) {
                let row = |threshold: f64| {
                    let settings = batch::Settings {
                        duration: scene.duration,
                        samples: 2,
                        pace: Pace::Fixed(Fixed { method, step }),
                        locate: false,
                        max_steps: 100_000,
                        time_limit: None,
                        energy_limit: threshold / OFF,
                    };
                    let job = Job {
                        settings,
                        varied: Vec::new(),
                        fixed: Vec::new(),
                        responses: vec![Asked::of(0, Response::Final)],
                        estimate: false,
                        wanted: f64::INFINITY,
                        width: Width::widest(),
                    };
                    engine.rows(&job, &[]).expect("registers").rows[0]
                };
                // a row has one reason: what is missing in a balance is named first
                let [quiet, told] = scene.thresholds(error);
                let name = scene.name;
                let case = format!("{name} {method:?} {step}: an error of {error:.1e}");
                let errs = |doubt| matches!(doubt, Some(Doubt::Error(_)));
                if let Some(quiet) = quiet {
                    assert!(!errs(row(quiet).doubt), "{case}");
                }
                if let Some(told) = told {
                    let told = row(told);
                    assert_eq!(told.status, Status::Doubtful, "{case}");
                    told_as_an_error[place] += u32::from(errs(told.doubt));
                }
            }
        }
    }
    assert!(
        told_as_an_error.iter().all(|&told| told > 0),
        "{told_as_an_error:?}"
    );
}
