//! The models that are part of the program, as texts.

use bryant_generator::diagnostic::Diagnostics;
use bryant_generator::model::Model;
use bryant_generator::model::annotated_model::AnnotatedModel;
use std::io;
use std::path::Path;
use std::sync::LazyLock;

/// All files of the bundled models: their path in `models/`, and their text.
static FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/models.rs"));

/// Directories of models for applications and for certification tests.
const SCENES: [&str; 2] = ["applications/", "certification/"];

/// A bundled model.
#[derive(Clone, Copy, Debug)]
pub struct Bundled {
    /// Its name, which is that of its file without directory and extension.
    pub name: &'static str,
    /// The path of its file in `models/`.
    pub file: &'static str,
    /// Its YAML.
    pub yaml: &'static str,
}

static MODELS: LazyLock<Vec<Bundled>> = LazyLock::new(|| {
    let models = FILES.iter().filter_map(|&(file, yaml)| {
        let path = file.strip_suffix(".yaml")?;
        let scene = SCENES.iter().find_map(|of| path.strip_prefix(of));
        let name = scene.unwrap_or(path);
        // files in other directories are parts that models include
        (!name.contains('/')).then_some(Bundled { name, file, yaml })
    });
    models.collect()
});

/// All bundled models, in the order of their names.
pub fn all() -> &'static [Bundled] {
    &MODELS
}

/// The bundled model with this name.
pub fn find(name: &str) -> Option<&'static Bundled> {
    all().iter().find(|model| model.name == name)
}

/// The text of a file of the bundled models, by its path in `models/`.
pub fn file(path: &Path) -> Option<&'static str> {
    let name = path.to_string_lossy().replace('\\', "/");
    FILES
        .iter()
        .find(|(file, _)| *file == name)
        .map(|(_, text)| *text)
}

/// The model that a bundled text describes.
///
/// # Errors
/// Every problem of the text. There is none, because tests read all bundled texts.
pub fn model(bundled: &Bundled) -> Result<Model, Diagnostics> {
    scene(bundled).map(|scene| scene.model)
}

/// The model of a bundled text, and the places of its items in the text.
///
/// # Errors
/// As [`model`].
pub fn scene(bundled: &Bundled) -> Result<AnnotatedModel, Diagnostics> {
    let missing = || io::Error::from(io::ErrorKind::NotFound);
    let loader = |path: &Path| file(path).map(str::to_owned).ok_or_else(missing);
    bryant_generator::read_annotated_str(bundled.file, bundled.yaml, &loader)
}
