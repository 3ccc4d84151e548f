//! The responses of a study agree with those computed here, by their definitions, from the table of `bryant run` with
//! the same parameters.

use super::directory;
use super::folder::Table;
use crate::command_call::call;
use std::path::Path;

/// The default accuracy of studies.
const ACCURACY: f64 = 1e-3;
/// Time between samples of the study and of the table \[s\].
const EVERY: f64 = 1e-4;
/// Standard gravity \[m/s²\].
const GRAVITY: f64 = 9.806_65;

/// The table of a run with parameters, much more accurate than a study.
fn run(at: &Path, lap_slack: f64, friction: f64) -> Table {
    let set = [
        format!("lap_slack={lap_slack}"),
        format!("friction={friction}"),
    ];
    let mut arguments = vec![
        "run",
        "child-seat",
        "--duration",
        "60 ms",
        "--every",
        "0.1 ms",
    ];
    arguments.extend(["--accuracy", "1e-5", "--no-files", "--csv", "-"]);
    arguments.extend(["--set", &set[0], "--set", &set[1]]);
    Table::of(&call(at, &arguments, 0).0)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
}

/// max L (V/(g L))^2.5 over all windows of at most 15 ms that begin and end on samples.
fn hic15(samples: &[f64]) -> f64 {
    let mut velocity = vec![0.0];
    for pair in samples.windows(2) {
        velocity.push(velocity[velocity.len() - 1] + (pair[0] + pair[1]) / 2.0 * EVERY);
    }
    let mut most: f64 = 0.0;
    for start in 0..samples.len() {
        for end in (start + 1)..samples.len().min(start + 151) {
            let length = (end - start) as f64 * EVERY;
            let mean = (velocity[end] - velocity[start]) / length / GRAVITY;
            most = most.max(length * mean.max(0.0).powf(2.5));
        }
    }
    most
}

/// The time during which the samples, connected by straight lines, are above a level \[s\].
fn above(samples: &[f64], level: f64) -> f64 {
    let part = |pair: &[f64]| {
        let (low, high) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
        match (low > level, high > level) {
            (true, _) => 1.0,
            (false, false) => 0.0,
            (false, true) => (high - level) / (high - low),
        }
    };
    EVERY * samples.windows(2).map(part).sum::<f64>()
}

/// The largest level that is exceeded for 3 ms in total, by bisection.
fn clip(samples: &[f64]) -> f64 {
    let (mut low, mut high) = (0.0, largest(samples));
    for _ in 0..60 {
        let level = (low + high) / 2.0;
        match above(samples, level) > 3e-3 {
            true => low = level,
            false => high = level,
        }
    }
    low
}

#[track_caller]
fn near(found: f64, expected: f64, bound: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(
        error <= bound,
        "{what}: {found}, not {expected}: off by {error}, not {bound}"
    );
}

#[test]
fn responses_and_series_are_those_of_a_run() {
    let directory = directory();
    let at = directory.path();
    call(at, &["sweep", "seat.yaml", "--out", "results"], 0);
    let table = Table::read(&at.join("results/results.csv"));
    assert!(table.words("status").iter().all(|status| *status == "done"));
    let (slack, friction) = (table.numbers("lap_slack [m]"), table.numbers("friction"));
    for row in [0, 55, 117] {
        let run = run(at, slack[row], friction[row]);
        let (lap, head) = (
            run.numbers("lap belt force [N]"),
            run.numbers("head accelerometer [m/s^2]"),
        );
        let excursion = run.numbers("head excursion [m]");
        let is = |heading: &str, expected: f64, bound: f64| {
            let found = table.numbers(heading)[row];
            near(
                found,
                expected,
                bound * expected.abs(),
                &format!("{heading} of row {row}"),
            );
        };
        is("lap [N]", largest(&lap), ACCURACY);
        is("late [m]", excursion[500], ACCURACY);
        // HIC is a power 2.5 of the acceleration, whose accuracy is given
        is("injury", hic15(&head), 2.5 * ACCURACY);
        is("three [m/s^2]", clip(&head), ACCURACY);

        if row == 55 {
            continue;
        }
        let kept = Table::read(&at.join(format!("results/series/run-{row:08}.csv")));
        let times = kept.numbers("time [s]");
        assert_eq!(times.len(), 601);
        for (heading, expected) in [
            ("head excursion [m]", &excursion),
            ("lap belt force [N]", &lap),
        ] {
            let size = largest(&expected.iter().map(|x| x.abs()).collect::<Vec<_>>());
            let series = kept.numbers(heading);
            assert_eq!(series.len(), expected.len());
            for (k, (found, expected)) in series.iter().zip(expected).enumerate() {
                near(times[k], k as f64 * EVERY, 1e-12, "time");
                near(
                    *found,
                    *expected,
                    ACCURACY * size,
                    &format!("{heading} at {}", times[k]),
                );
            }
        }
    }
}

#[test]
fn errors_are_what_was_aimed_at_and_estimates_tell_of_them() {
    let directory = directory();
    let at = directory.path();
    let sharp = super::SEAT.replace("sampling: 0.1 ms", "sampling: 0.1 ms, accuracy: 1e-6");
    std::fs::write(at.join("sharp.yaml"), sharp).unwrap();
    call(at, &["sweep", "seat.yaml", "--out", "results"], 0);
    call(at, &["sweep", "sharp.yaml", "--out", "sharp"], 0);
    let results = Table::read(&at.join("results/results.csv"));
    let sharp = Table::read(&at.join("sharp/results.csv"));
    let estimates = results.numbers("error estimate");
    let mut errors = vec![0.0_f64; estimates.len()];
    for response in ["lap [N]", "injury", "three [m/s^2]", "late [m]"] {
        let pairs = results
            .numbers(response)
            .into_iter()
            .zip(sharp.numbers(response));
        for (error, (found, expected)) in errors.iter_mut().zip(pairs) {
            *error = error.max((found / expected - 1.0).abs());
        }
    }
    assert!(errors.iter().all(|error| *error < ACCURACY), "{errors:?}");
    // one run and its twin cannot guarantee more
    let told = errors
        .iter()
        .zip(&estimates)
        .filter(|(error, estimate)| error <= estimate);
    let told = told.count();
    assert!(2 * told > errors.len(), "{told} of {}", errors.len());
    assert!(
        estimates.iter().all(|estimate| *estimate < ACCURACY),
        "{estimates:?}"
    );
}
