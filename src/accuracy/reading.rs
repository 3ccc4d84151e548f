//! Numbers that engineers read off a run: the largest magnitude of each output, and the head injury criterion of each
//! resultant acceleration.

use crate::table::{Column, Table};
use bryant_runtime::Response;
use bryant_runtime::response::reduce;

/// A number that is read off a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its name: "peak lap belt force", "HIC15 of head accelerometer".
    pub name: String,
    /// SI unit of the value, "" for HIC.
    pub unit: String,
    /// The value in the reference.
    pub value: f64,
    /// Index of the output in the table of a run.
    column: usize,
    response: Response,
}

/// Least size of a peak, as a share of the largest peak in the same unit; smaller ones are noise and are not read.
const NOISE: f64 = 1e-6;

/// The head injury criterion over 15 ms.
const HIC15: Response = Response::Hic { window: 15e-3 };

/// All readings of a reference whose values are not zero.
pub fn of(table: &Table) -> Vec<Reading> {
    let peak = |index: usize| value(table, index, Response::Magnitude);
    let outputs = || table.columns.iter().enumerate().skip(1);
    let largest = |unit: &str| {
        let same = outputs().filter(|(_, column)| column.unit == unit);
        same.map(|(index, _)| peak(index)).fold(0.0, f64::max)
    };
    let mut readings = Vec::new();
    for (index, column) in outputs() {
        let Column { name, unit, values } = column;
        let is_read = peak(index) > NOISE * largest(unit);
        let mut read = |name: String, unit: &str, response| {
            readings.extend(is_read.then(|| Reading {
                name,
                unit: unit.to_owned(),
                value: value(table, index, response),
                column: index,
                response,
            }));
        };
        read(format!("peak {name}"), unit, Response::Magnitude);
        // a component of an acceleration, which changes its sign, has no head injury criterion
        if unit == "m/s^2" && values.len() > 1 && values.iter().all(|a| *a >= 0.0) {
            read(format!("HIC15 of {name}"), "", HIC15);
        }
    }
    readings
}

impl Reading {
    /// The error of this reading in a run, relative to its value in the reference; infinite if the run has no such
    /// reading.
    pub fn error(&self, run: &Table) -> f64 {
        let error = (value(run, self.column, self.response) - self.value).abs() / self.value;
        if error.is_nan() { f64::INFINITY } else { error }
    }
}

/// A response of an output; NaN if there is none.
fn value(table: &Table, index: usize, response: Response) -> f64 {
    let (times, values) = (&table.columns[0].values, &table.columns[index].values);
    let every = match times[..] {
        [first, second, ..] => second - first,
        _ => 1.0,
    };
    // the last sample may be nearer to its neighbour than the others
    let equidistant = match times[..] {
        [.., before, last] if response == HIC15 && last - before < every * (1.0 - 1e-6) => {
            values.len() - 1
        }
        _ => values.len(),
    };
    let samples = &values[..equidistant];
    reduce(
        response,
        samples,
        every,
        &mut vec![0.0; response.scratch(samples.len())],
    )
}
