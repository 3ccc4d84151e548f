//! Compiles a model that is not bundled, once, and finds it again.
//!
//! ```text
//! runtime sources ─rustc→ libbryant_runtime.rlib ┐
//!                                                ├─rustc→ program around one model
//! generated module + a main of three lines ──────┘
//! ```
//!
//! Plain rustc, no cargo, no network. What was compiled stays in a cache, keyed by everything that decides the result:
//! what the model says, this program, the compiler, the processor. Entries are built beside their place and moved into it,
//! so two runs at once do not disturb each other and a broken-off one leaves nothing behind.

mod cache;
pub mod machine_code;
mod message;
mod rustc;
pub mod variants;

pub use cache::Cache;
pub use rustc::Rustc;

use bryant_generator::diagnostic::Diagnostics;
use bryant_study::study::Precision;
use std::path::{Path, PathBuf};

/// A model could not be compiled.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// There is no compiler.
    #[error(
        "this model is not bundled, so it must be compiled, but `{command}` cannot be started: {source}\n  \
         help: install Rust (https://rustup.rs), or name the compiler by RUSTC=/path/to/rustc"
    )]
    NoCompiler {
        /// The command tried.
        command: String,
        /// Why it did not start.
        source: std::io::Error,
    },
    /// The compiler does not answer as one.
    #[error(
        "`{command} {arguments}` failed: {message}\n  help: name a working compiler by RUSTC=/path/to/rustc"
    )]
    BadCompiler {
        /// The command.
        command: String,
        /// What it was asked.
        arguments: String,
        /// What it said.
        message: String,
    },
    /// There is no linker.
    #[error(
        "the compiler found no linker: {message}\n  help: install a C compiler, which brings one \
         (Debian and Ubuntu: apt install gcc; Fedora: dnf install gcc; macOS: xcode-select --install)"
    )]
    NoLinker {
        /// What the compiler said.
        message: String,
    },
    /// A function of the user's does not compile.
    #[error("{0}")]
    User(Diagnostics),
    /// What was generated does not compile.
    #[error(
        "the source written for this model does not compile, which is a fault of bryant, not of the model: {message}\n  \
         help: the source and all messages are kept in {}; please report them", .kept.display()
    )]
    Rejected {
        /// The first error.
        message: String,
        /// Where source and messages are kept.
        kept: PathBuf,
    },
    /// The cache cannot be used.
    #[error(
        "cannot keep compiled models in {}: {source}\n  help: name a writable directory by BRYANT_CACHE", .path.display()
    )]
    Cache {
        /// The file or directory.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The program that times variants of a model broke off.
    #[error("the variants of the model could not be timed: {message}")]
    Timing {
        /// What it said.
        message: String,
    },
    /// No place for a cache is known.
    #[error(
        "there is no place for compiled models: neither BRYANT_CACHE nor XDG_CACHE_HOME nor HOME is set\n  \
             help: name a writable directory by BRYANT_CACHE"
    )]
    NoCache,
}

/// What to compile.
#[derive(Clone, Copy, Debug)]
pub struct Unit<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// Digest of the model.
    pub digest: &'a str,
    /// Texts of the user's that the module holds.
    pub texts: &'a [Text<'a>],
}

/// Rust text of the user's.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a> {
    /// The file, as shown to the user.
    pub name: &'a str,
    /// What is in it.
    pub text: &'a str,
}

/// What has to be done before a model can run, for a progress indication.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The runtime is compiled, once for all models.
    Runtime,
    /// The equations are derived and written.
    Generating,
    /// The generated source is compiled.
    Compiling,
}

/// The program around a model: from the cache, else generated and compiled.
///
/// `source` writes the generated module; it is called only where nothing is cached. `stage` hears of everything that takes
/// time.
pub fn program(
    unit: Unit<'_>,
    source: &mut dyn FnMut() -> String,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    build(unit, MAIN, source, stage)
}

