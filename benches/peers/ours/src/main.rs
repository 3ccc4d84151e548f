//! Accelerations of the models of the comparison, and the whole fall of dummy15, computed and timed by this project.
//!
//! | arguments | standard input | standard output |
//! |---|---|---|
//! | `trees` | | the trees as JSON |
//! | `names MODEL` | | the names of q, then v |
//! | `start MODEL` | | the state that a run starts from, q then v |
//! | `accelerations MODEL COLUMN` | number of states, then each: q, v | nanoseconds per evaluation of each batch, a line; then v̇, a line for each state |
//! | `function FOLDER ROBOT FUNCTION COLUMN` | number of rows, then each: q, v, accelerations | nanoseconds per evaluation of each batch, a line; then the results, a line for each row |
//! | `fall DURATION STEP COLUMN METHOD` | one state of dummy15 | nanoseconds of each run, a line; then the state at the end |
//!
//! A column is `f64`, or a width of registers: `1` (one state, with fused multiply-adds), `4`, `8`, or `widest`. In
//! lanes the derivative of the whole state is timed, including q̇. A method is `rk4`, `dop853` or `adams`, with steps
//! of one length.
//!
//! SI units; q and v are in the order of the model's own table of coordinates. The programs of the other engines use
//! the same format.

mod fall;
mod functions;
mod lanes;
mod robots;
mod time;

use bryant_runtime::real::lanes::with_width;
use bryant_runtime::{Model, ParameterSet, Width};
use fall::StepFormula;
use std::error::Error;
use std::io::Read;
use std::marker::PhantomData;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The generated modules.
#[allow(missing_docs)]
mod models {
    pub mod planar9 {
        bryant_runtime::include_model!("planar9");
    }
    pub mod chain5 {
        bryant_runtime::include_model!("chain5");
    }
    pub mod dummy15 {
        bryant_runtime::include_model!("dummy15");
    }
    pub mod chain30 {
        bryant_runtime::include_model!("chain30");
    }
    pub mod chain100 {
        bryant_runtime::include_model!("chain100");
    }
    #[cfg(robots)]
    pub mod panda {
        bryant_runtime::include_model!("panda");
    }
    #[cfg(robots)]
    pub mod ur5 {
        bryant_runtime::include_model!("ur5");
    }
    #[cfg(robots)]
    pub mod hyq {
        bryant_runtime::include_model!("hyq");
    }
    #[cfg(robots)]
    pub mod anymal {
        bryant_runtime::include_model!("anymal");
    }
    #[cfg(robots)]
    pub mod talos {
        bryant_runtime::include_model!("talos");
    }
}

/// Calls a macro with the module of the named model.
macro_rules! with_model {
    ($name:expr, $call:ident $(, $argument:expr)*) => {
        match $name {
            "planar9" => $call!(models::planar9 $(, $argument)*),
            "chain5" => $call!(models::chain5 $(, $argument)*),
            "dummy15" => $call!(models::dummy15 $(, $argument)*),
            "chain30" => $call!(models::chain30 $(, $argument)*),
            "chain100" => $call!(models::chain100 $(, $argument)*),
            #[cfg(robots)]
            "panda" => $call!(models::panda $(, $argument)*),
            #[cfg(robots)]
            "ur5" => $call!(models::ur5 $(, $argument)*),
            #[cfg(robots)]
            "hyq" => $call!(models::hyq $(, $argument)*),
            #[cfg(robots)]
            "anymal" => $call!(models::anymal $(, $argument)*),
            #[cfg(robots)]
            "talos" => $call!(models::talos $(, $argument)*),
            name => return Err(format!("there is no model {name:?}").into()),
        }
    };
}

/// A column of the table: takes states, gives the times of batches and the accelerations.
macro_rules! one_by_one {
    ($($module:ident)::+, $states:expr) => {{
        use $($module)::+ as module;
        let mechanism = module::Mechanism::<f64>::new(module::Parameters::defaults());
        let states: Vec<([f64; module::COORDINATES], [f64; module::VELOCITIES])> = $states
            .iter()
            .map(|row| Ok((array(row, 0)?, array(row, module::COORDINATES)?)))
            .collect::<Result<_>>()?;
        let mut results = vec![[0.0; module::VELOCITIES]; states.len()];
        let times = time::batches(states.len(), || {
            for ((q, v), result) in states.iter().zip(&mut results) {
                *result = mechanism.accelerations(0.0, q, v);
            }
            std::hint::black_box(&mut results);
        });
        (times, results.iter().map(|row| row.to_vec()).collect())
    }};
}

