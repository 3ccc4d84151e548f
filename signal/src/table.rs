//! Recordings as CSV: a column of times in seconds, then a column for each channel, with names such as `head acceleration [m/s^2]`.

use crate::recording::bytes_of;
use crate::{Channel, ReadError, Recording, Signal};
use std::path::Path;

/// Reads a table. An empty cell is a sample that is missing.
///
/// # Errors
/// The file cannot be read, a cell is not a number, or times are not at equal intervals.
pub fn read(path: &Path) -> Result<Recording, ReadError> {
    let bytes = bytes_of(path)?;
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let broken = |error: &csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        ReadError::content(path, line, format!("this is no table of CSV: {error}"))
    };
    let names: Vec<String> = match reader.headers() {
        Ok(names) => names.iter().map(str::to_owned).collect(),
        Err(error) => return Err(broken(&error)),
    };
    let scale = match names.first().map(|name| name_and_unit(name)) {
        Some((_, "ms")) => 1e-3,
        Some((name, unit))
            if unit == "s" || name.eq_ignore_ascii_case("time") && unit.is_empty() =>
        {
            1.0
        }
        _ => {
            return Err(ReadError::content(
                path,
                1,
                "the first column must be the time: `time [s]` or `time [ms]`",
            ));
        }
    };
    let mut columns = vec![Vec::new(); names.len()];
    for record in reader.records() {
        let record = record.map_err(|error| broken(&error))?;
        let line = record.position().map_or(1, csv::Position::line);
        for ((column, cell), name) in columns.iter_mut().zip(&record).zip(&names) {
            let cell = cell.trim();
            let number = match cell {
                "" => Ok(f64::NAN),
                _ => cell.parse::<f64>(),
            };
            column.push(number.map_err(|_| {
                ReadError::content(
                    path,
                    line,
                    format!("`{cell}` in the column `{name}` is no number"),
                )
            })?);
        }
    }
    let times: Vec<f64> = columns[0].iter().map(|t| t * scale).collect();
    let mut channels = Vec::new();
    for (name, column) in names.iter().zip(&columns).skip(1) {
        let signal = Signal::of_samples(&times, column).ok_or_else(|| {
            ReadError::content(
                path,
                2,
                "times must be two or more, at equal intervals: write the run with `--every`, or sample the test evenly",
            )
        })?;
        let (name, unit) = name_and_unit(name);
        channels.push(Channel {
            name: name.to_owned(),
            title: String::new(),
            unit: unit.to_owned(),
            signal,
        });
    }
    Ok(Recording { channels })
}

/// The parts of `head acceleration [m/s^2]`.
fn name_and_unit(column: &str) -> (&str, &str) {
    let column = column.trim();
    let parts = column
        .strip_suffix(']')
        .and_then(|rest| rest.rsplit_once('['));
    match parts {
        Some((name, unit)) => (name.trim(), unit.trim()),
        None => (column, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::read;

    fn table(text: &str) -> Result<crate::Recording, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        std::fs::write(&path, text).unwrap();
        read(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn a_table_has_channels_with_units() {
        let read = table("time [ms],\"force, left [N]\",angle\n0,1,2\n1,,4\n").unwrap();
        let force = read.channel("force, left").unwrap();
        assert_eq!((force.unit.as_str(), force.signal.interval), ("N", 1e-3));
        assert!(force.signal.values[1].is_nan());
        assert_eq!(read.channels[1].signal.values, [2.0, 4.0]);
        assert_eq!(read.channels[1].unit, "");
    }

    #[test]
    fn what_is_no_table_of_times_is_refused_at_its_line() {
        for (text, told) in [
            (
                "force [N],x\n0,1\n",
                "run.csv:1: the first column must be the time",
            ),
            (
                "time [s],x\n0,1\n0.1,a\n",
                "run.csv:3: `a` in the column `x`",
            ),
            ("time [s],x\n0,1\n0.1,1\n0.3,1\n", "equal intervals"),
            ("time [s],x\n0,1\n0.1\n", "run.csv:3"),
            ("", "run.csv:1"),
        ] {
            let error = table(text).unwrap_err();
            assert!(error.contains(told), "{text:?}: {error}");
        }
    }
}
