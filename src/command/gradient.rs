//! `bryant gradient`: exact derivatives of responses with respect to parameters.

use super::Error;
use super::model_argument::{find, nearest};
use super::parameters::{parse_parameters, values_of};
use super::prepare::prepare;
use super::progress::{Progress, Whole};
use super::response::{self, Response};
use super::run::{TIME_LIMIT, time_limit};
use super::terminal::Terminal;
use crate::accuracy::check::{FAR, PROMISED};
use crate::accuracy::finding::percent;
use crate::equations::Engine;
use crate::interrupt;
use crate::sweep;
use bryant_generator::model::{Model, Parameter};
use bryant_runtime::batch::rows::{Gradients, Job};
use bryant_runtime::batch::{Pace, Settings, Status};
use bryant_runtime::program::{ErrorKind, RunError};
use bryant_runtime::simulate::ENERGY_LIMIT;
use bryant_runtime::{Tolerances, Width};
use bryant_study::facts::ModelFacts;
use bryant_study::quantity;
use serde_json::json;
use std::time::{Duration, Instant};

/// Differentiate responses of a run with respect to parameters: by dual numbers through the whole simulation, events included.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
A response is WHAT of OUTPUT, as in a study: peak, minimum, magnitude, time of peak, time of minimum, range, mean, final, HIC15, HIC36,
excursion, integral, value at TIME, clip TIME, contiguous clip TIME. Underscores stand for spaces, and some words of an
output's name suffice.

Derivatives are those of the computed run, with its steps held: exact to the accuracy of the run. Where a switch fires or a belt
locks, its time depends on the parameters, and the derivative jumps as it should (saltation). Where an output itself jumps there, an
acceleration for one, responses are those of both sides of the jump, at its time: samples of a study know a jump to within their interval.

Windows of HIC begin and end on samples and jumps. This hardly changes its value, but it changes its derivative: by 0.4 % in child-seat at a sample
every 0.1 ms, by 0.02 to 0.1 % with `--sampling '10 us'`.

Derivatives are compared with those of a run at ten times the tolerance. Where they are not as accurate as 0.1 %, sharper runs follow; what stays
beyond 1 %, or beyond 10 % at a --tolerance of your own, ends with exit code 3.

Ctrl-C ends it with the table of the derivatives that are there, after those under way, and exit code 130.

Examples:
  bryant gradient child-seat --of peak_lap_force --wrt webbing_scale,lap_slack
  bryant gradient child-seat --of 'HIC15 of head accelerometer' --of 'clip 3 ms of chest accelerometer' --check
  bryant gradient my.yaml --of 'value at 80 ms of head excursion' --set belt_stiffness='40 kN'")]
pub struct Arguments {
    /// Bundled model or YAML file
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

    /// Time between the samples that responses are read off [default: a twentieth of the time between the rows of the model]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    sampling: Option<f64>,

    /// Relative tolerance of every step [default: 1e-8, and smaller where that is not enough]
    #[arg(long, value_name = "NUMBER", value_parser = quantity::tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,

    /// Give up when the computation of a run takes longer than this, or would take ten times as long at its present rate; a time, or off [default: 5 min]
    #[arg(long, value_name = "TIME", value_parser = time_limit, allow_hyphen_values = true)]
    time_limit: Option<f64>,

    /// Compare with central differences of sharper runs
    #[arg(long)]
    check: bool,

    /// Print everything as JSON
    #[arg(long)]
    json: bool,
}

/// Tolerance if the user gives none.
const TOLERANCE: f64 = 1e-8;
/// Tolerance of the runs for difference quotients, and the share of its size by which a parameter is changed to either side. The error of a
/// difference quotient has two parts: the square of the second, and the first divided by the second.
const SHARP: f64 = 1e-12;
const MOVED: f64 = 1e-4;
/// Largest number of steps of a run.
const MOST_STEPS: u32 = 10_000_000;
/// Differences disagree if they are off by more than this share of the largest derivative.
const AGREE: f64 = 1e-2;
/// Slopes that are smaller than this share of their response are measured by the response.
const SMALL: f64 = 1e-2;
/// Differences cannot tell from 0 what is less than this share of a response.
const NOISE: f64 = SHARP / MOVED / AGREE;

