//! `bryant export`: writes models for other programs.

mod archive;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod library;

use self::library::Library;
use super::Error;
use super::integration::Integration;
use super::model_argument::find;
use super::outputs::{Outputs, Replacing};
use super::parameters::parse_parameters;
use super::prepare::prepare;
use super::run::read_start;
use super::terminal::Terminal;
use crate::signature::ContentKind;
use crate::{files, quantity};
use bryant_fmu::{ENGINE, SETTING, Setting, Version, description};
use bryant_runtime::program::Job;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Write a model for other programs
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Fmu(Box<Fmu>),
}

/// Write a model as an FMU for co-simulation: Simulink, Dymola, OpenModelica and CarMaker take it, and Python by FMPy
#[derive(Debug, Args)]
#[command(after_long_help = "\
The FMU integrates the model as `bryant run --no-verify` does, with its error control, events and stops: at the same times it has the
same outputs, bit for bit, as long as the model has no inputs. Inputs are held from one communication to the next. Parameters may be
set before a run, the inputs at any time. What the model has no name for is named after its kind: `parameter gravity` if there is an
output gravity, too.

An FMU carries one shared library for each platform that it runs on, libbryant_fmi.so, libbryant_fmi.dylib or bryant_fmi.dll, which
lies beside this program or is named by --library. No compiler is needed.

Examples:
  bryant export fmu child-seat
  bryant export fmu robot.urdf --fmi 3 -o robot.fmu
  bryant export fmu my.yaml --set belt_stiffness='40 kN' --tolerance 1e-8
  bryant export fmu my.yaml --library linux/libbryant_fmi.so --library windows/bryant_fmi.dll")]
struct Fmu {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// File of the FMU [default: MODEL.fmu]
    #[arg(long, short, alias = "output", value_name = "FILE.fmu")]
    out: Option<PathBuf>,

    /// Version of the interface: most programs read 2, newer ones 3 as well
    #[arg(long, value_enum, default_value_t = Fmi::Two)]
    fmi: Fmi,

    #[command(flatten)]
    integration: Integration,

    /// Value of a parameter of the model, with its unit, in place of its default; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// Begin with the state in this file, which `run --final-state` or `settle` wrote, and at its time
    #[arg(long, value_name = "STATE.json")]
    start: Option<PathBuf>,

    /// Time at which a run usually ends [default: as the model says]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    duration: Option<f64>,

    /// Usual time between two communications [default: as the model says]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    every: Option<f64>,

    /// Shared library that the FMU carries, one for each platform; may be repeated [default: the one beside this
    /// program]
    #[arg(long, value_name = "FILE")]
    library: Vec<PathBuf>,

    #[command(flatten)]
    replacing: Replacing,
}

/// Version of the interface.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Fmi {
    /// FMI 2.0
    #[value(name = "2")]
    Two,
    /// FMI 3.0
    #[value(name = "3")]
    Three,
}

impl Arguments {
    /// Writes the file.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        match self.what {
            What::Fmu(fmu) => fmu.execute(terminal),
        }
    }
}

impl Fmu {
    fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        found.tell(terminal);
        let model = &found.model;
        let path = self
            .out
            .clone()
            .unwrap_or_else(|| PathBuf::from(format!("{}.fmu", model.name)));
        let read = found.files.iter().chain(&self.start).chain(&self.library);
        Outputs::of(read, self.replacing).take("--out", &path, ContentKind::Fmu)?;
        if let Some((name, _)) = found.user_sources()?.first() {
            return Err(Error::Input(format!(
                "{name} is a function of yours, and an FMU carries none\n  help: leave out the force, or write it with the laws of the language"
            )));
        }
        let version = match self.fmi {
            Fmi::Two => Version::Two,
            Fmi::Three => Version::Three,
        };
        let libraries = Library::all(&self.library)?;
        let mut job = Job {
            duration: self.duration,
            every: self.every,
            method: self.integration.method()?,
            locate: Some(self.integration.locates_kinks()),
            parameters: parse_parameters(&self.set, &found.scene)?,
            ..Job::default()
        };
        let engine = prepare(&found, terminal)?;
        if let Some(path) = &self.start {
            let end = self.duration.unwrap_or(model.run.duration);
            let read = read_start(path, model, &engine, &job.parameters, end)?;
            for note in &read.notes {
                terminal.note(note);
            }
            job.start = Some(read.start);
        }
        let state = job.start.as_ref().map(|start| start.state.clone());
        let settings = job.settings(engine.info());
        let setting = Setting::of(&settings, job.parameters, state);
        let identifier = identifier(&model.name);
        let description = description(version, &engine, &setting, &identifier, &model.title);

        let mut archive = archive::Archive::new();
        archive.add("modelDescription.xml", description.as_bytes());
        archive.add(&format!("resources/{ENGINE}"), &engine.keep());
        archive.add(
            &format!("resources/{SETTING}"),
            setting.written().as_bytes(),
        );
        for library in &libraries {
            archive.add(&library.place(version, &identifier), &library.content);
        }
        let archive = archive.finish();
        files::replace(&path, |file| file.write_all(&archive)).map_err(Error::system)?;
        let of_platforms: Vec<&str> = libraries.iter().map(Library::platform).collect();
        terminal.note(&format!(
            "wrote {}: FMI {}, co-simulation, {}, {:.1} MB",
            path.display(),
            version.name(),
            of_platforms.join(" and "),
            archive.len() as f64 / 1e6
        ));
        Ok(())
    }
}

/// The name of a model as an identifier of C.
pub fn identifier(name: &str) -> String {
    let letters = name.chars().map(|c| match c.is_ascii_alphanumeric() {
        true => c,
        false => '_',
    });
    let identifier: String = letters.collect();
    match identifier.starts_with(|c: char| c.is_ascii_alphabetic()) {
        true => identifier,
        false => format!("model_{identifier}"),
    }
}
