//! The workbench of a case, which runs scenes and records checks.

use crate::case::{Bound, Check, Found};
use crate::case_model::CaseModel;
use bryant_generator::expression::Function;
use bryant_generator::model::Model;
use bryant_runtime::Report;
use bryant_runtime::program::{Energy, Finding, Header, Job, RunError};

/// Runs scenes in the same way as a user's models.
pub trait Engine: Sync {
    /// Runs a job with a scene, in the arithmetic that the job requests. The scene is generated and compiled first,
    /// unless that was done before.
    ///
    /// # Errors
    /// The scene is not a valid model, or does not compile. A failed run is not an error.
    fn run(&self, scene: &CaseModel, job: &Job) -> Result<Run, Trouble>;

    /// The functions that the equations of a model call, such as its curves; NaN for a user function, which only
    /// compiled code can call.
    fn functions(&self, model: &Model) -> Box<Call>;
}

/// The value of a function at its arguments.
pub type Call = dyn Fn(Function, &[f64]) -> f64;

/// The result of a run, complete or failed.
#[derive(Clone, Debug)]
pub struct Run {
    /// Names and units.
    pub header: Header,
    /// Time of every sample \[s\].
    pub times: Vec<f64>,
    /// For each sample the state: q, v, z, m.
    pub states: Vec<Vec<f64>>,
    /// For each sample the outputs, SI.
    pub outputs: Vec<Vec<f64>>,
    /// The cost of the run, or its failure.
    pub result: Result<Report, RunError>,
    /// The balance of energy; `None` if the run did not start.
    pub energy: Option<Energy>,
    /// The reasons why the run cannot be trusted.
    pub doubts: Vec<Finding>,
}

/// Why a case could not be measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// The scene is not a valid model.
    Refused(String),
    /// A run failed that must succeed.
    Failed(String),
    /// An error of the system: the compiler, a file.
    System(String),
    /// The case refers to a part that its scene lacks: an error in the case.
    Case(String),
    /// The case panicked, with this message.
    Panicked(String),
}

impl std::fmt::Display for Trouble {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Trouble::Refused(text) => write!(f, "the scene was refused: {text}"),
            Trouble::Failed(text) => write!(f, "the run failed: {text}"),
            Trouble::System(text) | Trouble::Case(text) => write!(f, "{text}"),
            Trouble::Panicked(text) => write!(f, "the case panicked: {text}"),
        }
    }
}

impl std::error::Error for Trouble {}

impl Run {
    /// The cost of the run.
    ///
    /// # Errors
    /// The run failed.
    pub fn report(&self) -> Result<&Report, Trouble> {
        self.result
            .as_ref()
            .map_err(|error| Trouble::Failed(error.message.clone()))
    }

    /// An output at all samples.
    ///
    /// # Errors
    /// There is no output of this name.
    pub fn output(&self, name: &str) -> Result<Vec<f64>, Trouble> {
        let names = self.header.outputs.iter().map(|output| &output.name);
        column(names, &self.outputs, name)
    }

    /// An entry of the state at all samples.
    ///
    /// # Errors
    /// There is no entry of this name.
    pub fn state(&self, name: &str) -> Result<Vec<f64>, Trouble> {
        let header = &self.header;
        let names = (header.coordinates.iter())
            .chain(&header.velocities)
            .chain(&header.auxiliaries)
            .chain(&header.memory);
        column(names, &self.states, name)
    }

    /// The state at the end.
    ///
    /// # Errors
    /// There was no sample.
    pub fn last(&self) -> Result<&[f64], Trouble> {
        let last = self.states.last().map(Vec::as_slice);
        last.ok_or_else(|| Trouble::Case("the run has no sample".into()))
    }

    /// The balance of energy.
    ///
    /// # Errors
    /// The run did not start.
    pub fn energy(&self) -> Result<&Energy, Trouble> {
        let energy = self.energy.as_ref();
        energy.ok_or_else(|| Trouble::Case("the run has no balance of energy".into()))
    }
}

fn column<'a>(
    mut names: impl Iterator<Item = &'a String>,
    rows: &[Vec<f64>],
    name: &str,
) -> Result<Vec<f64>, Trouble> {
    let index = names
        .position(|known| known == name)
        .ok_or_else(|| Trouble::Case(format!("nothing is called {name:?}")))?;
    Ok(rows.iter().map(|row| row[index]).collect())
}

/// Runs the scenes of a case and records its checks.
pub struct Bench<'a> {
    engine: &'a dyn Engine,
    full: bool,
    variant: String,
    checks: Vec<Check>,
}

impl<'a> Bench<'a> {
    /// A bench for one case; if `full`, the case includes harder variants that take long.
    pub fn new(engine: &'a dyn Engine, full: bool) -> Bench<'a> {
        Bench {
            engine,
            full,
            variant: String::new(),
            checks: Vec::new(),
        }
    }

    /// The engine that runs the scenes.
    pub fn engine(&self) -> &'a dyn Engine {
        self.engine
    }

    /// True if harder variants are included.
    pub fn full(&self) -> bool {
        self.full
    }

    /// The recorded checks.
    pub fn into_checks(self) -> Vec<Check> {
        self.checks
    }

    /// Names the variant that the following checks belong to.
    pub fn variant(&mut self, name: impl Into<String>) {
        self.variant = name.into();
    }

    /// Runs a job; the run may fail.
    ///
    /// # Errors
    /// The scene is not a valid model, or does not compile.
    pub fn run(&self, scene: &CaseModel, job: &Job) -> Result<Run, Trouble> {
        self.engine.run(scene, job)
    }

    /// Runs a job that must succeed.
    ///
    /// # Errors
    /// Those of [`Bench::run`], or the run failed.
    pub fn succeed(&self, scene: &CaseModel, job: &Job) -> Result<Run, Trouble> {
        let run = self.engine.run(scene, job)?;
        run.report()?;
        Ok(run)
    }

    /// Records a number that must be at most a bound.
    pub fn at_most(
        &mut self,
        criterion: impl Into<String>,
        measured: f64,
        bound: f64,
        unit: &'static str,
        because: impl Into<String>,
    ) {
        let found = Found::Number {
            measured,
            bound: Bound::AtMost(bound),
            unit,
        };
        self.note(criterion.into(), because.into(), found);
    }

    /// Records a number that must be at least a bound.
    pub fn at_least(
        &mut self,
        criterion: impl Into<String>,
        measured: f64,
        bound: f64,
        unit: &'static str,
        because: impl Into<String>,
    ) {
        let found = Found::Number {
            measured,
            bound: Bound::AtLeast(bound),
            unit,
        };
        self.note(criterion.into(), because.into(), found);
    }

    /// Records a statement that must hold, with what was observed.
    pub fn states(
        &mut self,
        criterion: impl Into<String>,
        holds: bool,
        seen: impl Into<String>,
        because: impl Into<String>,
    ) {
        let seen = seen.into();
        let found = Found::Statement { holds, seen };
        self.note(criterion.into(), because.into(), found);
    }

    fn note(&mut self, criterion: String, because: String, found: Found) {
        self.checks.push(Check {
            variant: self.variant.clone(),
            criterion,
            because,
            found,
        });
    }
}
