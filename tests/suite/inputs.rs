//! Inputs change during a run: the motion is that of closed forms, to rounding where the integrator is exact.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::failure::{Reason, Refusal};
use bryant_runtime::simulate::{Driven, Run, Watch, workspace_length};
use bryant_runtime::{Adaptive, Failure, Pace, Settings, Tolerances};
use std::io;

/// A cart of 2 kg on a rail along x, which an input pushes.
const CART: &str = "\
model: cart
dimension: 2
inputs:
  push: { value: 0 N, min: -100 N, max: 100 N }
  line: 1 m
systems:
  - name: cart
    reference: fixed
    elements: [{ name: body, joint: { slider: x }, mass: 2 kg, cg: [0, 0], inertia: 1 }]
outputs:
  - { name: x, of: cart/body, what: position, component: x }
  - { name: v, of: cart/body, what: velocity, component: x }
run: { duration: 1 s, every: 0.1 s }
";

fn read(text: &str) -> Result<Engine, String> {
    let none = |_: &std::path::Path| Err(io::ErrorKind::NotFound.into());
    let (model, _) =
        bryant_generator::read_str("cart.yaml", text, &none).map_err(|e| e.to_string())?;
    let lists = Config::new().matrices(false).lists(&model);
    Ok(Engine::new(lists).expect("it has no functions of a user"))
}

fn cart(forces: &str) -> Engine {
    read(&format!("{CART}{forces}")).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Runs a model; before each of the times, `control` is given the outputs and sets the inputs. The outputs at the last
/// time.
fn driven<'e>(
    engine: &'e Engine,
    tolerance: f64,
    times: &[f64],
    mut control: impl FnMut(usize, &[f64]) -> [f64; 2],
) -> Result<Vec<f64>, Failure<'e>> {
    let mut model = engine.in_double();
    let info = engine.info();
    let mut settings = Settings::of(info);
    if let Pace::Adaptive(adaptive) = &mut settings.method.pace {
        *adaptive = Adaptive {
            tolerances: Tolerances::uniform(tolerance),
            ..*adaptive
        };
    }
    let mut start = vec![0.0; info.state_length()];
    model.initial_state(&mut start);
    let mut memory = vec![0.0; workspace_length(info, &settings)];
    let mut parameters = vec![0.0; Driven::<f64>::length(info)];
    let model = Driven::new(&mut *model, info, &mut parameters);
    let mut watch = Watch::new(info, 0.02);
    let watched = Some(&mut watch);
    let of_model = |failure: Failure<'_>| failure.with_info(info);
    let run = Run::driven(&mut memory, &model, &start, &settings, watched);
    let mut run = run.map_err(of_model)?;
    let mut outputs = run.advance_to(0.0).map_err(of_model)?.outputs.to_vec();
    for (k, &t) in times.iter().enumerate() {
        let inputs = control(k, &outputs);
        model.set_inputs(&inputs).map_err(|refusal| Failure {
            t,
            reason: Reason::Refused(refusal),
            info,
        })?;
        outputs = run.advance_to(t).map_err(of_model)?.outputs.to_vec();
    }
    let doubts: Vec<String> = watch.diagnostics().map(|d| format!("{d:?}")).collect();
    assert!(doubts.is_empty(), "{doubts:?}");
    Ok(outputs)
}

#[test]
fn inputs_are_held_between_two_advances() {
    let engine = cart("forces: [{ joint: cart/body, motor: 0.5 * push }]\n");
    let times: Vec<f64> = (1..=1000).map(|k| f64::from(k) / 1000.0).collect();
    // at first as by default, so that nothing changes before the first step
    let push = |k: usize| match k {
        0 => 0.0,
        k => 40.0 * ((k * 37 % 101) as f64 / 50.0 - 1.0),
    };
    let (mut x, mut v, mut before) = (0.0, 0.0, 0.0);
    let found = driven(&engine, 1e-6, &times, |k, outputs| {
        // polynomials of the second degree, which the method follows exactly: a few roundings a step of numbers up to
        // 10
        let bound = 100.0 * f64::EPSILON * (k + 1) as f64;
        assert!((outputs[0] - x).abs() <= bound, "{k}: {outputs:?} {x}");
        assert!((outputs[1] - v).abs() <= bound, "{k}: {outputs:?} {v}");
        let (a, h) = (0.5 * push(k) / 2.0, times[k] - before);
        (x, v) = (x + v * h + 0.5 * a * h * h, v + a * h);
        before = times[k];
        [push(k), 1.0]
    });
    let found = found.unwrap();
    assert!((found[0] - x).abs() < 1e-12 && (found[1] - v).abs() < 1e-12);
    assert!(x.abs() > 1e-3, "{x}");
}

