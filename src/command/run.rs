//! `bryant run`: runs a model, and writes the motion as a table, files and pictures.

mod animation;
mod comparison;
mod criteria;
mod files;
mod inputs;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod outcome;
mod remarks;
mod report;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod responses;
mod result;
mod rings;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod scene;

use self::scene::Shown;
use super::Error;
use super::accuracy::accuracy;
use super::caution::{self, singular::Near};
use super::compare::{filter_standard, pair};
use super::error_report::ErrorReport;
use super::integration::Integration;
use super::model_argument::{Found, find};
use super::outputs::{self, Replacing};
use super::parameters::{parse_parameters, values_of};
use super::prepare::{by_rustc, prepare};
use super::progress::{Progress, Whole};
use super::terminal::Terminal;
use crate::accuracy::check::{self, Certainty, Checked, FAR};
use crate::accuracy::comparison::PROMISED;
use crate::accuracy::fastest_motion::fastest;
use crate::accuracy::target;
use crate::build_on_demand::RustcModel;
use crate::equations::Engine;
use crate::interrupt;
use crate::picture::{Format, View};
use crate::simulation::{self, Recording, Runs};
use crate::table::Table;
use crate::units::{self, Units};
use crate::{balance, quantity, state_file};
use bryant_generator::model::Model;
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::units::UnitSystem;
use bryant_runtime::program::{ErrorKind, Finding, Job, RunError};
use bryant_runtime::response::filter::Standard;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use files::Files;
use remarks::{look_for_right_angle, remark};
use responses::Responses;
pub use scene::meshes_of;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Run a model: print its table, write it as CSV, draw the motion
#[derive(Debug, Args)]
#[command(after_long_help = "\
Times may have units (0.1 ms, 2 s); a bare number is in seconds. Other quantities likewise: a bare number is in SI units.

Ctrl-C ends the run: the samples up to there are printed and written, and the exit code is 130.

