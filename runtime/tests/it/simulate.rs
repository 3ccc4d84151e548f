//! Runs against closed forms, orders of convergence, and every way to fail.

mod orders;
mod run;
mod watch;

use crate::models::{
    Chain, Counter, Explosion, Follower, Kepler, Ledge, Oscillator, PULSE, Pendulum, Ratchet,
    Runaway, Sled, Spin, Stage, Stiff, Undefined, Undetermined,
};
use crate::scalars::Pair;
use bryant_runtime::failure::{Culprit, Failure, Quantity, Reason};
use bryant_runtime::integrate::control::Tolerances;
use bryant_runtime::simulate::{
    Adaptive, Cause, Integrator, Pace, Report, Run, Sample, Settings, Watch, run_in, simulate,
    simulate_from, simulate_stiff, workspace_length,
};
use bryant_runtime::{Differentiable, Direct, Dual, Formula, Model};
use std::ops::ControlFlow;

type Rows = Vec<(f64, Vec<f64>)>;

fn rows<M: Model<f64>>(settings: &Settings) -> (Rows, Result<Report, Failure<'static>>)
where
    M::Parameters: bryant_runtime::ParameterSet<f64>,
{
    use bryant_runtime::ParameterSet;
    let model = M::new(M::Parameters::defaults());
    let mut rows = Vec::new();
    let report = simulate(&model, settings, &mut |sample| {
        rows.push((sample.t, sample.state.to_vec()));
    });
    (rows, report)
}

fn at_tolerance(relative: f64) -> Integrator {
    Integrator::adaptive(Formula::Dopri5, Tolerances::uniform(relative))
}

fn paced(adaptive: Adaptive) -> Integrator {
    Integrator {
        formula: Formula::Dopri5,
        pace: Pace::Adaptive(adaptive),
    }
}

fn of<M: Model<f64>>(method: Integrator) -> Settings {
    Settings {
        method,
        ..Settings::of(M::INFO)
    }
}

/// Largest error of x = cos t, v = −sin t over all samples.
fn oscillator_error(method: Integrator) -> f64 {
    let (rows, report) = rows::<Oscillator>(&of::<Oscillator>(method));
    report.unwrap();
    let errors = rows
        .iter()
        .map(|(t, y)| (y[0] - t.cos()).abs().max((y[1] + t.sin()).abs()));
    errors.fold(0.0, f64::max)
}

#[test]
fn error_goes_down_with_the_tolerance() {
    let mut before = f64::INFINITY;
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let error = oscillator_error(at_tolerance(tolerance));
        // two seconds take at most some ten steps' worth of tolerance
        assert!(error < 30.0 * tolerance, "{error:e} at {tolerance:e}");
        assert!(error < before / 10.0);
        before = error;
    }
}

#[test]
fn kepler_orbit_closes() {
    let settings = of::<Kepler>(at_tolerance(1e-11));
    let (rows, report) = rows::<Kepler>(&settings);
    let end = &rows.last().unwrap().1;
    let start = [0.5, 0.0, 0.0, 3.0_f64.sqrt()];
    for (y, y0) in end.iter().zip(start) {
        assert!((y - y0).abs() < 1e-8, "{end:?} {report:?}");
    }
}

#[test]
fn pendulum_follows_the_elliptic_functions() {
    // φ = 2 asin(k sn(K − ω₀t, k)), k = sin 45°
    let known = [
        (0.5, 0.401770849808083),
        (1.0, -1.4050273115248),
        (2.0, 0.916647589663245),
        (5.0, 1.22945181148539),
        (10.0, 0.278680673569983),
    ];
    let (rows, _) = rows::<Pendulum>(&Settings {
        every: 0.5,
        ..of::<Pendulum>(at_tolerance(1e-12))
    });
    for (t, angle) in known {
        let row = rows.iter().find(|row| row.0 == t).unwrap();
        assert!((row.1[0] - angle).abs() < 1e-9, "{row:?}");
    }
}

