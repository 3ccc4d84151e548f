//! `bryant gradient`: exact derivatives of responses with respect to parameters.

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod slopes;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod table;

use super::Error;
use super::model_argument::{find, nearest};
use super::parameters::{parse_parameters, values_of};
use super::prepare::prepare;
use super::progress::{Progress, Whole};
use super::response::{self, Requested};
use super::run::{TIME_LIMIT, time_limit};
use super::terminal::Terminal;
use crate::accuracy::check::FAR;
use crate::accuracy::comparison::PROMISED;
use crate::accuracy::conclusion::percent;
use crate::interrupt;
use crate::units;
use bryant_generator::model::units::{Unit, UnitSystem};
use bryant_generator::model::{Model, Parameter};
use bryant_runtime::batch::rows::Job;
use bryant_runtime::batch::{Pace, Settings};
use bryant_runtime::simulate::ENERGY_LIMIT;
use bryant_runtime::{Tolerances, Width};
use bryant_study::facts::ModelFacts;
use bryant_study::quantity;
use slopes::{Accurate, Problem, TOLERANCE, by_size};
use std::cell::Cell;
use std::time::Duration;
use table::{AGREE, Table};

/// Differentiate responses of a run with respect to parameters: by dual numbers through the whole simulation, events
/// included.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
A response is WHAT of OUTPUT, as in a study: peak, minimum, magnitude, time of peak, time of minimum, range, mean, final, HIC15, HIC36,
excursion, integral, value at TIME, clip TIME, contiguous clip TIME. Underscores stand for spaces, and some words of an
output's name suffice.

The derivatives are those of the computed run, with its steps held. They are as exact as the run. If a switch fires or a belt locks,
the time of this event depends on the parameters, and the derivative includes this (saltation). If an output such as an acceleration
jumps at the event, responses use its values on both sides of the jump, at the exact time. A study knows the time of a jump only to
within the interval of its samples.

Windows of HIC begin and end on samples and jumps. This hardly changes its value, but it changes its derivative: by 0.4 % in child-seat at a sample
every 0.1 ms, by 0.02 to 0.1 % with `--sampling '10 us'`.

The command compares the derivatives with those of a run at ten times the tolerance. If they are not as accurate as 0.1 %, it repeats the
run at smaller tolerances. If their error stays above 1 %, or above 10 % at a --tolerance of your own, it ends with exit code 3.
So it does if --check finds more than that.

After Ctrl-C it finishes the derivatives under way, prints the table of those that are done, and ends with exit code 130.

Examples:
  bryant gradient child-seat --of peak_lap_force --wrt webbing_scale,lap_slack
  bryant gradient child-seat --of 'HIC15 of head accelerometer' --of 'clip 3 ms of chest accelerometer' --check
  bryant gradient my.yaml --of 'value at 80 ms of head excursion' --set belt_stiffness='40 kN'")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// Response to differentiate; may be repeated
    #[arg(
        long,
        value_name = "RESPONSE",
        required = true,
        allow_hyphen_values = true
    )]
    of: Vec<String>,

    /// Parameters to differentiate with respect to, by name [default: all of the model]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    wrt: Vec<String>,

    /// Value of a parameter of the model, with its unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// Length of the run, a time [default: as the model says]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    duration: Option<f64>,

    /// Time between the samples that responses are read off [default: a twentieth of the time between the rows of the
    /// model]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    sampling: Option<f64>,

    /// Relative tolerance of every step [default: 1e-8, and smaller where that is not enough]
    #[arg(long, value_name = "NUMBER", value_parser = quantity::tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,

    /// Give up when the computation of a run takes longer than this, or would take ten times as long at its present
    /// rate; a time, or off [default: 5 min]
    #[arg(long, value_name = "TIME", value_parser = time_limit, allow_hyphen_values = true)]
    time_limit: Option<f64>,

    /// Compare with central differences of sharper runs
    #[arg(long)]
    check: bool,

    /// Print everything as JSON
    #[arg(long)]
    json: bool,

    /// Units of responses and parameters: SI, or engineering (mm, g, kN, °, kPa, ms) [default: as the model says]
    #[arg(long, value_name = "SYSTEM", value_parser = units::system())]
    units: Option<UnitSystem>,
}