Examples:
  bryant run child-seat
  bryant run child-seat --duration '80 ms' --every '1 ms' --out results
  bryant run child-seat --set lap_slack='20 mm' --set gravity=9.81
  bryant run child-seat --method rk4 --step '0.1 ms'
  bryant run child-seat --accuracy 0.1% --verify
  bryant run child-seat --no-files --csv - | head
  bryant run child-seat --plot 'head accelerometer' --plot 'lap belt force, cushion force'
  bryant run child-seat --response 'HIC15 of head accelerometer' --response '3 ms clip of chest accelerometer'
  bryant run child-seat -r 'peak of lap belt force' -r 'time of peak of lap belt force'
  bryant run my/sled.yaml --json > run.json
  bryant run child-seat --duration '60 ms' --final-state state.json
  bryant run child-seat --start state.json
  bryant run child-seat --report child-seat.html")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    #[command(flatten)]
    integration: Integration,

    /// Accuracy of every output, relative to its largest magnitude (1%, 1e-3): the program chooses the method, sharpens
    /// the tolerance until runs agree, and prints the estimated error
    #[arg(long, value_name = "ERROR", value_parser = accuracy, allow_hyphen_values = true, conflicts_with_all = ["method", "step", "tolerance", "kinks"])]
    accuracy: Option<f64>,

    /// Compare with a much sharper run by another method, however long that takes, and print by how much they differ
    #[arg(long)]
    verify: bool,

    /// Leave out the check that every run gets: a second run by another method at a tenth of the tolerance. If outputs
    /// or responses differ by more than 0.1 %, the run is repeated at a smaller tolerance
    #[arg(long, conflicts_with = "verify")]
    no_verify: bool,

    /// What evaluates the equations: built-in is machine code or an interpreter of this program; rustc compiles the
    /// generated Rust of the whole model with optimisation, which takes seconds to minutes and is meant for comparisons
    #[arg(long, value_name = "NAME", default_value = BUILT_IN, value_parser = PossibleValuesParser::new([BUILT_IN, RUSTC]))]
    engine: String,

    /// Time at which the run ends; this is its length where it begins at 0 [default: as the model says]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    duration: Option<f64>,

    /// Begin with the state in this file, which --final-state wrote, and at its time. Entries are found by name, so
    /// that the model may be another one with the same coordinates
    #[arg(long, value_name = "STATE.json")]
    start: Option<PathBuf>,

    /// Write the state of the last sample, by name, to begin another run with it; - prints it instead of the readable
    /// table
    #[arg(long, value_name = "STATE.json")]
    final_state: Option<PathBuf>,

    /// Time between the rows of the table [default: as the model says]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    every: Option<f64>,

    /// Value of a parameter of the model, with its unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// File that an input of the model follows over time: a table whose first column is the time, or a test in ISO-MME.
    /// It is the column with the name of the input, or the only one; others are named as 'torque=measured.csv, COLUMN'.
    /// Values go in straight lines from row to row; may be repeated
    #[arg(long, value_name = "NAME=FILE", value_parser = inputs::input_file)]
    input: Vec<inputs::InputFile>,

    /// Give up when the computation takes longer than this, or would take ten times as long at its present rate; a
    /// time, or off [default: 5 min]
    #[arg(long, value_name = "TIME", value_parser = time_limit, allow_hyphen_values = true)]
    time_limit: Option<f64>,

    /// Give up after this many steps [default: 10000000]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    max_steps: Option<u64>,

    /// Share of energy and momentum that may be missing in their balances, or off. If more is missing, the run cannot
    /// be trusted [default: 2%]
    #[arg(long, value_name = "SHARE", value_parser = energy_limit, allow_hyphen_values = true)]
    energy_limit: Option<f64>,

    /// Directory of the files [default: the current one]
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,

    /// File of the table with all digits; - prints it instead of the readable table [default: MODEL.csv]
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// File of the picture, SVG or PNG by the ending of its name; - prints SVG instead of the readable table [default:
    /// MODEL.svg, or MODEL.png with --pictures png]
    #[arg(long, value_name = "FILE.svg|.png", value_parser = outputs::picture)]
    picture: Option<PathBuf>,

    /// Format of the pictures whose files are not named: that of the motion, and plots
    #[arg(long, value_name = "FORMAT", default_value = "svg", value_parser = outputs::format())]
    pictures: Format,

    /// Write a report: one page of HTML with the motion, the curves and the messages of the run; any browser shows it,
    /// without a network
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// Recording whose curves the report shows beside those of the run: a test in ISO-MME, or a CSV table of `bryant
    /// run`. Its channels are found by name or code, or by --channel
    #[arg(long, value_name = "RECORDING", requires = "report")]
    measured: Option<PathBuf>,

    /// Which channel of --measured belongs to an output; may be repeated
    #[arg(long, value_name = "OUTPUT=CHANNEL", value_parser = pair, requires = "measured")]
    channel: Vec<(String, String)>,

    /// Parameter of a second run, which the report shows on top of the first, in grey and in dashes; may be repeated,
    /// for several parameters of that run
    #[arg(long, value_name = "NAME=VALUE", requires = "report")]
    beside: Vec<String>,

    /// Also write the table as Apache Parquet, with all digits
    #[arg(long, value_name = "FILE.parquet")]
    parquet: Option<PathBuf>,

    /// Write the motion as an animation in glTF 2.0, for Blender and other programs that show bodies in space
    #[arg(long, value_name = "FILE.glb")]
    animation: Option<PathBuf>,

    /// Write all outputs as channels of ISO-MME (ISO/TS 13499) into this folder: MODEL.mme, and a folder Channel.
    /// Outputs with a `code` in the model have that channel code
    #[arg(long, value_name = "FOLDER")]
    mme: Option<PathBuf>,

    /// Write only the files that are named by --csv, --parquet, --picture, --report, --animation, --mme
    /// and --final-state
    #[arg(long)]
    no_files: bool,

    /// Plot columns of the table over time, or over another column as NAMES over NAME; may be repeated
    #[arg(long, value_name = "'NAMES over NAME'", allow_hyphen_values = true)]
    plot: Vec<String>,

    /// Box that a curve of a plot over time should pass through, as 'rotation: 57 ms to 64 ms, 64 deg to 78 deg'; `any`
    /// leaves a side open; may be repeated
    #[arg(
        long,
        value_name = "'NAME: TIME to TIME, VALUE to VALUE'",
        allow_hyphen_values = true
    )]
    corridor: Vec<String>,

    /// Response that is read off the run, as WHAT of OUTPUT: 'HIC15 of head accelerometer', '3 ms clip of chest
    /// acceleration', 'time of peak of belt force', 'value at 80 ms of head excursion'. Some words of an output's name
    /// suffice. May be repeated
    #[arg(
        long,
        short = 'r',
        value_name = "'WHAT of OUTPUT'",
        allow_hyphen_values = true
    )]
    response: Vec<String>,

    /// Read off the responses of a study, sampled as it says; the rest of the study is ignored
    #[arg(long, value_name = "STUDY.yaml")]
    responses: Option<PathBuf>,

    /// Time between the samples that responses are read off, which do not depend on the rows of the table [default: as
    /// the study of --responses says, or a twentieth of the time between the model's rows]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    sampling: Option<f64>,

    /// Judge the run by the injury criteria of a regulation for a dummy: 'FMVSS 208, Hybrid III 50M'; `bryant
    /// criteria --list` lists them. Outputs with a `code` of ISO-MME are found by it, others are named by --place. For
    /// this the run is sampled at 10 kHz, whatever the table shows
    #[arg(long, value_name = "'REGULATION, DUMMY'", value_parser = standard_and_dummy)]
    criteria: Option<(String, String)>,

    /// Standard whose coefficients the filters of criteria have [default: as the model says, or iso6487]
    #[arg(long, value_name = "NAME", value_parser = filter_standard())]
    filter_standard: Option<Standard>,

    /// The output of a place of the dummy, for --criteria: 'head=head acceleration'; may be repeated
    #[arg(long, value_name = "PLACE=OUTPUT", value_parser = pair)]
    place: Vec<(String, String)>,

    /// Test object and position of the occupant whose outputs are judged, the first two characters of their codes
    #[arg(long, value_name = "OCCUPANT", value_parser = super::criteria::occupant)]
    occupant: Option<String>,

    /// About this many stick figures in the picture, at round times
    #[arg(long, value_name = "COUNT", default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..=100))]
    figures: u16,

    /// Direction from which the picture shows a model in space: side, from the right; front; top, from above; oblique,
    /// from the right, the front and above [default: side, unless the motion is larger from the front or from above]
    #[arg(long, value_name = "VIEW", value_parser = view())]
    view: Option<View>,

    /// Draw the stick figures on top of each other instead of side by side
    #[arg(long)]
    overlay: bool,

    /// List the work of each effect in the balance of energy
    #[arg(long)]
    energy: bool,

    /// Print the result alone: neither the table nor what the run took
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,

    /// Print the table and the report as JSON
    #[arg(long)]
    json: bool,

    /// Units in which outputs and responses are shown and written: SI, or engineering (mm, g, kN, °, kPa, ms). An
    /// output with a unit of its own keeps it. Files of ISO-MME and criteria have the units of their standards
    /// [default: as the model says]
    #[arg(long, value_name = "SYSTEM", value_parser = units::system())]
    units: Option<UnitSystem>,

    /// Significant digits of the largest value of every column of the table [default: by the unit]
    #[arg(long, value_name = "DIGITS", value_parser = clap::value_parser!(u8).range(1..=17))]
    precision: Option<u8>,

    #[command(flatten)]
    replacing: Replacing,
}

