use bryant::accuracy::reading;
use bryant::table::{Column, Table};

type Signal<'a> = &'a dyn Fn(f64) -> f64;

fn table(samples: usize, outputs: &[(&str, &str, Signal<'_>)]) -> Table {
    let times: Vec<f64> = (0..samples).map(|i| i as f64 * 1e-3).collect();
    let column = |(name, unit, of): &(&str, &str, Signal<'_>)| Column {
        name: name.to_string(),
        unit: unit.to_string(),
        values: times.iter().map(|t| of(*t)).collect(),
    };
    let time = column(&("time", "s", &|t| t));
    Table {
        columns: [time]
            .into_iter()
            .chain(outputs.iter().map(column))
            .collect(),
    }
}

#[test]
fn peaks_are_read_whatever_their_sign() {
    let of = |scale: f64| {
        let force = move |t: f64| -scale * (3.0 - (t - 0.05) * (t - 0.05));
        table(
            101,
            &[
                ("force", "N", &force),
                ("noise", "N", &|_| 1e-7),
                ("none", "m", &|_| 0.0),
            ],
        )
    };
    // an output that is always 0, or noise, has no relative error
    let readings = reading::of(&of(1.0));
    assert_eq!(readings.len(), 1);
    assert_eq!(
        (readings[0].name.as_str(), readings[0].value),
        ("peak force", 3.0)
    );
    assert!((readings[0].error(&of(1.01)) - 0.01).abs() < 1e-14);
    assert_eq!(readings[0].error(&of(f64::NAN)), f64::INFINITY);
}

#[test]
fn resultant_accelerations_have_a_head_injury_criterion() {
    let of = |a: f64| {
        table(
            101,
            &[("head", "m/s^2", &move |_| a), ("x", "m/s^2", &move |_| -a)],
        )
    };
    let readings = reading::of(&of(500.0));
    let names: Vec<&str> = readings.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["peak head", "HIC15 of head", "peak x"]);
    // 0.015 s · (a/g)^2.5
    let expected = 0.015 * (500.0f64 / 9.806_65).powf(2.5);
    assert!((readings[1].value / expected - 1.0).abs() < 1e-12);
    let error = readings[1].error(&of(505.0));
    assert!((error - (1.01f64.powf(2.5) - 1.0)).abs() < 1e-12);
}

/// A last sample that is nearer than the others is no whole interval.
#[test]
fn a_shorter_last_interval_does_not_change_the_head_injury_criterion() {
    let whole = table(101, &[("head", "m/s^2", &|t| 1e4 * t)]);
    let mut longer = whole.clone();
    for (column, last) in longer.columns.iter_mut().zip([0.1001, 1e6]) {
        column.values.push(last);
    }
    assert_eq!(reading::of(&whole)[1].value, reading::of(&longer)[1].value);
}
