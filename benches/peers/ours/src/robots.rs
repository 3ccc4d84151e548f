//! The robots of the comparison: URDF files in the folder `ROBOTS`, written by `robots.py`.

use bryant_generator::urdf::{Base, Imported, Options, import};
use std::path::Path;

/// Their names, and what their bases do.
pub const ROBOTS: [(&str, Base); 5] = [
    ("panda", Base::Fixed),
    ("ur5", Base::Fixed),
    ("hyq", Base::Free),
    ("anymal", Base::Free),
    ("talos", Base::Free),
];

/// A robot of the folder.
pub fn read(folder: &Path, name: &str, base: Base) -> Result<Imported, Box<dyn std::error::Error>> {
    let text = std::fs::read_to_string(folder.join(name).with_extension("urdf"))?;
    let options = Options {
        base,
        ..Options::default()
    };
    Ok(import(name, &text, &options)?)
}
