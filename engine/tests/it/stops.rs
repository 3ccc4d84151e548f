//! Vehicles that stop and stay at rest, compared with closed forms: over every scalar, in single runs, in lanes and in
//! gradients.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{self, Fixed, Pace, Status};
use bryant_runtime::response::Response;
use bryant_runtime::{
    Adjustable, DoubleDouble, Dual, Dynamics, Family, Formula, Integrator, Real, Settings,
    Tolerances, Width, simulate,
};
use std::ops::ControlFlow;

/// A car that brakes, with bodies that ride on it, swing on it and are tied to it.
const CAR: &str = "
model: car
dimension: 2
parameters:
  speed: 10 m/s
  braking: 5 m/s^2
vehicles:
  - { name: car, acceleration: [-braking, 0], STOPS start: { position: [WHERE, 0], velocity: [speed, 0] } }
systems:
  - name: hook
    reference: { on: car, at: [0, 1] }
    elements: [{ name: link, mass: 2 kg, cg: [0, -0.3], inertia: 0.05 }]
    start: { angles: { link: ANGLE }, rates: { link: RATE } }
  - name: block
    elements: [{ name: body, mass: 3 kg, cg: [0, 0], inertia: 0.05 }]
    start: { position: [BLOCK], velocity: [BLOCKS] }
forces:
  - { field: gravity, acceleration: [0, -9.81], on: [hook] }
  - spring: tie
    from: { on: block/body, at: [0, 0] }
    to: { on: car, at: [1, 0] }
    length: 0.5 m
    stiffness: 40 N/m
    damping: 5
outputs:
  - { name: x, of: car, what: position, component: x }
  - { name: v, of: car, what: velocity, component: x }
  - { name: a, of: car, what: acceleration, component: x }
  - { name: angle, of: hook/link, what: angle }
  - { name: block, of: block/body, what: position, component: x }
run: { duration: 4 s, every: 4 s }
";

