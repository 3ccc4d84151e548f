//! Runs without a result, or with one that cannot be trusted, have the reason in every table, and it is that of `bryant
//! run`.

use super::folder::Table;
use crate::command_call::{bryant, call};
use bryant_runtime::Width;
use std::path::Path;

/// A body on a bending joint. With J = 1 and an elastic moment of 1 N m/rad, a rotation faster than π rad/s about a
/// fixed axis takes it through 180°, where flexion has no direction.
const BENDS: &str = "\
model: bends
dimension: 3
parameters: { rate: 1 rad/s, tilt: 0 rad/s, spin: 0 rad/s, damping: { value: 0 } }
curves: { half: { points: [[0, 0], [180 deg, 3.141592653589793]], extrapolate: linear } }
systems:
  - name: top
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
    start: { rates: { body: [tilt, rate, spin] } }
forces:
  - { joint: top/body, axis: z, flexion: { elastic: half, damping: damping } }
outputs:
  - { name: torque, of: joint top/body, what: torque, about: flexion }
run: { duration: 5 s, every: 10 ms }
";

/// tilt, rate, spin, and the end of the run.
const ROWS: [([f64; 3], &str); 9] = [
    ([0.0, 3.2, 0.0], "doubtful"),
    ([3.2, 0.0, 0.0], "doubtful"),
    ([2.0, 3.0, 0.0], "doubtful"),
    ([0.0, 12.0, 0.0], "doubtful"),
    // ½ J ω² < ½ k π²: it turns back before 180°
    ([0.0, 3.1, 0.0], "done"),
    ([2.0, 2.3, 0.0], "done"),
    // it passes beside 180°
    ([0.0, 3.2, 0.6], "done"),
    ([0.3, 3.2, 0.6], "done"),
    ([0.0, 0.0, 0.0], "done"),
];

fn study(run: &str) -> String {
    let row = |([tilt, rate, spin], _): &([f64; 3], &str)| {
        format!("  - {{ tilt: {tilt}, rate: {rate}, spin: {spin}, damping: 0 }}\n")
    };
    let rows: String = ROWS.iter().map(row).collect();
    format!(
        "model: bends.yaml\ndesign: list\nrows:\n{rows}  - {{ tilt: 0, rate: 1, spin: 0, damping: -0.1 }}\n\
         run: {{ {run} }}\nresponses: [{{ of: torque, what: peak }}]\ntables: [csv, parquet]\n"
    )
}

fn swept(at: &Path, run: &str, lanes: &str) -> (Table, String) {
    std::fs::write(at.join("bends.yaml"), BENDS).unwrap();
    std::fs::write(at.join("study.yaml"), study(run)).unwrap();
    let out = format!("{}-{lanes}", run.len());
    let (stdout, _) = call(
        at,
        &["sweep", "study.yaml", "--out", &out, "--lanes", lanes],
        0,
    );
    (Table::read(&at.join(out).join("results.csv")), stdout)
}

#[test]
fn every_row_without_a_result_says_why() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    let widths = Width::ALL.into_iter().filter(|width| width.is_available());
    for width in widths {
        for run in ["sampling: 10 ms", "sampling: 10 ms, step: 5 ms"] {
            let (table, stdout) = swept(at, run, width.name());
            let (statuses, reasons) = (table.words("status"), table.words("reason"));
            let peaks = table.words("peak of torque [N*m]");
            for (row, (given, ends)) in ROWS.iter().enumerate() {
                assert_eq!(statuses[row], *ends, "{given:?} {run} {}", width.name());
                let said = reasons[row].contains("\"joint top/body\" is bent through 180°");
                assert_eq!(
                    (said, peaks[row].is_empty()),
                    (*ends == "doubtful", *ends == "doubtful")
                );
                assert_eq!(reasons[row].is_empty(), *ends == "done");
            }
            assert_eq!(statuses[ROWS.len()], "refused");
            assert!(reasons[ROWS.len()].contains("damping"), "{reasons:?}");
            assert!(
                stdout.contains("4 because \"joint top/body\" is bent"),
                "{stdout}"
            );
        }
    }
    let summary = std::fs::read_to_string(at.join("15-1/summary.json")).unwrap();
    assert!(summary.contains("is bent through 180°") && summary.contains("\"reasons\""));
    let parquet = std::fs::read(at.join("15-1/results.parquet")).unwrap();
    let words = "is bent through 180°".as_bytes();
    assert!(parquet.windows(words.len()).any(|at| at == words));
}

