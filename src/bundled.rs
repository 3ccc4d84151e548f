//! The models that come with the program.

use bryant_generator::diagnostic::Diagnostics;
use bryant_generator::model::{self, Model};
use bryant_runtime::program::Entry;

/// A model compiled into this program, with the text it was made from.
#[derive(Debug)]
pub struct Bundled {
    entry: Entry,
    yaml: &'static str,
}

impl Bundled {
    /// Its name.
    pub fn name(&self) -> &'static str {
        self.entry.info.name
    }

    /// The compiled model.
    pub fn entry(&'static self) -> &'static Entry {
        &self.entry
    }

    /// Its text.
    pub fn yaml(&self) -> &'static str {
        self.yaml
    }

    /// The model that the text describes.
    pub fn model(&self) -> Result<Model, Diagnostics> {
        let loader = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
        let (model, _) = model::read_str(&format!("{}.yaml", self.name()), self.yaml, &loader)?;
        Ok(model)
    }
}

/// All of them, in the order of the list.
pub fn all() -> &'static [Bundled] {
    &[]
}

/// The one of this name.
pub fn find(name: &str) -> Option<&'static Bundled> {
    all().iter().find(|b| b.name() == name)
}
