//! Reads the description of a tree of rigid elements and writes its equations of motion as Rust source.

pub mod description;
pub mod diagnostic;
pub mod equations;
pub mod expression;
pub mod formalism;
pub mod model;

pub use diagnostic::{Diagnostic, Diagnostics};

/// Why there is no source.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The description is wrong; every problem with its place and remedy.
    #[error("{0}")]
    Description(#[from] Diagnostics),
    /// A file could not be written, or a directory not be found.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: std::path::PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}
