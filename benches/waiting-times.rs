//! The waiting times of a user: the commands on two scenes of real size, and the compilation of a user's crate.
//!
//! ```text
//! cargo bench --bench waiting-times                  the commands
//! cargo bench --bench waiting-times -- --crates      and a crate with a model, compiled three ways
//! cargo bench --bench waiting-times -- --clone       and the README's two commands in a fresh clone (half an hour)
//! ```
//!
//! Every line is the median of a few runs of the whole process, in wall time, beside its goal. The first row of a goal
//! is the first line on standard output.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

type Failed = Box<dyn std::error::Error>;

/// Number of repetitions of commands that take less than a second.
const REPETITIONS: usize = 5;

fn main() -> Result<(), Failed> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // `cargo test --bench waiting-times` only checks that the names in the scenes are still valid
    let measures = arguments.iter().any(|argument| argument == "--bench");
    let place = std::env::temp_dir().join(format!("bryant-waiting-times-{}", std::process::id()));
    std::fs::create_dir_all(&place)?;
    let asked = |option: &str| arguments.iter().any(|argument| argument == option);
    let mut result = commands(&place, measures);
    if result.is_ok() && asked("--crates") {
        result = crates(&place);
    }
    if result.is_ok() && asked("--clone") {
        result = clone(&place);
    }
    std::fs::remove_dir_all(&place)?;
    result
}

/// The times of one run of a process \[s\].
struct Took {
    first_line: f64,
    all: f64,
}

fn commands(place: &Path, measures: bool) -> Result<(), Failed> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/scenes");
    for file in std::fs::read_dir(&here)? {
        let path = file?.path();
        if let Some(name) = path.file_name() {
            std::fs::copy(&path, place.join(name))?;
        }
    }
    println!(
        "{:58} {:>9} {:>9} {:>9}",
        "", "first [s]", "all [s]", "goal [s]"
    );
    for (scene, of, wrt) in [
        ("occupant", "peak_shoulder_force", "limit"),
        ("pedestrian", "HIC15_of_head_acceleration", "speed"),
    ] {
        let model = format!("{scene}.yaml");
        let study = format!("{scene}-study.yaml");
        let long = 1;
        let gradient = ["gradient", &model, "--of", of, "--wrt", wrt];
        measure(place, long, &gradient, 2.0)?;
        if !measures {
            continue;
        }
        measure(place, REPETITIONS, &["check", &model], 0.15)?;
        measure(place, REPETITIONS, &["run", &model, "--no-files"], 0.3)?;
        measure(place, long, &["sweep", &study], f64::NAN)?;
        measure(place, long, &["effects", &model, "--no-time"], 10.0)?;
        measure(place, long, &["effects", &model], 30.0)?;
        measure(
            place,
            long,
            &["accuracy", &model, "--quick", "--no-files"],
            15.0,
        )?;
        measure(place, long, &["accuracy", &model, "--no-files"], 45.0)?;
    }
    Ok(())
}

/// Runs a command several times, each time on an edited model, and prints the median.
fn measure(place: &Path, repetitions: usize, words: &[&str], goal: f64) -> Result<(), Failed> {
    let mut took = Vec::new();
    for repetition in 0..repetitions {
        edit(&place.join(words[1]), repetition)?;
        took.push(run(place, words)?);
    }
    let median = |of: fn(&Took) -> f64| {
        let mut values: Vec<f64> = took.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let goal = match goal.is_nan() {
        true => String::new(),
        false => format!("{goal}"),
    };
    println!(
        "{:58} {:>9.3} {:>9.3} {goal:>9}",
        words.join(" "),
        median(|took| took.first_line),
        median(|took| took.all)
    );
    Ok(())
}

/// Changes the title, and so the digest of the file, but not the scene.
fn edit(path: &Path, repetition: usize) -> Result<(), Failed> {
    let text = std::fs::read_to_string(path)?;
    let lines = text.lines().map(|line| match line.starts_with("title:") {
        true => format!("title: edited {repetition} times"),
        false => line.to_owned(),
    });
    let text: Vec<String> = lines.collect();
    Ok(std::fs::write(path, text.join("\n") + "\n")?)
}

fn run(place: &Path, words: &[&str]) -> Result<Took, Failed> {
    let start = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_bryant"))
        .args(words)
        .current_dir(place)
        .env("NO_COLOR", "1")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let mut output = BufReader::new(child.stdout.take().ok_or("no output")?);
    let mut line = String::new();
    output.read_line(&mut line)?;
    let first_line = start.elapsed().as_secs_f64();
    output.read_to_end(&mut Vec::new())?;
    let status = child.wait()?;
    let all = start.elapsed().as_secs_f64();
    // a doubtful run does not end with success, but its time counts
    match status.code() {
        Some(0 | 3) => Ok(Took { first_line, all }),
        _ => Err(format!("bryant {} ended with {status}", words.join(" ")).into()),
    }
}

/// The compile time of a user's crate in release, with compiled dependencies.
fn crates(place: &Path) -> Result<(), Failed> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, program, goal) in [
        ("accelerations", ACCELERATIONS, 2.0),
        ("simulate over f64", SIMULATE, 3.0),
        ("simulate over Dual", OVER_DUALS, 8.0),
    ] {
        let own = place.join("own");
        std::fs::create_dir_all(own.join("src"))?;
        std::fs::write(own.join("Cargo.toml"), manifest(root))?;
        std::fs::write(own.join("build.rs"), BUILD)?;
        std::fs::copy(root.join("models/dummy15.yaml"), own.join("dummy15.yaml"))?;
        let main = own.join("src/main.rs");
        std::fs::write(&main, "fn main() {}\n")?;
        cargo(&own)?;
        std::fs::write(&main, program)?;
        let start = Instant::now();
        cargo(&own)?;
        let label = format!("own crate, release: {name}");
        println!(
            "{label:58} {:>9} {:>9.3} {goal:>9}",
            "",
            start.elapsed().as_secs_f64()
        );
    }
    Ok(())
}

