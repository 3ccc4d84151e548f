//! The output of a command arrives, or the command says that it did not.

use crate::command_call::{bryant, call, expect};
use crate::{PENDULUM, directory};
use std::fs::OpenOptions;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Output, Stdio};

/// The command, with a function that is called in its process before it begins.
fn with(at: &Path, arguments: &[&str], before: fn() -> std::io::Result<()>) -> Output {
    let mut command = bryant(at);
    command.args(arguments);
    // SAFETY: the function makes a single system call, which is allowed between `fork` and `exec`.
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

/// Limits files of this process to 512 bytes.
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
        // opened for reading and writing, as the standard library opens it in place of a closed descriptor
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
    // files that fit are there and complete
    assert!(
        written.iter().all(|name| name == "clock.csv"),
        "{written:?}"
    );
}

/// Two results go to one place: nothing runs, and the message has both options and the place.
#[test]
fn two_results_in_one_place_are_refused() {
    let directory = directory();
    std::fs::create_dir(directory.path().join("sub")).unwrap();
    std::os::unix::fs::symlink("a.svg", directory.path().join("link.svg")).unwrap();
    std::os::unix::fs::symlink("clock.yaml", directory.path().join("model.svg")).unwrap();
    let before = files(directory.path());
    for (arguments, said) in [
        (
            "run clock.yaml --csv a.svg --picture a.svg",
            "says otherwise",
        ),
        (
            "run clock.yaml --csv a.svg --picture ./sub/../a.svg",
            "says otherwise",
        ),
        (
            "run clock.yaml --csv a.svg --picture link.svg",
            "says otherwise",
        ),
        ("run clock.yaml --csv clock.svg", "says otherwise"),
        (
            "run clock.yaml --out sub --picture sub/clock-swing-over-time.svg --plot swing",
            "--picture and --plot 'swing over time'",
        ),
        (
            "run clock.yaml --plot swing --plot swing",
            "--plot 'swing over time' and --plot",
        ),
        (
            "run clock.yaml --csv - --picture -",
            "--csv and --picture both write to standard output",
        ),
        (
            "run clock.yaml --csv - --json",
            "--json and --csv both write to standard output",
        ),
        (
            "run clock.yaml --picture /dev/stdout --json",
            "standard output",
        ),
        (
            "run clock.yaml --csv a --final-state ./a",
            "--csv and --final-state both",
        ),
        (
            "run clock.yaml --csv - --final-state -",
            "--csv and --final-state both write to standard output",
        ),
        (
            "run clock.yaml --final-state clock.yaml",
            "--final-state would write to clock.yaml, which is read",
        ),
        (
            "run clock.yaml --csv clock.yaml",
            "--csv would write to clock.yaml, which is read",
        ),
        (
            "run clock.yaml --picture model.svg",
            "--picture would write to model.svg, which is read",
        ),
        (
            "accuracy clock.yaml --csv a.svg --picture a.svg",
            "says otherwise",
        ),
        (
            "accuracy clock.yaml --picture a.svg --picture ./a.svg",
            "--picture and --picture both",
        ),
        (
            "accuracy clock.yaml --markdown clock-accuracy.csv",
            "--csv and --markdown both",
        ),
        ("accuracy clock.yaml --markdown clock.yaml", "which is read"),
        (
            "stability --json --markdown -",
            "--json and --markdown both write to standard output",
        ),
    ] {
        let words: Vec<&str> = arguments.split(' ').collect();
        let (stdout, stderr) = call(directory.path(), &words, 2);
        assert!(
            stdout.is_empty() && stderr.contains(said),
            "{arguments}\n{stderr}"
        );
        assert!(stderr.contains("help:"), "{stderr}");
    }
    assert_eq!(files(directory.path()), before, "nothing is written");
    // a state is printed in place of the table
    let state = ["run", "clock.yaml", "--no-files", "--final-state", "-"];
    let (stdout, _) = call(directory.path(), &state, 0);
    assert!(stdout.starts_with("{\n  \"model\": \"clock\""), "{stdout}");
    assert_eq!(files(directory.path()), before, "nothing is written");
    // the null device accepts two results
    let twice = ["run", "clock.yaml", "--no-files", "--csv", "/dev/null"];
    call(directory.path(), &twice, 0);
}

