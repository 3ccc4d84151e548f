use bryant::report::curves::MOST_BETWEEN;
use bryant::report::{Curve, Samples, curves};
use bryant::table::Column;
use bryant_generator::model::units::UnitSystem;
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
        start: 0.0,
        every: EVERY,
    };
    let unit = UnitSystem::Si.unit("N");
    let curve = || Curve {
        column: &column,
        samples: Some(samples),
        unit: &unit,
    };
    curves(
        &times,
        &std::iter::repeat_with(curve)
            .take(count)
            .collect::<Vec<_>>(),
    )
    .into()
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
