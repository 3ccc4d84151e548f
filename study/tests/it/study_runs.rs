//! Runs of whole studies: the same bytes however they are run, and messages if they cannot be run.

use crate::common;
use crate::common::parquet::{self, Cell};
use crate::common::{Closed, NO_WAY, ishigami, open, program, study};
use bryant_study::engine::{Engine, EngineError, Outcomes, Series, Worker};
use bryant_study::results::{Results, ResultsError};
use bryant_study::run::{Progress, Report, RunError, run};
use bryant_study::shard::Shard;
use bryant_study::store::part::PartError;
use bryant_study::store::{Folder, FolderError};
use bryant_study::study::Study;
use bryant_study::table::{TableError, merge};
use std::path::Path;
use std::sync::Mutex;

const TABLES: &str = "design: sobol\nruns: 3000\nseed: 4\ntables: [parquet, csv]\nkeep: { runs: [5, 7], every: 1000, outputs: [way] }";

fn run_quietly(study: &Study, folder: &Folder, shard: Shard, threads: usize) -> Report {
    run(study, &Closed(ishigami), folder, shard, threads, &|_| {}).unwrap()
}

/// Names and bytes of all files of a folder except the blocks, whose content is in the tables.
fn files(path: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for directory in [path.to_owned(), path.join("series"), path.join("blocks")] {
        for entry in std::fs::read_dir(&directory).unwrap() {
            let entry = entry.unwrap();
            if entry.path().is_file() {
                let name = entry
                    .path()
                    .strip_prefix(path)
                    .unwrap()
                    .to_string_lossy()
                    .into_owned();
                files.push((name, std::fs::read(entry.path()).unwrap()));
            }
        }
    }
    files.sort();
    files
}

fn merged(study: &Study, path: &Path) -> Vec<(String, Vec<u8>)> {
    let folder = open(path, study);
    merge(&Results::new(study, &folder, None).unwrap()).unwrap();
    files(path)
}

#[test]
fn any_number_of_threads_and_shards_gives_the_same_bytes() {
    let study = study(TABLES);
    let whole = tempfile::tempdir().unwrap();
    run_quietly(&study, &open(whole.path(), &study), Shard::WHOLE, 1);
    let expected = merged(&study, whole.path());
    for (shards, threads) in [(1, 3), (1, 64), (2, 1), (5, 2), (1000, 1)] {
        let folder = tempfile::tempdir().unwrap();
        // the last shard first, because their order does not matter
        for index in (0..shards).rev() {
            let shard = Shard::new(index, shards).unwrap();
            run_quietly(&study, &open(folder.path(), &study), shard, threads);
        }
        let found = merged(&study, folder.path());
        assert!(found == expected, "{shards} shards, {threads} threads");
    }
    assert!(merged(&study, whole.path()) == expected, "merged twice");
}

#[test]
fn a_table_has_every_row_once_with_what_the_formula_says() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    run_quietly(&study, &open(folder.path(), &study), Shard::WHOLE, 2);
    merged(&study, folder.path());
    let mut csv = csv::Reader::from_path(folder.path().join("results.csv")).unwrap();
    let headings = "run,a,b,c,final of force [N],final of way [m],status,steps,reached [s],error estimate,reason";
    assert_eq!(
        csv.headers().unwrap().iter().collect::<Vec<_>>().join(","),
        headings
    );
    let mut rows = 0;
    for record in csv.records() {
        let record = record.unwrap();
        assert_eq!(record[0].parse::<u64>().unwrap(), rows);
        let x: Vec<f64> = (1..4).map(|k| record[k].parse().unwrap()).collect();
        let [force, way] = ishigami(&x)[..] else {
            panic!("two responses")
        };
        assert_eq!(record[4].parse::<f64>().unwrap(), force);
        let status = if way.is_nan() { "non-finite" } else { "done" };
        assert_eq!(
            (record[5].parse().ok(), &record[6]),
            (way.is_finite().then_some(way), status)
        );
        assert_eq!(&record[10], if way.is_nan() { NO_WAY } else { "" });
        rows += 1;
    }
    assert_eq!(rows, 3000);
}

