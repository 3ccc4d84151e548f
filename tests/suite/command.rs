//! The command from end to end, as a user calls it: models in files, compiled on demand; output, files, and failures.

mod animated;
mod bags;
mod called;
mod certification;
mod checked;
mod comparing;
mod continued;
mod degenerate;
mod formulas;
mod grazing;
mod judged;
mod last_screen;
#[cfg(unix)]
mod long;
mod meshes;
mod people;
mod pictures;
mod polarity;
mod remarks;
mod replacing;
mod reports;
mod responses;
mod resting;
mod scenes;
mod share;
mod slipping;
mod slopes;
mod stiff;
#[cfg(unix)]
mod streams;
mod sweep;
mod tables;
mod trust;
mod turning;
mod units;

use called::{bryant, call, expect};
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

const ARM: &str = r#"<robot name="two-arm">
<link name="base"/>
<link name="Upper Arm">
  <visual><geometry><mesh filename="arm.stl"/></geometry></visual>
  <inertial><origin xyz="0 0 -0.2"/><mass value="2"/><inertia ixx="0.03" ixy="0" ixz="0.001" iyy="0.03" iyz="0" izz="0.01"/></inertial>
</link>
<joint name="shoulder" type="revolute">
  <parent link="base"/><child link="Upper Arm"/><origin xyz="0 0 1" rpy="0 0 1.5708"/><axis xyz="0 1 0"/>
  <limit lower="-0.5" upper="0.5" effort="1" velocity="1"/>
</joint>
</robot>
"#;

#[test]
fn a_robot_is_imported_and_runs() {
    let directory = directory();
    std::fs::write(directory.path().join("arm.urdf"), ARM).unwrap();
    let (written, notes) = call(directory.path(), &["import", "arm.urdf"], 0);
    assert!(
        written.contains("name: upper_arm") && written.contains("# Imported from arm.urdf."),
        "{written}"
    );
    assert!(written.contains("mesh: { file: \"arm.stl\","), "{written}");
    for part in ["--stops", "--right-angles", "line 8"] {
        assert!(notes.contains(part), "{part}\n{notes}");
    }
    let (nothing, _) = call(
        directory.path(),
        &["import", "arm.urdf", "-o", "arm.yaml"],
        0,
    );
    assert!(nothing.is_empty());
    // and a line with the checksum of all lines above
    let kept = std::fs::read_to_string(directory.path().join("arm.yaml")).unwrap();
    let (above, last) = kept.trim_end().rsplit_once('\n').unwrap();
    assert_eq!(above.trim_end(), written.trim_end());
    assert!(last.starts_with("# Written by bryant"), "{last}");
    // the file and the model imported from it are one model
    let table = |model| call(directory.path(), &["run", model, "--no-files"], 0).0;
    assert_eq!(table("arm.urdf"), table("arm.yaml"));
    assert!(table("arm.urdf").contains("shoulder"));
    // whoever runs the file gets the notes of the import
    for command in ["run", "check"] {
        let (_, told) = call(directory.path(), &[command, "arm.urdf"], 0);
        for note in notes.lines() {
            assert!(told.contains(note), "{command}: {note}\n{told}");
        }
        let (_, told) = call(directory.path(), &[command, "arm.yaml"], 0);
        assert!(!told.contains("--stops"), "{command}: {told}");
    }
    // an error that only the model shows has its place in the file: a hinge that moves no inertia
    let flat = ARM.replace("0 0 -0.2", "0 0 0");
    let flat = ["0.03", "0.001", "0.01"]
        .into_iter()
        .fold(flat, |text, value| {
            text.replace(&format!("=\"{value}\""), "=\"0\"")
        });
    std::fs::write(directory.path().join("flat.urdf"), flat).unwrap();
    for command in ["import", "run", "check"] {
        let (_, wrong) = call(directory.path(), &[command, "flat.urdf"], 2);
        assert!(
            wrong.contains("without any inertia") && wrong.contains("flat.urdf:3:"),
            "{command}: {wrong}"
        );
    }
    // effects have the places of the links and joints
    let (effects, _) = call(directory.path(), &["effects", "arm.urdf", "--no-time"], 0);
    assert!(!effects.contains("arm.urdf:1 "), "{effects}");
    let (held, _) = call(
        directory.path(),
        &["import", "arm.urdf", "--stops", "1e5"],
        0,
    );
    assert!(
        held.contains("stop: { from: -0.5, to: 0.5, stiffness: 1e5 }"),
        "{held}"
    );
    let (_, wrong) = call(
        directory.path(),
        &["import", "arm.urdf", "--stops", "-1"],
        2,
    );
    assert!(wrong.contains("positive"), "{wrong}");
    std::fs::write(
        directory.path().join("wrong.urdf"),
        ARM.replace("0 1 0", "0 0 0"),
    )
    .unwrap();
    for command in ["import", "run", "check"] {
        let (_, wrong) = call(directory.path(), &[command, "wrong.urdf"], 2);
        assert!(
            wrong.contains("wrong.urdf:8:") && wrong.contains("help:"),
            "{wrong}"
        );
    }
}