#[test]
fn a_picture_is_what_its_name_says() {
    let directory = directory();
    let read = |name: &str| std::fs::read(directory.path().join(name)).unwrap();
    let run = |picture: &str, code| {
        let arguments = ["run", "clock.yaml", "--no-files", "--picture", picture];
        call(directory.path(), &arguments, code)
    };
    run("a.png", 0);
    assert!(read("a.png").starts_with(b"\x89PNG\r\n\x1a\n"));
    run("a.SVG", 0);
    assert!(read("a.SVG").starts_with(b"<svg"));
    for name in ["a.jpg", "a.pdf", "a", ".png"] {
        let (_, stderr) = run(name, 2);
        assert!(stderr.contains(".svg or as .png"), "{stderr}");
        assert!(!directory.path().join(name).exists());
    }
    // standard output has only the picture
    let (stdout, stderr) = run("-", 0);
    assert_eq!(stdout.as_bytes(), read("a.SVG"));
    assert!(stderr.contains("evaluations") && !directory.path().join("-").exists());
}

#[test]
fn plots_of_columns_are_told_before_anything_runs() {
    let directory = directory();
    let text = PENDULUM.replace("name: bob height", "name: '{}'");
    let text = text.replace("name: swing", "name: 'swing, over all'");
    std::fs::write(directory.path().join("odd.yaml"), text).unwrap();
    let run = |plot: &str, code| {
        let arguments = ["run", "odd.yaml", "--no-files", "--plot", plot];
        call(directory.path(), &arguments, code).1
    };
    assert!(run("{}", 0).contains("wrote clock-u007b-u007d-over-time.svg"));
    assert!(
        run("swing, over all over {}", 0)
            .contains("wrote clock-swing-over-all-over-u007b-u007d.svg")
    );
    let before = files(directory.path());
    assert!(run("--", 2).contains("there is no column \"--\""));
    assert!(run("{}, swing, over all", 2).contains("do not fit one axis"));
    assert_eq!(files(directory.path()), before, "bad input writes nothing");
}

/// A user who stops reading is also told that a run cannot be trusted.
#[test]
fn a_reader_who_leaves_does_not_make_a_run_good() {
    let directory = directory();
    let arguments = ["run", "cut-short.yaml", "--no-files"];
    let mut command = bryant(directory.path());
    command
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    drop(child.stdout.take());
    let (_, stderr) = expect(child.wait_with_output().unwrap(), &arguments, 3);
    assert!(
        stderr.contains("a curve with `extrapolate: error`"),
        "{stderr}"
    );
}

/// Names that are not regular files: a device without an end, a pipe that nobody writes to, a folder.
fn endless(at: &Path) {
    std::os::unix::fs::symlink("/dev/zero", at.join("zero")).unwrap();
    let made = std::process::Command::new("mkfifo")
        .arg(at.join("pipe"))
        .status();
    assert!(made.unwrap().success());
    std::fs::create_dir(at.join("folder")).unwrap();
}

