//! Errors that stop a run, in words.

use super::{Finding, JobError};
use crate::patience::Late;
use crate::{Failure, Reason, Report};
use std::fmt;

/// What stopped a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunError {
    /// The origin of the error.
    pub kind: ErrorKind,
    /// Time reached \[s\], if the run had begun.
    pub t: Option<f64>,
    /// The coordinate or velocity that failed.
    pub coordinate: Option<String>,
    /// The likely cause and its remedy, also part of the message; empty where the message says all.
    pub cause: String,
    /// The whole message.
    pub message: String,
}

/// The origin of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The job is invalid or does not fit the model; nothing was computed.
    Job,
    /// The run began and could not go on.
    Run,
    /// The run was stopped because it took longer than the job allows.
    Time,
    /// An observer stopped the run.
    Stopped,
}

impl ErrorKind {
    /// Exit code of a program that ends with this error: 2 for a job; 3 for a run, also for one that takes too long;
    /// 130 for one that was stopped.
    pub fn exit_code(self) -> u8 {
        match self {
            ErrorKind::Job => 2,
            ErrorKind::Run | ErrorKind::Time => 3,
            ErrorKind::Stopped => 130,
        }
    }
}

impl RunError {
    /// [`ErrorKind::exit_code`]
    pub fn exit_code(&self) -> u8 {
        self.kind.exit_code()
    }

    /// The error of a run that takes longer than allowed.
    pub(super) fn out_of_time(report: &Report, late: Option<Late>) -> Self {
        let why = match late {
            Some(Late::Rate(all)) if all.is_finite() => format!(
                "because at the speed of its last seconds it would take {all:.0} s to compute"
            ),
            Some(Late::Rate(_)) => "because its time does not advance".to_owned(),
            Some(Late::Limit(limit)) => format!("because computing it took longer than {limit} s"),
            None => "because computing it took too long".to_owned(),
        };
        RunError {
            kind: ErrorKind::Time,
            t: Some(report.t),
            coordinate: None,
            cause: String::new(),
            message: format!(
                "the run was stopped at t = {} s, after {} steps, {why}",
                report.t, report.steps
            ),
        }
    }

    /// The error of a run that an observer stopped.
    pub(super) fn stopped(report: &Report) -> Self {
        RunError {
            kind: ErrorKind::Stopped,
            t: Some(report.t),
            coordinate: None,
            cause: String::new(),
            message: format!(
                "the run was stopped at t = {} s, after {} steps",
                report.t, report.steps
            ),
        }
    }

    /// Names the step as the cause, if it was found to be above the stability limit.
    pub(super) fn explained(mut self, doubts: &[Finding]) -> Self {
        let step = doubts.iter().find(|finding| finding.kind == "step");
        if let (Some(step), ErrorKind::Run) = (step, self.kind) {
            let what = self.message.split("; likely cause: ").next();
            let what = what.unwrap_or_default();
            self.cause = format!("{}; {}", step.message, step.remedy);
            self.message = format!("{what}; likely cause: {}", self.cause);
        }
        self
    }
}

impl From<Failure<'_>> for RunError {
    fn from(failure: Failure<'_>) -> Self {
        let message = failure.to_string();
        if let Reason::InvalidSettings(_) | Reason::Refused(_) = failure.reason {
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