fn engine_of(text: &str) -> Engine {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) =
        bryant_generator::read_str("scene.yaml", text, &none).unwrap_or_else(|e| panic!("{e}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// How a car moves.
#[derive(Clone, Copy)]
enum Moves {
    Stops,
    Brakes,
    Uniformly,
}

/// A car with the bodies that ride on it and are tied to it.
fn car(moves: Moves, place: f64, hook: [f64; 2], block: [[f64; 2]; 2]) -> Engine {
    let [[x, z], [u, w]] = block;
    let braking = "acceleration: [-braking, 0],";
    let text = match moves {
        Moves::Stops => CAR.replace("STOPS", "stops: true,"),
        Moves::Brakes => CAR.replace("STOPS", ""),
        Moves::Uniformly => CAR.replace(braking, "").replace("STOPS", ""),
    };
    let text = text.replace("WHERE", &format!("{place:e}"));
    let text = text.replace("ANGLE", &format!("{:e}", hook[0]));
    let text = text.replace("RATE", &format!("{:e}", hook[1]));
    let text = text.replace("BLOCKS", &format!("{u:e}, {w:e}"));
    engine_of(&text.replace("BLOCK", &format!("{x:e}, {z:e}")))
}

const BLOCK: [[f64; 2]; 2] = [[1.5, 0.1], [10.0, 0.0]];

fn stopping() -> Engine {
    car(Moves::Stops, 0.0, [0.1, 0.0], BLOCK)
}

/// x, v, a at a time, of a constant braking from a speed.
fn braked(speed: f64, braking: f64, t: f64) -> [f64; 3] {
    let stop = speed / braking;
    let moved = |t: f64| speed * t - 0.5 * braking * t * t;
    match speed * braking > 0.0 && t >= stop {
        true => [moved(stop), 0.0, 0.0],
        false => [moved(t), speed - braking * t, -braking],
    }
}

fn outputs<T: Real>(model: &dyn Dynamics<T>, t: f64) -> Vec<T> {
    let mut state = vec![T::from_f64(0.0); model.info().state_length()];
    model.initial_state(&mut state);
    let mut found = vec![T::from_f64(0.0); model.info().outputs.len()];
    model.outputs(T::from_f64(t), &state, &mut found);
    found
}

#[test]
fn constant_braking_ends_at_the_speed_over_it() {
    let engine = stopping();
    let (mut machine, mut interpreter) = (engine.over::<f64>(), engine.interpreted::<f64>());
    for (speed, braking) in [
        (10.0, 5.0),
        (13.9, 8.3),
        (-10.0, -5.0),
        // it never stops
        (10.0, -5.0),
        (10.0, 0.0),
        (0.0, 3.0),
        (0.0, 0.0),
    ] {
        machine.set_parameters(&[speed, braking]);
        interpreter.set_parameters(&[speed, braking]);
        for i in 0..=400 {
            let t = 0.02 * f64::from(i);
            let found = outputs(&machine, t);
            assert_eq!(found, outputs(&interpreter, t), "{speed}, {braking}: {t}");
            let expected = braked(speed, braking, t);
            for (found, expected) in found.iter().zip(expected) {
                let close = (found - expected).abs() <= 1e-13 * (1.0 + expected.abs());
                // at the end itself both sides are correct
                let at_end = (t * braking - speed).abs() < 1e-12;
                assert!(
                    close || at_end,
                    "{speed}, {braking} at {t}: {found}, {expected}"
                );
            }
        }
        let stop = match speed * braking > 0.0 {
            true => speed / braking,
            false => f64::INFINITY,
        };
        let kink = machine.kink_after(0.0);
        assert!(
            kink == stop || (kink - stop).abs() <= 1e-14 * stop,
            "{kink}"
        );
        assert_eq!(machine.kink_after(kink), f64::INFINITY);
        assert_eq!(machine.kink_after(1e9), f64::INFINITY);
    }
}

#[test]
fn the_end_moves_with_the_parameters() {
    let engine = stopping();
    let mut model = engine.over::<Dual<f64>>();
    for (speed, braking) in [(10.0, 5.0), (13.9, 8.3), (-7.0, -0.3)] {
        let (v, a) = (Dual::constant(speed), Dual::constant(braking));
        let stop = speed / braking;
        let cases = [
            ([Dual::variable(speed), a], 1.0 / braking, stop),
            (
                [v, Dual::variable(braking)],
                -stop / braking,
                -0.5 * stop * stop,
            ),
        ];
        for (parameters, by_time, by_place) in cases {
            model.set_parameters(&parameters);
            let kink = model.kink_after(0.0);
            assert!((kink.slope / by_time - 1.0).abs() <= 1e-14, "{kink:?}");
            let found = outputs(&model, 1.5 * stop);
            assert!(
                (found[0].slope / by_place - 1.0).abs() <= 1e-14,
                "{found:?}"
            );
            assert_eq!((found[1].slope, found[2].slope), (0.0, 0.0));
        }
    }
    // where there is no end, nothing moves and nothing is NaN
    for (speed, braking) in [(10.0, -5.0), (10.0, 0.0), (0.0, 5.0), (0.0, 0.0)] {
        for parameters in [
            [Dual::variable(speed), Dual::constant(braking)],
            [Dual::constant(speed), Dual::variable(braking)],
        ] {
            model.set_parameters(&parameters);
            let kink = model.kink_after(0.0);
            assert_eq!((kink.value, kink.slope), (f64::INFINITY, 0.0));
            for found in outputs(&model, 3.0) {
                assert!(
                    found.value.is_finite() && found.slope.is_finite(),
                    "{found:?}"
                );
            }
        }
    }
}

#[test]
fn more_digits_than_a_double_s_are_right() {
    let engine = stopping();
    let mut model = Family::over::<DoubleDouble>(&engine);
    let c = DoubleDouble::from_f64;
    model.set_parameters(&[c(1.0), c(3.0)]);
    let place = outputs(&*model, 1.0)[0];
    assert!((c(6.0) * place - c(1.0)).to_f64().abs() <= 1e-30);
}

fn curved(curve: &str, scaled: &str, more: &str) -> Engine {
    engine_of(&format!(
        "
model: pulse
dimension: 2
parameters: {{ speed: 6, times: 1, stretch: 1 }}
curves:
  c: {{ {curve} }}
vehicles:
  - {{ name: car, acceleration: [{scaled}, 0], stops: true, start: {{ velocity: [speed, 0] }} }}
  - {{ name: bus, velocity: [stretch, 0] }}
systems:
  - name: sled
    reference: {{ acceleration: [0, {scaled}], stops: true }}
    elements: [{{ name: link, mass: 2 kg, cg: [0, -0.3], inertia: 0.05 }}]
    start: {{ velocity: [0.5, speed] }}
outputs:
  - {{ name: x, of: car, what: position, component: x }}
  - {{ name: v, of: car, what: velocity, component: x }}
  - {{ name: a, of: car, what: acceleration, component: x }}
  - {{ name: z, of: sled/link, at: [0, 0], what: position, component: z }}
  - {{ name: w, of: sled/link, at: [0, 0], what: velocity, component: z }}
  - {{ name: b, of: sled/link, at: [0, 0], what: acceleration, component: z }}
  - {{ name: along, of: sled/link, at: [0, 0], what: position, component: x }}
  - {{ name: bus, of: bus, what: position, component: x }}
{more}run: {{ duration: 4 s, every: 4 s }}
"
    ))
}

/// 0, up to 4 in 1, there for 2, down to 0 in 1. From 6 it comes to rest at 2, after 12 − (2/3 + 2 + 2) = 22/3; from
/// 12, at its last point 4, symmetric about 2, after 24.
#[test]
fn a_pulse_is_followed_up_to_the_end() {
    let points = "points: [[0, 0], [1, -4], [3, -4], [4, 0]]";
    for beyond in ["hold", "linear", "error"] {
        let curve = format!("{points}, extrapolate: {beyond}");
        let engine = curved(&curve, "{ curve: c, times: times, stretch: stretch }", "");
        let mut model = engine.over::<f64>();
        let mut dual = engine.over::<Dual<f64>>();
        for (times, stretch) in [(1.0, 1.0), (0.7, 1.3), (3.0, 0.2), (1e3, 1e-3), (-0.5, 2.0)] {
            for (speed, end, way) in [(6.0, 2.0, 22.0 / 3.0), (12.0, 4.0, 24.0)] {
                let given = [times * stretch * speed, times, stretch];
                model.set_parameters(&given);
                let stop = end * stretch;
                let expected = times * stretch * stretch * way;
                for t in [stop * 1.001, 1.7 * stop, 5.0 * stop, 100.0 * stop] {
                    let found = outputs(&model, t);
                    for k in [0, 3] {
                        let close = (found[k] / expected - 1.0).abs() <= 1e-13;
                        assert!(close, "{beyond} {given:?} at {t}: {found:?}, {expected}");
                        assert_eq!(found[k + 1..k + 3], [0.0; 2], "{beyond} {given:?}");
                    }
                    assert_eq!(found[6], 0.5 * t);
                }
                let before = outputs(&model, 0.999 * stop);
                assert!(before[1] * given[0] > 0.0 && before[1].abs() < given[0].abs());
                // by the speed: T; by the factor: −∬; by the stretch: T' = 0 in x/stretch at the touch, and v₀ is kept
                let by = |k: usize, dual: &mut dyn Adjustable<Dual<f64>>| {
                    let mut all = given.map(Dual::constant);
                    all[k].slope = 1.0;
                    dual.set_parameters(&all);
                    let t = 1.5 * stop;
                    let place = outputs(&*dual, t)[0].slope;
                    let mut kinks = vec![dual.kink_after(0.0)];
                    while kinks[kinks.len() - 1].value < f64::INFINITY {
                        kinks.push(dual.kink_after(kinks[kinks.len() - 1].value));
                    }
                    let near = kinks
                        .iter()
                        .find(|kink| (kink.value / stop - 1.0).abs() < 1e-9);
                    (place, near.expect("a kink").slope)
                };
                let (by_speed, _) = by(0, &mut dual);
                assert!((by_speed / stop - 1.0).abs() <= 1e-12, "{by_speed}, {stop}");
                let (by_times, moved) = by(1, &mut dual);
                let gained = (way - end * speed) * stretch * stretch;
                assert!(
                    (by_times / gained - 1.0).abs() <= 1e-12,
                    "{by_times}, {gained}"
                );
                // 4 × on the plateau: dT/dtimes = −∂v/a = −(stretch · 6)/(4 times)
                if end == 2.0 {
                    let exact = -6.0 * stretch / (4.0 * times);
                    assert!((moved / exact - 1.0).abs() <= 1e-12, "{moved}, {exact}");
                }
            }
            // 12.5 is more than the whole area
            model.set_parameters(&[times * stretch * 12.5, times, stretch]);
            let found = outputs(&model, 5.0 * stretch);
            match beyond {
                "error" => assert!(found[0].is_nan()),
                "hold" => {
                    let left = 0.5 * times * stretch;
                    assert!((found[1] / left - 1.0).abs() <= 1e-12, "{found:?}");
                }
                // the curve goes on upwards: 0.5 + 2 s²
                _ => {
                    let left = 2.5 * times * stretch;
                    assert!((found[1] / left - 1.0).abs() <= 1e-12, "{found:?}");
                }
            }
        }
    }
}

/// y = −x² (3 − 2x) from 0 to 1, then −1: ∫ = −(x³ − x⁴/2), ∬ = −(x⁴/4 − x⁵/10).
#[test]
fn a_smooth_pulse_is_followed_up_to_the_end() {
    let engine = curved(
        "points: [[0, 0], [1, -1]], interpolate: cubic",
        "{ curve: c, times: times, stretch: stretch }",
        "",
    );
    // the slopes of cubics are 0 at held ends
    let mut model = engine.over::<f64>();
    for (times, stretch) in [(1.0, 1.0), (8.0, 0.3), (0.01, 40.0)] {
        for end in [0.2f64, 0.6, 0.95] {
            let speed = end * end * end * (1.0 - end / 2.0);
            let way = end * speed - end.powi(4) * (0.25 - end / 10.0);
            model.set_parameters(&[times * stretch * speed, times, stretch]);
            let found = outputs(&model, 3.0 * stretch);
            let expected = times * stretch * stretch * way;
            assert!(
                (found[0] / expected - 1.0).abs() <= 1e-12,
                "{found:?}, {expected}"
            );
            assert_eq!(found[1..3], [0.0; 2]);
        }
    }
}

/// The end of a run from a time and state, with steps of a given length.
fn end_of(
    engine: &Engine,
    parameters: &[f64],
    duration: f64,
    method: Integrator,
) -> (Vec<f64>, Vec<f64>, u64) {
    let mut model = engine.over::<f64>();
    model.set_parameters(parameters);
    let mut state = vec![0.0; model.info().state_length()];
    model.initial_state(&mut state);
    let settings = Settings {
        method,
        duration,
        every: duration,
        ..Settings::of(model.info())
    };
    let (mut end, mut outputs) = (Vec::new(), Vec::new());
    let report = simulate::run(&model, &state, &settings, None, &mut |sample| {
        end = sample.state.to_vec();
        outputs = sample.outputs.to_vec();
        ControlFlow::Continue(())
    });
    let report = report.unwrap_or_else(|failure| panic!("{failure}"));
    (end, outputs, report.steps)
}

/// A run with long steps equals two runs, the second of which begins at the end of the braking: no step crosses it.
#[test]
fn no_step_goes_across_the_end() {
    for formula in [
        Formula::Dopri5,
        Formula::Rk4,
        Formula::Heun,
        Formula::Dop853,
    ] {
        for (speed, braking) in [(10.0, 5.0), (9.0, 7.0), (11.0, 4.3)] {
            let stop = speed / braking;
            let (duration, step) = (4.0, 0.3);
            let method = Integrator::fixed(formula, step);
            let given = [speed, braking];
            let start = [[1.5, 0.1], [speed, 0.0]];
            let whole = car(Moves::Stops, 0.0, [0.1, 0.0], start);
            let (end, outputs, _) = end_of(&whole, &given, duration, method);
            let until = car(Moves::Brakes, 0.0, [0.1, 0.0], start);
            let (middle, _, _) = end_of(&until, &given, stop, method);
            // hook: angle; block: x, z, angle; then the velocities
            let [hook, x, z, turn, rate, u, w, spin] = middle[..] else {
                panic!("{middle:?}")
            };
            assert!(turn.abs() < 1e-9 && spin.abs() < 1e-9);
            let place = 0.5 * speed * stop;
            let after = car(Moves::Uniformly, place, [hook, rate], [[x, z], [u, w]]);
            let (last, _, _) = end_of(&after, &[0.0], duration - stop, method);
            for (ours, theirs) in end.iter().zip(&last) {
                let bound = 1e-11 * (1.0 + theirs.abs());
                assert!(
                    (ours - theirs).abs() <= bound,
                    "{formula} {given:?}: {end:?}, {last:?}"
                );
            }
            assert!((outputs[0] - 0.5 * speed * stop).abs() <= 1e-12);
        }
    }
}

fn job(engine: &Engine, pace: Pace, responses: &[usize]) -> Job {
    Job {
        settings: batch::Settings {
            duration: 4.0,
            samples: 41,
            pace,
            locate: true,
            max_steps: 100_000,
            time_limit: None,
            energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        },
        varied: (0..Family::info(engine).parameters.len()).collect(),
        fixed: Vec::new(),
        responses: responses
            .iter()
            .map(|output| Asked::of(*output, Response::Final))
            .collect(),
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    }
}

/// Each lane stops at its own time, or never.
#[test]
fn lanes_stop_one_by_one() {
    let engine = stopping();
    let mut rows = Vec::new();
    for i in 0..23 {
        let speed = 2.0 + 0.7 * f64::from(i);
        let braking = [5.0, 8.3, 0.0, -2.0, 3.1][i as usize % 5];
        rows.push([speed, braking]);
    }
    rows.extend([[0.0, 3.0], [0.0, 0.0], [-6.0, -4.0]]);
    let step = 0.2;
    let method = batch::LaneFormula::Dopri5;
    for fixed in [true, false] {
        let pace = match fixed {
            true => Pace::Fixed(Fixed { method, step }),
            false => Pace::Adaptive(Tolerances::of(1e-9)),
        };
        for width in Width::ALL.into_iter().filter(|width| width.is_available()) {
            let mut job = Job {
                width,
                ..job(&engine, pace, &[0, 1, 2, 3, 4])
            };
            // where braking is hard, the pulled block errs by more than is trusted
            job.settings.energy_limit = f64::INFINITY;
            let found = engine.rows(&job, rows.as_flattened()).expect("registers");
            for (i, [speed, braking]) in rows.iter().enumerate() {
                assert_eq!(found.rows[i].status, Status::Done, "{speed}, {braking}");
                let ours = &found.responses[5 * i..5 * i + 5];
                for (ours, expected) in ours.iter().zip(braked(*speed, *braking, 4.0)) {
                    assert!((ours - expected).abs() <= 1e-12 * (1.0 + expected.abs()));
                }
                let (single, bound) = match fixed {
                    true => (Integrator::fixed(Formula::Dopri5, step), 1e-11),
                    false => (
                        Integrator::adaptive(Formula::Dopri5, Tolerances::of(1e-9)),
                        1e-6,
                    ),
                };
                let (_, theirs, _) = end_of(&engine, &[*speed, *braking], 4.0, single);
                for k in [3, 4] {
                    let close = (ours[k] - theirs[k]).abs() <= bound * (1.0 + theirs[k].abs());
                    assert!(close, "{width:?} {speed}, {braking}: {ours:?}, {theirs:?}");
                }
            }
        }
    }
}

/// In steps of 0.2 s the pulled block errs by 1.2 % of the largest speed behind a car that brakes softly, and by 6.9 %
/// behind one that brakes hard, compared with steps of 1 ms. What is told begins at 5 %.
#[test]
fn steps_too_long_for_a_hard_braking_are_told() {
    let engine = stopping();
    let of = |speed: f64, braking: f64, step: f64| {
        let method = Integrator::fixed(Formula::Dopri5, step);
        end_of(&engine, &[speed, braking], 4.0, method).0
    };
    let pace = Pace::Fixed(Fixed {
        method: batch::LaneFormula::Dopri5,
        step: 0.2,
    });
    for (speed, braking, told) in [(15.3, 3.1, false), (16.7, 8.3, true)] {
        let job = job(&engine, pace, &[4]);
        let found = engine.rows(&job, &[speed, braking]).expect("registers");
        let expected = match told {
            true => Status::Doubtful,
            false => Status::Done,
        };
        assert_eq!(found.rows[0].status, expected, "{speed} {braking}");
        // the largest speed is about that of the car at first
        let [long, short] = [0.2, 1e-3].map(|step| of(speed, braking, step));
        let velocities = long.iter().zip(&short).skip(4);
        let apart = velocities.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert_eq!(apart > 0.05 * speed, told, "{apart}");
    }
}

/// For the car, v₀/a and −v₀²/2a²; for the bodies that it carries and pulls, differences of runs.
#[test]
fn gradients_know_that_the_end_moves() {
    let engine = stopping();
    let job = job(&engine, Pace::Adaptive(Tolerances::of(1e-10)), &[0, 3, 4]);
    for (speed, braking) in [(10.0, 5.0), (8.0, 7.1), (17.0, 4.9)] {
        let stop = speed / braking;
        let directions = [1.0, 0.0, 0.0, 1.0];
        let found = engine
            .gradients(&job, &[speed, braking], &directions)
            .expect("registers");
        assert!(found.rows.iter().all(|row| row.status == Status::Done));
        let exact = [stop, -0.5 * stop * stop];
        for (k, exact) in exact.into_iter().enumerate() {
            let ours = &found.slopes[3 * k..3 * k + 3];
            assert!((ours[0] / exact - 1.0).abs() <= 1e-13, "{ours:?}, {exact}");
            let h = 1e-4;
            let moved = |h: f64| {
                [
                    speed + h * directions[2 * k],
                    braking + h * directions[2 * k + 1],
                ]
            };
            let rows = engine
                .rows(&job, [moved(h), moved(-h)].as_flattened())
                .expect("registers");
            for i in [1, 2] {
                let difference = (rows.responses[i] - rows.responses[3 + i]) / (2.0 * h);
                // tolerances divided by h, and h² times third derivatives of some hundreds
                let bound = 1e-5 * (1.0 + difference.abs());
                assert!(
                    (ours[i] - difference).abs() <= bound,
                    "{i}: {ours:?}, {difference}"
                );
            }
        }
    }
}

/// A generator of pseudo-random numbers (splitmix64, Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * (z ^ (z >> 31)) as f64 / 2f64.powi(64)
    }

    fn of_size(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.between(0.0, 1.0))
    }

    fn below(&mut self, count: usize) -> usize {
        self.between(0.0, count as f64) as usize
    }
}

