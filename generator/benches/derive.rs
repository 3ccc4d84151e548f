//! The processor time from a text to the counted equations: chains of growing length, with the exponent of the growth,
//! or given files.
//!
//! ```text
//! cargo bench -p bryant-generator --bench derive                        chains
//! cargo bench -p bryant-generator --bench derive -- FILE...             models
//! cargo bench -p bryant-generator --bench derive -- --effects FILE...   as `bryant effects --no-time FILE`
//! ```
//!
//! Each line is a process of its own, because frames that were found once are kept. Beside the times are the operations
//! of the accelerations, so that one sees what a faster search costs.

use bryant_generator::dynamics::{self, derive_with};
use bryant_generator::effect;
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::program;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

type Failed = Box<dyn std::error::Error>;

/// The lengths of the chains.
const LINKS: [usize; 4] = [30, 100, 300, 1000];

fn main() -> Result<(), Failed> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let asked = |option: &str| arguments.iter().any(|argument| argument == option);
    let files: Vec<&String> = arguments.iter().filter(|a| !a.starts_with("--")).collect();
    if asked("--one") {
        for file in files {
            one(Path::new(file), asked("--effects"))?;
        }
        return Ok(());
    }
    println!("{:34} {:>8} {:>8} {:>8}", "", "read", "derive", "count");
    if !files.is_empty() {
        for file in files {
            alone(Path::new(file), asked("--effects"))?;
        }
        return Ok(());
    }
    let place = std::env::temp_dir().join(format!("bryant-derive-{}", std::process::id()));
    std::fs::create_dir_all(&place)?;
    // `cargo test --bench derive` only sees that it works
    let lengths = if asked("--bench") {
        &LINKS[..]
    } else {
        &LINKS[..1]
    };
    let result = chains(&place, lengths);
    std::fs::remove_dir_all(&place)?;
    result
}

/// Derives chains of each kind.
fn chains(place: &Path, lengths: &[usize]) -> Result<(), Failed> {
    for (kind, axes) in [
        ("parallel", &["0 1 0"][..]),
        ("crossed", &["0 1 0", "1 0 0", "0 0 1"]),
        ("irregular", &[]),
    ] {
        let mut before: Option<(usize, f64)> = None;
        for &links in lengths {
            let path = place.join(format!("{kind}-{links}.urdf"));
            std::fs::write(&path, chain(links, axes))?;
            let now = alone(&path, false)?;
            if let Some((fewer, took)) = before {
                let exponent = (now / took).ln() / (links as f64 / fewer as f64).ln();
                println!("{:34} grows as n^{exponent:.2}", "");
            }
            before = Some((links, now));
        }
    }
    Ok(())
}

/// Runs this program for one file alone, and returns the processor time \[s\].
fn alone(file: &Path, effects: bool) -> Result<f64, Failed> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("--one").arg(file).stdout(Stdio::piped());
    if effects {
        command.arg("--effects");
    }
    let output = command.output()?;
    let text = String::from_utf8(output.stdout)?;
    let (line, took) = text
        .trim_end()
        .rsplit_once('\n')
        .ok_or("the process for one file failed")?;
    println!("{line}");
    Ok(took.parse()?)
}

/// Prints what one file takes, then the processor time of all \[s\].
fn one(file: &Path, effects: bool) -> Result<(), Failed> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let begin = processor();
    let scene = bryant_generator::read_annotated(file)?;
    let read = processor();
    if effects {
        let variants = without_effects(&scene);
        let end = processor();
        println!(
            "{name:34} {:8.3} {:>8} {:8.3} s, {variants} variants",
            read - begin,
            "",
            end - read
        );
        println!("{}", end - begin);
        return Ok(());
    }
    let options = dynamics::Options {
        matrices: false,
        route: None,
    };
    let equations = derive_with(&scene.model, options);
    let derived = processor();
    let emitted = program::Options {
        matrices: false,
        ..program::Options::default()
    };
    let wanted = ["accelerations", "outputs"];
    let costs = program::costs_of(&scene.model, &equations, &emitted, Some(&wanted));
    let end = processor();
    let mut operations = String::new();
    for (method, table) in &costs {
        if ["accelerations", "outputs"].contains(&&**method) && table.total.total() > 0 {
            write!(operations, ", {method} {}", table.total.total())?;
        }
    }
    let times = [read - begin, derived - read, end - derived].map(|took| format!("{took:8.3}"));
    println!(
        "{name:34} {} s, n = {}{operations}",
        times.join(" "),
        equations.velocities.len()
    );
    println!("{}", end - begin);
    Ok(())
}

