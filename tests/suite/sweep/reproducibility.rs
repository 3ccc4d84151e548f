//! The same study has the same files, byte by byte: blocks, series, tables, summary and pictures.

use super::directory;
use super::folder::{Table, assert_same, files};
use crate::command_call::{bryant, call};
use bryant_runtime::Width;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

#[test]
fn threads_lanes_and_shards_leave_no_trace() {
    let directory = directory();
    let at = directory.path();
    let sweep = |out: &str, more: &[&str]| {
        let mut arguments = vec!["sweep", "seat.yaml", "--out", out];
        arguments.extend(more);
        call(at, &arguments, 0);
    };
    sweep("one", &["--threads", "1"]);
    let names: Vec<String> = files(&at.join("one")).into_keys().collect();
    for name in [
        "blocks/00000009.part",
        "results.csv",
        "results.parquet",
        "scatter.svg",
        "series/run-00000117.csv",
        "study.json",
        "study/study.yaml",
        "summary.json",
        "summary.txt",
        "tornado.svg",
    ] {
        assert!(names.iter().any(|n| n == name), "no {name} in {names:?}");
    }

    sweep("two", &["--threads", "2"]);
    assert_same(&at.join("one"), &at.join("two"));
    sweep("five", &["--threads", "5"]);
    assert_same(&at.join("one"), &at.join("five"));

    for width in Width::ALL.iter().filter(|width| width.is_available()) {
        let folder = format!("lanes-{}", width.name());
        sweep(&folder, &["--lanes", width.name()]);
        assert_same(&at.join("one"), &at.join(&folder));
    }

    // in any order, with other threads and lanes
    for (shard, more) in [("2/3", "1"), ("0/3", "3"), ("1/3", "2")] {
        sweep("shared", &["--shard", shard, "--threads", more]);
        assert!(!at.join("shared/results.csv").exists());
    }
    call(at, &["merge", "shared"], 0);
    assert_same(&at.join("one"), &at.join("shared"));

    // once more: nothing changes, and nothing is run
    let (_, said) = call(at, &["sweep", "seat.yaml", "--out", "shared"], 0);
    assert!(
        said.contains("0 runs in") && said.contains("160 were there"),
        "{said}"
    );
    call(at, &["merge", "shared"], 0);
    assert_same(&at.join("one"), &at.join("shared"));
}

/// Pseudo-random numbers from a seed, the same in every run of the test [Steele, Lea, Flood 2014: SplitMix64].
struct Chance(u64);

impl Chance {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) % bound
    }
}

/// Number of times that a study is killed before it can end.
const KILLS: usize = 12;
/// Number of blocks of the study.
const BLOCKS: usize = 64;

fn blocks(folder: &Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder.join("blocks")) else {
        return 0;
    };
    let whole = |name: &str| name.ends_with(".part") && !name.starts_with('.');
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter(|name| whole(name)).count()
}

#[test]
fn killed_again_and_again_a_study_loses_nothing() {
    let directory = directory();
    let at = directory.path();
    let long = super::SEAT
        .replace("runs: 160", &format!("runs: {}", 16 * BLOCKS))
        .replace("duration: 60 ms", "duration: 51 ms");
    std::fs::write(at.join("long.yaml"), long).unwrap();
    let begin = Instant::now();
    call(
        at,
        &["sweep", "long.yaml", "--out", "whole", "--threads", "2"],
        0,
    );
    // all killed processes together have less than half of the time, however fast this machine is
    let longest = begin.elapsed() / (2 * KILLS as u32);

    let mut chance = Chance(6);
    let folder = at.join("killed");
    for kill in 0..KILLS {
        let mut child = bryant(at)
            .args(["sweep", "long.yaml", "--out", "killed", "--threads", "2"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // every other one is killed while it begins, the others after they have stored something
        let before = blocks(&folder);
        let deadline = Instant::now() + Duration::from_secs(20);
        while kill % 2 == 1 && blocks(&folder) == before && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(longest * chance.below(1000) as u32 / 1000);
        child.kill().unwrap();
        let ended = child.wait().unwrap();
        // killed, not done: it has no exit code
        assert_eq!(
            ended.code(),
            None,
            "{} blocks after {kill} kills",
            blocks(&folder)
        );
    }
    let stored = blocks(&folder);
    assert!(0 < stored && stored < BLOCKS, "{stored}");

    let (_, said) = call(at, &["sweep", "long.yaml", "--out", "killed"], 0);
    assert!(
        said.contains(&format!("{} were there", 16 * stored)),
        "{said}"
    );
    assert_same(&at.join("whole"), &folder);
    let table = Table::read(&folder.join("results.csv"));
    let indices: Vec<String> = (0..16 * BLOCKS).map(|index| index.to_string()).collect();
    assert_eq!(table.words("run"), indices);
}
