use bryant::accuracy::norm::StateError;
use bryant::accuracy::point::{Done, Measure, Own, Point, Status, Timing, orders};
use bryant::accuracy::setting::{Pace, Setting};
use bryant_runtime::Formula;
use bryant_runtime::Report;
use bryant_runtime::program::Scalar;
use bryant_runtime::simulate::Cause;

/// A run with this error in the state and in its only reading.
pub fn point(pace: Pace, error: f64, time: f64) -> Point {
    Point {
        setting: Setting {
            formula: Formula::Rk4,
            switches: false,
            pace,
            scalar: Scalar::F64,
            locate: true,
        },
        status: Status::Done(Box::new(Done {
            state: StateError {
                error,
                entry: "a.x".into(),
            },
            readings: vec![2.0 * error],
            energy: Some(error * 0.1),
            momentum: None,
            report: Report {
                t: 1.0,
                steps: 10,
                rejected: 1,
                evaluations: 40,
                jacobians: 0,
                stiff: 0,
                events: 2,
                samples: 11,
                largest_step: pace.value(),
                smallest_step: pace.value(),
                smallest_step_at: 0.0,
                smallest_step_for: Cause::First,
            },
            order: None,
            timing: Timing {
                median: time,
                late: 1.1 * time,
                repetitions: 5,
            },
        })),
    }
}

fn own() -> Own {
    Own {
        state: 1e-12,
        readings: vec![1e-10],
    }
}

#[test]
fn the_order_is_that_of_the_errors() {
    let errors = [(1e-2, 3e-1), (1e-3, 3e-5), (1e-4, 3e-9), (1e-5, 1e-13)];
    let points: Vec<Point> = errors
        .iter()
        .map(|(h, e)| point(Pace::Step(*h), *e, 1.0))
        .collect();
    let points: Vec<&Point> = points.iter().collect();
    let orders = orders(&points, &own());
    assert_eq!(orders[0], None);
    for order in &orders[1..3] {
        assert!((order.unwrap() - 4.0).abs() < 1e-12, "{orders:?}");
    }
    // The last error is below that of the reference.
    assert_eq!(orders[3], None);
}

#[test]
fn no_error_is_said_to_be_below_that_of_the_reference() {
    let point = point(Pace::Tolerance(1e-9), 1e-13, 1.0);
    let done = point.done().unwrap();
    let state = done.error(Measure::State, &own());
    assert_eq!((state.error, state.at_most), (1e-12, true));
    let reading = done.error(Measure::Worst, &own());
    assert_eq!((reading.error, reading.at_most), (1e-10, true));
}

#[test]
fn medians_and_percentiles_are_those_of_the_definition() {
    let timing = Timing::of(&[5.0, 1.0, 3.0, 2.0, 4.0]);
    assert_eq!((timing.median, timing.repetitions), (3.0, 5));
    assert!((timing.late - 4.8).abs() < 1e-15);
    assert_eq!(Timing::of(&[2.0]).late, 2.0);
}
