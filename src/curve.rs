//! Curves of a model at plain numbers: y(x) = y_k + s_k (x − x_k) for x_k ≤ x < x_{k+1}, its slope, inverse and integrals.
//!
//! A compiled model has its curves as constants of fixed length (`bryant_runtime::curve`); here they come from the model
//! as read, with the same rules at the points and beyond the outermost ones.

use bryant_generator::model::{Curve, Extrapolate};

/// Value at `x`; NaN outside the points of a curve that must not be left.
pub fn value(curve: &Curve, x: f64) -> f64 {
    if forbidden(curve, x) {
        return f64::NAN;
    }
    let piece = piece(curve, x);
    let [x_k, y_k] = curve.points[piece.saturating_sub(1)];
    slope_of(curve, piece) * (x - x_k) + y_k
}

/// Slope at `x`, at a point that of the segment to its right; NaN outside the points of a curve that must not be left.
pub fn slope(curve: &Curve, x: f64) -> f64 {
    let last = curve.points.len() - 1;
    match curve.extrapolate {
        _ if forbidden(curve, x) || x.is_nan() => f64::NAN,
        // The last point still belongs to such a curve, what is right of it does not.
        Extrapolate::Error if x == curve.points[last][0] => segment_slope(curve, last - 1),
        _ => slope_of(curve, piece(curve, x)),
    }
}

/// The smallest abscissa on a rising segment at which the value is `y`, NaN where there is none.
pub fn inverse(curve: &Curve, y: f64) -> f64 {
    let points = &curve.points;
    let last = points.len() - 1;
    let goes_on = curve.extrapolate == Extrapolate::Linear;
    let rises = |k: usize| segment_slope(curve, k) > 0.0;
    let solve = |k: usize| points[k][0] + (y - points[k][1]) / segment_slope(curve, k);
    if goes_on && rises(0) && y < points[0][1] {
        return solve(0);
    }
    for k in (0..last).filter(|&k| rises(k)) {
        if points[k][1] <= y && y < points[k + 1][1] {
            return solve(k);
        }
    }
    let [x_last, y_last] = points[last];
    match rises(last - 1) {
        true if y == y_last => x_last,
        true if goes_on && y > y_last => solve(last - 1),
        _ => f64::NAN,
    }
}

/// ∫ y dx from 0 to `x`.
pub fn integral(curve: &Curve, x: f64) -> f64 {
    integrals(curve, x)[0]
}

/// ∬ y dx dx from 0 to `x`: the displacement of what starts at rest with the curve as its acceleration.
pub fn double_integral(curve: &Curve, x: f64) -> f64 {
    integrals(curve, x)[1]
}

/// First and second integral from 0 to `x`, exactly, piece by piece: over a piece from a of length h with the slope s
/// they grow by y_a h + s h²/2 and I_a h + y_a h²/2 + s h³/6.
fn integrals(curve: &Curve, x: f64) -> [f64; 2] {
    if x.is_nan() {
        return [f64::NAN; 2];
    }
    let between = |point: &f64| *point > x.min(0.0) && *point < x.max(0.0);
    let mut ends: Vec<f64> = curve.points.iter().map(|p| p[0]).filter(between).collect();
    if x < 0.0 {
        ends.reverse();
    }
    ends.push(x);
    let (mut a, mut first, mut second) = (0.0, 0.0, 0.0);
    for b in ends {
        let (h, middle) = (b - a, 0.5 * (a + b));
        if forbidden(curve, middle) {
            return [f64::NAN; 2];
        }
        let (y, s) = (value(curve, a), slope_of(curve, piece(curve, middle)));
        second += h * (first + h * (y / 2.0 + h * s / 6.0));
        first += h * (y + h * s / 2.0);
        a = b;
    }
    [first, second]
}

/// True where the curve has no value.
fn forbidden(curve: &Curve, x: f64) -> bool {
    let outside = x < curve.points[0][0] || x > curve.points[curve.points.len() - 1][0];
    curve.extrapolate == Extrapolate::Error && outside
}

