//! Runs the missing rows of a study: threads take blocks from a shared counter; each block depends on its index only.

use crate::design::{Sampler, TooManyParameters};
use crate::engine::{Engine, EngineError, Outcomes};
use crate::series;
use crate::shard::Shard;
use crate::store::folder::Found;
use crate::store::part::PartError;
use crate::store::write::WriteError;
use crate::store::{Folder, FolderError};
use crate::study::Study;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A message about the progress.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Rows were finished.
    Rows {
        /// Rows in the folder, including those that were there at the beginning.
        done: u64,
        /// Rows that were there at the beginning.
        found: u64,
        /// Rows of the shard.
        total: u64,
        /// Time since the search for blocks ended.
        elapsed: Duration,
    },
    /// A block in the folder is damaged and is run again.
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: PartError,
    },
}

/// The work that was done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Rows of this shard.
    pub rows: u64,
    /// Rows of this shard that were in the folder already.
    pub found: u64,
    /// Damaged blocks that were found.
    pub damaged: Vec<PathBuf>,
    /// Number of time series written.
    pub series: u64,
}

/// Why the work ended early. Stored results stay.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// An error of the folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file cannot be written: the disk is full, or gone.
    #[error("{error}\n  {done} of {total} rows are stored\n  help: {} the same command goes on from there", .error.remedy())]
    Write {
        /// The file and the reason.
        error: WriteError,
        /// Rows stored, of this shard.
        done: u64,
        /// Rows of this shard.
        total: u64,
    },
    /// An error of the engine.
    #[error(
        "{error}\n  {done} of {total} rows are stored\n  help: when its cause is gone, the same command goes on from there"
    )]
    Engine {
        /// The error.
        error: EngineError,
        /// Rows stored, of this shard.
        done: u64,
        /// Rows of this shard.
        total: u64,
    },
    /// The engine was asked to stop ([`Engine::stops`]).
    #[error("{done} of {total} runs are stored\n  help: the same command goes on from there")]
    Stopped {
        /// Rows stored, of this shard.
        done: u64,
        /// Rows of this shard.
        total: u64,
    },
    /// An error of the design.
    #[error(transparent)]
    Design(#[from] TooManyParameters),
}

/// Runs the blocks of a shard that are missing in the folder, on this many threads.
///
/// # Errors
/// The folder cannot be written, or the engine cannot work; finished blocks are kept.
pub fn run(
    study: &Study,
    engine: &dyn Engine,
    folder: &Folder,
    shard: Shard,
    threads: usize,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Report, RunError> {
    let sampler = Sampler::new(study)?;
    let search = search(folder, shard, threads, progress)?;
    let state = State {
        study,
        sampler: &sampler,
        engine,
        folder,
        missing: &search.missing,
        next: AtomicUsize::new(0),
        stop: AtomicBool::new(false),
        shared: Mutex::new(Shared {
            done: search.report.found,
            error: None,
        }),
    };
    let (total, found) = (search.report.rows, search.report.found);
    let begin = Instant::now();
    let tell = |done| {
        progress(Progress::Rows {
            done,
            found,
            total,
            elapsed: begin.elapsed(),
        })
    };
    tell(found);
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, search.missing.len().max(1)) {
            scope.spawn(|| state.work(&tell));
        }
    });
    let shared = state
        .shared
        .into_inner()
        .unwrap_or_else(|poisoned| poisoned.into_inner());
    let done = shared.done;
    let failed = |error| match error {
        Failure::Write(error) => RunError::Write { error, done, total },
        Failure::Engine(error) => RunError::Engine { error, done, total },
    };
    if let Some(error) = shared.error {
        return Err(failed(error));
    }
    let mut report = search.report;
    if done == total {
        report.series = series::write(study, &sampler, engine, folder, shard).map_err(failed)?;
    }
    if engine.stops() {
        return Err(RunError::Stopped { done, total });
    }
    Ok(report)
}

/// Why a thread ended.
pub(crate) enum Failure {
    Write(WriteError),
    Engine(EngineError),
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Failure::Write(error)
    }
}

impl From<EngineError> for Failure {
    fn from(error: EngineError) -> Self {
        Failure::Engine(error)
    }
}

struct Search {
    missing: Vec<u64>,
    report: Report,
}

