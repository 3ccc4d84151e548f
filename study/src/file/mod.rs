//! The study file: YAML, read into a [`Study`] and checked against the facts of a model. Every problem has its line.
//!
//! ```text
//! text ─tree→ located tree ─names, units, bounds→ Study
//! ```

mod design;
mod distribution;
pub mod keys;
mod reader;
mod responses;
mod rows;
mod settings;

use crate::facts::ModelFacts;
use crate::response::Response;
use crate::study::{RunSettings, Study};
use bryant_generator::description::file_content;
use bryant_generator::description::tree::{Node, Source};
use bryant_generator::{Diagnostic, Diagnostics};
pub use keys::Keys;
use reader::{Reader, optional};
pub(crate) use responses::sampling;
use std::path::Path;

/// A study file that is valid YAML and names its model.
#[derive(Debug)]
pub struct StudyFile {
    source: Source,
    /// The model as the file names it: a bundled model, or a path relative to the file.
    pub model: String,
}

impl StudyFile {
    /// Reads a text; `name` is what messages call the file.
    ///
    /// # Errors
    /// The text is not YAML, or the study has no model.
    pub fn parse(name: &str, text: &str) -> Result<StudyFile, Diagnostics> {
        const BEGIN: &str = "a study begins with `model: NAME`, `design: sobol`, `runs: 1024`, `parameters:` and `responses:`";
        if text.trim().is_empty() {
            return Err(Diagnostic::of_file(name, "the file is empty", BEGIN).into());
        }
        if let Some((what, _)) = file_content::of_text(text) {
            let message = format!("this is {what}, not a study");
            return Err(Diagnostic::of_file(name, message, BEGIN).into());
        }
        let source = Source::parse(name, text).map_err(|problem| *problem)?;
        if let Some((what, help)) = file_content::instead_of_study(&source.root, name) {
            let message = format!("this is {what}, not a study");
            return Err(Diagnostic::of_file(name, message, help).into());
        }
        let root = source.at();
        let model = root.node.get("model").and_then(Node::text);
        match model.filter(|model| !model.trim().is_empty()) {
            Some(model) => Ok(StudyFile {
                model: model.to_owned(),
                source,
            }),
            None => {
                let reader = Reader::of::<Keys>(root);
                reader.add(root.problem("the study names no model", BEGIN));
                Err(reader.problems())
            }
        }
    }

    /// The CSV file with the rows of a list, as the study names it; `None` if the study has no list or contains the
    /// rows itself.
    pub fn rows_from(&self) -> Option<String> {
        let rows = optional(self.source.at(), "rows")?;
        optional(rows, "csv")?.node.text().map(str::to_owned)
    }

    /// The responses of the study and the time between their samples \[s\], for one run of a model with this duration
    /// \[s\]. `sampling` overrides that of the study. The rest of the study is ignored.
    ///
    /// # Errors
    /// All problems of `run` and `responses` at once.
    pub fn responses(
        &self,
        facts: &ModelFacts,
        duration: f64,
        sampling: Option<f64>,
    ) -> Result<(Vec<Response>, f64), Diagnostics> {
        let root = self.source.at();
        let reader = Reader::of::<Keys>(root);
        let of_study = settings::run(&reader, root, &facts.run);
        let sampling = sampling.or(of_study.sampling);
        let run = RunSettings {
            duration: Some(duration),
            sampling,
            ..of_study
        };
        let responses = responses::read(&reader, root, facts, &run);
        match reader.is_sound() {
            true => {
                let sampling = responses::sampling(&run, facts, &responses);
                Ok((responses, sampling))
            }
            false => Err(reader.problems()),
        }
    }

    /// The duration of the study's runs \[s\], if the study gives one.
    pub fn duration(&self, facts: &ModelFacts) -> Option<f64> {
        let root = self.source.at();
        settings::run(&Reader::of::<Keys>(root), root, &facts.run).duration
    }

    /// The study, checked against its model. Relative paths begin at `directory`, which is that of the file.
    ///
    /// # Errors
    /// All problems at once.
    pub fn resolve(&self, facts: &ModelFacts, directory: &Path) -> Result<Study, Diagnostics> {
        let root = self.source.at();
        let reader = Reader::of::<Keys>(root);
        let plan = design::read(&reader, root, facts, directory);
        let fixed = settings::fixed(&reader, root, facts);
        let run = settings::run(&reader, root, &facts.run);
        let responses = responses::read(&reader, root, facts, &run);
        let rows = plan.as_ref().map(|plan| plan.rows);
        let keep = settings::keep(&reader, root, facts, rows);
        let tables = settings::tables(root);
        if let Some(plan) = &plan {
            settings::distinct(&reader, root, &plan.varied, &fixed, &responses);
        }
        match plan {
            Some(plan) if reader.is_sound() => Ok(Study {
                model: self.model.clone(),
                rows: plan.rows,
                varied: plan.varied,
                fixed,
                plan: plan.plan,
                run,
                responses,
                keep,
                tables,
            }),
            _ => Err(reader.problems()),
        }
    }
}
