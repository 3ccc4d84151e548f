//! Units in which outputs are shown: what is shown is the same run, and criteria and files of other standards are as
//! before.

use super::command_call::call;
use super::{directory, json};
use serde_json::Value;
use std::path::Path;

/// A body that is thrown and turns: its motion has a closed form that one sees.
const THROWN: &str = "\
model: thrown
dimension: 2
units: engineering
systems:
  - name: p
    start: { velocity: [0, 10], rates: { b: 180 deg/s } }
    elements: [{ name: b, mass: 2 kg, cg: [0, 0], inertia: 0.1 }]
forces: [{ field: gravity, acceleration: [0, -9.80665] }]
outputs:
  - { name: height, of: p/b, what: position, component: z }
  - { name: in cm, of: p/b, what: position, component: z, unit: cm }
  - { name: speed, of: p/b, what: velocity, component: z, unit: km/h }
  - { name: acceleration, of: p/b, what: acceleration, component: z }
  - { name: in SI, of: p/b, what: acceleration, component: z, unit: m/s^2 }
  - { name: angle, of: p/b, what: angle }
  - { name: turning, of: p/b, what: angular_velocity, unit: rpm }
  - { name: drag, formula: acceleration * in_cm / span, with: { in_cm: in cm } }
parameters: { span: 2 s }
run: { duration: 0.5 s, every: 0.25 s }
";

fn rows(folder: &Path, arguments: &[&str]) -> Value {
    let whole = [&["run", "thrown.yaml", "--no-files", "--json"], arguments].concat();
    json(&call(folder, &whole, 0).0)
}

fn units(run: &Value) -> Vec<&str> {
    let columns = run["columns"].as_array().unwrap();
    columns
        .iter()
        .map(|column| column["unit"].as_str().unwrap())
        .collect()
}

#[test]
fn outputs_are_shown_in_their_units() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("thrown.yaml"), THROWN).unwrap();
    let run = rows(directory.path(), &[]);
    let expected = [
        "ms", "mm", "cm", "km/h", "g", "m/s^2", "deg", "rpm", "m^2/s^3",
    ];
    assert_eq!(units(&run), expected);
    // after half a second: 10 t − g t²/2, 10 − g t, one half turn a second
    let g = 9.80665;
    let height = 5.0 - g / 8.0;
    let closed = [
        500.0,
        1e3 * height,
        1e2 * height,
        3.6 * (10.0 - g / 2.0),
        -1.0,
        -g,
        90.0,
        30.0,
        -g * height / 2.0,
    ];
    let last = run["rows"]
        .as_array()
        .unwrap()
        .last()
        .unwrap()
        .as_array()
        .unwrap();
    for ((found, expected), unit) in last.iter().zip(closed).zip(units(&run)) {
        let found = found.as_f64().unwrap();
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "{found} for {expected} {unit}"
        );
    }
    // peaks and responses too; a response of time follows the times
    let asked = [
        "-r",
        "peak of height",
        "-r",
        "time of peak of height",
        "-r",
        "integral of speed",
        "-r",
        "range of angle",
    ];
    let run = rows(directory.path(), &asked);
    let shown = |list: &str, what: usize| {
        let one = &run[list][what];
        (
            one["value"].as_f64().unwrap(),
            one["unit"].as_str().unwrap().to_owned(),
        )
    };
    let [peak, time, way, range] = [0, 1, 2, 3].map(|index| shown("responses", index));
    assert_eq!(
        [&peak.1, &time.1, &way.1, &range.1],
        ["mm", "ms", "m", "deg"]
    );
    for (found, expected) in [
        (peak.0, 1e3 * height),
        (time.0, 500.0),
        (way.0, height),
        (range.0, 90.0),
    ] {
        assert!(
            (found / expected - 1.0).abs() < 1e-4,
            "{found} for {expected}"
        );
    }
    assert_eq!(shown("peaks", 0).1, "mm");
    assert!((shown("peaks", 0).0 / (1e3 * height) - 1.0).abs() < 1e-9);
    // an output with a unit of its own keeps it
    let run = rows(directory.path(), &["--units", "SI"]);
    assert_eq!(
        units(&run),
        [
            "s", "m", "cm", "km/h", "m/s^2", "m/s^2", "rad", "rpm", "m^2/s^3"
        ]
    );
}

