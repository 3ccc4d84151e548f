use bryant::command::gradient::slopes::difference;

#[test]
fn differences_are_of_second_order_and_keep_to_bounds() {
    // they are exact for a parabola except for rounding: 4 ε of its size over the step
    let slope_at = |x: f64, bounds: [Option<f64>; 2]| {
        let at = |by: f64| {
            let x = x + by;
            let inside =
                bounds[0].is_none_or(|min| x >= min) && bounds[1].is_none_or(|max| x <= max);
            assert!(inside, "{x}");
            Ok(vec![3.0 * x * x - x])
        };
        difference(at, x, 1e-3, bounds).unwrap()[0]
    };
    for (x, bounds) in [
        (0.5, [None, None]),
        (0.5, [Some(0.0), Some(1.0)]),
        (0.0, [Some(0.0), Some(1.0)]),
        (1.0, [Some(0.0), Some(1.0)]),
        (0.9995, [Some(0.0), Some(1.0)]),
    ] {
        let found = slope_at(x, bounds);
        assert!(
            (found - (6.0 * x - 1.0)).abs() < 16.0 * f64::EPSILON / 1e-3,
            "{x}: {found}"
        );
    }
}