#[test]
fn parquet_and_csv_hold_the_same() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    run_quietly(&study, &open(folder.path(), &study), Shard::WHOLE, 2);
    merged(&study, folder.path());
    let file = std::fs::read(folder.path().join("results.parquet")).unwrap();
    let table = parquet::read(&file);
    assert_eq!(table.created_by, "bryant");
    let (_, reasons) = table.columns.last().unwrap();
    assert!(reasons.contains(&Cell::Text(NO_WAY.into())));
    assert!(table.metadata["units"].contains("\"final of way\":\"m\""));
    let keys: Vec<&String> = table.metadata.keys().collect();
    assert_eq!(
        keys,
        ["arithmetic", "identity", "model", "units", "version"]
    );
    let mut csv = csv::Reader::from_path(folder.path().join("results.csv")).unwrap();
    let headings = csv.headers().unwrap().clone();
    assert_eq!(headings.len(), table.columns.len());
    for ((name, cells), heading) in table.columns.iter().zip(&headings) {
        assert_eq!(heading.split(" [").next(), Some(name.as_str()));
        assert_eq!(cells.len(), 3000);
    }
    for (row, record) in csv.records().enumerate() {
        for ((_, cells), text) in table.columns.iter().zip(&record.unwrap()) {
            match &cells[row] {
                Cell::Double(x) if x.is_nan() => assert_eq!(text, ""),
                Cell::Double(x) => assert_eq!(text.parse(), Ok(*x)),
                Cell::Long(x) => assert_eq!(text.parse(), Ok(*x)),
                Cell::Count(x) => assert_eq!(text.parse(), Ok(*x)),
                Cell::Text(x) => assert_eq!(text, x),
            }
        }
    }
    // To read the tables with another program, name a directory by BRYANT_TABLES.
    if let Some(directory) = std::env::var_os("BRYANT_TABLES") {
        for name in ["results.parquet", "results.csv"] {
            std::fs::copy(folder.path().join(name), Path::new(&directory).join(name)).unwrap();
        }
    }
}

#[test]
fn series_of_kept_runs_are_written_and_follow_what_is_asked() {
    let mut study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    let report = run_quietly(&study, &open(folder.path(), &study), Shard::WHOLE, 1);
    assert_eq!(report.series, 5);
    let names: Vec<String> = files(folder.path())
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    for row in [0, 5, 7, 1000, 2000] {
        assert!(
            names.contains(&format!("series/run-{row:08}.csv")),
            "{names:?}"
        );
    }
    let text = std::fs::read_to_string(bryant_study::series::path(folder.path(), 5)).unwrap();
    assert!(text.starts_with("time [s],way [m]\n0,0\n0.1,"), "{text}");
    let again = run_quietly(&study, &open(folder.path(), &study), Shard::WHOLE, 1);
    assert_eq!((again.series, again.found), (0, 3000));
    study.keep.outputs.clear();
    let other = run_quietly(&study, &open(folder.path(), &study), Shard::WHOLE, 1);
    assert_eq!(other.series, 5);
}

#[test]
fn a_damaged_block_is_told_and_run_again() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    let store = open(folder.path(), &study);
    run_quietly(&study, &store, Shard::WHOLE, 2);
    let expected = merged(&study, folder.path());
    let [changed, cut, foreign] = [3, 10, 20].map(|block| store.block_path(block));
    let mut bytes = std::fs::read(&changed).unwrap();
    bytes[200] ^= 1;
    std::fs::write(&changed, &bytes).unwrap();
    std::fs::write(&cut, &std::fs::read(&cut).unwrap()[..100]).unwrap();
    std::fs::copy(store.block_path(21), &foreign).unwrap();
    let results = Results::new(&study, &store, None).unwrap();
    let error = merge(&results).unwrap_err();
    let TableError::Results(ResultsError::Damaged(blocks)) = error else {
        panic!("{error}");
    };
    let expected_blocks = [
        (3, PartError::Damaged),
        (10, PartError::Damaged),
        (20, PartError::Other),
    ];
    assert_eq!(blocks, expected_blocks);
    let told = Mutex::new(Vec::new());
    let tell = |progress: Progress| {
        if let Progress::Damaged { path, .. } = progress {
            told.lock().unwrap().push(path);
        }
    };
    let report = run(&study, &Closed(ishigami), &store, Shard::WHOLE, 2, &tell).unwrap();
    assert_eq!(report.damaged, [changed, cut, foreign]);
    assert_eq!(report.damaged, *told.lock().unwrap());
    assert_eq!(report.found, 3000 - 3 * 16);
    assert!(merged(&study, folder.path()) == expected);
}