impl Arguments {
    /// Differentiates and prints.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        found.tell(terminal);
        let model = &found.model;
        let set = parse_parameters(&self.set, &found.scene)?;
        let point = values_of(model, &set);
        let wrt = self.parameters(model)?;
        let facts = ModelFacts::of(&found.scene);
        let duration = self.duration.unwrap_or(facts.run.duration);
        let responses: Vec<Response> = self
            .of
            .iter()
            .map(|text| Response::read("--of", text, &facts, [0.0, duration]))
            .collect::<Result<_, _>>()?;
        let usual = response::sampling(facts.run.sampling, &responses);
        let every = self.sampling.unwrap_or(usual);
        // each lane has a value and its derivative
        let bytes = 2 * size_of::<f64>() * Width::widest().lanes();
        let samples = response::intervals(every, duration, &responses, bytes)? + 1;
        let varied: Vec<usize> = wrt.iter().map(|(index, _)| *index).collect();
        let job = Job {
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
        };
        let engine = prepare(&found, terminal)?;

        let row: Vec<f64> = wrt.iter().map(|(index, _)| point[*index]).collect();
        let sizes: Vec<f64> = wrt
            .iter()
            .zip(&row)
            .map(|((_, p), x)| size(p, *x))
            .collect();
        let bounds: Vec<_> = wrt.iter().map(|(_, p)| [p.min, p.max]).collect();
        let directions = each_alone(&sizes);
        let what = format!("differentiating {}", model.name);
        let whole = Whole::Count(row.len() as u64, "parameters");
        let progress = Progress::new(terminal, what, whole);
        interrupt::watch();
        let asked = Asked {
            engine: &engine,
            job: &job,
            row: &row,
            directions: &directions,
        };
        let result = asked
            .accurately(self.tolerance, &progress)
            .and_then(|found| {
                let compare = || {
                    progress.next("comparing with differences".into(), whole);
                    differences(&engine, &job, &row, &sizes, &bounds, &progress)
                };
                Ok((found, self.check.then(compare).transpose()?))
            });
        drop(progress);
        engine.check()?;
        let (
            Accurate {
                gradients,
                error,
                tolerance,
            },
            checked,
        ) = result?;
        let slopes = by_size(&gradients.slopes, &sizes, responses.len());
        let done = gradients.rows.len();
        let parameters: Vec<&Parameter> = wrt[..done].iter().map(|(_, p)| *p).collect();
        let table = Table {
            responses: &responses,
            parameters: &parameters,
            row: &row[..done],
            values: &gradients.values,
            slopes: &slopes,
            checked: checked.as_deref(),
        };
        match self.json {
            true => terminal.print_json(&table.json())?,
            false if done > 0 => terminal.print(&table.text())?,
            false => {}
        }
        let compared = checked.map_or(done, |checked| checked.len() / responses.len());
        if let Some(missing) = missing(&wrt, done, compared) {
            return Err(Error::Interrupted(missing));
        }
        let (limit, help) = match self.tolerance {
            Some(_) => (FAR, "give a smaller --tolerance, or none"),
            None => (
                AGREE,
                "`bryant run` with the same parameters says how accurate the run is",
            ),
        };
        if tolerance < self.tolerance.unwrap_or(TOLERANCE) {
            terminal.note(&format!("sharpened to tolerance {tolerance:e}"));
        }
        let Some(error) = error else {
            return Ok(());
        };
        if error.is_nan() || error > PROMISED {
            let error = match error.is_nan() {
                true => "not known".into(),
                false => percent(error),
            };
            terminal.note(&format!("estimated error: {error}"));
        }
        match error <= limit {
            true => Ok(()),
            false => Err(Error::failed(format!(
                "the derivatives are not as accurate as {}: a run at ten times the tolerance has other derivatives\n  help: {help}",
                percent(limit)
            ))),
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

/// The sentence that says what an interruption left out: how many derivatives are done, and how many are compared.
fn missing(wrt: &[(usize, &Parameter)], done: usize, compared: usize) -> Option<String> {
    let names = |from: usize| {
        let names: Vec<&str> = wrt[from..].iter().map(|(_, p)| p.name.as_str()).collect();
        names.join(", ")
    };
    match (done < wrt.len(), compared < done) {
        (true, _) => Some(format!("derivatives by {} are missing", names(done))),
        (false, true) => Some(format!(
            "derivatives by {} are not compared with differences",
            names(compared)
        )),
        (false, false) => None,
    }
}

/// The size of a parameter's possible change: its value, or a share of the interval between its bounds.
fn size(parameter: &Parameter, value: f64) -> f64 {
    match (parameter.min, parameter.max) {
        _ if value != 0.0 => value.abs(),
        (Some(min), Some(max)) if max > min => 0.1 * (max - min),
        _ => 1.0,
    }
}

fn ask(engine: &Engine, job: &Job, given: &[f64], directions: &[f64]) -> Result<Gradients, Error> {
    let gradients = engine
        .gradients(job, given, directions)
        .map_err(Error::system)?;
    for row in &gradients.rows {
        let what = match row.status {
            Status::Done => continue,
            Status::NonFinite => "something is not finite",
            Status::StepTooSmall => "the tolerance asks for steps below the smallest",
            Status::TooManySteps => "it takes too many steps",
            Status::Slow => {
                "the computation takes longer than --time-limit, or would take ten times as long at its present rate"
            }
            Status::Doubtful => {
                let why = sweep::doubt(engine, row.doubt);
                let why = why.unwrap_or_else(|| "its result is doubtful".to_owned());
                return Err(Error::failed(format!(
                    "the simulation cannot be trusted: {why}\n  help: `bryant run` with the same parameters says more"
                )));
            }
            Status::Refused => {
                let why = sweep::refusal(engine, job, given);
                let why = why.unwrap_or_else(|| "the parameters are refused".to_owned());
                return Err(Error::Input(format!(
                    "{why}, which is not so with these parameters"
                )));
            }
        };
        return Err(Error::Run(RunError {
            kind: ErrorKind::Run,
            t: Some(row.t),
            coordinate: None,
            cause: String::new(),
            message: format!(
                "the simulation failed at t = {} s: {what}\n  help: `bryant run` with the same parameters says more",
                row.t
            ),
        }));
    }
    Ok(gradients)
}

/// The problem: model, job, parameters and directions.
struct Asked<'a> {
    engine: &'a Engine,
    job: &'a Job,
    row: &'a [f64],
    directions: &'a [f64],
}

/// Responses and slopes, with an estimate of their error.
struct Accurate {
    gradients: Gradients,
    /// Their estimated error, relative to the largest slope of a response, or to 1 % of the response. NaN if the run for comparison failed;
    /// `None` if an interruption left it out.
    error: Option<f64>,
    tolerance: f64,
}

/// Errors fall like the tolerance, at worst like its root: two runs whose tolerances are as 10 to 1 then differ by this many times the
/// error of the sharper one.
const SURELY: f64 = 2.16;
/// No sharper run begins after this time \[s\], or after this many times the time of the first.
const PATIENCE: [f64; 2] = [10.0, 5.0];

impl Asked<'_> {
    fn at(&self, tolerance: f64, progress: &Progress) -> Result<Gradients, Error> {
        let mut job = self.job.clone();
        job.settings.pace = Pace::Adaptive(Tolerances::of(tolerance));
        slopes(self.engine, &job, self.row, self.directions, progress)
    }