/// Counts the operations of a scene without each of its effects; returns the number of variants.
fn without_effects(scene: &AnnotatedModel) -> usize {
    let mut variants = 0;
    for entry in effect::of_annotated_model(scene)
        .iter()
        .filter(|entry| entry.is_in)
    {
        let Some(variant) = entry
            .effect
            .and_then(|effect| effect::without(&scene.model, effect))
        else {
            continue;
        };
        let variant = match entry.effect {
            Some(effect::Effect::Output(_)) => variant,
            _ => variant.without_outputs(),
        };
        effect::cost(&variant);
        variants += 1;
    }
    variants
}

/// A chain of hinges as a URDF. Links have no symmetry. Without axes, these, the places and the orientations are
/// irregular, too.
fn chain(links: usize, axes: &[&str]) -> String {
    // a generator of Lehmer: any numbers without a pattern will do
    let mut seed = 1u64;
    let mut random = move || {
        seed = seed * 48_271 % 0x7fff_ffff;
        seed as f64 / 0x7fff_ffff as f64 - 0.5
    };
    let mut text = String::from("<robot name=\"chain\"><link name=\"l0\"/>\n");
    for k in 1..=links {
        let (x, z) = (0.05 * random(), 0.2 + 0.05 * random());
        let moments = [0.02, 0.03, 0.025].map(|moment| moment + 0.005 * random());
        let products = [(); 3].map(|()| 0.002 * random());
        let _ = writeln!(
            text,
            "<link name=\"l{k}\"><inertial><origin xyz=\"{x} 0.01 {z}\"/><mass value=\"{}\"/><inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"{}\" ixz=\"{}\" iyz=\"{}\"/></inertial></link>",
            1.0 + random(),
            moments[0],
            moments[1],
            moments[2],
            products[0],
            products[1],
            products[2],
        );
        let (axis, origin) = match axes {
            [] => {
                let axis = [(); 3].map(|()| random());
                let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
                let axis = axis.map(|a| (a / length).to_string());
                let origin = format!(
                    "xyz=\"{} {} {}\" rpy=\"{} {} {}\"",
                    random(),
                    random(),
                    random(),
                    random(),
                    random(),
                    random()
                );
                (axis.join(" "), origin)
            }
            axes => (
                axes[k % axes.len()].to_owned(),
                "xyz=\"0 0 0.4\"".to_owned(),
            ),
        };
        let _ = writeln!(
            text,
            "<joint name=\"j{k}\" type=\"continuous\"><parent link=\"l{}\"/><child link=\"l{k}\"/><origin {origin}/><axis xyz=\"{axis}\"/></joint>",
            k - 1
        );
    }
    text + "</robot>\n"
}

/// The processor time of this process \[s\].
#[cfg(unix)]
#[expect(unsafe_code, reason = "the standard library has no processor time")]
fn processor() -> f64 {
    let mut time = libc::timespec {
        tv_sec: 0,
        tv_nsec: 0,
    };
    // SAFETY: the pointer is that of a timespec.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The time since the first call \[s\]; other systems have no processor time without a library.
#[cfg(not(unix))]
fn processor() -> f64 {
    static BEGIN: std::sync::LazyLock<std::time::Instant> =
        std::sync::LazyLock::new(std::time::Instant::now);
    BEGIN.elapsed().as_secs_f64()
}
