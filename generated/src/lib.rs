//! The bundled models, compiled: one module for each file in `models/`, written by the build script, and a table of all models.
//!
//! The entry points for `f64` are compiled here, so that crates that use them need not compile the equations again.

use bryant_runtime::program::Entry;

/// A bundled model.
#[derive(Clone, Copy, Debug)]
pub struct Bundled {
    /// The compiled equations, over `f64`.
    pub entry: Entry,
    /// Names and texts of its YAML files: the model first, then the files that it includes. Names are relative to the directory of the
    /// model.
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

#[cfg(test)]
mod tests {
    use super::*;
    use bryant_runtime::program::RunError;

    #[test]
    fn every_model_is_found_by_its_name_and_has_its_text() {
        assert!(!MODELS.is_empty());
        for model in MODELS {
            let found = find(model.entry.info.name).map(|found| found.entry.info.name);
            assert_eq!(found, Some(model.entry.info.name));
            assert!(
                model
                    .yaml()
                    .contains(&format!("model: {}", model.entry.info.name))
            );
        }
    }

    #[test]
    fn every_model_starts_with_finite_rates() -> Result<(), RunError> {
        for model in MODELS {
            let state = model.entry.initial_state(&[])?;
            let mut rates = vec![f64::NAN; state.len()];
            model.entry.derivative(&[], 0.0, &state, &mut rates)?;
            assert!(
                rates.iter().all(|rate| rate.is_finite()),
                "{}: {rates:?}",
                model.entry.info.name
            );
        }
        Ok(())
    }
}
