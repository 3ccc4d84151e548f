//! The models that come with the program: compiled, and as the text they were made from.

use bryant_generated::MODELS;
use bryant_generator::diagnostic::Diagnostics;
use bryant_generator::model::{Model, Scene, scene};

pub use bryant_generated::Bundled;

/// All of them, in the order of their names.
pub fn all() -> &'static [Bundled] {
    MODELS
}

/// The one of this name.
pub fn find(name: &str) -> Option<&'static Bundled> {
    bryant_generated::find(name)
}

/// What the text of a bundled model describes.
pub fn model(bundled: &Bundled) -> Result<Model, Diagnostics> {
    scene(bundled).map(|scene| scene.model)
}

/// The same with what its text mentions, and where.
pub fn scene(bundled: &Bundled) -> Result<Scene, Diagnostics> {
    let missing = || std::io::Error::from(std::io::ErrorKind::NotFound);
    let name = bundled
        .texts
        .first()
        .map_or(bundled.entry.info.name, |(name, _)| name);
    let loader = |path: &std::path::Path| {
        let name = path.to_string_lossy().replace('\\', "/");
        bundled.file(&name).map(str::to_owned).ok_or_else(missing)
    };
    scene::read_str(name, bundled.yaml(), &loader)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_describes_what_was_compiled() {
        for bundled in all() {
            let info = bundled.entry.info;
            let model = model(bundled).unwrap();
            assert_eq!(
                (model.name.as_str(), model.digest.as_str()),
                (info.name, info.digest)
            );
            let names: Vec<&str> = model.outputs.iter().map(|o| o.name.as_str()).collect();
            let compiled: Vec<&str> = info.outputs.iter().map(|o| o.name).collect();
            assert_eq!(names, compiled);
        }
    }
}