/// The program around a model for a study of accuracy: every arithmetic there is, and a run that is timed is not the first
/// of its process.
pub fn program_of_all_scalars(
    unit: Unit<'_>,
    source: &mut dyn FnMut() -> String,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    build(unit, MAIN_OF_ALL_SCALARS, source, stage)
}

/// The program around a model in single precision.
pub fn program_in_single_precision(
    unit: Unit<'_>,
    source: &mut dyn FnMut() -> String,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    build(unit, MAIN_IN_SINGLE_PRECISION, source, stage)
}

/// The program around a model that runs rows of a study, for any processor of this kind: it has the code for all widths of registers and
/// takes the widest there is. It is kept in a folder of its own, from which other machines, that need no compiler then, take it.
pub fn program_of_rows(
    unit: Unit<'_>,
    precision: Precision,
    folder: &Path,
    source: &mut dyn FnMut() -> String,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    let kept = Cache {
        root: folder.to_owned(),
    };
    let main = match precision {
        Precision::Double => MAIN_OF_ROWS,
        Precision::Single => MAIN_OF_ROWS_IN_SINGLE_PRECISION,
    };
    // No compiler has a say here: whoever looks for the program may have none.
    let key = rustc::digest([unit.digest, main, env!("CARGO_PKG_VERSION")]);
    let entry = entry_name(unit.name, &key[..24]);
    kept.entry(&entry, &executable(), |directory| {
        let found = build_for(Rustc::find()?.portable(), unit, main, source, stage)?;
        let to = directory.join(executable());
        let copied = std::fs::copy(&found, &to);
        copied
            .map(|_| ())
            .map_err(|source| BuildError::Cache { path: to, source })
    })
}

/// The program around a model that differentiates runs.
pub fn program_of_gradients(
    unit: Unit<'_>,
    source: &mut dyn FnMut() -> String,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    build_for(
        Rustc::find()?.portable(),
        unit,
        MAIN_OF_GRADIENTS,
        source,
        stage,
    )
}

/// Compiles the runtime, unless that is done: before several models are compiled at once.
pub fn prepare(stage: &mut dyn FnMut(Stage)) -> Result<(), BuildError> {
    runtime(&Rustc::find()?, &Cache::find()?, stage).map(|_| ())
}

fn build(
    unit: Unit<'_>,
    program: &str,
    source: &mut dyn FnMut() -> String,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    build_for(Rustc::find()?, unit, program, source, stage)
}

/// Name of a directory in the cache.
fn entry_name(model: &str, key: &str) -> String {
    let plain = |c: &char| c.is_ascii_alphanumeric() || *c == '-';
    let name: String = model.chars().filter(plain).take(60).collect();
    format!("{name}-{key}")
}

/// Name of the program in it.
fn executable() -> String {
    format!("model{}", std::env::consts::EXE_SUFFIX)
}

fn build_for(
    rustc: Rustc,
    unit: Unit<'_>,
    program: &str,
    source: &mut dyn FnMut() -> String,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    let cache = Cache::find()?;
    let key = rustc.key(&rustc::digest([unit.digest, program]));
    let (entry, executable) = (entry_name(unit.name, &key), executable());
    cache.entry(&entry, &executable, |directory| {
        let runtime = runtime(&rustc, &cache, stage)?;
        stage(Stage::Generating);
        let text = source();
        stage(Stage::Compiling);
        let main = directory.join("main.rs");
        write(&directory.join("model.rs"), &text)?;
        write(&main, program)?;
        rustc.compile(
            &main,
            &[
                "--crate-name=model",
                "--crate-type=bin",
                &format!("--extern=bryant_runtime={}", runtime.display()),
            ],
            &directory.join(&executable),
            &cache,
            (&text, unit.texts),
        )
    })
}

/// The whole program: everything in it is the model's module and the runtime's.
const MAIN: &str = "\
//! The program around one model; written by bryant.
mod model;

fn main() -> std::process::ExitCode {
    bryant_runtime::program::main::<model::Mechanism<f64>>()
}
";

