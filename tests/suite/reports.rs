//! `bryant run --report`: one complete page with the numbers of the run.

use super::command_call::call;
use serde_json::Value;
use std::path::Path;

/// The page of a model, and the data in it.
fn report(directory: &Path, model: &str, more: &[&str]) -> (String, Value) {
    let mut arguments = vec!["run", model, "--no-files", "--report", "report.html"];
    arguments.extend(more);
    call(directory, &arguments, 0);
    page(&directory.join("report.html"))
}

/// A page, and the data in it.
pub fn page(path: &Path) -> (String, Value) {
    let page = std::fs::read_to_string(path).unwrap();
    let data = page.split("id=\"data\">").nth(1).unwrap();
    let data = data.split("</script>").next().unwrap();
    let data = serde_json::from_str(data).unwrap();
    (page, data)
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], |list| list)
}

/// Belts and contacts are shown with the forces of the model's own outputs.
#[test]
fn forces_of_a_report_are_those_of_the_outputs() {
    let directory = tempfile::tempdir().unwrap();
    let (page, data) = report(directory.path(), "child-seat", &[]);
    // a page that is sent to others should be at most a megabyte
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    let column = |name: &str| -> Vec<f64> {
        let columns = list(&data["columns"]);
        let found = columns.iter().find(|column| column["name"] == name);
        let values = list(&found.unwrap_or_else(|| panic!("{name}"))["values"]);
        values.iter().map(|value| value.as_f64().unwrap()).collect()
    };
    let scene = &data["scene"];
    let times = list(&scene["times"]);
    assert_eq!(times.len(), column("lap belt force").len());
    assert_eq!(times, list(&data["times"]));
    assert_eq!(list(&scene["frames"]).len(), times.len());
    let bodies = list(&scene["bodies"]).len();
    assert!(
        list(&scene["frames"])
            .iter()
            .all(|frame| list(frame).len() == 7 * bodies)
    );
    for (belt, output) in [
        ("lap", "lap belt force"),
        ("shoulder", "shoulder belt force"),
    ] {
        let line = list(&scene["lines"])
            .iter()
            .find(|line| line["name"] == belt);
        let forces = list(&line.unwrap()["force"]);
        for (force, expected) in forces.iter().zip(column(output)) {
            // both are written with six digits
            let force = force.as_f64().unwrap();
            assert!(
                (force - expected).abs() <= 2e-5 * expected.abs() + 1e-9,
                "{belt}: {force} {expected}"
            );
        }
        assert_eq!(forces.len(), times.len());
    }
    // while the cushion is compressed, a contact pushes
    let pushes = list(&scene["pushes"]);
    for (k, force) in column("cushion force").iter().enumerate() {
        assert!(*force == 0.0 || !list(&pushes[k]).is_empty(), "row {k}");
    }
}

/// The curves have the peaks of the run, which lie between rows, and each curve stands in one plot with the bodies that
/// it belongs to.
#[test]
fn curves_of_a_report_have_the_peaks_of_the_run() {
    let directory = tempfile::tempdir().unwrap();
    let (_, data) = report(directory.path(), "child-seat", &["--every", "5 ms"]);
    let run = [
        "run",
        "child-seat",
        "--no-files",
        "--json",
        "--every",
        "5 ms",
    ];
    let run: Value = serde_json::from_str(&call(directory.path(), &run, 0).0).unwrap();
    let columns = list(&data["columns"]);
    let mut cut = 0;
    for peak in list(&run["peaks"]) {
        let column = columns
            .iter()
            .find(|column| column["name"] == peak["output"]);
        let column = column.unwrap();
        let value = peak["value"].as_f64().unwrap();
        assert_eq!(column["largest"][0], value);
        assert_eq!(column["largest"][1], peak["time_s"]);
        // six digits are written
        let has = |values: &Value| {
            floats(values)
                .iter()
                .any(|v| (v / value - 1.0).abs() < 1e-5)
        };
        assert!(
            has(&column["values"]) || has(&column["between"]["values"]),
            "{peak}"
        );
        cut += usize::from(!has(&column["values"]));
    }
    assert!(cut > 2, "rows have all peaks but {cut}");
    let mut shown = vec![0; columns.len()];
    for plot in list(&data["plots"]) {
        let curves = list(&plot["curves"]);
        assert!(curves.len() <= 6);
        for curve in curves {
            let index = curve.as_u64().unwrap() as usize;
            shown[index] += 1;
            assert_eq!(columns[index]["unit"], plot["unit"]);
        }
    }
    assert_eq!(shown, vec![1; columns.len()]);
    let bodies = list(&data["scene"]["bodies"]);
    let of = |name: &str| -> Vec<&Value> {
        let column = columns
            .iter()
            .find(|column| column["name"] == name)
            .unwrap();
        let indices = list(&column["bodies"]).iter();
        indices
            .map(|k| &bodies[k.as_u64().unwrap() as usize]["name"])
            .collect()
    };
    assert_eq!(of("head excursion"), ["child/head"]);
    assert_eq!(of("lap belt force"), ["child/torso"]);
    assert_eq!(of("chin force"), ["child/head", "child/torso"]);
}