#[test]
fn lanes_tell_what_single_runs_tell() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("bends.yaml"), BENDS).unwrap();
    for ([tilt, rate, spin], ends) in ROWS {
        let set = [("tilt", tilt), ("rate", rate), ("spin", spin)];
        let set = set.map(|(name, value)| format!("--set={name}={value}"));
        let mut command = bryant(at);
        command
            .args(["run", "bends.yaml", "--no-files", "--no-verify"])
            .args(&set);
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).contains("is bent through 180°");
        let code = if said { 3 } else { 0 };
        assert_eq!(
            (said, output.status.code()),
            (ends == "doubtful", Some(code)),
            "{output:?}"
        );
        // the same by dual numbers in lanes
        let mut command = bryant(at);
        command.args([
            "gradient",
            "bends.yaml",
            "--of",
            "mean of torque",
            "--wrt",
            "rate",
        ]);
        let output = command.args(&set).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).contains("is bent through 180°");
        assert_eq!(
            (told, output.status.code() == Some(3)),
            (said, said),
            "{set:?} {output:?}"
        );
    }
}

/// A ball that flies at another one, in fixed steps of 1 ms, which are longer than a fast ball needs to fly through.
#[test]
fn fixed_steps_that_go_over_something_are_told() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/hard/scenes/bullet.yaml");
    std::fs::copy(scene, at.join("bullet.yaml")).unwrap();
    // steps of some millimetres see the contact; steps of 0.1 m to 0.4 m do not: neither their ends nor their middles
    // are within 20 mm of the target
    let (slow, fast) = ([2.0, 1.7, 2.5], [129.0, 230.0, 370.0, 417.9]);
    let row = |speed: &f64| format!("{{ speed: {speed}, stiffness: 1e4 }}");
    let rows: Vec<String> = slow.iter().chain(&fast).map(row).collect();
    let study = format!(
        "model: bullet.yaml\ndesign: list\nrows: [{}]\nrun: {{ duration: 1 s, step: 1 ms, method: rk4 }}\n\
         responses: [{{ of: speed, what: final }}]\ntables: [csv]\n",
        rows.join(", ")
    );
    std::fs::write(at.join("study.yaml"), study).unwrap();
    let widths = Width::ALL.into_iter().filter(|width| width.is_available());
    for width in widths {
        let folder = format!("missed-{}", width.name());
        let lanes = ["--out", &folder, "--lanes", width.name()];
        call(at, &[&["sweep", "study.yaml"][..], &lanes].concat(), 0);
        let table = Table::read(&at.join(folder).join("results.csv"));
        let (statuses, reasons) = (table.words("status"), table.words("reason"));
        for row in 0..slow.len() + fast.len() {
            let (status, reason) = (&statuses[row], &reasons[row]);
            let missed = row >= slow.len();
            assert_eq!(*status == "doubtful", missed, "{row}: {status} {reason}");
            assert_eq!(
                reason.contains("passed over") && reason.contains("hit"),
                missed
            );
        }
    }
}

/// Two balls that fly through each other, or past each other.
const THROUGH: &str = "\
model: through
dimension: 3
parameters: { offset: 0 m }
systems:
  - name: ball
    elements: [{ name: body, mass: 10 g, cg: [0, 0, 0], inertia: [1e-6, 1e-6, 1e-6] }]
    start: { position: [-1, offset, 0], velocity: [200, 0, 0] }
  - name: target
    elements: [{ name: body, mass: 10 g, cg: [0, 0, 0], inertia: [1e-6, 1e-6, 1e-6] }]
forces:
  - contact: hit
    ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [10 mm, 10 mm, 10 mm] }
    with: { on: target/body, center: [0, 0, 0], semi_axes: [10 mm, 8 mm, 10 mm] }
    elastic: { points: [[0, 0], [10 mm, 1]], extrapolate: linear }
outputs: [{ name: speed, of: target/body, what: velocity, component: x }]
run: { duration: 20 ms, every: 1 ms }
";

