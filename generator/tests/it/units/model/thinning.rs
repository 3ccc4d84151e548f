use bryant_generator::model::{Curve, Extrapolate, Interpolate};

fn curve(count: u32, interpolate: Interpolate, of: impl Fn(f64) -> f64) -> Curve {
    let x = |i: u32| 1e-4 * f64::from(i) - 0.01;
    Curve {
        name: "pulse".to_owned(),
        points: (0..count).map(|i| [x(i), of(x(i))]).collect(),
        interpolate,
        extrapolate: Extrapolate::Hold,
        states_extrapolation: false,
        thinned: None,
    }
}

/// The stated error is the largest distance of a point that was left out, and it is small where the curve is smooth.
#[test]
fn a_curve_of_many_points_is_thinned_with_its_error() {
    for interpolate in [Interpolate::Linear, Interpolate::Cubic] {
        let all = curve(12_001, interpolate, |t| {
            300.0 * (30.0 * t).sin() + (3e3 * t).cos()
        });
        let thin = all.clone().with_at_most(10_000);
        let thinned = thin.thinned.unwrap();
        assert!(
            thin.points.len() <= 10_000 && thin.points.len() > 5_000,
            "{}",
            thin.points.len()
        );
        assert_eq!(thinned.points, 12_001);
        let off = |point: &[f64; 2]| (thin.value(point[0]) - point[1]).abs();
        let largest = all.points.iter().map(off).fold(0.0, f64::max);
        assert_eq!(thinned.error, largest);
        // a line over two intervals misses its middle by h² |y''|/2, |y''| ≤ 300 30² + 3e3² = 9.27e6: 0.046; then half
        // of the points would be enough. A cubic is level at its extremes, and errs by more
        let is_line = interpolate == Interpolate::Linear;
        assert!(!is_line || thinned.error < 0.047, "{}", thinned.error);
        let ends = |curve: &Curve| [curve.points[0], curve.points[curve.points.len() - 1]];
        assert_eq!(ends(&thin), ends(&all));
    }
}

/// Lines need their corners only, a step keeps both of its sides, and noise keeps its peaks within the error.
#[test]
fn corners_and_peaks_stay() {
    let roof = curve(20_001, Interpolate::Linear, |t| 1.0 - (t - 0.99).abs());
    let thin = roof.clone().with_at_most(10_000);
    assert!(thin.thinned.unwrap().error < 1e-14, "{:?}", thin.thinned);
    assert!((thin.value(0.99) - 1.0).abs() < 1e-14);
    let step =
        curve(20_001, Interpolate::Linear, |t| f64::from(t > 0.5) * 40.0).with_at_most(10_000);
    assert_eq!(step.thinned.unwrap().error, 0.0);
    let mut state = 1u64;
    let noise: Vec<f64> = (0..15_000)
        .map(|_| {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        })
        .collect();
    let mut all = curve(15_000, Interpolate::Linear, |_| 0.0);
    all.points
        .iter_mut()
        .zip(&noise)
        .for_each(|(point, noise)| point[1] = *noise);
    let thin = all.clone().with_at_most(10_000);
    let error = thin.thinned.unwrap().error;
    assert!(thin.points.len() <= 10_000 && error < 0.5, "{error}");
    let few = curve(10_000, Interpolate::Linear, |t| t);
    assert_eq!(few.clone().with_at_most(10_000), few);
}
