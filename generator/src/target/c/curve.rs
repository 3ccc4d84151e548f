//! Curves as constant arrays of points, slopes, coefficients and integrals.
//!
//! Slopes, coefficients and integrals are computed as the runtime computes them (`bryant_runtime::curve`), so that
//! values have the same bits.

use super::number;
use crate::model::Extrapolate;
use crate::program::Curve;
use std::fmt::Write as _;

/// All numbers that are computed from the points of a curve. There is one more piece than points: piece 0 lies left of
/// the first point, piece k + 1 right of point k.
struct Pieces {
    /// Slope at the left end of each piece.
    m: Vec<f64>,
    /// Quadratic and cubic coefficients of each piece; `None` for lines.
    higher: Option<[Vec<f64>; 2]>,
    /// At each point, the integral from the first point. `twice` has the double integral.
    once: Vec<f64>,
    twice: Vec<f64>,
    /// The abscissae at which the curve is not smooth.
    kinks: Vec<f64>,
}

/// The C definition of a curve: its arrays, and a structure named `name` that points to them.
pub(super) fn define(curve: &Curve, name: &str) -> String {
    let pieces = match &curve.tangents {
        None => lines(curve),
        Some(tangents) => cubics(curve, tangents),
    };
    let column = |k: usize| {
        curve
            .points
            .iter()
            .map(|point| point[k])
            .collect::<Vec<_>>()
    };
    let mut arrays = vec![("x", column(0)), ("y", column(1)), ("m", pieces.m)];
    let smooth = pieces.higher.is_some();
    if let Some([second, third]) = pieces.higher {
        arrays.extend([("c2", second), ("c3", third)]);
    }
    arrays.extend([("once", pieces.once), ("twice", pieces.twice)]);
    let kinks = pieces.kinks.len();
    if kinks > 0 {
        arrays.push(("kink", pieces.kinks));
    }
    let mut text = format!("/* {} */\n", super::comment(&curve.name));
    for (part, values) in &arrays {
        let values: Vec<String> = values.iter().map(|value| number(*value)).collect();
        let values = values.join(", ");
        let _ = writeln!(text, "static const double {name}_{part}[] = {{{values}}};");
    }
    let higher = match smooth {
        true => format!("{name}_c2, {name}_c3"),
        false => "NULL, NULL".to_owned(),
    };
    let kink = match kinks {
        0 => "NULL".to_owned(),
        _ => format!("{name}_kink"),
    };
    let points = curve.points.len();
    let bounded = u8::from(curve.extrapolate == Extrapolate::Error);
    let goes_on = u8::from(curve.extrapolate == Extrapolate::Linear);
    let _ = writeln!(
        text,
        "static const struct bryant_curve {name} = {{{points}, {bounded}, {goes_on}, {name}_x, {name}_y, {name}_m, {higher}, \
         {name}_once, {name}_twice, {kinks}, {kink}}};\n"
    );
    text
}

fn lines(curve: &Curve) -> Pieces {
    let points = &curve.points;
    let slope = |k: usize| (points[k + 1][1] - points[k][1]) / (points[k + 1][0] - points[k][0]);
    let slopes: Vec<f64> = (0..points.len() - 1).map(slope).collect();
    let (mut once, mut twice) = (vec![0.0], vec![0.0]);
    for k in 0..points.len() - 1 {
        let run = points[k + 1][0] - points[k][0];
        let [y, next] = [points[k][1], points[k + 1][1]];
        twice.push(twice[k] + run * (once[k] + run * (2.0 * y + next) / 6.0));
        once.push(once[k] + run * (y + next) / 2.0);
    }
    let goes_on = curve.extrapolate == Extrapolate::Linear;
    let (first, last) = (slopes[0], slopes[slopes.len() - 1]);
    let beyond = |slope: f64| if goes_on { slope } else { 0.0 };
    let held = curve.extrapolate == Extrapolate::Hold;
    let kinked = |k: usize| match k {
        0 => held && first != 0.0,
        _ if k == slopes.len() => held && last != 0.0,
        _ => {
            let rounding = rounding(points[k - 1], points[k]) + rounding(points[k], points[k + 1]);
            (slopes[k] - slopes[k - 1]).abs() > rounding
        }
    };
    let kinks = (0..points.len()).filter(|k| kinked(*k));
    let kinks = kinks.map(|k| points[k][0]).collect();
    Pieces {
        kinks,
        m: [&[beyond(first)], &slopes[..], &[beyond(last)]].concat(),
        higher: None,
        once,
        twice,
    }
}

