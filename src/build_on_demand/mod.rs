//! Compiles functions of user forces, or a whole model for comparison, as a library that is loaded into this process.
//!
//! ```text
//! runtime sources, what such a library needs ─rustc→ rlib ┐
//!                                                         ├─rustc→ library ─load→ functions
//! module of the user's functions, or of a model ──────────┘
//! ```
//!
//! Plain rustc is called, without cargo or a network. Results stay in a cache. The key of an entry covers everything
//! that affects it: the text of the model, this program, the compiler, the processor. An entry is built in another
//! directory and then moved to its place, so that two runs at once do not disturb each other, and an interrupted one
//! leaves no incomplete entry.

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod cache;
mod exports;
pub mod guard;
mod library;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod message;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod rustc;
mod rustc_model;
mod user_forces;

pub use cache::Cache;
pub use library::LoadError;
pub use rustc::Rustc;
pub use rustc_model::RustcModel;
pub use user_forces::{UserFailure, UserForces};

use bryant_generator::diagnostic::Diagnostics;
use std::path::{Path, PathBuf};

/// The environment variable for the directory above the system's directory for caches.
const HOME: &str = match cfg!(windows) {
    true => "LOCALAPPDATA",
    false => "HOME",
};

/// A model could not be compiled.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// There is no compiler.
    #[error(
        "the Rust compiler is needed here, but `{command}` cannot be started: {source}\n  \
         help: install Rust (https://rustup.rs), or name the compiler by RUSTC=/path/to/rustc"
    )]
    NoCompiler {
        /// The command that was tried.
        command: String,
        /// Why it did not start.
        source: std::io::Error,
    },
    /// The compiler does not answer its usual questions.
    #[error(
        "`{command} {arguments}` failed: {message}\n  help: name a working compiler by RUSTC=/path/to/rustc"
    )]
    BadCompiler {
        /// The command.
        command: String,
        /// Its arguments.
        arguments: String,
        /// Its message.
        message: String,
    },
    /// This program cannot load libraries.
    #[error(
        "user forces are compiled as a library, and this program cannot load any: it is linked statically, so that it runs on every Linux\n  \
         help: use the program for x86_64-unknown-linux-gnu or aarch64-unknown-linux-gnu, or build it: cargo install bryant"
    )]
    Static,
    /// There is no linker.
    #[error(
        "the compiler found no linker: {message}\n  help: install a C compiler, which brings one \
         (Debian and Ubuntu: apt install gcc; Fedora: dnf install gcc; macOS: xcode-select --install; Windows: the Build Tools for Visual Studio, with C++)"
    )]
    NoLinker {
        /// The message of the compiler.
        message: String,
    },
    /// A user function does not compile.
    #[error("{0}")]
    User(Diagnostics),
    /// The generated source does not compile, which is an error of this program.
    #[error(
        "the source written for this model does not compile, which is a fault of bryant, not of the model: {message}\n  \
         help: the source and all messages are kept in {}; please report them", .kept.display()
    )]
    Rejected {
        /// The first error.
        message: String,
        /// The directory where source and messages are kept.
        kept: PathBuf,
    },
    /// The cache cannot be used.
    #[error(
        "cannot keep compiled models in {}: {source}\n  help: name a writable directory by BRYANT_CACHE", .path.display()
    )]
    Cache {
        /// The file or directory.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
    /// Other users may have written into the cache.
    #[error(
        "{} is not used: {reason}, and what is in a cache is run with your rights\n  \
         help: make it yours alone (chown -R, chmod -R go-w), or name another directory by BRYANT_CACHE; it is created where it does not exist", .path.display()
    )]
    Untrusted {
        /// The file or directory.
        path: PathBuf,
        /// How others may have written.
        reason: &'static str,
    },
    /// A compiled library cannot be loaded.
    #[error(
        "the library that was compiled for this model cannot be loaded: {source}\n  help: remove {}; the library is then compiled again", .path.display()
    )]
    Load {
        /// Its directory in the cache.
        path: PathBuf,
        /// The reason.
        source: LoadError,
    },
    /// No directory for a cache is known.
    #[error(
        "there is no place for compiled models: neither BRYANT_CACHE nor XDG_CACHE_HOME nor {} is set\n  \
             help: name a writable directory by BRYANT_CACHE",
        HOME
    )]
    NoCache,
}

/// A module to compile.
#[derive(Clone, Copy, Debug)]
pub struct Unit<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// Digest of the model.
    pub digest: &'a str,
    /// The user's texts that the module contains.
    pub texts: &'a [Text<'a>],
}

/// Rust text of the user.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a> {
    /// The file, as shown to the user.
    pub name: &'a str,
    /// The content of the file.
    pub text: &'a str,
}

/// The steps before a model can run, for a progress indication.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The runtime is compiled, once for all models.
    Runtime,
    /// The equations are derived and written.
    Generating,
    /// The generated source is compiled.
    Compiling,
}

/// Name of a directory in the cache.
fn entry_name(model: &str, key: &str) -> String {
    let plain = |c: &char| c.is_ascii_alphanumeric() || *c == '-';
    let name: String = model.chars().filter(plain).take(60).collect();
    format!("{name}-{key}")
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
