//! The entry point for build scripts: the models to read, the files to write, and the messages to cargo.
//!
//! [`Config::generate_str`] is the core without files: text in, text out. [`Config::generate`] adds files and messages.
//! A file is replaced as a whole, and only if its text changes.

use crate::description::load::read_bytes;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::dynamics;
use crate::dynamics::functions::{Request, requests};
use crate::equations::Equations;
use crate::law::ForceKind;
use crate::model::{Coordinates, Dimension, Model};
use crate::program::{self, Costs, Lists};
use crate::read::{read, read_str};
use crate::target::{c, rust, summary};
use std::fmt;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// The reason why no source was generated.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The description is wrong; every problem with its place and remedy.
    #[error("{0}")]
    Description(#[from] Diagnostics),
    /// A file could not be read or written, or a directory was not found.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
}

/// The same as `Display`, because a build script that returns the error by `?` prints it by `Debug`.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

/// The models to generate, with options and directories.
///
/// ```no_run
/// # fn main() -> Result<(), bryant_generator::Error> {
/// bryant_generator::Config::new().model("models/arm.yaml").model("models/leg.yaml").generate()?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Config {
    models: Vec<PathBuf>,
    directories: Vec<PathBuf>,
    out_dir: Option<PathBuf>,
    c_dir: Option<PathBuf>,
    coordinates: Option<Coordinates>,
    functions: Vec<String>,
    options: program::Options,
}

/// A generated module.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The name to give to `include_model!`: that of the YAML file without its extension.
    pub name: String,
    /// The model.
    pub model: Model,
    /// The text of the module.
    pub source: String,
    /// The files read: the YAML first, then the files that it includes.
    pub read: Vec<PathBuf>,
    /// The file to which [`Config::generate`] wrote the text; empty if nothing was written. In cargo's `OUT_DIR`, the
    /// user's own Rust files are included by path instead of pasted, so that compiler messages point to these files.
    pub written: PathBuf,
}

impl Default for Config {
    fn default() -> Self {
        Self::new()
    }
}

impl Config {
    /// No models; output to cargo's `OUT_DIR`.
    pub fn new() -> Self {
        Self {
            models: Vec::new(),
            directories: Vec::new(),
            out_dir: None,
            c_dir: None,
            coordinates: None,
            functions: Vec::new(),
            options: program::Options::default(),
        }
    }

    /// Adds a model: the path of its YAML file, relative to the crate.
    pub fn model(&mut self, path: impl Into<PathBuf>) -> &mut Self {
        self.models.push(path.into());
        self
    }

    /// Adds every `*.yaml` of a directory, without its subdirectories.
    pub fn models_in(&mut self, directory: impl Into<PathBuf>) -> &mut Self {
        self.directories.push(directory.into());
        self
    }

    /// Sets the directory to which the modules are written, each as `NAME.rs`, instead of `OUT_DIR`.
    pub fn out_dir(&mut self, directory: impl Into<PathBuf>) -> &mut Self {
        self.out_dir = Some(directory.into());
        self
    }

    /// Sets a directory to which [`generate`](Self::generate) also writes each model as C99: `NAME.h` and `NAME.c`. The
    /// functions are named after the model and its methods. They need nothing but `math.h`.
    pub fn emit_c(&mut self, directory: impl Into<PathBuf>) -> &mut Self {
        self.c_dir = Some(directory.into());
        self
    }

    /// Whether to generate the methods for S, r_s and r_k, which need the runtime's feature `nalgebra`; the default is
    /// true. A crate that turns this feature off
    /// (`bryant-runtime = { …, default-features = false, features = ["libm"] }`) must set `matrices(false)`; otherwise
    /// the compiler reports it.
    pub fn matrices(&mut self, matrices: bool) -> &mut Self {
        self.options.matrices = matrices;
        self
    }

