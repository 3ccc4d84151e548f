//! Conditions on the curves of loading and unloading under which hysteresis loops close, as inequalities of the factors
//! of the curves.

use super::curve::{Curve, Extrapolate, Interpolate, ScaledCurve};
use super::number::Number;

/// Number of straight pieces by which a smooth piece of a curve is approximated.
const PIECES: u32 = 16;

/// Curves are compared up to this many times the abscissae of their last points.
const FAR: f64 = 1e3;

/// Relative tolerance for a slope that equals the steepest one up to rounding.
pub const ROUNDING: f64 = 1e-12;

/// The slopes of a curve, the steepest up and the steepest down (for negative factors). A line must be at least as
/// steep as these, whatever the factor of the curve.
pub fn steepest(curve: &Curve) -> Vec<f64> {
    let drawn = drawn(curve, 1.0);
    let slope = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
    let slopes = || drawn.points.windows(2).map(slope);
    let (up, down) = (slopes().fold(0.0, f64::max), slopes().fold(0.0, f64::min));
    let steep = [up, down].into_iter().filter(|slope| *slope != 0.0);
    steep.map(|slope| slope * (1.0 - ROUNDING)).collect()
}

/// A curve that is 0 everywhere.
pub fn nothing() -> Curve {
    Curve {
        name: String::new(),
        points: vec![[0.0, 0.0], [1.0, 0.0]],
        interpolate: Interpolate::Linear,
        extrapolate: Extrapolate::Hold,
        states_extrapolation: true,
        thinned: None,
    }
}

/// The scaling of a curve by factors of 1.
pub fn unscaled() -> ScaledCurve {
    ScaledCurve {
        curve: 0,
        times: 1.0.into(),
        stretch: 1.0.into(),
        stiffness: false,
    }
}

/// The curve −f(−x): for x ≥ 0, the part of f below 0, rotated by 180° about the origin.
pub fn turned(curve: &Curve) -> Curve {
    let points = curve.points.iter().rev();
    Curve {
        points: points.map(|[x, y]| [-x, -y]).collect(),
        ..curve.clone()
    }
}

/// The distances by which the curve `loading` lies above the curve `unloading`, at each kink of either from
/// 0 on: none may be negative.
pub fn clearances(
    unloading: (&Curve, &ScaledCurve),
    loading: (&Curve, &ScaledCurve),
) -> Vec<Number> {
    let constant = |scaled: &ScaledCurve| scaled.stretch.constant().is_some();
    if unloading.1.stretch == loading.1.stretch || (constant(unloading.1) && constant(loading.1)) {
        let difference = |[a, b]: [f64; 2]| {
            let (of_loading, of_unloading) = (loading.1.times.clone(), unloading.1.times.clone());
            Number::difference(
                Number::product(a.into(), of_loading),
                Number::product(b.into(), of_unloading),
            )
        };
        return above(unloading, loading)
            .into_iter()
            .map(difference)
            .collect();
    }
    stretched(unloading, loading)
}

/// The same distances for curves whose stretches depend on different parameters, so that the order of their kinks may
/// change.
fn stretched(unloading: (&Curve, &ScaledCurve), loading: (&Curve, &ScaledCurve)) -> Vec<Number> {
    let [u, f] = [unloading, loading].map(|(curve, scaled)| (drawn(curve, 1.0), scaled));
    let at = |(curve, scaled): &(Curve, &ScaledCurve), x: &Number| {
        let value = polygon(curve, Number::quotient(x.clone(), scaled.stretch.clone()));
        Number::product(scaled.times.clone(), value)
    };
    let slack = |(curve, scaled): &(Curve, &ScaledCurve)| {
        let sizes = curve.points.iter().map(|point| point[1].abs());
        let size = ROUNDING * sizes.fold(0.0, f64::max);
        Number::product(size.into(), scaled.times.clone())
    };
    let slack = Number::sum(slack(&u), slack(&f));
    let mut far = Number::Constant(1.0);
    let mut places = vec![Number::ZERO];
    for (curve, scaled) in [&u, &f] {
        for point in curve.points.iter().filter(|point| point[0] > 0.0) {
            places.push(Number::product(point[0].into(), scaled.stretch.clone()));
        }
        far = Number::sum(far, places[places.len() - 1].clone());
    }
    let mut clearances: Vec<Number> = places
        .iter()
        .map(|x| Number::sum(Number::difference(at(&f, x), at(&u, x)), slack.clone()))
        .collect();
    let far = Number::product(FAR.into(), far);
    let slack = Number::product(FAR.into(), slack);
    clearances.push(Number::sum(
        Number::difference(at(&f, &far), at(&u, &far)),
        slack,
    ));
    clearances
}

