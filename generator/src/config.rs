//! The front door for build scripts: which models to read, where to write their modules, what to tell cargo.
//!
//! [`Config::generate_str`] is the pure core, text in, text out; [`Config::generate`] the shell around it with files and
//! messages. Files are replaced as a whole and only where their text changes.

use crate::description::load::read_bytes;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{self, Coordinates, Dimension, ForceKind, Model};
use crate::program::{self, Lists};
use crate::target::{c, rust};
use crate::{Error, dynamics};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// What to generate, and where.
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
    options: program::Options,
}

/// A generated module.
#[derive(Clone, Debug)]
pub struct Generated {
    /// What `include_model!` is given: the name of the YAML file without its extension.
    pub name: String,
    /// The model.
    pub model: Model,
    /// The text of the module.
    pub source: String,
    /// Files read: the YAML first, then what it includes.
    pub read: Vec<PathBuf>,
    /// Where [`Config::generate`] wrote the text; empty where nothing was written. In cargo's `OUT_DIR` files of the user's are included by
    /// their path instead of pasted, so that the compiler shows what is wrong with them where they are.
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
            options: program::Options::default(),
        }
    }

    /// Adds a model: the path of its YAML file, relative to the crate.
    pub fn model(&mut self, path: impl Into<PathBuf>) -> &mut Self {
        self.models.push(path.into());
        self
    }

    /// Adds every `*.yaml` in a directory, not in directories below it.
    pub fn models_in(&mut self, directory: impl Into<PathBuf>) -> &mut Self {
        self.directories.push(directory.into());
        self
    }

    /// Where the modules go, each as `NAME.rs`, instead of to `OUT_DIR`.
    pub fn out_dir(&mut self, directory: impl Into<PathBuf>) -> &mut Self {
        self.out_dir = Some(directory.into());
        self
    }

    /// Where [`generate`](Self::generate) writes each model as C99, too: `NAME.h` and `NAME.c`, whose functions have the names of the
    /// model's methods behind that of the model. They need nothing but `math.h`.
    pub fn emit_c(&mut self, directory: impl Into<PathBuf>) -> &mut Self {
        self.c_dir = Some(directory.into());
        self
    }

    /// Whether there are methods for S, r_s and r_k, which need the runtime's feature `nalgebra`. There are by default. A crate that turns
    /// this feature off (`bryant-runtime = { …, default-features = false, features = ["libm"] }`) asks for `matrices(false)`; if it does not,
    /// the compiler says so.
    pub fn matrices(&mut self, matrices: bool) -> &mut Self {
        self.options.matrices = matrices;
        self
    }

    /// Statements up to which a method is compiled as one function; 3000 unless said otherwise. Longer ones are calls: of functions that
    /// like elements share, where half of a method is such and not too much is left, of its pieces otherwise. Calls compile faster, and
    /// cost some time.
    pub fn merged(&mut self, statements: usize) -> &mut Self {
        self.options.merged = statements;
        self
    }

    /// Describes orientation by these coordinates, whatever the models say. In the plane there is no choice.
    pub fn coordinates(&mut self, coordinates: Coordinates) -> &mut Self {
        self.coordinates = Some(coordinates);
        self
    }

    /// The module of a model.
    pub fn source(&self, model: &Model) -> String {
        let options = dynamics::Options {
            matrices: self.options.matrices,
            ..Default::default()
        };
        rust::module(model, &dynamics::derive_with(model, options), &self.options)
    }

    /// A model as C99, with the operations of [`Self::source`].
    ///
    /// # Errors
    /// A model that calls functions of the user's, which are Rust.
    pub fn c_source(&self, model: &Model) -> Result<c::Source, c::NoC> {
        let options = dynamics::Options {
            matrices: self.options.matrices,
            ..Default::default()
        };
        let equations = dynamics::derive_with(model, options);
        let lists = program::lists(model, &equations, &self.options);
        c::source(&lists, &program::about(model, &equations))
    }

    /// The methods of a model as lists, with the operations of [`Self::source`] to the last bit.
    pub fn lists(&self, model: &Model) -> Lists {
        let options = dynamics::Options {
            matrices: self.options.matrices,
            ..Default::default()
        };
        let equations = dynamics::derive_with(model, options);
        program::lists(model, &equations, &self.options)
    }

    /// The module of the model in a YAML text. `name` stands for the file in messages; included files are asked for by
    /// their path relative to it.
    ///
    /// # Errors
    /// Every problem of the text.
    pub fn generate_str(
        &self,
        name: &str,
        text: &str,
        loader: &dyn Fn(&Path) -> io::Result<String>,
    ) -> Result<Generated, Diagnostics> {
        let (model, read) = model::read_str(name, text, loader)?;
        Ok(self.generated(Path::new(name), model, read))
    }

    /// Reads the models and writes one file for each; tells cargo which files it read and, if there are any, which
    /// problems it found.
    ///
    /// # Errors
    /// Every problem of every model; a file that cannot be read or written. Nothing is written if a model is wrong.
    pub fn generate(&self) -> Result<Vec<Generated>, Error> {
        let result = self.read_and_write();
        if let Err(error) = &result
            && under_cargo()
        {
            report(error);
        }
        result
    }

    /// [`generate`](Self::generate) for build scripts that do nothing else: problems are cargo's to show, without the
    /// remains of a failed program around them. Outside of cargo they go to standard error, and the process ends.
    pub fn generate_or_report(&self) -> Vec<Generated> {
        match self.generate() {
            Ok(generated) => generated,
            // Cargo fails the build because of the problems reported.
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
            match model::read(&path) {
                Ok((model, read)) => {
                    read.iter().for_each(|path| rerun_if_changed(path));
                    all.push(self.generated(&path, model, read));
                }
                // Which files it includes is not known; cargo runs a script that failed again in any case.
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

    /// All models as C, where that is asked for.
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

    /// The models named, then those of the directories by name.
    fn paths(&self) -> Result<Vec<PathBuf>, Error> {
        let mut paths = self.models.clone();
        for directory in &self.directories {
            // A directory is watched too: a model added to it is to be found.
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

/// What `include_model!` looks a name up in.
const INDEX: &str = "bryant-models.rs";

/// A variable of this name and that of the model has the path of its module, where the crate is compiled.
const VARIABLE: &str = "BRYANT_MODEL_";

/// The macro that `include_model!` calls: it takes in a model that a build script wrote to this directory, by whichever call, or is an error
/// that lists them.
fn index(directory: &Path) -> io::Result<String> {
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

/// How the text of every module begins.
const HEAD: &str = "// @generated by bryant-generator";

/// The text of a module with files of the user's included by path. One that begins with documentation or attributes of the file itself
/// (`//!`, `#![…]`) cannot be included, and stays pasted.
#[doc(hidden)]
pub fn including(generated: &Generated) -> String {
    let mut text = generated.source.clone();
    let beside = generated.read.first().and_then(|model| model.parent());
    for force in &generated.model.forces {
        let ForceKind::User(user) = &force.kind else {
            continue;
        };
        let Some(source) = &user.function.source else {
            continue;
        };
        let path = beside.map_or(PathBuf::from(&source.name), |at| at.join(&source.name));
        // As the compiler finds it: from the directory of the package, where build scripts run.
        let included = syn::parse_file(&source.text)
            .is_ok_and(|file| file.attrs.is_empty() && file.shebang.is_none())
            && path.is_file();
        if included {
            let shown = path.display().to_string();
            let place = match path.is_absolute() {
                // such a path may begin with `\\?\` on Windows, which needs backslashes
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

/// Two models that would be written to one file.
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

/// Cargo sets both for build scripts, and not both for anything else.
fn under_cargo() -> bool {
    std::env::var_os("CARGO_MANIFEST_DIR").is_some() && std::env::var_os("OUT_DIR").is_some()
}

fn rerun_if_changed(path: &Path) {
    if under_cargo() {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}

/// One line for cargo per problem.
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

/// Replaces a file as a whole, unless it has this text already.
fn write(path: &Path, text: &str) -> io::Result<()> {
    if read_bytes(path, text.len() as u64).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    // In the same directory, so that renaming stays within one file system.
    let temporary = path.with_extension(format!("{}.tmp", std::process::id()));
    std::fs::write(&temporary, text)?;
    std::fs::rename(&temporary, path).inspect_err(|_| {
        // The first error is the one to tell.
        let _ = std::fs::remove_file(&temporary);
    })
}

#[cfg(test)]
mod tests {
    use super::index;
    use std::path::Path;

    #[test]
    fn the_index_has_what_the_generator_wrote_and_nothing_else() {
        let at = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target-of-no-name");
        assert!(index(&at).is_err(), "there is no such directory");

        let at = std::env::temp_dir().join(format!("bryant-index-{}", std::process::id()));
        std::fs::create_dir_all(&at).expect("a directory");
        let text = "// @generated by bryant-generator 0.2.0 from arm.yaml\n";
        std::fs::write(at.join("arm.rs"), text).expect("a file");
        std::fs::write(at.join("my-leg.rs"), text).expect("a file");
        std::fs::write(
            at.join("other.rs"),
            "// of another build script, which is long enough\n",
        )
        .expect("a file");
        let index = index(&at).expect("a text");
        std::fs::remove_dir_all(&at).expect("removed");
        assert!(
            index.contains("the build script made: arm, my-leg\""),
            "{index}"
        );
        let file = syn::parse_file(&index).expect("Rust");
        assert_eq!(file.items.len(), 1);
    }
}