/// Reads a regulation and a dummy from `REGULATION, DUMMY`.
fn standard_and_dummy(text: &str) -> Result<(String, String), String> {
    match text.split_once(',') {
        Some((standard, dummy)) => Ok((standard.trim().to_owned(), dummy.trim().to_owned())),
        None => Err("give a regulation and a dummy, as 'FMVSS 208, Hybrid III 50M'".to_owned()),
    }
}

/// The names of the engines.
const BUILT_IN: &str = "built-in";
const RUSTC: &str = "rustc";

/// Largest number of rows of a table, as in a model, because all of them are kept until the end.
const MOST_ROWS: f64 = 1e6;

/// A duration that is this many times that of the model is perhaps in the wrong unit.
const UNUSUAL: f64 = 100.0;

/// Time limit of a run if the user gives none \[s\].
pub(super) const TIME_LIMIT: f64 = 300.0;
/// Time limit of the search for the cause of a slow run \[s\].
const LOOKING: f64 = 10.0;

impl Arguments {
    /// Runs the model.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let mut found = find(&self.model)?;
        found.show_in(self.units);
        found.tell(terminal);
        let mut job = self.job(&found.scene)?;
        let files = Files::of(&self, &found)?;
        let mut responses = Responses::of(&self, &found, 0.0)?;
        if let Some(note) = self.long(&found.model) {
            terminal.note(&note);
        }
        for note in super::caution::thinned(&found.model) {
            terminal.note(&note);
        }
        self.follow_inputs(&mut found, &job)?;
        let engine = prepare(&found, terminal)?;
        if let Some(path) = &self.start {
            let end = job.duration.unwrap_or(found.model.run.duration);
            let read = read_start(path, &found.model, &engine, &job.parameters, end)?;
            for note in &read.notes {
                terminal.note(note);
            }
            responses = Responses::of(&self, &found, read.start.t)?;
            job.start = Some(read.start);
        }
        for caution in responses.cautions() {
            terminal.note(&format!("warning: {caution}"));
        }
        job.reading = responses.reading.clone();
        let job = job;
        let compiled = match self.engine == RUSTC {
            true => Some(by_rustc(&found, &engine, self.may_be_stiff(), terminal)?),
            false => None,
        };
        let evaluated: &dyn Runs = match &compiled {
            Some(compiled) => compiled,
            None => &*engine,
        };
        let (mut recording, errors) = self.record(evaluated, &job, &found.model, terminal);
        engine.check()?;
        self.look_for_cause(&engine, &found.model, &job, &mut recording);
        remark(&found, &job, &mut recording);
        if let Some(failure) = compiled.as_ref().and_then(RustcModel::failure) {
            return Err(Error::failed(failure.to_owned()));
        }
        if let Err(error) = &recording.result
            && error.kind == ErrorKind::Job
        {
            return Err(Error::Run(error.clone()));
        }