#[test]
fn missing_blocks_are_named_with_their_shards() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    let store = open(folder.path(), &study);
    for index in [0, 1, 3] {
        run_quietly(&study, &store, Shard::new(index, 4).unwrap(), 1);
    }
    let error = Results::new(&study, &store, Some(4))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("47 of 188 blocks are missing: 2, 6, 10,"),
        "{error}"
    );
    assert!(error.contains("of shards 2 of 4"), "{error}");
}

#[test]
fn a_folder_of_another_study_is_refused() {
    let one = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    open(folder.path(), &one);
    let other = study(&TABLES.replace("seed: 4", "seed: 5"));
    let error = Folder::open(folder.path(), &other, &program()).unwrap_err();
    let FolderError::Other {
        there,
        here,
        differs,
        ..
    } = &error
    else {
        panic!("{error}")
    };
    assert_ne!(there, here);
    assert_eq!(differs, &["the study (the values of the parameters)"]);
    let mut program = program();
    program.model = "another".into();
    let error = Folder::open(folder.path(), &one, &program)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("differs: the model\n") && error.contains("help: name another folder"),
        "{error}"
    );
}

#[test]
fn tables_and_kept_runs_may_change_without_another_folder() {
    let folder = tempfile::tempdir().unwrap();
    open(folder.path(), &study(TABLES));
    open(folder.path(), &study("design: sobol\nruns: 3000\nseed: 4"));
}

#[test]
fn a_folder_of_something_else_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("thesis.txt"), "mine").unwrap();
    let error = Folder::open(folder.path(), &study(TABLES), &program()).unwrap_err();
    assert!(matches!(error, FolderError::Foreign(_)), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("study.json"), "{}").unwrap();
    let error = Folder::open(folder.path(), &study(TABLES), &program()).unwrap_err();
    assert!(matches!(error, FolderError::Unreadable { .. }), "{error}");
}

/// An engine that wants many rows at once.
struct Wide(u64);

impl Engine for Wide {
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError> {
        Ok(Box::new(Wide(self.0)))
    }

    fn rows_at_once(&self) -> u64 {
        self.0
    }
}

impl Worker for Wide {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        // as many whole blocks of 16 rows as it wants, or less if no more are left
        let count = (rows.len() / common::PARAMETERS) as u64;
        assert!(count <= self.0.next_multiple_of(16), "{count}");
        Closed(ishigami).worker()?.run(rows, outcomes)
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        Closed(ishigami).worker()?.series(row)
    }
}

#[test]
fn rows_at_once_are_whole_blocks_with_the_same_results() {
    let study = study(TABLES);
    let one = tempfile::tempdir().unwrap();
    run_quietly(&study, &open(one.path(), &study), Shard::WHOLE, 1);
    let expected = merged(&study, one.path());
    for rows in [17, 500, 1_000_000] {
        let folder = tempfile::tempdir().unwrap();
        let store = open(folder.path(), &study);
        let report = run(&study, &Wide(rows), &store, Shard::WHOLE, 2, &|_| {}).unwrap();
        assert_eq!((report.rows, report.found), (3000, 0));
        assert!(merged(&study, folder.path()) == expected, "{rows} at once");
    }
}

#[test]
fn shards_open_one_folder_at_the_same_time() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new/deep");
    std::thread::scope(|scope| {
        for index in 0..8 {
            let (path, study) = (&path, &study);
            scope.spawn(move || {
                let shard = Shard::new(index, 8).unwrap();
                run_quietly(study, &open(path, study), shard, 1);
            });
        }
    });
    let whole = tempfile::tempdir().unwrap();
    run_quietly(&study, &open(whole.path(), &study), Shard::WHOLE, 1);
    assert!(merged(&study, &path) == merged(&study, whole.path()));
}

/// Removes the folder, or stops working, after some rows.
struct Failing<'a> {
    folder: &'a Path,
    rows: Mutex<usize>,
    removes: bool,
}

impl Engine for Failing<'_> {
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError> {
        Ok(Box::new(FailingWorker(self)))
    }
}