    /// Slopes at a tolerance, compared with those at ten times the tolerance. If they are not as accurate as promised and the user gave no
    /// tolerance, sharper runs follow.
    fn accurately(&self, given: Option<f64>, progress: &Progress) -> Result<Accurate, Error> {
        let begin = Instant::now();
        let mut tolerance = given.unwrap_or(TOLERANCE);
        let mut gradients = self.at(tolerance, progress)?;
        let longest = PATIENCE[0].max(PATIENCE[1] * begin.elapsed().as_secs_f64());
        if interrupt::asked() {
            return Ok(Accurate {
                gradients,
                error: None,
                tolerance,
            });
        }
        // a tolerance must be below 1
        let other = match tolerance < 0.1 {
            true => 10.0 * tolerance,
            false => 0.1 * tolerance,
        };
        let coarse = self.at(other, progress);
        let mut error = coarse.map_or(f64::NAN, |coarse| apart(&gradients, &coarse) / SURELY);
        while (error.is_nan() || error > PROMISED)
            && given.is_none()
            && tolerance > SHARP
            && begin.elapsed().as_secs_f64() < longest
            && !interrupt::asked()
        {
            let Ok(sharper) = self.at(0.1 * tolerance, progress) else {
                break;
            };
            if sharper.rows.len() < gradients.rows.len() {
                break;
            }
            error = apart(&sharper, &gradients) / SURELY;
            (gradients, tolerance) = (sharper, 0.1 * tolerance);
        }
        Ok(Accurate {
            gradients,
            error: Some(error),
            tolerance,
        })
    }
}