        let done = Done {
            arguments: &self,
            found: &found,
            job: &job,
            shown: Shown::new(&found, &job),
            recording: &recording,
            table: Units::of(&found.model).table(&recording.table),
            errors: &errors,
            responses: &responses,
            verdict: responses.verdict(&recording),
        };
        // Files are written before results are printed: a user who closes the pipe after ten lines still gets them.
        let written = done.write(&files, terminal)?;
        let printed = done.print(&files, &written, terminal);
        let printed = printed.and_then(|()| terminal.flush());
        self.tell_cost(&recording, &errors, terminal);
        for line in &recording.notes {
            terminal.note(line);
        }
        let printed = printed.and_then(|()| done.print_result(&files, terminal));
        if let [first, others @ ..] = &written[..] {
            let others = others.iter().map(|file| format!(", {}", file.display()));
            terminal.note(&format!(
                "wrote {}{}",
                first.display(),
                others.collect::<String>()
            ));
        }
        let duration = job.duration.unwrap_or(found.model.run.duration);
        let outcome = self.conclude(&recording, &errors, duration);
        terminal.end(printed, outcome)
    }

    /// Lets the inputs of `--input` follow their files.
    fn follow_inputs(&self, found: &mut Found, job: &Job) -> Result<(), Error> {
        let set = |name: &str| job.parameters.iter().any(|(set, _)| set == name);
        if let Some(both) = self.input.iter().find(|file| set(file.name())) {
            return Err(Error::Input(format!(
                "the input \"{}\" has a value from --set, and a file from --input\n  help: give one of them",
                both.name()
            )));
        }
        let start = match &self.start {
            Some(path) => state_file::time(path).map_err(Error::Input)?,
            None => 0.0,
        };
        let end = self.duration.unwrap_or(found.model.run.duration);
        inputs::follow(&mut found.model, &self.input, [start, end])
    }

    /// Looks for the cause of a failure or of a slow run; after a run that reached its end, adds doubts and notes about
    /// singular joints and belts.
    fn look_for_cause(&self, engine: &Engine, model: &Model, job: &Job, recording: &mut Recording) {
        match &recording.result {
            Ok(_) => {
                doubt_singular_start(model, job, recording);
                let notes = rings::notes(model, job, recording);
                recording.notes.extend(notes);
            }
            Err(error) if error.kind == ErrorKind::Time => {
                let looking = LOOKING.min(self.time_limit.unwrap_or(TIME_LIMIT));
                let fastest = fastest(engine, job, &recording.parameters(job), looking);
                if let (Some(fastest), Err(error)) = (fastest, &mut recording.result) {
                    error.cause = fastest.text();
                }
                look_for_right_angle(model, job, recording);
            }
            Err(error) if error.kind == ErrorKind::Run => {
                look_for_singular_joint(model, job, recording);
                look_for_right_angle(model, job, recording);
            }
            Err(_) => {}
        }
    }

    /// Prints the cost of the run, how its error was found, and the balance of energy if it is requested.
    fn tell_cost(&self, recording: &Recording, errors: &ErrorReport, terminal: &mut Terminal) {
        if recording.result.is_err() || self.quiet {
            return;
        }
        if let Some(energy) = recording.energy.as_ref().filter(|_| self.energy) {
            terminal.note(&balance::text(&recording.header, energy));
        }
        terminal.note(&outcome::report(recording));
        for line in errors.lines() {
            terminal.note(&line);
        }
    }

    /// Fails if the run cannot be trusted or did not reach its end.
    fn conclude(
        &self,
        recording: &Recording,
        errors: &ErrorReport,
        duration: f64,
    ) -> Result<(), Error> {
        match &recording.result {
            Ok(_) => {
                outcome::doubtful(recording)?;
                if interrupt::asked() && (self.accuracy.is_some() || !self.no_verify) {
                    return Err(Error::Interrupted(
                        "the table is complete, but not all of the runs that its error is estimated from were done".into(),
                    ));
                }
                errors.check()
            }
            Err(error) if error.kind == ErrorKind::Stopped => Err(Error::Interrupted(format!(
                "{}; the samples after t = {} s up to {duration} s are missing",
                error.message,
                recording.last_time(),
            ))),
            Err(error) => Err(Error::Run(RunError {
                message: outcome::failure(error, recording),
                ..error.clone()
            })),
        }
    }

    /// A note about a duration that was perhaps meant in milliseconds; `None` if it was not.
    fn long(&self, model: &Model) -> Option<String> {
        let times = self.duration? / model.run.duration;
        (times >= UNUSUAL).then(|| {
            format!(
                "--duration is {:.0} times the {} of the model; a bare number is in seconds",
                times,
                crate::accuracy::setting::time(model.run.duration)
            )
        })
    }

    fn job(&self, scene: &AnnotatedModel) -> Result<Job, Error> {
        let model = &scene.model;
        let method = self.integration.method()?;
        let duration = self.duration.unwrap_or(model.run.duration);
        let every = self.every.unwrap_or(model.run.every);
        if duration / every > MOST_ROWS {
            return Err(Error::Input(format!(
                "the table would have {:.1e} rows, {:.1} GB of numbers\n  help: at most {MOST_ROWS:e} are kept; give a longer --every or a shorter --duration",
                duration / every,
                duration / every * ((1 + model.outputs.len()) * size_of::<f64>()) as f64 / 1e9
            )));
        }
        if self.report.is_some() && duration / every > report::MOST_ROWS {
            return Err(Error::Input(format!(
                "the report would have {:.1e} rows, and no browser shows them well\n  help: at most {:e} fit; give a longer --every or a shorter --duration",
                duration / every,
                report::MOST_ROWS
            )));
        }
        Ok(Job {
            duration: self.duration,
            every: self.every,
            method,
            locate: Some(self.integration.locates_kinks()),
            max_steps: self.max_steps,
            time_limit: Duration::try_from_secs_f64(self.time_limit.unwrap_or(TIME_LIMIT)).ok(),
            energy_limit: self.energy_limit,
            parameters: parse_parameters(&self.set, scene)?,
            ..Job::default()
        })
    }

    /// True if a method with a Jacobian is requested, or may be chosen.
    fn may_be_stiff(&self) -> bool {
        self.accuracy.is_some() || self.integration.is_implicit()
    }

    /// Runs the job, and finds out about the error of the run.
    fn record(
        &self,
        engine: &dyn Runs,
        job: &Job,
        model: &Model,
        terminal: &Terminal,
    ) -> (Recording, ErrorReport) {
        let duration = job.duration.unwrap_or(model.run.duration);
        let what = format!("running {}", model.name);
        let begin = job.start.as_ref().map_or(0.0, |start| start.t);
        let progress = Progress::new(terminal, what, Whole::Time(duration - begin));
        let mut hear = |t: f64| progress.set(t - begin);
        interrupt::watch();
        let chosen = job.method.is_some();
        let checked = match self.accuracy {
            Some(wanted) => target::run(engine, job, wanted, &mut hear),
            None if self.verify || self.no_verify => Checked {
                recording: simulation::run(engine, job, &mut hear),
                certainty: Certainty::none(if chosen { FAR } else { PROMISED }),
            },
            None => {
                let mut runs = 0;
                let mut hear_of = |before: usize, t: f64| {
                    if before != runs {
                        runs = before;
                        let what = format!("checking {}", model.name);
                        progress.next(what, Whole::Time(duration - begin));
                    }
                    hear(t);
                };
                check::run(engine, job, chosen, &mut hear_of)
            }
        };
        let (recording, mut known) = (checked.recording, checked.certainty);
        if self.verify && recording.result.is_ok() {
            let made_by = known
                .setting
                .map_or(job.clone(), |setting| setting.job(job));
            known.check = Some(check::verify(engine, (&made_by, &recording), &mut hear));
        }
        drop(progress);
        let errors = ErrorReport::new(&recording.header, known);
        (recording, errors)
    }
}

