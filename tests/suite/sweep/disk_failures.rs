//! Disks that are full and folders that cannot be written: exit code 1, what is stored stays, and the same command goes
//! on from there.
#![cfg(unix)]

use super::directory;
use super::folder::{assert_same, files};
use crate::command_call::{bryant, call, expect};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;

/// Runs the command with files limited to this many blocks of 512 bytes: like a full disk, except for the name of the
/// error.
#[track_caller]
fn limited(at: &Path, blocks: u32, arguments: &[&str], code: i32) -> String {
    let ready = bryant(at);
    let mut command = Command::new("sh");
    // the signal of the limit is ignored, so that writing fails as on a full disk
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    command.arg("-c").arg(script).arg(ready.get_program());
    command.args(arguments).current_dir(at);
    expect(command.output().unwrap(), arguments, code).1
}

#[test]
fn a_full_disk_loses_nothing() {
    let directory = directory();
    let at = directory.path();
    call(at, &["sweep", "seat.yaml", "--out", "whole"], 0);
    let whole = files(&at.join("whole"));
    let sizes = |name: &str| whole[name].len();
    // one limit is below a block, one between blocks and tables
    assert!(512 < sizes("blocks/00000000.part") && sizes("blocks/00000000.part") < 16 * 512);
    assert!(16 * 512 < sizes("results.csv"));

    call(
        at,
        &["sweep", "seat.yaml", "--out", "results", "--shard", "3/10"],
        0,
    );
    let before = files(&at.join("results"));
    let said = limited(at, 1, &["sweep", "seat.yaml", "--out", "results"], 1);
    assert!(
        said.contains("cannot write") && said.contains(".part"),
        "{said}"
    );
    assert!(said.contains("16 of 160 rows are stored"), "{said}");
    assert!(
        said.contains("the same command goes on from there"),
        "{said}"
    );
    assert!(
        before == files(&at.join("results")),
        "something was written, or lost"
    );

    // blocks can be written, but the series that are kept cannot
    let said = limited(at, 16, &["sweep", "seat.yaml", "--out", "results"], 1);
    assert!(
        said.contains("cannot write") && said.contains("series"),
        "{said}"
    );
    assert!(said.contains("160 of 160 rows are stored"), "{said}");
    call(
        at,
        &["sweep", "seat.yaml", "--out", "results", "--shard", "0/10"],
        0,
    );
    call(
        at,
        &["sweep", "seat.yaml", "--out", "results", "--shard", "7/10"],
        0,
    );
    let said = limited(at, 16, &["merge", "results"], 1);
    assert!(
        said.contains("cannot write") && said.contains("results."),
        "{said}"
    );
    assert!(said.contains("merge again: the results are kept"), "{said}");
    // a shard that was killed leaves the file of its lock
    std::fs::write(at.join("results/blocks/shard-1-of-10.lock"), "").unwrap();
    call(at, &["merge", "results"], 0);
    assert_same(&at.join("whole"), &at.join("results"));
}

#[test]
fn a_file_where_the_folder_should_be_is_named() {
    let directory = directory();
    let at = directory.path();
    let (_, said) = call(at, &["sweep", "seat.yaml", "--out", "seat.yaml/results"], 1);
    assert!(said.contains("seat.yaml/results"), "{said}");
    let (_, said) = call(at, &["merge", "seat.yaml"], 2);
    assert!(said.contains("is not a folder of results"), "{said}");
}

#[test]
fn a_folder_that_cannot_be_written_keeps_what_it_has() {
    let directory = directory();
    let at = directory.path();
    call(
        at,
        &["sweep", "seat.yaml", "--out", "results", "--shard", "3/10"],
        0,
    );
    let before = files(&at.join("results"));
    let mode = |path: &str, mode| {
        std::fs::set_permissions(at.join(path), std::fs::Permissions::from_mode(mode)).unwrap();
    };
    mode("", 0o755);
    mode("results/blocks", 0o555);
    let arguments = ["sweep", "seat.yaml", "--out", "results"];
    let mut command = bryant(at);
    command.args(arguments);
    if std::fs::write(at.join("results/blocks/.probe"), "").is_ok() {
        // a user who may write everywhere becomes one who may not
        std::fs::remove_file(at.join("results/blocks/.probe")).unwrap();
        command.uid(65_534).gid(65_534);
    }
    match command.output() {
        Ok(output) => {
            let (_, said) = expect(output, &arguments, 1);
            assert!(
                said.contains("cannot write") && said.contains("results/"),
                "{said}"
            );
        }
        Err(error) => eprintln!("not tried: the command cannot be started as nobody: {error}"),
    }
    mode("results/blocks", 0o755);
    assert!(
        before == files(&at.join("results")),
        "something was written, or lost"
    );
}
