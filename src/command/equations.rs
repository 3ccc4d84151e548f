//! `bryant equations`: prints S, r_s and r_k as text, as source code, or as numbers at one state.

use super::Error;
use super::gradient::table::number;
use super::model_argument::find;
use super::outputs::{Outputs, Replacing};
use super::parameters::{parse_parameters, values_of};
use super::prepare::users_of;
use super::progress::Progress;
use super::terminal::Terminal;
use crate::build_on_demand::UserForces;
use crate::equations::of_lists;
use crate::evaluation::{self, Evaluation, Function, State};
use crate::files;
use crate::notation::Notation;
use crate::signature::ContentKind;
use bryant_generator::Config;
use bryant_generator::description::load::read_file;
use bryant_generator::description::tree::MAX_BYTES;
use bryant_generator::dynamics::derive_in_first_chart;
use bryant_generator::equations::{Equations, Variable};
use bryant_generator::expression::print::{Names, latex, text};
use bryant_generator::expression::{NodeId, Symbol};
use bryant_generator::model::{Coordinates, Curve, Dimension, Extrapolate, Interpolate, Model};
use bryant_generator::target::c::Source;
use bryant_picture::text::typeset;
use bryant_runtime::Info;
use clap::{Args, ValueEnum};
use std::fmt::Write as _;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Print the equations of motion S v̇ = r_s + r_k as text, LaTeX, Rust or C, or their values at a state
#[derive(Debug, Args)]
#[command(after_long_help = "\
The state is a JSON file {\"t\": 0.01, \"q\": [...], \"v\": [...]} (SI units; - reads it from standard input); q and v stand
in the order of \"coordinates\" and \"velocities\", which --json prints, with the state itself as \"state\". Without
--at the state is that at the start of a run. Functions of user forces are compiled as for `bryant run`. --functions
needs accelerations for some, as \"a\": [...] in the order of v; without them it takes those of the motion.

Examples:
  bryant equations sled-pendulum
  bryant equations sled-pendulum --latex > equations.tex
  bryant equations my.yaml --rust > model.rs
  bryant equations child-seat --c --out src          write src/child_seat.h and src/child_seat.c
  bryant equations my.yaml --json                    values at the start
  bryant equations robot-arm --functions 'inverse_dynamics,jacobian(hand)'
  echo '{\"t\": 0, \"q\": [0.1, 0, 0, 0.2], \"v\": [0, 0, 0, 1]}' | bryant equations sled-pendulum --at - --json")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// Print LaTeX
    #[arg(long, conflicts_with_all = ["rust", "c", "at", "json"])]
    latex: bool,

    /// Print the Rust source that a build script would write
    #[arg(long, conflicts_with_all = ["at", "json", "set"])]
    rust: bool,

    /// Print the model as C99: a header, then the source that includes it
    #[arg(long, conflicts_with_all = ["latex", "rust", "at", "json", "set"])]
    c: bool,

    /// Write the C99 as NAME.h and NAME.c into this directory instead
    #[arg(
        long,
        short,
        alias = "output",
        value_name = "DIRECTORY",
        requires = "c"
    )]
    out: Option<PathBuf>,

    /// Functions of the mechanism, such as inverse_dynamics or jacobian(arm/hand): with --rust and --c their source as
    /// well, else their values at the state
    #[arg(
        long,
        value_name = "NAME,…",
        value_delimiter = ',',
        conflicts_with = "latex"
    )]
    functions: Vec<String>,

    /// Coordinates of orientations in space, instead of those of the model
    #[arg(long, value_enum)]
    coordinates: Option<CoordinatesName>,

    /// Print values at the state in this file; - is standard input
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,

    /// Value of a parameter of the model, with its unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// Print the values at a state as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    replacing: Replacing,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum CoordinatesName {
    /// Unit quaternions; v holds angular velocities
    Quaternion,
    /// Bryant angles; v holds their rates
    Bryant,
}

