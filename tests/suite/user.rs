//! User forces: against built-in forces with the same law, and against closed forms.

use crate::users::functions;
use bryant_generated as bundled;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::expression::evaluate::Inputs;
use bryant_runtime::program::Entry;
use bryant_runtime::{Model as _, ParameterSet, Section};
use bryant_tests::compiled_equations::Compiled;
use bryant_tests::models::{self, MODELS};
use bryant_tests::rounding::Rounded;
use bryant_tests::runs::{Recording, run};
use bryant_tests::trees::Random;

const STATES: usize = 40;
/// As in `compiled`: the factor from the scatter of eight samples to the largest difference.
const C: f64 = 20.0;
const TOLERANCE: f64 = 1e-11;
const G: f64 = 9.81;

fn named(name: &str) -> &'static Compiled {
    let found = MODELS.iter().find(|m| m.entry.info.name == name);
    found.unwrap_or_else(|| panic!("{name} is no test model"))
}

/// v̇ and the outputs of the compiled model, and the effect of rounding on each.
fn values(compiled: &Compiled, t: f64, state: &[f64]) -> Vec<(f64, f64)> {
    let model = compiled.model();
    let route = None;
    let matrices = false;
    let equations = derive_with(&model, Options { matrices, route });
    let roots = [&equations.accelerations[..], &equations.outputs].concat();
    let (q, v) = state.split_at(equations.coordinates.len());
    let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let inputs = Inputs {
        time: t,
        coordinates: q,
        velocities: v,
        parameters: &parameters,
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    let mut rounded = Rounded::new(&equations.graph, &roots);
    let (_, scatter) = rounded.evaluate(&inputs, &functions(&model), f64::EPSILON);
    let mut rates = vec![f64::NAN; state.len()];
    compiled
        .entry
        .derivative(&[], t, state, &mut rates)
        .expect("rates");
    let outputs = compiled.entry.section(Section::Outputs, &[], t, state);
    let outputs = outputs.expect("outputs");
    let values = rates[q.len()..].iter().chain(&outputs).copied();
    values.zip(scatter).collect()
}

/// Every kind of port has the same effect as the built-in force with the same law: in the plane by a function of this
/// crate, in space by files beside the model. Both round differently: c κ ε, as in `compiled`.
#[test]
fn functions_of_the_user_do_what_built_in_forces_do() {
    for (user, twin) in [
        ("user-plane", "twin-plane"),
        ("user-space", "twin-space"),
        ("user-joints", "twin-joints"),
    ] {
        let (user, twin) = (named(user), named(twin));
        assert_eq!(user.entry.info.coordinates, twin.entry.info.coordinates);
        assert_eq!(user.entry.info.velocities, twin.entry.info.velocities);
        let names: Vec<&str> = twin.entry.info.outputs.iter().map(|o| o.name).collect();
        let start = twin.entry.initial_state(&[]).expect("a start");
        let mut random = Random::new(7);
        for k in 0..STATES {
            let range = if k % 2 == 0 { 0.05 } else { 0.5 };
            let mut state: Vec<f64> = start
                .iter()
                .map(|x| x + random.uniform(-range, range))
                .collect();
            for (i, name) in twin.entry.info.coordinates.iter().enumerate() {
                if name.ends_with(".qw") {
                    let quaternion = &mut state[i..i + 4];
                    let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
                    quaternion.iter_mut().for_each(|x| *x /= norm);
                }
            }
            let t = random.uniform(0.0, 0.1);
            let (ours, theirs) = (values(user, t, &state), values(twin, t, &state));
            let largest = |of: &[(f64, f64)]| of.iter().fold(0.0f64, |m, (_, s)| m.max(*s));
            let velocities = twin.entry.info.velocities.len();
            for (i, (a, b)) in ours.iter().zip(&theirs).enumerate() {
                let all = if i < velocities {
                    ..velocities
                } else {
                    ..ours.len()
                };
                let bound = C * (largest(&ours[all]) + largest(&theirs[all]));
                let what = twin.entry.info.velocities.iter().chain(&names).nth(i);
                assert!(
                    (a.0 - b.0).abs() <= bound,
                    "{} of {what:?}: {} by functions, {} built in, allowed {bound:e}",
                    twin.entry.info.name,
                    a.0,
                    b.0
                );
            }
        }
        assert_eq!(ours_taut(&user.entry), ours_taut(&twin.entry));
    }
}

/// Whether the first output has a force at the start: the belt must be taut there, or its law would not be compared.
fn ours_taut(entry: &Entry) -> bool {
    let state = entry.initial_state(&[]).expect("a start");
    let outputs = entry.section(Section::Outputs, &[], 0.0, &state);
    let outputs = outputs.expect("outputs");
    assert!(outputs[0] > 1.0, "{}: {outputs:?}", entry.info.name);
    true
}

/// v = v_t tanh(g t/v_t), v_t = √(2 m g/(ρ c_d A)), from rest. A step errs by at most the tolerance times the speed,
/// and drag reduces errors.
#[test]
fn a_falling_body_tends_to_its_terminal_velocity() {
    let entry = bundled::find("skydiver").expect("it is bundled").entry;
    for area in [0.46, 1.0, 20.0] {
        let run = run(&entry, &[("drag_area", area)], TOLERANCE);
        let terminal = (2.0 * 80.0 * G / (1.225 * area)).sqrt();
        let (speed, drag) = (run.column("speed"), run.column("drag"));
        let bound = run.steps * TOLERANCE * (1.0 + terminal);
        assert!(bound < 1e-3 * terminal, "the bound {bound:e} is empty");
        for ((&t, speed), drag) in run.times.iter().zip(speed).zip(drag) {
            let expected = terminal * (G * t / terminal).tanh();
            assert!(
                (speed - expected).abs() <= bound,
                "{area} m² at {t} s: {speed} instead of {expected}, allowed {bound:e}"
            );
            let of_drag = 80.0 * G * (expected / terminal).powi(2);
            // the force is quadratic in the speed
            let bound = 2.0 * bound * 80.0 * G / terminal + 1e-12;
            assert!(
                (drag - of_drag).abs() <= bound,
                "{t} s: {drag} N, not {of_drag}"
            );
        }
    }
}

/// In wind the body drifts. Relative to the air it falls as in still air, with the wind against it at the start, so it
/// ends at the speed of the wind.
#[test]
fn the_wind_takes_the_body_along() {
    let entry = bundled::find("skydiver").expect("it is bundled").entry;
    let run = run(&entry, &[("wind", 10.0), ("drag_area", 20.0)], TOLERANCE);
    let (speed, last) = (run.column("speed"), run.times.len() - 1);
    let terminal = (2.0 * 80.0 * G / (1.225 * 20.0)).sqrt();
    // both components relax at least like exp(−g t/v_t)
    let left = (10.0 + terminal) * (-G * run.times[last] / terminal).exp();
    let expected = 10f64.hypot(terminal);
    let bound = run.steps * TOLERANCE * (1.0 + expected) + left;
    assert!(
        (speed[last] - expected).abs() <= bound,
        "{} {expected}",
        speed[last]
    );
}

fn held(excitation: f64) -> Recording {
    let entry = models::elbow_hold::ENTRY;
    run(&entry, &[("excitation", excitation)], TOLERANCE)
}

/// ȧ = (u − a)/(τ (0.5 + 1.5 a)) for a < u: t = −τ (1.5 (a − a₀) + (0.5 + 1.5 u) ln((u − a)/(u − a₀)));
/// ȧ = −a (0.5 + 1.5 a)/τ for u = 0: a/(0.5 + 1.5 a) = a₀/(0.5 + 1.5 a₀) exp(−0.5 t/τ).
#[test]
fn activation_follows_excitation_as_its_closed_form_says() {
    let (start, rise, decay) = (0.02, 0.015, 0.05);
    for u in [0.3, 1.0] {
        let run = held(u);
        let mut compared = 0;
        let samples = run.times.iter().zip(run.column("activation"));
        for ((&t, a), rate) in samples.zip(run.column("activation rate")) {
            // while the rate is still large enough to determine times
            if rate < 1e-3 {
                continue;
            }
            let ratio: f64 = (u - a) / (u - start);
            let expected = -rise * (1.5 * (a - start) + (0.5 + 1.5 * u) * ratio.ln());
            let bound = (run.steps * TOLERANCE + 1e-14) / rate;
            assert!(bound < 1e-3, "the bound {bound:e} is empty");
            assert!(
                (t - expected).abs() <= bound,
                "u = {u}: a = {a} at {t}, not {expected}"
            );
            compared += 1;
        }
        assert!(compared > 5, "{compared}");
    }
    let run = held(0.0);
    let odds = |a: f64| a / (0.5 + 1.5 * a);
    for (&t, a) in run.times.iter().zip(run.column("activation")) {
        let expected = odds(start) * (-0.5 * t / decay).exp();
        let bound = 2.0 * run.steps * TOLERANCE;
        assert!(bound < 1e-3 * odds(start));
        assert!((odds(a) - expected).abs() <= bound, "a = {a} at {t}");
    }
}

/// Held still: a = u, and the muscle's moment about the elbow balances that of the weight.
#[test]
fn a_muscle_holds_the_forearm_where_the_moments_balance() {
    let isometric = |u: f64, length: f64| -> f64 {
        let stretch = (length - 0.18) / 0.14;
        let active = u * (-(stretch - 1.0f64).powi(2) / 0.45).exp();
        let strain = (stretch - 1.0f64).max(0.0);
        1000.0 * (active + ((5.0 * strain / 0.6).exp() - 1.0) / (5f64.exp() - 1.0))
    };
    // M_y = z F_x − x F_z of the tension towards the origin, and of the weight
    let span = |angle: f64| {
        let (x, z) = (0.045 * angle.cos(), -0.045 * angle.sin());
        let (dx, dz) = (0.02 - x, 0.29 - z);
        (x, z, dx, dz, dx.hypot(dz))
    };
    let moment = |u: f64, angle: f64| {
        let (x, z, dx, dz, length) = span(angle);
        let force = isometric(u, length) / length;
        force * (z * dx - x * dz) + 2.0 * G * 0.2 * angle.cos()
    };
    for u in [0.1, 0.2, 0.3] {
        let run = held(u);
        let last = run.times.len() - 1;
        let at = |name: &str| run.column(name)[last];
        let (angle, speed) = (at("angle"), at("speed"));
        let error = run.steps * TOLERANCE;
        assert!((at("activation") - u).abs() <= error);
        let length = span(angle).4;
        assert!((at("length") - length).abs() <= 1e-15);
        // 5 kN/m is more than the stiffness of this muscle at these lengths; an activation of 1 is 1 kN of force
        let bound = 5e3 * error + 1e3 * error + 1e4 * speed.abs();
        assert!(bound < 1e-2 * isometric(u, length));
        assert!(
            (at("force") - isometric(u, length)).abs() <= bound,
            "u = {u}: {} N instead of {}",
            at("force"),
            isometric(u, length)
        );
        let stiffness = ((moment(u, angle + 1e-4) - moment(u, angle - 1e-4)) / 2e-4).abs();
        // the remaining motion: a damping of 2 N m s and that of the muscle, below 1 kN s/m · 45 mm
        let bound = (stiffness + 45.0) * error + (2.0 + 45.0) * speed.abs();
        let weight = 2.0 * G * 0.2;
        assert!(bound < 1e-2 * weight, "the bound {bound:e} is empty");
        assert!(
            moment(u, angle).abs() <= bound,
            "u = {u}: {} N m are left at {angle} rad, allowed {bound:e}",
            moment(u, angle)
        );
    }
}

/// The power of the muscle in the balance is −T L̇, up to the rounding of a product.
#[test]
fn the_work_of_the_muscle_is_counted() {
    let entry = models::elbow_hold::ENTRY;
    let at = entry.info.powers.iter().position(|p| *p == "user biceps");
    let at = at.expect("the muscle is among the effects that do work");
    assert_eq!(entry.info.auxiliaries, ["user biceps: activation"]);
    let run = held(0.3);
    let columns = ["force", "shortening"].map(|name| run.column(name));
    let mut most = 0.0f64;
    for (i, (&t, state)) in run.times.iter().zip(&run.states).enumerate() {
        let powers = entry.section(Section::Powers, &[("excitation".into(), 0.3)], t, state);
        let powers = powers.expect("powers");
        let expected = -columns[0][i] * columns[1][i];
        let error = (powers[at] - expected).abs();
        assert!(
            error <= 8.0 * f64::EPSILON * expected.abs(),
            "{t}: {error:e}"
        );
        most = most.max(expected.abs());
    }
    assert!(most > 1.0, "the muscle did work, {most} W");
}

/// One text serves all scalars: f32 agrees within its own rounding, c κ ε of the arguments and of the muscle's twenty
/// operations.
#[test]
fn a_function_of_the_user_computes_in_single_precision() {
    let compiled = bryant_tests::compiled_equations::Compiled {
        path: "../models/elbow.yaml",
        entry: bundled::find("elbow").expect("it is bundled").entry,
        matrices: None,
    };
    let model = compiled.model();
    let route = None;
    let matrices = false;
    let equations = derive_with(&model, Options { matrices, route });
    let roots: Vec<_> = equations
        .accelerations
        .iter()
        .copied()
        .chain(equations.auxiliaries.iter().map(|z| z.next))
        .collect();
    let mut rounded = Rounded::new(&equations.graph, &roots);
    let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let single = bundled::elbow::Mechanism::<f32>::new(ParameterSet::<f32>::defaults());
    let double = bundled::elbow::Mechanism::<f64>::new(ParameterSet::<f64>::defaults());
    let mut random = Random::new(3);
    for _ in 0..STATES {
        let mut state = [0.0f64; 5];
        for (x, range) in state.iter_mut().zip([1.0, 1.0, 2.0, 2.0, 0.4]) {
            *x = f64::from(random.uniform(-range, range) as f32);
        }
        state[4] = state[4].abs();
        let t = f64::from(random.uniform(0.2, 0.6) as f32);
        let inputs = Inputs {
            time: t,
            coordinates: &state[..2],
            velocities: &state[2..4],
            parameters: &parameters,
            auxiliaries: &state[4..],
            memory: &[],
            accelerations: &[],
        };
        let (_, scatter) = rounded.evaluate(&inputs, &functions(&model), f32::EPSILON.into());
        let largest = scatter.iter().fold(0.0f64, |m, s| m.max(*s));
        let ours = single.derivative(t as f32, &state.map(|x| x as f32));
        let expected = double.derivative(t, &state);
        for i in 2..5 {
            let error = (f64::from(ours[i]) - expected[i]).abs();
            assert!(
                error <= C * largest,
                "[{i}]: {error:e}, allowed {:e}",
                C * largest
            );
        }
        assert!((2..5).any(|i| f64::from(ours[i]) != expected[i]));
    }
}