/// A run that is over, and everything that its results are made from.
struct Done<'a> {
    arguments: &'a Arguments,
    found: &'a Found,
    job: &'a Job,
    shown: Shown<'a>,
    recording: &'a Recording,
    /// Its table, in the units that are shown.
    table: Table,
    errors: &'a ErrorReport,
    responses: &'a Responses,
    /// `None` if no criteria are requested; `Some(None)` if the run does not allow a verdict.
    verdict: Option<Option<crate::criteria::Verdict>>,
}

impl Done<'_> {
    /// Writes all files; returns their paths.
    fn write(&self, files: &Files, terminal: &mut Terminal) -> Result<Vec<PathBuf>, Error> {
        let Done {
            arguments,
            found,
            recording,
            ref shown,
            ..
        } = *self;
        let mut written = files.write(arguments, shown, (recording, &self.table), terminal)?;
        if let Some(path) = &arguments.report {
            let of_run = (recording, &self.table, self.errors);
            let judged = self.verdict.as_ref().map(judged_json);
            let judged = (self.responses, judged);
            let page = report::html(arguments, shown, of_run, judged, terminal)?;
            crate::files::replace(path, |out| out.write_all(page.as_bytes()))
                .map_err(Error::system)?;
            written.push(path.clone());
        }
        if let Some(path) = &arguments.parquet {
            crate::files::replace(path, |out| {
                files::parquet(out, &found.model.name, (recording, &self.table))
            })
            .map_err(Error::system)?;
            written.push(path.clone());
        }
        if let Some(path) = &arguments.animation {
            let file = animation::animation(shown, (recording, self.errors), terminal)?;
            crate::files::replace(path, |out| out.write_all(&file)).map_err(Error::system)?;
            written.push(path.clone());
        }
        shown.tell(terminal);
        Ok(written)
    }

    /// Prints the table and remarks about criteria; or all results as JSON.
    fn print(
        &self,
        files: &Files,
        written: &[PathBuf],
        terminal: &mut Terminal,
    ) -> Result<(), Error> {
        let Done {
            arguments,
            job,
            recording,
            errors,
            responses,
            ..
        } = *self;
        if arguments.json {
            let mut value = outcome::json(
                &arguments.engine,
                job,
                (recording, &self.table),
                errors,
                written,
            );
            value["responses"] = responses.json(recording, errors);
            value["peaks"] = result::json_of_peaks(&responses.peaks(recording));
            if let Some(verdict) = &self.verdict {
                value["criteria"] = judged_json(verdict);
            }
            return terminal.print_json(&value);
        }
        files.print(arguments, &self.shown, (recording, &self.table), terminal)?;
        self.shown.tell(terminal);
        match &self.verdict {
            Some(Some(verdict)) if !arguments.quiet && !files.prints_a_file() => {
                terminal.print(&format!("\n{}", verdict.remarks()))
            }
            _ => Ok(()),
        }
    }

    /// Prints the result on one screen; on standard error if a file is printed. With JSON it prints nothing, because
    /// JSON includes the result.
    fn print_result(&self, files: &Files, terminal: &mut Terminal) -> Result<(), Error> {
        if self.arguments.json {
            return Ok(());
        }
        let text = result::text(self, terminal.width());
        if files.prints_a_file() {
            terminal.note(text.trim_matches('\n'));
            return Ok(());
        }
        terminal.print(&text)?;
        terminal.flush()
    }
}