/// Largest number of steps of a run.
const MOST_STEPS: u32 = 10_000_000;
impl Arguments {
    /// Differentiates and prints.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let mut found = find(&self.model)?;
        found.show_in(self.units);
        found.tell(terminal);
        let model = &found.model;
        let set = parse_parameters(&self.set, &found.scene)?;
        let point = values_of(model, &set);
        let wrt = self.parameters(model)?;
        let facts = ModelFacts::of(&found.scene);
        let duration = self.duration.unwrap_or(facts.run.duration);
        let responses: Vec<Requested> = self
            .of
            .iter()
            .map(|text| Requested::read("--of", text, &facts, [0.0, duration]))
            .collect::<Result<_, _>>()?;
        for caution in responses.iter().filter_map(|one| one.caution.as_ref()) {
            terminal.note(&format!("warning: {caution}"));
        }
        let varied: Vec<usize> = wrt.iter().map(|(index, _)| *index).collect();
        let job = self.job(&facts, duration, &responses, &point, varied)?;
        let engine = prepare(&found, terminal)?;

        let row: Vec<f64> = wrt.iter().map(|(index, _)| point[*index]).collect();
        let parameters: Vec<&Parameter> = wrt.iter().map(|(_, p)| *p).collect();
        let problem = Problem {
            engine: &engine,
            job: &job,
            parameters: &parameters,
            row: &row,
            stiff: Cell::new(false),
        };
        let what = format!("differentiating {}", model.name);
        let whole = Whole::Count(row.len() as u64, "parameters");
        let progress = Progress::new(terminal, what, whole);
        interrupt::watch();
        let result = problem
            .accurately(self.tolerance, &progress)
            .and_then(|found| {
                let compare = || {
                    progress.next("comparing with differences".into(), whole);
                    problem.differences(&progress)
                };
                Ok((found, self.check.then(compare).transpose()?))
            });
        drop(progress);
        engine.check()?;
        let (found, checked) = result?;
        let gradients = &found.gradients;
        let done = gradients.rows.len();
        let system = model.units.system;
        let units = parameters.iter().map(|one| system.unit(&one.unit));
        let units: Vec<Unit> = units.collect();
        let table = Table {
            units: &units,
            error: found.error,
            responses: &responses,
            parameters: &parameters[..done],
            row: &row[..done],
            values: &gradients.values,
            slopes: &by_size(&gradients.slopes, &problem.sizes(), responses.len()),
            checked: checked.as_deref(),
        };
        match self.json {
            true => terminal.print_json(&table.json())?,
            false if done > 0 => terminal.print(&table.text())?,
            false => {}
        }
        let compared = checked
            .as_ref()
            .map_or(done, |checked| checked.len() / responses.len());
        match missing(&parameters, done, compared) {
            Some(missing) => Err(Error::Interrupted(missing)),
            None => {
                if problem.stiff.get() {
                    terminal.note(
                        "the scene is stiff: the derivatives are differences of runs, not dual numbers through a run",
                    );
                }
                self.conclude(&found, terminal)?;
                match table.worst() {
                    Some(worst) if worst.is_nan() || worst > self.limit() => Err(disagree(worst)),
                    _ => Ok(()),
                }
            }
        }
    }

    /// The run as a request to the runtime. `point` has the values of all parameters, of which some are `varied`.
    fn job(
        &self,
        facts: &ModelFacts,
        duration: f64,
        responses: &[Requested],
        point: &[f64],
        varied: Vec<usize>,
    ) -> Result<Job, Error> {
        let usual = response::sampling(facts.run.sampling, responses);
        let every = self.sampling.unwrap_or(usual);
        // each lane has a value and its derivative
        let bytes = 2 * size_of::<f64>() * Width::widest().lanes();
        let samples = response::intervals(every, duration, responses, bytes)? + 1;
        Ok(Job {
            settings: Settings {
                duration,
                samples,
                pace: Pace::Adaptive(Tolerances::of(self.tolerance.unwrap_or(TOLERANCE))),
                locate: true,
                max_steps: MOST_STEPS,
                time_limit: Duration::try_from_secs_f64(self.time_limit.unwrap_or(TIME_LIMIT)).ok(),
                energy_limit: ENERGY_LIMIT,
            },
            fixed: (0..point.len())
                .filter(|index| !varied.contains(index))
                .map(|index| (index, point[index]))
                .collect(),
            varied,
            responses: responses.iter().map(|response| response.asked).collect(),
            estimate: false,
            wanted: f64::INFINITY,
            width: Width::widest(),
        })
    }

    /// Prints how accurate the derivatives are; an error if they are not accurate enough.
    fn conclude(&self, found: &Accurate, terminal: &mut Terminal) -> Result<(), Error> {
        let tolerance = found.tolerance;
        if tolerance < self.tolerance.unwrap_or(TOLERANCE) {
            terminal.note(&format!("sharpened to tolerance {tolerance:e}"));
        }
        let Some(error) = found.error else {
            return Ok(());
        };
        if error.is_nan() || error > PROMISED {
            let error = match error.is_nan() {
                true => "not known".into(),
                false => percent(error),
            };
            terminal.note(&format!("estimated error: {error}"));
        }
        let limit = self.limit();
        let help = match self.tolerance {
            Some(_) => "give a smaller --tolerance, or none",
            None => "`bryant run` with the same parameters says how accurate the run is",
        };
        match error <= limit {
            true => Ok(()),
            false => Err(Error::failed(format!(
                "the derivatives are not as accurate as {}: a run at ten times the tolerance has other derivatives\n  help: {help}",
                percent(limit)
            ))),
        }
    }

    /// Derivatives that are wrong by more cannot be trusted.
    fn limit(&self) -> f64 {
        match self.tolerance {
            Some(_) => FAR,
            None => AGREE,
        }
    }

    /// The requested parameters, with their indices.
    fn parameters<'m>(&self, model: &'m Model) -> Result<Vec<(usize, &'m Parameter)>, Error> {
        let names: Vec<&str> = model.parameters.iter().map(|p| p.name.as_str()).collect();
        if names.is_empty() {
            return Err(Error::Input(format!(
                "\"{}\" has no parameters to differentiate with respect to\n  help: give numbers names under `parameters:`",
                model.name
            )));
        }
        if self.wrt.is_empty() {
            return Ok(model.parameters.iter().enumerate().collect());
        }
        let mut wrt: Vec<(usize, &Parameter)> = Vec::new();
        for name in self.wrt.iter().map(|name| name.trim()) {
            let Some(index) = names.iter().position(|known| *known == name) else {
                let help = match nearest(name, &names) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => format!("there are: {}", names.join(", ")),
                };
                return Err(Error::Input(format!(
                    "--wrt: \"{}\" has no parameter \"{}\"\n  help: {help}",
                    model.name,
                    name.escape_debug()
                )));
            };
            if wrt.iter().all(|(known, _)| *known != index) {
                wrt.push((index, &model.parameters[index]));
            }
        }
        Ok(wrt)
    }
}

/// The derivatives and the differences are too far apart.
fn disagree(worst: f64) -> Error {
    Error::failed(format!(
        "derivatives and differences disagree by {} of the largest\n  help: a response that has a kink or a jump near these values has no derivative \
         there; `bryant sweep` over a few values of the parameter shows it",
        percent(worst)
    ))
}

/// The sentence that says what an interruption left out: how many derivatives are done, and how many are compared.
fn missing(parameters: &[&Parameter], done: usize, compared: usize) -> Option<String> {
    let names = |from: usize| {
        let names: Vec<&str> = parameters[from..].iter().map(|p| p.name.as_str()).collect();
        names.join(", ")
    };
    match (done < parameters.len(), compared < done) {
        (true, _) => Some(format!("derivatives by {} are missing", names(done))),
        (false, true) => Some(format!(
            "derivatives by {} are not compared with differences",
            names(compared)
        )),
        (false, false) => None,
    }
}
