//! Lists the valid models that cases spoil: those of the workspace, or the copies in a package, which `.ci/package`
//! puts into `samples`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Files of the workspace, relative to this crate.
const SAMPLES: [&str; 16] = [
    "../models/sled-pendulum.yaml",
    "../tests/models/bending.yaml",
    "../tests/models/curves.yaml",
    "../tests/models/discs.yaml",
    "../tests/models/edge-space.yaml",
    "../tests/models/incline.yaml",
    "../tests/models/joint-stops.yaml",
    "../tests/models/loads.yaml",
    "../tests/models/motions.yaml",
    "../tests/models/plastic-bounce.yaml",
    "../tests/models/prescribed.yaml",
    "../tests/models/switches.yaml",
    "../tests/models/twin-space.yaml",
    "../tests/models/vehicle-turned.yaml",
    "../tests/models/webbing.yaml",
    "scenes/oscillator.yaml",
];

/// The file that one of them includes.
const PULSE: &str = "../tests/models/data/pulse.csv";

fn main() -> std::io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let packed = Path::new("samples").is_dir();
    if packed {
        println!("cargo::rerun-if-changed=samples");
    }
    let place = |file: &str| -> std::io::Result<PathBuf> {
        let file = Path::new(file);
        let path = match file.file_name() {
            Some(name) if packed && file.starts_with("..") => Path::new("samples").join(name),
            _ => file.to_owned(),
        };
        println!("cargo::rerun-if-changed={}", path.display());
        std::path::absolute(path)
    };
    let mut table = String::from("/// The valid models.\npub const ALL: &[(&str, &str)] = &[\n");
    for sample in SAMPLES {
        let path = place(sample)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let _ = writeln!(
            table,
            "    ({name:?}, include_str!({:?})),",
            path.display().to_string()
        );
    }
    let pulse = place(PULSE)?.display().to_string();
    let _ = writeln!(
        table,
        "];\n\n/// The text of the file that one of them includes.\npub const PULSE: &str = include_str!({pulse:?});"
    );
    let out = std::env::var_os("OUT_DIR").unwrap_or_default();
    std::fs::write(Path::new(&out).join("samples.rs"), table)
}
