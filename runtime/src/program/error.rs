//! What stops a run, in a form that can be sent to another process.

use super::JobError;
use crate::{Failure, Reason};
use std::fmt;

/// What stopped a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunError {
    /// Whose fault.
    pub kind: ErrorKind,
    /// Time reached \[s\], of a run that had begun.
    pub t: Option<f64>,
    /// The coordinate or velocity at fault.
    pub coordinate: Option<String>,
    /// The likely cause and its remedy, also part of the message; empty where the message says all.
    pub cause: String,
    /// The whole message.
    pub message: String,
}

/// Whose fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The job does not fit the model, or makes no sense: nothing was computed.
    Job,
    /// The run began and could not go on.
    Run,
}

impl RunError {
    /// Exit code of a program that ends with this: 2 for a job, 3 for a run.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            ErrorKind::Job => 2,
            ErrorKind::Run => 3,
        }
    }
}

impl From<Failure> for RunError {
    fn from(failure: Failure) -> Self {
        let message = failure.to_string();
        if let Reason::InvalidSettings(_) = failure.reason {
            return RunError {
                kind: ErrorKind::Job,
                t: None,
                coordinate: None,
                cause: String::new(),
                message,
            };
        }
        RunError {
            kind: ErrorKind::Run,
            t: Some(failure.t),
            coordinate: failure.coordinate().map(str::to_owned),
            cause: failure.cause().to_owned(),
            message,
        }
    }
}

impl From<JobError> for RunError {
    fn from(error: JobError) -> Self {
        RunError {
            kind: ErrorKind::Job,
            t: None,
            coordinate: None,
            cause: String::new(),
            message: error.to_string(),
        }
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for RunError {}
