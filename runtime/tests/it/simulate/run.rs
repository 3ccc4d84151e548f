//! Runs that are left and resumed have the bits of runs that are not; runs that begin later go on where others ended.

use crate::models::{
    Chain, Counter, Explosion, Follower, Kepler, Oscillator, Ratchet, Sled, Spin, Stage,
};
use bryant_runtime::failure::Reason;
use bryant_runtime::simulate::Run;
use bryant_runtime::simulate::{
    Integrator, Report, Sample, Settings, Watch, run_in, workspace_length,
};
use bryant_runtime::{Differentiable, Dynamics, Formula, Model, ParameterSet, Real, Tolerances};
use std::ops::ControlFlow;

/// Time, state and outputs of a sample, in bits.
fn bits(sample: Sample<'_, f64>) -> Vec<u64> {
    let numbers = std::iter::once(&sample.t)
        .chain(sample.state)
        .chain(sample.outputs);
    numbers.map(|number| number.to_bits()).collect()
}

/// All samples of one run, what it took, and what is missing in its balance.
fn whole(
    model: &dyn Dynamics<f64>,
    start: &[f64],
    settings: &Settings,
) -> (Vec<Vec<u64>>, Report, u64) {
    let mut memory = vec![0.0; workspace_length(model.info(), settings)];
    let mut watch = Watch::new(model.info(), 0.02);
    let mut samples = Vec::new();
    let report = run_in(
        &mut memory,
        model,
        start,
        settings,
        Some(&mut watch),
        &mut |sample| {
            samples.push(bits(sample));
            ControlFlow::Continue(())
        },
    );
    (samples, report.unwrap(), watch.balance.gap().to_bits())
}

/// The same by a run that is asked for one sample after the other, and for each as often; and for one between two of
/// them where `between`.
fn piecewise(
    (model, start): (&dyn Dynamics<f64>, &[f64]),
    settings: &Settings,
    times: &[u64],
    often: usize,
    between: bool,
) -> (Vec<Vec<u64>>, Report, u64) {
    let mut memory = vec![f64::NAN; workspace_length(model.info(), settings)];
    let mut watch = Watch::new(model.info(), 0.02);
    let mut run = Run::new(&mut memory, model, start, settings, Some(&mut watch)).unwrap();
    let mut samples = Vec::new();
    let mut before = settings.start;
    for t in times.iter().map(|t| f64::from_bits(*t)) {
        if between {
            run.advance_to(before + 0.37 * (t - before)).unwrap();
        }
        for _ in 1..often {
            run.advance_to(t).unwrap();
        }
        samples.push(bits(run.advance_to(t).unwrap()));
        before = t;
    }
    // the end of the last step, as one run has it
    let report = run.report();
    f64::march(&mut run, &mut |_| ControlFlow::Continue(()), None).unwrap();
    (samples, report, watch.balance.gap().to_bits())
}

fn check<M: Model<f64>>()
where
    M::Parameters: ParameterSet<f64>,
{
    let model = M::new(ParameterSet::<f64>::defaults());
    check_from(&Differentiable(&model), model.initial_state().as_ref());
}

fn check_from(model: &dyn Dynamics<f64>, start: &[f64]) {
    let info = model.info();
    let name = info.name;
    for formula in Formula::ALL {
        for (locate, every) in [(false, 0.083), (true, 0.0101)] {
            let at = |method| Settings {
                method,
                locate,
                every: every * info.duration,
                ..Settings::of(info)
            };
            let mut methods = vec![Integrator::fixed(formula, 0.003 * info.duration)];
            if formula.estimates_error() {
                methods.push(Integrator::adaptive(formula, Tolerances::uniform(1e-6)));
            }
            for method in methods {
                let settings = at(method);
                let (samples, report, gap) = whole(model, start, &settings);
                let times: Vec<u64> = samples.iter().map(|sample| sample[0]).collect();
                let once = piecewise((model, start), &settings, &times, 1, false);
                assert!(samples.len() > 12, "{name}");
                assert_eq!(once, (samples.clone(), report, gap), "{name} by {method:?}");
                let (again, _, same) = piecewise((model, start), &settings, &times, 3, false);
                assert_eq!(
                    (again, same),
                    (samples.clone(), gap),
                    "{name} by {method:?}"
                );
                // steps under control of their error do not end at samples
                if matches!(method.pace, bryant_runtime::simulate::Pace::Adaptive(_)) {
                    let (more, _, same) = piecewise((model, start), &settings, &times, 1, true);
                    assert_eq!((more, same), (samples, gap), "{name} by {method:?}");
                }
            }
        }
    }
}

#[test]
fn a_run_in_pieces_has_the_bits_of_one_in_one_piece() {
    check::<Oscillator>();
    check::<Sled>();
    check::<Follower>();
    check::<Kepler>();
    check::<Spin>();
    check::<Ratchet>();
    check::<Counter>();
    check::<Chain>();
    check::<Stage>();
}