/// Piece 0 lies left of the first point, piece k + 1 right of point k.
fn piece(curve: &Curve, x: f64) -> usize {
    curve.points.partition_point(|point| point[0] <= x)
}

fn slope_of(curve: &Curve, piece: usize) -> f64 {
    let last = curve.points.len() - 1;
    let outer = piece == 0 || piece > last;
    match curve.extrapolate {
        Extrapolate::Hold | Extrapolate::Error if outer => 0.0,
        _ => segment_slope(curve, piece.clamp(1, last) - 1),
    }
}

/// Slope of the segment from point `k` to the next.
fn segment_slope(curve: &Curve, k: usize) -> f64 {
    let [[x0, y0], [x1, y1]] = [curve.points[k], curve.points[k + 1]];
    (y1 - y0) / (x1 - x0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(extrapolate: Extrapolate) -> Curve {
        Curve {
            name: "webbing".into(),
            points: vec![[0.0, 0.0], [1.0, 2.0], [3.0, 3.0]],
            extrapolate,
        }
    }

    #[test]
    fn interpolates_and_extrapolates_as_told() {
        let at = |extrapolate, x| value(&curve(extrapolate), x);
        assert_eq!(at(Extrapolate::Linear, 0.5), 1.0);
        assert_eq!(at(Extrapolate::Linear, 2.0), 2.5);
        assert_eq!(at(Extrapolate::Linear, -1.0), -2.0);
        assert_eq!(at(Extrapolate::Linear, 5.0), 4.0);
        assert_eq!(at(Extrapolate::Hold, 5.0), 3.0);
        assert_eq!(at(Extrapolate::Hold, -5.0), 0.0);
        assert!(at(Extrapolate::Error, 3.1).is_nan());
        assert_eq!(at(Extrapolate::Error, 3.0), 3.0);
        assert!(at(Extrapolate::Linear, f64::NAN).is_nan());
    }

    #[test]
    fn inverse_undoes_value() {
        let curve = curve(Extrapolate::Linear);
        for x in [-0.5, 0.0, 0.25, 1.0, 1.75, 3.0, 4.5] {
            assert!((inverse(&curve, value(&curve, x)) - x).abs() <= 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn inverse_is_nowhere_beyond_a_held_curve() {
        let curve = curve(Extrapolate::Hold);
        assert_eq!(inverse(&curve, 3.0), 3.0);
        assert!(inverse(&curve, 3.1).is_nan());
        assert!(inverse(&curve, -0.1).is_nan());
    }

    #[test]
    fn integrals_are_those_of_the_polygon() {
        // Areas under (0,0) (1,2) (3,3): 1, then 5; to the left of 0 the first line goes on, or the value 0 stays.
        let linear = curve(Extrapolate::Linear);
        assert_eq!(integral(&linear, 1.0), 1.0);
        assert_eq!(integral(&linear, 3.0), 6.0);
        assert_eq!(integral(&linear, -1.0), 1.0);
        assert_eq!(integral(&curve(Extrapolate::Hold), -1.0), 0.0);
        assert_eq!(integral(&curve(Extrapolate::Hold), 4.0), 9.0);
        // x³/3 on the first segment; from there 1/3 + h + h² + h³/12.
        assert!((double_integral(&linear, 1.0) - 1.0 / 3.0).abs() < 1e-15);
        assert!((double_integral(&linear, 3.0) - 7.0).abs() < 1e-14);
        assert!((double_integral(&linear, -1.0) + 1.0 / 3.0).abs() < 1e-15);
        assert!(integral(&curve(Extrapolate::Error), 4.0).is_nan());
    }

    #[test]
    fn slope_is_of_the_segment_to_the_right() {
        assert_eq!(slope(&curve(Extrapolate::Linear), 0.5), 2.0);
        assert_eq!(slope(&curve(Extrapolate::Linear), 1.0), 0.5);
        assert_eq!(slope(&curve(Extrapolate::Hold), 3.0), 0.0);
        assert_eq!(slope(&curve(Extrapolate::Error), 3.0), 0.5);
        assert!(slope(&curve(Extrapolate::Error), 3.5).is_nan());
    }
}
