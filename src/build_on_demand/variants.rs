//! Variants of a model, compiled one by one and timed against each other in one program.
//!
//! ```text
//! module ─rustc→ library ┐
//! module ─rustc→ library ┼─rustc→ program: all variants in turn, round after round ─→ median of each
//! module ─rustc→ library ┘
//! ```
//!
//! All variants run in the same process, interleaved, so that whatever slows the machine down slows all of them down. A
//! library is kept for the next time. Its machine code is read from its object file: that of the method, with all that the
//! compiler put into it, but not what it calls.

use super::{BuildError, Cache, Rustc, Text, machine_code, runtime, rustc, write};
use crate::parallel;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// v̇(t, q, v)
    Accelerations,
    /// The outputs, with the accelerations where they need them.
    Outputs,
}

impl Method {
    /// Its name in a module.
    pub fn name(self) -> &'static str {
        match self {
            Method::Accelerations => "accelerations",
            Method::Outputs => "outputs",
        }
    }
}

/// What was measured of one method of one module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Median time of one evaluation \[s\].
    pub time: f64,
    /// Length of its machine code; `None` where the format of object files is not known.
    pub bytes: Option<u64>,
}

/// A library, ready to be timed.
struct Built {
    name: String,
    path: PathBuf,
    bytes: Option<u64>,
}

