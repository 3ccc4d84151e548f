//! Engines that evaluate formulas, and studies of them.

pub mod parquet;

use bryant_study::engine::{Engine, EngineError, Outcome, Outcomes, Series, Status, Worker};
use bryant_study::facts::{ModelFacts, OutputFact, ParameterFact};
use bryant_study::file::StudyFile;
use bryant_study::store::Folder;
use bryant_study::store::identity::Program;
use bryant_study::study::Study;
use std::path::Path;

/// A closed form: the responses of a row.
pub type Formula = fn(&[f64]) -> Vec<f64>;

/// Evaluates a formula. Rows whose result is not finite are `NonFinite`.
pub struct Closed(pub Formula);

impl Engine for Closed {
    fn worker(&self) -> Result<Box<dyn Worker + '_>, EngineError> {
        Ok(Box::new(ClosedWorker(self.0)))
    }
}

/// The reason of rows without a result.
pub const NO_WAY: &str = "there is no way, \"none\"";

struct ClosedWorker(Formula);

impl Worker for ClosedWorker {
    fn run(&mut self, rows: &[f64], outcomes: &mut Outcomes) -> Result<(), EngineError> {
        for row in rows.chunks(PARAMETERS) {
            let responses = self.0(row);
            let finite = responses.iter().all(|r| r.is_finite());
            let status = if finite {
                Status::Done
            } else {
                Status::NonFinite
            };
            let steps = (1000.0 * row[0].abs()) as u32;
            outcomes.push_because(
                Outcome {
                    status,
                    reached: 0.1,
                    steps,
                    error: f64::NAN,
                },
                &responses,
                (!finite).then(|| NO_WAY.into()),
            );
        }
        Ok(())
    }

    fn series(&mut self, row: &[f64]) -> Result<Series, EngineError> {
        let times = vec![0.0, 0.1];
        let outputs = self.0(row).iter().map(|x| vec![0.0, *x]).collect();
        Ok(Series { times, outputs })
    }
}

/// Number of parameters of every model here: a, b, c.
pub const PARAMETERS: usize = 3;

/// The facts: a, b, c are pure numbers, and there are two outputs.
pub fn facts() -> ModelFacts {
    let parameter = |name: &str| ParameterFact {
        name: name.into(),
        unit: String::new(),
        default: 0.0,
        min: None,
        max: None,
    };
    let output = |name: &str, unit: &str| OutputFact {
        name: name.into(),
        unit: unit.into(),
        ..OutputFact::default()
    };
    ModelFacts {
        parameters: ["a", "b", "c"].map(parameter).to_vec(),
        outputs: vec![output("force", "N"), output("way", "m")],
        ..ModelFacts::default()
    }
}

/// A study of a, b, c from −π to π, with the final values of both outputs.
pub fn study(head: &str) -> Study {
    let range = "{ from: -pi, to: pi }";
    with(head, &format!("{{ a: {range}, b: {range}, c: {range} }}"))
}

/// A study with these `parameters`, and with the final values of both outputs.
pub fn with(head: &str, parameters: &str) -> Study {
    let text = format!(
        "model: closed\n{head}\nparameters: {parameters}\nresponses:\n  - {{ of: force, what: final }}\n  - {{ of: way, what: \
         final }}\n"
    );
    let file = StudyFile::parse("study.yaml", &text).unwrap();
    file.resolve(&facts(), Path::new(".")).unwrap()
}

/// The program that the results are attributed to.
pub fn program() -> Program {
    Program {
        model: "closed form".into(),
        version: "1".into(),
        arithmetic: "f64".into(),
    }
}

/// The study's folder.
pub fn open(path: &Path, study: &Study) -> Folder {
    Folder::open(path, study, &program()).unwrap()
}

/// Ishigami's function, and a sum that is NaN for a > 3.
pub fn ishigami(x: &[f64]) -> Vec<f64> {
    let [a, b, c] = [x[0], x[1], x[2]];
    let value = a.sin() + 7.0 * b.sin().powi(2) + 0.1 * c.powi(4) * a.sin();
    vec![value, if a > 3.0 { f64::NAN } else { a + b + c }]
}
