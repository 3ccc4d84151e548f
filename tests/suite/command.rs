//! The command from end to end, as a user calls it: models in files, compiled on demand; output, files, and failures.

mod accuracy_check;
mod animation;
mod bags;
mod belt_slip;
mod certification;
mod command_call;
mod comparison;
mod continuation;
mod costs;
mod criteria;
mod degenerate_systems;
mod export;
mod file_replacement;
mod formulas;
mod functions;
mod grazing;
mod input_files;
mod large_rotations;
mod last_screen;
#[cfg(unix)]
mod long_commands;
mod meshes;
mod modes;
mod people;
mod pictures;
mod polarity;
mod remarks;
mod reports;
mod responses;
mod robots;
mod scenes;
mod share;
mod shown_units;
mod singular;
mod slopes;
mod states_of_rest;
mod stiff;
#[cfg(unix)]
mod streams;
mod sweep;
mod tables;
mod trust;
mod units;

use command_call::{bryant, call, expect};
use std::path::Path;
use std::process::Stdio;

/// A rod that hangs from a fixed joint: J φ̈ = −m g l sin φ with m = 2 kg, l = 0.5 m, J = 0.1 + m l² = 0.6 kg m².
const PENDULUM: &str = "\
model: clock
title: a rod that swings
dimension: 2
parameters:
  gravity: { value: 9.81 m/s^2, min: 0 }
systems:
  - name: clock
    reference: fixed
    elements:
      - { name: rod, mass: 2 kg, cg: [0, -0.5], inertia: 0.1 }
    start: { angles: { rod: 30 deg } }
forces:
  - field: earth
    acceleration: [0, -gravity]
outputs:
  - { name: swing, of: clock/rod, what: angle }
  - { name: bob height, of: clock/rod, at: cg, what: position, component: z }
run: { duration: 1 s, every: 0.1 s }
";

/// The same rod in a field that is known for 50 ms only.
const CUT_SHORT: &str = "\
model: cut-short
dimension: 2
curves:
  pulse: { points: [[0, 0], [0.05, 100]], extrapolate: error }
systems:
  - name: clock
    reference: fixed
    elements:
      - { name: rod, mass: 2 kg, cg: [0, -0.5], inertia: 0.1 }
forces:
  - field: sled
    acceleration: [pulse, 0]
outputs:
  - { name: swing, of: clock/rod, what: angle }
run: { duration: 0.1 s, every: 10 ms }
";

/// A directory with both models.
fn directory() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("clock.yaml"), PENDULUM).unwrap();
    std::fs::write(directory.path().join("cut-short.yaml"), CUT_SHORT).unwrap();
    directory
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    let list = value
        .as_array()
        .unwrap_or_else(|| panic!("no list: {value}"));
    list.iter().map(|n| n.as_f64().unwrap()).collect()
}

#[test]
fn a_run_prints_a_table_and_writes_files() {
    let directory = directory();
    let (stdout, stderr) = call(directory.path(), &["run", "clock.yaml"], 0);
    let lines: Vec<&str> = stdout.lines().collect();
    assert!(lines[0].contains("swing"), "{stdout}");
    assert!(
        lines[1].trim_start().starts_with("[s]") && lines[1].contains("[rad]"),
        "{stdout}"
    );
    assert_eq!(
        lines.iter().position(|line| line.is_empty()),
        Some(2 + 11),
        "{stdout}"
    );
    assert!(
        lines[2].contains("0.0  ") && lines[2].contains("0.524"),
        "{stdout}"
    );
    assert!(
        stderr.contains("wrote clock.csv") && stderr.contains("evaluations"),
        "{stderr}"
    );

    let csv = std::fs::read_to_string(directory.path().join("clock.csv")).unwrap();
    assert!(
        csv.starts_with("\"time [s]\",swing [rad],bob height [m]\n"),
        "{csv}"
    );
    assert_eq!(csv.lines().count(), 1 + 11);
    let svg = std::fs::read_to_string(directory.path().join("clock.svg")).unwrap();
    assert!(svg.contains("a rod that swings") && svg.ends_with("</svg>\n"));
    let rest = std::fs::read_dir(directory.path()).unwrap().count();
    assert_eq!(rest, 2 + 2, "models and files alone are left");
}

