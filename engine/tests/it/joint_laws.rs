//! Laws of joints that remember or drive, compared with closed forms, on one coordinate of inertia 1 of every kind:
//! unloading curves, friction that holds, motors, drives.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{self, Pace, Status};
use bryant_runtime::response::Response;
use bryant_runtime::{Dynamics, Formula, Integrator, Settings, Tolerances, Width, simulate};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

const TOLERANCE: f64 = 1e-10;

/// The kinds of coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    PlaneHinge,
    Hinge,
    Slider,
    BallAboutY,
    Torsion,
    Flexion,
}

/// All with two sides.
const KINDS: [Of; 5] = [
    Of::PlaneHinge,
    Of::Hinge,
    Of::Slider,
    Of::BallAboutY,
    Of::Torsion,
];

/// One body with one coordinate q and q̈ = Q(t, q, q̇); parameters k = 100 and steep = 400.
fn scene(of: Of, law: &str, [q, rate]: [f64; 2], rest: &str) -> Engine {
    let (dimension, inertia, cg) = match of {
        Of::PlaneHinge => (2, "1", "[0, 0]"),
        _ => (3, "[1, 1, 1]", "[0, 0, 0]"),
    };
    let (joint, start, force, about, what) = match of {
        Of::PlaneHinge => (
            "",
            format!("angles: {{ b: {q} }}, rates: {{ b: {rate} }}"),
            law.to_owned(),
            "",
            "angle",
        ),
        Of::Hinge => (
            "joint: { hinge: y }, ",
            format!("joints: {{ b: {q} }}, joint_rates: {{ b: {rate} }}"),
            law.to_owned(),
            "",
            "angle",
        ),
        Of::Slider => (
            "joint: { slider: z }, ",
            format!("joints: {{ b: {q} }}, joint_rates: {{ b: {rate} }}"),
            law.to_owned(),
            "",
            "position",
        ),
        Of::BallAboutY => (
            "",
            format!("angles: {{ b: [0, {q}, 0] }}, rates: {{ b: [0, {rate}, 0] }}"),
            format!("about: {{ y: {{ {law} }} }}"),
            ", about: y",
            "angle",
        ),
        Of::Torsion => (
            "",
            format!("angles: {{ b: [0, 0, {q}] }}, rates: {{ b: [0, 0, {rate}] }}"),
            format!("torsion: {{ {law} }}"),
            ", about: torsion",
            "angle",
        ),
        Of::Flexion => (
            "",
            format!("angles: {{ b: [0, {q}, 0] }}, rates: {{ b: [0, {rate}, 0] }}"),
            format!("flexion: {{ {law} }}"),
            ", about: flexion",
            "angle",
        ),
    };
    let text = format!(
        "
model: law
dimension: {dimension}
parameters: {{ k: 100, steep: 400 }}
curves: {{ line: {{ points: [[-1, -1], [1, 1]], extrapolate: linear }} }}
systems:
  - name: s
    reference: fixed
    elements: [{{ name: b, {joint}mass: 1, cg: {cg}, inertia: {inertia} }}]
    start: {{ {start} }}
forces:
  - {{ joint: s/b, {force} }}
outputs:
  - {{ name: q, of: joint s/b, what: {what}{about} }}
  - {{ name: rate, of: joint s/b, what: rate{about} }}
{rest}run: {{ duration: 1 s, every: 0.1 s }}
"
    );
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("law.yaml", &text, &none)
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// Time and the first outputs at so many samples, q and q̇ before others, and the number of steps.
fn run<const N: usize>(engine: &Engine, duration: f64, samples: usize) -> (Vec<[f64; N]>, f64) {
    let machine = engine.over::<f64>();
    let settings = Settings {
        method: Integrator::adaptive(Formula::Dopri5, Tolerances::of(TOLERANCE)),
        duration,
        every: duration / samples as f64,
        ..Settings::of(machine.info())
    };
    let mut state = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut state);
    let mut rows = Vec::new();
    let report = simulate::run(&machine, &state, &settings, None, &mut |sample| {
        rows.push(std::array::from_fn(|i| match i {
            0 => sample.t,
            i => sample.outputs[i - 1],
        }));
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|failure| panic!("{failure}"));
    (rows, report.steps as f64)
}

/// The allowed error: each step errs by at most the tolerance in q and in q̇, and an error of q̇ grows with time in q.
fn bound(steps: f64, time: f64) -> f64 {
    steps * TOLERANCE * time.max(1.0)
}

/// x(t) of a mass that is thrown with `v` at a spring of stiffness k, which unloads along slope s and keeps its
/// permanent set on both sides.
fn thrown(v: f64, k: f64, s: f64, t: f64) -> f64 {
    let (loading, line) = (k.sqrt(), s.sqrt());
    let quarter = FRAC_PI_2 / loading + FRAC_PI_2 / line;
    let mut left = t;
    let (mut sets, mut v) = ([0.0, 0.0], v);
    // each side is loaded along the curve once, and the mass leaves it more slowly
    for side in 0..2 {
        let sign = [1.0, -1.0][side];
        let most = v / loading;
        let set = most * (1.0 - k / s);
        if left < FRAC_PI_2 / loading {
            return sign * most * (loading * left).sin();
        }
        if left < quarter {
            let phase = line * (left - FRAC_PI_2 / loading);
            return sign * (set + (most - set) * phase.cos());
        }
        left -= quarter;
        sets[side] = set;
        v *= (k / s).sqrt();
        // the distance to where the other side begins
        let way = set / v;
        if left < way {
            return sign * (set - v * left);
        }
        left -= way;
    }
    // from then on it moves between the two sets, always on the unloading lines
    let (bounce, across) = (PI / line, (sets[0] + sets[1]) / v);
    let depth = v / line;
    // it has just passed 0 on its way up
    if left < sets[0] / v {
        return v * left;
    }
    left = (left - sets[0] / v).rem_euclid(2.0 * (bounce + across));
    if left < bounce {
        return sets[0] + depth * (line * left).sin();
    }
    left -= bounce;
    if left < across {
        return sets[0] - v * left;
    }
    left -= across;
    if left < bounce {
        return -sets[1] - depth * (line * left).sin();
    }
    -sets[1] + v * (left - bounce)
}

const SETS: &str = "elastic: { curve: line, times: k }, unloading_slope: steep";

#[test]
fn each_side_keeps_its_set() {
    for of in KINDS {
        let engine = scene(of, SETS, [0.0, 2.0], "");
        let (rows, steps) = run::<3>(&engine, 3.0, 300);
        for [t, q, _] in rows {
            let expected = thrown(2.0, 100.0, 400.0, t);
            let bound = bound(steps, 20.0);
            assert!(
                (q - expected).abs() <= bound,
                "{of:?} at {t}: {q} for {expected}, allowed {bound:e}"
            );
        }
    }
}

/// The outputs of both sets of the joint.
fn sets(about: &str) -> String {
    ["above", "below"]
        .map(|side| {
            format!("  - {{ name: {side}, of: joint s/b, what: permanent_set_{side}{about} }}\n")
        })
        .concat()
}

fn about(of: Of) -> &'static str {
    match of {
        Of::BallAboutY => ", about: y",
        Of::Torsion => ", about: torsion",
        Of::Flexion => ", about: flexion",
        _ => "",
    }
}

