//! Commands that take long: their progress messages, and their results after Ctrl-C.

use crate::command_call::{bryant, call, expect};
use crate::{directory, json, numbers, without_a_toolchain};
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// A scene of real size.
fn scene(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "benches", "scenes", name]
        .iter()
        .collect();
    path.to_str().unwrap().to_owned()
}

fn begin(directory: &Path, arguments: &[&str]) -> Child {
    let mut command = bryant(directory);
    command.args(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.env("BRYANT_PROGRESS", "0.5");
    // tests in the background of a shell ignore Ctrl-C, and their child processes inherit this
    #[expect(unsafe_code, reason = "between fork and exec")]
    // SAFETY: `signal` may be called between fork and exec, and no handler is installed.
    unsafe {
        command.pre_exec(|| {
            libc::signal(libc::SIGINT, libc::SIG_DFL);
            Ok(())
        });
    }
    command.spawn().unwrap()
}

/// The lines of a stream up to the first one that contains a text.
fn lines_until(stream: &mut impl BufRead, text: &str) -> String {
    let mut all = String::new();
    while !all.contains(text) {
        let before = all.len();
        stream.read_line(&mut all).unwrap();
        assert!(all.len() > before, "it ended without \"{text}\"\n{all}");
    }
    all
}

/// Presses Ctrl-C.
fn interrupt(child: &Child) {
    let id = child.id().to_string();
    let killed = Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert!(killed.success());
}

/// Waits until standard error contains a text, presses Ctrl-C, and expects the end of an interrupted command. Standard
/// output must fit into a pipe.
fn interrupted_when(directory: &Path, arguments: &[&str], said: &str) -> (String, String) {
    let mut child = begin(directory, arguments);
    let mut messages = BufReader::new(child.stderr.take().unwrap());
    let mut stderr = lines_until(&mut messages, said);
    interrupt(&child);
    let mut stdout = String::new();
    child
        .stdout
        .take()
        .unwrap()
        .read_to_string(&mut stdout)
        .unwrap();
    messages.read_to_string(&mut stderr).unwrap();
    let output = Output {
        status: child.wait().unwrap(),
        stdout: stdout.into_bytes(),
        stderr: stderr.into_bytes(),
    };
    expect(output, arguments, 130)
}

/// A line of progress appears after the time between lines, with the simulated time, its total, and the time left. The
/// table and the file have the same samples up to the time in the message, and not those of the whole run.
#[test]
fn a_run_that_is_interrupted_keeps_its_samples() {
    let directory = directory();
    let arguments = [
        "run",
        "clock.yaml",
        "--method",
        "rk4",
        "--step",
        "1 us",
        "--duration",
        "1000 s",
        "--every",
        "10 ms",
        "--max-steps",
        "1000000000000",
        "--time-limit",
        "off",
    ];
    // the first lines do not yet say how much time is left
    let said = " simulated, about ";
    let (stdout, stderr) = interrupted_when(directory.path(), &arguments, said);
    let line = stderr.lines().find(|line| line.contains(said)).unwrap();
    assert!(
        line.starts_with("running clock: ") && line.contains(" of 1000 s simulated, about "),
        "{stderr}"
    );
    let missing = stderr.split("error: interrupted: ").nth(1).unwrap();
    assert!(
        missing.contains("the run was stopped at t = ")
            && missing.contains("up to 1000 s are missing"),
        "{stderr}"
    );
    let csv = std::fs::read_to_string(directory.path().join("clock.csv")).unwrap();
    let (table, file) = (stdout.lines().count() - 2, csv.lines().count() - 1);
    assert!(
        table == file && (2..10_000).contains(&file),
        "{table} {file}"
    );
    let last = csv.lines().last().unwrap().split(',').next().unwrap();
    assert!(
        missing.contains(&format!("after t = {last} s")),
        "{last}\n{stderr}"
    );
}

#[test]
fn what_is_short_says_nothing_of_its_progress() {
    let directory = directory();
    let (_, stderr) = call(directory.path(), &["run", "clock.yaml"], 0);
    assert!(
        !stderr.contains("simulated,") && !stderr.contains(" so far"),
        "{stderr}"
    );
}

/// The costliest effects come first; the cost is the number of operations plus twenty for each call.
#[test]
fn effects_are_in_the_order_of_their_cost() {
    let directory = directory();
    let arguments = ["effects", "child-seat", "--no-time", "--json"];
    let effects = json(&call(directory.path(), &arguments, 0).0);
    assert_eq!(effects["complete"], true);
    let list = effects["effects"].as_array().unwrap();
    let costs = list
        .iter()
        .filter_map(|effect| Some(effect["operations"].as_i64()? + 20 * effect["calls"].as_i64()?));
    let costs: Vec<i64> = costs.collect();
    assert!(
        costs.len() > 20 && costs.is_sorted_by(|a, b| a >= b),
        "{costs:?}"
    );
    // effects without operations come after them
    assert!(
        list[..costs.len()]
            .iter()
            .all(|effect| effect["operations"].is_i64())
    );
}

/// Rows with times appear while others are still being timed. After Ctrl-C the others appear without times, with a
/// message about their number.
#[test]
fn effects_appear_as_they_are_timed() {
    let directory = directory();
    let path = scene("occupant.yaml");
    let arguments = ["effects", &path];
    let mut child = begin(directory.path(), &arguments);
    let mut table = BufReader::new(child.stdout.take().unwrap());
    let first = "motion out of the x–z plane";
    let mut stdout = lines_until(&mut table, first);
    interrupt(&child);
    table.read_to_string(&mut stdout).unwrap();
    let output = Output {
        stdout: stdout.into_bytes(),
        ..child.wait_with_output().unwrap()
    };
    let (stdout, stderr) = expect(output, &arguments, 130);
    assert!(
        stderr.contains("error: interrupted: of ") && stderr.contains("were not timed"),
        "{stderr}"
    );
    let timed = |line: &&str| {
        line.split_whitespace()
            .filter(|word| word.contains('.') && word.parse::<f64>().is_ok())
            .count()
            == 2
    };
    let rows: Vec<&str> = stdout
        .lines()
        .filter(|line| line.contains("  in "))
        .collect();
    assert!(timed(&rows[0]) && rows[0].starts_with(first), "{}", rows[0]);
    let of_timed = rows.iter().filter(|line| timed(line)).count();
    assert!(
        rows.len() > 150 && of_timed < rows.len() - 20,
        "{of_timed} of {}",
        rows.len()
    );
    assert!(stdout.contains("with nothing left out"), "{stdout}");
}

/// Ctrl-C leaves a report of the points that exist.
#[test]
fn a_study_of_accuracy_that_is_interrupted_reports_what_it_has() {
    let directory = directory();
    let arguments = [
        "accuracy",
        "clock.yaml",
        "--methods",
        "rk4,tsit5",
        "--repetitions",
        "10000",
        "--budget",
        "120 s",
        "--no-files",
    ];
    let (stdout, stderr) = interrupted_when(directory.path(), &arguments, "timing of clock");
    assert!(
        stdout.contains("this rests on ") && stdout.contains("tsit5 at "),
        "{stdout}"
    );
    assert!(
        stderr.contains("error: interrupted: ") && stderr.contains("fewer repetitions"),
        "{stderr}"
    );
}

/// For any scene: after 1 s, plus 5 s in which a busy machine finishes the work that has begun.
#[test]
fn a_study_of_accuracy_keeps_to_its_budget() {
    let directory = directory();
    for name in ["occupant.yaml", "pedestrian.yaml"] {
        let path = scene(name);
        let arguments = [
            "accuracy",
            &path,
            "--quick",
            "--budget",
            "1 s",
            "--no-files",
            "--json",
        ];
        let study = json(&call(directory.path(), &arguments, 0).0);
        let took = study["took_s"].as_f64().unwrap();
        assert!(took < 1.0 + 5.0, "{name}: {took} s");
        let sentence = study["sentence"].as_str().unwrap();
        assert!(
            sentence.contains("this rests on ")
                && sentence.contains("not reached or stopped (--budget), most of "),
            "{sentence}"
        );
    }
}

/// Finished blocks stay; the same command does the rest.
#[test]
fn a_sweep_that_is_interrupted_goes_on_from_there() {
    let directory = directory();
    let study = "model: clock.yaml\ndesign: sobol\nruns: 131072\nparameters: { gravity: { from: 9, to: 10 } }\n\
                 responses: [{ of: swing, what: peak }]\n";
    std::fs::write(directory.path().join("study.yaml"), study).unwrap();
    let arguments = ["sweep", "study.yaml", "--no-estimate"];
    let child = begin(directory.path(), &arguments);
    let results = directory.path().join("study-results");
    while files(&results) < 8 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    interrupt(&child);
    let (_, stderr) = expect(child.wait_with_output().unwrap(), &arguments, 130);
    assert!(
        stderr.contains("of 131072 runs are stored")
            && stderr.contains("the same command goes on from there"),
        "{stderr}"
    );
    assert!(!results.join("results.csv").exists() && !results.join("results.parquet").exists());
    let (_, stderr) = call(directory.path(), &arguments, 0);
    assert!(
        stderr.contains(" were there") && stderr.contains("wrote "),
        "{stderr}"
    );
}

/// Files in a folder and those below.
fn files(folder: &Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return 0;
    };
    let count = |path: PathBuf| if path.is_dir() { files(&path) } else { 1 };
    entries.flatten().map(|entry| count(entry.path())).sum()
}

