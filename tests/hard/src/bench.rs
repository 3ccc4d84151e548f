//! What a case works with: it runs scenes, and notes what it finds.

use crate::case::{Bound, Check, Found};
use crate::scene::Scene;
use bryant_generator::expression::Function;
use bryant_generator::expression::evaluate::Functions;
use bryant_generator::model::Model;
use bryant_runtime::Report;
use bryant_runtime::program::{Energy, Finding, Header, Job, RunError};

/// Runs scenes as a user's models are run.
pub trait Engine: Sync {
    /// Generates and compiles the scene, unless that was done before, and does a job with it, in whatever arithmetic it asks for.
    ///
    /// # Errors
    /// The scene is no model, or does not compile. A run that fails is no error.
    fn run(&self, scene: &Scene, job: &Job) -> Result<Run, Trouble>;

    /// The value of a function of a model that is not algebra, at as many numbers as it has arguments; NaN of a user's function,
    /// which only compiled code can call.
    fn call(&self, model: &Model, function: Function, arguments: &[f64]) -> f64;
}

/// The functions of a model, for who evaluates its equations.
pub fn functions<'a>(engine: &'a dyn Engine, model: &'a Model) -> impl Functions<f64> + 'a {
    |function: Function, arguments: &[f64]| engine.call(model, function, arguments)
}

/// What came out of a run, also of one that failed on the way.
#[derive(Clone, Debug)]
pub struct Run {
    /// Names and units.
    pub header: Header,
    /// Time of every sample \[s\].
    pub times: Vec<f64>,
    /// State of every sample: q, v, z, m.
    pub states: Vec<Vec<f64>>,
    /// Outputs of every sample, SI.
    pub outputs: Vec<Vec<f64>>,
    /// What it took, or what stopped it.
    pub result: Result<Report, RunError>,
    /// Where the energy went, if anything ran.
    pub energy: Option<Energy>,
    /// Why it cannot be trusted.
    pub doubts: Vec<Finding>,
}

/// A case that could not be measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// The scene is no model.
    Refused(String),
    /// A run failed that must not.
    Failed(String),
    /// Something around it: the compiler, a file.
    System(String),
    /// The case asks for what its scene does not have: a fault of the case.
    Case(String),
    /// It panicked, with this message.
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
    /// What it took.
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
    /// There is none of this name.
    pub fn output(&self, name: &str) -> Result<Vec<f64>, Trouble> {
        let names = self.header.outputs.iter().map(|output| &output.name);
        column(names, &self.outputs, name)
    }

    /// An entry of the state at all samples.
    ///
    /// # Errors
    /// There is none of this name.
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

    /// Where the energy went.
    ///
    /// # Errors
    /// Nothing ran.
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

/// Where a case runs its scenes and notes its checks.
pub struct Bench<'a> {
    engine: &'a dyn Engine,
    full: bool,
    variant: String,
    checks: Vec<Check>,
}

impl<'a> Bench<'a> {
    /// For one case; `full` for the harder variants that take long.
    pub fn new(engine: &'a dyn Engine, full: bool) -> Bench<'a> {
        Bench {
            engine,
            full,
            variant: String::new(),
            checks: Vec::new(),
        }
    }

    /// What runs its scenes.
    pub fn engine(&self) -> &'a dyn Engine {
        self.engine
    }

    /// Whether the grid is the full one.
    pub fn full(&self) -> bool {
        self.full
    }

    /// What was noted.
    pub fn into_checks(self) -> Vec<Check> {
        self.checks
    }

    /// Names the member of the family that the checks from now on are of.
    pub fn variant(&mut self, name: impl Into<String>) {
        self.variant = name.into();
    }

    /// Does a job, whatever comes out.
    ///
    /// # Errors
    /// The scene is no model, or does not compile.
    pub fn run(&self, scene: &Scene, job: &Job) -> Result<Run, Trouble> {
        self.engine.run(scene, job)
    }

    /// Does a job that must succeed.
    ///
    /// # Errors
    /// As [`Bench::run`], and a run that fails.
    pub fn succeed(&self, scene: &Scene, job: &Job) -> Result<Run, Trouble> {
        let run = self.engine.run(scene, job)?;
        run.report()?;
        Ok(run)
    }

    /// Notes a number that must be no more than a bound.
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

    /// Notes a number that must be no less than a bound.
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

    /// Notes whether a statement holds, and what was seen.
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
