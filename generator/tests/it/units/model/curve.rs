use bryant_generator::model::{Curve, Extrapolate, Interpolate};
use proptest::prelude::*;

fn curve(extrapolate: Extrapolate) -> Curve {
    Curve {
        name: "webbing".into(),
        points: vec![[0.0, 0.0], [1.0, 2.0], [3.0, 3.0]],
        interpolate: Interpolate::Linear,
        extrapolate,
        states_extrapolation: true,
        thinned: None,
    }
}

#[test]
fn interpolates_and_extrapolates_as_told() {
    let at = |extrapolate, x| curve(extrapolate).value(x);
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
        assert!((curve.inverse(curve.value(x)) - x).abs() <= 8.0 * f64::EPSILON);
    }
}

#[test]
fn inverse_is_nowhere_beyond_a_held_curve() {
    let curve = curve(Extrapolate::Hold);
    assert_eq!(curve.inverse(3.0), 3.0);
    assert!(curve.inverse(3.1).is_nan());
    assert!(curve.inverse(-0.1).is_nan());
}

#[test]
fn integrals_are_those_of_the_polygon() {
    // Areas under (0,0) (1,2) (3,3): 1, then 5; to the left of 0 the first line goes on, or the value 0 stays.
    let linear = curve(Extrapolate::Linear);
    assert_eq!(linear.integral(1.0), 1.0);
    assert_eq!(linear.integral(3.0), 6.0);
    assert_eq!(linear.integral(-1.0), 1.0);
    assert_eq!(curve(Extrapolate::Hold).integral(-1.0), 0.0);
    assert_eq!(curve(Extrapolate::Hold).integral(4.0), 9.0);
    // x³/3 on the first segment; from there 1/3 + h + h² + h³/12.
    assert!((linear.double_integral(1.0) - 1.0 / 3.0).abs() < 1e-15);
    assert!((linear.double_integral(3.0) - 7.0).abs() < 1e-14);
    assert!((linear.double_integral(-1.0) + 1.0 / 3.0).abs() < 1e-15);
    assert!(curve(Extrapolate::Error).integral(4.0).is_nan());
}

#[test]
fn slope_is_of_the_segment_to_the_right() {
    assert_eq!(curve(Extrapolate::Linear).slope(0.5), 2.0);
    assert_eq!(curve(Extrapolate::Linear).slope(1.0), 0.5);
    assert_eq!(curve(Extrapolate::Hold).slope(3.0), 0.0);
    assert_eq!(curve(Extrapolate::Error).slope(3.0), 0.5);
    assert!(curve(Extrapolate::Error).slope(3.5).is_nan());
}

fn cubic(points: &[[f64; 2]], extrapolate: Extrapolate) -> Curve {
    Curve {
        name: "smooth".into(),
        points: points.to_vec(),
        interpolate: Interpolate::Cubic,
        extrapolate,
        states_extrapolation: true,
        thinned: None,
    }
}

#[test]
fn slopes_of_cubics_are_weighted_harmonic_means() {
    let points = [
        [0.0, 0.0],
        [0.5, 0.1],
        [1.2, 2.0],
        [2.0, 2.5],
        [3.5, 1.0],
        [4.0, 0.8],
    ];
    // secants 1/5, 19/7, 5/8, −1, −2/5 over lengths 0.5, 0.7, 0.8, 1.5, 0.5; at the left end the parabola falls where
    // the piece rises, at the right end it does not
    let slopes = [
        0.0,
        3.6 / (1.9 * 5.0 + 1.7 * 7.0 / 19.0),
        4.5 / (2.3 * 7.0 / 19.0 + 2.2 * 8.0 / 5.0),
        0.0,
        -6.0 / (2.5 + 3.5 * 5.0 / 2.0),
        -0.25,
    ];
    // ∫ of a piece is h (y₀ + y₁)/2 + h² (m₀ − m₁)/12
    let area = |k: usize| {
        let ([x0, y0], [x1, y1]) = (points[k], points[k + 1]);
        let h = x1 - x0;
        h * (y0 + y1) / 2.0 + h * h * (slopes[k] - slopes[k + 1]) / 12.0
    };
    let areas: f64 = (0..5).map(area).sum();
    for extrapolate in [Extrapolate::Error, Extrapolate::Linear] {
        let curve = cubic(&points, extrapolate);
        for (k, expected) in slopes.iter().enumerate() {
            // a dozen roundings
            assert!(
                (curve.tangent(k) - expected).abs() <= 12.0 * f64::EPSILON,
                "{k}"
            );
            assert!(
                (curve.slope(points[k][0]) - expected).abs() <= 64.0 * f64::EPSILON,
                "{k}"
            );
            assert!((curve.value(points[k][0]) - points[k][1]).abs() <= 16.0 * f64::EPSILON);
        }
        assert!((curve.integral(4.0) - areas).abs() <= 64.0 * f64::EPSILON);
    }
    let held = cubic(&points, Extrapolate::Hold);
    assert_eq!([held.tangent(0), held.tangent(5)], [0.0, 0.0]);
    assert!((held.tangent(1) - slopes[1]).abs() <= 1e-8);
}

