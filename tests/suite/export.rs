//! `bryant export`: what the archives of FMUs contain, and what none is made of. What FMUs compute is tested by FMPy.

use crate::command_call::call;
use std::io::Read;
use std::path::{Path, PathBuf};
use tempfile::tempdir;
use zip::ZipArchive;

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

/// The files in an archive, and the description in it.
fn content(path: &Path) -> (Vec<String>, String) {
    let mut archive = ZipArchive::new(std::fs::File::open(path).unwrap()).unwrap();
    let names = archive.file_names().map(str::to_owned).collect();
    let mut description = String::new();
    let mut file = archive.by_name("modelDescription.xml").unwrap();
    file.read_to_string(&mut description).unwrap();
    (names, description)
}

/// The shared library that is built with the program.
fn library() -> PathBuf {
    let folder = Path::new(env!("CARGO_BIN_EXE_bryant")).parent().unwrap();
    let name = match (cfg!(windows), cfg!(target_os = "macos")) {
        (true, _) => "bryant_fmi.dll",
        (_, true) => "libbryant_fmi.dylib",
        _ => "libbryant_fmi.so",
    };
    folder.join("deps").join(name)
}

#[test]
fn an_fmu_has_a_description_a_model_and_a_library() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    for (version, place) in [("2", "linux64"), ("3", "x86_64-linux")] {
        let arguments = ["export", "fmu", "child-seat", "--fmi", version, "--force"];
        let (_, said) = call(folder, &arguments, 0);
        assert!(said.contains(&format!("FMI {version}.0")), "{said}");
        let (names, description) = content(&folder.join("child-seat.fmu"));
        assert_eq!(names.len(), 4, "{names:?}");
        if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            let expected = format!("binaries/{place}/child_seat.so");
            assert!(names.contains(&expected), "{names:?}");
        }
        for part in [
            format!("fmiVersion=\"{version}.0\""),
            "modelIdentifier=\"child_seat\"".to_owned(),
            "name=\"lap_slack\"".to_owned(),
            "stopTime=\"0.16\" stepSize=\"0.002\"".to_owned(),
        ] {
            assert!(description.contains(&part), "{part}: {description}");
        }
    }
    // options are start values; the same export has the same bytes
    let set = ["export", "fmu", "child-seat", "--set", "lap_slack=20 mm"];
    call(folder, &[&set[..], &["-o", "a.fmu"]].concat(), 0);
    call(folder, &[&set[..], &["-o", "b.fmu"]].concat(), 0);
    assert_eq!(bytes(&folder.join("a.fmu")), bytes(&folder.join("b.fmu")));
    let (_, description) = content(&folder.join("a.fmu"));
    assert!(description.contains("start=\"0.02\""), "{description}");
    // an archive of this program may be replaced, another file may not
    call(folder, &[&set[..], &["-o", "a.fmu"]].concat(), 0);
    std::fs::write(folder.join("notes.fmu"), "mine").unwrap();
    let (_, said) = call(folder, &[&set[..], &["-o", "notes.fmu"]].concat(), 2);
    assert!(said.contains("did not write"), "{said}");
}

#[test]
fn a_run_of_an_fmu_may_begin_at_a_state() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let run = ["run", "child-seat", "--no-files", "--no-verify"];
    let until = ["--duration", "60 ms", "--final-state", "state.json"];
    call(folder, &[&run[..], &until].concat(), 0);
    call(
        folder,
        &["export", "fmu", "child-seat", "--start", "state.json"],
        0,
    );
    let (_, description) = content(&folder.join("child-seat.fmu"));
    assert!(description.contains("startTime=\"0.06\""), "{description}");
}

#[test]
fn what_an_fmu_cannot_carry_is_refused() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("text.so"), "no library").unwrap();
    let library = library().display().to_string();
    for (arguments, words) in [
        // a function of the user
        (&["skydiver"][..], "an FMU carries none"),
        (
            &["child-seat", "--library", "text.so"],
            "is no library of FMUs",
        ),
        (
            &["child-seat", "--library", "none.so"],
            "cannot read none.so",
        ),
        (
            &["child-seat", "--library", &library, "--library", &library],
            "two libraries for",
        ),
        (&["child-seat", "-o", "seat.zip"], "says otherwise"),
        (&["child-seat", "--set", "lap_slack=-1 mm"], "lap_slack"),
        (&["child-seat", "--start", "none.json"], "none.json"),
    ] {
        let arguments = [&["export", "fmu"], arguments].concat();
        let (_, said) = call(folder, &arguments, 2);
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    let written = std::fs::read_dir(folder).unwrap().count();
    assert_eq!(written, 1, "a refused export wrote a file");
}