/// A free rod falls as the output says, and the page moves the rod to the same place.
#[test]
fn bodies_of_a_report_are_where_the_outputs_say() {
    let directory = tempfile::tempdir().unwrap();
    let model = "\
model: fall
title: '</script><b>\"&'
dimension: 3
systems:
  - name: one
    elements: [{ name: rod, mass: 2 kg, cg: [0, 0, 0], inertia: [0.1, 0.2, 0.3] }]
    start: { position: [0, 0, 3], velocity: [1, 2, 0], angles: { rod: [10 deg, 20 deg, 30 deg] }, rates: { rod: [1, 2, 3] } }
forces: [{ field: earth, acceleration: [0, 0, -9.81] }]
outputs:
  - { name: height, of: one/rod, what: position, component: z }
run: { duration: 0.5 s, every: 50 ms }
";
    std::fs::write(directory.path().join("fall.yaml"), model).unwrap();
    let (page, data) = report(directory.path(), "fall.yaml", &["-r", "peak of height"]);
    assert!(!page.contains("<b>"));
    assert_eq!(data["title"], "</script><b>\"&");
    let heights = list(&data["columns"][0]["values"]);
    for (frame, height) in list(&data["scene"]["frames"]).iter().zip(heights) {
        let frame: Vec<f64> = list(frame).iter().map(|x| x.as_f64().unwrap()).collect();
        assert!((frame[2] - height.as_f64().unwrap()).abs() <= 1e-5 * 3.0);
        let length: f64 = frame[3..].iter().map(|x| x * x).sum();
        assert!((length - 1.0).abs() < 1e-4, "{frame:?}");
    }
    assert_eq!(data["responses"][0]["value"], 3.0);
    assert!(
        data["command"]
            .as_str()
            .unwrap()
            .contains("'peak of height'")
    );
}

/// The page of a run that cannot be trusted says so; the page of a failed run shows the existing samples.
#[test]
fn a_report_of_a_failed_run_says_why() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("cut-short.yaml"), super::CUT_SHORT).unwrap();
    let arguments = [
        "run",
        "cut-short.yaml",
        "--no-files",
        "--report",
        "report.html",
    ];
    call(directory.path(), &arguments, 3);
    let page = std::fs::read_to_string(directory.path().join("report.html")).unwrap();
    assert!(page.contains("\"failure\":\""), "{page}");
}

/// If there are more rows than a browser can show, the command refuses before the run.
#[test]
fn a_report_of_too_many_rows_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let arguments = [
        "run",
        "child-seat",
        "--every",
        "1 us",
        "--no-files",
        "--report",
        "report.html",
    ];
    let (_, said) = call(directory.path(), &arguments, 2);
    assert!(said.contains("--every"), "{said}");
    assert!(!directory.path().join("report.html").exists());
}

/// A page is not printed on standard output.
#[test]
fn a_report_to_standard_output_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let arguments = ["run", "child-seat", "--no-files", "--report", "-"];
    let (_, said) = call(directory.path(), &arguments, 2);
    assert!(said.contains("--report"), "{said}");
    assert!(!directory.path().join("-").exists());
}

/// The data in a page.
fn data_of(page: &str) -> Value {
    let data = page.split("id=\"data\">").nth(1).unwrap();
    serde_json::from_str(data.split("</script>").next().unwrap()).unwrap()
}

fn floats(value: &Value) -> Vec<f64> {
    list(value).iter().map(|x| x.as_f64().unwrap()).collect()
}

/// At each time, kinetic energy and the works of effects fulfil the balance; the last values are those of the end.
#[test]
fn works_over_time_end_where_the_balance_is() {
    let directory = tempfile::tempdir().unwrap();
    let (_, data) = report(directory.path(), "child-seat", &[]);
    let times = floats(&data["works"]["times"]);
    assert!(times.len() > 100 && times.len() <= 301, "{}", times.len());
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    let effects = list(&data["works"]["effects"]);
    let whole = data["energy"]["work"].as_object().unwrap();
    assert_eq!(effects.len(), whole.len());
    let largest = whole
        .values()
        .map(|work| work.as_f64().unwrap().abs())
        .fold(0.0, f64::max);
    for effect in effects {
        let values = floats(&effect["values"]);
        let end = whole[effect["name"].as_str().unwrap()].as_f64().unwrap();
        assert_eq!(values.len(), times.len());
        // the last value is up to 1/300 of the run before the end, when nothing changes fast
        let last = values.last().unwrap();
        assert!((last - end).abs() < 0.02 * largest, "{effect:?} {end}");
    }
}