impl Arguments {
    /// Derives the equations and prints them.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        // the state is read first, so that an error in it is found before the long work
        let state = self.at.as_deref().map(read_state).transpose()?;
        let found = find(&self.model)?;
        let set = parse_parameters(&self.set, &found.scene)?;
        let mut model = found.model.clone();
        match self.coordinates {
            Some(CoordinatesName::Quaternion) => model.coordinates = Coordinates::Quaternion,
            Some(CoordinatesName::Bryant) => model.coordinates = Coordinates::Bryant,
            None => {}
        }
        model.normalize();
        let mut config = Config::new();
        config.functions(&self.functions);
        config.requests(&model, &self.model).map_err(Error::Model)?;
        let progress = Progress::deriving(terminal, &model.name);
        if self.rust {
            let text = config.source(&model);
            drop(progress);
            return terminal.print(&text);
        }
        if self.c {
            let made = config.c_source(&model).map_err(Error::input);
            drop(progress);
            return self.print_c(&made?, &found.files, terminal);
        }
        if !(self.json || state.is_some() || !self.functions.is_empty()) {
            let equations = derive_in_first_chart(&model);
            drop(progress);
            return terminal.print(&listing(
                &model,
                &equations,
                &values_of(&model, &set),
                self.latex,
            ));
        }
        let lists = config.lists(&model);
        drop(progress);
        let users = users_of(&found, &model, terminal)?;
        let engine = of_lists(lists, users.clone()).map_err(Error::system)?;
        let parameters = values_of(&model, &set);
        let state = state.unwrap_or_else(|| evaluation::start(&engine, &parameters));
        let values = evaluation::at(&engine, &parameters, &state);
        // if a user function panicked, its message says more than a missing number
        if let Some(failure) = users.as_deref().and_then(UserForces::failure) {
            return Err(Error::User(failure.problems.clone()));
        }
        let values = values.map_err(Error::input)?;
        if self.json {
            terminal.print_json(&values)
        } else {
            terminal.print(&table(engine.info(), &values))
        }
    }

    /// Prints header and source in C, or writes them as files.
    fn print_c(
        &self,
        made: &Source,
        read: &[PathBuf],
        terminal: &mut Terminal,
    ) -> Result<(), Error> {
        let Source {
            name,
            header,
            source,
        } = made;
        let Some(directory) = &self.out else {
            return terminal.print(&format!("{header}\n{source}"));
        };
        let files = [("h", header), ("c", source)];
        let files = files.map(|(ending, text)| (directory.join(format!("{name}.{ending}")), text));
        let mut outputs = Outputs::of(read, self.replacing);
        for (path, _) in &files {
            outputs.take("--out", path, ContentKind::Source)?;
        }
        for (path, text) in files {
            files::replace(&path, |out| out.write_all(text.as_bytes())).map_err(Error::system)?;
        }
        Ok(())
    }
}

fn read_state(path: &Path) -> Result<State, Error> {
    let (name, text) = if path == Path::new("-") {
        let mut text = String::new();
        let input = std::io::stdin().take(MAX_BYTES as u64 + 1);
        let read = { input }.read_to_string(&mut text).map(|_| text);
        ("standard input".to_owned(), read)
    } else {
        (path.display().to_string(), read_file(path))
    };
    let text = text.map_err(|e| {
        Error::Input(format!(
            "cannot read the state from {name}: {e}\n  help: name a file, or - for standard input"
        ))
    })?;
    if text.len() > MAX_BYTES {
        return Err(Error::Input(format!(
            "{name} is longer than {MAX_BYTES} bytes, and no state is\n  help: give one state, as `--json` prints it as \"state\""
        )));
    }
    serde_json::from_str(&text).map_err(|error| {
        Error::Input(format!(
            "{name} is not a state: {error}\n  \
             help: write {{\"t\": 0.0, \"q\": [...], \"v\": [...]}}, SI units, as `--json` prints it as \"state\""
        ))
    })
}

/// The equations for people: the meaning of the symbols, then S, r_s and r_k.
fn listing(model: &Model, equations: &Equations, parameters: &[f64], as_latex: bool) -> String {
    let notation = Notation::new(model, equations);
    let symbol = |symbol| {
        if as_latex {
            notation.latex(symbol)
        } else {
            notation.text(symbol)
        }
    };
    let function = |function| notation.function(function);
    let names = Names {
        symbol: &symbol,
        function: &function,
    };
    let roots = roots(equations, as_latex);
    let comment = if as_latex { '%' } else { '#' };
    let mut result = String::new();
    for line in heading(model, equations, parameters, &symbol) {
        let line = format!("{comment} {line}");
        result.push_str(line.trim_end());
        result.push('\n');
    }
    result.push('\n');
    if as_latex {
        result.push_str("\\[\n");
        result.push_str(&latex(&equations.graph, &roots, &names));
        result.push_str("\\]\n");
    } else {
        result.push_str(&text(&equations.graph, &roots, &names));
    }
    result
}

