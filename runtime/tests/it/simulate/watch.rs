//! The watch against motions whose fate theory knows.

use crate::models::{Leaky, Oscillator, Stage, Stiff};
use bryant_runtime::simulate::{ENERGY_LIMIT, Watch};
use bryant_runtime::simulate::{Integrator, Problem, Settings, run};
use bryant_runtime::{Differentiable, Formula, Model, ParameterSet, Report, Tolerances};
use core::ops::ControlFlow;

/// A run of a model whose first parameter is set, watched.
fn watched<M: Model<f64>>(
    parameter: Option<f64>,
    settings: &Settings,
    limit: f64,
) -> (
    Watch<'static, f64>,
    Result<Report, bryant_runtime::Failure<'static>>,
) {
    let mut parameters = M::Parameters::defaults();
    if let Some(value) = parameter {
        assert!(parameters.set(0, value));
    }
    let model = M::new(parameters);
    let mut watch = Watch::new(M::INFO, limit);
    let (model, start) = (Differentiable(&model), model.initial_state());
    let sink = &mut |_: bryant_runtime::Sample<'_, _>| ControlFlow::Continue(());
    let result = run(&model, start.as_ref(), settings, Some(&mut watch), sink);
    (watch, result.map_err(|failure| failure.with_info(M::INFO)))
}

fn settings(method: Integrator, duration: f64) -> Settings {
    Settings {
        method,
        duration,
        every: duration,
        ..Settings::of(Oscillator::INFO)
    }
}

/// Speed and index of the fastest motion, where the step was found to be above the limit.
fn step_of(watch: &Watch<'_, f64>) -> Option<(f64, usize)> {
    watch.diagnostics().find_map(|found| match found.problem {
        Problem::Step { rate, index, .. } => Some((rate, index)),
        _ => None,
    })
}

#[test]
fn a_step_above_the_limit_is_found_with_the_speed_of_the_motion() {
    // ω = 10 1/s; a step 1.2 times above the limit in any direction is above that on the imaginary axis
    let omega = 10.0;
    for formula in Formula::ALL {
        let Some(limit) = formula.stability_limit() else {
            continue;
        };
        let method = Integrator::fixed(formula, 1.2 * limit / omega);
        let settings = settings(method, 100.0 * limit / omega);
        let (watch, result) = watched::<Oscillator>(Some(omega * omega), &settings, ENERGY_LIMIT);
        let (rate, _) = step_of(&watch).unwrap_or_else(|| panic!("{formula}: {result:?}"));
        // exact but for rounding: a linear model whose states differ along its only motion
        assert!((rate / omega - 1.0).abs() < 1e-9, "{formula}: {rate}");
        let found = watch.diagnostics().next().expect("a diagnostic");
        let text = found.to_string();
        let expected = format!("above the stability limit of {formula} in this scene, about");
        assert!(
            text.contains(&expected) && text.contains("10.0 1/s"),
            "{text}"
        );
    }
}

#[test]
fn a_step_below_the_limit_of_the_oscillator_is_not_suspected() {
    // limits on the imaginary axis, where an undamped oscillator lies: Hairer & Wanner, Solving ODEs II, IV.2
    for (formula, limit) in [
        (Formula::SemiImplicitEuler, 2.0),
        (Formula::Rk4, 8f64.sqrt()),
        (Formula::Merson, 12f64.sqrt()),
    ] {
        let omega = 10.0;
        let settings = settings(Integrator::fixed(formula, 0.95 * limit / omega), 20.0);
        let (watch, result) = watched::<Oscillator>(Some(omega * omega), &settings, ENERGY_LIMIT);
        assert!(result.is_ok());
        assert_eq!(step_of(&watch), None, "{formula}");
    }
}

#[test]
fn a_step_that_blows_up_at_once_is_explained_by_its_size() {
    // hλ = 10⁴: infinite within a few dozen steps
    for formula in [Formula::Rk4, Formula::Dopri5, Formula::Dop853] {
        let settings = settings(Integrator::fixed(formula, 0.1), 1000.0);
        let (watch, result) = watched::<Stiff>(None, &settings, ENERGY_LIMIT);
        assert!(result.is_err(), "{formula}");
        let (rate, index) = step_of(&watch).unwrap_or_else(|| panic!("{formula}"));
        assert!((rate / 1e5 - 1.0).abs() < 1e-6, "{formula}: {rate}");
        assert_eq!(index, 0);
    }
}

