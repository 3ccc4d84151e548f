//! Outputs over time as the page reads them: the rows of the table, and as many samples between them as the eye needs.

use super::short;
use crate::table::Column;
use bryant_runtime::response::{Response, reduce};
use serde_json::{Value, json};

/// A curve between two points that the page has may be off by this share of its range: less than a pixel of a plot.
const SHARE: f64 = 1e-3;
/// The page has at most this many points between rows, of all outputs: some hundred kilobytes.
const MOST_BETWEEN: usize = 20_000;

/// Equidistant samples of an output.
#[derive(Clone, Copy)]
pub struct Samples<'a> {
    /// In a unit of the output.
    pub values: &'a [f64],
    /// By this factor they are in the unit of the column.
    pub factor: f64,
    /// \[s\]
    pub start: f64,
    /// \[s\]
    pub every: f64,
}

impl Samples<'_> {
    fn value(&self, index: usize) -> f64 {
        self.factor * self.values[index]
    }

    fn time(&self, index: usize) -> f64 {
        self.start + index as f64 * self.every
    }

    /// The smallest and the largest value with their times \[s\]; null if there is none.
    fn extremes(&self) -> [Value; 2] {
        let read = |response| reduce(response, self.values, self.every, &mut []);
        let both = [
            (Response::Minimum, Response::TimeOfMinimum),
            (Response::Peak, Response::TimeOfPeak),
        ];
        both.map(|(value, time)| {
            let (value, time) = (self.factor * read(value), self.start + read(time));
            match value.is_finite() && time.is_finite() {
                true => json!([value, time]),
                false => Value::Null,
            }
        })
    }
}

/// A sample between two rows.
struct Point {
    index: usize,
    /// How far the curve would be off without it, as a share of the range of the curve; never more than that of a sample that was found before.
    share: f64,
}

