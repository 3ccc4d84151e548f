//! Numbers that engineers read off a run, with their errors: the peak of each output and its time, and the head injury
//! criterion of each acceleration.
//!
//! The peak is the sample with the largest magnitude. Its time is that of the vertex of the parabola through this
//! sample and its two neighbours. In other runs it is searched near the time of the reference's peak: of two peaks that
//! are almost equal, rounding decides which is larger, and a change from one to the other is not an error of the time.

use super::hic::{WINDOW, hic};
use super::trajectory::Trajectory;

/// An output: its name and unit in the header of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
}

/// A number that is read off a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its name: "peak lap belt force", "HIC15 of head accelerometer".
    pub name: String,
    /// SI unit of the value, "" for HIC.
    pub unit: String,
    /// Index of the output.
    pub column: usize,
    /// The kind of reading.
    pub kind: Kind,
    /// The value in the reference.
    pub value: f64,
    /// Time of a peak in the reference \[s\]; `None` for HIC.
    pub time: Option<f64>,
}

/// The kinds of readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The sample of the largest magnitude.
    Peak,
    /// The head injury criterion over 15 ms.
    Hic,
}

/// The error of a reading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadingError {
    /// Error of the value, relative to that of the reference.
    pub value: f64,
    /// Error of the time of a peak \[s\].
    pub time: Option<f64>,
}

/// Least size of a peak, as a share of the largest peak in the same unit; smaller ones are noise and are not read.
const NOISE: f64 = 1e-6;

/// Half of the interval in which a peak is searched, as a share of the run; at least two samples.
const NEAR: f64 = 0.02;

/// All readings of a reference whose values are not zero.
pub fn of(columns: &[Column], reference: &Trajectory) -> Vec<Reading> {
    let series: Vec<Vec<f64>> = (0..columns.len()).map(|i| reference.output(i)).collect();
    let peaks: Vec<Option<usize>> = series.iter().map(|values| peak(values, |_| true)).collect();
    let height = |column: usize| peaks[column].map_or(0.0, |sample| series[column][sample].abs());
    let largest = |unit: &str| {
        let same = (0..columns.len()).filter(|&i| columns[i].unit == unit);
        same.map(height).fold(0.0, f64::max)
    };
    let mut readings = Vec::new();
    for (index, column) in columns.iter().enumerate() {
        let Some(sample) = peaks[index] else { continue };
        if height(index) <= NOISE * largest(&column.unit) {
            continue;
        }
        readings.push(Reading {
            name: format!("peak {}", column.name),
            unit: column.unit.clone(),
            column: index,
            kind: Kind::Peak,
            value: series[index][sample],
            time: Some(vertex(&reference.times, &series[index], sample)),
        });
        let resultant = series[index].iter().all(|a| *a >= 0.0);
        let value = hic(&reference.times, &series[index], WINDOW);
        if let ("m/s^2", true, Some(value)) = (column.unit.as_str(), resultant, value) {
            readings.push(Reading {
                name: format!("HIC15 of {}", column.name),
                unit: String::new(),
                column: index,
                kind: Kind::Hic,
                value,
                time: None,
            });
        }
    }
    readings
}

impl Reading {
    /// The same reading of another reference; its value is NaN if the other reference has no such reading.
    pub fn again(&self, reference: &Trajectory) -> Reading {
        let values = reference.output(self.column);
        let (value, time) = match self.kind {
            Kind::Hic => (hic(&reference.times, &values, WINDOW), None),
            Kind::Peak => match peak(&values, |_| true) {
                Some(sample) => (
                    Some(values[sample]),
                    Some(vertex(&reference.times, &values, sample)),
                ),
                None => (None, None),
            },
        };
        Reading {
            value: value.unwrap_or(f64::NAN),
            time,
            ..self.clone()
        }
    }

    /// The error of this reading in a run; infinite if the run has no such reading.
    pub fn error(&self, reference: &Trajectory, run: &Trajectory) -> ReadingError {
        let values = run.output(self.column);
        let relative = |value: f64| match ((value - self.value) / self.value).abs() {
            // two zeros are equal
            _ if value == self.value => 0.0,
            error if error.is_nan() => f64::INFINITY,
            error => error,
        };
        let whole = values.len() >= reference.times.len();
        match self.kind {
            Kind::Hic => ReadingError {
                value: hic(&run.times, &values, WINDOW)
                    .filter(|_| whole)
                    .map_or(f64::INFINITY, relative),
                time: None,
            },
            Kind::Peak => ReadingError {
                value: peak(&values, |_| true)
                    .filter(|_| whole)
                    .map_or(f64::INFINITY, |sample| {
                        // a peak with the opposite sign is another peak of the same size
                        relative(values[sample].abs() * self.value.signum())
                    }),
                time: self.time.and_then(|time| {
                    let reach = self.reach(reference);
                    let near = |i: usize| (run.times[i] - time).abs() <= reach;
                    let sample = peak(&values, near)?;
                    Some((vertex(&run.times, &values, sample) - time).abs())
                }),
            },
        }
    }

    /// Half of the interval around the time of the reference's peak in which a peak is searched \[s\].
    fn reach(&self, reference: &Trajectory) -> f64 {
        let times = &reference.times;
        let (first, last) = (times.first(), times.last());
        let duration = last.zip(first).map_or(0.0, |(last, first)| last - first);
        let widest = times
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .fold(0.0, f64::max);
        (NEAR * duration).max(2.5 * widest)
    }
}