/// The program that runs rows of a study.
const MAIN_OF_ROWS: &str = "\
//! The program around one model that runs rows of a study; written by bryant.
mod model;

fn main() -> std::process::ExitCode {
    bryant_runtime::program::rows::main_of_rows::<model::Mechanism<f64>>()
}
";

/// The same in single precision.
const MAIN_OF_ROWS_IN_SINGLE_PRECISION: &str = "\
//! The program around one model that runs rows of a study in single precision; written by bryant.
mod model;

fn main() -> std::process::ExitCode {
    bryant_runtime::program::rows::main_of_rows_in_single_precision::<model::Mechanism<f64>>()
}
";

/// The program that differentiates runs.
const MAIN_OF_GRADIENTS: &str = "\
//! The program around one model that differentiates its runs; written by bryant.
mod model;

fn main() -> std::process::ExitCode {
    bryant_runtime::program::rows::main_of_gradients::<model::Mechanism<f64>>()
}
";

/// The program around a model, in single precision.
const MAIN_IN_SINGLE_PRECISION: &str = "\
//! The program around one model in single precision; written by bryant.
mod model;

fn main() -> std::process::ExitCode {
    bryant_runtime::program::main_of::<f32, model::Mechanism<f64>>()
}
";

/// The program of a study. What is timed is a run in a process that has run before, as in a series of runs: a first one, which
/// is broken off early, has the code read and the processor awake.
const MAIN_OF_ALL_SCALARS: &str = r#"//! The program around one model, for every arithmetic; written by bryant.
mod model;

use bryant_runtime::program::{Job, Scalar, main_of_all_scalars, run};
use bryant_runtime::{DoubleDouble, Fast};
use model::Mechanism;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

fn main() -> std::process::ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let Some(job) = Job::from_words(&words).ok().filter(|job| job.silent) {
        // As large a stack as the run itself has.
        let first = std::thread::Builder::new().stack_size(256 << 20);
        let _ = first.spawn(move || warm_up(&job)).map(|thread| thread.join());
    }
    main_of_all_scalars::<Mechanism<f64>>()
}

fn warm_up(job: &Job) {
    let start = Instant::now();
    let sink = &mut |_: f64, _: &[f64], _: &[f64]| match start.elapsed() < Duration::from_millis(2) {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(()),
    };
    let _ = match job.scalar {
        Scalar::F64 => run::<f64, Mechanism<f64>>(job, sink),
        Scalar::F32 => run::<f32, Mechanism<f32>>(job, sink),
        Scalar::Fast => run::<Fast, Mechanism<Fast>>(job, sink),
        Scalar::DoubleDouble => run::<DoubleDouble, Mechanism<DoubleDouble>>(job, sink),
    };
}
"#;

/// The runtime as a library for this compiler.
fn runtime(
    rustc: &Rustc,
    cache: &Cache,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    let files = bryant_runtime::source::FILES;
    let key = rustc.key(&rustc::digest(
        files.iter().flat_map(|(path, text)| [*path, *text]),
    ));
    cache.entry(
        &format!("runtime-{key}"),
        "libbryant_runtime.rlib",
        |directory| {
            stage(Stage::Runtime);
            for (path, text) in files {
                write(&directory.join(path), text)?;
            }
            rustc.compile(
                &directory.join("lib.rs"),
                &[
                    "--crate-name=bryant_runtime",
                    "--crate-type=rlib",
                    "--cfg=feature=\"std\"",
                ],
                &directory.join("libbryant_runtime.rlib"),
                cache,
                ("", &[]),
            )
        },
    )
}

fn write(path: &Path, text: &str) -> Result<(), BuildError> {
    let written = match path.parent() {
        Some(parent) => std::fs::create_dir_all(parent).and_then(|()| std::fs::write(path, text)),
        None => std::fs::write(path, text),
    };
    written.map_err(|source| BuildError::Cache {
        path: path.to_owned(),
        source,
    })
}