#[test]
fn a_controller_and_a_stop_act_together() {
    // 8 N on 2 kg up to a stop of 50 N/m at 0.5 m, reached with 2 m/s at 0.5 s, then a spring about 0.5 m + 8/50 m
    let engine =
        cart("forces: [{ joint: cart/body, motor: push, stop: { to: 0.5, stiffness: 50 } }]\n");
    let times: Vec<f64> = (1..=1000).map(|k| f64::from(k) / 1000.0).collect();
    let found = driven(&engine, 1e-10, &times, |_, _| [8.0, 1.0]).unwrap();
    let (omega, rest) = (5.0f64, 8.0 / 50.0);
    let (sine, cosine) = (omega * 0.5).sin_cos();
    let x = 0.5 + rest - rest * cosine + 2.0 / omega * sine;
    let v = rest * omega * sine + 2.0 * cosine;
    // a thousand steps whose errors are allowed to be 1e-10 each
    assert!((found[0] - x).abs() < 1e-7, "{found:?} {x}");
    assert!((found[1] - v).abs() < 1e-7, "{found:?} {v}");
}

#[test]
fn a_threshold_that_falls_fires_its_switch_at_once() {
    let engine = cart(
        "switches: [{ switch: go, when: { of: cart/body, what: position, component: x, above: line } }]\n\
         forces: [{ joint: cart/body, motor: push, since: go }]\n",
    );
    let found = driven(&engine, 1e-6, &[0.25, 0.5, 1.0], |k, _| {
        [10.0, if k < 2 { 1.0 } else { -1.0 }]
    });
    // 5 m/s² for half a second
    let found = found.unwrap();
    assert!((found[1] - 2.5).abs() < 1e-12, "{found:?}");
    assert!((found[0] - 0.625).abs() < 1e-12, "{found:?}");
}

#[test]
fn limits_hold_and_what_is_refused_changes_nothing() {
    let engine = cart("forces: [{ joint: cart/body, motor: push }]\n");
    let mut model = engine.in_double();
    let mut parameters = [0.0; 4];
    let driven = Driven::new(&mut *model, engine.info(), &mut parameters);
    driven.set_inputs(&[3.0, 1.0]).unwrap();
    for bad in [101.0, -100.5, f64::INFINITY, f64::NAN] {
        let refused = driven.set_inputs(&[bad, 1.0]).unwrap_err();
        let expected = match bad.is_finite() {
            true => Refusal::OutOfLimits(0, bad),
            false => Refusal::NotFinite(0, bad),
        };
        assert_eq!(format!("{refused:?}"), format!("{expected:?}"));
        let rate = |model: &Driven<'_, f64>| {
            let mut rate = [0.0; 2];
            bryant_runtime::Dynamics::derivative(model, 0.0, &[0.0, 0.0], &mut rate);
            rate
        };
        assert_eq!(rate(&driven), [0.0, 1.5]);
    }
}

#[test]
fn conditions_hold_also_for_inputs() {
    // an input that stretches a curve must be positive, whatever its limits are
    let engine = cart(
        "curves: { pulse: { points: [[0, 0], [1, 10]] } }\n\
         forces: [{ joint: cart/body, motor: { curve: pulse, stretch: push / 1 N + 1 } }]\n",
    );
    let mut model = engine.in_double();
    let mut parameters = [0.0; 4];
    let driven = Driven::new(&mut *model, engine.info(), &mut parameters);
    let rate = || {
        let mut rate = [0.0; 2];
        bryant_runtime::Dynamics::derivative(&driven, 0.5, &[0.0, 0.0], &mut rate);
        rate[1]
    };
    driven.set_inputs(&[1.0, 1.0]).unwrap();
    assert_eq!(rate(), 1.25);
    let refused = driven.set_inputs(&[-2.0, 1.0]).unwrap_err();
    assert!(matches!(refused, Refusal::Condition(_)), "{refused:?}");
    assert_eq!(rate(), 1.25);
}

#[test]
fn an_input_stands_only_where_a_run_can_follow_it() {
    let said = |forces: &str| read(&format!("{CART}{forces}")).map(|_| ());
    said("forces: [{ field: wind, acceleration: [push / 2 kg, 0] }]\n").unwrap();
    said("forces: [{ joint: cart/body, drive: { to: line, stiffness: 50 } }]\n").unwrap();
    said("forces: [{ load: pull, on: cart/body, force: [push, 0] }]\n").unwrap();
    for forces in [
        "forces: [{ joint: cart/body, damping: push / 1 m * 1 s }]\n",
        "forces: [{ joint: cart/body, stop: { to: line, stiffness: 50 } }]\n",
        "forces: [{ joint: cart/body, motor: 1, friction: push }]\n",
        "vehicles: [{ name: car, velocity: [line / 1 s, 0] }]\n",
    ] {
        let problems = said(forces).unwrap_err();
        assert!(problems.contains("is an input"), "{forces}: {problems}");
        assert_eq!(problems.matches("help:").count(), 1, "{problems}");
    }
    let twice = said("parameters: { push: 1 N }\n").unwrap_err();
    assert!(twice.contains("push"), "{twice}");
}