#[test]
fn the_sets_are_outputs() {
    // 1 − k/s of how far each side was ever loaded, from the neutral angle
    let (k, s, v) = (100.0f64, 400.0f64, 2.0);
    let kept = 1.0 - k / s;
    let most = v / k.sqrt();
    let quarter = FRAC_PI_2 / k.sqrt();
    let lowest = quarter + FRAC_PI_2 / s.sqrt() + most * kept / (v * (k / s).sqrt()) + quarter;
    for of in KINDS {
        for neutral in [0.0, 0.3] {
            let law = format!("{SETS}, neutral: {neutral}");
            let engine = scene(of, &law, [neutral, v], &sets(about(of)));
            let (rows, steps) = run::<5>(&engine, 3.0, 300);
            for [t, q, _, above, below] in rows {
                let at = |t: f64| thrown(v, k, s, t);
                let expected = [at(t.min(quarter)), at(t.min(lowest)).min(0.0)];
                for (ours, furthest) in [above, below].into_iter().zip(expected) {
                    let bound = bound(steps, 20.0);
                    assert!(
                        (ours - kept * furthest).abs() <= bound,
                        "{of:?} at {t}: {ours} for {}, allowed {bound:e}, at {q}",
                        kept * furthest
                    );
                }
            }
        }
    }
}

