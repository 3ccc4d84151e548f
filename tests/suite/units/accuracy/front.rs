use bryant::accuracy::front::{Cost, cheapest, digits, pareto, slope};

fn cost(error: f64, time: f64) -> Cost {
    Cost { error, time }
}

#[test]
fn the_front_is_what_nothing_beats() {
    let points = [
        cost(1e-2, 1.0),
        cost(1e-3, 2.0),
        // slower and less accurate than the one before
        cost(2e-3, 2.5),
        // as accurate as the second, and slower
        cost(1e-3, 3.0),
        // as fast as the first, and less accurate
        cost(5e-2, 1.0),
        cost(0.0, 10.0),
        cost(f64::NAN, 0.1),
        cost(f64::INFINITY, 0.2),
    ];
    assert_eq!(pareto(&points), [0, 1, 5]);
    // By the definition, pair by pair.
    for (i, p) in points
        .iter()
        .enumerate()
        .filter(|(_, p)| p.error.is_finite())
    {
        let beaten = points.iter().any(|q| {
            q.error <= p.error && q.time <= p.time && (q.error < p.error || q.time < p.time)
        });
        assert_eq!(pareto(&points).contains(&i), !beaten, "{i}");
    }
    assert_eq!(cheapest(&points, 5e-3), Some(1));
    assert_eq!(cheapest(&points, 1e-1), Some(0));
    assert_eq!(cheapest(&points[..1], 1e-3), None);
    assert!(pareto(&[]).is_empty());
}

#[test]
fn equal_points_are_on_the_front_once() {
    let points = [cost(1e-3, 1.0), cost(1e-3, 1.0)];
    assert_eq!(pareto(&points), [0]);
}

#[test]
fn a_digit_costs_what_the_points_were_made_with() {
    // time = 2 ms · 1.6^digits, errors at random places of eight digits
    let errors = [3e-1, 7e-3, 1.1e-4, 5e-5, 4e-7, 2e-8];
    let time = |error: f64| 2e-3 * 1.6f64.powf(-error.log10());
    let points: Vec<Cost> = errors.iter().map(|&e| cost(e, time(e))).collect();
    let digits = digits(&points).unwrap();
    assert!((digits.factor - 1.6).abs() < 1e-12, "{digits:?}");
    assert!((digits.from / 3e-1 - 1.0).abs() < 1e-12 && (digits.to / 2e-8 - 1.0).abs() < 1e-12);
    assert_eq!(digits.points, 6);
}

#[test]
fn too_little_is_no_regression() {
    assert_eq!(digits(&[]), None);
    assert_eq!(digits(&[cost(1e-1, 1.0), cost(1e-5, 2.0)]), None);
    let close = [cost(1e-3, 1.0), cost(2e-3, 1.5), cost(3e-3, 2.0)];
    assert_eq!(digits(&close), None);
    // An error of 0 has no number of digits.
    assert_eq!(digits(&[cost(0.0, 1.0); 5]), None);
}

#[test]
fn the_slope_is_that_of_least_squares() {
    // (0,0) (1,2) (2,1): b = Σ(x−1)(y−1)/Σ(x−1)² = (1 + 0)/2
    let b = slope(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)]);
    assert!((b - 0.5).abs() < 1e-15);
}
