//! Curves whose length is not known to the compiler.

use bryant_runtime::curve::Table;
use bryant_runtime::curve::{Cubic, Curve, Extrapolate};
use bryant_runtime::{Dual, Real};

const POINTS: [[f64; 2]; 12] = {
    let mut points = [[0.0; 2]; 12];
    let mut k = 0;
    while k < 12 {
        let x = k as f64;
        points[k] = [
            0.3 * x - 1.0,
            if k % 3 == 0 {
                0.7 * x
            } else {
                1.1 - x * x / 7.0
            },
        ];
        k += 1;
    }
    points
};

fn same(one: f64, other: f64) {
    assert!(one.to_bits() == other.to_bits() || one.is_nan() && other.is_nan());
}

#[test]
fn a_table_has_the_bits_of_a_curve_of_known_length() {
    for extrapolate in [Extrapolate::Linear, Extrapolate::Hold, Extrapolate::Error] {
        let (curve, table) = (
            Curve::new(POINTS, extrapolate),
            Table::of_lines(&POINTS, extrapolate),
        );
        let given = POINTS.map(|[x, y]| [x, y, 0.1 * y]);
        let (cubic, cubics) = (
            Cubic::new(given, extrapolate),
            Table::of_cubics(&given, extrapolate),
        );
        for i in -40..=80 {
            let x = 0.0625 * f64::from(i) + 0.01;
            same(curve.value(x), table.value(x));
            same(curve.slope(x), table.slope(x));
            same(curve.integral(x), table.integral(x));
            same(curve.double_integral(x), table.double_integral(x));
            same(curve.inverse(x), table.inverse(x));
            same(curve.breakpoint_indicator(x), table.breakpoint_indicator(x));
            same(curve.stop(x, -0.3), table.stop(x, -0.3));
            same(curve.kink_after(0.3, x), table.kink_after(0.3, x));
            same(cubic.value(x), cubics.value(x));
            same(cubic.second_derivative(x), cubics.second_derivative(x));
            same(cubic.integral(x), cubics.integral(x));
            same(cubic.inverse(x), cubics.inverse(x));
            same(
                cubic.breakpoint_indicator(x),
                cubics.breakpoint_indicator(x),
            );
            same(cubic.stop(x, -0.3), cubics.stop(x, -0.3));
            let there = Dual::variable(x);
            same(cubic.slope(there).slope, cubics.slope(there).slope);
        }
    }
    assert!(Real::is_finite(
        Table::of_lines(&POINTS, Extrapolate::Linear).value(9.0)
    ));
}