/// A verdict as JSON; null if there is none.
fn judged_json(verdict: &Option<crate::criteria::Verdict>) -> serde_json::Value {
    verdict
        .as_ref()
        .map_or(serde_json::Value::Null, crate::criteria::Verdict::json)
}

/// Reads the view of a picture.
fn view() -> impl TypedValueParser<Value = View> {
    PossibleValuesParser::new(View::ALL.map(View::name))
        .map(|name| View::named(&name).unwrap_or_default())
}

/// Reads the largest share of a balance that may be missing: a number like an accuracy, or off.
fn energy_limit(text: &str) -> Result<f64, String> {
    match text {
        "off" => Ok(f64::INFINITY),
        text => accuracy(text).map_err(|error| format!("{error}, or off")),
    }
}

/// Reads a length of time, or off.
pub(super) fn time_limit(text: &str) -> Result<f64, String> {
    match text {
        "off" => Ok(f64::INFINITY),
        text => quantity::time(text).map_err(|error| format!("{error}, or off")),
    }
}

/// Reads the state with which a run until `end` \[s\] begins.
pub(super) fn read_start(
    path: &Path,
    of: &Model,
    engine: &Engine,
    parameters: &[(String, f64)],
    end: f64,
) -> Result<state_file::Read, Error> {
    let mut model = engine.in_double();
    model.set_parameters(&values_of(of, parameters));
    let mut own = vec![0.0; engine.info().state_length()];
    model.initial_state(&mut own);
    state_file::read(path, engine.info(), &own, end).map_err(Error::Input)
}

