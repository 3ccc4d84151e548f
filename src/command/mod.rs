//! The command line: one file for each subcommand; errors and exit codes.

// Those that are public are so for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod accuracy;
#[doc(hidden)]
pub mod effects;
#[doc(hidden)]
pub mod error_report;
#[doc(hidden)]
pub mod export;
#[doc(hidden)]
pub mod gradient;
#[doc(hidden)]
pub mod help;
#[doc(hidden)]
pub mod model_argument;
#[doc(hidden)]
pub mod outputs;
#[doc(hidden)]
pub mod prepare;
#[doc(hidden)]
pub mod progress;
#[doc(hidden)]
pub mod response;
#[doc(hidden)]
pub mod run;
#[doc(hidden)]
pub mod sweep;
#[doc(hidden)]
pub mod terminal;

mod caution;
mod check;
mod compare;
mod criteria;
mod equations;
mod human;
mod import;
mod integration;
mod merge;
mod models;
mod modes;
mod parameters;
mod schema;
mod settle;
mod stability;

pub(crate) use terminal::fitted;

use crate::{interrupt, process};
use bryant_generator::diagnostic::Diagnostics;
use bryant_runtime::program::{ErrorKind, RunError};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::io::Write;
use std::process::ExitCode;
use terminal::{Kept, Terminal};

/// Simulate how mechanisms move: crash-test dummies in belts and seats, robots, any tree of rigid bodies.
#[derive(Debug, Parser)]
#[command(
    name = "bryant",
    version = crate::VERSION,
    about,
    long_about = "Reads the description of a mechanism (trees of rigid elements, the forces between them) in YAML, derives \
                  its equations of motion S(q) q̈ = r_s + r_k for exactly that mechanism, and runs it.\n\n\
                  MODEL is the name of a bundled model (`bryant models` lists them) or the path of a YAML or URDF file.",
    after_help = "Try: bryant run child-seat",
    after_long_help = "\
Examples:
  bryant models                                      what is bundled
  bryant run child-seat                              table, peaks, child-seat.csv and child-seat.svg
  bryant run my.yaml --set belt_stiffness='40 kN'    another value for a parameter
  bryant check my.yaml                               what was understood, or everything that is wrong
  bryant human --like male-50 -o man.yaml            an adult as a system for models
  bryant import robot.urdf -o robot.yaml             a robot's description of ROS as a model
  bryant export fmu my.yaml                          an FMU for Simulink, Dymola, OpenModelica
  bryant settle my.yaml -o rest.json                 a state of rest, to start runs from
  bryant modes my.yaml --start rest.json             frequencies and damping about a state of rest
  bryant criteria TEST.mme --standard 'UN R94' --dummy 'Hybrid III 50M'
                                                     injury criteria beside the limits of a regulation
  bryant compare run.csv TEST.mme                    how well a run agrees with a measurement
  bryant sweep study.yaml                            many runs with other parameters, in lanes and on all processors
  bryant gradient child-seat --of peak_lap_force     what a response changes by when parameters do
  bryant effects my.yaml                             what is in, what is out, and what each effect costs
  bryant accuracy my.yaml                            what each further digit costs in time
  bryant equations sled-pendulum --latex             S and r_s to read
  bryant stability                                   hard cases, and how far from their bounds they stay

Exit codes:
  0  done
  1  something around the model failed: a file, standard output, the compiler
  2  bad input: the model, an option, a state; every problem is reported with place and remedy
  3  the simulation failed on the way, and what was computed up to there is written; or it cannot be trusted, and a message says
     since when and why
130  interrupted by Ctrl-C: what was computed is printed or written, and a message says what is missing; a second Ctrl-C ends at once

Environment:
  BRYANT_CACHE   where compiled user forces are kept (otherwise XDG_CACHE_HOME/bryant, ~/.cache/bryant)
  RUSTC          the compiler for functions of user forces (otherwise rustc from the path)
  NO_COLOR       no colour, whatever the terminal"
)]
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    // in the order of a first day: what is there, what it does, models of one's own, studies, what is behind it
    Models(models::Arguments),
    Run(Box<run::Arguments>),
    Check(check::Arguments),
    Human(human::Arguments),
    Import(import::Arguments),
    Export(export::Arguments),
    Settle(settle::Arguments),
    Modes(modes::Arguments),
    Criteria(criteria::Arguments),
    Schema(schema::Arguments),
    Compare(compare::Arguments),
    Sweep(sweep::Arguments),
    Merge(merge::Arguments),
    Gradient(gradient::Arguments),
    Effects(effects::Arguments),
    Accuracy(accuracy::Arguments),
    Equations(equations::Arguments),
    Stability(stability::Arguments),
}

/// The reasons why a command failed.
#[derive(Debug)]
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub enum Error {
    /// The description of a model is wrong.
    Model(Diagnostics),
    /// A user function failed in a run.
    User(Diagnostics),
    /// An option, a state or a name is wrong; the message includes the remedy.
    Input(String),
    /// The simulation failed.
    Run(RunError),
    /// An error of the system, such as a file that cannot be written.
    System(String),
    /// The user pressed Ctrl-C; the message says which results are missing.
    Interrupted(String),
    /// The reader of standard output is gone, as in `bryant models | head -1`.
    Closed,
}