#[test]
fn ellipsoids_that_sink_through_each_other_are_told_in_lanes() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("through.yaml"), THROUGH).unwrap();
    let study = |run: &str| {
        format!(
            "model: through.yaml\ndesign: list\nrows: [{{ offset: 0 }}, {{ offset: 1e-3 }}, {{ offset: -5e-3 }}, {{ offset: 0.03 }}]\n\
             {run}responses: [{{ of: speed, what: final }}]\ntables: [csv]\n"
        )
    };
    let widths = Width::ALL.into_iter().filter(|width| width.is_available());
    for width in widths {
        for run in ["", "run: { step: 10 us, method: rk4 }\n"] {
            std::fs::write(at.join("study.yaml"), study(run)).unwrap();
            let folder = format!("through-{}-{}", width.name(), run.len());
            let lanes = ["--out", &folder, "--lanes", width.name()];
            call(at, &[&["sweep", "study.yaml"][..], &lanes].concat(), 0);
            let table = Table::read(&at.join(folder).join("results.csv"));
            let statuses = table.words("status");
            assert_eq!(statuses, ["doubtful", "done", "done", "done"], "{run}");
            let reason = &table.words("reason")[0];
            assert!(
                reason.contains("\"contact hit\" have sunk into each other"),
                "{reason}"
            );
        }
    }
}

/// A wheel that swings at ω = √(k/J) for ever, so that no method may take longer steps than the motion asks for. With J
/// = 10⁻⁹ kg m² and k = 1000 N m/rad that is 10⁶ 1/s, and a million steps are over within the run.
const SWINGS_ON: &str = "\
model: swing
dimension: 2
parameters: { spring: 1000 N*m/rad }
systems:
  - name: wheel
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1e-9 }]
    start: { rates: { body: 1e3 } }
forces:
  - { joint: wheel/body, stiffness: spring }
outputs: [{ name: angle, of: joint wheel/body, what: angle }]
run: { duration: 10 s, every: 0.1 s }
";

#[test]
fn rows_that_swing_fast_say_what_bounds_their_steps() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("swing.yaml"), SWINGS_ON).unwrap();
    let study = "model: swing.yaml\ndesign: list\nrows: [{ spring: 1000 }, { spring: 1e-9 }]\nresponses: [{ of: angle, what: final }]\n\
                 tables: [csv]\n";
    std::fs::write(at.join("study.yaml"), study).unwrap();
    let (stdout, stderr) = call(at, &["sweep", "study.yaml", "--out", "out"], 0);
    let why = "1 because the limit of 1000000 steps is reached, with steps of some 100 ns at the time reached";
    assert!(stdout.contains(why), "{stdout}");
    // √(k/J), and steps of 0.1 to 1 of its inverse
    let fastest = "the fastest motion reaches about 1000000 1/s";
    let force = "most in \"wheel/body.omega\", by \"joint wheel/body: elastic\"";
    let said = stderr.contains("the run with spring = 1000 is at t = ");
    assert!(
        said && stderr.contains(fastest) && stderr.contains(force),
        "{stderr}"
    );
    assert_eq!(stderr.matches("the run with").count(), 1, "{stderr}");
    let table = Table::read(&at.join("out/results.csv"));
    assert_eq!(table.words("status"), ["too-many-steps", "done"]);
}

#[test]
fn rows_that_take_too_long_are_given_up_and_run_again() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    // ω of one row is 10⁶ 1/s, that of the other 1 1/s
    std::fs::write(at.join("swing.yaml"), SWINGS_ON).unwrap();
    let study = "model: swing.yaml\ndesign: list\nrows: [{ spring: 1e-9 }, { spring: 1000 }]\nresponses: [{ of: angle, what: final }]\n\
                 tables: [csv]\n";
    std::fs::write(at.join("study.yaml"), study).unwrap();
    let sweep = ["sweep", "study.yaml", "--out", "out"];
    let table = || Table::read(&at.join("out/results.csv"));
    let said = |stderr: &str| {
        let given_up = "1 run was given up because computing takes too long: run 1";
        assert!(stderr.contains(given_up), "{stderr}");
    };
    // of a million steps, which take seconds
    let limited = [&sweep[..], &["--time-limit", "50 ms"]].concat();
    let (stdout, stderr) = call(at, &limited, 3);
    said(&stderr);
    assert!(
        stdout.contains("1 because its computation takes longer than 50 ms"),
        "{stdout}"
    );
    assert!(
        stderr.contains("the run with spring = 1000 is at t = "),
        "{stderr}"
    );
    assert!(
        stderr.contains("by \"joint wheel/body: elastic\""),
        "{stderr}"
    );
    assert_eq!(table().words("status"), ["done", "slow"]);
    let (_, stderr) = call(at, &["merge", "out"], 3);
    said(&stderr);
    let summary = std::fs::read_to_string(at.join("out/summary.json")).unwrap();
    assert!(summary.contains("\"slow\""), "{summary}");
    // with the usual time limit it ends in another way
    call(at, &sweep, 0);
    assert_eq!(table().words("status"), ["done", "too-many-steps"]);
    // a derivative is given up, too
    let gradient = [
        "gradient",
        "swing.yaml",
        "--of",
        "final angle",
        "--wrt",
        "spring",
        "--time-limit",
        "50 ms",
    ];
    let (_, stderr) = call(at, &gradient, 3);
    assert!(
        stderr.contains("takes longer than --time-limit"),
        "{stderr}"
    );
}