    /// Sets the largest number of statements of a method that is compiled as one function; the default is 3000. A
    /// longer method calls its pieces. Calls compile faster, but take some run time.
    pub fn merged(&mut self, statements: usize) -> &mut Self {
        self.options.merged = statements;
        self
    }

    /// Describes orientations by these coordinates, in place of those that the models state. In the plane there is no
    /// choice.
    pub fn coordinates(&mut self, coordinates: Coordinates) -> &mut Self {
        self.coordinates = Some(coordinates);
        self
    }

    /// Asks for [functions](crate::dynamics::functions) by their names, in addition to those that were asked for
    /// before: `["inverse_dynamics", "jacobian(arm/hand)"]`. They become methods of the mechanism, functions in C and
    /// functions of the lists. A function that each model has in any case (`kinetic_energy`; `mass_matrix` and
    /// `applied_forces` unless [`matrices`](Self::matrices) is false) is not written a second time in Rust and C.
    pub fn functions<S: Into<String>>(&mut self, names: impl IntoIterator<Item = S>) -> &mut Self {
        self.functions.extend(names.into_iter().map(Into::into));
        self
    }

    /// The functions that are asked for, of this model. `file` stands for the model in messages.
    ///
    /// # Errors
    /// All functions and frames that the model does not have; functions whose derivation is not possible, because the
    /// model has a law that cannot be differentiated in symbols.
    pub fn requests(&self, model: &Model, file: &str) -> Result<Vec<Request>, Diagnostics> {
        let found = requests(model, file, self.functions.iter().map(String::as_str))?;
        let doubtful = found.iter().filter(|of| of.function().may_be_impossible());
        let doubtful: Vec<Request> = doubtful.cloned().collect();
        if doubtful.is_empty() {
            return Ok(found);
        }
        let equations = dynamics::derive_functions(model, dynamics::Options::default(), &doubtful);
        let problems = equations.impossible.iter().map(|of| {
            let (function, what) = (&of.function, of.what);
            Diagnostic::of_file(
                file,
                format!("{function} is not possible: {what} cannot be differentiated in symbols"),
                "differentiate by dual numbers, as `bryant gradient` and the engine over `Dual` do, or leave the law out",
            )
        });
        let problems: Vec<Diagnostic> = problems.collect();
        match problems.is_empty() {
            true => Ok(found),
            false => Err(Diagnostics { problems }),
        }
    }

    /// The equations of a model, with the functions that are asked for.
    fn equations(&self, model: &Model) -> Equations {
        let requests = self.requests(model, &model.name);
        let requests = requests.unwrap_or_else(|problems| panic!("{problems}"));
        let options = dynamics::Options {
            matrices: self.options.matrices,
            ..Default::default()
        };
        dynamics::derive_functions(model, options, &requests)
    }

    /// The module of a model.
    ///
    /// # Panics
    /// If the model does not have a function that is asked for: [`requests`](Self::requests) tells.
    pub fn source(&self, model: &Model) -> String {
        rust::module(model, &self.equations(model), &self.options)
    }

    /// A model as C99, with the same operations as [`Self::source`].
    ///
    /// # Errors
    /// If the model calls functions of the user, which are Rust.
    ///
    /// # Panics
    /// If the model does not have a function that is asked for: [`requests`](Self::requests) tells.
    pub fn c_source(&self, model: &Model) -> Result<c::Source, c::NoC> {
        let equations = self.equations(model);
        let lists = program::lists(model, &equations, &self.options);
        c::source(&lists, &summary::lines(model, &equations))
    }

    /// The methods of a model as lists, with the same operations as [`Self::source`], bit for bit.
    ///
    /// # Panics
    /// If the model does not have a function that is asked for: [`requests`](Self::requests) tells.
    pub fn lists(&self, model: &Model) -> Lists {
        program::lists(model, &self.equations(model), &self.options)
    }

