//! What is read from a run between its samples.

use crate::models::Runaway;
use bryant_runtime::batch::rows::Asked;
use bryant_runtime::program::{Entry, Job, Start};
use bryant_runtime::program::{Kept, Reading};
use bryant_runtime::response::Channel;
use bryant_runtime::{Formula, Integrator, Response, Tolerances};
use std::ops::ControlFlow;

/// ẍ = −k (x + 1), where the curve of the force has a slope of k = 10⁻³ / 1.45, from 0 with 1 m/s: x and ẋ.
fn motion(t: f64) -> [f64; 2] {
    let w = (1e-3f64 / 1.45).sqrt();
    let (sin, cos) = (w * t).sin_cos();
    [cos + sin / w - 1.0, cos - w * sin]
}

/// Rows and answers.
fn run(job: &Job) -> (Vec<f64>, Vec<f64>) {
    let mut rows = Vec::new();
    let outcome = Entry::of::<Runaway>().run_balanced(job, &mut |t, state, _| {
        rows.extend([t].iter().chain(state));
        ControlFlow::Continue(())
    });
    outcome.result.unwrap();
    let answers = outcome.answers.iter().map(|answer| answer.value);
    (rows, answers.collect())
}

const END: f64 = 0.4;
const AT: f64 = 0.2137;

fn job(method: Integrator) -> Job {
    let asked = |response| Asked::of(0, response);
    Job {
        duration: Some(END),
        every: Some(0.1),
        method: Some(method),
        reading: Reading {
            intervals: 400,
            asked: vec![
                asked(Response::Peak),
                asked(Response::TimeOfPeak),
                asked(Response::Value { at: AT }),
                asked(Response::Excursion),
            ],
            kept: vec![Kept {
                channel: Channel::output(0),
                in_place_of: None,
            }],
            works_every: None,
        },
        ..Job::default()
    }
}

fn methods() -> [Integrator; 2] {
    [
        Integrator::adaptive(Formula::Dopri5, Tolerances::uniform(1e-10)),
        // a step that does not divide the time between two samples
        Integrator::fixed(Formula::Rk4, 0.013),
    ]
}

#[test]
fn responses_are_those_of_the_motion_and_leave_no_trace_in_it() {
    for method in methods() {
        let asked = job(method);
        let (rows, answers) = run(&asked);
        let [end, _] = motion(END);
        let expected = [end, END, motion(AT)[0], end];
        for (answer, expected) in answers.iter().zip(expected) {
            assert!((answer - expected).abs() < 1e-9, "{answers:?}");
        }
        assert_eq!(answers.len(), 4);
        let silent = Job {
            reading: Reading::default(),
            ..asked
        };
        assert_eq!(run(&silent), (rows, Vec::new()));
    }
}

#[test]
fn times_are_those_of_the_run_wherever_it_begins() {
    for method in methods() {
        let asked = Job {
            start: Some(Start {
                t: 0.15,
                state: motion(0.15).to_vec(),
            }),
            ..job(method)
        };
        let (_, answers) = run(&asked);
        let [end, _] = motion(END);
        let expected = [end, END, motion(AT)[0], end - motion(0.15)[0]];
        for (answer, expected) in answers.iter().zip(expected) {
            assert!((answer - expected).abs() < 1e-9, "{answers:?}");
        }
    }
}

#[test]
fn a_run_that_breaks_off_has_no_answers() {
    let job = Job {
        // beyond the end of the curve
        duration: Some(1.0),
        ..job(methods()[0])
    };
    let entry = Entry::of::<Runaway>();
    let outcome = entry.run_balanced(&job, &mut |_, _, _| ControlFlow::Continue(()));
    assert!(outcome.result.is_err() && outcome.answers.is_empty());
}