#[test]
fn a_set_is_of_the_time_in_which_the_force_acts() {
    // thrown to 0.125 before the force is there; at 0.08, on the way back, it is loaded at once, and unloads from there
    // along its line
    let law = format!("name: back, motor: -4 }}\n  - {{ joint: s/b, {SETS}, since: now");
    let outputs = sets(about(Of::Slider));
    let rest = format!("{outputs}switches: [{{ switch: now, when: {{ time: 0.4 }} }}]\n");
    let engine = scene(Of::Slider, &law, [0.0, 1.0], &rest);
    let (rows, steps) = run::<5>(&engine, 0.425, 85);
    for &[t, q, _, above, _] in rows.iter().filter(|row| row[0] >= 0.4) {
        let (foot, slope) = (0.75 * 0.08, 400.0f64);
        let (rest, turned) = (foot - 4.0 / slope, slope.sqrt() * (t - 0.4));
        let expected = rest + (0.08 - rest) * turned.cos() - 0.6 / slope.sqrt() * turned.sin();
        let bound = bound(steps, 20.0);
        assert!((q - expected).abs() <= bound, "at {t}: {q} for {expected}");
        assert!((above - foot).abs() <= bound, "at {t}: {above}");
    }
}

#[test]
fn flexion_keeps_one_set() {
    // bent by a, on with v: energy says how far
    let (k, s, a, v) = (100.0f64, 400.0f64, 0.1, 2.0f64);
    let furthest = (a * a + v * v / k).sqrt();
    let law = "stiffness: 100, unloading_slope: steep";
    let engine = scene(Of::Flexion, law, [a, v], &sets(about(Of::Flexion)));
    let (rows, steps) = run::<5>(&engine, 0.2, 2);
    let [_, q, rate, above, below] = rows[2];
    assert!(q < furthest && rate < 0.0, "has turned: {q} {rate}");
    let apart = (above - (1.0 - k / s) * furthest).abs();
    assert!(apart <= bound(steps, 20.0), "{above} {apart:e}");
    assert_eq!(below, 0.0);
}

#[test]
fn lanes_and_gradients_know_the_sets() {
    let engine = scene(Of::Hinge, SETS, [0.0, 2.0], "");
    // on the way back; after both sets; while bouncing off one
    for duration in [0.3, 0.9, 2.0] {
        let job = |width| Job {
            settings: batch::Settings {
                duration,
                samples: 2,
                pace: Pace::Adaptive(Tolerances::of(TOLERANCE)),
                locate: true,
                max_steps: 100_000,
                time_limit: None,
                energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
            },
            varied: vec![0, 1],
            fixed: Vec::new(),
            responses: vec![Asked::of(0, Response::Final)],
            estimate: false,
            wanted: f64::INFINITY,
            width,
        };
        let rows: Vec<[f64; 2]> = (0..13)
            .map(|i| [90.0 + 3.0 * f64::from(i), 400.0 + 20.0 * f64::from(i)])
            .collect();
        for width in Width::ALL.into_iter().filter(|width| width.is_available()) {
            let found = engine
                .rows(&job(width), rows.as_flattened())
                .expect("registers");
            for (i, [k, s]) in rows.iter().enumerate() {
                assert_eq!(found.rows[i].status, Status::Done);
                let expected = thrown(2.0, *k, *s, duration);
                let apart = (found.responses[i] - expected).abs();
                // some hundred steps, each with an error of the tolerance, times the rate of 20
                assert!(apart <= 1e4 * TOLERANCE, "{k}, {s}: {apart:e}");
            }
        }
        for [k, s] in [[100.0, 400.0], [120.0, 610.0]] {
            let found = engine
                .gradients(&job(Width::widest()), &[k, s], &[1.0, 0.0, 0.0, 1.0])
                .expect("registers");
            let h = 1e-4;
            let difference = |dk: f64, ds: f64| {
                let at = |h: f64| thrown(2.0, k + h * dk, s + h * ds, duration);
                (at(h) - at(-h)) / (2.0 * h)
            };
            for (ours, exact) in found
                .slopes
                .iter()
                .zip([difference(1.0, 0.0), difference(0.0, 1.0)])
            {
                assert!(
                    (ours - exact).abs() <= 1e-5 * exact.abs() + 1e-8,
                    "{duration}: {ours} for {exact}"
                );
            }
        }
    }
}