#[test]
fn hard_cases_that_are_interrupted_are_not_said_to_have_run() {
    let directory = directory();
    let arguments = ["stability", "--full", "--markdown", "page.md"];
    let (stdout, stderr) = interrupted_when(directory.path(), &arguments, "hard cases");
    assert!(
        stderr.contains("cases were not run to their end"),
        "{stderr}"
    );
    assert!(stdout.contains("every bound is kept"), "{stdout}");
    assert!(
        !directory.path().join("page.md").exists(),
        "a page of some of them"
    );
}

/// The summary leads to the page of each group, which leads back, whatever its name.
#[test]
fn hard_cases_have_a_summary_and_a_page_for_each_group() {
    let directory = directory();
    for (file, folder) in [("page.md", "page"), ("cases", "cases.groups")] {
        let arguments = ["stability", "spin at", "--markdown", file];
        call(directory.path(), &arguments, 0);
        let text = |path: &str| std::fs::read_to_string(directory.path().join(path)).unwrap();
        let link = format!("[Orientation]({folder}/orientation.md) | 1 | ");
        assert!(text(file).contains(&link), "{}", text(file));
        let group = text(&format!("{folder}/orientation.md"));
        assert!(group.contains(&format!("(../{file})")), "{group}");
        assert!(group.contains("## Spin at 10 000 rad/s"), "{group}");
    }
}

