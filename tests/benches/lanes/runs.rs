//! Number of runs of child-seat in a second, as in `bryant sweep`: six parameters, 120 ms, to 0.1 %, each row twice for
//! the estimate of its error, with results on disk.

use bryant::bundled;
use bryant::sweep::{self, Lanes};
use bryant_runtime::Width;
use bryant_study::facts::ModelFacts;
use bryant_study::file::StudyFile;
use bryant_study::run::run;
use bryant_study::shard::Shard;
use bryant_study::store::Folder;
use bryant_study::store::identity::Program;
use std::path::Path;
use std::time::Instant;

const RUNS: u32 = 4096;

const STUDY: &str = "
model: child-seat
design: latin hypercube
seed: 1
parameters:
  lap_slack:      { from: 0 mm, to: 60 mm }
  shoulder_slack: { from: 0 mm, to: 60 mm }
  friction:       { from: 0.1, to: 0.5 }
  pulse_scale:    { from: 0.8, to: 1.2 }
  webbing_scale:  { from: 0.7, to: 1.3 }
  cushion_scale:  { from: 0.7, to: 1.3 }
run: { duration: 120 ms, accuracy: 0.1 %, sampling: 0.1 ms }
responses:
  - { name: peak lap force, of: lap belt force, what: peak }
  - { of: head accelerometer, what: HIC15 }
  - { of: chest accelerometer, what: clip, duration: 3 ms }
  - { of: head excursion, what: excursion }
";

pub fn table() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!("## Runs of child-seat\n");
    println!("{RUNS} runs of 120 ms to 0.1 %, six parameters, four responses; runs in a second.\n");
    println!("| registers | one thread | {threads} threads |");
    println!("|---|---|---|");
    for width in Width::ALL.into_iter().filter(|width| width.is_available()) {
        let [one, all] = [1, threads].map(|threads| rate(width, threads));
        println!("| {} | {one:.0} | {all:.0} |", width.name());
    }
}

/// Runs per second of a whole study.
fn rate(width: Width, threads: usize) -> f64 {
    let must = "the study is in order";
    let model = bundled::find("child-seat").expect(must);
    let text = format!("{STUDY}runs: {RUNS}\n");
    let file = StudyFile::parse("study.yaml", &text).expect(must);
    let scene = bundled::scene(model).expect(must);
    let (read, facts) = (&scene.model, ModelFacts::of(&scene));
    let study = file.resolve(&facts, Path::new("")).expect(must);
    let job = sweep::job(&study, read, &facts, width).expect(must);
    let folder = tempfile::tempdir().expect("a folder for results");
    let program = Program {
        model: read.digest.clone(),
        version: "benchmark".to_owned(),
        arithmetic: width.name().to_owned(),
    };
    let results = Folder::open(folder.path(), &study, &program).expect(must);
    let equations = bryant::equations::of(read).expect(must);
    let engine = Lanes::new(&equations, job, study.run.precision, &[]);
    let begin = Instant::now();
    let report = run(&study, &engine, &results, Shard::WHOLE, threads, &|_| ());
    let seconds = begin.elapsed().as_secs_f64();
    report.expect("rows are run").rows as f64 / seconds
}