#[test]
fn what_is_no_file_is_not_read() {
    let directory = directory();
    let at = |name: &str| directory.path().join(name);
    endless(directory.path());
    let write = |name: &str, text: &str| std::fs::write(at(name), text).unwrap();
    for odd in ["zero", "pipe", "folder"] {
        write(
            "includes.yaml",
            &format!(
                "model: includes\ninclude: [{odd}]\n{}",
                &PENDULUM["model: clock\n".len()..]
            ),
        );
        write(
            "curve.yaml",
            &PENDULUM.replace(
                "outputs:",
                &format!("curves: {{ c: {{ file: {odd}, columns: [a, b] }} }}\noutputs:"),
            ),
        );
        write("user.yaml", &PENDULUM.replace("outputs:", &format!("  - {{ user: drag, source: {odd}, points: {{ a: {{ on: clock/rod, at: [0, 0] }} }} }}\noutputs:")));
        write(
            "study.yaml",
            &format!(
                "model: clock.yaml\ndesign: list\nrows: {{ csv: {odd} }}\nresponses: [{{ of: swing, what: peak }}]\n"
            ),
        );
        write(
            "of.yaml",
            &format!(
                "model: {odd}\ndesign: list\nrows: [{{ gravity: 9 }}]\nresponses: [{{ of: swing, what: peak }}]\n"
            ),
        );
        for arguments in [
            &["check", odd][..],
            &["check", &format!("./{odd}")],
            &["check", "includes.yaml"],
            &["check", "curve.yaml"],
            &["check", "user.yaml"],
            &["sweep", odd],
            &["sweep", "study.yaml"],
            &["sweep", "of.yaml"],
            &["merge", odd],
            &["equations", "clock.yaml", "--at", odd],
        ] {
            let (stdout, stderr) = call(directory.path(), arguments, 2);
            let said = ["it is not a file", "is not a folder of results"];
            let said = said.iter().any(|said| stderr.contains(said));
            assert!(
                stdout.is_empty() && said && stderr.contains("help"),
                "{arguments:?} {odd}\n{stderr}"
            );
        }
    }
    // a link to a file is a file
    std::os::unix::fs::symlink("clock.yaml", at("link.yaml")).unwrap();
    call(directory.path(), &["check", "link.yaml"], 0);
    // standard input has an end, or an error
    let mut command = bryant(directory.path());
    command.args(["equations", "clock.yaml", "--at", "-"]);
    command.stdin(std::fs::File::open("/dev/zero").unwrap());
    let (_, stderr) = expect(command.output().unwrap(), &["--at", "-"], 2);
    assert!(stderr.contains("standard input is longer than"), "{stderr}");
}

#[test]
fn what_is_no_file_in_a_folder_of_results_is_not_read() {
    let directory = directory();
    let at = |name: &str| directory.path().join(name);
    endless(directory.path());
    let study = "model: clock.yaml\ndesign: list\nrows: [{ gravity: 9 }, { gravity: 10 }]\nresponses: [{ of: swing, what: peak }]\nkeep: { runs: [0] }\n";
    std::fs::write(at("study.yaml"), study).unwrap();
    call(
        directory.path(),
        &["sweep", "study.yaml", "--out", "results"],
        0,
    );
    for name in [
        "study.json",
        "study/study.yaml",
        "study/facts.json",
        "blocks/00000000.part",
        "series/run-00000000.csv",
    ] {
        let (file, kept) = (at("results").join(name), at("kept"));
        std::fs::rename(&file, &kept).unwrap();
        std::os::unix::fs::symlink("/dev/zero", &file).unwrap();
        for arguments in [
            &["merge", "results"][..],
            &["sweep", "study.yaml", "--out", "results"],
        ] {
            let output = bryant(directory.path()).args(arguments).output().unwrap();
            let code = output.status.code();
            assert!(
                matches!(code, Some(0..=2)),
                "{name} {arguments:?} {output:?}"
            );
        }
        std::fs::rename(&kept, &file).unwrap();
    }
}

#[test]
fn more_samples_than_can_be_kept_are_refused() {
    let directory = directory();
    for (arguments, said) in [
        (
            &[
                "gradient",
                "clock.yaml",
                "--of",
                "peak of swing",
                "--sampling",
                "1e-8",
            ][..],
            " GB",
        ),
        (&["run", "clock.yaml", "--every", "1e-8"], " GB"),
        (
            &["accuracy", "clock.yaml", "--every", "1e-8"],
            "1.0e8 samples",
        ),
    ] {
        let (stdout, stderr) = call(directory.path(), arguments, 2);
        assert!(
            stdout.is_empty() && stderr.contains(said) && stderr.contains("help:"),
            "{stderr}"
        );
    }
}