#[test]
fn what_unloading_gives_back_is_the_area_below_its_curve() {
    // half a cycle leaves √(E_u/E_l) of the speed: down the line to u, then along u
    let (k, s, u, v) = (100.0f64, 400.0, 25.0, 2.0f64);
    let most = v / k.sqrt();
    let foot = most * (1.0 - k / s);
    let meets = s * foot / (s - u);
    let back = 0.5 * u * meets * meets + 0.5 * (u * meets + k * most) * (most - meets);
    let ratio = (back / (0.5 * k * most * most)).sqrt();
    let law = "elastic: { curve: line, times: k }, unloading: { curve: line, times: 25 }, unloading_slope: steep";
    for of in KINDS {
        let engine = scene(of, law, [0.0, v], &sets(about(of)));
        let (rows, steps) = run::<5>(&engine, 2.0, 20_000);
        // the foot of the line: of f on the way out, of u once that is met, on the side where the joint is
        let out = FRAC_PI_2 / k.sqrt();
        let met = out + ((meets - foot) / (most - foot)).acos() / s.sqrt();
        for &[t, q, rate, above, below] in rows.iter().filter(|row| row[0] < met + 0.3) {
            let bound = bound(steps, 10.0);
            let expected = match t {
                t if t < out => q * (1.0 - k / s),
                t if t < met => foot,
                _ if q > 0.0 => q * (1.0 - u / s),
                _ => 0.0,
            };
            assert!(
                (above - expected).abs() <= bound,
                "{of:?} at {t}: {above} for {expected}"
            );
            let below_expected = if q < 0.0 && rate < 0.0 {
                q * (1.0 - k / s)
            } else {
                0.0
            };
            if q > 0.0 || rate < 0.0 {
                assert!(
                    (below - below_expected).abs() <= bound,
                    "{of:?} at {t}: {below}"
                );
            }
        }
        let peaks: Vec<f64> = rows
            .windows(3)
            .filter(|w| w[1][1].abs() > w[0][1].abs() && w[1][1].abs() >= w[2][1].abs())
            .map(|w| w[1][1])
            .collect();
        assert!(peaks.len() >= 4, "{of:?}: {peaks:?}");
        // half a sample away from the top of a parabola
        let sampled = 0.5 * k * most * 0.5e-4f64.powi(2);
        for (n, peak) in peaks.iter().enumerate() {
            let expected = most * ratio.powi(n as i32) * [1.0, -1.0][n % 2];
            let bound = sampled + bound(steps, 10.0);
            assert!(
                (peak - expected).abs() <= bound,
                "{of:?}, {n}: {peak} for {expected}, allowed {bound:e}"
            );
        }
    }
}

