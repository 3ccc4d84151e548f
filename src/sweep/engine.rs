//! What runs the rows of a study: a bundled model in this process, or the program around one that was compiled, a process for each
//! thread.

use bryant_runtime::batch::Status as Ended;
use bryant_runtime::batch::rows::{Job, Row};
use bryant_runtime::program::RowsEntry;
use bryant_runtime::program::rows::{ONE_FOR_ITS_SERIES, doubles, read_row, write_doubles};
use bryant_study::engine::{Engine, EngineError, Outcome, Outcomes, Series, Status, Worker};
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// A model that runs in lanes.
#[derive(Clone, Debug)]
pub struct Lanes {
    program: Program,
    job: Job,
    /// Outputs of the model.
    outputs: usize,
}

#[derive(Clone, Debug)]
enum Program {
    Bundled(RowsEntry),
    Compiled(PathBuf),
}

impl Lanes {
    /// A bundled model.
    pub fn bundled(entry: RowsEntry, job: Job, outputs: usize) -> Self {
        let program = Program::Bundled(entry);
        Lanes {
            program,
            job,
            outputs,
        }
    }

    /// A model compiled as a program of its own.
    pub fn compiled(path: &Path, job: Job, outputs: usize) -> Self {
        let program = Program::Compiled(path.to_owned());
        Lanes {
            program,
            job,
            outputs,
        }
    }
}

impl Engine for Lanes {
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError> {
        match &self.program {
            Program::Bundled(entry) => Ok(Box::new(Linked {
                entry: *entry,
                job: &self.job,
                outputs: self.outputs,
            })),
            Program::Compiled(path) => Ok(Box::new(Process::start(path, &self.job, self.outputs)?)),
        }
    }
}

fn outcome(row: &Row) -> Outcome {
    Outcome {
        status: match row.status {
            Ended::Done => Status::Done,
            Ended::NonFinite => Status::NonFinite,
            Ended::StepTooSmall => Status::StepTooSmall,
            Ended::TooManySteps => Status::TooManySteps,
            Ended::Refused => Status::Refused,
        },
        reached: row.t,
        steps: row.steps,
        error: row.error,
    }
}

/// Times and outputs of a run: samples output by output.
fn series(job: &Job, samples: &[f64]) -> Series {
    let count = job.settings.samples;
    let every = job.settings.duration / (count - 1) as f64;
    Series {
        times: (0..count).map(|i| i as f64 * every).collect(),
        outputs: samples.chunks(count).map(<[f64]>::to_vec).collect(),
    }
}

struct Linked<'a> {
    entry: RowsEntry,
    job: &'a Job,
    outputs: usize,
}

impl Worker for Linked<'_> {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        let results = (self.entry.rows)(self.job, rows);
        let results = results.map_err(|error| EngineError(error.to_string()))?;
        let width = self.job.responses.len();
        for (index, row) in results.rows.iter().enumerate() {
            outcomes.push(outcome(row), &results.responses[index * width..][..width]);
        }
        Ok(())
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        let all: Vec<usize> = (0..self.outputs).collect();
        let result = (self.entry.series)(self.job, row, &all);
        let (_, samples) = result.map_err(|error| EngineError(error.to_string()))?;
        Ok(series(self.job, &samples))
    }
}

/// A process that runs rows.
struct Process<'a> {
    path: PathBuf,
    job: &'a Job,
    outputs: usize,
    child: Child,
    input: BufWriter<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl<'a> Process<'a> {
    fn start(path: &Path, job: &'a Job, outputs: usize) -> Result<Self, EngineError> {
        let failed = |error: std::io::Error| {
            EngineError(format!(
                "cannot start the compiled model {}: {error}\n  help: remove this file, and it is compiled again",
                path.display()
            ))
        };
        let mut child = Command::new(path)
            .args(job.to_words())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        match (child.stdin.take(), child.stdout.take()) {
            (Some(input), Some(output)) => Ok(Process {
                path: path.to_owned(),
                job,
                outputs,
                child,
                input: BufWriter::new(input),
                output: BufReader::new(output),
            }),
            _ => Err(failed(std::io::Error::other("it has no input or output"))),
        }
    }

    /// What went wrong, in the process's own words where it has such.
    fn failure(&mut self, error: &std::io::Error) -> EngineError {
        let _ = self.child.kill();
        let mut words = String::new();
        if let Some(mut errors) = self.child.stderr.take() {
            let _ = errors.read_to_string(&mut words);
        }
        let words = match words.trim() {
            "" => error.to_string(),
            words => words.to_owned(),
        };
        let path = self.path.display();
        EngineError(format!(
            "the compiled model {path} broke off: {words}\n  help: run again; if it stays, remove this file"
        ))
    }

    fn ask(&mut self, count: u64, rows: &[f64]) -> std::io::Result<()> {
        self.input.write_all(&count.to_le_bytes())?;
        write_doubles(&mut self.input, rows)?;
        self.input.flush()
    }

    fn rows(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> std::io::Result<()> {
        let across = self.job.varied.len().max(1);
        let count = rows.len() / across;
        self.ask(count as u64, rows)?;
        for _ in 0..count {
            let row = read_row(&mut self.output)?;
            let responses = doubles(&mut self.output, self.job.responses.len())?;
            outcomes.push(outcome(&row), &responses);
        }
        Ok(())
    }

    fn samples(&mut self, row: &[f64]) -> std::io::Result<Vec<f64>> {
        self.ask(ONE_FOR_ITS_SERIES, row)?;
        read_row(&mut self.output)?;
        doubles(&mut self.output, self.outputs * self.job.settings.samples)
    }
}

impl Worker for Process<'_> {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        self.rows(rows, outcomes)
            .map_err(|error| self.failure(&error))
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        let samples = self.samples(row).map_err(|error| self.failure(&error))?;
        Ok(series(self.job, &samples))
    }
}

impl Drop for Process<'_> {
    fn drop(&mut self) {
        // it would end with its input, too
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
