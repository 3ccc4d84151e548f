//! The order of every method as observed: on a smooth problem, and on problems with kinks that are located or passed.

use crate::models::{Ball, Kepler, Tether};
use bryant_runtime::simulate::{Integrator, Settings, run, simulate, simulate_stiff};
use bryant_runtime::{
    Differentiable, DoubleDouble, Formula, Model, ParameterSet, Real, Tolerances,
};
use core::ops::ControlFlow;

/// The state at the end of a run, whose only samples are those at its ends.
fn end<M: Model<f64>>(method: Integrator, locate: bool) -> Vec<f64> {
    let model = M::new(M::Parameters::defaults());
    let settings = Settings {
        method,
        locate,
        every: M::INFO.duration,
        ..Settings::of(M::INFO)
    };
    let mut end = Vec::new();
    simulate_stiff(&model, &settings, &mut |sample| {
        end = sample.state.to_vec();
    })
    .unwrap();
    end
}

fn error<M: Model<f64>>(method: Integrator, locate: bool, exact: &[f64]) -> f64 {
    let end = end::<M>(method, locate);
    let errors = end.iter().zip(exact).map(|(y, exact)| (y - exact).abs());
    errors.fold(0.0, f64::max)
}

/// Slope of the line through (ln step, ln error) by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs = points.iter().map(|(h, e)| (h.ln(), e.ln()));
    let (sx, sy, sxx, sxy) = logs.fold((0.0, 0.0, 0.0, 0.0), |(sx, sy, sxx, sxy), (x, y)| {
        (sx + x, sy + y, sxx + x * x, sxy + x * y)
    });
    (n * sxy - sx * sy) / (n * sxx - sx * sx)
}

/// (step, error) of a method at steps of duration/n, n growing by a factor, while the error is within bounds.
fn errors<M: Model<f64>>(
    formula: Formula,
    locate: bool,
    exact: &[f64],
    within: [f64; 2],
    growth: f64,
) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    let mut steps = 12.0;
    while steps < 2e6 {
        let step = M::INFO.duration / f64::floor(steps);
        let error = error::<M>(Integrator::fixed(formula, step), locate, exact);
        if error < within[0] {
            break;
        }
        if error < within[1] {
            points.push((step, error));
        }
        steps *= growth;
    }
    points
}

/// Error at the end of a run of an orbit of eccentricity 0.2 that ends close to eccentric anomaly 5.
fn orbit_error<T: Real>(settings: &Settings) -> f64 {
    let num = T::from_f64;
    let (one, eccentricity) = (num(1.0), num(1.0) / num(5.0));
    let b = (one - eccentricity * eccentricity).sqrt();
    // Kepler's equation t = E − e sin E by Newton's method
    let (t, mut anomaly) = (num(settings.duration), num(5.0));
    for _ in 0..6 {
        let (s, c) = anomaly.sin_cos();
        anomaly = anomaly - (anomaly - eccentricity * s - t) / (one - eccentricity * c);
    }
    let (s, c) = anomaly.sin_cos();
    let rate = one / (one - eccentricity * c);
    let exact = [c - eccentricity, b * s, -(s * rate), b * c * rate];
    let start = [
        one - eccentricity,
        num(0.0),
        num(0.0),
        b / (one - eccentricity),
    ];
    let mut end = start;
    run(
        &Differentiable(&Kepler),
        &start,
        settings,
        None,
        &mut |sample| {
            end.copy_from_slice(sample.state);
            ControlFlow::Continue(())
        },
    )
    .unwrap();
    let errors = (0..4).map(|i| (end[i] - exact[i]).abs().to_f64());
    errors.fold(0.0, f64::max)
}

