//! `bryant sweep`: runs one model many times according to a study, in lanes and on all processors.

use super::Error;
use super::merge;
use super::model_argument::{self, Found};
use super::outputs::{self, Outputs, Replacing};
use super::prepare::prepare;
use super::progress::{Progress, Whole};
use super::run::{TIME_LIMIT, time_limit};
use super::terminal::Terminal;
use crate::interrupt;
use crate::picture::Format;
use crate::process::command_line;
use crate::report::study::{About, Judged};
use crate::sweep::{self, KeptError, Lanes};
use bryant_generator::Diagnostic;
use bryant_generator::description::load::{read_file, shown, unreadable};
use bryant_runtime::Width;
use bryant_study::criteria::judge;
use bryant_study::design::Sampler;
use bryant_study::engine::Engine;
use bryant_study::facts::ModelFacts;
use bryant_study::file::StudyFile;
use bryant_study::run::{Progress as SweepProgress, RunError, run};
use bryant_study::shard::Shard;
use bryant_study::store::identity::Program;
use bryant_study::store::{Folder, FolderError};
use bryant_study::study::{Precision, Study};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Run a study: many runs of one model with other parameters, several at once in SIMD lanes, on all processors.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
STUDY.yaml says what differs between runs and what is read off each (docs/studies.md):

  model: child-seat
  design: sobol
  runs: 4096
  parameters: { lap_slack: { from: 0 mm, to: 60 mm }, friction: { from: 0, to: 0.6 } }
  responses: [{ of: lap belt force, what: peak }, { of: head accelerometer, what: HIC15 }]

Results are kept in FOLDER block by block. Whatever ends the command, the same command goes on from
what is there: no run is lost, and none is there twice. Ctrl-C ends it after the blocks of runs
under way, with exit code 130. When all are there, tables (results.parquet),
a summary and pictures are written into FOLDER.

Examples:
  bryant sweep study.yaml                      all of it, into study-results
  bryant sweep study.yaml --plan               how many runs there would be, and the first of them
  bryant sweep study.yaml --out F --shard 2/8  the third of eight shards, on any machine that sees F;
                                               when all are done: bryant merge F

In arrays of SLURM the shard is that of the task, unless --shard says otherwise. With --shard 8 it is
one of eight, which one SLURM_ARRAY_TASK_ID, HQ_TASK_ID or JOB_COMPLETION_INDEX says.")]
pub struct Arguments {
    /// The study
    #[arg(value_name = "STUDY.yaml")]
    study: PathBuf,

    /// Folder of the results [default: the study's name and -results]
    #[arg(long, short, value_name = "FOLDER")]
    out: Option<PathBuf>,

    /// Run only shard I of N, counted from 0; with N alone, the shard of this task of a job array
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,

    /// Threads [default: one per processor]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// Number of runs side by side in a register: 8 (AVX-512), 4 (AVX2), 2 (64-bit ARM), 1, or plain, which is 1
    /// without fused multiply-adds. In single precision 8, 4 and 2 stand for twice as many. All but plain give the same
    /// results [default: the most that the processor has]
    #[arg(long, value_name = "LANES", value_parser = lanes)]
    lanes: Option<Width>,

    /// Print only what would be run: how many runs, and the first rows
    #[arg(long)]
    plan: bool,

    /// Do not estimate errors by a second, coarser run of each row: this saves about two fifths of the time
    #[arg(long)]
    no_estimate: bool,

    /// Give up a run when its computation takes longer than this, or would take ten times as long at its present rate.
    /// The run then ends as `slow`, and the study goes on; a time, or off [default: 5 min]
    #[arg(long, value_name = "TIME", value_parser = time_limit, allow_hyphen_values = true)]
    time_limit: Option<f64>,

    /// Format of the pictures
    #[arg(long, value_name = "FORMAT", default_value = "svg", value_parser = outputs::format())]
    pictures: Format,

    /// Write a report: one page of HTML with the distributions, the parameters that they depend on, and a table of runs
    /// to select and sort; any browser shows it, without a network
    #[arg(long, value_name = "FILE.html", conflicts_with_all = ["shard", "plan"])]
    report: Option<PathBuf>,

