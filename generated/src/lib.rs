//! The bundled models, compiled: one module for each file in `models/`, written by the build script, and a table of all
//! models.
//!
//! The entry points for `f64` are compiled here, so that crates that use them need not compile the equations again.

use bryant_runtime::program::Entry;

/// A bundled model.
#[derive(Clone, Copy, Debug)]
pub struct Bundled {
    /// The compiled equations, over `f64`.
    pub entry: Entry,
    /// Names and texts of its YAML files: the model first, then the files that it includes. Names are relative to the
    /// directory of the model.
    pub texts: &'static [(&'static str, &'static str)],
}

impl Bundled {
    /// The YAML of the model.
    pub fn yaml(&self) -> &'static str {
        self.texts.first().map_or("", |(_, text)| text)
    }

    /// The text of a file by the name that an include uses.
    pub fn file(&self, name: &str) -> Option<&'static str> {
        self.texts
            .iter()
            .find(|(file, _)| *file == name)
            .map(|(_, text)| *text)
    }
}

/// The model with this name.
pub fn find(name: &str) -> Option<&'static Bundled> {
    MODELS.iter().find(|model| model.entry.info.name == name)
}

include!(concat!(env!("OUT_DIR"), "/all.rs"));
