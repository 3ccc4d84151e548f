//! Recordings as CSV: a column of times in seconds, then a column for each channel. Headings are names such as `head
//! acceleration [m/s^2]`.

use crate::recording::text_of;
use crate::{Channel, ReadError, Recording, Signal, unit};
use bryant_table::{Fault, Heading, Table};
use std::path::Path;

/// A column of a table over its times, which may be at any intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name, the heading without the unit.
    pub name: String,
    /// Its unit as it is written; empty if there is none.
    pub unit: String,
    /// The numbers; NaN for an empty cell.
    pub values: Vec<f64>,
}

/// Reads a table, with fields between `,`, `;` or tabs, as in the tables of curves. An empty cell is a missing sample.
///
/// # Errors
/// The file cannot be read, a cell is not a number, a line has too many or too few fields, or times are not at equal
/// intervals.
pub fn read(path: &Path) -> Result<Recording, ReadError> {
    let Columns {
        times,
        line,
        columns,
    } = columns(path)?;
    let mut channels = Vec::new();
    for Column { name, unit, values } in columns {
        let signal = Signal::of_samples(&times, &values).ok_or_else(|| {
            ReadError::content(
                path,
                line + 1,
                "times must be two or more, at equal intervals: write the run with `--every`, or sample the test evenly",
            )
        })?;
        channels.push(Channel {
            name,
            unit,
            ..Channel::of(signal)
        });
    }
    Ok(Recording {
        channels,
        damaged: Vec::new(),
    })
}

/// A table over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// The times \[s\], in their order in the file.
    pub times: Vec<f64>,
    /// The line of the headings, from 1 on.
    pub line: u64,
    /// The other columns.
    pub columns: Vec<Column>,
}

/// Reads a table as [`read`] does, at any times.
///
/// # Errors
/// The file cannot be read, a cell is not a number, or a line has too many or too few fields.
pub fn columns(path: &Path) -> Result<Columns, ReadError> {
    let text = text_of(path).map_err(|error| ReadError::io(path, error))?;
    let wrong = |fault: Fault| ReadError::fault(path, &fault);
    let table = Table::of(&text).map_err(wrong)?;
    let table = table.ok_or_else(|| ReadError::content(path, 1, "the table is empty"))?;
    let headings = table.headings(&|text| unit::quantity(text).is_some());
    let time = headings[0];
    let line = time.field.line as u64;
    let scale = match time.unit {
        Some(unit) => unit::factor(unit, "s"),
        None => time.name.eq_ignore_ascii_case("time").then_some(1.0),
    };
    let scale = scale.ok_or_else(|| {
        let message = "the first column must be the time, with its unit: `time [s]` or `time [ms]`";
        ReadError::content(path, line, message)
    })?;
    let mut columns = vec![Vec::new(); headings.len()];
    for row in table.rows(true) {
        for (column, field) in columns.iter_mut().zip(row.map_err(wrong)?) {
            column.push(field.number().map_err(wrong)?.unwrap_or(f64::NAN));
        }
    }
    let mut columns = columns.into_iter();
    let times = columns.next().unwrap_or_default();
    let named = headings.iter().skip(1).zip(columns);
    // an empty column is due to a separator at the end of every line
    let named = named.filter(|(heading, column)| {
        !(heading.field.text.is_empty() && column.iter().all(|x: &f64| x.is_nan()))
    });
    let column = |(heading, values): (&Heading<'_>, Vec<f64>)| Column {
        name: heading.name.to_owned(),
        unit: heading.unit.unwrap_or_default().to_owned(),
        values,
    };
    Ok(Columns {
        times: times.iter().map(|t| t * scale).collect(),
        line,
        columns: named.map(column).collect(),
    })
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

    /// The same numbers with other separators, in other units, and as other programs write the time.
    #[test]
    fn separators_and_units_of_headings_are_honoured() {
        let expected = table("time [s],a [g]\n0.000,1.5\n0.001,-2\n0.002,0\n").unwrap();
        for text in [
            "time [ms];a [g]\n0;1.5\n1;-2\n2;0\n",
            "\u{feff}time [ms]\ta [g]\r\n0\t1.5\r\n1\t-2\r\n2\t0\r\n",
            "# from a program\nTime,a (g)\n0,1.5\n\n0.001,-2\n0.002,0\n",
            "t [ms],a/g\n0,1.5\n1,-2\n2,0\n",
            "Zeit/ms;\"a [g]\";\n0;1.5;\n1;-2;\n2;0;\n",
        ] {
            let found = table(text).unwrap();
            assert_eq!(found.channels.len(), 1, "{text}");
            let (found, expected) = (&found.channels[0], &expected.channels[0]);
            assert_eq!(
                (&found.name, &found.unit),
                (&expected.name, &expected.unit),
                "{text}"
            );
            assert_eq!(found.signal.values, expected.signal.values, "{text}");
            assert!(
                (found.signal.interval / expected.signal.interval - 1.0).abs() < 1e-12,
                "{text}"
            );
        }
    }

    #[test]
    fn what_is_no_table_of_times_is_refused_at_its_line() {
        for (text, told) in [
            (
                "force [N],x\n0,1\n",
                "run.csv:1: the first column must be the time",
            ),
            ("time [s],x\n0,1\n0.1,a\n", "run.csv:3: \"a\" is no number"),
            ("time [s],x\n0,1\n0.1,1\n0.3,1\n", "equal intervals"),
            ("time [s],x\n0,1\n0.1\n", "run.csv:3: this line has 1 field"),
            (
                "time [s],x\n0,1\n0,1,1,5\n",
                "run.csv:3: this line has 4 fields",
            ),
            ("time [s];x\n0,0;1\n0,1;1,5\n", "comma is a decimal mark"),
            (
                "time [N],x\n0,1\n1,2\n",
                "run.csv:1: the first column must be the time",
            ),
            (
                "t,x\n0,1\n1,2\n",
                "run.csv:1: the first column must be the time",
            ),
            ("", "run.csv:1"),
        ] {
            let error = table(text).unwrap_err();
            assert!(error.contains(told), "{text:?}: {error}");
        }
    }
}
