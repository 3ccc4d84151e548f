//! Curves of length 0, backward curves, curves with one point, and curves with points near the limits of floating-point
//! numbers.

use super::panics::Tried;
use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::case_model::CaseModel;
use crate::random::Random;
use bryant_generator::model::{Curve, Extrapolate};

/// Curves through random, mostly invalid points.
pub const CURVES: Case = Case {
    group: Group::Garbage,
    name: "curves of no length",
    law: "A curve is refused with its place, or it goes through its points from both sides, with finite values between them.",
    run: curves,
};

/// Allowed deviation of a curve from its points, as a share of the neighbouring ordinates; the reader of models allows
/// the same.
const TOLERANCE: f64 = 1e-9;

/// Candidates for abscissae and ordinates.
const NUMBERS: [&str; 22] = [
    "0",
    "-0.0",
    "0",
    "1",
    "1",
    "2",
    "-1",
    "5e-324",
    "1e-320",
    "1e-310",
    "1e-160",
    "1e160",
    "1e300",
    "1e308",
    "-1e308",
    "1.7e308",
    "-1.7e308",
    "1.0000000000000002",
    "0.5",
    "3",
    "nan",
    ".inf",
];

fn curves(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let count = if bench.full() { 200_000 } else { 4000 };
    let mut random = Random::new(2);
    let mut tried = Tried::default();
    let (mut refused, mut accepted) = (0, 0);
    for _ in 0..count {
        let text = written(&mut random);
        let found = tried.input(&|| text.clone(), || match scene(&text).model() {
            Err(problems) => match problems.problems.iter().all(|p| p.line > 0) {
                true => Ok(false),
                false => Err(format!("no place: {problems}")),
            },
            Ok(model) => {
                model.curves.iter().try_for_each(through_its_points)?;
                Ok(true)
            }
        });
        match found {
            Some(true) => accepted += 1,
            Some(false) => refused += 1,
            None => {}
        }
    }
    tried.note(
        bench,
        count,
        "refused, or through its points",
        "the definition of a curve",
    );
    for (what, count) in [("refused", refused), ("accepted", accepted)] {
        bench.at_least(what, f64::from(count), 100.0, "", "every outcome occurs");
    }
    Ok(())
}

/// The text of a random curve; the abscissae of half of the curves increase.
fn written(random: &mut Random) -> String {
    let number = |random: &mut Random| (*random.one_of(&NUMBERS)).to_owned();
    let length = random.below(5);
    let mut points: Vec<[String; 2]> = (0..length)
        .map(|_| [number(random), number(random)])
        .collect();
    if random.one_in(2) {
        // texts that are not numbers are sorted as 0, so they may come anywhere
        points.sort_by(|a, b| {
            let value = |text: &str| text.parse::<f64>().unwrap_or(0.0);
            value(&a[0]).total_cmp(&value(&b[0]))
        });
        points.dedup_by(|a, b| a[0] == b[0]);
    }
    let points: Vec<String> = points.iter().map(|[x, y]| format!("[{x}, {y}]")).collect();
    let unit = ["", "unit: [ms, m/s^2], ", "unit: [h, kN], "];
    let rule = |random: &mut Random, key: &str, words: &[&str]| match random.below(words.len() + 1)
    {
        0 => String::new(),
        i => format!(", {key}: {}", words[i - 1]),
    };
    format!(
        "{{ {}points: [{}]{}{} }}",
        random.one_of(&unit),
        points.join(", "),
        rule(random, "interpolate", &["linear", "cubic"]),
        rule(random, "extrapolate", &["hold", "linear", "error"]),
    )
}

/// A model with a force that follows a curve, whatever the unit of the curve.
fn scene(curve: &str) -> CaseModel {
    let force = if curve.contains("m/s^2") {
        "{ field: f, acceleration: [c, 0] }"
    } else {
        "{ load: l, on: s/e, force: [c, 0] }"
    };
    CaseModel::new(
        "curve",
        format!(
            "model: curve\ndimension: 2\ncurves:\n  c: {curve}\nsystems:\n  - name: s\n    elements: [{{ name: e, mass: 1, cg: \
             [0, 0], inertia: 1 }}]\nforces:\n  - {force}\n"
        ),
    )
}

/// Checks that a curve goes through its points: exactly where a piece begins, within rounding where a piece ends.
fn through_its_points(curve: &Curve) -> Result<(), String> {
    let last = curve.points.len() - 1;
    for (k, &[x, y]) in curve.points.iter().enumerate() {
        // only the last point of a curve without extrapolation is not the beginning of a piece
        let rounding = match curve.extrapolate == Extrapolate::Error && k == last {
            true => TOLERANCE * (y.abs() + curve.points[k - 1][1].abs()),
            false => 0.0,
        };
        let value = curve.value(x);
        if !(x.is_finite() && y.is_finite() && (value - y).abs() <= rounding) {
            return Err(format!("{value:e} at the point {x:e}, {y:e}"));
        }
    }
    for pair in curve.points.windows(2) {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        let (before, middle) = (x1.next_down(), x0 + 0.5 * (x1 - x0));
        // a monotone cubic is at most three times as steep as its secant; abscissae have rounding errors
        let slope = 3.0 * ((y1 - y0) / (x1 - x0)).abs();
        let bound = TOLERANCE * (y0.abs() + y1.abs())
            + slope
                * (2.0 * f64::EPSILON * x0.abs()
                    + 2.0 * f64::EPSILON * x1.abs()
                    + f64::from_bits(1));
        let value = curve.value(before);
        if before > x0 && (value - y1).abs() > bound {
            return Err(format!("{value:e} just before the point {x1:e}, {y1:e}"));
        }
        let value = curve.value(middle);
        if !(value >= y0.min(y1) - bound && value <= y0.max(y1) + bound) {
            return Err(format!("{value:e} between {y0:e} and {y1:e}"));
        }
    }
    let [first, last] = [curve.points[0][0], curve.points[curve.points.len() - 1][0]];
    for beyond in [first - 1.0, last + 1.0] {
        let inside = (first..=last).contains(&beyond);
        let value = curve.value(beyond);
        // a value by linear extrapolation may be infinite
        if value.is_nan() != (curve.extrapolate == Extrapolate::Error && !inside) {
            return Err(format!("{value:e} at {beyond:e}"));
        }
    }
    Ok(())
}