    /// Print the summary as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    replacing: Replacing,
}

/// Number of rows that `--plan` shows.
const SHOWN: u64 = 8;

impl Arguments {
    /// Runs the study, or a shard of it.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let shard = shard(self.shard.as_deref(), |name| std::env::var(name).ok())?;
        let (file, text) = read(&self.study)?;
        let directory = self.study.parent().unwrap_or(Path::new(""));
        let found = model_of(&file, directory)?;
        let facts = ModelFacts::of(&found.scene);
        let study = file.resolve(&facts, directory).map_err(Error::Model)?;
        for caution in study
            .responses
            .iter()
            .filter_map(|one| one.caution(&facts.outputs))
        {
            terminal.note(&format!("warning: {caution}"));
        }
        if self.plan {
            return plan(&study, &found, terminal);
        }
        if let Some(path) = &self.report {
            let rows = file.rows_from().map(|rows| directory.join(rows));
            let read = found.files.iter().chain([&self.study]).chain(&rows);
            let mut outputs = Outputs::of(read, self.replacing);
            outputs.take_report(path)?;
        }

        let width = self.lanes.unwrap_or_else(Width::widest);
        let mut job = sweep::job(&study, &found.model, &facts, width).map_err(Error::Input)?;
        job.estimate = !self.no_estimate;
        job.settings.time_limit =
            Duration::try_from_secs_f64(self.time_limit.unwrap_or(TIME_LIMIT)).ok();
        let path = self.out.clone().unwrap_or_else(|| of_study(&self.study));
        let program = Program {
            model: found.model.digest.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            arithmetic: arithmetic(study.run.precision, job.estimate),
        };
        let folder = Folder::open(&path, &study, &program).map_err(folder_error)?;
        let _lock = folder.lock(shard).map_err(folder_error)?;
        sweep::keep(&path, &file, &text, &facts, directory).map_err(kept_error)?;

        let equations = prepare(&found, terminal)?;
        let progress = Progress::new(terminal, "running the study".to_owned(), Whole::Unknown);
        let tell = progress.teller();
        let engine =
            Lanes::new(&equations, job, study.run.precision, &facts.outputs).telling(&tell);
        let threads = self.threads.map_or_else(
            || std::thread::available_parallelism().map_or(1, usize::from),
            usize::from,
        );
        let ran = run_all(&study, &engine, &folder, shard, threads, &progress);
        drop(progress);
        terminal.note(&ran?);
        for (reason, rows) in engine.refused() {
            let plural = if rows == 1 { "run is" } else { "runs are" };
            terminal.note(&format!("{rows} {plural} refused: {reason}"));
        }
        for line in engine.standstills() {
            terminal.note(&line);
        }
        equations.check()?;
        if shard != Shard::WHOLE {
            terminal.note(&format!(
                "this shard is done; when all are: bryant merge {}",
                path.display()
            ));
            return match engine.given_up() {
                0 => Ok(()),
                count => Err(merge::given_up(count, &[])),
            };
        }
        let about = About {
            study: self.study.display().to_string(),
            model: model_path(&file, directory),
            digest: found.model.digest.clone(),
            criteria: criteria(&facts)?,
            command: command_line(),
        };
        let how = merge::Finish {
            shards: None,
            pictures: self.pictures,
            json: self.json,
            page: self.report.clone().map(|path| (path, about)),
        };
        merge::finish(&study, &folder, &how, terminal)
    }
}

/// The criteria of a model, for a report.
fn criteria(facts: &ModelFacts) -> Result<Vec<Judged>, Error> {
    let Some(asked) = &facts.criteria else {
        return Ok(Vec::new());
    };
    let (_, judged) = judge(facts, asked).map_err(Error::Input)?;
    let judged = judged.iter().map(|one| Judged {
        name: one.criterion.name.to_owned(),
        shown: one.shown(),
    });
    Ok(judged.collect())
}

