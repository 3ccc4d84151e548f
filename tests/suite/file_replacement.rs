//! Files that are there already: those that the program wrote are replaced, others are not, and no command writes to
//! what it reads.

use super::command_call::call;
use super::{PENDULUM, directory};
use std::fs;
use std::path::Path;

/// Every file of a run, by the option that names it.
const FILES: [(&str, &str); 8] = [
    ("--csv", "table.csv"),
    ("--picture", "motion.svg"),
    ("--picture", "motion.png"),
    ("--report", "run.html"),
    ("--animation", "run.glb"),
    ("--parquet", "table.parquet"),
    ("--final-state", "state.json"),
    ("--mme", "test"),
];

fn run(at: &Path, option: &str, file: &str, more: &[&str], code: i32) -> String {
    let mut arguments = vec!["run", "clock.yaml", "--no-files", option, file];
    arguments.extend(more);
    call(at, &arguments, code).1
}

/// A run is repeated, and so is that of an edited model: other outputs, another title, other times.
#[test]
fn a_repeated_run_replaces_its_files() {
    let directory = directory();
    let at = directory.path();
    let edited = PENDULUM
        .replace("name: swing", "name: angle")
        .replace("a rod", "a long rod")
        .replace("every: 0.1 s", "every: 0.05 s");
    for (option, file) in FILES {
        for text in [PENDULUM, PENDULUM, &edited, PENDULUM] {
            fs::write(at.join("clock.yaml"), text).unwrap();
            run(at, option, file, &[], 0);
        }
    }
    // the usual names, and plots
    for _ in 0..2 {
        call(at, &["run", "clock.yaml", "--plot", "swing"], 0);
    }
}

#[test]
fn a_file_of_someone_else_is_not_replaced() {
    let directory = directory();
    let at = directory.path();
    let tables = [
        "data\n",
        "time [s],swing [rad],bob height [m]\n0,0,0\n0.1,0,0\n",
        "\"time [s]\",\"swing [rad]\"\n0,0\n",
        "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>\n",
        "<!DOCTYPE html><html></html>\n",
        "{\"model\": \"clock\"}\n",
        "\u{89}PNG\r\n",
        "glTF",
        "PAR1",
    ];
    for (option, file) in FILES.into_iter().filter(|(option, _)| *option != "--mme") {
        for text in tables {
            fs::write(at.join(file), text).unwrap();
            let said = run(at, option, file, &[], 2);
            assert!(said.contains(file) && said.contains("--force"), "{said}");
            assert_eq!(fs::read_to_string(at.join(file)).unwrap(), text, "{option}");
        }
        run(at, option, file, &["--force"], 0);
        run(at, option, file, &[], 0);
        // nothing is lost with an empty file
        fs::write(at.join(file), "").unwrap();
        run(at, option, file, &[], 0);
    }
    fs::write(at.join("clock.csv"), "a measurement\n").unwrap();
    let (_, said) = call(at, &["run", "clock.yaml"], 2);
    assert!(said.contains("clock.csv"), "{said}");
    assert!(
        !at.join("clock.svg").exists(),
        "refused before anything is written"
    );
    for file in ["clock.mme", "Channel/clock.chn"] {
        let foreign = at.join("foreign").join(file);
        fs::create_dir_all(foreign.parent().unwrap()).unwrap();
        fs::write(&foreign, "Data format edition number  :1.6\n").unwrap();
        let said = run(at, "--mme", "foreign", &[], 2);
        assert!(said.contains("--force"), "{said}");
        fs::remove_file(foreign).unwrap();
    }
}

