//! Outputs over time as the page reads them: the rows of the table, and as many samples between them as the eye needs.

use super::short;
use crate::table::Column;
use bryant_generator::model::units::Unit;
use bryant_runtime::response::{Response, reduce};
use serde_json::{Value, json};

/// A curve between two points that the page has may be off by this share of its range: less than a pixel of a plot.
const SHARE: f64 = 1e-3;
/// The page has at most this many points between rows, of all outputs: some hundred kilobytes.
pub const MOST_BETWEEN: usize = 20_000;

/// Equidistant samples of an output.
#[derive(Clone, Copy)]
pub struct Samples<'a> {
    /// In SI.
    pub values: &'a [f64],
    /// \[s\]
    pub start: f64,
    /// \[s\]
    pub every: f64,
}

impl Samples<'_> {
    fn time(&self, index: usize) -> f64 {
        self.start + index as f64 * self.every
    }

    /// The smallest and the largest value in a unit, with their times \[s\]; null if there is none.
    fn extremes(&self, unit: &Unit) -> [Value; 2] {
        let read = |response| reduce(response, self.values, self.every, &mut []);
        let both = [
            (Response::Minimum, Response::TimeOfMinimum),
            (Response::Peak, Response::TimeOfPeak),
        ];
        both.map(|(value, time)| {
            let (value, time) = (read(value), self.start + read(time));
            match value.is_finite() && time.is_finite() {
                true => json!([unit.of_si(value), time]),
                false => Value::Null,
            }
        })
    }
}

/// An output over time.
pub struct Curve<'a> {
    /// Its rows, in SI.
    pub column: &'a Column,
    /// What lies between them, in SI; there are samples of a run that reached its end.
    pub samples: Option<Samples<'a>>,
    /// The unit in which it is shown.
    pub unit: &'a Unit,
}

/// A sample between two rows.
struct Point {
    index: usize,
    /// How far the curve would be off without it, as a share of the range of the curve; never more than that of a
    /// sample that was found before.
    share: f64,
}

/// The outputs in their units, each with its rows and what lies between them. `times` are those of the rows \[s\].
pub fn curves(times: &[f64], outputs: &[Curve<'_>]) -> Vec<Value> {
    let mut found: Vec<Vec<Point>> = outputs
        .iter()
        .map(|curve| match &curve.samples {
            Some(samples) => between(times, &curve.column.values, samples),
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
    let each = outputs.iter().zip(found).map(|(of, points)| {
        let Curve {
            column,
            samples,
            unit,
        } = of;
        let shown = |value: f64| short(unit.of_si(value));
        let mut curve = json!({
            "name": column.name,
            "unit": unit.name,
            "values": column.values.iter().map(|value| shown(*value)).collect::<Vec<_>>(),
        });
        if let Some(samples) = samples {
            let [smallest, largest] = samples.extremes(unit);
            curve["smallest"] = smallest;
            curve["largest"] = largest;
            let mut indices: Vec<usize> = points.iter().map(|point| point.index).collect();
            indices.sort_unstable();
            let time = |index: &usize| short(samples.time(*index));
            let value = |index: &usize| shown(samples.values[*index]);
            curve["between"] = json!({
                "times": indices.iter().map(time).collect::<Vec<_>>(),
                "values": indices.iter().map(value).collect::<Vec<_>>(),
            });
        }
        curve
    });
    each.collect()
}

/// The samples between rows without which the curve would be off, and its smallest and largest sample (Ramer 1972,
/// Douglas and Peucker 1973).
fn between(times: &[f64], values: &[f64], samples: &Samples<'_>) -> Vec<Point> {
    let finite = || samples.values.iter().copied().filter(|v| v.is_finite());
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
                (samples.values[k] - line).abs() / (high - low)
            };
            let far = (first..end)
                .map(|k| (k, off(k)))
                .filter(|(_, off)| *off > SHARE);
            if let Some((k, off)) = far.max_by(|a, b| a.1.total_cmp(&b.1)) {
                let share = above.min(off);
                points.push(Point { index: k, share });
                let middle = (k as f64, samples.values[k]);
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
        let Some(at) = samples.values.iter().position(|v| *v == extreme) else {
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