fn cubics(curve: &Curve, tangents: &[f64]) -> Pieces {
    let points = &curve.points;
    let count = points.len();
    let mut coefficients = Vec::new();
    let (mut once, mut twice) = (vec![0.0], vec![0.0]);
    for k in 0..count - 1 {
        let ([x, y], [next_x, next_y]) = (points[k], points[k + 1]);
        let (m, next_m) = (tangents[k], tangents[k + 1]);
        let h = next_x - x;
        let secant = (next_y - y) / h;
        let c2 = (3.0 * secant - 2.0 * m - next_m) / h;
        let c3 = (m + next_m - 2.0 * secant) / (h * h);
        coefficients.push([m, c2, c3]);
        let (first, second) = (once[k], twice[k]);
        once.push(first + h * (y + h * (m / 2.0 + h * (c2 / 3.0 + h * c3 / 4.0))));
        twice.push(
            second + h * (first + h * (y / 2.0 + h * (m / 6.0 + h * (c2 / 12.0 + h * c3 / 20.0)))),
        );
    }
    let kinks = cubic_kinks(curve, tangents, &coefficients);
    let [m, c2, c3] = coefficients[count - 2];
    let h = points[count - 1][0] - points[count - 2][0];
    let (before, after) = match curve.extrapolate {
        Extrapolate::Linear => (tangents[0], [tangents[count - 1], 0.0, 0.0]),
        Extrapolate::Hold => (0.0, [0.0; 3]),
        // the last point still belongs to the curve, with the slope and second derivative of the last piece
        Extrapolate::Error => {
            let end = m + h * (2.0 * c2 + 3.0 * h * c3);
            (0.0, [end, c2 + 3.0 * h * c3, 0.0])
        }
    };
    coefficients.insert(0, [before, 0.0, 0.0]);
    coefficients.push(after);
    let column = |k: usize| coefficients.iter().map(|piece| piece[k]).collect();
    Pieces {
        m: column(0),
        higher: Some([column(1), column(2)]),
        once,
        twice,
        kinks,
    }
}

/// The points at which the second derivative changes, and the ends of a held curve if the slope changes there.
fn cubic_kinks(curve: &Curve, tangents: &[f64], coefficients: &[[f64; 3]]) -> Vec<f64> {
    let points = &curve.points;
    let mut kinks = Vec::new();
    // of the piece left of each point: the second derivative at its right end, and a bound of the rounding error of
    // that
    let (mut bend, mut off) = (0.0, 0.0);
    for (k, &[x, _]) in points.iter().enumerate() {
        let m = tangents[k];
        let (mut next, mut next_off, mut next_bend, mut end) = (0.0, 0.0, 0.0, true);
        if let Some(&[_, c2, c3]) = coefficients.get(k) {
            let h = points[k + 1][0] - x;
            next = 2.0 * c2;
            next_bend = next + 6.0 * c3 * h;
            let slopes = m.abs() + tangents[k + 1].abs();
            next_off =
                (16.0 * rounding(points[k], points[k + 1]) + 16.0 * f64::EPSILON * slopes) / h;
            end = k == 0;
        }
        let jumps = (next - bend).abs() > off + next_off;
        let kinked = match curve.extrapolate {
            Extrapolate::Error => jumps && !end,
            Extrapolate::Linear => jumps,
            Extrapolate::Hold => jumps || (end && m != 0.0),
        };
        if kinked {
            kinks.push(x);
        }
        (bend, off) = (next_bend, next_off);
    }
    kinks
}

/// A bound of the error in the slope of a line through two points, due to the rounding of their coordinates.
fn rounding([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
    let run = x1 - x0;
    let slope = ((y1 - y0) / run).abs();
    4.0 * f64::EPSILON * (y0.abs() + y1.abs() + slope * (x0.abs() + x1.abs())) / run
}