/// Points from 0 to 3 s, some before 0: ordinates of all sizes, level parts, ramps of a nanosecond.
fn points(random: &mut Random) -> String {
    let mut x = [0.0, 0.0, -0.7, 0.2][random.below(4)];
    let mut y = [0.0, random.between(-2.0, 2.0)][random.below(2)];
    let mut points = vec![format!("[{x:e}, {y:e}]")];
    for _ in 0..2 + random.below(6) {
        x += [random.between(0.05, 0.9), random.of_size(1e-9, 1.0)][random.below(2)];
        y = [
            y,
            0.0,
            -y,
            random.between(-2.0, 2.0),
            random.of_size(1e-6, 1e3),
        ][random.below(5)];
        points.push(format!("[{x:e}, {y:e}]"));
    }
    points.join(", ")
}

/// The sign of a velocity; 0 for one that began at rest and came back to rest before the first look.
fn sign_of(side: f64) -> f64 {
    if side == 0.0 { 0.0 } else { side.signum() }
}

/// A body that stops, compared with the same body that goes on. Before the stop both are equal. The body is at rest
/// from the first time at which the other has turned back, and not before.
// one loop, whose steps share the two bodies and their curve
#[test]
fn random_pulses_end_where_the_free_motion_turns() {
    let mut random = Random(7);
    let (mut stopped, mut went_on) = (0, 0);
    for round in 0..150 {
        let smooth = ["linear", "cubic"][round % 2];
        let beyond = ["hold", "linear", "error"][round % 3];
        let curve = format!(
            "points: [{}], interpolate: {smooth}, extrapolate: {beyond}",
            points(&mut random)
        );
        let engine = curved(&curve, "{ curve: c, times: times, stretch: stretch }", "");
        let free = engine_of(&format!(
            "
model: free
dimension: 2
parameters: {{ speed: 6, times: 1, stretch: 1 }}
curves: {{ c: {{ {curve} }} }}
vehicles:
  - {{ name: car, acceleration: [{{ curve: c, times: times, stretch: stretch }}, 0], start: {{ velocity: [speed, 0] }} }}
systems: [{{ name: s, reference: fixed, elements: [{{ name: e, mass: 1, cg: [0, -1], inertia: 1 }}] }}]
outputs:
  - {{ name: x, of: car, what: position, component: x }}
  - {{ name: v, of: car, what: velocity, component: x }}
"
        ));
        let (mut model, mut free) = (engine.over::<f64>(), free.over::<f64>());
        let mut dual = engine.over::<Dual<f64>>();
        for case in 0..12 {
            let stretch = random.of_size(0.01, 100.0);
            let sign = [1.0, -1.0][random.below(2)];
            let mut given = [
                sign * random.of_size(1e-3, 10.0),
                random.between(-3.0, 3.0),
                stretch,
            ];
            given[0] *= stretch;
            free.set_parameters(&[0.0, given[1], stretch]);
            let gained = |t: f64| outputs(&free, t)[1];
            match case {
                // exactly the velocity that the pulse takes up to some place: a point, an extremum or the end
                0..4 => given[0] = -gained(stretch * random.between(0.0, 3.0)),
                4 => {
                    let all = (0..3000).map(|i| gained(stretch * 0.001 * f64::from(i)));
                    given[0] = -all.filter(|v| v.is_finite()).fold(0.0, f64::min);
                }
                5 => given[0] = 0.0,
                6 => given[0] *= 1e-12,
                7 => given[0] *= 1e9,
                _ => {}
            }
            if !given[0].is_finite() {
                continue;
            }
            model.set_parameters(&given);
            free.set_parameters(&given);
            let size = 1.0 + given[0].abs() + 1e3 * given[1].abs() * stretch;
            let rounding = 1e-11 * size;
            let mut side = given[0];
            let mut turned = false;
            let mut rest: Option<f64> = None;
            for i in 0..=2000 {
                let t = stretch * 0.002 * f64::from(i);
                let (ours, theirs) = (outputs(&model, t), outputs(&free, t));
                if let Some(place) = rest {
                    assert_eq!(ours[..3], [place, 0.0, 0.0], "{curve} {given:?} at {t}");
                    continue;
                }
                let moved = side != 0.0 || theirs[1] != 0.0;
                if ours[1] == 0.0 && ours[2] == 0.0 && moved && i > 0 {
                    // either it turned since the last time, or it is about to reach 0
                    let steep = 1e3 * given[1].abs() * 0.002 * stretch;
                    let back = sign_of(side) * theirs[1];
                    assert!(
                        back.is_nan() || back <= steep + rounding,
                        "{curve} {given:?} at {t}"
                    );
                    assert!(ours[0].is_finite());
                    rest = Some(ours[0]);
                    continue;
                }
                for (ours, theirs) in ours[..2].iter().zip(&theirs) {
                    let same = ours == theirs || (ours.is_nan() && theirs.is_nan());
                    assert!(same, "{curve} {given:?} at {t}: {ours}, {theirs}");
                }
                if side == 0.0 {
                    side = theirs[1];
                }
                turned |= side.signum() * theirs[1] < -rounding;
                assert!(!turned, "{curve} {given:?} goes backwards at {t}");
            }
            stopped += u32::from(rest.is_some());
            went_on += u32::from(rest.is_none());
            for k in 0..3 {
                let mut all = given.map(Dual::constant);
                all[k].slope = 1.0;
                dual.set_parameters(&all);
                let end = outputs(&dual, 3.9 * stretch);
                let left = end[0].value.is_nan();
                assert!(
                    left || end[..3].iter().all(|d| d.slope.is_finite()),
                    "{curve} {given:?}"
                );
                assert!(!dual.kink_after(0.0).slope.is_nan());
            }
        }
    }
    assert!(stopped > 300 && went_on > 300, "{stopped}, {went_on}");
}
