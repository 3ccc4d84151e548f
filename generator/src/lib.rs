//! Reads the description of a tree of rigid elements and writes its equations of motion as Rust source.
//!
//! In the `main` of a build script
//!
//! ```no_run
//! bryant_generator::Config::new().model("models/arm.yaml").generate_or_report();
//! ```
//!
//! and in the crate `mod arm { bryant_runtime::include_model!("arm"); }`.

pub mod config;
pub mod description;
pub mod diagnostic;
pub mod effect;
pub mod emit;
pub mod equations;
pub mod expression;
pub mod formalism;
pub mod model;
pub mod program;
pub mod target;

pub use config::{Config, Generated};
pub use diagnostic::{Diagnostic, Diagnostics};

/// Why there is no source.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The description is wrong; every problem with its place and remedy.
    #[error("{0}")]
    Description(#[from] Diagnostics),
    /// A file could not be written, or a directory not be found.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: std::path::PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// As `Display`: what a build script shows that hands the error on by `?`.
impl std::fmt::Debug for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{self}")
    }
}