/// The difference of the slopes and responses of two runs, relative to the largest slope of each response, or to 1 % of the response if
/// that is larger.
fn apart(fine: &Gradients, coarse: &Gradients) -> f64 {
    let responses = fine.values.len();
    let mut worst = 0.0;
    for k in 0..responses {
        let of = |g: &Gradients| -> Vec<f64> {
            g.slopes
                .iter()
                .skip(k)
                .step_by(responses)
                .copied()
                .collect()
        };
        let [a, b] = [of(fine), of(coarse)];
        let largest = a
            .iter()
            .chain(&b)
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        let value = fine.values[k].abs().max(coarse.values[k].abs());
        let size = largest.max(SMALL * value).max(f64::MIN_POSITIVE);
        let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs() / size);
        let of_value =
            (fine.values[k] - coarse.values[k]).abs() / value.max(largest).max(f64::MIN_POSITIVE);
        for difference in differences.chain([of_value]) {
            // a NaN stays
            if difference.is_nan() || difference > worst {
                worst = difference;
            }
        }
    }
    worst
}

/// A direction for each parameter: along this parameter only, with its size as the length.
fn each_alone(sizes: &[f64]) -> Vec<f64> {
    let mut directions = vec![0.0; sizes.len() * sizes.len()];
    for (i, size) in sizes.iter().enumerate() {
        directions[i * sizes.len() + i] = *size;
    }
    directions
}

/// Responses, and slopes in as many of the directions as time allows; as many run side by side as a register holds.
fn slopes(
    engine: &Engine,
    job: &Job,
    row: &[f64],
    directions: &[f64],
    progress: &Progress,
) -> Result<Gradients, Error> {
    let mut all = Gradients {
        rows: Vec::new(),
        values: Vec::new(),
        slopes: Vec::new(),
    };
    for some in directions.chunks(job.width.lanes() * row.len()) {
        if interrupt::asked() {
            break;
        }
        let found = ask(engine, job, row, some)?;
        all.values = found.values;
        all.rows.extend(found.rows);
        all.slopes.extend(found.slopes);
        progress.set(all.rows.len() as f64);
    }
    Ok(all)
}

/// Derivatives by difference quotients of sharper runs, for as many parameters as time allows: central differences, or at a bound one-sided
/// differences of the same order.
fn differences(
    engine: &Engine,
    job: &Job,
    row: &[f64],
    sizes: &[f64],
    bounds: &[[Option<f64>; 2]],
    progress: &Progress,
) -> Result<Vec<f64>, Error> {
    let mut job = job.clone();
    job.settings.pace = Pace::Adaptive(Tolerances::of(SHARP));
    let still = vec![0.0; row.len()];
    let mut slopes = Vec::new();
    for (i, size) in sizes.iter().enumerate() {
        let at = |by: f64| {
            let mut moved = row.to_vec();
            moved[i] += by;
            ask(engine, &job, &moved, &still).map(|gradients| gradients.values)
        };
        if interrupt::asked() {
            break;
        }
        slopes.extend(difference(at, row[i], MOVED * size, bounds[i])?);
        progress.set((i + 1) as f64);
    }
    Ok(slopes)
}

