//! Inputs of a run from files: `--input NAME=FILE`.

use super::Error;
use crate::command::compare::{channel, of_file, recording};
use bryant_generator::model::{Model, Parameter};
use bryant_signal::{table, unit};
use std::path::{Path, PathBuf};

/// An input and its file.
#[derive(Clone, Debug)]
pub struct InputFile {
    name: String,
    path: PathBuf,
    /// The column, if it is named.
    column: Option<String>,
}

impl InputFile {
    /// The input.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Reads `NAME=FILE` or `NAME=FILE, COLUMN`.
pub fn input_file(text: &str) -> Result<InputFile, String> {
    let Some((name, file)) = text.split_once('=') else {
        return Err("give an input and its file, as 'torque=measured.csv'".to_owned());
    };
    let (file, column) = match file.rsplit_once(',') {
        Some((file, column)) => (file, Some(column.trim().to_owned())),
        None => (file, None),
    };
    Ok(InputFile {
        name: name.trim().to_owned(),
        path: PathBuf::from(file.trim()),
        column,
    })
}

/// Lets inputs of a model follow files from the time `start` to `end` \[s\].
///
/// # Errors
/// The model has no such input; a file cannot be read, has no such column or another quantity, does not cover the run,
/// or has a value that is missing or out of the limits of the input.
pub fn follow(model: &mut Model, files: &[InputFile], [start, end]: [f64; 2]) -> Result<(), Error> {
    for (place, file) in files.iter().enumerate() {
        let index = (model.parameters.iter())
            .position(|of| of.input && of.name == file.name)
            .ok_or_else(|| unknown(model, &file.name))?;
        if files[..place].iter().any(|other| other.name == file.name) {
            return Err(Error::Input(format!(
                "the input \"{}\" is given twice",
                file.name
            )));
        }
        let points = points(file, &model.parameters[index], [start, end])?;
        model.set_over_time(index, points);
    }
    Ok(())
}

fn unknown(model: &Model, name: &str) -> Error {
    let inputs = model.parameters.iter().filter(|of| of.input);
    let names: Vec<&str> = inputs.map(|of| of.name.as_str()).collect();
    let help = match names.is_empty() {
        true => "it has none: write it under `inputs:` in place of `parameters:`".to_owned(),
        false => format!("there are: {}", names.join(", ")),
    };
    Error::Input(format!("the model has no input \"{name}\"\n  help: {help}"))
}

/// The points of an input over time \[s; SI\].
fn points(file: &InputFile, input: &Parameter, run: [f64; 2]) -> Result<Vec<[f64; 2]>, Error> {
    let (path, name) = (&file.path, &input.name);
    let wrong =
        |message: String| Error::Input(format!("--input {name}: {}: {message}", path.display()));
    let (times, column) = samples(file, name)?;
    let factor = match column.unit.as_str() {
        "" => Some(1.0),
        of => unit::factor(of, &input.unit),
    };
    let factor = factor.ok_or_else(|| {
        let (found, needed) = (&column.unit, &input.unit);
        wrong(format!(
            "\"{}\" is in `{found}`, and the input in `{needed}`",
            column.name
        ))
    })?;
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(times.len());
    for (t, value) in times.into_iter().zip(column.values) {
        let value = value * factor;
        if !(t.is_finite() && value.is_finite()) {
            return Err(wrong(format!("there is no number at {t} s")));
        }
        if points.last().is_some_and(|[before, _]| *before >= t) {
            return Err(wrong(format!("the times do not increase at {t} s")));
        }
        let [min, max] = [
            input.min.unwrap_or(f64::NEG_INFINITY),
            input.max.unwrap_or(f64::INFINITY),
        ];
        if !(min..=max).contains(&value) {
            let unit = &input.unit;
            return Err(wrong(format!(
                "{value} {unit} at {t} s is out of the limits of the input, {min} to {max}"
            )));
        }
        points.push([t, value]);
    }
    let ([[first, _], ..], [.., [last, _]]) = (&points[..], &points[..]) else {
        return Err(wrong("it has no rows".to_owned()));
    };
    if points.len() < 2 || *first > run[0] || *last < run[1] {
        return Err(wrong(format!(
            "it goes from {first} s to {last} s, and the run from {} s to {} s\n  help: give a longer file, or a shorter --duration",
            run[0], run[1]
        )));
    }
    Ok(points)
}

/// The times \[s\] and the column of an input.
fn samples(file: &InputFile, name: &str) -> Result<(Vec<f64>, table::Column), Error> {
    let path = &file.path;
    let is_table = !path.is_dir() && !has_ending(path, "mme");
    if !is_table {
        let recording = recording(path)?;
        let wanted = file.column.as_deref().unwrap_or(name);
        let channel = channel(&recording, path, wanted)?;
        let signal = &channel.signal;
        let times = (0..signal.values.len()).map(|index| signal.time(index));
        let column = table::Column {
            name: channel.name.clone(),
            unit: channel.unit.clone(),
            values: signal.values.clone(),
        };
        return Ok((times.collect(), column));
    }
    let table::Columns {
        times, mut columns, ..
    } = of_file(path, table::columns)?;
    let named = |name: &str| columns.iter().position(|column| column.name == name);
    let found = match &file.column {
        Some(column) => named(column),
        None => named(name).or((columns.len() == 1).then_some(0)),
    };
    match found {
        Some(index) => Ok((times, columns.swap_remove(index))),
        None => {
            let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
            let wanted = file.column.as_deref().unwrap_or(name);
            Err(Error::Input(format!(
                "--input {name}: {} has no column \"{wanted}\"\n  help: name one, --input '{name}={}, COLUMN'; there are {}",
                path.display(),
                path.display(),
                names.join(", ")
            )))
        }
    }
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension()
        .is_some_and(|of| of.eq_ignore_ascii_case(ending))
}