#[test]
fn pendulum_period_is_the_elliptic_integral() {
    // T = 4K(sin 45°)/ω₀ by the arithmetic-geometric mean: 2π/(ω₀ agm(1, cos 45°))
    let (mut a, mut g) = (1.0, 0.5_f64.sqrt());
    for _ in 0..6 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    let period = std::f64::consts::TAU / (9.81_f64.sqrt() * a);
    assert!((period - 2.3678419475762373).abs() < 1e-14);
    for method in [at_tolerance(1e-12), Integrator::fixed(Formula::Rk4, 1e-3)] {
        let settings = Settings {
            duration: period,
            every: period,
            ..of::<Pendulum>(method)
        };
        let (rows, _) = rows::<Pendulum>(&settings);
        let end = &rows[1].1;
        assert!(
            (end[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-9,
            "{end:?}"
        );
        assert!(end[1].abs() < 1e-8, "{end:?}");
    }
}

#[test]
fn samples_come_at_multiples_and_at_the_end() {
    for method in [Integrator::default(), Integrator::fixed(Formula::Rk4, 0.03)] {
        let settings = Settings {
            duration: 1.0,
            every: 0.3,
            ..of::<Oscillator>(method)
        };
        let (rows, report) = rows::<Oscillator>(&settings);
        let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
        assert_eq!(times, [0.0, 0.3, 2.0 * 0.3, 3.0 * 0.3, 1.0]);
        assert_eq!(report.unwrap().samples, 5);

        let settings = Settings {
            duration: 0.7,
            every: 0.1,
            ..settings
        };
        let (rows, _) = self::rows::<Oscillator>(&settings);
        assert_eq!(rows.len(), 8);
        assert_eq!(rows[7].0, 0.7);

        let settings = Settings {
            duration: 0.7,
            every: 5.0,
            ..settings
        };
        let (rows, _) = self::rows::<Oscillator>(&settings);
        assert_eq!(rows.len(), 2);
    }
}

#[test]
fn kinks_cost_no_accuracy() {
    // x is a cubic between the kinks, v a parabola: both methods are exact if no step crosses one
    let exact = |t: f64| match t {
        t if t < 0.1 => (0.0, 0.0),
        t if t < 0.2 => (330.0 * (t - 0.1).powi(3), 990.0 * (t - 0.1).powi(2)),
        t => (
            0.33 + 9.9 * (t - 0.2) + 99.0 * (t - 0.2).powi(2),
            9.9 + 198.0 * (t - 0.2),
        ),
    };
    for method in [Integrator::default(), Integrator::fixed(Formula::Rk4, 0.07)] {
        let (rows, report) = rows::<Sled>(&Settings {
            every: 0.03,
            ..of::<Sled>(method)
        });
        for (t, y) in &rows {
            let (x, v) = exact(*t);
            assert!(
                (y[0] - x).abs() < 1e-13 && (y[1] - v).abs() < 1e-12,
                "{t} {y:?}"
            );
        }
        assert_eq!(report.unwrap().rejected, 0);
    }
}

#[test]
fn a_jump_of_the_derivative_at_a_kink_is_seen_from_both_sides() {
    for method in [Integrator::default(), Integrator::fixed(Formula::Rk4, 0.07)] {
        let (rows, _) = rows::<Follower>(&of::<Follower>(method));
        for (t, y) in rows {
            assert!((y[0] - PULSE.value(t)).abs() < 1e-12, "{t} {y:?}");
        }
    }
}

#[test]
fn quaternions_stay_units() {
    for method in [Integrator::default(), Integrator::fixed(Formula::Rk4, 0.05)] {
        let (rows, _) = rows::<Spin>(&Settings {
            every: 0.37,
            ..of::<Spin>(method)
        });
        for (t, q) in rows {
            let norm: f64 = q.iter().map(|x| x * x).sum();
            assert!((norm - 1.0).abs() < 4.0 * f64::EPSILON);
            // 100 rad at 10⁻⁶ per step
            assert!((q[0] - t.cos()).abs() < 2e-4, "{t} {q:?}");
        }
    }
}

#[test]
fn a_state_already_on_its_manifold_costs_no_evaluation() {
    let (_, report) = rows::<Pendulum>(&of::<Pendulum>(Integrator::default()));
    let report = report.unwrap();
    // one at the start, one for the first step, six a step
    assert_eq!(report.evaluations, 2 + 6 * (report.steps + report.rejected));
    assert!(report.smallest_step <= report.largest_step);
}

#[test]
fn stiffness_is_survived_without_many_rejections() {
    let (rows, report) = rows::<Stiff>(&of::<Stiff>(Integrator::default()));
    let report = report.unwrap();
    for (t, y) in rows {
        // x lags behind cos t by 10⁻⁵ sin t
        assert!((y[0] - t.cos() - 1e-5 * t.sin()).abs() < 1e-5, "{t} {y:?}");
    }
    // the interval of stability is 3.3: at least 10⁵/3.3 steps, and no controller gets by with exactly these
    assert!((30_000..45_000).contains(&report.steps), "{report:?}");
    assert!(report.rejected < report.steps / 10, "{report:?}");
}

#[test]
fn lanes_equal_scalar() {
    let settings = Settings {
        every: 0.5,
        duration: 2.0,
        ..of::<Pendulum>(at_tolerance(1e-10))
    };
    let (scalar, _) = rows::<Pendulum>(&settings);
    let mut both = Vec::new();
    simulate::<Pair, _>(&Pendulum, &settings, &mut |sample| {
        both.push([sample.state[0], sample.state[1]]);
    })
    .unwrap();
    for (row, pair) in scalar.iter().zip(both) {
        assert_eq!(pair.map(|x| x.0), [[row.1[0]; 2], [row.1[1]; 2]]);
    }
}

#[test]
fn f32_runs_to_its_own_digits() {
    let settings = Settings {
        every: 0.5,
        duration: 2.0,
        ..of::<Pendulum>(at_tolerance(1e-5))
    };
    let mut angles = Vec::new();
    simulate::<f32, _>(&Pendulum, &settings, &mut |s| angles.push(s.state[0])).unwrap();
    assert!(
        (f64::from(angles[4]) - 0.916647589663245).abs() < 1e-3,
        "{angles:?}"
    );
}

#[test]
fn dual_numbers_carry_the_derivative_of_a_run() {
    // ∂φ(t)/∂φ(0) by a dual number and by a central difference
    let settings = Settings {
        every: 1.0,
        duration: 1.0,
        ..of::<Pendulum>(at_tolerance(1e-12))
    };
    let from = |angle: f64, slope: f64| {
        let start = [
            Dual {
                value: angle,
                slope,
            },
            Dual::constant(0.0),
        ];
        let mut end = start;
        simulate_from::<Dual<f64>, _>(&Pendulum, start, &settings, &mut |sample| {
            end.copy_from_slice(sample.state);
            ControlFlow::Continue(())
        })
        .unwrap();
        end[0]
    };
    let exact = from(1.0, 1.0).slope;
    let difference = (from(1.001, 0.0).value - from(0.999, 0.0).value) / 0.002;
    assert!((exact - difference).abs() < 1e-4, "{exact} {difference}");
}

#[test]
fn leaving_a_curve_names_the_force_and_the_time() {
    // the spring hardly brakes: x = t to 10⁻³, the curve ends at 0.45
    for (method, late) in [
        (Integrator::default(), 1e-3),
        (Integrator::fixed(Formula::Rk4, 0.001), 2e-3),
    ] {
        let (rows, report) = rows::<Runaway>(&of::<Runaway>(method));
        let failure = report.unwrap_err();
        assert_eq!(rows.len(), 5, "0, 0.1 … 0.4");
        assert!((failure.t - 0.45).abs() < late, "{failure:?}");
        let Reason::NonFinite {
            index: 1,
            of: Quantity::Derivative,
            output: Some(1),
            culprit: Culprit::Curve { curve: 0, argument },
        } = failure.reason
        else {
            panic!("{failure}");
        };
        assert!((0.45..0.45 + 0.1).contains(&argument), "{argument}");
        let text = failure.to_string();
        assert!(
            text.contains("velocity \"mass.x\"") && text.contains("\"spring force\""),
            "{text}"
        );
        assert!(
            text.contains(
                "the argument of the curve \"spring: curve\" exceeds the last point (0.450 m) by "
            ),
            "{text}"
        );
    }
}

#[test]
fn an_explosion_ends_in_a_failure_at_its_time() {
    let (rows, report) = rows::<Explosion>(&of::<Explosion>(Integrator::default()));
    let failure = report.unwrap_err();
    assert!((failure.t - 1.0).abs() < 1e-3, "{failure:?}");
    assert!(matches!(
        failure.reason,
        Reason::StepTooSmall { index: 0, .. } | Reason::NonFinite { index: 0, .. }
    ));
    assert!((9..=11).contains(&rows.len()), "{rows:?}");
    assert!(failure.to_string().contains("coordinate \"x\""));

    let (_, report) =
        self::rows::<Explosion>(&of::<Explosion>(Integrator::fixed(Formula::Rk4, 0.01)));
    let failure = report.unwrap_err();
    assert!(matches!(failure.reason, Reason::NonFinite { index: 0, .. }));
}

#[test]
fn a_start_that_is_no_number_is_refused() {
    for method in [Integrator::default(), Integrator::fixed(Formula::Rk4, 0.01)] {
        let (rows, report) = rows::<Undefined>(&of::<Undefined>(method));
        let of = Quantity::InitialState;
        let reason = Reason::NonFinite {
            index: 1,
            of,
            output: None,
            culprit: Culprit::Unknown,
        };
        assert_eq!(report.unwrap_err().reason, reason);
        assert!(rows.is_empty());

        let (rows, report) = self::rows::<Undetermined>(&self::of::<Undetermined>(method));
        let of = Quantity::Derivative;
        let reason = Reason::NonFinite {
            index: 1,
            of,
            output: None,
            culprit: Culprit::Unknown,
        };
        assert_eq!(report.unwrap_err().reason, reason);
        assert!(rows.is_empty());
    }
}

#[test]
fn too_many_steps_end_a_run() {
    for method in [at_tolerance(1e-10), Integrator::fixed(Formula::Rk4, 1e-300)] {
        let settings = Settings {
            max_steps: 10,
            ..of::<Oscillator>(method)
        };
        let failure = rows::<Oscillator>(&settings).1.unwrap_err();
        let Reason::TooManySteps {
            limit: 10,
            cause,
            step,
        } = failure.reason
        else {
            panic!("{failure}");
        };
        let text = failure.to_string();
        match method.pace {
            Pace::Fixed(fixed) => {
                assert_eq!((cause, step), (Cause::Fixed, fixed));
                assert!(text.contains("the step is 1e-300 s"), "{text}");
            }
            Pace::Adaptive(_) => {
                assert!(matches!(cause, Cause::Tolerance(_)), "{cause:?}");
                assert!(0.0 < step && step < 0.2, "{step}");
                assert!(text.contains("\"mass.x\" keeps steps at"), "{text}");
                assert_eq!(failure.coordinate(), Some("mass.x"));
            }
        }
    }
}

#[test]
fn a_tolerance_below_rounding_is_a_step_too_small() {
    let settings = Settings {
        max_steps: 1_000_000,
        ..of::<Oscillator>(at_tolerance(1e-300))
    };
    let failure = rows::<Oscillator>(&settings).1.unwrap_err();
    assert!(
        matches!(failure.reason, Reason::StepTooSmall { .. }),
        "{failure}"
    );
}

#[test]
fn a_first_step_of_nothing_still_gets_there() {
    let adaptive = Adaptive {
        first_step: Some(1e-300),
        ..Adaptive::default()
    };
    let (_, report) = rows::<Oscillator>(&of::<Oscillator>(paced(adaptive)));
    assert!(report.unwrap().steps < 100);
}

#[test]
fn settings_without_sense_are_refused() {
    let good = of::<Oscillator>(Integrator::default());
    let adaptive = |change: fn(&mut Adaptive)| {
        let mut adaptive = Adaptive::default();
        change(&mut adaptive);
        Settings {
            method: paced(adaptive),
            ..good
        }
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let all = [
            (
                Settings {
                    duration: bad,
                    ..good
                },
                "duration",
            ),
            (Settings { every: bad, ..good }, "every"),
            (
                Settings {
                    method: Integrator::fixed(Formula::Rk4, bad),
                    ..good
                },
                "step",
            ),
            (of::<Oscillator>(at_tolerance(bad)), "relative tolerance"),
        ];
        for (settings, expected) in all {
            let (rows, report) = rows::<Oscillator>(&settings);
            let failure = report.unwrap_err();
            let Reason::InvalidSettings(setting) = failure.reason else {
                panic!("{failure}")
            };
            assert_eq!(setting.name, expected);
            assert!(failure.to_string().contains("must be positive and finite"));
            assert!(rows.is_empty());
        }
    }
    for settings in [
        Settings {
            every: 1e-300,
            ..good
        },
        Settings {
            max_steps: 0,
            ..good
        },
        adaptive(|a| a.tolerances.positions = 0.0),
        adaptive(|a| a.tolerances.velocities = f64::NAN),
        adaptive(|a| a.tolerances.angles = 1.0),
        adaptive(|a| a.smallest_step = 0.0),
        adaptive(|a| a.largest_step = f64::NAN),
        adaptive(|a| a.largest_step = 1e-20),
        adaptive(|a| a.first_step = Some(-1.0)),
    ] {
        let failure = rows::<Oscillator>(&settings).1.unwrap_err();
        assert!(
            matches!(failure.reason, Reason::InvalidSettings(_)),
            "{failure}"
        );
    }
}

#[test]
fn a_tolerance_that_lets_all_of_a_value_be_wrong_is_refused() {
    for relative in [1.0, 2.0, 1e300] {
        let method = Integrator::adaptive(Formula::Dopri5, Tolerances::of(relative));
        let (rows, report) = rows::<Oscillator>(&of::<Oscillator>(method));
        let failure = report.unwrap_err();
        let Reason::InvalidSettings(setting) = failure.reason else {
            panic!("{failure}")
        };
        assert_eq!(setting.name, "relative tolerance");
        let text = failure.to_string();
        assert!(
            text.contains("must be below 1") && text.contains("1e-3"),
            "{text}"
        );
        assert!(rows.is_empty());
    }
    // coarse, but a tolerance; and a length or a speed has no size that is everything
    let coarse = Adaptive {
        tolerances: Tolerances {
            positions: 5.0,
            velocities: 5.0,
            ..Tolerances::of(0.5)
        },
        ..Adaptive::default()
    };
    let (_, report) = rows::<Oscillator>(&of::<Oscillator>(paced(coarse)));
    assert!(report.is_ok());
}

#[test]
fn default_settings_are_the_defaults_of_their_parts() {
    assert_eq!(Settings::of(Oscillator::INFO).method, Integrator::default());
}

#[test]
fn steps_end_at_events_and_memory_changes_between_steps() {
    let tolerance = 1e-10;
    let settings = Settings {
        method: at_tolerance(tolerance),
        ..Settings::of(<Ratchet as Model<f64>>::INFO)
    };
    let (rows, report) = rows::<Ratchet>(&settings);
    let report = report.unwrap();
    // π, 2π and 3π lie before 10
    assert_eq!(report.events, 3);
    for (t, y) in &rows {
        // errors grow by no more than a turn of the phase: steps × tolerance, twice for position and velocity
        let allowed = 2.0 * report.steps as f64 * tolerance;
        let turned = *t > std::f64::consts::PI;
        if turned {
            // the turning point itself ended a step: elsewhere the largest x would miss 1 by (step)²/2
            assert!((y[2] - 1.0).abs() < allowed, "{t}: {}", y[2]);
        } else {
            // what was reached before this sample, by a step's end
            assert!(y[2] <= -t.cos() + allowed);
        }
    }
    // without a sample in between, the memory is that of steps alone
    assert_eq!(rows[0].1[2], -1.0, "renewed before the first step");
}

#[test]
fn the_first_of_several_lanes_ends_the_step_for_all() {
    let model = <Ratchet as Model<Pair>>::new(crate::models::None);
    let mut initial = Model::<Pair>::initial_state(&model);
    // the second lane starts half a turn ahead
    initial[0] = Pair([-1.0, 1.0]);
    initial[1] = Pair([0.0, 1e-9]);
    let settings = Settings {
        method: at_tolerance(1e-10),
        duration: 4.0,
        ..Settings::of(<Ratchet as Model<Pair>>::INFO)
    };
    let mut last = initial;
    let report = simulate_from::<Pair, _>(&model, initial, &settings, &mut |sample| {
        last.copy_from_slice(sample.state);
        ControlFlow::Continue(())
    })
    .unwrap();
    // the second lane turns at 1e-9 and again, as the first, at π; both within rounding of one another or apart
    assert!((2..=3).contains(&report.events), "{}", report.events);
    assert!((last[2].0[0] - 1.0).abs() < 1e-8 && (last[2].0[1] - 1.0).abs() < 1e-8);
}

#[test]
fn rejected_steps_do_not_touch_memory() {
    for method in [at_tolerance(1e-8), Integrator::fixed(Formula::Rk4, 0.01)] {
        let settings = Settings {
            method,
            ..Settings::of(<Counter as Model<f64>>::INFO)
        };
        let (rows, report) = rows::<Counter>(&settings);
        let report = report.unwrap();
        let adaptive = matches!(method.pace, Pace::Adaptive(_));
        assert_eq!(report.rejected > 0, adaptive);
        // once at the start and once a step, less the last, whose sample is shown before
        let (_, last) = rows.last().unwrap();
        assert_eq!(last[2], report.steps as f64);
    }
}

/// An event function that jumps where a run stands would cut every step down to nothing, for ever: after a while one
/// goes on.
#[test]
fn a_event_function_that_jumps_where_a_run_stands_does_not_stop_it() {
    // of a long step an event is known less well than a time is
    let fixed = |step| Integrator::fixed(Formula::Rk4, step);
    for method in [at_tolerance(1e-8), fixed(0.01), fixed(0.5)] {
        let settings = Settings {
            method,
            max_steps: 100_000,
            ..Settings::of(<Ledge as Model<f64>>::INFO)
        };
        let (rows, report) = rows::<Ledge>(&settings);
        let report = report.unwrap();
        assert!(report.events >= 100, "{report:?}");
        let (t, last) = rows.last().unwrap();
        assert!(*t == 10.0 && (last[0] - 10.0).abs() < 1e-9, "{last:?}");
    }
}

#[test]
fn what_a_switch_makes_fire_fires_in_the_same_instant() {
    for method in [at_tolerance(1e-8), Integrator::fixed(Formula::Rk4, 0.3)] {
        let settings = Settings {
            method,
            ..Settings::of(<Chain as Model<f64>>::INFO)
        };
        let (rows, report) = rows::<Chain>(&settings);
        let (_, last) = rows.last().unwrap();
        // located to 1e-13 of a step, of fixed steps too
        assert!((last[2] - 1.0).abs() <= 2e-13, "{last:?}");
        assert_eq!([last[3], last[4]], [last[2]; 2]);
        assert_eq!(report.unwrap().events, 1);
    }
}

const STAGE: &bryant_runtime::Info = <Stage as Model<f64>>::INFO;

/// Every number of a run in bits, by one method in this memory.
fn bits(
    formula: Formula,
    memory: &mut [f64],
    watch: &mut Watch<'_, f64>,
) -> (Vec<u64>, Report, [f64; 2]) {
    let settings = Settings {
        method: Integrator::fixed(formula, 0.01),
        duration: 1.0,
        ..Settings::of(STAGE)
    };
    let model = Stage;
    let start = Model::<f64>::initial_state(&model);
    let mut all = Vec::new();
    let sink = &mut |sample: Sample<'_, f64>| {
        let numbers = sample.state.iter().chain(sample.outputs);
        all.extend(numbers.map(|number| number.to_bits()));
        ControlFlow::Continue(())
    };
    let length = workspace_length(STAGE, &settings);
    let model = Differentiable(&model);
    let memory = &mut memory[..length];
    let report = run_in(memory, &model, &start, &settings, Some(watch), sink).unwrap();
    (all, report, [watch.balance.gap(), watch.balance.exchanged])
}

#[test]
fn what_memory_holds_before_does_not_matter() {
    for formula in Formula::ALL {
        let mut clean = Watch::new(STAGE, 0.02);
        let expected = bits(formula, &mut [0.0; 200], &mut clean);
        let mut memory = [f64::NAN; 200];
        let (of_watch, of_run) = memory.split_at_mut(Watch::<f64>::length(STAGE));
        let mut watch = Watch::within(STAGE, 0.02, of_watch);
        assert_eq!(bits(formula, of_run, &mut watch), expected, "{formula}");
        assert!(!expected.0.is_empty());
    }
}

/// A run asserts that it needs all of its workspace; it panics if it needs more.
#[test]
fn a_workspace_is_as_long_as_it_is_said_to_be() {
    fn check<M: Model<f64>>() {
        for formula in Formula::ALL {
            let mut methods = vec![Integrator::fixed(formula, 0.01)];
            if formula.estimates_error() {
                methods.push(Integrator::switching(formula, Tolerances::default()));
            }
            for method in methods {
                let settings = of::<M>(method);
                let model = M::new(bryant_runtime::ParameterSet::defaults());
                let mut memory = vec![0.0; workspace_length(M::INFO, &settings)];
                let (model, start) = (Differentiable(&model), model.initial_state());
                Run::new(&mut memory, &model, start.as_ref(), &settings, None)
                    .unwrap_or_else(|failure| panic!("{} by {formula}: {failure}", M::INFO.name));
            }
        }
    }
    check::<Oscillator>();
    check::<Runaway>();
    check::<Chain>();
    check::<Counter>();
    check::<Stage>();
}

#[test]
#[should_panic(expected = "the workspace is too short for a run of Pendulum")]
fn a_workspace_that_is_too_short_is_refused() {
    let settings = of::<Pendulum>(Integrator::default());
    let mut memory = vec![0.0; workspace_length(<Pendulum as Model<f64>>::INFO, &settings) - 1];
    let start = Model::<f64>::initial_state(&Pendulum);
    let sink = &mut |_: Sample<'_, f64>| ControlFlow::Continue(());
    let _ = run_in(
        &mut memory,
        &Direct(&Pendulum),
        &start,
        &settings,
        None,
        sink,
    );
}

#[test]
fn a_method_that_needs_a_jacobian_says_so_where_there_is_none() {
    let settings = of::<Pendulum>(Integrator::fixed(Formula::Rodas5, 0.01));
    let failure = simulate::<f64, _>(&Pendulum, &settings, &mut |_| {}).unwrap_err();
    let formula = Formula::Rodas5;
    assert_eq!(failure.reason, Reason::NoJacobian { formula });
    let text = failure.to_string();
    assert!(
        text.contains("the method rodas5 needs the Jacobian") && text.contains("simulate_stiff"),
        "{text}"
    );
    let report = simulate_stiff::<f64, _>(&Pendulum, &settings, &mut |_| {}).unwrap();
    assert_eq!(report.jacobians, report.steps);
}