/// The same for as many states at once as a register has lanes.
macro_rules! abreast {
    ($($module:ident)::+, $width:expr, $states:expr) => {{
        let task = lanes::Accelerations {
            states: $states,
            of: PhantomData::<$($module)::+::Mechanism<f64>>,
        };
        with_width($width, task)
    }};
}

macro_rules! start {
    ($($module:ident)::+) => {{
        use $($module)::+ as module;
        module::Mechanism::<f64>::new(module::Parameters::defaults()).initial_state().to_vec()
    }};
}

macro_rules! names {
    ($($module:ident)::+) => {{
        use $($module)::+ as module;
        let info = <module::Mechanism<f64> as Model<f64>>::INFO;
        [info.coordinates, info.velocities].concat().join(" ")
    }};
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["trees"] => print!("{}", include_str!(concat!(env!("OUT_DIR"), "/trees.json"))),
        ["names", model] => println!("{}", with_model!(model, names)),
        ["start", model] => println!("{}", numbers(&with_model!(model, start))),
        ["accelerations", model, column] => {
            let states = read()?;
            let (times, results): (Vec<f64>, Vec<Vec<f64>>) = match column {
                "f64" => with_model!(model, one_by_one, states),
                column => {
                    let width = width(column)?;
                    let result = with_model!(model, abreast, width, &states);
                    result.ok_or("this processor has no such registers")?
                }
            };
            println!("{}", numbers(&times));
            results.iter().for_each(|row| println!("{}", numbers(row)));
        }
        ["function", folder, robot, function, column] => {
            let of = functions::Of::new(folder.as_ref(), robot, function)?;
            let rows = read()?;
            let (times, results) = match column {
                "f64" => of.one_by_one(&rows),
                column => with_width(width(column)?, functions::Abreast(&of, &rows))
                    .ok_or("this processor has no such registers")?,
            };
            println!("{}", numbers(&times));
            results.iter().for_each(|row| println!("{}", numbers(row)));
        }
        ["fall", duration, step, column, method] if column != "f64" => {
            let (duration, step): (f64, f64) = (duration.parse()?, step.parse()?);
            let states = read()?;
            let task = lanes::Fall {
                start: states.first().ok_or("a state is missing")?,
                rule: StepFormula::named(method)?,
                steps: (duration / step).round() as u32,
                step,
                of: PhantomData::<models::dummy15::Mechanism<f64>>,
            };
            let (times, end) =
                with_width(width(column)?, task).ok_or("this processor has no such registers")?;
            println!("{}", numbers(&times));
            println!("{}", numbers(&end));
        }
        ["fall", duration, step, _, method] => {
            use models::dummy15::{Mechanism, Parameters};
            let mechanism = Mechanism::<f64>::new(Parameters::defaults());
            let states = read()?;
            let start = array(states.first().ok_or("a state is missing")?, 0)?;
            let (duration, step) = (duration.parse()?, step.parse()?);
            let (times, end) = fall::fall(&mechanism, start, duration, step, StepFormula::named(method)?)?;
            println!("{}", numbers(&times));
            println!("{}", numbers(&end));
        }
        _ => {
            return Err(
                "trees, names, start, accelerations, function or fall? See src/main.rs".into(),
            );
        }
    }
    Ok(())
}

/// The width of registers of a column.
fn width(column: &str) -> Result<Width> {
    match column {
        "widest" => Ok(Width::widest()),
        column => {
            Width::named(column).ok_or_else(|| format!("there is no column {column:?}").into())
        }
    }
}

/// The states on standard input: their number, then each on a line.
fn read() -> Result<Vec<Vec<f64>>> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    let mut lines = text.lines();
    let count: usize = lines
        .next()
        .ok_or("the number of states is missing")?
        .parse()?;
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split_whitespace().map(str::parse).collect())
        .collect::<std::result::Result<_, _>>()?;
    if rows.len() != count || count == 0 {
        return Err(format!("{count} states were announced, {} given", rows.len()).into());
    }
    Ok(rows)
}

/// The entries of a row, starting at an index.
fn array<const N: usize>(row: &[f64], from: usize) -> Result<[f64; N]> {
    row.get(from..from + N)
        .and_then(|part| part.try_into().ok())
        .ok_or_else(|| format!("a state of {} numbers is too short", row.len()).into())
}

/// With as many digits as read back as the same numbers.
fn numbers(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
    texts.join(" ")
}