#[test]
fn inverse_undoes_a_rising_cubic() {
    let points = [[0.0, 0.0], [0.5, 0.1], [1.2, 2.0], [2.0, 2.5]];
    let curve = cubic(&points, Extrapolate::Linear);
    for k in -8..=40 {
        let x = f64::from(k) / 16.0;
        // where the curve is flat, a rounding of the ordinate moves the abscissa far
        let bound = 16.0 * f64::EPSILON * (1.0 + 3.0 / curve.slope(x));
        let back = curve.inverse(curve.value(x));
        assert!((back - x).abs() <= bound, "{x}: {back}");
    }
    assert!(cubic(&points, Extrapolate::Hold).inverse(2.6).is_nan());
    // level at the end: half of the digits
    let end = cubic(&points, Extrapolate::Hold).inverse(2.5);
    assert!((end - 2.0).abs() <= 4.0 * f64::EPSILON.sqrt(), "{end}");
}

proptest! {
    #[test]
    fn cubics_keep_to_their_points(
        steps in proptest::collection::vec((0.01..3.0f64, -5.0..5.0f64), 2..12),
        hold in proptest::bool::ANY,
        monotone in proptest::bool::ANY,
    ) {
        let mut points = vec![[-1.3, 0.7]];
        for (h, rise) in steps {
            let [x, y] = points[points.len() - 1];
            points.push([x + h, y + if monotone { rise.abs() } else { rise }]);
        }
        let extrapolate = if hold { Extrapolate::Hold } else { Extrapolate::Linear };
        let curve = cubic(&points, extrapolate);
        for pair in points.windows(2) {
            let ([a, y], [b, next]) = (pair[0], pair[1]);
            let h = b - a;
            let at = |i: i32| a + h * f64::from(i) / 32.0;
            // s, its powers and the coefficients each err by a few ε
            let rounding = 64.0 * f64::EPSILON * (y.abs() + next.abs() + 1.0);
            for i in 0..32 {
                let (low, high) = (curve.value(at(i)), curve.value(at(i + 1)));
                prop_assert!((high - low) * (next - y).signum() >= -rounding, "{pair:?} at {i}");
            }
            // the slope has no jump at the points, seen from the left
            let steep = 1.0 + (next - y).abs() / h;
            let left = curve.slope(b.next_down());
            let bound = 64.0 * f64::EPSILON * steep * (1.0 + b.abs() / h);
            prop_assert!((left - curve.slope(b)).abs() <= bound, "{left} at {b}");
        }
        let first = points[0][0];
        prop_assert_eq!(curve.slope(first - 1.0), curve.slope(first));
    }

    #[test]
    fn integrals_are_those_of_quadrature(
        steps in proptest::collection::vec((0.1..2.0f64, -3.0..3.0f64), 2..8),
        x in -6.0..9.0f64,
        smooth in proptest::bool::ANY,
    ) {
        let mut points = vec![[-2.0, 0.5]];
        for (h, rise) in steps {
            let [x, y] = points[points.len() - 1];
            points.push([x + h, y + rise]);
        }
        let mut curve = cubic(&points, Extrapolate::Linear);
        if !smooth {
            curve.interpolate = Interpolate::Linear;
        }
        // Boole's rule is exact up to degree 5 on a piece; the double integral is ∫ (x − τ) y(τ) dτ, of degree 4
        let mut ends: Vec<f64> = points.iter().map(|p| p[0]).filter(|p| *p > x.min(0.0) && *p < x.max(0.0)).collect();
        ends.extend([0.0, x]);
        ends.sort_by(f64::total_cmp);
        let (mut once, mut twice) = (0.0, 0.0);
        for pair in ends.windows(2) {
            let h = pair[1] - pair[0];
            for (i, weight) in [7.0, 32.0, 12.0, 32.0, 7.0].iter().enumerate() {
                let at = pair[0] + h * i as f64 / 4.0;
                let part = x.signum() * weight / 90.0 * h * curve.value(at);
                once += part;
                twice += (x - at) * part;
            }
        }
        // a hundred roundings of ordinates below 100 over lengths below 10
        let bound = 100.0 * f64::EPSILON * 100.0 * 10.0;
        prop_assert!((curve.integral(x) - once).abs() <= bound);
        prop_assert!((curve.double_integral(x) - twice).abs() <= 10.0 * bound);
    }
}