#[test]
fn a_robot_is_known_by_the_content_of_its_file() {
    let directory = directory();
    let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text).unwrap();
    for name in ["arm.urdf", "ARM.URDF", "arm.xml", "arm.txt"] {
        write(name, ARM);
    }
    write("blank.urdf", &format!("\n {ARM}"));
    for command in [&["run", "--no-files"][..], &["equations"]] {
        let of = |name: &str| call(directory.path(), &[command, &[name]].concat(), 0).0;
        for name in ["ARM.URDF", "arm.xml", "arm.txt", "blank.urdf"] {
            assert_eq!(of(name), of("arm.urdf"), "{command:?} {name}");
        }
    }
    call(directory.path(), &["check", "ARM.URDF"], 0);
    // other encodings of XML: UTF-16 as PowerShell writes it, and ISO 8859-1 where the file says so
    let marked = format!("\u{feff}{ARM}");
    let utf16 = marked.encode_utf16().flat_map(u16::to_le_bytes);
    let latin = format!("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><!-- \u{fc} -->\n{ARM}");
    let latin = latin.chars().map(|c| c as u8);
    for (name, bytes) in [
        ("utf16.urdf", utf16.collect::<Vec<u8>>()),
        ("latin.urdf", latin.collect()),
    ] {
        std::fs::write(directory.path().join(name), bytes).unwrap();
        let run = |name| call(directory.path(), &["run", "--no-files", name], 0).0;
        assert_eq!(run(name), run("arm.urdf"), "{name}");
    }
    // what is no robot is named by what it is, in every command that takes a model
    write("pendulum.xml", "<mujoco model=\"pendulum\"/>");
    write("world.sdf", "<sdf version=\"1.7\"/>");
    for command in ["check", "run", "equations", "effects", "settle", "import"] {
        for (name, what) in [("pendulum.xml", "MJCF"), ("world.sdf", "SDF")] {
            let (_, wrong) = call(directory.path(), &[command, name], 2);
            assert!(
                wrong.contains(what) && wrong.contains("help:"),
                "{command}: {wrong}"
            );
        }
    }
    // a file of shapes alone is refused, and repaired on demand
    let start = ARM.find("  <inertial>").unwrap();
    let end = ARM.find("</inertial>").unwrap() + "</inertial>".len();
    write("shape.urdf", &[&ARM[..start], &ARM[end..]].concat());
    let (_, wrong) = call(directory.path(), &["check", "shape.urdf"], 2);
    assert!(wrong.contains("--repair-inertias"), "{wrong}");
    let import = [
        "import",
        "shape.urdf",
        "--repair-inertias",
        "-o",
        "shape.yaml",
    ];
    let (_, told) = call(directory.path(), &import, 0);
    assert_eq!(told.matches("repaired: ").count(), 2, "{told}");
    call(directory.path(), &["check", "shape.yaml"], 0);
}

#[test]
fn a_missing_compiler_is_named_with_the_remedy() {
    let directory = ball();
    let (_, stderr) = without_a_toolchain(directory.path(), &["run", "ball.yaml"], 1);
    assert!(
        stderr.contains("/nonexistent/rustc") && stderr.contains("RUSTC="),
        "{stderr}"
    );
    assert!(!directory.path().join("ball.csv").exists());
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

/// The example of the documentation page: its model and its function.
fn ball() -> tempfile::TempDir {
    let page = include_str!("../../docs/forces/user.md");
    let block = |language: &str| {
        let begin = format!("```{language}\n");
        let (_, rest) = page.split_once(&begin).expect("a block");
        rest.split("```").next().expect("its end").to_owned()
    };
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("ball.yaml"), block("yaml")).unwrap();
    std::fs::write(directory.path().join("drag.rs"), block("rust")).unwrap();
    directory
}