/// Where an orbit closes its symmetry would flatter some methods, so it ends before.
#[test]
fn every_method_has_its_order_on_a_smooth_problem() {
    let time = 5.0 - 0.2 * 5.0f64.sin();
    for formula in Formula::ALL {
        // first step, how much finer the next, and which errors count: where the order shows already, and rounding (of
        // coefficients, too, of which those of the Rosenbrock method are large) not yet
        let (mut steps, finer, within) = match formula {
            Formula::SemiImplicitEuler => (3000.0, 1.8, 1e-6..3e-3),
            Formula::Heun => (200.0, 1.5, 2e-9..2e-5),
            Formula::Dop853 => (40.0, 1.07, 1.5e-14..3e-11),
            Formula::Rodas5 => (100.0, 1.3, 8e-12..3e-8),
            _ => (100.0, 1.3, 1e-13..1e-9),
        };
        let mut points = Vec::new();
        loop {
            let settings = Settings {
                method: Integrator::fixed(formula, time / f64::floor(steps)),
                duration: time,
                every: time,
                ..Settings::of(<Kepler as Model<f64>>::INFO)
            };
            let error = match formula.order() {
                1 | 2 => orbit_error::<f64>(&settings),
                // rounding of doubles would hide the order before it shows clearly
                _ => orbit_error::<DoubleDouble>(&settings),
            };
            points.push((time / f64::floor(steps), error));
            steps *= finer;
            if error < within.start || steps > 9e6 {
                break;
            }
        }
        let chosen: Vec<(f64, f64)> = points
            .iter()
            .copied()
            .filter(|(_, error)| within.contains(error))
            .collect();
        let largest = chosen.iter().fold(0.0f64, |m, p| m.max(p.1));
        let least = chosen.iter().fold(f64::INFINITY, |m, p| m.min(p.1));
        let observed = slope(&chosen);
        let nominal = f64::from(formula.order());
        assert!(largest / least > 1e3, "{formula}: {points:?}");
        assert!(
            (observed - nominal).abs() < 0.1,
            "{formula}: {observed} {chosen:?}"
        );
    }
}

/// Height and velocity of [`Ball`] at 3 s: free fall of √0.2 s, then an oscillation about −0.1 m at 10 rad/s until it
/// leaves with the velocity that it came with, and so on.
fn ball() -> [f64; 2] {
    let (g, omega) = (10.0f64, 10.0f64);
    let fall = (2.0 / g).sqrt();
    let speed = g * fall;
    // z = −g/ω² (1 − cos ωτ) − v/ω sin ωτ is 0 again where tan(ωτ/2) = −v ω/g
    let contact = 2.0 * (std::f64::consts::PI - (speed * omega / g).atan()) / omega;
    let period = 2.0 * fall + contact;
    let t = 3.0 - fall;
    let phase = t - (t / period).floor() * period;
    if phase < contact {
        let (s, c) = (omega * phase).sin_cos();
        let z = -g / (omega * omega) * (1.0 - c) - speed / omega * s;
        [z, -g / omega * s - speed * c]
    } else {
        let t = phase - contact;
        [speed * t - 0.5 * g * t * t, speed - g * t]
    }
}