    /// The operations of each method and of each function that is asked for.
    ///
    /// # Panics
    /// If the model does not have a function that is asked for: [`requests`](Self::requests) tells.
    pub fn costs(&self, model: &Model) -> Costs {
        program::costs(model, &self.equations(model), &self.options)
    }

    /// The module of the model in a YAML text. `name` stands for the file in messages; `loader` is asked for included
    /// files by their path relative to it.
    ///
    /// # Errors
    /// All problems found in the text.
    pub fn generate_str(
        &self,
        name: &str,
        text: &str,
        loader: &dyn Fn(&Path) -> io::Result<String>,
    ) -> Result<Generated, Diagnostics> {
        let (model, read) = read_str(name, text, loader)?;
        self.requests(&model, name)?;
        Ok(self.generated(Path::new(name), model, read))
    }

    /// Reads the models and writes one file for each. Tells cargo which files were read and which problems were found.
    ///
    /// # Errors
    /// All problems of all models, or a file that cannot be read or written. If a model has a problem, nothing is
    /// written.
    pub fn generate(&self) -> Result<Vec<Generated>, Error> {
        let result = self.read_and_write();
        if let Err(error) = &result
            && under_cargo()
        {
            report(error);
        }
        result
    }

    /// Calls [`generate`](Self::generate), for build scripts that do nothing else. Cargo shows the problems, without
    /// the traces of a failed program around them. Outside of cargo, the problems go to standard error, and the process
    /// ends.
    pub fn generate_or_report(&self) -> Vec<Generated> {
        match self.generate() {
            Ok(generated) => generated,
            // Cargo fails the build because problems have been reported.
            Err(_) if under_cargo() => Vec::new(),
            Err(error) => {
                eprintln!("{error}");
                std::process::exit(2);
            }
        }
    }

    fn read_and_write(&self) -> Result<Vec<Generated>, Error> {
        let out_dir = self.output_directory()?;
        let mut problems = Vec::new();
        let mut all = Vec::new();
        for path in self.paths()? {
            match read(&path) {
                Ok((model, read)) => {
                    read.iter().for_each(|path| rerun_if_changed(path));
                    match self.requests(&model, &path.display().to_string()) {
                        Ok(_) => all.push(self.generated(&path, model, read)),
                        Err(found) => problems.extend(found.problems),
                    }
                }
                // The files that it includes are unknown; but cargo always runs a failed script again.
                Err(found) => {
                    rerun_if_changed(&path);
                    problems.extend(found.problems);
                }
            }
        }
        problems.extend(same_names(&all));
        let as_c = self.all_as_c(&all).unwrap_or_else(|found| {
            problems.extend(found);
            Vec::new()
        });
        if !problems.is_empty() {
            return Err(Diagnostics { problems }.into());
        }
        std::fs::create_dir_all(&out_dir).map_err(|source| Error::File {
            path: out_dir.clone(),
            source,
        })?;
        let file = |path: &Path, text: &str| {
            write(path, text).map_err(|source| Error::File {
                path: path.to_path_buf(),
                source,
            })
        };
        if let Some(directory) = &self.c_dir {
            std::fs::create_dir_all(directory).map_err(|source| Error::File {
                path: directory.clone(),
                source,
            })?;
            for c::Source {
                name,
                header,
                source,
            } in &as_c
            {
                file(&directory.join(format!("{name}.h")), header)?;
                file(&directory.join(format!("{name}.c")), source)?;
            }
        }
        let of_cargo = self.out_dir.is_none();
        for generated in &mut all {
            generated.written = out_dir.join(format!("{}.rs", generated.name));
            match of_cargo {
                true => file(&generated.written, &including(generated))?,
                false => file(&generated.written, &generated.source)?,
            }
        }
        if of_cargo {
            if under_cargo() {
                for Generated { name, written, .. } in &all {
                    println!("cargo::rustc-env={VARIABLE}{name}={}", written.display());
                }
            }
            let index = index(&out_dir).map_err(|source| Error::File {
                path: out_dir.clone(),
                source,
            })?;
            file(&out_dir.join(INDEX), &index)?;
        }
        Ok(all)
    }

