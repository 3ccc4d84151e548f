//! `bryant merge`: the tables, the summary and the pictures of a study whose shards are all done.

use super::Error;
use super::progress::{Progress, Whole};
use super::sweep::{folder_error, kept_error};
use super::terminal::Terminal;
use crate::sweep::Kept;
use bryant_study::report::{ReportError, report};
use bryant_study::results::{Results, ResultsError};
use bryant_study::store::Folder;
use bryant_study::study::Study;
use bryant_study::summary::text::text;
use bryant_study::table::{self, TableError};
use std::path::PathBuf;

/// Merge the shards of a study that `bryant sweep --shard` ran into tables, a summary and pictures.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Everything needed is in FOLDER. What is missing is said; merging twice gives the same bytes, and the bytes are those of a study run
in one go.

Example:
  bryant merge study-results")]
pub struct Arguments {
    /// The folder that `bryant sweep` was given by --out
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,

    /// In how many shards the study was run: what is missing is then said by shard
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    shards: Option<u64>,

    /// Print the summary as JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Merges.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let kept = Kept::read(&self.folder).map_err(kept_error)?;
        let folder = Folder::open(&self.folder, &kept.study, &kept.program);
        let folder = folder.map_err(folder_error)?;
        finish(&kept.study, &folder, self.shards, self.json, terminal)
    }
}

/// Tables, summary and pictures of results that are complete.
pub(super) fn finish(
    study: &Study,
    folder: &Folder,
    shards: Option<u64>,
    json: bool,
    terminal: &mut Terminal,
) -> Result<(), Error> {
    let results = Results::new(study, folder, shards).map_err(results_error)?;
    let what = "writing tables, summary and pictures".to_owned();
    let progress = Progress::new(terminal, what, Whole::Unknown);
    let written = table::merge(&results).map_err(|error| match error {
        TableError::Results(error) => results_error(error),
        error => Error::system(error),
    });
    let summed = written.and_then(|tables| {
        let report = report(&results).map_err(|error| match error {
            ReportError::Results(error) => results_error(error),
            error => Error::system(error),
        })?;
        Ok((tables, report))
    });
    drop(progress);
    let (mut written, (summary, others)) = summed?;
    written.extend(others);
    if json {
        terminal.print_json(&summary)?;
    } else {
        let names: Vec<String> = study.varied.iter().map(|p| p.name.clone()).collect();
        terminal.print(&text(&summary, &names))?;
    }
    terminal.flush()?;
    for path in written {
        terminal.note(&format!("wrote {}", path.display()));
    }
    Ok(())
}

/// Blocks that are missing are a matter of input: their shards have to be run.
fn results_error(error: ResultsError) -> Error {
    match error {
        ResultsError::Missing { .. } => Error::input(error),
        ResultsError::Folder(error) => folder_error(error),
        error => Error::system(error),
    }
}
