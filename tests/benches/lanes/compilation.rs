//! The compile time of modules, and the length of their machine code.
//!
//! Each module becomes a library with only its derivative of the state, by `rustc -C opt-level=3` on one core for any
//! processor of its kind: once over `f64`, once over doubles in registers of every width of the runtime.

use super::machine_code;
use bryant_generator::Config;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

const ALONE: &str = "
#[inline(never)]
pub fn derivative(model: &Mechanism<f64>, t: f64, y: &[f64; STATE]) -> [f64; STATE] {
    bryant_runtime::Model::derivative(model, t, y)
}
";

const EVERY_WIDTH: &str = "
use bryant_runtime::{Several, Task, Width};

struct Derivative<'a, T> {
    model: &'a Mechanism<T>,
    y: &'a [T; STATE],
}

impl<T: Real> Task for Derivative<'_, T> {
    type Output = [T; STATE];

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.model.derivative(T::from_f64(0.0), self.y)
    }
}

struct OfAny;

impl bryant_runtime::real::lanes::OfAnyWidth for OfAny {
    type Output = f64;

    fn run<T: Several<One = f64>>(self) -> f64 {
        let model = Mechanism::<T>::new(bryant_runtime::ParameterSet::defaults());
        let y = model.initial_state();
        let rates = T::dispatch(Derivative { model: &model, y: &y });
        rates.iter().map(|rate| rate.lane(0)).sum()
    }
}

#[inline(never)]
pub fn derivative(width: Width) -> Option<f64> {
    bryant_runtime::real::lanes::with_width(width, OfAny)
}
";

/// Compiles one file.
fn compile(file: &Path, name: &str, options: &[&str]) -> PathBuf {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let library = file.with_file_name(format!("lib{name}.rlib"));
    let status = Command::new(compiler)
        .args(["--edition=2024", "--crate-type=rlib", "-Copt-level=3"])
        .args(["-Ccodegen-units=1", "-Awarnings"])
        .args(options)
        .arg(format!("--crate-name={name}"))
        .arg("-o")
        .arg(&library)
        .arg(file)
        .status();
    let done = status.as_ref().is_ok_and(|status| status.success());
    assert!(done, "{}: {status:?}", file.display());
    library
}

fn write(file: &Path, text: &str) {
    let folder = file.parent().unwrap_or(Path::new("."));
    let written = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(file, text));
    written.unwrap_or_else(|error| panic!("{}: {error}", file.display()));
}

pub fn table<const N: usize>(models: [(&str, &str); N]) {
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("a folder: {error}"));
    for (path, text) in bryant_runtime::source::FILES {
        write(&folder.path().join("runtime").join(path), text);
    }
    let root = folder.path().join("runtime/lib.rs");
    let runtime = compile(&root, "bryant_runtime", &["--cfg=feature=\"std\""]);
    let runtime = format!("--extern=bryant_runtime={}", runtime.display());

    println!("## Compilation of the derivative of the state\n");
    println!(
        "| model | lines | f64: compiled in | machine code | every width of registers: compiled in | machine code |"
    );
    println!("|---|---|---|---|---|---|");
    for (name, path) in models {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let (model, _) =
            bryant_generator::read(&path).unwrap_or_else(|problems| panic!("{problems}"));
        let module = Config::new().matrices(false).source(&model);
        print!("| {name} | {}", module.lines().count());
        for (kind, around) in [("alone", ALONE), ("every_width", EVERY_WIDTH)] {
            let file = folder.path().join(kind).join("lib.rs");
            write(&file, &format!("{module}\n{around}"));
            let start = Instant::now();
            let library = compile(&file, kind, &[&runtime]);
            let time = start.elapsed().as_secs_f64();
            let bytes = std::fs::read(&library).ok();
            let bytes = bytes.and_then(|bytes| machine_code::size(&bytes, ""));
            let kilobytes = bytes.map_or("?".to_owned(), |bytes| {
                format!("{:.1} kB", 1e-3 * bytes as f64)
            });
            print!(" | {time:.1} s | {kilobytes}");
        }
        println!(" |");
    }
}
