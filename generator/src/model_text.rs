//! The text of a model, from a YAML file or a URDF file.

use crate::description::load::{read_bytes, read_file, shown, unreadable};
use crate::description::tree::MAX_BYTES;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::urdf::{self, Imported};
use std::io;
use std::path::Path;

/// The text of a model, of a file.
pub struct ModelText {
    /// The file, for messages.
    pub name: String,
    /// YAML: of a URDF file what it was imported as.
    pub text: String,
    /// Of a URDF file: its own text, and how it was imported.
    urdf: Option<(String, Imported)>,
}

impl ModelText {
    /// A URDF file as a model.
    ///
    /// # Errors
    /// Every problem of it.
    pub fn of_urdf(
        name: String,
        text: String,
        options: &urdf::Options,
    ) -> Result<Self, Diagnostics> {
        let imported = urdf::import(&name, &text, options)?;
        Ok(ModelText {
            name,
            text: imported.yaml.clone(),
            urdf: Some((text, imported)),
        })
    }

    /// What to know of how it was imported, a sentence each; nothing of a YAML file.
    pub fn notes(&self) -> &[String] {
        match &self.urdf {
            Some((_, imported)) => &imported.notes,
            None => &[],
        }
    }

    /// Whether lines of the text are lines of the file.
    pub fn is_of_file(&self) -> bool {
        self.urdf.is_none()
    }

    /// The line of the file that a line of the text was made of.
    pub fn line_of_file(&self, line: usize) -> Option<usize> {
        match &self.urdf {
            Some((_, imported)) => imported.origin(line).map(|place| place.0),
            None => Some(line),
        }
    }

    /// Problems that were found in the text, as problems of the file.
    pub fn in_file(&self, mut found: Diagnostics) -> Diagnostics {
        let Some((text, imported)) = &self.urdf else {
            return found;
        };
        for problem in &mut found.problems {
            let (message, help) = (problem.message.clone(), problem.help.clone());
            *problem = match imported.origin(problem.line) {
                Some(place) => Diagnostic::at(&self.name, text, place, message, help),
                None => Diagnostic::of_file(&self.name, message, help),
            };
        }
        found.problems.sort_by_key(|p| (p.line, p.column));
        found
    }
}

/// The text of a model: a YAML file, or what a URDF file is as YAML. A file is URDF by its content, XML, or by its
/// name, `.urdf`.
///
/// # Errors
/// A file that cannot be read; every problem of a URDF file.
pub fn read_model(path: &Path) -> Result<ModelText, Diagnostics> {
    let (name, text) = (shown(path), read_text(path)?);
    let is_named_urdf = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("urdf"));
    match is_named_urdf || urdf::is_xml(&text) {
        true => {
            let options = urdf::Options {
                inputs: true,
                ..urdf::Options::default()
            };
            ModelText::of_urdf(name, text, &options)
        }
        false => Ok(ModelText {
            name,
            text,
            urdf: None,
        }),
    }
}

/// The text of a file: UTF-8, or, of XML, what it says itself.
///
/// # Errors
/// A file that cannot be read.
pub fn read_text(path: &Path) -> Result<String, Diagnostics> {
    let text = read_file(path).or_else(|error| {
        let bytes = match error.kind() {
            io::ErrorKind::InvalidData => read_bytes(path, MAX_BYTES as u64)?,
            _ => return Err(error),
        };
        urdf::decoded(&bytes).ok_or(error)
    });
    text.map_err(|error| {
        let (message, help) = unreadable(&shown(path), &error);
        Diagnostic::of_file(shown(path), message, help).into()
    })
}