#[test]
fn a_unit_of_another_quantity_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("thrown.yaml");
    for (unit, what) in [
        ("kg", "cannot be shown in"),
        ("furlong", "is no unit"),
        ("5 cm", "is no unit"),
        ("g", "cannot be shown in"),
        ("\"\"", "is no unit"),
    ] {
        let text = THROWN.replace("unit: cm", &format!("unit: {unit}"));
        std::fs::write(&file, text).unwrap();
        let (_, error) = call(directory.path(), &["check", "thrown.yaml"], 2);
        assert!(
            error.contains(what) && error.contains("thrown.yaml:"),
            "{unit}: {error}"
        );
    }
    // hertz of a rotation would be turns for some readers and radians for others
    std::fs::write(&file, THROWN.replace("unit: rpm", "unit: Hz")).unwrap();
    let (_, error) = call(directory.path(), &["check", "thrown.yaml"], 2);
    assert!(error.contains("cannot be shown in \"Hz\""), "{error}");
}

/// Criteria are judged and files of ISO-MME are written in the units of their standards: nothing there knows the units
/// of the outputs.
#[test]
fn criteria_and_files_of_tests_do_not_depend_on_units() {
    let directory = directory();
    let made = |units: &str| {
        let mme = format!("mme-{units}");
        let csv = format!("{units}.csv");
        let arguments = [
            "run",
            "child-restraint",
            "--units",
            units,
            "--no-files",
            "--no-verify",
            "--every",
            "0.1 ms",
            "--json",
        ];
        let files = [
            "--mme",
            &mme,
            "--csv",
            &csv,
            "-r",
            "HIC15 of head acceleration resultant",
        ];
        let run = json(&call(directory.path(), &[&arguments[..], &files].concat(), 0).0);
        let channels = directory.path().join(mme).join("Channel");
        let mut files: Vec<_> = std::fs::read_dir(channels)
            .unwrap()
            .map(|file| file.unwrap().path())
            .collect();
        files.sort();
        let files: Vec<String> = files
            .iter()
            .map(|file| std::fs::read_to_string(file).unwrap())
            .collect();
        (run, files)
    };
    let [(si, si_files), (shown, files)] = ["SI", "engineering"].map(made);
    assert_eq!(si["criteria"], shown["criteria"]);
    assert_eq!(si["responses"], shown["responses"]);
    assert!(si_files.len() > 3 && si_files == files);
    assert!(units(&shown).contains(&"g") && !units(&si).contains(&"g"));
    // the table of one is the test of the other: its units are read
    let arguments = [
        "compare",
        "engineering.csv",
        "SI.csv",
        "--channel",
        "head acceleration resultant=head acceleration resultant",
    ];
    let (told, _) = call(directory.path(), &arguments, 0);
    assert!(told.contains("1.000"), "{told}");
    // a table in other units is one of its own, which may be replaced
    let arguments = [
        "run",
        "child-restraint",
        "--no-files",
        "--no-verify",
        "--csv",
        "engineering.csv",
        "--duration",
        "1 ms",
    ];
    call(directory.path(), &arguments, 0);
    call(
        directory.path(),
        &[&arguments[..], &["--units", "engineering"]].concat(),
        0,
    );
}

#[test]
fn a_corridor_lies_where_its_numbers_say_in_any_unit() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("thrown.yaml"), THROWN).unwrap();
    let drawn = |units: &str| {
        let arguments = [
            "run",
            "thrown.yaml",
            "--no-files",
            "--units",
            units,
            "--plot",
            "height",
        ];
        let corridor = ["--corridor", "height: 0.25 s to 400 ms, 2 m to 3000 mm"];
        call(directory.path(), &[&arguments[..], &corridor].concat(), 0);
        let svg =
            std::fs::read_to_string(directory.path().join("thrown-height-over-time.svg")).unwrap();
        let line = svg
            .lines()
            .find(|line| line.contains("class=\"corridor\""))
            .unwrap()
            .to_owned();
        (line, svg)
    };
    let [(si, of_si), (shown, svg)] = ["SI", "engineering"].map(drawn);
    assert_eq!(si, shown);
    assert!(
        of_si.contains("height [m]") && svg.contains("height [mm]") && svg.contains("time [ms]")
    );
}