/// Runs without a compiler and with an empty path.
#[track_caller]
fn without_a_toolchain(at: &Path, arguments: &[&str], code: i32) -> (String, String) {
    let mut command = bryant(at);
    command.args(arguments);
    command.env("PATH", "").env("RUSTC", "/nonexistent/rustc");
    command.env("BRYANT_CACHE", at.join("no-cache"));
    expect(command.output().unwrap(), arguments, code)
}

#[test]
fn no_rust_toolchain_is_needed() {
    let directory = directory();
    let arguments = ["run", "clock.yaml", "--no-files", "--csv", "-"];
    let (first, _) = without_a_toolchain(directory.path(), &arguments, 0);
    let (second, _) = call(directory.path(), &arguments, 0);
    assert_eq!(first, second);
    let other = PENDULUM.replace("mass: 2 kg", "mass: 3 kg");
    std::fs::write(directory.path().join("clock.yaml"), other).unwrap();
    let (third, _) = without_a_toolchain(directory.path(), &arguments, 0);
    assert_ne!(first, third);
    assert!(!directory.path().join("no-cache").exists());
    // the scenes of real size, with belts, stops and contacts
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/scenes");
    for scene in ["occupant.yaml", "pedestrian.yaml"] {
        let model = scenes.join(scene);
        let arguments = ["run", model.to_str().unwrap(), "--no-files"];
        let (table, said) = without_a_toolchain(directory.path(), &arguments, 0);
        assert!(
            table.lines().count() > 50 && said.contains("evaluations"),
            "{said}"
        );
    }
}

