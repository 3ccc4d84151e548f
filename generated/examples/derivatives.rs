//! Evaluates the derivative of a bundled model on request, so that an integrator in another language can check a run.
//!
//! ```text
//! cargo run -p bryant-generated --example derivatives -- child-seat
//! ```
//!
//! Each line on standard input is a request, and each line on standard output is its answer. Units are SI; numbers are
//! written with the fewest digits that read back exactly.
//!
//! | request | answer |
//! |---|---|
//! | `names` | names of the entries of the state, separated by tabs |
//! | `outputs` | names of the outputs, separated by tabs |
//! | `digest` | the digest of the model |
//! | `start` | the state at the start of a run |
//! | `breakpoints` | times at which a curve of time has a kink, increasing |
//! | `rate T Y…` | ẏ at time T and state Y |
//! | `output T Y…` | the outputs there |
//!
//! A model with memory is refused: memory changes between steps, which this program does not know.

use bryant_runtime::Section;
use bryant_runtime::program::Entry;
use std::error::Error;
use std::io::{BufRead, Write};

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args()
        .nth(1)
        .ok_or("which model? Give the name of a bundled one")?;
    let bundled = bryant_generated::find(&name)
        .ok_or_else(|| format!("there is no bundled model {name:?}"))?;
    if !bundled.entry.info.memory.is_empty() {
        return Err(format!("{name} remembers what only its own steps renew").into());
    }
    let mut output = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        writeln!(output, "{}", answer(&bundled.entry, &line?)?)?;
        output.flush()?;
    }
    Ok(())
}

fn answer(entry: &Entry, line: &str) -> Result<String, Box<dyn Error>> {
    let info = entry.info;
    let (request, rest) = line.split_once(' ').unwrap_or((line, ""));
    let evaluated = |section: Option<Section>| -> Result<String, Box<dyn Error>> {
        let given: Vec<f64> = rest
            .split_whitespace()
            .map(str::parse)
            .collect::<Result<_, _>>()?;
        let (t, y) = given
            .split_first()
            .ok_or("a time and a state are missing")?;
        let result = match section {
            Some(section) => entry.section(section, &[], *t, y),
            None => {
                let mut rates = vec![f64::NAN; info.kinds.len()];
                let done = entry.derivative(&[], *t, y, &mut rates);
                done.map(|()| rates)
            }
        };
        Ok(numbers(&result.map_err(|error| error.message)?))
    };
    let size = info.kinds.len();
    match request {
        "names" => {
            let names: Vec<&str> = (0..size).filter_map(|i| info.state_name(i)).collect();
            Ok(names.join("\t"))
        }
        "outputs" => {
            let names: Vec<&str> = info.outputs.iter().map(|output| output.name).collect();
            Ok(names.join("\t"))
        }
        "digest" => Ok(info.digest.to_owned()),
        "start" => Ok(numbers(
            &entry.initial_state(&[]).map_err(|error| error.message)?,
        )),
        "breakpoints" => Ok(numbers(&breakpoints(entry)?)),
        "rate" => evaluated(None),
        "output" => evaluated(Some(Section::Outputs)),
        _ => Err(format!("no request {request:?}").into()),
    }
}

/// The breakpoints known in advance, and those whose times depend on parameters, within a run.
fn breakpoints(entry: &Entry) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut times = entry.info.breakpoints.to_vec();
    let mut t = 0.0;
    while t < entry.info.duration {
        t = entry.kink_after(&[], t).map_err(|error| error.message)?;
        times.push(t);
    }
    times.retain(|t| 0.0 < *t && *t < entry.info.duration);
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}

fn numbers(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    texts.join(" ")
}