    /// All models as C, if C is wanted.
    fn all_as_c(&self, all: &[Generated]) -> Result<Vec<c::Source>, Vec<Diagnostic>> {
        let mut problems = Vec::new();
        let mut sources: Vec<c::Source> = Vec::new();
        let wanted = all.iter().filter(|_| self.c_dir.is_some());
        for generated in wanted {
            let file = generated.read.first();
            let file = file.map_or(generated.name.clone(), |file| file.display().to_string());
            match self.c_source(&generated.model) {
                Ok(source) if sources.iter().any(|other| other.name == source.name) => {
                    problems.push(Diagnostic::of_file(
                        file,
                        format!("{}.c would be another model's, too", source.name),
                        "rename one of the two models",
                    ));
                }
                Ok(source) => sources.push(source),
                Err(none) => problems.push(Diagnostic::of_file(
                    file,
                    format!(
                        "there is no C of this model: {} is Rust",
                        none.functions.join(", ")
                    ),
                    "leave the force out, or describe it by curves",
                )),
            }
        }
        match problems.is_empty() {
            true => Ok(sources),
            false => Err(problems),
        }
    }

    fn generated(&self, path: &Path, mut model: Model, read: Vec<PathBuf>) -> Generated {
        if let Some(coordinates) = self
            .coordinates
            .filter(|_| model.dimension == Dimension::Space)
        {
            model.coordinates = coordinates;
            model.normalize();
        }
        let name = path
            .file_stem()
            .map(|stem| stem.to_string_lossy().into_owned());
        Generated {
            name: name.unwrap_or_else(|| model.name.clone()),
            source: self.source(&model),
            model,
            read,
            written: PathBuf::new(),
        }
    }

    fn output_directory(&self) -> Result<PathBuf, Error> {
        let from_cargo = || std::env::var_os("OUT_DIR").map(PathBuf::from);
        self.out_dir
            .clone()
            .or_else(from_cargo)
            .ok_or_else(|| Error::File {
                path: PathBuf::from("OUT_DIR"),
                source: io::Error::new(
                    io::ErrorKind::NotFound,
                    "not set: outside of a build script, say where to write with Config::out_dir",
                ),
            })
    }

    /// The models that were named, then those of the directories, sorted by name.
    fn paths(&self) -> Result<Vec<PathBuf>, Error> {
        let mut paths = self.models.clone();
        for directory in &self.directories {
            // The directory itself is watched, too, so that a model added to it is found.
            rerun_if_changed(directory);
            let error = |source| Error::File {
                path: directory.clone(),
                source,
            };
            let mut found = Vec::new();
            for entry in std::fs::read_dir(directory).map_err(error)? {
                let path = entry.map_err(error)?.path();
                if path
                    .extension()
                    .is_some_and(|extension| extension == "yaml")
                    && path.is_file()
                {
                    found.push(path);
                }
            }
            found.sort();
            paths.append(&mut found);
        }
        Ok(paths)
    }
}

/// The file in which `include_model!` looks up names.
const INDEX: &str = "bryant-models.rs";

/// Prefix of an environment variable: followed by the name of a model, it holds the path of the model's module while
/// the crate is compiled.
const VARIABLE: &str = "BRYANT_MODEL_";