/// Difference quotients of the function `at` of a parameter's change, of second order in the step, within the bounds of the parameter.
fn difference(
    at: impl Fn(f64) -> Result<Vec<f64>, Error>,
    value: f64,
    step: f64,
    [min, max]: [Option<f64>; 2],
) -> Result<Vec<f64>, Error> {
    let allowed = |by: f64| {
        min.is_none_or(|min| value + by >= min) && max.is_none_or(|max| value + by <= max)
    };
    if allowed(step) && allowed(-step) {
        let (right, left) = (at(step)?, at(-step)?);
        let pairs = right.iter().zip(&left);
        return Ok(pairs
            .map(|(right, left)| (right - left) / (2.0 * step))
            .collect());
    }
    let step = if allowed(step) { step } else { -step };
    let (here, near, far) = (at(0.0)?, at(step)?, at(2.0 * step)?);
    let triples = here.iter().zip(&near).zip(&far);
    Ok(triples
        .map(|((here, near), far)| (4.0 * near - 3.0 * here - far) / (2.0 * step))
        .collect())
}

/// Slopes along directions of these lengths, converted to derivatives.
fn by_size(slopes: &[f64], sizes: &[f64], responses: usize) -> Vec<f64> {
    let of = slopes.chunks(responses).zip(sizes);
    of.flat_map(|(slopes, size)| slopes.iter().map(move |slope| slope / size))
        .collect()
}

struct Table<'a> {
    responses: &'a [Response],
    parameters: &'a [&'a Parameter],
    row: &'a [f64],
    values: &'a [f64],
    /// One parameter after the other.
    slopes: &'a [f64],
    checked: Option<&'a [f64]>,
}

impl Table<'_> {
    fn slope(&self, response: usize, parameter: usize) -> f64 {
        self.slopes[parameter * self.responses.len() + response]
    }

    fn check(&self, response: usize, parameter: usize) -> Option<f64> {
        let checked = self.checked?;
        checked
            .get(parameter * self.responses.len() + response)
            .copied()
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for (k, response) in self.responses.iter().enumerate() {
            let unit = with_unit(&response.unit);
            text += &format!("{}: {}{unit}\n", response.name, number(self.values[k]));
            let mut lines = vec![
                ["parameter", "value", "derivative", "by 1 %", "difference"].map(String::from),
            ];
            for (i, parameter) in self.parameters.iter().enumerate() {
                let slope = self.slope(k, i);
                let elasticity = slope * self.row[i] / self.values[k];
                lines.push([
                    parameter.name.clone(),
                    number(self.row[i]) + &with_unit(&parameter.unit),
                    number(slope) + &with_unit(&quotient(&response.unit, &parameter.unit)),
                    match elasticity {
                        // a zero has no sign
                        0.0 => "0 %".into(),
                        _ if elasticity.is_finite() => format!("{elasticity:+.4} %"),
                        _ => "-".into(),
                    },
                    self.check(k, i).map_or_else(String::new, number),
                ]);
            }
            let columns = 4 + usize::from(self.checked.is_some());
            let width = |column: usize| {
                let widths = lines.iter().map(|line| line[column].chars().count());
                widths.max().unwrap_or(0)
            };
            let widths: Vec<usize> = (0..columns).map(width).collect();
            for line in &lines {
                let cells = line.iter().zip(&widths).enumerate();
                let cells = cells.map(|(column, (cell, width))| match column {
                    0 => format!("{cell:<width$}"),
                    _ => format!("{cell:>width$}"),
                });
                text += &format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end());
            }
            if let Some(worst) = self.disagreement(k) {
                let worst_of = percent(worst);
                text += &match worst <= AGREE {
                    true => format!("  differences agree within {worst_of} of the largest\n"),
                    false => format!(
                        "  differences disagree by {worst_of} of the largest: a response has a kink or a jump near these values\n"
                    ),
                };
            }
            text.push('\n');
        }
        text
    }

    /// How far the derivatives of a response are from the differences, relative to the largest change of the response that any parameter
    /// makes by either of the two, or to the noise of the differences.
    fn disagreement(&self, response: usize) -> Option<f64> {
        self.checked?;
        let change = |i: usize, slope: f64| (slope * size(self.parameters[i], self.row[i])).abs();
        let all = 0..self.parameters.len();
        let largest = all.clone().map(|i| {
            let difference = self.check(response, i).unwrap_or(0.0);
            change(i, self.slope(response, i)).max(change(i, difference))
        });
        let noise = NOISE * self.values[response].abs();
        let largest = largest.fold(noise.max(f64::MIN_POSITIVE), f64::max);
        let off = all.filter_map(|i| {
            let difference = self.check(response, i)?;
            Some(change(i, self.slope(response, i) - difference) / largest)
        });
        Some(off.fold(0.0, f64::max))
    }

    fn json(&self) -> serde_json::Value {
        let responses = self.responses.iter().enumerate().map(|(k, response)| {
            let parameters = self.parameters.iter().enumerate().map(|(i, parameter)| {
                let mut value = json!({
                    "name": parameter.name,
                    "value": self.row[i],
                    "unit": parameter.unit,
                    "derivative": self.slope(k, i),
                    "derivative_unit": quotient(&response.unit, &parameter.unit),
                });
                if let Some(difference) = self.check(k, i) {
                    value["difference"] = json!(difference);
                }
                value
            });
            let mut value = json!({
                "response": response.name,
                "value": self.values[k],
                "unit": response.unit,
                "parameters": parameters.collect::<Vec<_>>(),
            });
            if let Some(worst) = self.disagreement(k) {
                value["disagreement"] = json!(worst);
            }
            value
        });
        json!({ "responses": responses.collect::<Vec<_>>() })
    }
}