/// A ball in air lands before and below a ball without drag: v_t² = 2 m g/(ρ c_d A) = 134 m²/s².
#[test]
fn a_force_of_the_users_own_runs_from_its_page() {
    let directory = ball();
    let here = directory.path();
    let run = |arguments: &[&str]| {
        let arguments = [&["run", "ball.yaml", "--no-files", "--json"], arguments].concat();
        let (out, _) = call(here, &arguments, 0);
        json(&out)["rows"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers)
            .collect::<Vec<_>>()
    };
    let (drawn, free) = (run(&[]), run(&["--set", "cd=0"]));
    let last = |rows: &[Vec<f64>]| rows[rows.len() - 1].clone();
    // without drag x = 20 t, z = 15 t − g t²/2, within the tolerance of the run
    let (g, t) = (9.80665, 3.0);
    let [time, x, z, drag] = last(&free)[..] else {
        panic!("{free:?}")
    };
    assert!(time == t && drag == 0.0);
    assert!((x - 20.0 * t).abs() < 1e-3 && (z - (15.0 * t - g * t * t / 2.0)).abs() < 1e-3);
    // with drag, by steps of a tenth of a millisecond of the midpoint rule, whose error is below 1e-6 here
    let k = 0.5 * 1.2 * 0.47 * 13e-4 / 0.05;
    let (mut p, mut v, h) = ([0.0, 0.0], [20.0f64, 15.0], 1e-4);
    let rate = |v: [f64; 2]| {
        let speed = v[0].hypot(v[1]);
        [-k * speed * v[0], -k * speed * v[1] - g]
    };
    for _ in 0..30_000 {
        let a = rate(v);
        let middle = [v[0] + h / 2.0 * a[0], v[1] + h / 2.0 * a[1]];
        let a = rate(middle);
        for i in 0..2 {
            p[i] += h * middle[i];
            v[i] += h * a[i];
        }
    }
    let [_, x, z, drag] = last(&drawn)[..] else {
        panic!("{drawn:?}")
    };
    assert!(
        (x - p[0]).abs() < 1e-3 && (z - p[1]).abs() < 1e-3,
        "{x} {z} {p:?}"
    );
    let expected = 0.05 * k * (v[0] * v[0] + v[1] * v[1]);
    assert!(
        (drag - expected).abs() < 1e-4 * expected,
        "{drag} {expected}"
    );
}

