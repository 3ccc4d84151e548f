//! The command as the tests call it: a process of its own, with a cache that no user has.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

/// One cache for all tests of a run: some tests check its content, and all are faster with it.
pub fn cache() -> &'static Path {
    static CACHE: OnceLock<PathBuf> = OnceLock::new();
    CACHE.get_or_init(|| {
        let name = concat!(env!("CARGO_CRATE_NAME"), "-cache");
        let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        // entries of earlier builds of the program would never be used again
        if cache.exists() {
            std::fs::remove_dir_all(&cache).unwrap();
        }
        cache
    })
}

/// The command in a directory.
pub fn bryant(directory: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bryant"));
    command.current_dir(directory).env("BRYANT_CACHE", cache());
    command.stdin(Stdio::null());
    command
}

/// Runs the command and expects an exit code; returns standard output and standard error.
#[track_caller]
pub fn call(directory: &Path, arguments: &[&str], code: i32) -> (String, String) {
    let output = bryant(directory).args(arguments).output().unwrap();
    expect(output, arguments, code)
}

/// Expects an exit code of a finished command; returns standard output and standard error.
#[track_caller]
pub fn expect(output: Output, arguments: &[&str], code: i32) -> (String, String) {
    let stdout = String::from_utf8(output.stdout).unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        output.status.code(),
        Some(code),
        "{arguments:?}\nstdout: {stdout}\nstderr: {stderr}"
    );
    assert!(!stderr.contains("panicked at"), "{stderr}");
    (stdout, stderr)
}
