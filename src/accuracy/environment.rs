//! The conditions, besides the model, that affect measured times: the program, how it evaluates equations, the
//! processor.

use crate::equations::Engine;

/// The program and the machine that made a study.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Environment {
    /// Version of bryant.
    pub version: String,
    /// Commit that the program was built from, "unknown" if there was no repository.
    pub commit: String,
    /// The evaluation of equations: "machine code (AVX2)".
    pub engine: String,
    /// Architecture and operating system: "x86_64-linux".
    pub target: String,
    /// Vector instructions that the processor has, sorted.
    pub features: Vec<String>,
}

impl Environment {
    /// The environment of this process.
    pub fn of(engine: &Engine) -> Environment {
        Environment {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("BRYANT_COMMIT").to_owned(),
            engine: engine.arithmetic().to_owned(),
            target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            features: features(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn features() -> Vec<String> {
    let known = [
        ("avx", is_x86_feature_detected!("avx")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
        ("fma", is_x86_feature_detected!("fma")),
    ];
    let there = known.iter().filter(|(_, there)| *there);
    there.map(|(name, _)| (*name).to_owned()).collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn features() -> Vec<String> {
    Vec::new()
}
