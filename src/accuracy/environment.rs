//! What a time depends on beside the model: this program, the compiler, the processor.

use crate::build_on_demand::{BuildError, Rustc};

/// Where and by what a study was made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Environment {
    /// Version of bryant.
    pub version: String,
    /// Commit that it was built from, "unknown" where there was no repository.
    pub commit: String,
    /// "rustc 1.95.0 (…)"
    pub rustc: String,
    /// Architecture and operating system: "x86_64-linux".
    pub target: String,
    /// Features of the processor that the compiler was told to use, sorted.
    pub features: Vec<String>,
}

impl Environment {
    /// Of this process and the compiler that it uses.
    ///
    /// # Errors
    /// There is no compiler.
    pub fn here() -> Result<Environment, BuildError> {
        let rustc = Rustc::find()?;
        Ok(Environment {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("BRYANT_COMMIT").to_owned(),
            rustc: rustc.version().to_owned(),
            target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            features: rustc.features(),
        })
    }
}