#[test]
fn times_before_now_or_after_the_end_are_refused() {
    let settings = Settings::of(<Oscillator as Model<f64>>::INFO);
    let model = <Oscillator as Model<f64>>::new(ParameterSet::<f64>::defaults());
    let dynamics = Differentiable(&model);
    let mut memory = vec![0.0; workspace_length(<Oscillator as Model<f64>>::INFO, &settings)];
    let start = model.initial_state();
    let mut run = Run::new(&mut memory, &dynamics, start.as_ref(), &settings, None).unwrap();
    let half = 0.5 * settings.duration;
    let expected = bits(run.advance_to(half).unwrap());
    for wrong in [
        half.next_down(),
        settings.duration.next_up(),
        -1.0,
        f64::NAN,
        f64::INFINITY,
    ] {
        let failure = run.advance_to(wrong).expect_err("refused");
        let Reason::InvalidSettings(setting) = failure.reason else {
            panic!("{failure}");
        };
        assert_eq!(setting.name, "time to advance to");
        assert_eq!(setting.value.to_bits(), wrong.to_bits());
    }
    assert_eq!(bits(run.advance_to(half).unwrap()), expected);
    run.advance_to(settings.duration).unwrap();
}

#[test]
fn a_run_that_failed_says_so_again() {
    let settings = Settings::of(<Explosion as Model<f64>>::INFO);
    let model = <Explosion as Model<f64>>::new(ParameterSet::<f64>::defaults());
    let dynamics = Differentiable(&model);
    let mut memory = vec![0.0; workspace_length(<Explosion as Model<f64>>::INFO, &settings)];
    let start = model.initial_state();
    let mut run = Run::new(&mut memory, &dynamics, start.as_ref(), &settings, None).unwrap();
    let first = run.advance_to(settings.duration).expect_err("it explodes");
    let again = run.advance_to(settings.duration).expect_err("still");
    assert_eq!(first.reason, again.reason);
    assert_eq!(first.t, again.t);
}

/// The largest difference between one run of the sled and one in two halves that meet at this time, by a method.
fn halves(method: Integrator, at: f64) -> (f64, Vec<f64>) {
    let info = <Follower as Model<f64>>::INFO;
    let settings = Settings {
        method,
        ..Settings::of(info)
    };
    let model = <Follower as Model<f64>>::new(ParameterSet::<f64>::defaults());
    let dynamics = Differentiable(&model);
    let run = |settings: &Settings, start: &[f64]| {
        let mut memory = vec![0.0; workspace_length(info, settings)];
        let mut rows = Vec::new();
        let sink = &mut |sample: Sample<'_, f64>| {
            rows.push((sample.t, sample.state.to_vec()));
            ControlFlow::Continue(())
        };
        run_in(&mut memory, &dynamics, start, settings, None, sink).unwrap();
        rows
    };
    let start = model.initial_state();
    let whole = run(&settings, start.as_ref());
    let first = run(
        &Settings {
            duration: at,
            ..settings
        },
        start.as_ref(),
    );
    let (end, state) = first.last().unwrap();
    assert_eq!(*end, at);
    let second = run(
        &Settings {
            start: at,
            ..settings
        },
        state,
    );
    assert_eq!(second[0], (at, state.clone()));
    let mut worst = 0.0f64;
    for (t, state) in &second[1..] {
        // at the very same times as in one run
        let (_, expected) = whole.iter().find(|(time, _)| time == t).expect("a sample");
        for (a, b) in state.iter().zip(expected) {
            worst = worst.max((a - b).abs());
        }
    }
    (worst, second.iter().map(|(t, _)| *t).collect())
}

#[test]
fn a_run_that_begins_later_meets_all_later_kinks() {
    // the pulse has its kinks before and behind; where steps end on them, Runge-Kutta 4 integrates its straight lines
    // exactly
    let kinks = <Follower as Model<f64>>::INFO.breakpoints;
    let end = kinks[kinks.len() - 1];
    let duration = <Follower as Model<f64>>::INFO.duration;
    for share in [0.11, 0.5, 0.73] {
        let at = share * end.min(duration);
        for method in [
            Integrator::fixed(Formula::Rk4, 1e-3 * duration),
            Integrator::adaptive(Formula::Dop853, Tolerances::uniform(1e-12)),
        ] {
            let (worst, times) = halves(method, at);
            assert!(worst <= 1e-10, "{worst} by {method:?} from {at}");
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
        }
    }
}

#[test]
fn a_start_outside_of_the_run_is_refused() {
    let info = <Oscillator as Model<f64>>::INFO;
    for start in [-1e-3, info.duration, 2.0 * info.duration, f64::NAN] {
        let settings = Settings {
            start,
            ..Settings::of(info)
        };
        let model = <Oscillator as Model<f64>>::new(ParameterSet::<f64>::defaults());
        let mut memory = vec![0.0; workspace_length(info, &settings)];
        let (dynamics, initial) = (Differentiable(&model), model.initial_state());
        let refused = Run::new(&mut memory, &dynamics, initial.as_ref(), &settings, None);
        let Err(bryant_runtime::Failure {
            reason: Reason::InvalidSettings(setting),
            ..
        }) = refused.map(|_| ())
        else {
            panic!("accepted {start}");
        };
        assert_eq!(setting.name, "start");
    }
}
