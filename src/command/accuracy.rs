//! `bryant accuracy`: what each further digit costs in time, for any scene.

use super::Error;
use super::model_argument::{Found, find, nearest};
use super::outputs::{self, Outputs, Replacing, is_standard};
use super::parameters::{parse_parameters, values_of};
use super::prepare::prepare;
use super::progress::{Progress, Whole};
use super::terminal::Terminal;
use crate::accuracy::conclusion::Conclusion;
use crate::accuracy::plan::{Range, Request};
use crate::accuracy::point::Measure;
use crate::accuracy::reading::Reading;
use crate::accuracy::reference::ReferenceError;
use crate::accuracy::report::{diagram, front, record};
use crate::accuracy::setting::{Scheme, time};
use crate::accuracy::study::{Effort, Stage, Study, StudyError, Subject, study};
use crate::picture::Format;
use crate::process::command_line;
use crate::signature::ContentKind;
use crate::{files, interrupt, quantity};
use bryant_generator::model::Model;
use bryant_runtime::program::{ErrorKind, Job, RunError};
use clap::Args;
use std::path::{Component, Path, PathBuf};

/// Show what accuracy costs in time: every method over its steps or tolerances, against a reference
#[derive(Debug, Args)]
#[command(after_long_help = "\
Every method runs over fixed steps and, where it estimates its error, over tolerances; in f64 and f32, with kinks of force
laws located and passed over, and with fast sines. Errors are against dop853 in double-double arithmetic. The table has the
settings that no other one beats in both accuracy and time; the CSV file has all of them.

error in the state   the largest over all samples and entries: of positions and angles relative to the range they go
                     through, of orientations the angle between two relative to the largest from the start, of
                     velocities relative to their largest magnitude
readings             of every output its peak (the sample of the largest magnitude), of accelerations HIC15
time of a run        the median of repetitions in rounds over all points

All of it takes no longer than --budget says: a third of that is for the reference, a third for errors, on all processors, the rest for times. The
coarse end of every series comes first, then more where the front is; a run that takes longer than its share is stopped. Where
stability and not accuracy bounds the steps of a method, the report says so and names the motion and the force that bound them.

Ctrl-C ends it with the report of what was computed, and exit code 130.

Examples:
  bryant accuracy child-seat
  bryant accuracy child-seat --quick --of 'lap belt force'
  bryant accuracy my.yaml --methods rk4,dop853 --tolerances 1e-2..1e-10 --steps '1 ms..10 us'
  bryant accuracy child-seat --set friction=0 --duration '120 ms' --out results
  bryant accuracy child-seat --picture cost.png --markdown cost.md --no-files")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// Methods, separated by commas [default: all of them]
    #[arg(long, value_name = "NAMES", value_parser = methods)]
    methods: Option<Methods>,

    /// Tolerances of the methods that control their error [default: 1e-1..1e-12]
    #[arg(long, value_name = "FROM..TO", value_parser = tolerances, allow_hyphen_values = true)]
    tolerances: Option<Range>,

    /// Fixed steps, from one time to another [default: a thousandfold range below the time between samples]
    #[arg(long, value_name = "FROM..TO", value_parser = steps, allow_hyphen_values = true)]
    steps: Option<Range>,

    /// Run a coarser plan: decades, fewer combinations
    #[arg(long)]
    quick: bool,

    /// Repetitions of the timing of a run; long runs have fewer [default: 11, 3 with --quick]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=10_000))]
    repetitions: Option<u16>,

    /// Time that all runs together may take; slow settings are skipped [default: 40 s, 8 s with --quick]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    budget: Option<f64>,

    /// Error that the summary sentence and the diagram show: `state`, `worst` of all readings, or the name of an output
    /// [default: worst]
    #[arg(long, value_name = "OUTPUT")]
    of: Option<String>,

    /// Accuracy for which the summary sentence names the cheapest setting
    #[arg(long, value_name = "ERROR", default_value = "1 %", value_parser = accuracy, allow_hyphen_values = true)]
    accuracy: f64,

    /// Length of the run, a time [default: as the model says]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    duration: Option<f64>,

    /// Time between the samples at which errors are taken [default: as the model says]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    every: Option<f64>,

    /// Value of a parameter of the model, with its unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// Directory of the files [default: the current one]
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,

    /// CSV file of all points with their settings; - prints it instead of the table [default: MODEL-accuracy.csv]
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// File of the diagram, may be repeated; - prints SVG instead of the table [default: MODEL-accuracy.svg and
    /// MODEL-accuracy.png]
    #[arg(long, value_name = "FILE.svg|.png", value_parser = outputs::picture)]
    picture: Vec<PathBuf>,

    /// Markdown file with the summary sentence, the diagram and the front; - prints it instead of the table
    #[arg(long, value_name = "FILE.md")]
    markdown: Option<PathBuf>,

    /// Write only the files that are named
    #[arg(long)]
    no_files: bool,

    /// Print everything as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    replacing: Replacing,
}

