//! `bryant merge`: writes the tables, the summary and the pictures of a study whose shards are all done.

use super::Error;
use super::outputs;
use super::progress::{Progress, Whole};
use super::sweep::{folder_error, kept_error};
use super::terminal::Terminal;
use crate::picture::Format;
use crate::report::study::{self, About};
use crate::sweep::Kept;
use bryant_runtime::program::{ErrorKind, RunError};
use bryant_study::engine::Status;
use bryant_study::report::{ReportError, report};
use bryant_study::results::{Results, ResultsError};
use bryant_study::shard::Shard;
use bryant_study::store::Folder;
use bryant_study::study::Study;
use bryant_study::summary::text::text;
use bryant_study::table::{self, TableError};
use std::path::PathBuf;

/// Merge the shards of a study that `bryant sweep --shard` ran into tables, a summary and pictures.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
FOLDER has everything that is needed, and the command reports what is missing. Merging twice gives the same bytes, and these are the bytes
of a study that was run in one go.

Example:
  bryant merge study-results")]
pub struct Arguments {
    /// The folder that `bryant sweep` was given by --out
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,

    /// Number of shards that the study was run in; missing blocks are then reported by shard
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    shards: Option<u64>,

    /// Format of the pictures
    #[arg(long, value_name = "FORMAT", default_value = "svg", value_parser = outputs::format())]
    pictures: Format,

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
        let _lock = folder.lock(Shard::WHOLE).map_err(folder_error)?;
        let how = Finish {
            shards: self.shards,
            pictures: self.pictures,
            json: self.json,
            page: None,
        };
        finish(&kept.study, &folder, &how, terminal)
    }
}

/// How results are presented.
pub(super) struct Finish {
    /// Number of shards in which the study was run, if it is known.
    pub shards: Option<u64>,
    /// Format of the pictures.
    pub pictures: Format,
    /// True if the summary is printed as JSON.
    pub json: bool,
    /// The file of the report and its additional texts, if a report is to be written.
    pub page: Option<(PathBuf, About)>,
}

/// Writes the tables, the summary and the pictures of complete results.
pub(super) fn finish(
    study: &Study,
    folder: &Folder,
    how: &Finish,
    terminal: &mut Terminal,
) -> Result<(), Error> {
    let results = Results::new(study, folder, how.shards).map_err(results_error)?;
    let what = "writing tables, summary and pictures".to_owned();
    let progress = Progress::new(terminal, what, Whole::Unknown);
    let written = table::merge(&results).map_err(|error| match error {
        TableError::Results(error) => results_error(error),
        error => Error::system(error),
    });
    let summed = written.and_then(|mut tables| {
        let report = report(&results, how.pictures).map_err(|error| match error {
            ReportError::Results(error) => results_error(error),
            error => Error::system(error),
        })?;
        if let Some((path, about)) = &how.page {
            let page = study::page(&results, &report.0, about).map_err(results_error)?;
            crate::files::replace(path, |out| out.write_all(page.as_bytes()))
                .map_err(Error::system)?;
            tables.push(path.clone());
        }
        Ok((tables, report))
    });
    drop(progress);
    let (mut written, (summary, others)) = summed?;
    written.extend(others);
    if how.json {
        terminal.print_json(&summary)?;
    } else {
        let names: Vec<String> = study.varied.iter().map(|p| p.name.clone()).collect();
        terminal.print(&text(&summary, &names))?;
    }
    terminal.flush()?;
    for path in written {
        terminal.note(&format!("wrote {}", path.display()));
    }
    let slow = summary
        .ends
        .iter()
        .find(|(word, _)| *word == Status::Slow.word());
    match slow {
        Some((_, count)) => Err(given_up(*count, &summary.slow)),
        None => Ok(()),
    }
}

/// The error for runs that exceeded their time limit.
pub(super) fn given_up(count: u64, named: &[u64]) -> Error {
    let runs: Vec<String> = named.iter().map(u64::to_string).collect();
    let more = if count > named.len() as u64 {
        ", …"
    } else {
        ""
    };
    let plural = if count == 1 { "run was" } else { "runs were" };
    Error::Run(RunError {
        kind: ErrorKind::Time,
        t: None,
        coordinate: None,
        cause: String::new(),
        message: format!(
            "{count} {plural} given up because computing takes too long{}\n  help: `bryant sweep` with a longer --time-limit runs them \
             again, or leave out what makes them slow",
            match runs.is_empty() {
                true => String::new(),
                false => format!(": run {}{more}", runs.join(", ")),
            }
        ),
    })
}

/// Converts an error. Missing blocks are an error of the input, because the user must first run their shards.
fn results_error(error: ResultsError) -> Error {
    match error {
        ResultsError::Missing { .. } => Error::input(error),
        ResultsError::Folder(error) => folder_error(error),
        error => Error::system(error),
    }
}
