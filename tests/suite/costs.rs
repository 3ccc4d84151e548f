//! What further digits cost in time: `bryant accuracy`.

use super::command_call::call;
use super::{directory, json};

/// Arguments for a study of the clock: few points, one repetition, and so much time that a pause of a busy machine does
/// not make a point look too slow to run.
const STUDY: [&str; 15] = [
    "accuracy",
    "clock.yaml",
    "--quick",
    "--methods",
    "rk4,dop853",
    "--tolerances",
    "1e-2..1e-10",
    "--steps",
    "10 ms..1 ms",
    "--repetitions",
    "1",
    "--budget",
    "1 h",
    "--no-files",
    "--json",
];

/// The best lines of a diagram and its legend, as far as they do not depend on times: which variant of a method is the
/// best one, and so how many points its line has, does.
fn structure(svg: &str) -> Vec<String> {
    let line = |line: &str| {
        Some(
            line.strip_prefix("<polyline class=\"line")?
                .split_once('"')?
                .0
                .to_owned(),
        )
    };
    let mut parts: Vec<String> = svg.lines().filter_map(line).collect();
    // lines of other variants come in another order
    parts.sort();
    // the legend has a column of its own, to the right of the frame
    let legend = svg.lines().filter(|line| line.contains(" x=\"748\" "));
    let method = |line: &str| Some(line.split_once('>')?.1.split(", ").next()?.to_owned());
    parts.extend(legend.filter_map(method));
    parts
}

/// θ̈ = −κ sin θ swings at ω = √κ, κ = m g l/J = 2·9.81·0.5/0.6: a step that errs by the tolerance changes the end of a
/// run of T = 1 s by at most (1 + ωT) times as much.
#[test]
fn errors_fall_with_the_tolerance_and_are_written_down() {
    let directory = directory();
    let here = directory.path();
    let mut arguments = STUDY.to_vec();
    arguments.extend(["--csv", "a.csv", "--picture", "a.svg", "--picture", "a.png"]);
    arguments.extend(["--markdown", "a.md"]);
    let (out, _) = call(here, &arguments, 0);
    let study = json(&out);
    let points = study["points"].as_array().unwrap();

    // the reference is right to a dozen digits and more, by its own account
    let epsilon = f64::EPSILON;
    let phase = (2.0 * 9.81 * 0.5f64 / 0.6).sqrt();
    let own = study["reference_errors"]["the state"].as_f64().unwrap();
    assert!(own < 1e-14, "{own:e}");

    let of = |method: &str, scalar: &str, pace: &str| -> Vec<&serde_json::Value> {
        let wanted = |p: &&serde_json::Value| {
            p["method"] == method && p["scalar"] == scalar && p[pace].is_number()
        };
        points.iter().filter(wanted).collect()
    };
    let controlled = of("dop853", "f64", "tolerance");
    assert_eq!(controlled.len(), 5);
    let mut errors = Vec::new();
    for point in controlled {
        let [error, steps, tolerance] =
            ["error_state", "steps", "tolerance"].map(|key| point[key].as_f64().unwrap());
        assert!(error <= steps * tolerance * (1.0 + phase), "{point}");
        errors.push(error);
    }
    // neighbours with about five steps each may have similar errors; over four decades the tolerance shows
    let fall = errors.windows(3).all(|three| three[2] < three[0]);
    assert!(fall, "{errors:?}");
    // between steps of 10 ms and 1 ms, ωh = 0.04 and 0.004, the classical method has its order
    let fixed = of("rk4", "f64", "step_s");
    let order = fixed[1]["order"].as_f64().unwrap();
    assert!((order - 4.0).abs() < 0.1, "{order}");
    // the error in single precision is at least ε of it
    for point in of("dop853", "f32", "step_s") {
        let error = point["error_state"].as_f64().unwrap();
        assert!(error > 0.1 * f64::from(f32::EPSILON), "{point}");
    }

    // the file has the same numbers, and the settings that they were computed with (serde_json reads a number to within
    // a unit in the last place)
    let same = |text: String, value: &serde_json::Value| match (text.parse::<f64>(), value.as_f64())
    {
        (Ok(a), Some(b)) => (a - b).abs() <= 2.0 * epsilon * b.abs(),
        _ => false,
    };
    let mut table = csv::Reader::from_path(here.join("a.csv")).unwrap();
    let headings = table.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), points.len());
    let cell = |row: &csv::StringRecord, name: &str| -> String {
        let column = headings.iter().position(|h| h == name);
        row[column.unwrap_or_else(|| panic!("{name}: {headings:?}"))].to_owned()
    };
    for (row, point) in rows.iter().zip(points) {
        assert_eq!(cell(row, "status"), "done", "{row:?}");
        for (column, key) in [
            ("error in the state", "error_state"),
            ("gap of energy", "energy_gap"),
            ("wall time median [s]", "wall_median_s"),
            ("wall time 95th percentile [s]", "wall_95_s"),
            ("evaluations", "evaluations"),
            ("largest step [s]", "largest_step_s"),
        ] {
            let text = cell(row, column);
            assert!(same(text.clone(), &point[key]), "{column}: {text}, {point}");
        }
        let swing = &point["readings"]["peak swing"];
        assert!(same(cell(row, "error in peak swing"), swing));
        assert_eq!(cell(row, "method"), point["method"].as_str().unwrap());
        assert_eq!(cell(row, "model digest"), study["digest"].as_str().unwrap());
        for column in ["bryant", "engine", "target"] {
            assert!(!cell(row, column).is_empty(), "{column}");
        }
    }

    // a picture that is drawn again has the same lines and legend, whatever the times were
    let svg = std::fs::read_to_string(here.join("a.svg")).unwrap();
    assert!(svg.contains("for 1 % in the worst of") && svg.contains("Pareto front"));
    let first = structure(&svg);
    assert!(
        first.iter().any(|part| part.starts_with("dop853")),
        "{first:?}"
    );
    let mut again = STUDY.to_vec();
    again.extend(["--picture", "b.svg"]);
    call(here, &again, 0);
    let second = std::fs::read_to_string(here.join("b.svg")).unwrap();
    assert_eq!(first, structure(&second));
    let png = std::fs::read(here.join("a.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG\r\n"));
    let page = std::fs::read_to_string(here.join("a.md")).unwrap();
    let sentence = study["sentence"].as_str().unwrap();
    assert!(
        page.contains(&sentence[1..]) && page.contains("](a.svg)"),
        "{page}"
    );
    assert!(
        page.contains("bryant accuracy clock.yaml --quick --methods rk4,dop853"),
        "{page}"
    );
}