/// A study has the numbers and the units of a single run.
#[test]
fn studies_show_responses_in_the_same_units() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    std::fs::write(here.join("thrown.yaml"), THROWN).unwrap();
    let study = "model: thrown.yaml\ndesign: list\nrows: [{ span: 1 s }, { span: 2 s }]\nresponses:\n  - { of: height, what: peak }\n  - { of: in SI, what: minimum }\n  - { of: speed, what: integral }\n  - { of: height, what: time of peak }\nkeep: { runs: [1], outputs: [height, in SI] }\n";
    std::fs::write(here.join("study.yaml"), study).unwrap();
    call(here, &["sweep", "study.yaml"], 0);
    let summary = std::fs::read_to_string(here.join("study-results/summary.json")).unwrap();
    let summary = json(&summary);
    let height = 5.0 - 9.80665 / 8.0;
    let expected = [
        ("mm", 1e3 * height),
        ("m/s^2", -9.80665),
        ("m", height),
        ("ms", 500.0),
    ];
    for (index, (unit, value)) in expected.into_iter().enumerate() {
        let found = &summary["responses"][index];
        assert_eq!(found["unit"], unit);
        let mean = found["mean"].as_f64().unwrap();
        assert!(
            (mean / value - 1.0).abs() < 1e-4,
            "{mean} for {value} {unit}"
        );
    }
    // a series that is kept, too
    let series = std::fs::read_to_string(here.join("study-results/series/run-00000001.csv"));
    let series = series.unwrap();
    let (first, last) = (series.lines().next(), series.lines().last());
    assert_eq!(first, Some("time [ms],height [mm],in SI [m/s^2]"));
    let last: Vec<f64> = last
        .unwrap()
        .split(',')
        .map(|n| n.parse().unwrap())
        .collect();
    for (found, expected) in last.iter().zip([500.0, 1e3 * height, -9.80665]) {
        assert!((found / expected - 1.0).abs() < 1e-4, "{last:?}");
    }
    let summary = std::fs::read_to_string(here.join("study-results/summary.txt")).unwrap();
    assert!(
        summary.contains("[mm]") && summary.contains("[m/s²]"),
        "{summary}"
    );
}