/// Compiles modules and times one method of each. The same module given twice is timed twice. `texts` are those of the
/// user's that modules hold.
///
/// `progress` hears of the part that is done.
pub fn time(
    modules: &[(String, Method)],
    texts: &[Text<'_>],
    progress: &mut dyn FnMut(f64),
) -> Result<Vec<Measured>, BuildError> {
    let rustc = Rustc::find()?;
    let cache = Cache::find()?;
    let runtime = runtime(&rustc, &cache, &mut |_| {})?;
    let built = all(&rustc, &cache, &runtime, modules, texts, progress)?;
    let program = program(&rustc, &cache, &runtime, &built, modules)?;
    let times = run(&program, modules.len())?;
    progress(1.0);
    let measured = times.into_iter().zip(&built);
    Ok(measured
        .map(|(time, built)| Measured {
            time,
            bytes: built.bytes,
        })
        .collect())
}

/// The libraries of all modules, on all processors.
fn all(
    rustc: &Rustc,
    cache: &Cache,
    runtime: &Path,
    modules: &[(String, Method)],
    texts: &[Text<'_>],
    progress: &mut dyn FnMut(f64),
) -> Result<Vec<Built>, BuildError> {
    let library = |(module, method): &(String, Method)| {
        library(rustc, cache, runtime, module, texts, *method)
    };
    let share = modules.len() as f64 / (modules.len() + 1) as f64;
    let built = parallel::map(modules, library, &mut |part| progress(share * part));
    built.into_iter().collect()
}

/// One module as a library.
fn library(
    rustc: &Rustc,
    cache: &Cache,
    runtime: &Path,
    module: &str,
    texts: &[Text<'_>],
    method: Method,
) -> Result<Built, BuildError> {
    let key = rustc.key(&rustc::digest([module, LIBRARY, method.name()]));
    let name = format!("variant_{key}");
    let file = format!("lib{name}.rlib");
    let path = cache.entry(&name, &file, |directory| {
        write(&directory.join("model.rs"), module)?;
        write(&directory.join("lib.rs"), &around(module, &key, method))?;
        rustc.compile(
            &directory.join("lib.rs"),
            &[
                &format!("--crate-name={name}"),
                "--crate-type=rlib",
                &format!("--extern=bryant_runtime={}", runtime.display()),
            ],
            &directory.join(&file),
            cache,
            (module, texts),
        )
    })?;
    let bytes = std::fs::read(&path).ok();
    let bytes = bytes.and_then(|bytes| machine_code::size(&bytes, method.name()));
    Ok(Built { name, path, bytes })
}

/// The text around a module: states of force laws and their memory are arguments only where it has them.
fn around(module: &str, key: &str, method: Method) -> String {
    let parts = [
        ("q", "COORDINATES"),
        ("v", "VELOCITIES"),
        ("z", "AUXILIARIES"),
        ("m", "MEMORY"),
    ];
    let parts = parts
        .iter()
        .filter(|(_, length)| module.contains(&format!("pub const {length}: usize")));
    let join = |of: &dyn Fn(&str, &str) -> String| {
        let all: Vec<String> = parts
            .clone()
            .map(|(name, length)| of(name, length))
            .collect();
        all.join("")
    };
    LIBRARY
        .replace("SYMBOL", &format!("bryant_{}_{key}", method.name()))
        .replace("METHOD", method.name())
        .replace(
            "DECLARED",
            &join(&|name, length| format!(", {name}: &[f64; model::{length}]")),
        )
        .replace(
            "TYPES",
            &join(&|_, length| format!("[f64; model::{length}], ")),
        )
        .replace(
            "SPLIT",
            &join(&|name, length| {
                format!("let ({name}, rest) = rest.split_at(model::{length});\n            ")
            }),
        )
        .replace(
            "ARRAYS",
            &join(&|name, _| format!("{name}.try_into().unwrap(), ")),
        )
        .replace("BLACK", &join(&|name, _| format!(", black_box({name})")))
        .replace("NAMES", &join(&|name, _| format!("{name}, ")))
        .replace("GIVEN", &join(&|name, _| format!(", {name}")))
}

/// The program that times them all.
fn program(
    rustc: &Rustc,
    cache: &Cache,
    runtime: &Path,
    built: &[Built],
    modules: &[(String, Method)],
) -> Result<PathBuf, BuildError> {
    let mut calls = String::new();
    let mut options = vec![
        "--crate-name=timing".to_owned(),
        "--crate-type=bin".to_owned(),
    ];
    if let Some(directory) = runtime.parent() {
        options.push(format!("-Ldependency={}", directory.display()));
    }
    for Built { name, path, .. } in built {
        calls += &format!("        {name}::evaluations(),\n");
        let option = format!("--extern={name}={}", path.display());
        if !options.contains(&option) {
            options.push(option);
        }
    }
    let main = MAIN.replace("CALLS", &calls);
    let texts = modules.iter().map(|(text, _)| text.as_str());
    let key = rustc.key(&rustc::digest(texts.chain([main.as_str(), LIBRARY])));
    let executable = format!("timing{}", std::env::consts::EXE_SUFFIX);
    cache.entry(&format!("timing-{key}"), &executable, |directory| {
        write(&directory.join("main.rs"), &main)?;
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        rustc.compile(
            &directory.join("main.rs"),
            &options,
            &directory.join(&executable),
            cache,
            ("", &[]),
        )
    })
}

/// Runs the program: one time per line.
fn run(program: &Path, count: usize) -> Result<Vec<f64>, BuildError> {
    let failed = |message: String| BuildError::Timing { message };
    let output = Command::new(program)
        .output()
        .map_err(|error| failed(error.to_string()))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let times: Vec<f64> = text.lines().filter_map(|line| line.parse().ok()).collect();
    if !output.status.success() || times.len() != count {
        let said = String::from_utf8_lossy(&output.stderr);
        let first = said.lines().next().unwrap_or("it said nothing").to_owned();
        return Err(failed(first));
    }
    Ok(times)
}

/// A variant: its method as a function of its own, and a loop around it. States are off the special values of the start, and
/// several, so that no branch is always predicted.
const LIBRARY: &str = "\
//! A variant of a model, to be timed; written by bryant.
mod model;

use bryant_runtime::{Model, ParameterSet};
use std::hint::black_box;

type Mechanism = model::Mechanism<f64>;

#[inline(never)]
#[unsafe(no_mangle)]
pub fn SYMBOL(mechanism: &Mechanism, t: f64DECLARED) -> impl Sized + use<> {
    mechanism.METHOD(tGIVEN)
}

/// Seconds of so many evaluations.
pub fn evaluations() -> Box<dyn FnMut(u64) -> f64> {
    let mechanism = Mechanism::new(model::Parameters::defaults());
    let start = mechanism.initial_state();
    let states: Vec<(TYPES)> = (0..8)
        .map(|k| {
            let mut y = start;
            for (i, entry) in y.iter_mut().enumerate() {
                *entry += 0.02 * ((i * 7 + k * 3) % 11) as f64 - 0.1;
            }
            mechanism.normalize(&mut y);
            let rest = &y[..];
            SPLIT
            let _ = rest;
            (ARRAYS)
        })
        .collect();
    let t = 0.3 * model::INFO.duration;
    Box::new(move |count| {
        let begin = std::time::Instant::now();
        for i in 0..count {
            let (NAMES) = &states[(i % 8) as usize];
            black_box(SYMBOL(black_box(&mechanism), black_box(t)BLACK));
        }
        begin.elapsed().as_secs_f64()
    })
}
";

/// All variants in turn.
const MAIN: &str = "\
//! Times variants of a model against each other; written by bryant.

/// Rounds; every variant runs once in each.
const ROUNDS: usize = 101;
/// Length of a turn, about, in seconds.
const TURN: f64 = 5e-5;

fn main() {
    let mut all: Vec<Box<dyn FnMut(u64) -> f64>> = vec![
CALLS    ];
    let counts: Vec<u64> = all
        .iter_mut()
        .map(|evaluations| {
            let once = (0..10).map(|_| evaluations(100) / 100.0).fold(f64::MAX, f64::min);
            (TURN / once).clamp(16.0, 1e6) as u64
        })
        .collect();
    let mut times = vec![Vec::with_capacity(ROUNDS); all.len()];
    for _ in 0..ROUNDS {
        for ((evaluations, times), &count) in all.iter_mut().zip(&mut times).zip(&counts) {
            // The variants before have taken its place in the caches.
            evaluations(count / 8);
            times.push(evaluations(count) / count as f64);
        }
    }
    for mut times in times {
        times.sort_by(f64::total_cmp);
        println!(\"{:e}\", times[ROUNDS / 2]);
    }
}
";
