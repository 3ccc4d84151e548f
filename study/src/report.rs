//! The report of a complete study: `summary.json`, `summary.txt`, and the pictures `scatter` and `tornado` as SVG or
//! PNG.

use crate::picture::{scatter, tornado};
use crate::results::{Results, ResultsError};
use crate::store::write::{WriteError, at, replace};
use crate::summary::{Summary, summarize, text};
use bryant_picture::{Format, RasterError};
use std::path::PathBuf;

/// Why a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The results are incomplete or damaged.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A file cannot be written.
    #[error("{0}\n  help: {remedy} merge again: the results are kept", remedy = .0.remedy())]
    Write(#[from] WriteError),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Picture(#[from] RasterError),
    /// The summary cannot be written as JSON.
    #[error("cannot write the summary as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Writes the report into the folder of the results; returns the files.
///
/// # Errors
/// A block cannot be read, a file cannot be written, or a picture cannot be drawn.
pub fn report(
    results: &Results<'_>,
    pictures: Format,
) -> Result<(Summary, Vec<PathBuf>), ReportError> {
    let (summary, sample) = summarize(results)?;
    let names: Vec<String> = results
        .study
        .varied
        .iter()
        .map(|p| p.name.clone())
        .collect();
    let mut files = vec![
        (
            "summary.json".to_owned(),
            (serde_json::to_string_pretty(&summary)? + "\n").into_bytes(),
        ),
        (
            "summary.txt".to_owned(),
            text::text(&summary, &names).into_bytes(),
        ),
    ];
    let scatter = Some(("scatter", scatter::draw(results.study, &sample)));
    let tornado = tornado::draw(results.study, &summary).map(|drawing| ("tornado", drawing));
    for (name, drawing) in scatter.into_iter().chain(tornado) {
        let name = format!("{name}.{}", pictures.ending());
        files.push((name, drawing.bytes(pictures)?));
    }
    let mut written = Vec::new();
    for (name, content) in files {
        let path = results.folder.path().join(name);
        replace(&path, |out| -> Result<(), WriteError> {
            at(&path, out.write_all(&content))
        })?;
        written.push(path);
    }
    Ok((summary, written))
}