/// The entries of the upper triangle of S that are not 0, and those of r_s and r_k, with their names.
fn roots(equations: &Equations, as_latex: bool) -> Vec<(String, NodeId)> {
    let mut roots = Vec::new();
    for (i, row) in equations.mass_matrix.iter().enumerate() {
        for (j, entry) in row.iter().enumerate().skip(i) {
            if !equations.graph.expr(*entry).is_zero() {
                let (i, j) = (i + 1, j + 1);
                let name = if as_latex {
                    format!("S_{{{i},{j}}}")
                } else {
                    format!("S[{i},{j}]")
                };
                roots.push((name, *entry));
            }
        }
    }
    for (name, vector) in [
        ("s", &equations.velocity_forces),
        ("k", &equations.applied_forces),
    ] {
        for (i, entry) in vector.iter().enumerate() {
            let i = i + 1;
            let name = if as_latex {
                format!("r_{{{name},{i}}}")
            } else {
                format!("r_{name}[{i}]")
            };
            roots.push((name, *entry));
        }
    }
    roots
}

fn heading(
    model: &Model,
    equations: &Equations,
    parameters: &[f64],
    symbol: &dyn Fn(Symbol) -> String,
) -> Vec<String> {
    let mut lines = vec![
        format!("{}: S v̇ = r_s + r_k", model.name),
        "S is symmetric; entries that are not listed are zero or follow by symmetry.".to_owned(),
        String::new(),
    ];
    let quaternion =
        model.dimension == Dimension::Space && model.coordinates == Coordinates::Quaternion;
    let mut list = |title: &str, variables: &[Variable], of: fn(u32) -> Symbol| {
        lines.push(title.to_owned());
        let width = |text: &dyn Fn(usize, &Variable) -> String| {
            let widths = variables
                .iter()
                .enumerate()
                .map(|(i, v)| text(i, v).chars().count());
            widths.max().unwrap_or(0)
        };
        let short = |i: usize, _: &Variable| symbol(of(i as u32));
        let (first, second) = (width(&short), width(&|_, v| v.name.clone()));
        for (i, variable) in variables.iter().enumerate() {
            let unit = if variable.unit.is_empty() {
                "-"
            } else {
                variable.unit
            };
            let (short, name) = (short(i, variable), &variable.name);
            lines.push(format!(
                "  {:>3}  {short:first$}  {name:second$}  [{unit}]",
                i + 1
            ));
        }
    };
    list("coordinates q", &equations.coordinates, Symbol::Coordinate);
    let velocities = if quaternion {
        "velocities v, to which S, r_s and r_k belong (angular ones in absolute axes)"
    } else {
        "velocities v = q̇, to which S, r_s and r_k belong"
    };
    list(velocities, &equations.velocities, Symbol::Velocity);
    if equations.charts > 0 {
        lines.push(
            "Bryant angles in chart 0: A = Rx(φ1) Ry(φ2) Rz(φ3), singular where φ2 = ±90 deg; a run changes to another chart before."
                .to_owned(),
        );
    }
    for (i, state) in equations.auxiliaries.iter().enumerate() {
        let (symbol, unit) = (symbol(Symbol::Auxiliary(i as u32)), state.unit);
        let unit = if unit.is_empty() { "-" } else { unit };
        lines.push(format!("state {symbol} = {} [{unit}]", state.name));
    }
    for (parameter, value) in model.parameters.iter().zip(parameters) {
        let unit = if parameter.unit.is_empty() {
            "-"
        } else {
            &parameter.unit
        };
        let name = &parameter.name;
        lines.push(format!("parameter {name} = {value} [{unit}]"));
    }
    for curve in &model.curves {
        lines.push(describe(curve));
    }
    lines
}