/// The second run equals that of the command with the other parameters; a test is shown in the units of the outputs.
#[test]
fn a_second_run_and_a_test_lie_beside_the_run() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let other = [
        "run",
        "child-seat",
        "--no-files",
        "--csv",
        "other.csv",
        "--set",
        "lap_slack=0",
    ];
    call(path, &other, 0);
    let table = std::fs::read_to_string(path.join("other.csv")).unwrap();
    // the test has other units and other times
    let mut rows = String::from("time [s],sled/head [g]\n");
    for (index, line) in table
        .lines()
        .skip(1)
        .enumerate()
        .filter(|(index, _)| index % 2 == 0)
    {
        let head: f64 = line.split(',').nth(3).unwrap().parse().unwrap();
        rows.push_str(&format!("{},{}\n", 0.002 * index as f64, head / 9.80665));
    }
    std::fs::write(path.join("test.csv"), rows).unwrap();
    let more = [
        "--beside",
        "lap_slack=0 mm",
        "--measured",
        "test.csv",
        "--channel",
        "res. head acceleration=sled/head",
    ];
    let (page, data) = report(path, "child-seat", &more);
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    let column = |values: &Value, name: &str| -> Vec<f64> {
        let found = list(values).iter().find(|column| column["name"] == name);
        floats(&found.unwrap_or_else(|| panic!("{name}"))["values"])
    };
    let beside = column(&data["beside"]["curves"], "res. head acceleration");
    let expected: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(3).unwrap().parse().unwrap())
        .collect();
    let largest = expected.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    assert_eq!(beside.len(), expected.len());
    for (found, expected) in beside.iter().zip(&expected) {
        // six digits are written
        assert!(
            (found - expected).abs() < 1e-5 * largest,
            "{found} {expected}"
        );
    }
    let measured = column(&data["overlays"], "measured");
    assert_eq!(data["columns"][2]["name"], "res. head acceleration");
    assert_eq!(data["overlays"][0]["of"], 2);
    for (found, expected) in measured.iter().zip(expected.iter().step_by(2)) {
        assert!(
            (found - expected).abs() < 1e-5 * largest,
            "{found} {expected}"
        );
    }
    assert_eq!(
        list(&data["beside"]["scene"]["times"]).len(),
        expected.len()
    );
    for (arguments, told) in [
        (&["--beside", "lap_slak=0"][..], "lap_slack"),
        (&["--measured", "test.csv"], "no channel with the name"),
        (
            &["--measured", "test.csv", "--channel", "nose=sled/head"],
            "no output \"nose\"",
        ),
        (
            &[
                "--measured",
                "test.csv",
                "--channel",
                "lap belt force=sled/head",
            ],
            "one quantity",
        ),
        (&["--measured", "none.csv"], "none.csv"),
    ] {
        let run = ["run", "child-seat", "--no-files", "--report", "r.html"];
        let (_, error) = call(path, &[&run[..], arguments].concat(), 2);
        assert!(error.contains(told), "{told}: {error}");
        assert!(!path.join("r.html").exists());
    }
    call(
        path,
        &["run", "child-seat", "--no-files", "--beside", "lap_slack=0"],
        2,
    );
}

/// The page of a study has the rows of its table, and the command of a row gives its responses.
#[test]
fn a_study_has_a_page_whose_rows_can_be_run() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    std::fs::create_dir(path.join("studies")).unwrap();
    let study = "model: child-seat\ndesign: latin hypercube\nruns: 12\nparameters: { lap_slack: { from: 0 mm, to: 40 mm }, friction: { from: 0.1, to: 0.6 } }\nfixed: { gravity: 9.5 }\ntables: [csv]\n\
                 responses: [{ of: lap belt force, what: peak, name: \"</script><b>\" }]\n";
    std::fs::write(path.join("studies/s.yaml"), study).unwrap();
    call(
        path,
        &[
            "sweep",
            "studies/s.yaml",
            "--out",
            "rows",
            "--report",
            "page.html",
        ],
        0,
    );
    let page = std::fs::read_to_string(path.join("page.html")).unwrap();
    assert_eq!(page.matches("</script>").count(), 2);
    let data = data_of(&page);
    let rows = list(&data["rows"]);
    assert_eq!(rows.len(), 12);
    let table = std::fs::read_to_string(path.join("rows/results.csv")).unwrap();
    for row in rows {
        let force = list(row).last().unwrap().as_f64().unwrap();
        let found = table.lines().skip(1).flat_map(|line| line.split(','));
        let mut found = found.filter_map(|cell| cell.parse::<f64>().ok());
        assert!(found.any(|x| x == force), "{force} {table}");
    }
    let row = list(&rows[7]);
    let command = data["command"].as_str().unwrap();
    let mut words: Vec<String> = command.split(' ').skip(1).map(str::to_owned).collect();
    for (parameter, value) in list(&data["parameters"]).iter().zip(&row[3..]) {
        words.extend([
            "--set".to_owned(),
            format!("{}={value}", parameter["name"].as_str().unwrap()),
        ]);
    }
    for option in list(&data["fixed"]) {
        words.extend(option.as_str().unwrap().split(' ').map(str::to_owned));
    }
    words.extend(["--json", "--no-files"].map(str::to_owned));
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let run: Value = serde_json::from_str(&call(path, &words, 0).0).unwrap();
    let found = run["responses"][0]["value"].as_f64().unwrap();
    let expected = row.last().unwrap().as_f64().unwrap();
    // the study is accurate to 0.1 %
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}