/// The blocks that must be run. Every existing block is read, and its digest is checked.
fn search(
    folder: &Folder,
    shard: Shard,
    threads: usize,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Search, RunError> {
    let blocks = folder.blocks();
    let mine: Vec<u64> = shard.blocks(blocks.count()).collect();
    let next = AtomicUsize::new(0);
    let look = || -> Result<Vec<(u64, Option<PartError>)>, FolderError> {
        let mut missing = Vec::new();
        while let Some(&block) = mine.get(next.fetch_add(1, Ordering::Relaxed)) {
            match folder.read(block)? {
                // slow rows are run again: with more time they may reach their ends
                Found::Good(outcomes) if outcomes.any_slow() => missing.push((block, None)),
                Found::Good(_) => {}
                Found::Missing => missing.push((block, None)),
                Found::Bad(error) => missing.push((block, Some(error))),
            }
        }
        Ok(missing)
    };
    let found = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(look)).collect();
        let join = |handle: std::thread::ScopedJoinHandle<'_, _>| {
            handle
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        handles
            .into_iter()
            .map(join)
            .collect::<Result<Vec<_>, FolderError>>()
    })?;
    let mut found: Vec<_> = found.into_iter().flatten().collect();
    found.sort_by_key(|(block, _)| *block);
    let length = |block: &u64| {
        let rows = blocks.rows(*block);
        rows.end - rows.start
    };
    let rows = mine.iter().map(length).sum();
    let left: u64 = found.iter().map(|(block, _)| length(block)).sum();
    let mut report = Report {
        rows,
        found: rows - left,
        ..Report::default()
    };
    for (block, error) in &found {
        if let Some(error) = error {
            let path = folder.block_path(*block);
            progress(Progress::Damaged {
                path: path.clone(),
                error: error.clone(),
            });
            report.damaged.push(path);
        }
    }
    let missing = found.into_iter().map(|(block, _)| block).collect();
    Ok(Search { missing, report })
}

struct State<'a> {
    study: &'a Study,
    sampler: &'a Sampler<'a>,
    engine: &'a dyn Engine,
    folder: &'a Folder,
    missing: &'a [u64],
    next: AtomicUsize,
    stop: AtomicBool,
    shared: Mutex<Shared>,
}

struct Shared {
    done: u64,
    error: Option<Failure>,
}

impl State<'_> {
    /// The work of one thread: runs blocks until none are left, or one of the threads has failed.
    fn work(&self, tell: &dyn Fn(u64)) {
        let result = self.blocks(tell);
        if let Err(error) = result {
            self.stop.store(true, Ordering::Relaxed);
            let mut shared = self.lock();
            shared.error.get_or_insert(error);
        }
    }

    fn blocks(&self, tell: &dyn Fn(u64)) -> Result<(), Failure> {
        let mut worker = self.engine.worker()?;
        let mut values = Vec::new();
        let (d, width) = (self.study.varied.len(), self.study.responses.len());
        let blocks = self.folder.blocks();
        // a thread takes whole blocks with at least the number of rows that the engine wants in one call
        let taken = self.engine.rows_at_once().div_ceil(blocks.size).max(1) as usize;
        while !self.stop.load(Ordering::Relaxed) && !self.engine.stops() {
            let first = self
                .next
                .fetch_add(taken, Ordering::Relaxed)
                .min(self.missing.len());
            let mine = &self.missing[first..(first + taken).min(self.missing.len())];
            if mine.is_empty() {
                break;
            }
            values.clear();
            for row in mine.iter().flat_map(|block| blocks.rows(*block)) {
                values.resize(values.len() + d, 0.0);
                let start = values.len() - d;
                self.sampler.values(row, &mut values[start..]);
            }
            let mut outcomes = Outcomes::new(width);
            worker.run(&values, &mut outcomes)?;
            let (answered, asked) = (outcomes.runs.len(), values.len() / d);
            if answered != asked {
                let message = format!("the engine answered {answered} of {asked} rows");
                return Err(EngineError(message).into());
            }
            outcomes.show_in_units_of(&self.study.responses);
            let mut rest = outcomes;
            for block in mine {
                let rows = blocks.rows(*block);
                let count = rows.end - rows.start;
                let outcomes = rest.take(count as usize);
                self.folder.write(*block, &outcomes)?;
                let mut shared = self.lock();
                shared.done += count;
                // called while the lock is held, so that reported numbers only grow
                tell(shared.done);
            }
        }
        Ok(())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Shared> {
        self.shared
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}
