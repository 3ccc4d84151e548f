//! Compiles functions of user forces, or a generated model, as a small library, which this process loads.
//!
//! ```text
//! scalars, curves, force laws ─rustc→ libbryant_runtime.rlib (once for each compiler) ┐
//! functions of the user's, or one generated module ───────────────────────────────────┴─rustc→ library
//! ```
//!
//! Libraries are cached by their text, the compiler and the options. The same text is not compiled again for another
//! model, or by another build of this program.

use super::library::{LoadError, names};
use super::{BuildError, Cache, Rustc, Stage, Text, entry_name, rustc, write};
use bryant_generator::target::rust::Apart;
use std::path::{Path, PathBuf};

/// The parts of the text of a library.
pub(super) struct Source<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// The module with the user's functions, or of the generated model.
    pub module: &'a str,
    /// The text of the exported functions.
    pub exports: &'a str,
    /// The user's texts in the module.
    pub texts: &'a [Text<'a>],
}

/// The path of the library, which is compiled unless it is in the cache. `stage` is called before each step that takes
/// time.
pub(super) fn library(
    rustc: &Rustc,
    source: &Source<'_>,
    stage: &mut dyn FnMut(Stage),
) -> Result<PathBuf, BuildError> {
    if cfg!(all(target_env = "musl", target_feature = "crt-static")) {
        return Err(BuildError::Static);
    }
    let cache = Cache::find()?;
    let runtime_files = || {
        let files = bryant_runtime::source::FILES.iter();
        files.filter(|(path, _)| belongs(path))
    };
    let runtime_digest = rustc::digest(runtime_files().flat_map(|(path, text)| [*path, *text]));
    let digest = rustc::digest([&runtime_digest, source.module, source.exports]);
    let entry = entry_name(source.name, &rustc.key_of_text(&digest));
    let file = format!(
        "{}model{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    cache.entry(&entry, &file, |directory| {
        let key = rustc.key_of_text(&runtime_digest);
        let runtime = "libbryant_runtime.rlib";
        let runtime = cache.entry(&format!("equations-{key}"), runtime, |directory| {
            stage(Stage::Runtime);
            for (path, text) in runtime_files() {
                write(&directory.join(path), text)?;
            }
            let (crate_type, crate_name) = ("--crate-type=rlib", "--crate-name=bryant_runtime");
            rustc.compile(
                &directory.join("equations.rs"),
                &[
                    crate_type,
                    crate_name,
                    "--cfg=feature=\"std\"",
                    // leaves out the time loop, which these libraries do not use
                    "--cfg=bryant_equations",
                ],
                &directory.join(runtime),
                &cache,
                ("", &[]),
            )
        })?;
        stage(Stage::Compiling);
        write(&directory.join("model.rs"), source.module)?;
        write(&directory.join("main.rs"), source.exports)?;
        rustc.compile(
            &directory.join("main.rs"),
            &[
                "--crate-name=model",
                "--crate-type=cdylib",
                "-Cstrip=symbols",
                &format!("--extern=bryant_runtime={}", runtime.display()),
            ],
            &directory.join(&file),
            &cache,
            (source.module, source.texts),
        )
    })
}

/// True if a file belongs to the part of the runtime whose root is `equations.rs`.
fn belongs(path: &str) -> bool {
    let files = [
        "ffi.rs",
        "curve.rs",
        "dynamics.rs",
        "equations.rs",
        "model.rs",
        "real.rs",
        "section.rs",
        "version.rs",
    ];
    let folders = ["curve/", "force/", "real/"];
    let tests = path.ends_with("/tests.rs") || path.contains("/tests/");
    !tests && (files.contains(&path) || folders.iter().any(|folder| path.starts_with(folder)))
}

/// The error for a library that cannot be loaded; its remedy names the directory of the library.
pub(super) fn unusable(path: &Path, source: LoadError) -> BuildError {
    BuildError::Load {
        path: path.parent().unwrap_or(path).to_owned(),
        source,
    }
}

/// The text that begins every library. It redirects printed output to standard error with a prefix, because standard
/// output is for results.
fn start() -> String {
    format!(
        "\
macro_rules! println {{
    () => {{ ::std::eprintln!(\"[user force]\") }};
    ($($text:tt)*) => {{ ::std::eprintln!(\"[user force] {{}}\", ::std::format_args!($($text)*)) }};
}}
macro_rules! print {{
    ($($text:tt)*) => {{ ::std::eprint!($($text)*) }};
}}

mod model;

use bryant_runtime::ffi;

#[unsafe(no_mangle)]
extern \"C\" fn {}() -> u32 {{
    ffi::keep_what_panics_say();
    ffi::VERSION
}}

#[unsafe(no_mangle)]
unsafe extern \"C\" fn {}(place: *mut u8, length: usize) -> usize {{
    unsafe {{ ffi::said(place, length) }}
}}
",
        names::START,
        names::SAID
    )
}

/// The text of the exports of a library of user functions.
pub(super) fn exports_of_functions(apart: &Apart) -> String {
    let mut text = "//! Functions of a user's, to be loaded; written by bryant.\n".to_owned();
    text += &start();
    let mut arms = String::new();
    for (k, function) in apart.functions.iter().enumerate() {
        let (a, r, path) = (function.arguments, function.results, &function.path);
        text += &format!(
            "
struct Function{k};

impl ffi::Adapter<{a}, {r}> for Function{k} {{
    #[inline(always)]
    fn call<T: bryant_runtime::Real>(arguments: [T; {a}]) -> [T; {r}] {{
        model::{path}(arguments)
    }}
}}
"
        );
        arms += &format!("        {k} => ffi::function::<Function{k}, {a}, {r}>(base, order),\n");
    }
    text + &format!(
        "
#[unsafe(no_mangle)]
extern \"C\" fn {}(function: u32, base: u32, order: u32) -> Option<ffi::Call> {{
    match function {{
{arms}        _ => None,
    }}
}}
",
        names::FUNCTION
    )
}

/// The text of the exports of a library of a generated model, with a Jacobian or without.
pub(super) fn exports_of_model(jacobian: bool) -> String {
    let jacobian = match jacobian {
        true => "ByDuals",
        false => "NoJacobian",
    };
    let mut text = "//! A model, to be loaded; written by bryant.\n".to_owned();
    text += &start();
    text + &format!(
        "
use std::ffi::c_void;

type Mechanism = model::Mechanism<f64>;

#[unsafe(no_mangle)]
extern \"C\" fn {}() -> *mut c_void {{
    ffi::make::<Mechanism>()
}}

#[unsafe(no_mangle)]
unsafe extern \"C\" fn {}(model: *mut c_void) {{
    unsafe {{ ffi::discard::<Mechanism>(model) }}
}}

#[unsafe(no_mangle)]
unsafe extern \"C\" fn {}(
    model: *mut c_void,
    what: u32,
    t: f64,
    y: *const f64,
    y_length: usize,
    results: *mut f64,
    results_length: usize,
) -> i32 {{
    unsafe {{
        ffi::evaluate::<Mechanism, ffi::{jacobian}>(
            model, what, t, y, y_length, results, results_length,
        )
    }}
}}
",
        names::MAKE,
        names::DISCARD,
        names::EVALUATE
    )
}