/// A curve by its points (SI); a long curve by the first and last of them.
fn describe(curve: &Curve) -> String {
    let point = |[x, y]: &[f64; 2]| format!("({x}, {y})");
    let points = &curve.points;
    let text = if points.len() <= POINTS_SHOWN {
        points.iter().map(point).collect::<Vec<_>>().join(" ")
    } else {
        let first: Vec<String> = points[..POINTS_SHOWN - 1].iter().map(point).collect();
        format!("{} … {}", first.join(" "), point(&points[points.len() - 1]))
    };
    let beyond = match curve.extrapolate {
        Extrapolate::Linear => "outside of its points the outermost lines are extended",
        Extrapolate::Hold => "outside of its points the outermost values are kept",
        Extrapolate::Error => "not defined outside of its points",
    };
    let between = match curve.interpolate {
        Interpolate::Linear => "",
        Interpolate::Cubic => "; cubics between them",
    };
    format!("curve {}: {text}{between}; {beyond}", curve.name)
}

/// Largest number of points of a curve that are listed.
const POINTS_SHOWN: usize = 12;
/// Digits of a number.
const DIGITS: usize = 7;

/// The values as text: S as a grid; the vectors as columns beside the names of the velocities.
fn table(info: &Info, values: &Evaluation) -> String {
    let state = &values.state;
    let mut text = format!("t = {} s\n\n", state.t);
    let width = |names: &[&str]| {
        let widths = names.iter().map(|name| name.chars().count());
        widths.max().unwrap_or(0).max(10)
    };
    let (of_coordinates, of_velocities) = info.units.split_at(info.coordinates.len());
    let first = width(info.coordinates);
    let _ = writeln!(text, "{:first$}  {:>14}", "coordinate", "q");
    for ((name, unit), value) in info.coordinates.iter().zip(of_coordinates).zip(&state.q) {
        let (value, unit) = (number(*value, DIGITS), typeset(unit));
        let line = format!("{name:first$}  {value:>14}  {unit}");
        let _ = writeln!(text, "{}", line.trim_end());
    }
    let first = width(info.velocities);
    let _ = writeln!(
        text,
        "\n{:first$}  {:>14}  {:>14}  {:>14}  {:>14}  units",
        "velocity", "v", "r_s", "r_k", "dv/dt"
    );
    for (i, (name, unit)) in info.velocities.iter().zip(of_velocities).enumerate() {
        let numbers = [
            state.v[i],
            values.r_s[i],
            values.r_k[i],
            values.acceleration[i],
        ];
        let numbers = numbers
            .map(|n| format!("{:>14}", number(n, DIGITS)))
            .join("  ");
        let force = if *unit == "m/s" { "N" } else { "N·m" };
        let _ = writeln!(
            text,
            "{name:first$}  {numbers}  {unit}, {force}, {force}, {unit}²"
        );
    }
    text.push_str("\nS [kg between translations, kg·m between translation and rotation, kg·m² between rotations]\n");
    for row in &values.mass_matrix {
        let row: Vec<String> = row
            .iter()
            .map(|n| format!("{:>14}", number(*n, DIGITS)))
            .collect();
        let _ = writeln!(text, "{}", row.join(" "));
    }
    for function in &values.functions {
        text.push('\n');
        text += &function_table(function);
    }
    text
}

/// The values of a function: a row for each row, with its name.
fn function_table(function: &Function) -> String {
    let Function {
        name,
        rows,
        columns,
        values,
    } = function;
    let mut text = format!("{name}\n");
    let widths = |names: &[String]| names.iter().map(|name| name.chars().count()).max();
    let first = widths(rows).unwrap_or(0);
    let width = widths(columns).unwrap_or(0).max(14);
    if columns.iter().any(|column| !column.is_empty()) {
        let columns: Vec<String> = columns.iter().map(|c| format!("{c:>width$}")).collect();
        let line = format!("{:first$} {}", "", columns.join(" "));
        let _ = writeln!(text, "{}", line.trim_end());
    }
    for (row, values) in rows.iter().zip(values) {
        let values = values
            .iter()
            .map(|n| format!("{:>width$}", number(*n, DIGITS)));
        let _ = writeln!(
            text,
            "{row:first$} {}",
            values.collect::<Vec<_>>().join(" ")
        );
    }
    text
}