/// The value of a piecewise linear curve as an expression of its abscissa. A curve that must not be left is held beyond
/// its points.
fn polygon(curve: &Curve, x: Number) -> Number {
    let points = &curve.points;
    let smaller = |a: Number, b: f64| Number::smaller(a, b.into());
    let larger = |a: Number, b: f64| Number::negative(smaller(Number::negative(a), -b));
    let x = match curve.extrapolate {
        Extrapolate::Linear => x,
        Extrapolate::Hold | Extrapolate::Error => {
            smaller(larger(x, points[0][0]), points[points.len() - 1][0])
        }
    };
    let mut value = Number::Constant(points[0][1]);
    let mut before = 0.0;
    for (k, pair) in points.windows(2).enumerate() {
        let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        let beyond = Number::difference(x.clone(), pair[0][0].into());
        let beyond = match k {
            0 => beyond,
            _ => larger(beyond, 0.0),
        };
        value = Number::sum(value, Number::product((slope - before).into(), beyond));
        before = slope;
    }
    value
}

/// Pairs \[a, b\] that express that the curve `unloading` lies nowhere above the curve `loading` from 0 on:
/// a · (times of loading) ≥ b · (times of unloading) for each pair. The stretches of the curves must be constants, or
/// the same.
pub fn above(unloading: (&Curve, &ScaledCurve), loading: (&Curve, &ScaledCurve)) -> Vec<[f64; 2]> {
    let stretches = [unloading, loading].map(|(_, scaled)| scaled.stretch.constant());
    // curves with the same stretch are compared without it
    let [u, f] = match stretches {
        [Some(u), Some(f)] => [drawn(unloading.0, u), drawn(loading.0, f)],
        _ => [drawn(unloading.0, 1.0), drawn(loading.0, 1.0)],
    };
    let size = |curve: &Curve| {
        let sizes = curve.points.iter().map(|point| point[1].abs());
        8.0 * f64::EPSILON * sizes.fold(0.0, f64::max)
    };
    let (slack_f, slack_u) = (size(&f), size(&u));
    let abscissae = |curve: &Curve| -> Vec<f64> { curve.points.iter().map(|p| p[0]).collect() };
    let mut kinks = [vec![0.0], abscissae(&u), abscissae(&f)].concat();
    kinks.retain(|x| *x >= 0.0);
    let end = kinks.iter().fold(0.0, |most: f64, x| most.max(*x));
    let pair = |x: f64, far: f64| [value(&f, x) + far * slack_f, value(&u, x) - far * slack_u];
    let mut pairs: Vec<[f64; 2]> = kinks.iter().map(|x| pair(*x, 1.0)).collect();
    pairs.push(pair(FAR * (end + 1.0), FAR));
    binding(pairs)
}

/// The inequalities a x ≥ b y from which all others follow: the outermost two if the solutions form a wedge, otherwise
/// all.
fn binding(pairs: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut by_angle: Vec<(f64, [f64; 2])> = pairs
        .into_iter()
        .filter(|pair| *pair != [0.0, 0.0])
        .map(|[a, b]| (libm::atan2(-b, a), [a, b]))
        .collect();
    by_angle.sort_by(|a, b| a.0.total_cmp(&b.0));
    by_angle.dedup_by(|a, b| a.0 == b.0);
    let count = by_angle.len();
    let gap = |index: usize| {
        let next = (index + 1) % count;
        let turns = if next == 0 {
            std::f64::consts::TAU
        } else {
            0.0
        };
        by_angle[next].0 + turns - by_angle[index].0
    };
    match (0..count).find(|index| count > 2 && gap(*index) > std::f64::consts::PI) {
        Some(index) => vec![by_angle[(index + 1) % count].1, by_angle[index].1],
        None => by_angle.into_iter().map(|(_, pair)| pair).collect(),
    }
}

/// A curve with stretched abscissae, and with smooth pieces replaced by straight ones.
fn drawn(curve: &Curve, stretch: f64) -> Curve {
    let mut drawn = Curve {
        interpolate: Interpolate::Linear,
        ..curve.clone()
    };
    if curve.interpolate == Interpolate::Cubic {
        drawn.points = vec![curve.points[0]];
        for pair in curve.points.windows(2) {
            for piece in 1..PIECES {
                let x =
                    pair[0][0] + (pair[1][0] - pair[0][0]) * f64::from(piece) / f64::from(PIECES);
                drawn.points.push([x, curve.value(x)]);
            }
            drawn.points.push(pair[1]);
        }
    }
    for point in &mut drawn.points {
        point[0] *= stretch;
    }
    drawn
}

/// The value of a piecewise linear curve. A curve that must not be left is held beyond its points.
pub fn value(curve: &Curve, x: f64) -> f64 {
    let points = &curve.points;
    let last = points.len() - 1;
    let right = points.partition_point(|p| p[0] <= x);
    if curve.extrapolate != Extrapolate::Linear && (right == 0 || right > last) {
        return points[right.saturating_sub(1).min(last)][1];
    }
    let k = right.clamp(1, last) - 1;
    let [[x0, y0], [x1, y1]] = [points[k], points[k + 1]];
    y0 + (x - x0) * (y1 - y0) / (x1 - x0)
}
