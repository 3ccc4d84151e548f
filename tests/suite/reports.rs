//! `bryant run --report`: one page, whole, with the numbers of the run in it.

use super::called::call;
use serde_json::Value;
use std::path::Path;

/// The page of a model, and the data in it.
fn report(directory: &Path, model: &str, more: &[&str]) -> (String, Value) {
    let mut arguments = vec!["run", model, "--no-files", "--report", "report.html"];
    arguments.extend(more);
    call(directory, &arguments, 0);
    let page = std::fs::read_to_string(directory.join("report.html")).unwrap();
    let data = page.split("id=\"data\">").nth(1).unwrap();
    let data = data.split("</script>").next().unwrap();
    let data = serde_json::from_str(data).unwrap();
    (page, data)
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], |list| list)
}

/// Belts and contacts are shown with the forces that the model's own outputs have.
#[test]
fn forces_of_a_report_are_those_of_the_outputs() {
    let directory = tempfile::tempdir().unwrap();
    let (page, data) = report(directory.path(), "child-seat", &[]);
    // the issue of a page that is sent around: a megabyte at most
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    let column = |name: &str| -> Vec<f64> {
        let columns = list(&data["columns"]);
        let found = columns.iter().find(|column| column["name"] == name);
        let values = list(&found.unwrap_or_else(|| panic!("{name}"))["values"]);
        values.iter().map(|value| value.as_f64().unwrap()).collect()
    };
    let scene = &data["scene"];
    let times = list(&scene["times"]);
    assert_eq!(times.len(), column("time").len());
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
    // where the cushion is pressed, something pushes
    let pushes = list(&scene["pushes"]);
    for (k, force) in column("cushion force").iter().enumerate() {
        assert!(*force == 0.0 || !list(&pushes[k]).is_empty(), "row {k}");
    }
}

/// A free rod falls as the output says, and the page moves it there.
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
    let heights = list(&data["columns"][1]["values"]);
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

/// A run that cannot be trusted says so on its page; one that failed shows what there is.
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

/// More rows than a browser shows are refused before the run.
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

/// A page is not printed.
#[test]
fn a_report_to_standard_output_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let arguments = ["run", "child-seat", "--no-files", "--report", "-"];
    let (_, said) = call(directory.path(), &arguments, 2);
    assert!(said.contains("--report"), "{said}");
    assert!(!directory.path().join("-").exists());
}