#[test]
fn what_is_held_does_not_creep() {
    let rub = "friction: 2, friction_speed: 0.01";
    for of in KINDS {
        let held = format!("{rub}, friction_displacement: 1e-3, motor: 1.8");
        let (rows, steps) = run::<3>(&scene(of, &held, [0.0; 2], ""), 100.0, 100);
        for [t, q, rate] in rows.into_iter().filter(|row| row[0] > 9.0) {
            // 0.9 of the friction bends the bristle by 0.9 of its displacement; the transient of the start has decayed
            // to e⁻⁹⁰
            let bound = bound(steps, 1.0);
            assert!(
                (q - 0.9e-3).abs() <= bound,
                "{of:?} at {t}: {q}, allowed {bound:e}"
            );
            assert!(rate.abs() <= bound, "{of:?} at {t}: {rate}");
        }
        // with friction by speed it creeps with 0.9 of the tolerance speed, 1/200 s late
        let creeps = format!("{rub}, motor: 1.8");
        let (rows, steps) = run::<3>(&scene(of, &creeps, [0.0; 2], ""), 100.0, 100);
        for [t, q, _] in rows.into_iter().filter(|row| row[0] > 0.5) {
            let expected = 0.009 * (t - 1.0 / 200.0);
            assert!(
                (q - expected).abs() <= bound(steps, 1.0),
                "{of:?} at {t}: {q}"
            );
        }
        // above the friction limit it slides under the whole friction
        let slides = format!("{rub}, friction_displacement: 1e-3, motor: 2.2");
        let (rows, steps) = run::<3>(&scene(of, &slides, [0.0; 2], ""), 2.0, 20);
        let rate = |t: f64| {
            let row = rows.iter().find(|row| (row[0] - t).abs() < 1e-9);
            row.expect("a sample")[2]
        };
        assert!(
            (rate(2.0) - rate(1.0) - 0.2).abs() <= bound(steps, 1.0),
            "{of:?}"
        );
    }
}

#[test]
fn a_bristle_straightens_while_its_force_does_not_act() {
    let law = "friction: 2, friction_speed: 0.01, friction_displacement: 1e-3, until: over";
    let switch = "switches: [{ switch: over, when: { time: 1 } }]\n";
    let engine = scene(Of::Slider, law, [0.0, 1.0], switch);
    let machine = engine.over::<f64>();
    let settings = Settings {
        method: Integrator::adaptive(Formula::Dopri5, Tolerances::of(TOLERANCE)),
        duration: 2.0,
        every: 1.0,
        ..Settings::of(machine.info())
    };
    let mut state = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut state);
    let mut bristle = Vec::new();
    simulate::run(&machine, &state, &settings, None, &mut |sample| {
        // q, v, z
        bristle.push(sample.state[2]);
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|failure| panic!("{failure}"));
    // braked by 2 m/s² for half a second, it springs back within z_b and rests; then the bristle straightens by e⁻¹⁰
    assert!(bristle[1].abs() < 1e-3 && bristle[1] != 0.0, "{bristle:?}");
    let left = bristle[1] * (-10.0f64).exp();
    assert!((bristle[2] - left).abs() <= 1e-9, "{bristle:?} {left}");
}