/// Runs the missing rows; returns a line about this.
fn run_all(
    study: &Study,
    engine: &dyn Engine,
    folder: &Folder,
    shard: Shard,
    threads: usize,
    progress: &Progress,
) -> Result<String, Error> {
    let begin = Instant::now();
    interrupt::watch();
    let report = run(study, engine, folder, shard, threads, &|told| match told {
        SweepProgress::Rows {
            done, found, total, ..
        } if done == found => progress.next_from(
            "running the study".to_owned(),
            Whole::Count(total, "runs"),
            found as f64,
        ),
        SweepProgress::Rows { done, .. } => progress.set(done as f64),
        SweepProgress::Damaged { path, error } => {
            progress.say(&format!("{} is run again: {error}", path.display()));
        }
    });
    let report = report.map_err(|error| match error {
        RunError::Folder(error) => folder_error(error),
        RunError::Design(error) => Error::input(error),
        stopped @ RunError::Stopped { .. } => Error::Interrupted(stopped.to_string()),
        error => Error::system(error),
    })?;
    let seconds = begin.elapsed().as_secs_f64();
    let ran = report.rows - report.found;
    let found = match report.found {
        0 => String::new(),
        found => format!("; {found} were there"),
    };
    let again = match report.damaged.len() {
        0 => String::new(),
        blocks => format!("; {blocks} damaged blocks were run again"),
    };
    Ok(format!(
        "{ran} runs in {seconds:.1} s, {:.0} a second{found}{again}",
        ran as f64 / seconds.max(1e-9)
    ))
}

/// Converts an error. A folder of another study, or of something else, is an error of the input; a failure to read or
/// write is an error of the system.
pub(super) fn folder_error(error: FolderError) -> Error {
    match error {
        FolderError::Other { .. } | FolderError::Foreign(_) => Error::input(error),
        error => Error::system(error),
    }
}

/// Converts an error. Missing results or files are errors of the input; a failure to read or write is an error of the
/// system.
pub(super) fn kept_error(error: KeptError) -> Error {
    match error {
        KeptError::NoResults(_) | KeptError::Lost(_) | KeptError::Outside(_) => Error::input(error),
        error => Error::system(error),
    }
}

/// The arithmetic of the results in words; results of different arithmetic must not be mixed.
fn arithmetic(precision: Precision, estimate: bool) -> String {
    let rounding = match precision {
        Precision::Double => "f64, fused",
        Precision::Single => "f32, fused",
    };
    match estimate {
        true => rounding.to_owned(),
        false => format!("{rounding}, errors not estimated"),
    }
}

/// A study file and its text.
pub(super) fn read(path: &Path) -> Result<(StudyFile, String), Error> {
    let name = shown(path);
    let text = read_file(path).map_err(|error| {
        let (message, help) = unreadable(&name, &error);
        Error::Model(Diagnostic::of_file(&name, message, help).into())
    })?;
    let file = StudyFile::parse(&name, &text).map_err(Error::Model)?;
    Ok((file, text))
}

/// Reads the model of a study: a bundled one, or a file relative to the study file.
fn model_of(file: &StudyFile, directory: &Path) -> Result<Found, Error> {
    model_argument::find(&model_path(file, directory))
}

/// The model of a study as the argument of a command.
fn model_path(file: &StudyFile, directory: &Path) -> String {
    let beside = directory.join(&file.model);
    match beside.is_file() {
        true => beside.to_string_lossy().into_owned(),
        false => file.model.clone(),
    }
}

/// The default folder of a study: `studies/seat.yaml` → `seat-results`
pub fn of_study(study: &Path) -> PathBuf {
    let stem = study.file_stem().unwrap_or_default().to_string_lossy();
    PathBuf::from(format!("{stem}-results"))
}

fn lanes(text: &str) -> Result<Width, String> {
    let width = Width::named(text).ok_or("it is 8, 4, 2 or 1")?;
    match width.is_available() {
        true => Ok(width),
        false => Err("this processor has no such registers".into()),
    }
}