#[test]
fn steps_under_error_control_are_stable_and_not_suspected() {
    // λ = −10⁵ 1/s over 0.01 s: stability bounds the steps, at loose tolerances too
    for formula in Formula::ALL.into_iter().filter(|f| f.estimates_error()) {
        for tolerance in [1e-2, 1e-3, 1e-5] {
            let method = Integrator::adaptive(formula, Tolerances::uniform(tolerance));
            let settings = settings(method, 0.01);
            let (watch, result) = watched::<Stiff>(None, &settings, ENERGY_LIMIT);
            assert!(result.is_ok(), "{formula} at {tolerance}: {result:?}");
            assert_eq!(watch.diagnostics().count(), 0, "{formula} at {tolerance}");
        }
    }
}

#[test]
fn what_is_missing_in_the_balance_is_found_since_when() {
    // a power of which a tenth is not told from 0.5 s on: T = ½ t², W = 0.45 t² + const
    let of = |limit: f64| {
        let settings = settings(Integrator::default(), 1.0);
        let (watch, result) = watched::<Leaky>(None, &settings, limit);
        assert!(result.is_ok());
        watch.diagnostics().next()
    };
    // gap(t) = 0.05 (t² − ¼), of ½ t²
    let found = of(0.02).expect("a diagnostic");
    let Problem::Energy { share, effect, .. } = found.problem else {
        panic!("{found}");
    };
    assert!((share - 0.075).abs() < 1e-6, "{share}");
    assert_eq!(effect, Some(0));
    // 0.05 (t² − ¼) = 0.02 · ½ t² at t² = 0.3125: no earlier than a step before
    assert!(found.t < 0.3125f64.sqrt() && found.t > 0.3, "{}", found.t);
    assert!(found.to_string().contains("7.50 %"), "{found}");
    assert_eq!(of(0.08), None);
    assert_eq!(of(f64::INFINITY), None);
}

#[test]
fn a_slow_loss_of_the_energy_of_a_pendulum_is_found() {
    // |R(ihω)|² = 1 + (hω)⁴/4 of modified Euler: 5 % in 2000 steps of hω = 0.1, while 32 periods exchange 128 times the energy
    let settings = settings(Integrator::fixed(Formula::Heun, 0.1), 200.0);
    let (watch, _) = watched::<Stage>(None, &settings, ENERGY_LIMIT);
    let exchanged = watch.balance.exchanged;
    let gap = watch.balance.gap().abs();
    assert!(gap < ENERGY_LIMIT * exchanged, "{gap} {exchanged}");
    assert!(matches!(
        watch.diagnostics().next().map(|found| found.problem),
        Some(Problem::Energy { .. })
    ));
    let settings = Settings {
        method: Integrator::default(),
        ..settings
    };
    assert_eq!(
        watched::<Stage>(None, &settings, ENERGY_LIMIT)
            .0
            .diagnostics()
            .count(),
        0
    );
}

/// Coordinate and velocity of x = cos t at the end of so many steps, and their estimated errors.
fn swung(formula: Formula, step: f64, steps: f64) -> [[f64; 2]; 2] {
    let settings = settings(Integrator::fixed(formula, step), steps * step);
    let model = Oscillator::new(ParameterSet::defaults());
    let mut watch = Watch::new(Oscillator::INFO, f64::INFINITY);
    let mut last = [0.0; 2];
    let (model, start) = (Differentiable(&model), Model::<f64>::initial_state(&model));
    let sink = &mut |sample: bryant_runtime::Sample<'_, f64>| {
        last.copy_from_slice(sample.state);
        ControlFlow::Continue(())
    };
    run(&model, &start, &settings, Some(&mut watch), sink).unwrap();
    [
        last,
        [0, 1].map(|i| watch.error_of_entry(i).expect("fixed steps")),
    ]
}

#[test]
fn the_error_of_fixed_steps_is_estimated_within_a_factor_of_two() {
    // steps at which each errs by a part of the amplitude in a few periods
    for (formula, step) in [
        (Formula::SemiImplicitEuler, 0.1),
        (Formula::Heun, 0.2),
        (Formula::Rk4, 0.6),
        (Formula::Merson, 0.6),
        (Formula::Dopri5, 0.9),
        (Formula::Tsit5, 0.9),
        (Formula::Dop853, 2.0),
        (Formula::Rodas5, 0.9),
    ] {
        for steps in [7.0, 30.0, 100.0] {
            let [state, estimate] = swung(formula, step, steps);
            let t = step * steps;
            let error = [state[0] - t.cos(), state[1] + t.sin()];
            let size = error[0].hypot(error[1]);
            let apart = (error[0] - estimate[0]).hypot(error[1] - estimate[1]);
            assert!(
                size > 0.5 || apart <= 0.5 * size,
                "{formula}, {steps} steps: {error:?}, {estimate:?}"
            );
        }
    }
}