/// A stone on an arm, held by no force, and a stone that is a system of its own start with the same motion. Both fly
/// alike, and the arm swings as if it were alone, though the coordinates of the first stone are relative to it.
#[test]
fn a_free_joint_lets_go() {
    let bodies = "mass: 0.5, cg: [0.02, 0.01, 0], inertia: [0.01, 0.012, 0.008]";
    let text = format!(
        "
model: flight
dimension: 3
systems:
  - name: carried
    reference: fixed
    elements:
      - {{ name: arm, joint: {{ hinge: y }}, mass: 2, cg: [0.5, 0, 0], inertia: [0.1, 0.2, 0.2] }}
      - {{ name: stone, on: arm, at: [1, 0, 0], joint: free, {bodies} }}
    start: {{ joint_rates: {{ arm: -3, stone: [0, 0, 0, 1, 1, 0.3] }} }}
  - name: alone
    elements: [{{ name: stone, {bodies} }}]
    start: {{ position: [1, 0, 0], velocity: [0, 0, 3], rates: {{ stone: [1, -2, 0.3] }} }}
  - name: empty
    reference: fixed
    elements: [{{ name: arm, joint: {{ hinge: y }}, mass: 2, cg: [0.5, 0, 0], inertia: [0.1, 0.2, 0.2] }}]
    start: {{ joint_rates: {{ arm: -3 }} }}
forces:
  - {{ field: gravity, acceleration: [0, 0, -9.81] }}
outputs:
  - {{ name: a1, of: carried/stone, what: position, at: [0.1, 0.2, 0.3], component: [x, y, z] }}
  - {{ name: a2, of: alone/stone, what: position, at: [0.1, 0.2, 0.3], component: [x, y, z] }}
  - {{ name: b1, of: carried/stone, what: angular_velocity, component: [x, y, z] }}
  - {{ name: b2, of: alone/stone, what: angular_velocity, component: [x, y, z] }}
  - {{ name: c1, of: carried/arm, what: angular_velocity, component: [x, y, z] }}
  - {{ name: c2, of: empty/arm, what: angular_velocity, component: [x, y, z] }}
run: {{ duration: 0.4 s, every: 0.05 s }}
"
    );
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) =
        bryant_generator::read_str("flight.yaml", &text, &none).unwrap_or_else(|e| panic!("{e}"));
    let engine = Engine::new(Config::new().lists(&model)).expect("no functions");
    let machine = engine.over::<f64>();
    let settings = Settings {
        method: Integrator::adaptive(Formula::Dopri5, Tolerances::of(TOLERANCE)),
        ..Settings::of(machine.info())
    };
    let mut state = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut state);
    let mut rows = Vec::new();
    let report = simulate::run(&machine, &state, &settings, None, &mut |sample| {
        rows.push(sample.outputs.to_vec());
        ControlFlow::Continue(())
    });
    let steps = report.unwrap_or_else(|failure| panic!("{failure}")).steps;
    let position = |name: String| {
        let mut outputs = machine.info().outputs.iter();
        let found = outputs.position(|o| o.name == name);
        found.unwrap_or_else(|| panic!("{name}"))
    };
    let mut pairs = Vec::new();
    for what in ["a", "b", "c"] {
        for axis in ["x", "y", "z"] {
            pairs.push([1, 2].map(|k| position(format!("{what}{k} {axis}"))));
        }
    }
    // relative coordinates are divided by the cosine of the second angle, which stays above a half
    let bound = bound(steps as f64, 10.0);
    for (k, row) in rows.iter().enumerate() {
        for &[a, b] in &pairs {
            assert!((row[a] - row[b]).abs() <= bound, "{k}: {a} {b} {row:?}");
        }
    }
}

#[test]
fn motors_and_drives_move_as_their_formulas_say() {
    let e = |t: f64| (-3.0 * t).exp() * (0.1 * (4.0 * t).cos() + 0.075 * (4.0 * t).sin());
    type Motion<'a> = (&'a str, [f64; 2], &'a dyn Fn(f64) -> f64);
    let motions: [Motion<'_>; 6] = [
        ("motor: { points: [[0, 0], [2, 4]] }", [0.0; 2], &|t| {
            t * t * t / 3.0
        }),
        ("motor: -0.6", [0.0; 2], &|t| -0.3 * t * t),
        // at constant voltage: from 0.5 at rest down to 0 at 0.4 rad/s
        ("motor: 0.5, damping: 0.5 / 0.4", [0.0; 2], &|t| {
            0.4 * (t - 0.8 * (1.0 - (-t / 0.8).exp()))
        }),
        (
            "drive: { to: { points: [[0, 0.1], [5, 1.1]] }, stiffness: 25, damping: 6 }",
            [0.1, 0.2],
            &|t| 0.1 + 0.2 * t,
        ),
        (
            "drive: { to: { points: [[0, 0.1], [5, 1.1]] }, stiffness: 25, damping: 6 }",
            [0.0, 0.2],
            &|t| 0.1 + 0.2 * t - e(t),
        ),
        (
            "drive: { to: 1000, stiffness: 10, damping: 1, limit: 0.3 }",
            [0.0; 2],
            &|t| 0.15 * t * t,
        ),
    ];
    for of in KINDS {
        for (law, start, expected) in motions {
            let (rows, steps) = run::<3>(&scene(of, law, start, ""), 1.0, 20);
            for [t, q, _] in rows {
                let bound = bound(steps, 1.0) + 1e-14;
                assert!(
                    (q - expected(t)).abs() <= bound,
                    "{of:?}, {law} at {t}: {q} for {}",
                    expected(t)
                );
            }
        }
    }
}