/// The text of the macro that `include_model!` calls. The macro includes a model that any call of a build script wrote
/// to this directory; for another name it is an error that lists the models there.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn index(directory: &Path) -> io::Result<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(directory)? {
        let path = entry?.path();
        let name = path.file_stem().map(|stem| stem.to_string_lossy());
        let (Some(name), Some("rs")) = (name, path.extension().and_then(|e| e.to_str())) else {
            continue;
        };
        let mut head = [0; HEAD.len()];
        let read = std::fs::File::open(&path).and_then(|mut file| file.read_exact(&mut head));
        if read.is_ok() && head == *HEAD.as_bytes() {
            names.push(name.into_owned());
        }
    }
    names.sort();
    let listed = match names.is_empty() {
        true => "the build script made none".to_string(),
        false => format!("the build script made: {}", names.join(", ")),
    };
    let text = format!(
        "macro_rules! bryant_models {{
    ($name:expr) => {{
        ::core::include!(::core::env!(
            ::core::concat!({VARIABLE:?}, $name),
            ::core::concat!(\"there is no model \\\"\", $name, {:?})
        ));
    }};
}}
",
        format!("\"; {listed}")
    );
    Ok(text)
}

/// The beginning of every module.
const HEAD: &str = "// @generated by bryant-generator";

/// The text of a module in which the user's Rust files are included by path. A file that begins with documentation or
/// attributes of its own (`//!`, `#![…]`) cannot be included, so it stays pasted.
#[doc(hidden)]
pub fn including(generated: &Generated) -> String {
    let mut text = generated.source.clone();
    let beside = generated.read.first().and_then(|model| model.parent());
    for force in &generated.model.forces {
        let ForceKind::User(user) = ForceKind::of(force) else {
            continue;
        };
        let Some(source) = &user.function.source else {
            continue;
        };
        let path = beside.map_or(PathBuf::from(&source.name), |at| at.join(&source.name));
        // The path as the compiler finds it: relative to the package's directory, in which build scripts run.
        let included = syn::parse_file(&source.text)
            .is_ok_and(|file| file.attrs.is_empty() && file.shebang.is_none())
            && path.is_file();
        if included {
            let shown = path.display().to_string();
            let place = match path.is_absolute() {
                // an absolute path may begin with `\\?\` on Windows, which needs backslashes
                true => format!("{shown:?}"),
                false => format!(
                    "::core::concat!(::core::env!(\"CARGO_MANIFEST_DIR\"), {:?})",
                    format!("/{}", shown.replace('\\', "/"))
                ),
            };
            text = text.replace(
                &rust::pasted(source),
                &format!("    ::core::include!({place});\n"),
            );
        }
    }
    text
}

/// A problem for each two models that would be written to one file.
fn same_names(all: &[Generated]) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    for (i, generated) in all.iter().enumerate() {
        if let Some(first) = all[..i].iter().find(|other| other.name == generated.name)
            && let (Some(file), Some(other)) = (generated.read.first(), first.read.first())
        {
            problems.push(Diagnostic::of_file(
                file.display().to_string(),
                format!(
                    "{} would be generated from {} too",
                    generated.name,
                    other.display()
                ),
                "rename one of the two files",
            ));
        }
    }
    problems
}

/// True in a build script: only there does cargo set both variables.
fn under_cargo() -> bool {
    std::env::var_os("CARGO_MANIFEST_DIR").is_some() && std::env::var_os("OUT_DIR").is_some()
}

fn rerun_if_changed(path: &Path) {
    if under_cargo() {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}

/// Reports each problem to cargo on one line.
fn report(error: &Error) {
    match error {
        Error::Description(problems) => {
            problems
                .lines()
                .for_each(|line| println!("cargo::error={}", line.replace('\n', " ")));
        }
        error => println!("cargo::error={}", error.to_string().replace('\n', " ")),
    }
}

/// Replaces a file as a whole, unless it has the same text already.
fn write(path: &Path, text: &str) -> io::Result<()> {
    if read_bytes(path, text.len() as u64).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    // The temporary file is in the same directory, so that renaming stays within one file system.
    let temporary = path.with_extension(format!("{}.tmp", std::process::id()));
    std::fs::write(&temporary, text)?;
    std::fs::rename(&temporary, path).inspect_err(|_| {
        // The first error is returned, so a second one is ignored.
        let _ = std::fs::remove_file(&temporary);
    })
}