/// Position and velocity of [`Tether`] at 1.5 s: a damped oscillation from 0.5 s until the pull is 0, then free.
fn tether() -> [f64; 2] {
    let (decay, omega) = (2.0f64, 96.0f64.sqrt());
    let stretch = |t: f64| 2.0 / omega * (-decay * t).exp() * (omega * t).sin();
    let velocity = |t: f64| {
        let (s, c) = (omega * t).sin_cos();
        2.0 / omega * (-decay * t).exp() * (omega * c - decay * s)
    };
    let pull = |t: f64| 100.0 * stretch(t) + 4.0 * velocity(t);
    // between the largest stretch and the next zero of it
    let (mut low, mut high) = (
        0.25 * std::f64::consts::TAU / omega,
        std::f64::consts::PI / omega,
    );
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if pull(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let v = velocity(low);
    [1.0 + stretch(low) + v * (1.0 - low), v]
}

const WITH_ORDER: [Formula; 7] = [
    Formula::Heun,
    Formula::Rk4,
    Formula::Merson,
    Formula::Dopri5,
    Formula::Tsit5,
    Formula::Dop853,
    Formula::Rodas5,
];

/// Steps between events are of lengths that do not scale exactly, so that the observed order scatters a little; a
/// method may be better than its order on a linear problem, as both of these are between their kinks.
fn check<M: Model<f64>>(exact: &[f64], without: f64) {
    for formula in WITH_ORDER {
        let nominal = f64::from(formula.order());
        // a low order would take millions of steps to the error that shows a high one
        let least = if nominal < 3.0 { 1e-8 } else { 1e-11 };
        let located = errors::<M>(formula, true, exact, [least, 1e-2], 1.23);
        assert!(located.len() >= 6, "{formula}: {located:?}");
        let observed = slope(&located);
        assert!(
            observed > nominal - 0.3,
            "{formula}, located: {observed} {located:?}"
        );
        let least = if without < 1.5 { 1e-5 } else { 1e-8 };
        let passed = errors::<M>(formula, false, exact, [least, 1e-2], 1.37);
        let observed = slope(&passed);
        assert!(
            observed < without + 0.5 && observed < nominal + 0.5,
            "{formula}, passed: {observed} {passed:?}"
        );
        // and by far less accurate at the same step
        if nominal > without + 1.5 {
            let step = M::INFO.duration / 1000.0;
            let method = Integrator::fixed(formula, step);
            let [better, worse] = [true, false].map(|locate| error::<M>(method, locate, exact));
            assert!(better < 1e-2 * worse, "{formula}: {better:e} {worse:e}");
        }
    }
}

#[test]
fn kinks_cost_the_order_of_a_bouncing_ball_unless_located() {
    // the force is continuous: an error of O(h²) at each touch
    check::<Ball>(&ball(), 2.0);
}

#[test]
fn jumps_cost_the_order_of_a_belt_going_taut_unless_located() {
    // the force jumps: an error of O(h)
    check::<Tether>(&tether(), 1.0);
}

#[test]
fn error_follows_the_tolerance_with_kinks_located_or_not() {
    for formula in Formula::ALL.into_iter().filter(|f| f.estimates_error()) {
        for locate in [true, false] {
            for tolerance in [1e-4, 1e-6, 1e-8] {
                let method = Integrator::adaptive(formula, Tolerances::uniform(tolerance));
                let model = <Tether as Model<f64>>::new(crate::models::None);
                let settings = Settings {
                    method,
                    locate,
                    ..Settings::of(<Tether as Model<f64>>::INFO)
                };
                let report = simulate_stiff::<f64, _>(&model, &settings, &mut |_| {}).unwrap();
                let error = error::<Tether>(method, locate, &tether());
                // each step may err by (1 + |y|) tolerances, at most 3; an error of position becomes one of velocity,
                // ten times as large on the belt of 10 rad/s; what kinks add is within a step's tolerance
                assert!(
                    error < 30.0 * report.steps as f64 * tolerance,
                    "{formula} {locate}: {error:e} at {tolerance:e}"
                );
            }
        }
    }
}

/// What the study of accuracy takes as true: order 8 in double-doubles with kinks located.
fn reference(duration: f64) -> Settings {
    Settings {
        method: Integrator::adaptive(Formula::Dop853, Tolerances::uniform(1e-17)),
        locate: true,
        duration,
        every: duration,
        ..Settings::of(<Kepler as Model<f64>>::INFO)
    }
}

#[test]
fn reference_solutions_are_those_of_closed_forms_to_1e_14() {
    let orbit = orbit_error::<DoubleDouble>(&reference(5.0 - 0.2 * 5.0f64.sin()));
    assert!(orbit < 1e-14, "{orbit:e}");

    let mut end = [0.0; 2];
    simulate::<DoubleDouble, _>(&Ball, &reference(3.0), &mut |sample| {
        end = [0, 1].map(|i| sample.state[i].to_f64());
    })
    .unwrap();
    let exact = ball();
    // velocities are up to 4.5 m/s, and the closed form itself is rounded
    let error = (end[0] - exact[0]).abs().max((end[1] - exact[1]).abs());
    assert!(error < 5.0 * 1e-14, "{error:e}");
}
