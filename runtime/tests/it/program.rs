//! A run as the stand-alone program has it.

mod job;
mod reading;

use crate::models::{Oscillator, Runaway};
use bryant_runtime::program::{Entry, ErrorKind, Job, run, run_model_observed};
use bryant_runtime::{Compiled, Family, Model, ParameterSet, Section};
use std::ops::ControlFlow;
use std::time::Duration;

static TABLE: [Entry; 2] = [Entry::of::<Oscillator>(), Entry::of::<Runaway>()];

type Row = (f64, Vec<f64>, Vec<f64>);

fn rows_of(
    entry: &Entry,
    job: &Job,
) -> (
    Vec<Row>,
    Result<bryant_runtime::Report, bryant_runtime::program::RunError>,
) {
    let mut rows = Vec::new();
    let report = entry.run(job, &mut |t, y, o| {
        rows.push((t, y.to_vec(), o.to_vec()));
        ControlFlow::Continue(())
    });
    (rows, report)
}

#[test]
fn what_an_entry_runs_is_what_its_family_does() {
    let mut job = Job {
        every: Some(0.25),
        ..Job::default()
    };
    job.parameters.push(("stiffness".into(), 9.0));
    let (direct, report) = rows_of(&TABLE[0], &job);
    let mut rows = Vec::new();
    let family = Compiled::<Oscillator>::new();
    let mut writer = |t, y: &[f64], o: &[f64]| {
        rows.push((t, y.to_vec(), o.to_vec()));
        ControlFlow::Continue(())
    };
    let going_on = &mut |_| ControlFlow::Continue(());
    let outcome = run_model_observed(family.over(), &job, &mut writer, going_on);
    assert_eq!(rows, direct);
    assert_eq!(outcome.result.unwrap(), report.unwrap());
}

#[test]
fn a_failure_is_told_behind_the_samples_before_it() {
    let (rows, failure) = rows_of(&TABLE[1], &Job::default());
    assert_eq!(failure.unwrap_err().kind, ErrorKind::Run);
    assert!(!rows.is_empty());
}

#[test]
fn a_job_that_does_not_fit_is_refused() {
    let job = Job {
        parameters: vec![("stifness".into(), 1.0)],
        ..Job::default()
    };
    let (rows, result) = rows_of(&TABLE[0], &job);
    let error = result.unwrap_err();
    assert_eq!((rows.len(), error.kind), (0, ErrorKind::Job));
    assert!(error.message.contains("stifness") && error.message.contains("stiffness"));
}

#[test]
fn a_run_that_is_out_of_time_says_so() {
    let job = Job {
        duration: Some(1e6),
        every: Some(1e5),
        max_steps: Some(u64::MAX),
        time_limit: Some(Duration::from_millis(20)),
        ..Job::default()
    };
    let (rows, result) = rows_of(&TABLE[0], &job);
    let error = result.unwrap_err();
    assert_eq!(error.kind, ErrorKind::Time);
    assert!(error.t.is_some_and(|t| t < 1e6) && rows.len() < 11);
}

#[test]
fn an_observer_hears_between_samples_and_stops_a_run() {
    let job = Job {
        duration: Some(1e6),
        every: Some(1e6),
        max_steps: Some(u64::MAX),
        ..Job::default()
    };
    let (mut rows, mut heard) = (0, Vec::new());
    let outcome = run_model_observed(
        Compiled::<Oscillator>::new().over::<f64>(),
        &job,
        &mut |_, _, _| {
            rows += 1;
            ControlFlow::Continue(())
        },
        &mut |t| {
            heard.push(t);
            match heard.len() < 3 {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        },
    );
    let error = outcome.result.unwrap_err();
    assert_eq!((error.kind, rows, heard.len()), (ErrorKind::Stopped, 1, 3));
    assert!(heard.windows(2).all(|pair| pair[0] < pair[1]), "{heard:?}");
    assert_eq!(error.t, heard.last().copied());
}

#[test]
fn a_sink_that_breaks_off_ends_the_run() {
    let mut count = 0;
    let report = run::<f64, Oscillator>(&Job::default(), &mut |_, _, _| {
        count += 1;
        if count == 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })
    .unwrap();
    assert_eq!(report.samples, 3);
    assert!(report.t < Oscillator::INFO.duration);
}

#[test]
fn an_entry_evaluates_its_model() {
    let entry = &TABLE[0];
    let parameters = [("stiffness".to_string(), 4.0)];
    let mut rate = [0.0; 2];
    entry
        .derivative(&parameters, 0.0, &[0.5, 3.0], &mut rate)
        .unwrap();
    assert_eq!(rate, [3.0, -2.0]);
    let energy = entry.section(Section::Outputs, &parameters, 0.0, &[0.5, 3.0]);
    assert_eq!(energy.unwrap(), [5.0]);
    let powers = entry.section(Section::Powers, &parameters, 0.0, &[0.5, 3.0]);
    assert_eq!(powers.unwrap(), []);
    assert_eq!(entry.initial_state(&parameters).unwrap(), [1.0, 0.0]);
    assert!(
        entry
            .derivative(&parameters, 0.0, &[0.5], &mut rate)
            .is_err()
    );
    assert!(
        entry
            .derivative(&parameters, 0.0, &[0.5, 3.0], &mut rate[..1])
            .is_err()
    );
    assert_eq!(
        <Oscillator as Model<f64>>::Parameters::defaults().get(1),
        None
    );
}