/// Not even on request.
#[test]
fn no_command_writes_to_what_it_reads() {
    let directory = directory();
    let at = directory.path();
    run(at, "--csv", "measured.csv", &[], 0);
    for (option, more) in [
        ("--report", &["--measured", "measured.csv"][..]),
        (
            "--csv",
            &["--report", "r.html", "--measured", "measured.csv"],
        ),
    ] {
        let mut arguments = vec!["run", "clock.yaml", "--no-files", "--force"];
        arguments.extend(more);
        arguments.extend([option, "measured.csv"]);
        let (_, said) = call(at, &arguments, 2);
        assert!(said.contains("measured.csv"), "{said}");
    }
    for arguments in [
        ["run", "clock.yaml", "--csv", "clock.yaml"],
        ["settle", "clock.yaml", "-o", "clock.yaml"],
    ] {
        let arguments = [&arguments[..], &["--force"]].concat();
        call(at, &arguments, 2);
    }
    assert_eq!(fs::read_to_string(at.join("clock.yaml")).unwrap(), PENDULUM);
}

#[test]
fn a_person_that_was_changed_is_not_replaced() {
    let directory = directory();
    let at = directory.path();
    let person = |stature: &str, more: &[&str], code: i32| {
        let mut arguments = vec!["human", "--sex", "m", "--mass", "75 kg", "-o", "man.yaml"];
        arguments.extend(["--stature", stature]);
        arguments.extend(more);
        call(at, &arguments, code).1
    };
    person("1.7 m", &[], 0);
    person("1.8 m", &[], 0);
    let path = at.join("man.yaml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("mass:", "mass:  ", 1)).unwrap();
    let said = person("1.7 m", &[], 2);
    assert!(
        said.contains("changed") && said.contains("--force"),
        "{said}"
    );
    person("1.7 m", &["--force"], 0);
    person("1.7 m", &[], 0);
}

#[test]
fn an_ending_says_what_a_file_is() {
    let directory = directory();
    let at = directory.path();
    for (option, file) in [
        ("--report", "x.pdf"),
        ("--animation", "x.gltf"),
        ("--parquet", "x.csv"),
        ("--csv", "x.xlsx"),
        ("--final-state", "x.yaml"),
    ] {
        let said = run(at, option, file, &[], 2);
        assert!(
            said.contains("says otherwise") && said.contains("help"),
            "{said}"
        );
        assert!(!at.join(file).exists());
    }
    run(at, "--report", "run.htm", &[], 0);
    run(at, "--csv", "table", &[], 0);
}

/// What a file is decides what is said of it, and what to do with it.
#[test]
fn a_file_that_is_something_else_is_told_so() {
    let directory = directory();
    let at = directory.path();
    let study = "model: clock.yaml\ndesign: grid\nparameters: { gravity: { from: 9, to: 10, steps: 2 } }\nresponses: [{ of: swing, what: peak }]\n";
    fs::write(at.join("study.yaml"), study).unwrap();
    let files = [
        "--csv",
        "t.csv",
        "--final-state",
        "s.json",
        "--picture",
        "p.png",
        "--report",
        "r.html",
    ];
    call(at, &[&["run", "clock.yaml"], &files[..]].concat(), 0);
    call(at, &["human", "--like", "male-50", "-o", "man.yaml"], 0);
    for (file, needles) in [
        ("study.yaml", ["a study", "bryant sweep"]),
        ("./t.csv", ["a table (CSV)", "help"]),
        ("./s.json", ["a state of a run", "--start"]),
        ("./p.png", ["a picture (PNG)", "help"]),
        ("./r.html", ["a page of the web (HTML)", "help"]),
        ("man.yaml", ["a part that models include", "include:"]),
    ] {
        for command in ["run", "check"] {
            let (_, said) = call(at, &[command, file], 2);
            assert!(
                needles.iter().all(|needle| said.contains(needle)),
                "{file}: {said}"
            );
            assert_eq!(said.matches("error").count(), 1, "{said}");
        }
    }
    let (_, said) = call(at, &["sweep", "clock.yaml"], 2);
    assert!(
        said.contains("a model, not a study") && said.contains("bryant run"),
        "{said}"
    );
}