/// The outputs, each with its rows and what lies between them. `times` are those of the rows \[s\]; there are samples of a run that reached its end.
pub fn curves(times: &[f64], outputs: &[(&Column, Option<Samples<'_>>)]) -> Vec<Value> {
    let mut found: Vec<Vec<Point>> = outputs
        .iter()
        .map(|(column, samples)| match samples {
            Some(samples) => between(times, &column.values, samples),
            None => Vec::new(),
        })
        .collect();
    let mut shares: Vec<f64> = found.iter().flatten().map(|point| point.share).collect();
    if shares.len() > MOST_BETWEEN {
        shares.sort_unstable_by(|a, b| b.total_cmp(a));
        let least = shares[MOST_BETWEEN];
        for points in &mut found {
            points.retain(|point| point.share > least);
        }
    }
    let each = outputs
        .iter()
        .zip(found)
        .map(|((column, samples), points)| {
            let mut curve = json!({
                "name": column.name,
                "unit": column.unit,
                "values": column.values.iter().map(|value| short(*value)).collect::<Vec<_>>(),
            });
            if let Some(samples) = samples {
                let [smallest, largest] = samples.extremes();
                curve["smallest"] = smallest;
                curve["largest"] = largest;
                let mut indices: Vec<usize> = points.iter().map(|point| point.index).collect();
                indices.sort_unstable();
                let time = |index: &usize| short(samples.time(*index));
                let value = |index: &usize| short(samples.value(*index));
                curve["between"] = json!({
                    "times": indices.iter().map(time).collect::<Vec<_>>(),
                    "values": indices.iter().map(value).collect::<Vec<_>>(),
                });
            }
            curve
        });
    each.collect()
}

/// The samples between rows without which the curve would be off, and its smallest and largest sample (Ramer 1972, Douglas and Peucker 1973).
fn between(times: &[f64], values: &[f64], samples: &Samples<'_>) -> Vec<Point> {
    let all = || (0..samples.values.len()).map(|k| samples.value(k));
    let finite = || all().filter(|v| v.is_finite());
    let [low, high] = [
        finite().fold(f64::INFINITY, f64::min),
        finite().fold(f64::NEG_INFINITY, f64::max),
    ];
    if samples.every <= 0.0 || high <= low {
        return Vec::new();
    }
    let index = |time: f64| (time - samples.start) / samples.every;
    let mut points = Vec::new();
    // two points of the curve, as indices and values, with the share of the sample that they were found for
    let mut parts: Vec<[(f64, f64); 2]> = Vec::new();
    let mut shares = Vec::new();
    for (t, v) in times.windows(2).zip(values.windows(2)) {
        parts.push([(index(t[0]), v[0]), (index(t[1]), v[1])]);
        shares.push(f64::INFINITY);
        while let (Some([a, b]), Some(above)) = (parts.pop(), shares.pop()) {
            let first = (a.0 + 1e-6).floor() as usize + 1;
            let end = ((b.0 - 1e-6).ceil() as usize).min(samples.values.len());
            let off = |k: usize| {
                let line = a.1 + (b.1 - a.1) * (k as f64 - a.0) / (b.0 - a.0);
                (samples.value(k) - line).abs() / (high - low)
            };
            let far = (first..end)
                .map(|k| (k, off(k)))
                .filter(|(_, off)| *off > SHARE);
            if let Some((k, off)) = far.max_by(|a, b| a.1.total_cmp(&b.1)) {
                let share = above.min(off);
                points.push(Point { index: k, share });
                let middle = (k as f64, samples.value(k));
                parts.extend([[a, middle], [middle, b]]);
                shares.extend([share; 2]);
            }
        }
    }
    for extreme in [low, high] {
        // a row may have it
        if values.contains(&extreme) {
            continue;
        }
        let Some(at) = all().position(|v| v == extreme) else {
            continue;
        };
        match points.iter_mut().find(|point| point.index == at) {
            Some(point) => point.share = f64::INFINITY,
            None => points.push(Point {
                index: at,
                share: f64::INFINITY,
            }),
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::{MOST_BETWEEN, Samples, curves};
    use crate::table::Column;
    use serde_json::Value;

    const EVERY: f64 = 1e-4;

    /// A curve with rows every 10 ms and samples every 0.1 ms, over 1 s.
    fn of(curve: impl Fn(f64) -> f64, count: usize) -> Value {
        let times: Vec<f64> = (0..=100).map(|row| 1e-2 * f64::from(row)).collect();
        let column = Column {
            name: "one".into(),
            unit: "N".into(),
            values: times.iter().map(|t| curve(*t)).collect(),
        };
        let samples: Vec<f64> = (0..=10_000).map(|k| curve(EVERY * f64::from(k))).collect();
        let samples = Samples {
            values: &samples,
            factor: 1.0,
            start: 0.0,
            every: EVERY,
        };
        curves(&times, &vec![(&column, Some(samples)); count]).into()
    }

    /// Times and values of all points of a curve.
    fn points(curve: &Value) -> Vec<(f64, f64)> {
        let numbers = |list: &Value| -> Vec<f64> {
            let list = list.as_array().unwrap().iter();
            list.map(|x| x.as_f64().unwrap()).collect()
        };
        let rows = numbers(&curve["values"]).into_iter().enumerate();
        let mut points: Vec<(f64, f64)> = rows.map(|(row, v)| (1e-2 * row as f64, v)).collect();
        let between = &curve["between"];
        points.extend(
            numbers(&between["times"])
                .into_iter()
                .zip(numbers(&between["values"])),
        );
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    /// A blow of 2 ms between two rows, over slow waves.
    fn blow(t: f64) -> f64 {
        let x: f64 = (t - 0.4537) / 1e-3;
        (9.0 * t).sin() + 20.0 * (1.0 - x * x).max(0.0).powi(2)
    }

    #[test]
    fn a_peak_between_rows_is_in_the_curve() {
        let curve = &of(blow, 1)[0];
        let points = points(curve);
        let highest = points.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        // numbers have six digits
        let peak = 20.0 + (9.0f64 * 0.4537).sin();
        assert!(
            (highest.1 - peak).abs() < 1e-4 && (highest.0 - 0.4537).abs() < EVERY,
            "{highest:?}"
        );
        assert!((curve["largest"][0].as_f64().unwrap() - peak).abs() < 1e-4);
        assert!((curve["largest"][1].as_f64().unwrap() - 0.4537).abs() < EVERY);
    }

    /// The column is in kilonewtons, its samples are in newtons.
    #[test]
    fn samples_are_in_the_unit_of_their_column() {
        let times = [0.0, 0.01];
        let column = Column {
            name: "one".into(),
            unit: "kN".into(),
            values: vec![1.0, 1.0],
        };
        let samples = Samples {
            values: &[1000.0, 1000.0, 5000.0, 1000.0, 1000.0],
            factor: 1e-3,
            start: 0.0,
            every: 0.0025,
        };
        let curve = &curves(&times, &[(&column, Some(samples))])[0];
        assert_eq!(curve["largest"][0], 5.0);
        assert!(points(curve).contains(&(0.005, 5.0)), "{curve}");
    }

    #[test]
    fn a_curve_is_nowhere_off_and_is_short() {
        let points = points(&of(blow, 1)[0]);
        assert!(points.len() < 200, "{}", points.len());
        for k in 0..=10_000 {
            let t = EVERY * f64::from(k);
            let after = points.partition_point(|(time, _)| *time < t).max(1);
            let [(a, x), (b, y)] = [points[after - 1], points[after]];
            let line = x + (y - x) * (t - a) / (b - a);
            // the range is 22
            assert!(
                (line - blow(t)).abs() < 1.1e-3 * 22.0,
                "{t} {line} {}",
                blow(t)
            );
        }
    }

    #[test]
    fn many_restless_curves_keep_the_largest_points_only() {
        // every sample is far from its neighbours
        let noise = |t: f64| {
            (1.7e5 * t).sin()
                * if (t - 0.1234).abs() < 0.5 * EVERY {
                    9.0
                } else {
                    1.0
                }
        };
        let all = of(noise, 10);
        let count = |curve: &Value| curve["between"]["times"].as_array().unwrap().len();
        let counts: Vec<usize> = all.as_array().unwrap().iter().map(count).collect();
        assert!(counts.iter().sum::<usize>() <= MOST_BETWEEN, "{counts:?}");
        let largest = all[9]["largest"][0].as_f64().unwrap();
        assert!(
            points(&all[9])
                .iter()
                .any(|(_, v)| (v - largest).abs() < 1e-4 * largest)
        );
    }
}