/// The same motion up to rounding, and the name of the engine.
#[test]
fn a_run_by_rustc_is_the_same_run() {
    let directory = directory();
    let [ours, theirs] = ["built-in", "rustc"].map(|engine| {
        let arguments = [
            "run",
            "clock.yaml",
            "--engine",
            engine,
            "--no-files",
            "--json",
        ];
        json(&call(directory.path(), &arguments, 0).0)
    });
    assert_eq!(
        (&ours["engine"], &theirs["engine"]),
        (&"built-in".into(), &"rustc".into())
    );
    assert_eq!(ours["columns"], theirs["columns"]);
    let rows = |value: &serde_json::Value| -> Vec<Vec<f64>> {
        value["rows"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers)
            .collect()
    };
    let (ours, theirs) = (rows(&ours), rows(&theirs));
    assert_eq!((ours.len(), theirs.len()), (11, 11));
    for (a, b) in ours.iter().flatten().zip(theirs.iter().flatten()) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
    let arguments = ["run", "clock.yaml", "--engine", "rustc", "--no-files"];
    let (_, stderr) = without_a_toolchain(directory.path(), &arguments, 1);
    assert!(
        stderr.contains("help: install Rust")
            && stderr.contains("without --engine rustc nothing is compiled"),
        "{stderr}"
    );
}