/// A ball that falls on a plate whose curve ends at 50 mm, as in tests/suite/trust/doubts.rs.
const SINKS: &str = "\
model: sinks
dimension: 2
parameters: { mass: 5 kg, extent: 100 m, speed: 1 m/s }
systems:
  - name: man
    elements: [{ name: ball, mass: mass, cg: [0, 0], inertia: 0.02 }]
    start: { position: [0, 0.3], velocity: [speed, 0] }
forces:
  - { field: g, acceleration: [0, -1 gn] }
  - contact: shelf
    ellipsoid: { on: man/ball, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1], extent: extent }
    elastic: { points: [[0, 0], [0.02, 1000], [0.05, 5000]], extrapolate: linear }
outputs: [{ name: z, of: man/ball, what: position, component: z }]
run: { duration: 0.6 s, every: 0.1 s }
";

#[test]
fn curves_that_are_left_too_far_are_told_in_lanes() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("sinks.yaml"), SINKS).unwrap();
    // a heavy ball with ½ k x² goes far beyond twice the curve; a light one turns within it; beside the plate nothing
    // acts
    let rows = [
        (500.0, 100.0, true),
        (5.0, 100.0, false),
        (500.0, 0.2, false),
    ];
    let listed = rows.map(|(mass, extent, _)| format!("{{ mass: {mass}, extent: {extent} }}"));
    for (k, run) in ["sampling: 1 ms", "step: 0.2 ms"].into_iter().enumerate() {
        let study = format!(
            "model: sinks.yaml\ndesign: list\nrows: [{}]\nrun: {{ {run} }}\nresponses: [{{ of: z, what: minimum }}]\ntables: [csv]\n",
            listed.join(", ")
        );
        std::fs::write(at.join("study.yaml"), study).unwrap();
        let out = format!("sinks-{k}");
        call(at, &["sweep", "study.yaml", "--out", &out], 0);
        let table = Table::read(&at.join(out).join("results.csv"));
        let (statuses, reasons) = (table.words("status"), table.words("reason"));
        for (row, (mass, _, left)) in rows.iter().enumerate() {
            assert_eq!(statuses[row] == "doubtful", *left, "{mass} kg, {run}");
            let said = reasons[row]
                .contains("the argument of the curve \"contact shelf: curve\" is so far outside");
            assert_eq!(said, *left, "{}", reasons[row]);
        }
    }
    for (mass, code) in [("500", 3), ("5", 0)] {
        let mass = format!("mass={mass}");
        let arguments = [
            "gradient",
            "sinks.yaml",
            "--of",
            "minimum of z",
            "--wrt",
            "speed",
        ];
        let arguments = [&arguments[..], &["--set", &mass]].concat();
        let (_, stderr) = call(at, &arguments, code);
        assert_eq!(stderr.contains("is so far outside"), code == 3, "{stderr}");
    }
}

/// φ̈ = −φ from φ(0) = a: at 20 s it is a cos 20. The tolerance allows an error of a micrometre.
const SMALL: &str = "\
model: small
dimension: 2
parameters: { size: 1 rad }
systems:
  - name: swing
    reference: fixed
    elements: [{ name: body, mass: 1 kg, cg: [0, 0], inertia: 1 }]
    start: { angles: { body: size } }
forces: [{ joint: swing/body, elastic: { points: [[-1, -1], [1, 1]], extrapolate: linear } }]
outputs: [{ name: angle, of: swing/body, what: angle }]
run: { duration: 20 s, every: 0.1 s }
";

