//! A study that is killed again and again at random times and then finished: no row is lost, none is there twice, and
//! the table has the same bytes as without interruption.
//!
//! The program is its own child process: if a folder is in its environment, it runs the study there, slowly.

use crate::common::{Closed, ishigami, open, study};
use bryant_study::engine::{Engine, EngineError, Outcomes, Series, Worker};
use bryant_study::hash;
use bryant_study::results::Results;
use bryant_study::run::run;
use bryant_study::shard::Shard;
use bryant_study::study::Study;
use bryant_study::table::merge;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// The environment variable with the folder for the child process.
const FOLDER: &str = "BRYANT_STUDY_KILLED_FOLDER";
/// Least number of kills.
const KILLS: usize = 24;

/// A slow formula.
struct Slow;

impl Engine for Slow {
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError> {
        Ok(Box::new(Slow))
    }
}

impl Worker for Slow {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        std::thread::sleep(Duration::from_millis(8));
        Closed(ishigami).worker()?.run(rows, outcomes)
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        Closed(ishigami).worker()?.series(row)
    }
}

#[test]
fn no_row_is_lost() {
    let study = study("design: latin hypercube\nruns: 20000\nseed: 9\ntables: [csv, parquet]");
    match std::env::var_os(FOLDER) {
        Some(folder) => child(&study, Path::new(&folder)),
        None => killed_studies_lose_nothing(&study),
    }
}

fn child(study: &Study, folder: &Path) {
    run(study, &Slow, &open(folder, study), Shard::WHOLE, 2, &|_| {}).unwrap();
}

fn killed_studies_lose_nothing(study: &Study) {
    let expected = {
        let folder = tempfile::tempdir().unwrap();
        run(
            study,
            &Closed(ishigami),
            &open(folder.path(), study),
            Shard::WHOLE,
            1,
            &|_| {},
        )
        .unwrap();
        tables(study, folder.path())
    };
    let folder = tempfile::tempdir().unwrap();
    let mut interrupted = 0;
    for attempt in 0..KILLS {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "interruptions::no_row_is_lost"])
            .env(FOLDER, folder.path())
            .spawn()
            .unwrap();
        // every other one is killed while it begins, the others after they have stored something
        let before = blocks(folder.path());
        let deadline = Instant::now() + Duration::from_secs(20);
        while attempt % 2 == 1 && blocks(folder.path()) == before && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(1));
        }
        let wait = 20.0 * hash::uniform(1, 0, attempt as u64);
        std::thread::sleep(Duration::from_micros((1000.0 * wait) as u64));
        child.kill().unwrap();
        interrupted += usize::from(!child.wait().unwrap().success());
    }
    assert_eq!(interrupted, KILLS, "every attempt is ended before its end");
    let report = run(
        study,
        &Closed(ishigami),
        &open(folder.path(), study),
        Shard::WHOLE,
        2,
        &|_| {},
    )
    .unwrap();
    assert!(
        report.damaged.is_empty(),
        "a block was left half written: {:?}",
        report.damaged
    );
    assert!(report.found > 0 && report.found < report.rows, "{report:?}");
    assert!(
        tables(study, folder.path()) == expected,
        "the tables differ"
    );
    let left = std::fs::read_dir(folder.path().join("blocks"))
        .unwrap()
        .count();
    assert_eq!(
        left,
        blocks(folder.path()),
        "what was left unfinished is gone"
    );
    println!(
        "killed {interrupted} times, {} of {} rows were kept",
        report.found, report.rows
    );
}

/// Number of stored blocks.
fn blocks(folder: &Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder.join("blocks")) else {
        return 0;
    };
    let stored = entries
        .flatten()
        .filter(|e| e.path().extension().is_some_and(|end| end == "part"));
    stored.count()
}

/// Both tables; each row must be in its place.
fn tables(study: &Study, path: &Path) -> [Vec<u8>; 2] {
    let folder = open(path, study);
    let files = merge(&Results::new(study, &folder, None).unwrap()).unwrap();
    let [csv, parquet] = &files[..] else {
        panic!("{files:?}")
    };
    let mut reader = csv::Reader::from_path(csv).unwrap();
    let runs: Vec<u64> = reader
        .records()
        .map(|r| r.unwrap()[0].parse().unwrap())
        .collect();
    assert_eq!(runs, (0..20_000).collect::<Vec<u64>>());
    [csv, parquet].map(|file| std::fs::read(file).unwrap())
}
