use bryant_study::summary::sample::{is_in, quantile};

#[test]
fn quantiles_lie_between_neighbours() {
    let sorted = [1.0, 2.0, 4.0];
    assert_eq!(
        [0.0, 0.25, 0.5, 0.75, 1.0].map(|s| quantile(&sorted, s)),
        [1.0, 1.5, 2.0, 3.0, 4.0]
    );
    assert!(quantile(&[], 0.5).is_nan());
}

#[test]
fn samples_have_about_as_many_rows_as_wanted() {
    // binomial: the standard deviation is below √most
    let (rows, most) = (1_000_000, 10_000);
    let found = (0..rows).filter(|row| is_in(*row, rows, most)).count() as f64;
    assert!(
        (found - most as f64).abs() < 5.0 * (most as f64).sqrt(),
        "{found}"
    );
    assert!((0..100).all(|row| is_in(row, 100, 100)));
}
