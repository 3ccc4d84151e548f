//! Derivatives of responses: the program around a model that differentiates its runs, asked once.

use bryant_runtime::batch::rows::{Gradients, Job};
use bryant_runtime::program::rows::{doubles, read_row, write_doubles};
use bryant_study::engine::EngineError;
use std::io::{self, Read};
use std::path::Path;
use std::process::{Command, Stdio};

/// Responses at a row and their derivatives in some directions, as [`bryant_runtime::batch::rows::gradients`] has them.
///
/// # Errors
/// The program does not start, or breaks off.
pub fn gradients(
    program: &Path,
    job: &Job,
    row: &[f64],
    directions: &[f64],
) -> Result<Gradients, EngineError> {
    let count = directions.len() / row.len().max(1);
    ask(program, job, row, directions, count).map_err(|error| {
        EngineError(format!(
            "the compiled model {} broke off: {error}\n  help: remove this file, and it is compiled again",
            program.display()
        ))
    })
}

fn ask(
    program: &Path,
    job: &Job,
    row: &[f64],
    directions: &[f64],
    count: usize,
) -> io::Result<Gradients> {
    let mut child = Command::new(program)
        .args(job.to_words())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    if let Some(mut input) = child.stdin.take() {
        // it reads all before it answers
        write_doubles(&mut input, row)?;
        write_doubles(&mut input, directions)?;
    }
    let output = child.wait_with_output()?;
    if !output.status.success() {
        let words = String::from_utf8_lossy(&output.stderr);
        return Err(io::Error::other(words.trim().to_owned()));
    }
    let mut answer = output.stdout.as_slice();
    let rows = (0..count).map(|_| read_row(&mut answer));
    let rows = rows.collect::<io::Result<Vec<_>>>()?;
    let values = doubles(&mut answer, job.responses.len())?;
    let slopes = doubles(&mut answer, job.responses.len() * count)?;
    let mut rest = [0; 1];
    match answer.read(&mut rest)? {
        0 => Ok(Gradients {
            rows,
            values,
            slopes,
        }),
        _ => Err(io::Error::other("it says more than it was asked")),
    }
}