/// A body that is thrown at 10 m/s is 5 m − fall · s²/8 high after half a second.
#[test]
fn derivatives_and_parameters_are_shown_in_units() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let falling = THROWN
        .replace("[0, -9.80665]", "[0, -fall]")
        .replace("span: 2 s", "span: 2 s, fall: { value: 1 gn, min: 0 }");
    std::fs::write(here.join("thrown.yaml"), falling).unwrap();
    let g = 9.80665;
    let slope = |units: &[&str]| {
        let arguments = ["gradient", "thrown.yaml", "--of", "final of height"];
        let more = ["--wrt", "fall", "--check", "--json"];
        let printed = call(here, &[&arguments[..], &more, units].concat(), 0).0;
        let response = json(&printed)["responses"][0].clone();
        let parameter = response["parameters"][0].clone();
        let number = |value: &Value| value.as_f64().unwrap();
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        let units = [
            &response["unit"],
            &parameter["unit"],
            &parameter["derivative_unit"],
        ];
        let numbers = ["value", "derivative", "difference"].map(|key| number(&parameter[key]));
        (
            units.map(text),
            [
                number(&response["value"]),
                numbers[0],
                numbers[1],
                numbers[2],
            ],
        )
    };
    for (asked, units, expected) in [
        (
            &[][..],
            ["mm", "g", "mm/g"],
            [5e3 - 1e3 * g / 8.0, 1.0, -1e3 * g / 8.0],
        ),
        (
            &["--units", "SI"],
            ["m", "m/s^2", "s^2"],
            [5.0 - g / 8.0, g, -0.125],
        ),
    ] {
        let (found, [value, parameter, derivative, difference]) = slope(asked);
        assert_eq!(found, units);
        for (found, expected) in [
            (value, expected[0]),
            (parameter, expected[1]),
            (derivative, expected[2]),
            (difference, expected[2]),
        ] {
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{found} for {expected}"
            );
        }
    }
    let arguments = [
        "gradient",
        "thrown.yaml",
        "--of",
        "final of height",
        "--wrt",
        "fall",
    ];
    let (printed, _) = call(here, &arguments, 0);
    // five digits
    assert!(
        printed.contains("3774.2 mm") && printed.contains("-1225.8 mm/g"),
        "{printed}"
    );
    assert!(printed.contains(" 1 g "), "{printed}");

    let (text, _) = call(here, &["check", "thrown.yaml"], 0);
    for line in [
        "span = 2000 ms",
        "fall = 1 g, at least 0",
        "500 ms, a row every 250 ms",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let (text, _) = call(here, &["check", "thrown.yaml", "--units", "SI"], 0);
    assert!(
        text.contains("span = 2 s") && text.contains("0.5 s, a row"),
        "{text}"
    );
    let (printed, _) = call(here, &["check", "thrown.yaml", "--json"], 0);
    let fall = json(&printed)["parameters"][1].clone();
    assert_eq!(
        (&fall["default"], &fall["unit"]),
        (&1.0.into(), &"g".into())
    );
}

/// Criteria that are formed of several outputs are in the unit of these, and so many runs keep their limits in any
/// unit.
#[test]
fn studies_judge_alike_in_any_unit() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let bundled =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("models/applications/child-restraint.yaml");
    let text = std::fs::read_to_string(bundled).unwrap();
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/models/data/");
    let text = text.replace("../data/", data);
    let judged = |name: &str, units: &str| {
        let text = text.replacen("title:", &format!("units: {units}\ntitle:"), 1);
        std::fs::write(here.join(format!("{name}.yaml")), text).unwrap();
        let study = format!(
            "model: {name}.yaml\ndesign: list\nrows: [{{ harness_slack: 0 }}, {{ harness_slack: 60 mm, belt_slack: 40 mm }}]\nresponses: [{{ criterion: all }}]\n"
        );
        std::fs::write(here.join("study.yaml"), study).unwrap();
        call(
            here,
            &[
                "sweep",
                "study.yaml",
                "--out",
                name,
                "--report",
                "page.html",
            ],
            0,
        );
        let page = std::fs::read_to_string(here.join("page.html")).unwrap();
        let counts: Vec<String> = page
            .match_indices("\"within\":")
            .map(|(at, found)| {
                let digits = page[at + found.len()..]
                    .chars()
                    .take_while(char::is_ascii_digit);
                digits.collect()
            })
            .collect();
        let summary = json(&std::fs::read_to_string(here.join(name).join("summary.json")).unwrap());
        let responses = summary["responses"].as_array().unwrap().clone();
        (counts, responses)
    };
    let ((si, of_si), (shown, of_shown)) =
        (judged("si", "SI"), judged("engineering", "engineering"));
    assert!(si == shown && si.len() == of_si.len(), "{si:?} {shown:?}");
    let of = |all: &[serde_json::Value], name: &str| {
        let one = all.iter().find(|one| one["name"] == name).unwrap();
        (
            one["unit"].as_str().unwrap().to_owned(),
            one["mean"].as_f64().unwrap(),
        )
    };
    for (name, unit, size) in [("chest 3 ms", "g", 9.80665), ("head excursion", "mm", 1e-3)] {
        let ((_, si), (found, value)) = (of(&of_si, name), of(&of_shown, name));
        assert_eq!(found, unit);
        assert!(
            (value * size / si - 1.0).abs() < 1e-12,
            "{name}: {value} {unit} for {si}"
        );
    }
}