#[test]
fn the_version_has_the_commit() {
    let git = |arguments: &[&str]| {
        let mut git = std::process::Command::new("git");
        let output = git
            .arg("-C")
            .arg(env!("CARGO_MANIFEST_DIR"))
            .args(arguments)
            .output();
        let output = output.ok().filter(|output| output.status.success())?;
        Some(String::from_utf8(output.stdout).unwrap().trim().to_owned())
    };
    let commit = match git(&["rev-parse", "--show-prefix"]).as_deref() {
        Some("") => git(&["rev-parse", "--short=12", "HEAD"]).expect("a commit"),
        // sources without a repository, or inside of another one
        _ => "unknown".to_owned(),
    };
    let directory = tempfile::tempdir().unwrap();
    let (stdout, _) = call(directory.path(), &["--version"], 0);
    assert_eq!(
        stdout,
        format!("bryant {} (commit {commit})\n", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn both_methods_agree_and_conserve_energy() {
    let directory = directory();
    let run = |more: &[&str]| {
        let mut arguments = vec!["run", "clock.yaml", "--no-files", "--json"];
        arguments.extend(more);
        json(&call(directory.path(), &arguments, 0).0)
    };
    let adaptive = run(&["--tolerance", "1e-10"]);
    let fixed = run(&["--method", "rk4", "--step", "1 ms"]);
    assert_eq!(
        adaptive["columns"][1],
        serde_json::json!({ "name": "swing", "unit": "rad" })
    );
    let rows = |value: &serde_json::Value| -> Vec<Vec<f64>> {
        value["rows"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers)
            .collect()
    };
    let (adaptive_rows, fixed_rows) = (rows(&adaptive), rows(&fixed));
    assert_eq!(adaptive_rows.len(), 11);
    for (a, b) in adaptive_rows.iter().zip(&fixed_rows) {
        // RK4 at 1 ms over 1 s at ω₀ = 4 rad/s: (ω₀h)⁴/120 per radian is about 1e-11.
        assert!((a[1] - b[1]).abs() < 1e-8, "{a:?} {b:?}");
        // the bob stays on its circle of 0.5 m
        assert!((a[2] + 0.5 * a[1].cos()).abs() < 1e-12, "{a:?}");
    }
    assert_eq!(fixed["report"]["steps"], 1000);
    assert!(adaptive["report"]["rejected"].as_u64().is_some());
    assert_eq!(adaptive["files"], serde_json::json!([]));
}

#[test]
fn a_bundled_model_and_its_text_move_alike() {
    let directory = directory();
    let (listed, _) = call(directory.path(), &["models", "--json"], 0);
    let listed = json(&listed);
    let models = listed.as_array().unwrap();
    let seat = models.iter().find(|m| m["name"] == "child-seat").unwrap();
    assert_eq!(
        (&seat["dimension"], &seat["elements"], &seat["freedoms"]),
        (&2.into(), &7.into(), &9.into())
    );
    assert_eq!(
        call(directory.path(), &["models", "sled-pendulum"], 0)
            .0
            .lines()
            .count(),
        2
    );

    let (yaml, _) = call(directory.path(), &["models", "sled-pendulum", "--yaml"], 0);
    std::fs::write(directory.path().join("mine.yaml"), yaml).unwrap();
    let rows = |model: &str| {
        let arguments = ["run", model, "--no-files", "--csv", "-"];
        call(directory.path(), &arguments, 0).0
    };
    assert_eq!(rows("sled-pendulum"), rows("mine.yaml"));
}

#[test]
fn parameters_have_units_and_bounds() {
    let directory = directory();
    let last = |more: &[&str]| {
        let mut arguments = vec!["run", "clock.yaml", "--no-files", "--json"];
        arguments.extend(more);
        let value = json(&call(directory.path(), &arguments, 0).0);
        let rows = value["rows"].as_array().unwrap();
        (
            numbers(rows.last().unwrap())[1],
            value["parameters"]["gravity"]["value"].as_f64().unwrap(),
        )
    };
    // without gravity the rod stays where it is
    let (swing, gravity) = last(&["--set", "gravity=0"]);
    assert_eq!(gravity, 0.0);
    assert!((swing - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    assert_eq!(last(&["--set", "gravity = 162 cm/s^2"]).1, 1.62);

    let fails = |set: &str| call(directory.path(), &["run", "clock.yaml", "--set", set], 2).1;
    assert!(fails("gravitiy=1").contains("did you mean \"gravity\"?"));
    assert!(fails("gravity=3 kg").contains("a quantity in m/s^2 is needed"));
    assert!(fails("gravity=-1").contains("at least 0"));
    assert!(fails("gravity").contains("NAME=VALUE"));
    assert!(fails("gravity=3 parsec/s^2").contains("parsec"));
    let rest = std::fs::read_dir(directory.path()).unwrap().count();
    assert_eq!(rest, 2, "bad input writes nothing");
}

#[test]
fn times_are_checked_before_anything_runs() {
    let directory = directory();
    for arguments in [
        ["run", "clock.yaml", "--step", "3 kg"],
        ["run", "clock.yaml", "--duration", "0 s"],
        ["run", "clock.yaml", "--every", "soon"],
        ["run", "clock.yaml", "--tolerance", "0"],
        ["run", "clock.yaml", "--tolerance", "1"],
        ["gradient", "clock.yaml", "--tolerance", "2"],
    ] {
        let (stdout, stderr) = call(directory.path(), &arguments, 2);
        assert!(
            stdout.is_empty() && stderr.contains(arguments[2]),
            "{stderr}"
        );
    }
    for (arguments, remedy) in [
        (["--tolerance", "2", "--kinks", "passed"], "such as 1e-6"),
        (["--method", "rk4", "--tolerance", "1e-6"], "--step"),
        (
            ["--method", "euler", "--duration", "1 s"],
            "semi-implicit-euler, heun",
        ),
        (["--step", "1 ms", "--tolerance", "1e-6"], "--tolerance"),
        (
            ["--step", "1 h", "--kinks", "located"],
            "at most as long as the run",
        ),
        (["--accuracy", "0", "--kinks", "passed"], "1 %"),
        (["--accuracy", "1%", "--method", "rk4"], "--method"),
    ] {
        let all: Vec<&str> = ["run", "clock.yaml"].into_iter().chain(arguments).collect();
        let (stdout, stderr) = call(directory.path(), &all, 2);
        assert!(stdout.is_empty() && stderr.contains(remedy), "{stderr}");
    }
}

#[test]
fn a_run_is_as_accurate_as_asked_for_and_says_so() {
    let directory = directory();
    let arguments = [
        "run",
        "clock.yaml",
        "--accuracy",
        "1e-5",
        "--verify",
        "--no-files",
    ];
    let (_, stderr) = call(directory.path(), &arguments, 0);
    assert!(stderr.contains("estimated error at most"), "{stderr}");
    assert!(stderr.contains("dop853 at tolerance"), "{stderr}");
    let json_of = [
        "run",
        "clock.yaml",
        "--accuracy",
        "1e-5",
        "--verify",
        "--no-files",
        "--json",
    ];
    let (stdout, _) = call(directory.path(), &json_of, 0);
    let accuracy = &json(&stdout)["accuracy"];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let estimated = number(&accuracy["estimated"]["worst"]);
    // both are differences from runs that are sharper than requested
    assert!(estimated <= 1e-5, "{accuracy}");
    assert!(
        number(&accuracy["verified"]["difference"]["worst"]) <= 1e-5,
        "{accuracy}"
    );
    assert_eq!(number(&accuracy["wanted"]), 1e-5);
}

#[test]
fn a_failing_run_keeps_its_samples() {
    let directory = directory();
    let (stdout, stderr) = call(directory.path(), &["run", "cut-short.yaml"], 3);
    // 0, 10 … 50 ms: the pulse is known up to there
    assert_eq!(stdout.lines().count(), 2 + 6, "{stdout}");
    assert!(
        stderr.contains("clock/rod") && stderr.contains("t = 0.05"),
        "{stderr}"
    );
    assert!(
        stderr.contains("likely cause: a curve with `extrapolate: error`"),
        "{stderr}"
    );
    let csv = std::fs::read_to_string(directory.path().join("cut-short.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 6);
    assert!(directory.path().join("cut-short.svg").is_file());

    let (stdout, _) = call(
        directory.path(),
        &["run", "cut-short.yaml", "--no-files", "--json"],
        3,
    );
    let value = json(&stdout);
    assert_eq!(value["failure"]["element"], "clock/rod");
    assert_eq!(value["rows"].as_array().unwrap().len(), 6);
}

#[test]
fn files_go_where_they_are_told() {
    let directory = directory();
    let path = |name: &str| directory.path().join(name);
    call(directory.path(), &["run", "clock.yaml", "--out", "a/b"], 0);
    assert!(path("a/b/clock.csv").is_file() && path("a/b/clock.svg").is_file());
    call(
        directory.path(),
        &[
            "run",
            "clock.yaml",
            "--no-files",
            "--picture",
            "p.svg",
            "--overlay",
        ],
        0,
    );
    assert!(path("p.svg").is_file() && !path("clock.csv").exists());
    let (stdout, _) = call(
        directory.path(),
        &["run", "clock.yaml", "--no-files", "--csv", "-"],
        0,
    );
    assert_eq!(
        stdout,
        std::fs::read_to_string(path("a/b/clock.csv")).unwrap()
    );
    let (_, stderr) = call(directory.path(), &["run", "clock.yaml", "--csv", "a"], 1);
    assert!(stderr.contains("cannot write a"), "{stderr}");
}

#[test]
fn a_wrong_model_is_an_error_with_its_place() {
    let directory = directory();
    let wrong = PENDULUM
        .replace("mass: 2 kg", "mass: -2 kg")
        .replace("what: angle", "what: angel");
    std::fs::write(directory.path().join("wrong.yaml"), wrong).unwrap();
    for command in ["run", "check", "equations"] {
        let (stdout, stderr) = call(directory.path(), &[command, "wrong.yaml"], 2);
        assert!(stdout.is_empty());
        assert!(
            stderr.contains("wrong.yaml:10:") && stderr.contains("help:"),
            "{stderr}"
        );
    }
    let (_, stderr) = call(directory.path(), &["run", "no-such.yaml"], 2);
    assert!(stderr.contains("there is no file"), "{stderr}");
    let (_, stderr) = call(directory.path(), &["run", "child-saet"], 2);
    assert!(
        stderr.contains("neither a bundled model nor a file"),
        "{stderr}"
    );
}

#[test]
fn check_says_what_is_in_a_model() {
    let directory = directory();
    let (stdout, _) = call(directory.path(), &["check", "clock.yaml"], 0);
    for text in [
        "a rod that swings",
        "1 element, 1 freedom",
        "earth",
        "gravity = 9.81 m/s²",
        "swing [rad]",
        "operations",
    ] {
        assert!(stdout.contains(text), "{text}: {stdout}");
    }
    let value = json(&call(directory.path(), &["check", "clock.yaml", "--json"], 0).0);
    assert_eq!(value["freedoms"], 1);
    assert_eq!(value["systems"][0]["elements"][0]["mass_kg"], 2.0);
}

#[test]
fn equations_at_a_state_are_those_of_the_pendulum() {
    let directory = directory();
    std::fs::write(
        directory.path().join("state.json"),
        r#"{"t": 0, "q": [0.4], "v": [3]}"#,
    )
    .unwrap();
    let arguments = ["equations", "clock.yaml", "--at", "state.json", "--json"];
    let value = json(&call(directory.path(), &arguments, 0).0);
    // A rotation about +y moves a rod that hangs along −z towards −x: r_k = −m g l sin φ.
    let torque = -2.0 * 9.81 * 0.5 * 0.4f64.sin();
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs(), "{a} {b}");
    assert_eq!(value["coordinates"], serde_json::json!(["clock/rod.phi"]));
    assert_eq!(value["velocities"].as_array().unwrap().len(), 1);
    near(numbers(&value["S"][0])[0], 0.6);
    assert_eq!(numbers(&value["r_s"]), [0.0]);
    near(numbers(&value["r_k"])[0], torque);
    near(numbers(&value["acceleration"])[0], torque / 0.6);

    // without a state: the start of a run, 30 degrees
    let value = json(
        &call(
            directory.path(),
            &["equations", "clock.yaml", "--json", "--set", "gravity=1"],
            0,
        )
        .0,
    );
    near(numbers(&value["r_k"])[0], -0.5);

    std::fs::write(
        directory.path().join("state.json"),
        r#"{"q": [0.4, 1], "v": [3]}"#,
    )
    .unwrap();
    let (_, stderr) = call(directory.path(), &arguments, 2);
    assert!(
        stderr.contains("\"q\" has 2 numbers") && stderr.contains("clock/rod.phi"),
        "{stderr}"
    );
    std::fs::write(directory.path().join("state.json"), r#"{"q": [0.4}"#).unwrap();
    let (_, stderr) = call(directory.path(), &arguments, 2);
    assert!(
        stderr.contains("state.json") && stderr.contains("line 1"),
        "{stderr}"
    );
}

#[test]
fn functions_are_those_of_the_pendulum() {
    let directory = directory();
    let write = |text: &str| std::fs::write(directory.path().join("state.json"), text).unwrap();
    write(r#"{"q": [0.4], "v": [3], "a": [2]}"#);
    let functions = "inverse_dynamics, jacobian(rod),kinetic_energy,pose(clock/rod)";
    let arguments = [
        "equations",
        "clock.yaml",
        "--functions",
        functions,
        "--at",
        "state.json",
    ];
    let value = json(&call(directory.path(), &[&arguments[..], &["--json"]].concat(), 0).0);
    let of = |k: usize| &value["functions"][k];
    let first = |k: usize| of(k)["values"][0][0].as_f64().unwrap();
    // J a + m g l sin φ, with the inertia J about the pivot
    let torque = 0.6 * 2.0 + 2.0 * 9.81 * 0.5 * 0.4f64.sin();
    assert!((first(0) - torque).abs() < 1e-14 * torque, "{value}");
    assert_eq!(of(1)["rows"][4], "about_y");
    assert_eq!(
        of(1)["values"],
        serde_json::json!([[0.0], [0.0], [0.0], [0.0], [1.0], [0.0]])
    );
    assert!((first(2) - 0.5 * 0.6 * 9.0).abs() < 1e-14, "{value}");
    // a turn about +y takes x towards -z
    assert!(
        (of(3)["values"][2][0].as_f64().unwrap() + 0.4f64.sin()).abs() < 1e-15,
        "{value}"
    );

    let (text, _) = call(directory.path(), &arguments, 0);
    assert!(
        text.contains("\njacobian(rod)\n") && text.contains("about_y"),
        "{text}"
    );
    // without accelerations those of the motion: no joint has to provide anything
    write(r#"{"q": [0.4], "v": [3]}"#);
    let value = json(&call(directory.path(), &[&arguments[..], &["--json"]].concat(), 0).0);
    assert!(
        value["functions"][0]["values"][0][0]
            .as_f64()
            .unwrap()
            .abs()
            < 1e-14,
        "{value}"
    );
    write(r#"{"q": [0.4], "v": [3], "a": [2, 1]}"#);
    let (_, stderr) = call(directory.path(), &arguments, 2);
    assert!(stderr.contains("\"a\" has 2 numbers"), "{stderr}");

    let arguments = [
        "equations",
        "clock.yaml",
        "--functions",
        "bias,jacobian(rod)",
    ];
    let (rust, _) = call(directory.path(), &[&arguments[..], &["--rust"]].concat(), 0);
    assert!(
        rust.contains("pub fn bias(") && rust.contains("pub fn jacobian_rod("),
        "{rust}"
    );
    let (c, _) = call(directory.path(), &[&arguments[..], &["--c"]].concat(), 0);
    assert!(c.contains("void clock_jacobian_rod(const clock_model *m, double t, const double y[], double results[]);"), "{c}");
    let wrong = ["equations", "clock.yaml", "--functions", "jacobian(rot)"];
    let (_, stderr) = call(directory.path(), &wrong, 2);
    assert!(
        stderr.contains("there is no frame \"rot\"") && stderr.contains("did you mean \"rod\"?"),
        "{stderr}"
    );
}

#[test]
fn equations_are_printed_in_three_languages() {
    let directory = directory();
    let (text, _) = call(directory.path(), &["equations", "clock.yaml"], 0);
    assert!(
        text.contains("S[1,1] = ") && text.contains("phi_rod") && text.contains("r_k[1] = "),
        "{text}"
    );
    let (latex, _) = call(directory.path(), &["equations", "clock.yaml", "--latex"], 0);
    assert!(
        latex.contains("\\begin{aligned}") && latex.contains("\\varphi_{\\mathrm{rod}}"),
        "{latex}"
    );
    let (rust, _) = call(directory.path(), &["equations", "clock.yaml", "--rust"], 0);
    assert!(rust.contains("pub fn mass_matrix"), "{rust}");
}

#[test]
fn nobody_need_read_to_the_end() {
    let directory = directory();
    for arguments in [
        vec!["run", "clock.yaml", "--no-files", "--every", "10 us"],
        vec!["equations", "clock.yaml", "--rust"],
        vec!["models"],
        vec!["--help"],
    ] {
        let mut child = bryant(directory.path())
            .args(&arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(!stderr.contains("panicked"), "{arguments:?}: {stderr}");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
    }
}

#[test]
fn help_has_examples_and_exit_codes() {
    let directory = directory();
    let (help, _) = call(directory.path(), &["--help"], 0);
    assert!(
        help.contains("Exit codes:") && help.contains("BRYANT_CACHE") && help.contains("Examples:")
    );
    for command in ["run", "check", "equations", "models"] {
        let (help, _) = call(directory.path(), &[command, "--help"], 0);
        assert!(help.contains("Examples:"), "{help}");
    }
    call(directory.path(), &["rum"], 2);
}

#[test]
fn effects_are_listed_with_what_they_cost() {
    let directory = directory();
    let (text, _) = call(directory.path(), &["effects", "clock.yaml", "--no-time"], 0);
    for line in [
        "field earth: z",
        "the reference joint is fixed (clock.yaml:8 reference: fixed)",
        "motion in the plane (clock.yaml:3 dimension: 2)",
        "parameter gravity",
        "with nothing left out",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    assert!(
        !text.contains("[ns]") && !text.contains("not mentioned"),
        "{text}"
    );

    // with timing, and few effects: the rest is the same
    let arguments = [
        "effects",
        "clock.yaml",
        "--json",
        "--only",
        "field earth: z",
    ];
    let effects = json(&call(directory.path(), &arguments, 0).0);
    let list = effects["effects"].as_array().unwrap();
    assert_eq!(list.len(), 1, "{effects}");
    let field = &list[0];
    assert_eq!(field["place"]["line"], 14);
    // without its weight the rod has no acceleration: 1 product and 1 sine less
    assert_eq!(
        (&field["operations"], &field["calls"]),
        (&1.into(), &1.into())
    );
    let positive = |value: &serde_json::Value| value.as_f64().unwrap() > 0.0;
    assert!(
        positive(&field["time_with_s"]) && positive(&field["time_without_s"]),
        "{field}"
    );
    let (scene, general) = (&effects["scene"], &effects["nothing_left_out"]);
    // interpreted equations have no code
    let keys = match scene["code_bytes"].is_null() {
        true => &["operations", "time_s"][..],
        false => &["operations", "time_s", "code_bytes"],
    };
    for key in keys {
        let [part, whole] = [scene, general].map(|v| v[key].as_f64().unwrap());
        assert!(part < whole, "{key}: {effects}");
    }
    assert!(effects["noise_s"].as_f64().unwrap() >= 0.0);
}

#[test]
fn a_parameter_that_changes_nothing_is_refused_with_the_reason() {
    let directory = directory();
    let text = PENDULUM.replace("    acceleration:", "    enabled: false\n    acceleration:");
    std::fs::write(directory.path().join("idle.yaml"), text).unwrap();
    let arguments = ["run", "idle.yaml", "--no-files", "--set", "gravity=1"];
    let (_, stderr) = call(directory.path(), &arguments, 2);
    assert!(
        stderr.contains(
            "\"gravity\" (idle.yaml:5) changes nothing: everything that it is used for is out"
        ),
        "{stderr}"
    );
}

/// Heun's method at ωh = √(m g l/J) h = 4.04 · 0.1 gains (ωh)⁴/4 = 0.7 % of energy in each step of a small swing.
#[test]
fn a_run_that_cannot_be_trusted_ends_with_3_and_says_why() {
    let directory = directory();
    let here = directory.path();
    let arguments = [
        "run",
        "clock.yaml",
        "--method",
        "heun",
        "--step",
        "100 ms",
        "--duration",
        "10 s",
        "--every",
        "100 ms",
        "--no-files",
    ];
    let (out, err) = call(here, &arguments, 3);
    // everything is printed, and then the run is doubted
    assert!(out.contains("10.0"), "{out}");
    for part in ["since t = ", "energy", "help:", "--tolerance"] {
        assert!(err.contains(part), "{part}: {err}");
    }
    let mut json_too = arguments.to_vec();
    json_too.push("--json");
    let (out, _) = call(here, &json_too, 3);
    let doubts = &json(&out)["doubts"];
    assert_eq!(doubts[0]["kind"], "energy", "{doubts}");
    assert!(doubts[0]["since_s"].as_f64().is_some(), "{doubts}");
    let mut allowed = arguments.to_vec();
    // the second run gives the same, and has an option of its own
    allowed.extend(["--energy-limit", "off"]);
    let (_, err) = call(here, &allowed, 3);
    assert!(err.contains("not as accurate as 10 %"), "{err}");
    allowed.push("--no-verify");
    call(here, &allowed, 0);
    // a finer step needs no allowance
    let mut finer = arguments.to_vec();
    finer[5] = "1 ms";
    call(here, &finer, 0);
}

/// A table of times alone says nothing: what to add is said in its place, and works as it is written.
#[test]
fn a_model_without_outputs_says_what_to_add() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let model = "model: m\ndimension: 2\nsystems:\n  - name: p\n    elements: [{ name: b, mass: 2 kg, cg: [0, 0], inertia: 0.1 }]\nrun: { duration: 0.5 s, every: 0.25 s }\n";
    std::fs::write(here.join("m.yaml"), model).unwrap();
    let (told, _) = call(here, &["run", "m.yaml", "--no-files"], 0);
    assert!(
        told.contains("the model has no outputs") && !told.contains("0.25"),
        "{told}"
    );
    let (_, added) = told.split_once("such as\n\n").unwrap();
    let (added, _) = added.split_once("\n\n").unwrap();
    std::fs::write(here.join("m.yaml"), format!("{model}{added}\n")).unwrap();
    let (told, _) = call(here, &["run", "m.yaml", "--no-files"], 0);
    assert!(told.contains("position") && told.contains("0.25"), "{told}");
    // a reference that is none of the words
    let wrong = model.replace("name: p\n", "name: p\n    reference: fixd\n");
    std::fs::write(here.join("m.yaml"), wrong).unwrap();
    let (_, told) = call(here, &["check", "m.yaml"], 2);
    assert!(
        told.contains("did you mean `fixed`?") && told.contains("on: VEHICLE"),
        "{told}"
    );
}

/// Of two elements of one name the second is told, and nothing that follows from it; what else is wrong is told, too.
#[test]
fn two_elements_of_one_name_are_one_error() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let model = "\
model: two
dimension: 2
systems:
  - name: man
    elements:
      - { name: torso, mass: 2 kg, cg: [0, 0], inertia: 0.1 }
      - { name: torso, on: torso, at: [0, 1], mass: 2 kg, cg: [0, 0], inertia: 0.1 }
      - { name: head, on: torso, at: [0, 1], mass: 2 kg, cg: [0, 0], inertia: 0.1 }
forces: [{ joint: man/torso, damping: 1 }]
outputs:
  - { name: x, of: man/torso, what: position, component: z }
  - { name: y, of: man/torsi, what: position, component: z }
run: { duration: 0.5 s, every: 0.25 s }
";
    std::fs::write(here.join("two.yaml"), model).unwrap();
    let (_, told) = call(here, &["check", "two.yaml"], 2);
    assert!(
        told.contains("two elements called \"torso\"") && told.contains("two.yaml:7:"),
        "{told}"
    );
    assert!(told.contains("no element \"man/torsi\""), "{told}");
    assert_eq!(told.matches("error:").count(), 2, "{told}");
}
