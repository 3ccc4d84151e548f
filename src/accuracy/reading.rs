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

#[cfg(test)]
mod tests {
    use super::*;

    type Signal<'a> = &'a dyn Fn(f64) -> f64;

    fn table(samples: usize, outputs: &[(&str, &str, Signal<'_>)]) -> Table {
        let times: Vec<f64> = (0..samples).map(|i| i as f64 * 1e-3).collect();
        let column = |(name, unit, of): &(&str, &str, Signal<'_>)| Column {
            name: name.to_string(),
            unit: unit.to_string(),
            values: times.iter().map(|t| of(*t)).collect(),
        };
        let time = column(&("time", "s", &|t| t));
        Table {
            columns: [time]
                .into_iter()
                .chain(outputs.iter().map(column))
                .collect(),
        }
    }

    #[test]
    fn peaks_are_read_whatever_their_sign() {
        let of = |scale: f64| {
            let force = move |t: f64| -scale * (3.0 - (t - 0.05) * (t - 0.05));
            table(
                101,
                &[
                    ("force", "N", &force),
                    ("noise", "N", &|_| 1e-7),
                    ("none", "m", &|_| 0.0),
                ],
            )
        };
        // an output that is always 0, or noise, has no relative error
        let readings = super::of(&of(1.0));
        assert_eq!(readings.len(), 1);
        assert_eq!(
            (readings[0].name.as_str(), readings[0].value),
            ("peak force", 3.0)
        );
        assert!((readings[0].error(&of(1.01)) - 0.01).abs() < 1e-14);
        assert_eq!(readings[0].error(&of(f64::NAN)), f64::INFINITY);
    }

    #[test]
    fn resultant_accelerations_have_a_head_injury_criterion() {
        let of = |a: f64| {
            table(
                101,
                &[("head", "m/s^2", &move |_| a), ("x", "m/s^2", &move |_| -a)],
            )
        };
        let readings = super::of(&of(500.0));
        let names: Vec<&str> = readings.iter().map(|r| r.name.as_str()).collect();
        assert_eq!(names, ["peak head", "HIC15 of head", "peak x"]);
        // 0.015 s · (a/g)^2.5
        let expected = 0.015 * (500.0f64 / 9.806_65).powf(2.5);
        assert!((readings[1].value / expected - 1.0).abs() < 1e-12);
        let error = readings[1].error(&of(505.0));
        assert!((error - (1.01f64.powf(2.5) - 1.0)).abs() < 1e-12);
    }

    /// A last sample that is nearer than the others is no whole interval.
    #[test]
    fn a_shorter_last_interval_does_not_change_the_head_injury_criterion() {
        let whole = table(101, &[("head", "m/s^2", &|t| 1e4 * t)]);
        let mut longer = whole.clone();
        for (column, last) in longer.columns.iter_mut().zip([0.1001, 1e6]) {
            column.values.push(last);
        }
        assert_eq!(super::of(&whole)[1].value, super::of(&longer)[1].value);
    }
}