/// Methods, each once.
#[derive(Clone, Debug)]
pub struct Methods(pub Vec<Scheme>);

/// The places where results go.
struct Places {
    csv: Option<PathBuf>,
    pictures: Vec<PathBuf>,
}

/// A run may have at most this many samples: the samples of many runs are kept and compared.
const MOST_SAMPLES: f64 = 1e5;

impl Arguments {
    /// Carries out the study and reports it.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        found.tell(terminal);
        let model = &found.model;
        self.check_of(model)?;
        let places = self.places(&found)?;
        let effort = self.effort(model)?;
        let set = parse_parameters(&self.set, &found.scene)?;

        let engine = prepare(&found, terminal)?;
        let subject = Subject {
            model,
            engine: &engine,
            parameters: values_of(model, &set),
            job: Job {
                duration: self.duration,
                every: self.every,
                parameters: set,
                ..Job::default()
            },
        };
        let study = self.study(&subject, &effort, terminal)?;
        engine.check()?;
        let conclusion = Conclusion::of(&study, self.accuracy);

        // Files come first: a user who closes the pipe after ten lines still has them.
        let results = self.results(&study, &conclusion, &places)?;
        let (prints, files): (Vec<_>, Vec<_>) =
            results.into_iter().partition(|(path, _)| is_standard(path));
        let mut written = Vec::new();
        for (path, bytes) in files {
            files::replace(&path, |out| out.write_all(&bytes)).map_err(Error::system)?;
            written.push(path);
        }
        let printed = match prints.first() {
            _ if self.json => terminal.print_json(&record::json(&study, &conclusion)),
            Some((_, bytes)) => terminal.write(|out| out.write_all(bytes)),
            None => {
                let text = front::text(&study, &conclusion, terminal.width());
                terminal.print(&format!("{text}\n"))
            }
        };
        let printed = printed.and_then(|()| terminal.flush());
        for file in &written {
            terminal.note(&format!("wrote {}", file.display()));
        }
        let done = study.points.iter().filter(|p| p.done().is_some()).count();
        terminal.note(&format!(
            "{done} of {} settings in {}",
            study.points.len(),
            time(study.took)
        ));
        let outcome = match study.interrupted {
            true => Err(Error::Interrupted(format!(
                "{} settings are missing, and the times are medians of fewer repetitions",
                study.points.len() - done
            ))),
            false => Ok(()),
        };
        terminal.end(printed, outcome)
    }

    /// The settings that are run, and how often.
    fn effort(&self, model: &Model) -> Result<Effort, Error> {
        let duration = self.duration.unwrap_or(model.run.duration);
        let every = self.every.unwrap_or(model.run.every).min(duration);
        if duration / every > MOST_SAMPLES {
            return Err(Error::Input(format!(
                "every run would have {:.1e} samples\n  help: at most {MOST_SAMPLES:e} are compared; give a longer --every or a \
                 shorter --duration",
                duration / every
            )));
        }
        let steps = self.steps.unwrap_or(Range::of_steps(every, duration));
        let longest = steps.largest();
        if longest > duration {
            return Err(Error::Input(format!(
                "--steps: steps of {} are longer than the run of {}\n  help: give steps of {} or less",
                time(longest),
                time(duration),
                time(every)
            )));
        }
        if longest > every * (1.0 + 1e-9) {
            return Err(Error::Input(format!(
                "--steps: steps of {} are longer than the {} between two samples, on which steps end\n  \
                 help: give steps of {} or less, or a longer --every",
                time(longest),
                time(every),
                time(every)
            )));
        }
        let (repetitions, budget) = match self.quick {
            true => (3, 8.0),
            false => (11, 40.0),
        };
        Ok(Effort {
            request: Request {
                schemes: self
                    .methods
                    .as_ref()
                    .map_or_else(Scheme::all, |m| m.0.clone()),
                tolerances: match self.tolerances {
                    Some(tolerances) => tolerances,
                    None => Range::new(1e-1, 1e-12).map_err(Error::input)?,
                },
                steps,
                quick: self.quick,
            },
            repetitions: self.repetitions.map_or(repetitions, usize::from),
            budget: self.budget.unwrap_or(budget),
        })
    }

    /// Checks `--of` before anything is computed.
    fn check_of(&self, model: &Model) -> Result<(), Error> {
        let Some(name) = &self.of else { return Ok(()) };
        let outputs = || model.outputs.iter().map(|o| o.name.as_str());
        let known = ["state", "worst"].contains(&name.as_str())
            || outputs().any(|o| {
                [o, &format!("peak {o}"), &format!("HIC15 of {o}")].contains(&name.as_str())
            });
        if known {
            return Ok(());
        }
        let all: Vec<&str> = ["state", "worst"].into_iter().chain(outputs()).collect();
        Err(unknown_of(name, &all))
    }

    /// The error that `--of` names.
    fn measure(&self, readings: &[Reading]) -> Result<Measure, StudyError> {
        let name = match self.of.as_deref() {
            None | Some("worst") if readings.is_empty() => return Ok(Measure::State),
            None | Some("worst") => return Ok(Measure::Worst),
            Some("state") => return Ok(Measure::State),
            Some(name) => name,
        };
        let found = readings
            .iter()
            .position(|r| r.name == name || r.name == format!("peak {name}"));
        found.map(Measure::Reading).ok_or_else(|| {
            let names: Vec<&str> = readings.iter().map(|r| r.name.as_str()).collect();
            StudyError::Measure(format!(
                "\"{name}\" is zero during the whole run, or has no head injury criterion, so it has no relative error\n  \
                 help: --of state, worst, {}",
                names.join(", ")
            ))
        })
    }

    fn study(
        &self,
        subject: &Subject<'_>,
        effort: &Effort,
        terminal: &Terminal,
    ) -> Result<Study, Error> {
        let text = |stage| {
            let (what, whole) = match stage {
                Stage::Reference => ("computing the reference", Whole::Unknown),
                Stage::Errors => ("computing errors", Whole::Share),
                Stage::Times => ("timing", Whole::Share),
            };
            (format!("{what} of {}", subject.model.name), whole)
        };
        let mut now = Stage::Reference;
        let (what, whole) = text(now);
        let shown = Progress::new(terminal, what, whole);
        interrupt::watch();
        let mut progress = |stage: Stage, part: f64| {
            if stage != now {
                now = stage;
                let (what, whole) = text(stage);
                shown.next(what, whole);
            }
            shown.set(part);
        };
        let of = |readings: &[Reading]| self.measure(readings);
        let result = study(subject, effort, of, &mut progress);
        drop(shown);
        result.map_err(|error| match error {
            _ if interrupt::asked() => Error::Interrupted("there is no reference yet".into()),
            StudyError::Measure(message) => Error::Input(message),
            StudyError::Reference(ref failed @ ReferenceError::Run { ref error, .. }) => {
                let message = failed.to_string();
                let error = (**error).clone();
                Error::Run(RunError { message, ..error })
            }
            StudyError::Reference(failed @ ReferenceError::Apart { .. }) => Error::Run(RunError {
                kind: ErrorKind::Run,
                t: None,
                coordinate: None,
                cause: String::new(),
                message: failed.to_string(),
            }),
        })
    }

    /// The places of results: those that are requested, and the usual files.
    fn places(&self, found: &Found) -> Result<Places, Error> {
        let usual = |extension: &str| {
            let file = format!("{}-accuracy.{extension}", found.model.name);
            self.out.clone().unwrap_or_default().join(file)
        };
        let mut outputs = Outputs::of(&found.files, self.replacing);
        if self.json {
            outputs.take("--json", Path::new("-"), ContentKind::Table)?;
        }
        let csv = self.csv.clone();
        let csv = csv.or_else(|| (!self.no_files).then(|| usual("csv")));
        let pictures = match self.picture.as_slice() {
            [] if self.no_files => Vec::new(),
            [] => vec![usual("svg"), usual("png")],
            named => named.to_vec(),
        };
        let named = csv.iter().map(|path| ("--csv", path, ContentKind::Table));
        let named = named.chain(
            pictures
                .iter()
                .map(|path| ("--picture", path, ContentKind::Picture)),
        );
        let page = self.markdown.iter();
        let page = page.map(|path| ("--markdown", path, ContentKind::Markdown));
        for (option, path, kind) in named.chain(page) {
            outputs.take(option, path, kind)?;
        }
        Ok(Places { csv, pictures })
    }

    /// Writes every result to its place, in the order of this list.
    fn results(
        &self,
        study: &Study,
        conclusion: &Conclusion,
        places: &Places,
    ) -> Result<Vec<(PathBuf, Vec<u8>)>, Error> {
        let mut results = Vec::new();
        if let Some(path) = &places.csv {
            let mut bytes = Vec::new();
            record::csv(study, conclusion, &mut bytes).map_err(Error::system)?;
            results.push((path.clone(), bytes));
        }
        let drawing = diagram::diagram(study, conclusion).drawing();
        for path in &places.pictures {
            let format = Format::of(path).unwrap_or(Format::Svg);
            results.push((path.clone(), drawing.bytes(format).map_err(Error::system)?));
        }
        if let Some(path) = &self.markdown {
            let picture = places.pictures.iter().find(|path| !is_standard(path));
            let picture = picture.map(|picture| link(path, picture));
            let section = front::section(study, conclusion, picture.as_deref(), &command_line());
            results.push((path.clone(), section.into_bytes()));
        }
        Ok(results)
    }
}

