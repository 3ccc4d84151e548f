//! What curves of loading and unloading must be for the loops to close, as inequalities of their factors.

use super::{Curve, Extrapolate, Interpolate, ScaledCurve};

/// Straight pieces by which a smooth piece of a curve is looked at.
const PIECES: u32 = 16;

/// A slope equal to the steepest, reckoned otherwise, may be less by rounding.
const ROUNDING: f64 = 1e-12;

/// The slopes of a curve that a line must be at least as steep as, whatever factor the curve is scaled by: the steepest up and, for
/// negative factors, down.
pub fn steepest(curve: &Curve) -> Vec<f64> {
    let drawn = drawn(curve, 1.0);
    let slope = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
    let slopes = || drawn.points.windows(2).map(slope);
    let (up, down) = (slopes().fold(0.0, f64::max), slopes().fold(0.0, f64::min));
    let steep = [up, down].into_iter().filter(|slope| *slope != 0.0);
    steep.map(|slope| slope * (1.0 - ROUNDING)).collect()
}

/// The pairs \[a, b\] by which the curve of unloading lies nowhere from 0 on above that of loading: where a · times of loading ≥ b · times
/// of unloading for each. Curves whose stretches are different expressions of parameters are compared as they are without.
pub fn above(upper: (&Curve, &ScaledCurve), lower: (&Curve, &ScaledCurve)) -> Vec<[f64; 2]> {
    let stretches = [upper, lower].map(|(_, scaled)| scaled.stretch.constant());
    // where both are stretched alike, the comparison is that of the curves themselves
    let [u, f] = match stretches {
        [Some(u), Some(f)] => [drawn(upper.0, u), drawn(lower.0, f)],
        _ => [drawn(upper.0, 1.0), drawn(lower.0, 1.0)],
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
    pairs.push(pair(1e3 * (end + 1.0), 1e3));
    binding(pairs)
}

/// Of inequalities a x ≥ b y those that the others follow from: the outermost two, where all of them leave a wedge.
fn binding(pairs: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut by_angle: Vec<(f64, [f64; 2])> = pairs
        .into_iter()
        .filter(|pair| *pair != [0.0, 0.0])
        .map(|[a, b]| ((-b).atan2(a), [a, b]))
        .collect();
    by_angle.sort_by(|a, b| a.0.total_cmp(&b.0));
    by_angle.dedup_by(|a, b| a.0 == b.0);
    let count = by_angle.len();
    let gap = |index: usize| {
        let next = (index + 1) % count;
        let turns = if next == 0 { std::f64::consts::TAU } else { 0.0 };
        by_angle[next].0 + turns - by_angle[index].0
    };
    match (0..count).find(|index| count > 2 && gap(*index) > std::f64::consts::PI) {
        Some(index) => vec![by_angle[(index + 1) % count].1, by_angle[index].1],
        None => by_angle.into_iter().map(|(_, pair)| pair).collect(),
    }
}

/// A curve with its abscissae stretched, smooth pieces as straight ones.
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

/// The value of a curve of straight pieces; beyond its points the outermost where it must not be left.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Number;

    fn curve(points: &[[f64; 2]], extrapolate: Extrapolate) -> Curve {
        let (name, points) = (String::new(), points.to_vec());
        Curve {
            name,
            points,
            interpolate: Interpolate::Linear,
            extrapolate,
            told: true,
        }
    }

    /// Whether u, scaled, keeps at or below f.
    fn below(u: (&Curve, f64), f: (&Curve, f64)) -> bool {
        let scaled = |times: f64| ScaledCurve {
            curve: 0,
            times: times.into(),
            stretch: Number::Constant(1.0),
        };
        let pairs = above((u.0, &scaled(u.1)), (f.0, &scaled(f.1)));
        pairs.iter().all(|[a, b]| a * f.1 >= b * u.1)
    }

    #[test]
    fn curves_are_compared_wherever_either_has_a_kink() {
        let f = curve(&[[0.0, 0.0], [2.0, 2.0]], Extrapolate::Linear);
        let u = curve(&[[0.0, 0.0], [1.0, 0.2], [1.5, 1.4]], Extrapolate::Hold);
        assert!(below((&u, 1.0), (&f, 1.0)));
        // 1.2 · 1.4 = 1.68 at 1.5
        assert!(!below((&u, 1.2), (&f, 1.0)));
        assert!(below((&u, 1.2), (&f, 1.2)));
        // held at 2 while the other goes on with 2.4 per unit
        let u = curve(&[[0.0, 0.0], [1.5, 1.4], [1.6, 1.6]], Extrapolate::Linear);
        assert!(!below((&u, 1.0), (&f, 1.0)));
        let u = curve(&[[1.9, 0.0], [2.0, 0.2]], Extrapolate::Linear);
        assert!(!below((&u, 1.0), (&f, 1.0)));
    }

    #[test]
    fn few_inequalities_are_left_of_many() {
        let parabola = |k: f64| [k, k * k];
        let f: Vec<[f64; 2]> = (0..50).map(|k| parabola(f64::from(k))).collect();
        let u: Vec<[f64; 2]> = f.iter().map(|[x, y]| [*x, 0.5 * y]).collect();
        let [f, u] = [f, u].map(|points| curve(&points, Extrapolate::Hold));
        let one = ScaledCurve {
            curve: 0,
            times: 1.0.into(),
            stretch: 1.0.into(),
        };
        let pairs = above((&u, &one), (&f, &one));
        assert!(pairs.len() <= 3, "{pairs:?}");
        assert!(below((&u, 2.0), (&f, 1.0)));
        assert!(!below((&u, 2.000001), (&f, 1.0)));
        assert!(!below((&u, 1.0), (&f, -1.0)));
    }

    #[test]
    fn the_steepest_slopes_are_up_and_down() {
        let f = curve(&[[0.0, 0.0], [2.0, 2.0], [3.0, -1.0]], Extrapolate::Hold);
        let close = |a: f64, b: f64| (a - b).abs() <= 2.0 * ROUNDING * b.abs();
        let slopes = steepest(&f);
        assert!(close(slopes[0], 1.0) && close(slopes[1], -3.0));
    }

    #[test]
    fn a_held_curve_keeps_its_outermost_value() {
        let f = curve(&[[1.0, 1.0], [2.0, 3.0]], Extrapolate::Hold);
        assert_eq!(
            [0.0, 1.5, 2.0, 9.0].map(|x| value(&f, x)),
            [1.0, 2.0, 3.0, 3.0]
        );
        let f = curve(&[[1.0, 1.0], [2.0, 3.0]], Extrapolate::Linear);
        assert_eq!([0.0, 3.0].map(|x| value(&f, x)), [-1.0, 5.0]);
    }
}
