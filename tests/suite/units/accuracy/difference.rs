use bryant::accuracy::difference::Difference;
use bryant::table::{Column, Table};

fn table(columns: &[(&str, &str, &[f64])]) -> Table {
    let column = |(name, unit, values): &(&str, &str, &[f64])| Column {
        name: name.to_string(),
        unit: unit.to_string(),
        values: values.to_vec(),
    };
    Table {
        columns: columns.iter().map(column).collect(),
    }
}

#[test]
fn differences_are_relative_to_the_largest_of_each_output() {
    let coarse = table(&[
        ("time", "s", &[0.0, 1.0]),
        ("force", "N", &[0.0, 101.0]),
        ("angle", "rad", &[0.5, -0.25]),
        ("noise", "N", &[1e-9, 0.0]),
    ]);
    let sharp = table(&[
        ("time", "s", &[0.0, 1.0]),
        ("force", "N", &[0.0, 100.0]),
        ("angle", "rad", &[0.5, -0.26]),
        ("noise", "N", &[0.0, 1e-9]),
    ]);
    let difference = Difference::of(&coarse, &sharp);
    for (found, expected) in difference.outputs.iter().zip([0.01, 0.02, 0.0]) {
        assert!((found - expected).abs() < 1e-15, "{difference:?}");
    }
    assert_eq!(difference.output, "angle");
    let lucky = Difference::of(&sharp, &sharp).at_least(Some(&difference), 0.1);
    assert!((lucky.worst - 0.002).abs() < 1e-15 && lucky.output == "angle");
}

#[test]
fn what_one_run_alone_has_seen_is_no_noise() {
    let hit = table(&[("time", "s", &[0.0, 1.0]), ("force", "N", &[0.0, 9.0])]);
    let miss = table(&[("time", "s", &[0.0, 1.0]), ("force", "N", &[0.0, 0.0])]);
    assert_eq!(Difference::of(&hit, &miss).worst, f64::INFINITY);
    assert_eq!(Difference::of(&miss, &hit).worst, 1.0);
    assert_eq!(Difference::of(&miss, &miss).worst, 0.0);
    let wrong = table(&[("time", "s", &[0.0, 1.0]), ("force", "N", &[0.0, f64::NAN])]);
    assert_eq!(Difference::of(&wrong, &hit).worst, f64::INFINITY);
    assert_eq!(Difference::of(&hit, &wrong).worst, f64::INFINITY);
}

#[test]
fn runs_of_different_lengths_have_nothing_in_common() {
    let long = table(&[("time", "s", &[0.0, 1.0]), ("x", "m", &[0.0, 1.0])]);
    let short = table(&[("time", "s", &[0.0]), ("x", "m", &[0.0])]);
    assert_eq!(Difference::of(&short, &long).worst, f64::INFINITY);
}
