use bryant_study::summary::moments::{Correlation, Moments};

#[test]
fn moments_of_whole_numbers_are_exact_far_from_zero() {
    // 0 … 100: mean 50, sample variance n(n + 1)/12 with n = 101
    let mut moments = Moments::default();
    for k in 0..=100 {
        moments.add(1e9 + f64::from(k));
    }
    assert_eq!((moments.minimum, moments.maximum), (1e9, 1e9 + 100.0));
    assert!((moments.mean() - (1e9 + 50.0)).abs() < 1e-6);
    let variance = moments.deviation().powi(2);
    // rounding of the mean, 1e9 ε, times the spread
    assert!((variance - 101.0 * 102.0 / 12.0).abs() < 1e-4, "{variance}");
    assert!(Moments::default().mean().is_nan());
}

#[test]
fn straight_lines_correlate_fully_and_constants_not_at_all() {
    let of = |line: fn(f64) -> f64| {
        let mut pairs = Correlation::default();
        for k in 0..20 {
            pairs.add(f64::from(k), line(f64::from(k)));
        }
        pairs.value()
    };
    assert!((of(|x| 3.0 + 2.0 * x) - 1.0).abs() < 1e-14);
    assert!((of(|x| 3.0 - 2.0 * x) + 1.0).abs() < 1e-14);
    assert!(of(|_| 3.0).is_nan());
}
