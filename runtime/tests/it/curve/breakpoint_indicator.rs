//! Functions that change their signs at the points of a curve.

use crate::scalars::Pair;
use bryant_runtime::Dual;
use bryant_runtime::curve::{Cubic, Curve, Extrapolate};

const POINTS: [[f64; 2]; 5] = [[-1.0, 2.0], [0.0, 0.0], [0.5, 0.0], [1.0, 1.5], [2.5, 6.0]];

/// Sign and distance by search.
fn closed_form(kinks: &[f64], x: f64) -> f64 {
    let passed = kinks.iter().filter(|k| **k <= x).count();
    let distance = kinks
        .iter()
        .map(|k| (x - k).abs())
        .fold(f64::INFINITY, f64::min);
    if passed % 2 == 0 { distance } else { -distance }
}

#[test]
fn the_sign_changes_where_the_slope_does() {
    // from (0.5, 0) on the points lie on a line
    for (extrapolate, kinks) in [
        (Extrapolate::Linear, &[0.0, 0.5][..]),
        (Extrapolate::Hold, &[-1.0, 0.0, 0.5, 2.5]),
        (Extrapolate::Error, &[0.0, 0.5]),
    ] {
        let curve = Curve::new(POINTS, extrapolate);
        for i in -80..=120 {
            // binary fractions: every operation is exact
            let x = f64::from(i) / 16.0;
            assert_eq!(
                curve.breakpoint_indicator(x),
                closed_form(kinks, x),
                "{extrapolate:?} at {x}"
            );
        }
        assert!(curve.breakpoint_indicator(f64::NAN).is_nan());
        let lanes = curve.breakpoint_indicator(Pair([-4.0, 0.75]));
        assert_eq!(
            lanes,
            Pair([
                curve.breakpoint_indicator(-4.0),
                curve.breakpoint_indicator(0.75)
            ])
        );
    }
}

#[test]
fn lines_have_no_kink() {
    let line = [
        [0.0, 0.0],
        [0.1, 0.1 * 3e4],
        [0.3, 0.3 * 3e4],
        [0.7, 0.7 * 3e4],
    ];
    let curve = Curve::new(line, Extrapolate::Linear);
    assert_eq!(
        [
            curve.breakpoint_indicator(-1.0),
            curve.breakpoint_indicator(0.2),
            curve.breakpoint_indicator(9.0)
        ],
        [1.0; 3]
    );
    let smooth = line.map(|[x, y]| [x, y, 3e4]);
    assert_eq!(
        Cubic::new(smooth, Extrapolate::Linear).breakpoint_indicator(0.2),
        1.0
    );
    // a held curve has kinks at both ends
    assert_eq!(
        Curve::new(line, Extrapolate::Hold).breakpoint_indicator(0.25),
        -0.25
    );
}

#[test]
fn of_cubics_the_bend_counts() {
    // x³ with its slopes: one polynomial. At 2 a line continues differently, at 0 it does not: slope and second
    // derivative are 0 there
    let cube = [[0.0, 0.0, 0.0], [1.0, 1.0, 3.0], [2.0, 8.0, 12.0]];
    let curve = Cubic::new(cube, Extrapolate::Linear);
    for x in [-3.0, 0.5, 1.0, 1.5, 2.0, 4.0] {
        assert_eq!(curve.breakpoint_indicator(x), 2.0 - x);
    }
    assert_eq!(
        Cubic::new(cube, Extrapolate::Error).breakpoint_indicator(3.0),
        1.0
    );
    // level in the middle: the bend jumps from −6 to 6
    let stairs = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]];
    let curve = Cubic::new(stairs, Extrapolate::Error);
    assert_eq!(
        [
            curve.breakpoint_indicator(0.25),
            curve.breakpoint_indicator(1.0),
            curve.breakpoint_indicator(1.5)
        ],
        [0.75, 0.0, -0.5]
    );
    let curve = Cubic::new(stairs, Extrapolate::Hold);
    assert_eq!(
        [
            curve.breakpoint_indicator(-1.0),
            curve.breakpoint_indicator(0.25),
            curve.breakpoint_indicator(2.5)
        ],
        [1.0, -0.25, -0.5]
    );
}

#[test]
fn many_kinks_are_found_by_bisection() {
    const MANY: Curve<40> = {
        let mut points = [[0.0; 2]; 40];
        let mut k = 0;
        while k < 40 {
            points[k] = [k as f64, if k % 2 == 0 { 0.0 } else { 1.0 }];
            k += 1;
        }
        Curve::new(points, Extrapolate::Hold)
    };
    let kinks: Vec<f64> = (0..40).map(f64::from).collect();
    for i in -8..=330 {
        let x = f64::from(i) / 8.0;
        assert_eq!(
            MANY.breakpoint_indicator(x),
            closed_form(&kinks, x),
            "at {x}"
        );
        let lanes = MANY.breakpoint_indicator(Pair([x, 39.0 - x]));
        assert_eq!(
            lanes,
            Pair([
                MANY.breakpoint_indicator(x),
                MANY.breakpoint_indicator(39.0 - x)
            ])
        );
    }
    let there = Dual {
        value: 2.25,
        slope: 1.0,
    };
    assert_eq!(
        MANY.breakpoint_indicator(there),
        Dual {
            value: -0.25,
            slope: -1.0
        }
    );
}