/// The README's commands in a fresh clone of what is committed. What they download is downloaded before.
fn clone(place: &Path) -> Result<(), Failed> {
    let own = place.join("clone");
    let mut git = Command::new("git");
    git.args(["clone", "--quiet"]);
    succeed(git.arg(env!("CARGO_MANIFEST_DIR")).arg(&own))?;
    in_folder(&own, &["fetch", "--locked"])?;
    for (words, goal) in [
        (&["run", "--release", "--", "run", "child-seat"][..], 120.0),
        (&["test", "--workspace"][..], 900.0),
    ] {
        let start = Instant::now();
        in_folder(&own, words)?;
        let label = format!("fresh clone: cargo {}", words.join(" "));
        let took = start.elapsed().as_secs_f64();
        println!("{label:58} {:>9} {took:>9.1} {goal:>9}", "");
    }
    Ok(())
}

fn cargo(own: &Path) -> Result<(), Failed> {
    in_folder(own, &["build", "--release"])
}

/// Runs cargo in a folder, with that folder's own target.
fn in_folder(folder: &Path, words: &[&str]) -> Result<(), Failed> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(words).current_dir(folder);
    succeed(command.env_remove("CARGO_TARGET_DIR"))
}

fn succeed(command: &mut Command) -> Result<(), Failed> {
    let output = command.output()?;
    match output.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
    }
}

fn manifest(root: &Path) -> String {
    let root = root.display();
    format!(
        "[package]\nname = \"own\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
         [dependencies]\nbryant-runtime = {{ path = \"{root}/runtime\" }}\n\n\
         [build-dependencies]\nbryant-generator = {{ path = \"{root}/generator\" }}\n\n[workspace]\n"
    )
}

const BUILD: &str = "fn main() {
    bryant_generator::Config::new().model(\"dummy15.yaml\").generate_or_report();
}
";

const ACCELERATIONS: &str = "mod dummy { bryant_runtime::include_model!(\"dummy15\"); }
fn main() {
    let body = dummy::Mechanism::<f64>::new(dummy::Parameters::default());
    let (q, v) = body.initial_conditions();
    println!(\"{:?}\", body.accelerations(0.0, &q, &v));
}
";

const SIMULATE: &str = "mod dummy { bryant_runtime::include_model!(\"dummy15\"); }
use bryant_runtime::{Settings, simulate};
fn main() {
    let body = dummy::Mechanism::<f64>::new(dummy::Parameters::default());
    let report = simulate(&body, &Settings::of(&dummy::INFO), &mut |sample| println!(\"{}\", sample.t));
    println!(\"{report:?}\");
}
";

const OVER_DUALS: &str = "mod dummy { bryant_runtime::include_model!(\"dummy15\"); }
use bryant_runtime::{Dual, Settings, simulate};
fn main() {
    let body = dummy::Mechanism::<Dual<f64>>::new(dummy::Parameters::default());
    let report = simulate(&body, &Settings::of(&dummy::INFO), &mut |sample| println!(\"{}\", sample.t));
    println!(\"{report:?}\");
}
";
