//! A scene to be simulated: a model as a user writes it.

use bryant_generator::diagnostic::Diagnostics;
use bryant_generator::model::Model;
use bryant_generator::read_str;
use std::io;
use std::path::Path;

/// The model of a case, as text.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct CaseModel {
    /// The name of its file in messages.
    pub name: String,
    /// Its YAML text.
    pub text: String,
}

impl CaseModel {
    /// A scene of this name and YAML.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> CaseModel {
        CaseModel {
            name: name.into(),
            text: text.into(),
        }
    }

    /// Reads the model. A scene is one text and includes no files.
    ///
    /// # Errors
    /// All problems, with their places.
    pub fn model(&self) -> Result<Model, Diagnostics> {
        let no_others = |_: &Path| Err(io::Error::from(io::ErrorKind::NotFound));
        let file = format!("{}.yaml", self.name);
        read_str(&file, &self.text, &no_others).map(|(model, _)| model)
    }
}

/// A scene of `scenes/`, by its name.
#[macro_export]
macro_rules! scene {
    ($name:literal) => {
        $crate::case_model::CaseModel::new(
            $name,
            include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/scenes/",
                $name,
                ".yaml"
            )),
        )
    };
}
