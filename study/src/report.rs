//! What is written about a study that is complete: `summary.json`, `summary.txt`, `scatter.svg`, `tornado.svg`.

use crate::picture::{PictureError, scatter, tornado};
use crate::results::{Results, ResultsError};
use crate::store::write::{WriteError, at, replace};
use crate::summary::{Summary, summarize, text};
use std::path::PathBuf;

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The results are not complete or not sound.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A file cannot be written.
    #[error("{0}\n  help: {remedy} merge again: the results are kept", remedy = .0.remedy())]
    Write(#[from] WriteError),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The summary cannot be written as JSON.
    #[error("cannot write the summary as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Writes the report into the folder of the results; the files written.
///
/// # Errors
/// A block cannot be read, or a file not be written.
pub fn report(results: &Results<'_>) -> Result<(Summary, Vec<PathBuf>), ReportError> {
    let (summary, sample) = summarize(results)?;
    let names: Vec<String> = results
        .study
        .varied
        .iter()
        .map(|p| p.name.clone())
        .collect();
    let mut files = vec![
        (
            "summary.json",
            serde_json::to_string_pretty(&summary)? + "\n",
        ),
        ("summary.txt", text::text(&summary, &names)),
        ("scatter.svg", scatter::draw(results.study, &sample)?),
    ];
    if let Some(picture) = tornado::draw(results.study, &summary)? {
        files.push(("tornado.svg", picture));
    }
    let mut written = Vec::new();
    for (name, content) in files {
        let path = results.folder.path().join(name);
        replace(&path, |out| -> Result<(), WriteError> {
            at(&path, out.write_all(content.as_bytes()))
        })?;
        written.push(path);
    }
    Ok((summary, written))
}
