//! A study of a formula, from its file to its pictures: an example of a program that uses this crate.
//!
//! ```text
//! cargo run --release -p bryant-study --example ishigami -- study/examples/ishigami.yaml FOLDER [SHARD] [THREADS]
//! ```

use bryant_picture::Format;
use bryant_study::engine::{Engine, EngineError, Outcome, Outcomes, Series, Status, Worker};
use bryant_study::facts::{ModelFacts, OutputFact, ParameterFact};
use bryant_study::file::StudyFile;
use bryant_study::report::report;
use bryant_study::results::Results;
use bryant_study::run::run;
use bryant_study::shard::Shard;
use bryant_study::store::Folder;
use bryant_study::store::identity::Program;
use bryant_study::table::merge;
use std::path::Path;

/// sin a + 7 sin² b + c⁴ sin a / 10
struct Ishigami;

impl Engine for Ishigami {
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError> {
        Ok(Box::new(Ishigami))
    }
}

impl Worker for Ishigami {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        for row in rows.chunks(3) {
            let end = Outcome {
                status: Status::Done,
                reached: 0.0,
                steps: 1,
                error: 0.0,
            };
            outcomes.push(end, &[value(row)]);
        }
        Ok(())
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        Ok(Series {
            times: vec![0.0],
            outputs: vec![vec![value(row)]],
        })
    }
}

fn value(x: &[f64]) -> f64 {
    x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, path, rest @ ..] = &arguments[..] else {
        return Err("usage: ishigami STUDY.yaml FOLDER [SHARD] [THREADS]".into());
    };
    let shard = rest.first().map_or(Ok(Shard::WHOLE), |text| text.parse())?;
    let threads = rest.get(1).map_or(Ok(2), |text| text.parse())?;
    let unit = String::new;
    let parameter = |name: &str| ParameterFact {
        name: name.into(),
        unit: unit(),
        default: 0.0,
        min: None,
        max: None,
    };
    let facts = ModelFacts {
        parameters: ["a", "b", "c"].map(parameter).to_vec(),
        outputs: vec![OutputFact {
            name: "f".into(),
            unit: unit(),
            ..OutputFact::default()
        }],
        ..ModelFacts::default()
    };
    let directory = Path::new(file).parent().unwrap_or(Path::new("."));
    let study =
        StudyFile::parse(file, &std::fs::read_to_string(file)?)?.resolve(&facts, directory)?;
    let program = Program {
        model: "ishigami".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        arithmetic: "f64".into(),
    };
    let folder = Folder::open(Path::new(path), &study, &program)?;
    run(&study, &Ishigami, &folder, shard, threads, &|_| {})?;
    if shard == Shard::WHOLE {
        let results = Results::new(&study, &folder, None)?;
        merge(&results)?;
        report(&results, Format::Svg)?;
        print!(
            "{}",
            std::fs::read_to_string(folder.path().join("summary.txt"))?
        );
    }
    Ok(())
}
