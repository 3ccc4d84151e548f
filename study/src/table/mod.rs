//! The table of a study: a row for each run, in the order of the rows; it has the same bytes however the study was run.
//!
//! ```text
//! run | parameters … | responses … | status | steps | reached [s] | error estimate | reason
//! ```

pub mod csv;
pub mod parquet;

use crate::results::{Results, ResultsError};
use crate::store::FolderError;
use crate::store::write::{WriteError, replace};
use crate::study::{Study, TableKind};
use std::path::PathBuf;

/// A column with its heading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// SI unit, "" for a pure number and for a column that is not a quantity.
    pub unit: String,
}

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The results are incomplete or damaged.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The file cannot be written.
    #[error("{0}\n  help: {remedy} merge again: the results are kept", remedy = .0.remedy())]
    Write(#[from] WriteError),
}

/// Writes the tables that the study requests into the folder of results, and removes unfinished files of processes that
/// were ended.
///
/// # Errors
/// A file cannot be written, or a block cannot be read.
pub fn merge(results: &Results<'_>) -> Result<Vec<PathBuf>, TableError> {
    results.folder.tidy().map_err(ResultsError::from)?;
    let mut written = Vec::new();
    for kind in &results.study.tables {
        let name = match kind {
            TableKind::Parquet => "results.parquet",
            TableKind::Csv => "results.csv",
        };
        let path = results.folder.path().join(name);
        replace(&path, |out| match kind {
            TableKind::Parquet => parquet::write(out, &path, results),
            TableKind::Csv => csv::write(out, &path, results),
        })?;
        written.push(path);
    }
    Ok(written)
}

/// Columns of numbers of a study: its parameters, then its responses.
pub fn numbers(study: &Study) -> Vec<Column> {
    let parameters = study.varied.iter().map(|p| (&p.name, &p.unit));
    let responses = study.responses.iter().map(|r| (&r.name, &r.unit.name));
    let column = |(name, unit): (&String, &String)| Column {
        name: name.clone(),
        unit: unit.clone(),
    };
    parameters.chain(responses).map(column).collect()
}

impl From<FolderError> for TableError {
    fn from(error: FolderError) -> Self {
        TableError::Results(error.into())
    }
}