#[test]
fn what_the_compiler_finds_in_a_function_is_shown_in_its_file() {
    let directory = ball();
    let file = directory.path().join("drag.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("* speed;", "* sped;")).unwrap();
    let (_, err) = call(directory.path(), &["run", "ball.yaml", "--no-files"], 2);
    assert!(err.contains("drag.rs:6:"), "{err}");
    assert!(err.contains("cannot find value `sped`"), "{err}");
    assert!(err.contains("similar name exists: `speed`"), "{err}");
    assert!(!err.contains("fault of bryant"), "{err}");

    // the example of the page
    std::fs::write(
        &file,
        text.replace("points.centre.velocity", "points.center.velocity"),
    )
    .unwrap();
    let (_, err) = call(directory.path(), &["check", "ball.yaml"], 2);
    let page = include_str!("../../docs/forces/user.md");
    assert!(page.contains(err.trim()), "{err}");
}

#[test]
fn a_changed_function_is_compiled_again() {
    let directory = ball();
    let drag = || {
        let (out, _) = call(
            directory.path(),
            &["run", "ball.yaml", "--no-files", "--json"],
            0,
        );
        numbers(&json(&out)["rows"][0])[3]
    };
    let before = drag();
    let file = directory.path().join("drag.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("-0.5", "-1.0")).unwrap();
    let after = drag();
    // the compiler may fuse other operations of the changed text
    assert!(
        (after / (2.0 * before) - 1.0).abs() < 1e-12,
        "{after} after {before}"
    );
}

#[test]
fn a_skeleton_is_a_function_that_compiles_and_does_nothing() {
    let directory = ball();
    let here = directory.path();
    std::fs::remove_file(here.join("drag.rs")).unwrap();
    let (_, err) = call(here, &["run", "ball.yaml"], 2);
    assert!(err.contains("there is no file \"drag.rs\""), "{err}");
    let (out, _) = call(here, &["check", "ball.yaml", "--skeleton", "air"], 0);
    std::fs::write(here.join("drag.rs"), &out).unwrap();
    let (out, _) = call(here, &["run", "ball.yaml", "--no-files", "--json"], 0);
    let rows = json(&out)["rows"].as_array().unwrap().clone();
    assert!(rows.iter().all(|row| numbers(row)[3] == 0.0), "{out}");
    let (_, err) = call(here, &["check", "ball.yaml", "--skeleton", "ait"], 2);
    assert!(err.contains("did you mean \"air\"?"), "{err}");
}

/// r_k of a ball of 50 g is its weight and −½ ρ c_d A |v| v, r_s is 0, and S v̇ = r_k.
#[test]
fn equations_at_a_state_have_the_functions_of_the_user() {
    let directory = ball();
    let here = directory.path();
    let state = |vx: f64, vz: f64| {
        let state = format!("{{\"q\": [0, 2, 0.3], \"v\": [{vx}, {vz}, 0]}}");
        std::fs::write(here.join("state.json"), state).unwrap();
    };
    let at = |cd: &str| {
        let arguments = [
            "equations",
            "ball.yaml",
            "--at",
            "state.json",
            "--json",
            "--set",
            cd,
        ];
        json(&call(here, &arguments, 0).0)
    };
    let (vx, vz) = (12.0, -5.0);
    state(vx, vz);
    for cd in [0.0, 0.47, 1.5] {
        let found = at(&format!("cd={cd}"));
        let factor = -0.5 * 1.2 * cd * 13e-4 * 13.0;
        let expected = [factor * vx, factor * vz - 0.05 * 9.80665, 0.0];
        let (force, rate) = (numbers(&found["r_k"]), numbers(&found["acceleration"]));
        for i in 0..3 {
            assert!((force[i] - expected[i]).abs() < 1e-12, "{found}");
        }
        for i in 0..2 {
            assert!((0.05 * rate[i] - expected[i]).abs() < 1e-12, "{found}");
        }
    }
    // as a table
    let (out, _) = call(here, &["equations", "ball.yaml", "--at", "state.json"], 0);
    assert!(out.contains("ball.vx"), "{out}");
    // a function that panics reports the place
    let file = here.join("drag.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    let panics = text.replace(
        "let mut output",
        "panic!(\"no air\");\n    #[allow(unreachable_code)]\n    let mut output",
    );
    assert_ne!(panics, text);
    std::fs::write(&file, panics).unwrap();
    let arguments = ["equations", "ball.yaml", "--at", "state.json"];
    let (_, err) = call(here, &arguments, 3);
    assert!(
        err.contains("panicked: no air") && err.contains("drag.rs:"),
        "{err}"
    );
}

#[test]
fn what_only_a_crate_can_call_is_said() {
    let directory = ball();
    let here = directory.path();
    let (out, _) = call(here, &["equations", "ball.yaml"], 0);
    assert!(out.contains("drag_returns_centre_force_x(t, "), "{out}");

    let model = std::fs::read_to_string(here.join("ball.yaml")).unwrap();
    let lines = model.lines().filter(|line| !line.contains("source:"));
    let lines: Vec<&str> = lines.collect();
    let model = lines
        .join("\n")
        .replace("function: drag ", "function: crate::aero::drag ");
    std::fs::write(here.join("ball.yaml"), model).unwrap();
    let (out, _) = call(here, &["check", "ball.yaml"], 0);
    assert!(out.contains("user        air"), "{out}");
    let (_, err) = call(here, &["run", "ball.yaml"], 2);
    assert!(
        err.contains("calls crate::aero::drag") && err.contains("source: FILE.rs"),
        "{err}"
    );
}

/// Arguments for a study of the clock: few points, one repetition, and so much time that a pause of a busy machine does not make a point
/// look too slow to run.
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

/// The lines of a diagram with their numbers of points, and its legend: the parts that do not depend on times.
fn structure(svg: &str) -> Vec<String> {
    let mut parts: Vec<String> = svg
        .lines()
        .filter_map(|line| {
            let class = line.strip_prefix("<polyline class=\"line")?;
            let (class, points) = class.split_once("\" points=\"")?;
            Some(format!("{class}: {}", points.matches(',').count()))
        })
        .collect();
    // the legend has a column of its own, to the right of the frame
    let legend = svg.lines().filter(|line| line.contains(" x=\"748\" "));
    parts.extend(legend.filter_map(|line| Some(line.split_once('>')?.1.to_owned())));
    parts
}

/// θ̈ = −κ sin θ swings at ω = √κ, κ = m g l/J = 2·9.81·0.5/0.6: a step that errs by the tolerance changes the end of a run of T = 1 s by
/// at most (1 + ωT) times as much.
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

    // the reference is the closed form; the computed solution agrees with it up to the rounding of its constants
    let epsilon = f64::EPSILON;
    let phase = (2.0 * 9.81 * 0.5f64 / 0.6).sqrt();
    let closed = &study["reference"]["closed_form"];
    assert!(
        closed["name"].as_str().unwrap().contains("pendulum"),
        "{closed}"
    );
    let difference = closed["difference"].as_f64().unwrap();
    assert!(
        difference < (16.0 + 16.0 * phase) * epsilon,
        "{difference:e}"
    );

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

    // the file has the same numbers, and the settings that they were computed with (serde_json reads a number to within a unit in the last
    // place)
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
            ("operations", "operations"),
            ("largest step [s]", "largest_step_s"),
        ] {
            let text = cell(row, column);
            assert!(same(text.clone(), &point[key]), "{column}: {text}, {point}");
        }
        let swing = &point["readings"]["peak swing"]["error"];
        assert!(same(cell(row, "error in peak swing"), swing));
        assert_eq!(cell(row, "method"), point["method"].as_str().unwrap());
        assert_eq!(cell(row, "model digest"), study["digest"].as_str().unwrap());
        for column in ["bryant", "commit", "engine", "target", "CPU features"] {
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
        page.contains("bryant accuracy clock.yaml --methods rk4,dop853"),
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

/// A body on a joint, with a force on it or without.
fn on_a_joint(joint: &str, force: &str) -> String {
    format!(
        "model: several
dimension: 3
systems:
  - name: arm
    reference: fixed
    elements: [{{ name: hand, mass: 2 kg, cg: [0.1, 0.2, 0.3], inertia: [0.1, 0.2, 0.25], joint: {joint} }}]
forces: [{{ field: earth, acceleration: [0, 0, -9.81] }}{force}]
run: {{ duration: 1 s, every: 0.1 s }}
"
    )
}

#[test]
fn a_start_in_a_singular_position_of_a_joint_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let three = "[ { hinge: z }, { hinge: y }, { hinge: x } ]";
    let text = on_a_joint(three, "");
    let with = |angle: &str| {
        let start = format!("start: {{ joints: {{ hand: [0 deg, {angle}, 0 deg] }} }}\nforces");
        text.replace("forces", &format!("    {start}"))
    };
    let run = |angle: &str, code: i32| {
        std::fs::write(directory.path().join("several.yaml"), with(angle)).unwrap();
        call(
            directory.path(),
            &["run", "several.yaml", "--no-files"],
            code,
        )
        .1
    };
    for angle in ["90 deg", "-90 deg", "89.99999999 deg"] {
        let told = run(angle, 3);
        assert!(
            told.contains("the joint of \"arm/hand\" is in, or close to, a singular position")
                && told.contains("there angle-z and angle-x move the element alike"),
            "{told}"
        );
    }
    // the run can continue away from there
    run("60 deg", 0);
    // where rounding alone says how it leaves such a position, it is not trusted
    let euler = "[ { hinge: z, name: a }, { hinge: x, name: b }, { hinge: z, name: c } ]";
    let start = "    start: { joints: { hand: [0, 180 deg, 0] } }\nforces";
    let text = on_a_joint(euler, "").replace("forces", start);
    let run = |text: String, code: i32| {
        std::fs::write(directory.path().join("several.yaml"), text).unwrap();
        let arguments = ["run", "several.yaml", "--no-files", "--no-verify"];
        call(directory.path(), &arguments, code).1
    };
    let told = run(text.clone(), 3);
    assert!(
        told.contains("at the start the joint of \"arm/hand\" is in a singular position")
            && told.contains("there a and c move the element alike"),
        "{told}"
    );
    // a rotor keeps the mass matrix regular
    run(text.replace("name: c", "name: c, armature: 0.05"), 0);
}

#[test]
fn check_warns_of_singular_positions_of_a_joint() {
    let three = "[ { hinge: z }, { hinge: y }, { hinge: x } ]";
    let stop = |to: &str| {
        format!(
            ", {{ joint: arm/hand, freedom: angle-y, stop: {{ from: -{to}, to: {to}, stiffness: 100 }} }}"
        )
    };
    let tilted = "[ { hinge: z }, { hinge: [0, 1, 1], name: tilt }, { hinge: x } ]";
    let polar = "[ { hinge: z, name: first }, { slider: x }, { hinge: z, name: last } ]";
    for (joint, force, told) in [
        (
            three,
            "",
            Some(
                "is singular at angle-y = -90° or 90°: there angle-z and angle-x move the element alike",
            ),
        ),
        (
            "free",
            "",
            Some("angle-y = -90° or 90°: there angle-x and angle-z move"),
        ),
        (
            three,
            &stop("85 deg"),
            Some("comes within 10° of angle-y = -90° or 90°, where it is singular"),
        ),
        (three, &stop("79 deg"), None),
        // a.(b x c) = 0 if the axis of the last joint lies in the plane of the others
        (tilted, "", Some("is singular at tilt = -90° or 90°")),
        (
            polar,
            "",
            Some("is singular at position-x = 0 mm: there first and last move"),
        ),
        (
            "[ { hinge: z, name: a, armature: 0.1 }, { hinge: x, name: b }, { hinge: z, name: c } ]",
            "",
            None,
        ),
        (
            "[ { hinge: x, name: a }, { hinge: [1, 1e-5, 0], name: b } ]",
            "",
            Some("the axes of a and b of \"arm/hand\" are only 6e-4° apart"),
        ),
        (
            "[ { slider: z, name: a }, { slider: [0.02, 0, -1], name: b } ]",
            "",
            Some("are only 1.1° apart"),
        ),
        (
            "[ { hinge: x, name: a }, { hinge: [1, 0.05, 0], name: b } ]",
            "",
            None,
        ),
        (
            "[ { hinge: x, name: a }, { slider: [1, 1e-5, 0], name: b } ]",
            "",
            None,
        ),
        ("{ universal: [x, y] }", "", None),
        ("{ cylinder: z }", "", None),
        ("{ planar: z }", "", None),
        ("translation", "", None),
        ("{ hinge: x }", "", None),
    ] {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(
            directory.path().join("several.yaml"),
            on_a_joint(joint, force),
        )
        .unwrap();
        let (_, stderr) = call(directory.path(), &["check", "several.yaml"], 0);
        match told {
            Some(told) => assert!(stderr.contains(told), "{joint}: {stderr}"),
            None => assert!(
                !stderr.contains("singular") && !stderr.contains("apart"),
                "{joint}: {stderr}"
            ),
        }
    }
}

#[test]
fn an_axis_of_parameters_needs_a_direction() {
    let directory = tempfile::tempdir().unwrap();
    let scene = on_a_joint("{ hinge: [a, 0, b] }", "")
        .replace("dimension: 3", "dimension: 3\nparameters: { a: 1, b: 1 }");
    std::fs::write(directory.path().join("axis.yaml"), scene).unwrap();
    let run = |set: [&str; 2], code: i32| {
        let arguments = [
            "run",
            "axis.yaml",
            "--no-files",
            "--set",
            set[0],
            "--set",
            set[1],
        ];
        call(directory.path(), &arguments, code).1
    };
    // squares that overflow, vanish, or keep few digits; no direction; no number
    for set in [
        ["a=1e200", "b=1"],
        ["a=1e-200", "b=0"],
        ["a=1e-162", "b=0"],
        ["a=0", "b=0"],
    ] {
        let told = run(set, 2);
        assert!(
            told.contains("`joint` of arm/hand must have an axis with a direction"),
            "{set:?}: {told}"
        );
    }
    for set in [["a=1e100", "b=1"], ["a=1e-100", "b=0"], ["a=0", "b=-3"]] {
        run(set, 0);
    }
}

#[test]
fn a_freedom_without_inertia_has_the_remedy_that_helps() {
    let twice = on_a_joint("[ { hinge: z, name: a }, { hinge: z, name: b } ]", "");
    let light = on_a_joint("{ hinge: z }", "").replace(
        "cg: [0.1, 0.2, 0.3], inertia: [0.1, 0.2, 0.25]",
        "cg: [0, 0, 0.3], inertia: [0.1, 0.1, 0]",
    );
    for (scene, help) in [
        (twice, "whatever its mass: remove one of them"),
        (
            light,
            "give what it carries mass or moments of inertia there",
        ),
    ] {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("several.yaml"), scene).unwrap();
        let (_, stderr) = call(directory.path(), &["check", "several.yaml"], 2);
        assert!(
            stderr.contains("without any inertia") && stderr.contains(help),
            "{stderr}"
        );
    }
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