struct FailingWorker<'a>(&'a Failing<'a>);

impl Worker for FailingWorker<'_> {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        let mut left = self.0.rows.lock().unwrap();
        *left = left.saturating_sub(rows.len());
        if *left == 0 && self.0.removes {
            std::fs::rename(self.0.folder.join("blocks"), self.0.folder.join("away")).unwrap();
            *left = usize::MAX;
        } else if *left == 0 {
            return Err(EngineError("the device is lost".into()));
        }
        Closed(ishigami).worker()?.run(rows, outcomes)
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        Closed(ishigami).worker()?.series(row)
    }
}

#[test]
fn what_is_done_stays_where_a_file_cannot_be_written() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let store = open(path, &study);
    let engine = Failing {
        folder: path,
        rows: Mutex::new(1000 * 3),
        removes: true,
    };
    let error = run(&study, &engine, &store, Shard::WHOLE, 1, &|_| {}).unwrap_err();
    // blocks of 16 rows; the block during which the folder disappears is not stored
    assert!(
        matches!(
            error,
            RunError::Write {
                done: 992,
                total: 3000,
                ..
            }
        ),
        "{error}"
    );
    let message = error.to_string();
    assert!(
        message.contains("00000062.part") && message.contains("goes on from there"),
        "{message}"
    );
    std::fs::rename(path.join("away"), path.join("blocks")).unwrap();
    assert_eq!(run_quietly(&study, &store, Shard::WHOLE, 2).found, 992);
}

#[test]
fn what_is_done_stays_where_the_engine_fails() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    let store = open(folder.path(), &study);
    let engine = Failing {
        folder: folder.path(),
        rows: Mutex::new(1000 * 3),
        removes: false,
    };
    let error = run(&study, &engine, &store, Shard::WHOLE, 1, &|_| {}).unwrap_err();
    assert!(
        matches!(error, RunError::Engine { done: 992, .. }),
        "{error}"
    );
    assert!(error.to_string().contains("the device is lost"), "{error}");
}

#[test]
fn a_full_disk_is_told_as_such() {
    use std::io::{Error, ErrorKind};
    let source = Error::from(ErrorKind::StorageFull);
    let error = bryant_study::store::write::WriteError {
        path: "blocks/00000003.part".into(),
        source,
    };
    let message = RunError::Write {
        error,
        done: 192,
        total: 3000,
    }
    .to_string();
    for words in [
        "00000003.part",
        "192 of 3000 rows",
        "make room",
        "the same command goes on",
    ] {
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn progress_grows_to_all_rows() {
    let study = study(TABLES);
    let folder = tempfile::tempdir().unwrap();
    let told = Mutex::new(Vec::new());
    let tell = |progress: Progress| {
        if let Progress::Rows { done, total, .. } = progress {
            told.lock().unwrap().push((done, total));
        }
    };
    run(
        &study,
        &Closed(ishigami),
        &open(folder.path(), &study),
        Shard::WHOLE,
        4,
        &tell,
    )
    .unwrap();
    let told = told.into_inner().unwrap();
    assert!(
        told.windows(2).all(|pair| pair[0].0 < pair[1].0),
        "{told:?}"
    );
    assert_eq!((told[0], told[told.len() - 1]), ((0, 3000), (3000, 3000)));
}

/// The lock ends with the process, however it ends, because it is the system's; here it ends when it is dropped.
#[test]
fn two_commands_do_not_run_the_same_rows() {
    let study = study(TABLES);
    let directory = tempfile::tempdir().unwrap();
    let folder = open(directory.path(), &study);
    let shard = |index| Shard::new(index, 2).unwrap();
    let busy = |shard| match folder.lock(shard) {
        Ok(_) => false,
        Err(FolderError::Busy(path)) => path == directory.path(),
        Err(error) => panic!("{error}"),
    };
    let whole = folder.lock(Shard::WHOLE).unwrap();
    assert!(busy(Shard::WHOLE) && busy(shard(0)));
    drop(whole);
    let first = folder.lock(shard(0)).unwrap();
    assert!(busy(Shard::WHOLE) && busy(shard(0)) && !busy(shard(1)));
    drop(first);
    assert!(!busy(Shard::WHOLE));
}
