//! What a command prints and writes arrives, or the command says that it did not.

use crate::called::{bryant, expect};
use crate::directory;
use std::fs::OpenOptions;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Output;

/// The command with something done to its process before it begins.
fn with(at: &Path, arguments: &[&str], before: fn() -> std::io::Result<()>) -> Output {
    let mut command = bryant(at);
    command.args(arguments);
    // SAFETY: what is done is one call of the system's, which may be made between `fork` and `exec`.
    #[expect(unsafe_code, reason = "between fork and exec")]
    unsafe {
        command.pre_exec(before)
    };
    command.output().unwrap()
}

/// The names of files, sorted.
fn files(at: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(at).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Closes standard output.
fn close() -> std::io::Result<()> {
    #[expect(unsafe_code, reason = "a call of the system's")]
    let closed = unsafe { libc::close(1) };
    match closed {
        0 => Ok(()),
        _ => Err(std::io::Error::last_os_error()),
    }
}

/// Files of this process have at most 512 bytes.
fn short_files() -> std::io::Result<()> {
    let limit = libc::rlimit {
        rlim_cur: 512,
        rlim_max: 512,
    };
    #[expect(unsafe_code, reason = "a call of the system's")]
    let limited = unsafe { libc::setrlimit(libc::RLIMIT_FSIZE, &limit) };
    match limited {
        0 => Ok(()),
        _ => Err(std::io::Error::last_os_error()),
    }
}

const PRINTING: [&[&str]; 6] = [
    &["run", "clock.yaml", "--no-files"],
    &["run", "clock.yaml", "--no-files", "--json"],
    &["run", "clock.yaml", "--no-files", "--csv", "-"],
    &["check", "clock.yaml"],
    &["models"],
    &["--help"],
];

#[test]
fn a_standard_output_that_is_closed_is_an_error() {
    let directory = directory();
    for arguments in PRINTING {
        let output = with(directory.path(), arguments, close);
        let (_, stderr) = expect(output, arguments, 1);
        assert!(
            stderr.contains("cannot write to standard output: it is closed"),
            "{stderr}"
        );
    }
}

#[test]
fn nothing_is_lost_where_standard_output_goes_nowhere() {
    let directory = directory();
    for arguments in PRINTING {
        // for reading and writing, as the standard library opens it in the place of what is closed
        let null = OpenOptions::new().read(true).write(true).open("/dev/null");
        let mut command = bryant(directory.path());
        command.args(arguments).stdout(null.unwrap());
        expect(command.output().unwrap(), arguments, 0);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_that_is_full_is_an_error() {
    let directory = directory();
    for arguments in PRINTING {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = bryant(directory.path());
        command.args(arguments).stdout(full);
        let (_, stderr) = expect(command.output().unwrap(), arguments, 1);
        let said = stderr.matches("cannot write to standard output").count();
        assert_eq!(said, 1, "{stderr}");
    }
}

#[test]
fn a_limit_on_files_is_told_and_leaves_none() {
    let directory = directory();
    let before = files(directory.path());
    let arguments = ["run", "clock.yaml"];
    let output = with(directory.path(), &arguments, short_files);
    let (_, stderr) = expect(output, &arguments, 1);
    assert!(stderr.contains("cannot write clock."), "{stderr}");
    let written: Vec<String> = files(directory.path())
        .into_iter()
        .filter(|name| !before.contains(name))
        .collect();
    // what fits is there and whole
    assert!(
        written.iter().all(|name| name == "clock.csv"),
        "{written:?}"
    );
}