/// The index of the sample with the largest magnitude, among some samples; `None` if there are none, or one is not
/// finite.
fn peak(values: &[f64], among: impl Fn(usize) -> bool) -> Option<usize> {
    let mut best: Option<usize> = None;
    for (i, value) in values.iter().enumerate().filter(|(i, _)| among(*i)) {
        if !value.is_finite() {
            return None;
        }
        if best.is_none_or(|best| value.abs() > values[best].abs()) {
            best = Some(i);
        }
    }
    best
}

/// Abscissa of the vertex of the parabola through a sample and its neighbours, limited to the interval between these.
/// For the first and the last sample, and if there is no peak between the neighbours, the abscissa of the sample
/// itself.
fn vertex(times: &[f64], values: &[f64], sample: usize) -> f64 {
    let inner = sample > 0 && sample + 1 < values.len().min(times.len());
    if !inner {
        return times[sample];
    }
    let [t0, t1, t2] = [sample - 1, sample, sample + 1].map(|i| times[i]);
    let [y0, y1, y2] = [sample - 1, sample, sample + 1].map(|i| values[i]);
    let (left, right) = ((y1 - y0) / (t1 - t0), (y2 - y1) / (t2 - t1));
    let curvature = right - left;
    if curvature == 0.0 || !curvature.is_finite() {
        return t1;
    }
    // the slope is `left` in the middle of the first interval, and `right` in the middle of the second
    let (a, b) = (0.5 * (t0 + t1), 0.5 * (t1 + t2));
    (a - left * (b - a) / curvature).clamp(t0, t2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(list: &[(&str, &str)]) -> Vec<Column> {
        list.iter()
            .map(|(name, unit)| Column {
                name: name.to_string(),
                unit: unit.to_string(),
            })
            .collect()
    }

    fn sampled(every: f64, samples: usize, outputs: &dyn Fn(f64) -> Vec<f64>) -> Trajectory {
        let times: Vec<f64> = (0..samples).map(|i| i as f64 * every).collect();
        Trajectory {
            outputs: times.iter().map(|t| outputs(*t)).collect(),
            states: times.iter().map(|_| Vec::new()).collect(),
            times,
        }
    }

    #[test]
    fn peaks_are_read_with_their_time() {
        // a parabola is met exactly
        let reference = sampled(0.1, 11, &|t| vec![3.0 - (t - 0.43).powi(2), 0.0]);
        let columns = columns(&[("force", "N"), ("chin force", "N")]);
        let readings = of(&columns, &reference);
        // An output that is always 0 has no relative error.
        assert_eq!(readings.len(), 1);
        assert_eq!(readings[0].name, "peak force");
        assert!((readings[0].time.unwrap() - 0.43).abs() < 1e-12);
        assert!((readings[0].value - (3.0 - 0.03f64.powi(2))).abs() < 1e-15);

        let run = sampled(0.1, 11, &|t| vec![1.01 * (3.0 - (t - 0.45).powi(2)), 0.0]);
        let error = readings[0].error(&reference, &run);
        assert!((error.time.unwrap() - 0.02).abs() < 1e-12, "{error:?}");
        let expected = (1.01 * (3.0 - 0.05f64.powi(2)) / readings[0].value - 1.0).abs();
        assert!((error.value - expected).abs() < 1e-14);
    }

    #[test]
    fn of_two_equal_peaks_the_one_of_the_reference_is_timed() {
        let swing = |amplitudes: [f64; 2]| {
            move |t: f64| {
                let amplitude = if t < 1.0 {
                    amplitudes[0]
                } else {
                    amplitudes[1]
                };
                vec![amplitude * (std::f64::consts::PI * t).sin()]
            }
        };
        let reference = sampled(0.02, 101, &swing([1.001, 1.0]));
        let readings = of(&columns(&[("x", "m")]), &reference);
        let run = sampled(0.02, 101, &swing([1.0, 1.002]));
        let error = readings[0].error(&reference, &run);
        // In the run the second peak, of the opposite sign, is the larger one.
        assert!((error.value - 0.001 / 1.001).abs() < 1e-12, "{error:?}");
        assert!(error.time.unwrap() < 1e-12, "{error:?}");
    }

    #[test]
    fn accelerations_have_a_head_injury_criterion() {
        let columns = columns(&[("head accelerometer", "m/s^2"), ("x acceleration", "m/s^2")]);
        let reference = sampled(1e-3, 101, &|_| vec![500.0, -500.0]);
        let readings = of(&columns, &reference);
        let names: Vec<&str> = readings.iter().map(|r| r.name.as_str()).collect();
        // A component of an acceleration has no HIC.
        assert_eq!(
            names,
            [
                "peak head accelerometer",
                "HIC15 of head accelerometer",
                "peak x acceleration"
            ]
        );
        let run = sampled(1e-3, 101, &|_| vec![505.0, -500.0]);
        let error = readings[1].error(&reference, &run).value;
        assert!((error - (1.01f64.powf(2.5) - 1.0)).abs() < 1e-12);
        // A run that broke off has no readings.
        let broken = sampled(1e-3, 50, &|_| vec![500.0, -500.0]);
        assert_eq!(readings[0].error(&reference, &broken).value, f64::INFINITY);
        assert_eq!(readings[1].error(&reference, &broken).value, f64::INFINITY);
    }
}