#[test]
fn inaccurate_rows_are_run_again_or_reported() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("small.yaml"), SMALL).unwrap();
    let sizes = [1.0, 1e-3, 1e-5, 1e-6, 1e-13];
    let rows = sizes.map(|size| format!("{{ size: {size:e} }}"));
    let study = format!(
        "model: small.yaml\ndesign: list\nrows: [{}]\nresponses: [{{ of: angle, what: final }}]\ntables: [csv]\n",
        rows.join(", ")
    );
    std::fs::write(at.join("study.yaml"), study).unwrap();
    let (stdout, _) = call(at, &["sweep", "study.yaml", "--out", "out"], 0);
    let table = Table::read(&at.join("out/results.csv"));
    let found = table.numbers("final of angle [rad]");
    let errors = table.numbers("error estimate");
    let reasons = table.words("reason");
    let mut again = 0;
    for (row, size) in sizes.iter().enumerate() {
        let away = (found[row] / (size * 20f64.cos()) - 1.0).abs();
        let good = errors[row] <= 1e-3;
        // a row with a good estimate is accurate, with a margin for the estimate; another row has a reason
        assert!(!good || away < 3e-3, "{size}: {away} {}", errors[row]);
        assert_eq!(good, !reasons[row].contains("is above"), "{}", reasons[row]);
        again += usize::from(reasons[row].contains("this is the result at"));
    }
    assert!(errors[0] <= 1e-3 && reasons[0].is_empty(), "{reasons:?}");
    assert!(again >= 2 && errors[2] <= 1e-3, "{reasons:?}");
    // a tenth of a picometre is below all tolerances, but accelerations are relative to the largest
    assert!(errors[4] <= 1e-3, "{reasons:?}");
    assert!(
        stdout.contains("because its estimated error was above"),
        "{stdout}"
    );
}

#[test]
fn derivatives_are_accurate_or_said_not_to_be() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("small.yaml"), SMALL).unwrap();
    // the motion is linear in its start: the derivative is cos 20 for any size
    let exact = 20f64.cos();
    for (size, tolerance, code) in [
        ("1", None, 0),
        ("1e-6", None, 0),
        ("1", Some("1e-6"), 0),
        ("1e-6", Some("1e-4"), 3),
        ("1e-14", None, 0),
    ] {
        let set = format!("size={size}");
        let mut arguments = vec!["gradient", "small.yaml", "--of", "final of angle", "--json"];
        arguments.extend(["--set", &set]);
        arguments.extend(tolerance.iter().flat_map(|t| ["--tolerance", t]));
        let (stdout, stderr) = call(at, &arguments, code);
        let json: serde_json::Value = serde_json::from_str(&stdout).unwrap();
        let found = json["responses"][0]["parameters"][0]["derivative"].as_f64();
        let away = (found.unwrap() / exact - 1.0).abs();
        assert!(code == 3 || away < 3e-3, "{size}: {away}");
        assert_eq!(
            stderr.contains("are not as accurate as"),
            code == 3,
            "{stderr}"
        );
    }
}

/// An oscillator of ω = 100 1/s.
const SWINGS: &str = "\
model: swings
dimension: 2
parameters: { rate: 1 rad/s }
systems:
  - name: wheel
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { rates: { body: rate } }
forces: [{ joint: wheel/body, stiffness: 1e4 }]
outputs: [{ name: angle, of: joint wheel/body, what: angle }]
run: { duration: 1 s, every: 10 ms }
";

/// Steps of ωh = ½ by rk4 keep 1 − y⁶/72 + y⁸/576 of the energy each, y = ωh: 4.1 % are lost in the 200 of a run. Angle
/// and velocity lose the same. The balance has the work at the velocities that there are, so it lacks what the velocity
/// loses: 2.05 %.
#[test]
fn the_limit_of_missing_energy_is_that_of_the_study() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("swings.yaml"), SWINGS).unwrap();
    for (limit, ends) in [
        (", energy_limit: 1 %", "doubtful"),
        (", energy_limit: 1.8 %", "doubtful"),
        (", energy_limit: 2.3 %", "done"),
    ] {
        let study = format!(
            "model: swings.yaml\ndesign: list\nrows: [{{ rate: 1 }}, {{ rate: 3 }}]\nrun: {{ step: 5 ms, method: rk4{limit} }}\n\
             responses: [{{ of: angle, what: peak }}]\ntables: [csv]\n"
        );
        std::fs::write(at.join("study.yaml"), study).unwrap();
        let out = format!("out-{}", limit.len() + ends.len());
        call(at, &["sweep", "study.yaml", "--out", &out], 0);
        let table = Table::read(&at.join(out).join("results.csv"));
        assert_eq!(table.words("status"), [ends; 2], "{limit}");
        let told = table.words("reason")[0].contains("balance of energy has a gap");
        assert_eq!(told, ends == "doubtful", "{limit}");
    }
    let study = "model: swings.yaml\ndesign: list\nrows: [{ rate: 1 }]\nrun: { energy_limit: 3 % }\nresponses: [{ of: angle, what: peak }]\n";
    std::fs::write(at.join("study.yaml"), study).unwrap();
    let (_, stderr) = call(at, &["sweep", "study.yaml"], 2);
    assert!(stderr.contains("there is no `step`"), "{stderr}");
}