/// Environment variables with the index of a task in a job array.
const TASKS: [&str; 3] = ["SLURM_ARRAY_TASK_ID", "HQ_TASK_ID", "JOB_COMPLETION_INDEX"];

/// The requested shard; if only the number of shards is given, the one of this task of a job array.
pub fn shard(
    asked: Option<&str>,
    variable: impl Fn(&str) -> Option<String>,
) -> Result<Shard, Error> {
    let number = |name: &str| -> Result<Option<u64>, Error> {
        let Some(text) = variable(name) else {
            return Ok(None);
        };
        let number = text.trim().parse();
        number.map(Some).map_err(|_| {
            Error::Input(format!(
                "{name} is \"{}\", which is no number\n  help: say which shard by --shard I/N",
                text.escape_debug()
            ))
        })
    };
    let task = || -> Result<Option<(&str, u64)>, Error> {
        for name in TASKS {
            if let Some(index) = number(name)? {
                return Ok(Some((name, index)));
            }
        }
        Ok(None)
    };
    let of = |index, count| Shard::new(index, count).map_err(Error::input);
    match asked.map(|text| (text, text.parse::<u64>())) {
        // only N is given: the index is that of the task in its job array
        Some((_, Ok(count))) => match task()? {
            Some(("SLURM_ARRAY_TASK_ID", index)) => {
                let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
                of(index.saturating_sub(first), count)
            }
            Some((_, index)) => of(index, count),
            None => Err(Error::Input(format!(
                "--shard {count}: which of the {count} shards is not said by {}\n  help: write --shard I/{count}, I from 0",
                TASKS.join(", ")
            ))),
        },
        Some((text, Err(_))) => text.parse().map_err(Error::input),
        None => match (task()?, number("SLURM_ARRAY_TASK_COUNT")?) {
            (Some(("SLURM_ARRAY_TASK_ID", index)), Some(count)) => {
                let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
                of(index.saturating_sub(first), count)
            }
            (Some((name, _)), _) => Err(Error::Input(format!(
                "this is a task of a job array ({name} is set), but of how many is not known\n  \
                 help: write --shard N for one of N shards, or --shard 0/1 for all of the study"
            ))),
            (None, _) => Ok(Shard::WHOLE),
        },
    }
}

/// Prints what a study would run.
fn plan(study: &Study, found: &Found, terminal: &mut Terminal) -> Result<(), Error> {
    let sampler = Sampler::new(study).map_err(Error::input)?;
    let duration = study.run.duration.unwrap_or(found.model.run.duration);
    terminal.print(&format!(
        "{} runs of {}, each of {} of its motion\n",
        study.rows,
        found.model.name,
        crate::accuracy::setting::time(duration)
    ))?;
    let mut lines = vec![{
        let heading = |p: &bryant_study::study::Varied| match p.unit.as_str() {
            "" => p.name.clone(),
            unit => format!("{} [{unit}]", p.name),
        };
        let mut cells = vec!["run".to_owned()];
        cells.extend(study.varied.iter().map(heading));
        cells
    }];
    let mut values = vec![0.0; study.varied.len()];
    for row in 0..study.rows.min(SHOWN) {
        sampler.values(row, &mut values);
        let mut cells = vec![row.to_string()];
        cells.extend(values.iter().map(|value| format!("{value:.6}")));
        lines.push(cells);
    }
    let columns = lines[0].len();
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max();
    let widths: Vec<usize> = (0..columns).filter_map(width).collect();
    for line in &lines {
        let cells = line.iter().zip(&widths);
        let cells: Vec<String> = cells
            .map(|(cell, width)| format!("{cell:>width$}"))
            .collect();
        terminal.print(&format!("{}\n", cells.join("  ")))?;
    }
    if study.rows > SHOWN {
        terminal.print(&format!("and {} more\n", study.rows - SHOWN))?;
    }
    for response in &study.responses {
        let unit = match response.unit.name.as_str() {
            "" => String::new(),
            unit => format!(" [{unit}]"),
        };
        terminal.print(&format!("response: {}{unit}\n", response.name))?;
    }
    Ok(())
}