impl Error {
    /// An error of the input, with a message.
    fn input(error: impl std::fmt::Display) -> Self {
        Error::Input(error.to_string())
    }

    /// An error of the system.
    fn system(error: impl std::fmt::Display) -> Self {
        Error::System(error.to_string())
    }

    /// The error for a simulation whose results cannot be used.
    fn failed(message: String) -> Self {
        Error::Run(RunError {
            kind: ErrorKind::Run,
            t: None,
            coordinate: None,
            cause: String::new(),
            message,
        })
    }

    fn exit_code(&self) -> u8 {
        match self {
            Error::Closed => 0,
            Error::System(_) => 1,
            Error::Model(_) | Error::Input(_) => 2,
            Error::User(_) => 3,
            Error::Run(error) => error.exit_code(),
            Error::Interrupted(_) => interrupt::EXIT_CODE,
        }
    }

    fn report(&self, terminal: &Terminal) {
        match self {
            Error::Closed => {}
            Error::Model(diagnostics) | Error::User(diagnostics) => {
                terminal.error_text(&diagnostics.render(terminal.colour()));
            }
            Error::Input(message) | Error::System(message) => terminal.error(message),
            Error::Run(error) => terminal.error(&error.message),
            Error::Interrupted(missing) => terminal.error(&format!("interrupted: {missing}")),
        }
    }
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    process::outlive_limits_of_files();
    let matches = help::fitted(Cli::command()).try_get_matches();
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => return print_help(&error),
    };
    ExitCode::from(cli.execute(Terminal::new()))
}

/// What a command printed, and how it ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Captured {
    /// The exit code.
    pub code: u8,
    /// What it printed on standard output.
    pub output: String,
    /// What it printed on standard error.
    pub messages: String,
}

/// Runs a command line (without the name of the program) inside of another program, which handles Ctrl-C
/// ([`interrupt::is_handled`], [`interrupt::stop`]). Nothing is printed, but by functions of user forces.
pub fn captured(line: &[String]) -> Captured {
    let words = std::iter::once("bryant").chain(line.iter().map(String::as_str));
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => {
            let (text, failed) = (error.to_string(), error.use_stderr());
            let (output, messages) = match failed {
                true => (String::new(), text),
                false => (text, String::new()),
            };
            return Captured {
                code: if failed { 2 } else { 0 },
                output,
                messages,
            };
        }
    };
    let (output, messages) = (Kept::default(), Kept::default());
    let terminal = Terminal::keeping(output.clone(), messages.clone());
    let code = process::with_command_line(line, || cli.execute(terminal));
    Captured {
        code,
        output: output.text(),
        messages: messages.text(),
    }
}

impl Cli {
    /// Runs the command, and returns its exit code.
    fn execute(self, mut terminal: Terminal) -> u8 {
        let result = match self.command {
            Command::Run(arguments) => arguments.execute(&mut terminal),
            Command::Accuracy(arguments) => arguments.execute(&mut terminal),
            Command::Check(arguments) => arguments.execute(&mut terminal),
            Command::Compare(arguments) => arguments.execute(&mut terminal),
            Command::Criteria(arguments) => arguments.execute(&mut terminal),
            Command::Effects(arguments) => arguments.execute(&mut terminal),
            Command::Equations(arguments) => arguments.execute(&mut terminal),
            Command::Models(arguments) => arguments.execute(&mut terminal),
            Command::Schema(arguments) => arguments.execute(&mut terminal),
            Command::Settle(arguments) => arguments.execute(&mut terminal),
            Command::Modes(arguments) => arguments.execute(&mut terminal),
            Command::Stability(arguments) => arguments.execute(&mut terminal),
            Command::Sweep(arguments) => arguments.execute(&mut terminal),
            Command::Merge(arguments) => arguments.execute(&mut terminal),
            Command::Gradient(arguments) => arguments.execute(&mut terminal),
            Command::Human(arguments) => arguments.execute(&mut terminal),
            Command::Import(arguments) => arguments.execute(&mut terminal),
            Command::Export(arguments) => arguments.execute(&mut terminal),
        };
        // earlier output must come before the message
        let printed = terminal.flush();
        match terminal.end(printed, result) {
            Ok(()) => 0,
            Err(error) => {
                error.report(&terminal);
                error.exit_code()
            }
        }
    }
}

/// Prints help, the version, or an error in the command line.
fn print_help(text: &clap::Error) -> ExitCode {
    let printed = text.print().and_then(|()| std::io::stdout().flush());
    let mut terminal = Terminal::new();
    let result = match printed {
        // errors go to standard error; if printing them fails, nothing can be done
        _ if text.use_stderr() => return ExitCode::from(2),
        Ok(()) => terminal.write(|_| Ok(())),
        Err(error) => Err(terminal::unwritten(error)),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            error.report(&terminal);
            ExitCode::from(error.exit_code())
        }
    }
}