/// If a joint is in a singular position, names it as the cause of a failure.
fn look_for_singular_joint(model: &Model, job: &Job, recording: &mut Recording) {
    let given = job.start.as_ref().map(|start| &start.state);
    let last = Some(&recording.last_state).filter(|state| !state.is_empty());
    let state = last.or(given);
    let coordinates = &recording.header.coordinates;
    let value = |name: &str| {
        let place = coordinates.iter().position(|one| one == name)?;
        state?.get(place).copied()
    };
    let parameters = recording.parameters(job);
    let cause = caution::singular::at(model, &parameters, value, Near::CloseTo);
    if let (Some(cause), Err(error)) = (cause, &mut recording.result) {
        error.cause = cause.join("; ");
    }
}

/// Adds a doubt to a run that starts in a singular position of a joint, because rounding errors alone decide how it
/// leaves this position.
fn doubt_singular_start(model: &Model, job: &Job, recording: &mut Recording) {
    let coordinates = &recording.header.coordinates;
    let value = |name: &str| {
        let place = coordinates.iter().position(|one| one == name)?;
        job.start.as_ref()?.state.get(place).copied()
    };
    let parameters = recording.parameters(job);
    let Some([position, remedy]) = caution::singular::at(model, &parameters, value, Near::In)
    else {
        return;
    };
    let start = Finding {
        since: recording.first_time(),
        kind: "singular".to_owned(),
        amount: 0.0,
        coordinate: String::new(),
        message: format!("at the start {position}"),
        remedy,
        lasts: true,
    };
    recording.doubts.insert(0, start);
}