/// The link of a picture in a page: relative to the directory of the page if both paths are absolute or both are
/// relative.
pub fn link(page: &Path, picture: &Path) -> String {
    let text = |path: &Path| path.to_string_lossy().replace('\\', "/");
    let directory = page.parent().unwrap_or(Path::new(""));
    let common = directory.components().zip(picture.components());
    let common = common.take_while(|(a, b)| a == b).count();
    let up = directory.components().skip(common);
    // the parent of a directory `..` is not known
    let unknown = up.clone().any(|part| part == Component::ParentDir);
    if unknown || page.is_absolute() != picture.is_absolute() {
        return text(picture);
    }
    let down = picture.components().skip(common);
    let relative: PathBuf = up.map(|_| Component::ParentDir).chain(down).collect();
    text(&relative)
}

/// Names of methods, separated by commas.
pub fn methods(text: &str) -> Result<Methods, String> {
    let mut methods = Vec::new();
    for name in text
        .split(',')
        .map(str::trim)
        .filter(|name| !name.is_empty())
    {
        let found = Scheme::all()
            .into_iter()
            .find(|scheme| scheme.name() == name);
        let Some(scheme) = found else {
            let names: Vec<String> = Scheme::all().iter().map(|s| s.name()).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let near = match nearest(name, &names) {
                Some(near) => format!("did you mean \"{near}\"? There are"),
                None => "there are".to_owned(),
            };
            return Err(format!(
                "there is no method \"{name}\"\n  help: {near} {}",
                names.join(", ")
            ));
        };
        if !methods.contains(&scheme) {
            methods.push(scheme);
        }
    }
    match methods.is_empty() {
        true => Err("no method is named\n  help: write them as rk4,dop853".into()),
        false => Ok(Methods(methods)),
    }
}

pub fn tolerances(text: &str) -> Result<Range, String> {
    Range::read(text, quantity::tolerance)
        .map_err(|error| format!("{error}\n  help: give the largest and the smallest: 1e-2..1e-10"))
}

pub fn steps(text: &str) -> Result<Range, String> {
    Range::read(text, quantity::time).map_err(|error| {
        format!("{error}\n  help: steps are positive times, from the longest to the shortest: '1 ms..10 us'")
    })
}

/// A requested error: between 0 and 1, possibly in %.
pub fn accuracy(text: &str) -> Result<f64, String> {
    match quantity::quantity(text, "") {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        Ok(_) => Err("it is not between 0 and 1\n  help: write it as 1 % or 1e-3".into()),
        Err(error) => Err(error.to_string()),
    }
}

fn unknown_of(name: &str, all: &[&str]) -> Error {
    let help = match nearest(name, all) {
        Some(near) => format!("did you mean \"{near}\"? There are"),
        None => "there are".to_owned(),
    };
    Error::Input(format!(
        "there is no output \"{}\" to show the error of\n  help: {help} {}",
        name.escape_debug(),
        all.join(", ")
    ))
}