/// A time that a `Duration` cannot hold is still a valid time.
#[test]
fn a_study_may_have_more_time_than_there_is() {
    let directory = directory();
    let mut arguments = vec!["accuracy", "clock.yaml", "--quick", "--methods", "rk4"];
    arguments.extend(["--steps", "10 ms..1 ms", "--repetitions", "1"]);
    arguments.extend(["--budget", "1e300 s", "--no-files", "--json"]);
    let (out, _) = call(directory.path(), &arguments, 0);
    let study = json(&out);
    let points = study["points"].as_array().unwrap();
    assert!(!points.is_empty());
    for point in points {
        assert!(point["error_state"].is_number(), "{point}");
    }
}

#[test]
fn a_study_that_cannot_be_is_refused_with_what_can() {
    let directory = directory();
    let here = directory.path();
    let refused = |arguments: &[&str], words: &[&str]| {
        let mut all = vec!["accuracy", "clock.yaml"];
        all.extend(arguments);
        let (_, err) = call(here, &all, 2);
        for word in words {
            assert!(err.contains(word), "{arguments:?}: {err}");
        }
    };
    refused(&["--methods", "rk5"], &["rk4", "dop853", "rodas5"]);
    for wrong in ["0..1e-3", "1e-3..-1e-6", "1..1e-6", "nan"] {
        refused(&["--tolerances", wrong], &["1e-2..1e-10"]);
    }
    refused(&["--steps", "2 s..1 ms"], &["longer than the run of 1 s"]);
    refused(
        &["--steps", "500 ms..1 ms"],
        &["between two samples", "100 ms"],
    );
    refused(
        &["--of", "swings"],
        &["swing", "bob height", "state", "worst"],
    );
    refused(&["--picture", "a.pdf"], &[".svg", ".png"]);
    refused(&["--set", "gravity=-1"], &["at least 0"]);

    // the scene itself cannot run to its end
    let (_, err) = call(here, &["accuracy", "cut-short.yaml", "--quick"], 3);
    assert!(
        err.contains("nothing to measure errors against") && err.contains("at t = 0.05 s the rate"),
        "{err}"
    );
}