/// A number with seven digits.
fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".into(),
        _ if (1e-3..1e6).contains(&size) => {
            let decimals = (6 - size.log10().floor() as i32).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.6e}"),
    }
}

fn with_unit(unit: &str) -> String {
    match unit {
        "" => String::new(),
        unit => format!(" {unit}"),
    }
}

fn quotient(above: &str, below: &str) -> String {
    match (above, below) {
        (above, "") => above.to_owned(),
        ("", below) => format!("1/({below})"),
        (above, below) if above == below => String::new(),
        (above, below) => format!("({above})/({below})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_of_second_order_and_keep_to_bounds() {
        // they are exact for a parabola except for rounding: 4 ε of its size over the step
        let slope_at = |x: f64, bounds: [Option<f64>; 2]| {
            let at = |by: f64| {
                let x = x + by;
                let inside =
                    bounds[0].is_none_or(|min| x >= min) && bounds[1].is_none_or(|max| x <= max);
                assert!(inside, "{x}");
                Ok(vec![3.0 * x * x - x])
            };
            difference(at, x, 1e-3, bounds).unwrap()[0]
        };
        for (x, bounds) in [
            (0.5, [None, None]),
            (0.5, [Some(0.0), Some(1.0)]),
            (0.0, [Some(0.0), Some(1.0)]),
            (1.0, [Some(0.0), Some(1.0)]),
            (0.9995, [Some(0.0), Some(1.0)]),
        ] {
            let found = slope_at(x, bounds);
            assert!(
                (found - (6.0 * x - 1.0)).abs() < 16.0 * f64::EPSILON / 1e-3,
                "{x}: {found}"
            );
        }
    }

    #[test]
    fn numbers_have_seven_digits() {
        assert_eq!(number(1234.5678), "1234.568");
        assert_eq!(number(-0.25), "-0.2500000");
        assert_eq!(number(1e-9), "1.000000e-9");
        assert_eq!(quotient("N", "m"), "(N)/(m)");
        assert_eq!(quotient("N", "N"), "");
    }
}
