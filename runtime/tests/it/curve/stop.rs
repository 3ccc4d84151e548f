//! Where a motion against a curve stops.

use crate::scalars::Pair;
use bryant_runtime::curve::{Cubic, Curve, Extrapolate};
use bryant_runtime::{DoubleDouble, Dual, Real};

const fn lines<const N: usize>(points: [[f64; 2]; N], beyond: Extrapolate) -> Curve<N> {
    Curve::new(points, beyond)
}

const CONSTANT: Curve<2> = lines([[0.0, 1.0], [1.0, 1.0]], Extrapolate::Hold);
/// From 0 up to 4 in 1, there for 2, down to 0 in 1: an area of 12.
const TRAPEZOID: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 4.0], [3.0, 4.0], [4.0, 0.0]];

#[test]
fn constant_braking_stops_at_the_speed_over_it() {
    for (v, a) in [
        (10.0, 5.0),
        (13.9, 8.3),
        (1e-9, 1e3),
        (1e6, 1e-3),
        (3.0, 3.0),
    ] {
        let exact = v / a;
        for sign in [1.0, -1.0] {
            let x = CONSTANT.stop(sign * v, -sign * a);
            assert!(
                (x / exact - 1.0).abs() <= 4.0 * f64::EPSILON,
                "{v}, {a}: {x}"
            );
        }
        // faster and faster
        assert_eq!(CONSTANT.stop(v, a), 0.0);
    }
    assert_eq!(CONSTANT.stop(3.0, 0.0), 0.0);
    assert_eq!(CONSTANT.stop(0.0, -2.0), 0.0);
    assert_eq!(CONSTANT.stop(0.0, 0.0), 0.0);
    assert!(CONSTANT.stop(f64::NAN, -1.0).is_nan());
    assert!(CONSTANT.stop(1.0, f64::INFINITY).is_nan());
}

#[test]
fn a_trapezoid_is_integrated() {
    for beyond in [Extrapolate::Hold, Extrapolate::Linear, Extrapolate::Error] {
        let pulse = lines(TRAPEZOID, beyond);
        // on the ramp 2x², on the top 2 + 4 (x − 1), on the way down 12 − 2 (4 − x)²
        for (v, exact) in [
            (1.28, 0.8),
            (2.0, 1.0),
            (6.0, 2.0),
            (10.0, 3.0),
            (11.5, 3.5),
        ] {
            let x = pulse.stop(v, -1.0);
            assert!((x - exact).abs() <= 8.0 * f64::EPSILON * exact, "{v}: {x}");
        }
        // more than the whole area
        assert_eq!(pulse.stop(12.5, -1.0), 0.0);
        // exactly the whole area: it stops at the last point, where the pulse ends
        assert_eq!(pulse.stop(12.0, -1.0), 4.0);
        assert_eq!(pulse.stop(12.0 * (1.0 + f64::EPSILON), -1.0), 4.0);
        assert_eq!(pulse.stop(1.2, -0.1), 4.0);
    }
    // Beyond the last point the line goes on below 0, so v rises again: nothing stops
    let goes_on = lines(TRAPEZOID, Extrapolate::Linear);
    assert_eq!(goes_on.stop(13.0, -1.0), 0.0);
    // and in the other direction: from −13 it goes up to −1, and then down
    assert_eq!(goes_on.stop(-13.0, 1.0), 0.0);
    // a push forward, and the line beyond brakes: 12 + 1 = 2 (x − 4)²
    let x = goes_on.stop(1.0, 1.0);
    assert!(
        (x - 4.0 - 6.5f64.sqrt()).abs() <= 8.0 * f64::EPSILON * x,
        "{x}"
    );
}

#[test]
fn what_touches_0_stops_there() {
    // brakes until 1, where the acceleration changes its sign inside a piece
    let turns = lines([[0.0, -1.0], [2.0, 1.0]], Extrapolate::Hold);
    // v = v₀ − x + x²/2, lowest at 1 with v₀ − 1/2
    assert_eq!(turns.stop(0.5, 1.0), 1.0);
    assert_eq!(turns.stop(0.5 * (1.0 + 4.0 * f64::EPSILON), 1.0), 1.0);
    assert_eq!(turns.stop(0.51, 1.0), 0.0);
    let x = turns.stop(0.48, 1.0);
    assert!((x - 0.8).abs() <= 1e-15, "{x}");
    // a place of turning back has no derivatives
    let x = turns.stop(Dual::variable(0.5), Dual::constant(1.0));
    assert_eq!((x.value, x.slope), (1.0, 0.0));
    // at a point of the curve
    let at_point = lines([[0.0, -1.0], [1.0, 0.0], [2.0, 3.0]], Extrapolate::Hold);
    assert_eq!(at_point.stop(0.5, 1.0), 1.0);
    assert_eq!(at_point.stop(0.5 - 1e-16, 1.0), 1.0);
}

#[test]
fn what_starts_at_rest_stops_when_it_comes_back_to_it() {
    // 0 until 1, then up and down by an area of 1 each, and once more
    let there_and_back = lines(
        [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 1.0],
            [4.0, -1.0],
            [5.0, 0.0],
            [6.0, 1.0],
        ],
        Extrapolate::Hold,
    );
    assert_eq!(there_and_back.stop(0.0, 1.0), 5.0);
    assert_eq!(there_and_back.stop(0.0, -0.3), 5.0);
    // slightly faster: never, until the line beyond would have braked it
    assert_eq!(there_and_back.stop(0.1, 1.0), 0.0);
    // slightly the other way: on the ramp, x − 1 = √0.2
    let x = there_and_back.stop(-0.1, 1.0);
    assert!((x - 1.0 - 0.2f64.sqrt()).abs() <= 1e-15, "{x}");
}

#[test]
fn curves_that_begin_before_or_after_the_start_count_from_0() {
    let early = lines(
        [[-10.0, 3.0], [-1.0, -2.0], [9.0, -2.0]],
        Extrapolate::Error,
    );
    let x = early.stop(5.0, 1.0);
    assert!((x - 2.5).abs() <= 64.0 * f64::EPSILON, "{x}");
    assert_eq!(early.stop(50.0, 1.0), 0.0);
    let late = [[1.0, -2.0], [2.0, -4.0]];
    // held: 2 x; as a line −2 x: v₀ − x²
    let x = lines(late, Extrapolate::Hold).stop(1.0, 1.0);
    assert!((x - 0.5).abs() <= 4.0 * f64::EPSILON, "{x}");
    let x = lines(late, Extrapolate::Linear).stop(0.25, 1.0);
    assert!((x - 0.5).abs() <= 4.0 * f64::EPSILON, "{x}");
    let x = lines(late, Extrapolate::Linear).stop(9.0, 1.0);
    assert!((x - 3.0).abs() <= 16.0 * f64::EPSILON, "{x}");
    assert_eq!(lines(late, Extrapolate::Error).stop(1.0, 1.0), 0.0);
}

#[test]
fn cubics_are_solved_as_quartics() {
    // −4 x³ + 3 x² … by its Hermite form: y = x² (3 − 2x), slope 0 at both ends, then held at 1
    let smooth = Cubic::new([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], Extrapolate::Hold);
    // ∫ = x³ − x⁴/2
    for x in [0.1f64, 0.4, 0.9, 1.0] {
        let v = x * x * x * (1.0 - x / 2.0);
        let found = smooth.stop(2.0 * v, -2.0);
        assert!((found - x).abs() <= 64.0 * f64::EPSILON, "{x}: {found}");
    }
    let found = smooth.stop(2.5, -1.0);
    assert!((found - 3.0).abs() <= 8.0 * f64::EPSILON, "{found}");
}

#[test]
fn derivatives_are_those_of_the_root() {
    // v₀ = a x²/2 on a ramp: x = √(2 v₀/a), dx/dv₀ = x/2v₀, dx/da = −x/2a
    let ramp = lines([[0.0, 0.0], [9.0, 9.0]], Extrapolate::Linear);
    for (v, a) in [(2.0, 1.0), (3.0, 0.7), (70.0, 0.3f64)] {
        let exact = (2.0 * v / a).sqrt();
        let by_speed = ramp.stop(Dual::variable(v), Dual::constant(-a));
        let by_braking = ramp.stop(Dual::constant(v), -Dual::variable(a));
        for (found, slope) in [
            (by_speed, exact / (2.0 * v)),
            (by_braking, -exact / (2.0 * a)),
        ] {
            assert!((found.value / exact - 1.0).abs() <= 8.0 * f64::EPSILON);
            assert!((found.slope / slope - 1.0).abs() <= 16.0 * f64::EPSILON);
        }
        // the second derivative by v₀: −x/4v₀²
        let twice = Dual {
            value: Dual::variable(v),
            slope: Dual::constant(1.0),
        };
        let found = ramp.stop(twice, Dual::constant(Dual::constant(-a)));
        let bend = -exact / (4.0 * v * v);
        assert!((found.slope.slope / bend - 1.0).abs() <= 64.0 * f64::EPSILON);
    }
    let never = CONSTANT.stop(Dual::variable(1.0), Dual::constant(1.0));
    assert_eq!((never.value, never.slope), (0.0, 0.0));
}

#[test]
fn more_digits_than_a_double_s_are_found() {
    let c = DoubleDouble::from_f64;
    let x = CONSTANT.stop(c(1.0), c(-3.0));
    assert!((c(3.0) * x - c(1.0)).to_f64().abs() <= f64::EPSILON * f64::EPSILON);
    let ramp = lines([[0.0, 0.0], [9.0, 9.0]], Extrapolate::Linear);
    let x = ramp.stop(c(3.0), c(-1.0));
    assert!((x * x - c(6.0)).to_f64().abs() <= 16.0 * f64::EPSILON * f64::EPSILON);
}

#[test]
fn each_lane_has_its_own() {
    let pulse = lines(TRAPEZOID, Extrapolate::Error);
    let found = pulse.stop(Pair([6.0, 20.0]), Pair([-1.0; 2]));
    assert_eq!(found, Pair([pulse.stop(6.0, -1.0), 0.0]));
    let found = pulse.stop(Pair([12.0, 1.28]), Pair([-1.0; 2]));
    assert_eq!(found, Pair([4.0, pulse.stop(1.28, -1.0)]));
    let found = pulse.stop(Pair([f64::NAN, 1.28]), Pair([-1.0; 2]));
    assert!(found.0[0].is_nan() && found.0[1] == pulse.stop(1.28, -1.0));
}

/// Random curves against a scan: nothing is 0 before, and it is 0 there.
#[test]
fn random_curves_reach_0_there_and_not_before() {
    let mut seed = 1u64;
    let mut random = |low: f64, high: f64| {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut stopped = 0;
    for round in 0..3000 {
        let mut points = [[random(-1.0, 1.0), random(-2.0, 2.0)]; 6];
        for k in 1..6 {
            points[k] = [points[k - 1][0] + random(0.05, 1.0), random(-2.0, 2.0)];
        }
        let beyond = [Extrapolate::Hold, Extrapolate::Linear, Extrapolate::Error][round % 3];
        let velocity = random(-1.5, 1.5);
        let factor = random(-2.0, 2.0);
        // slopes of 0 keep cubics monotone
        let flat = points.map(|[x, y]| [x, y, 0.0]);
        let (curve, cubic) = (Curve::new(points, beyond), Cubic::new(flat, beyond));
        let smooth = round % 2 == 1;
        let at = |x: f64| {
            let integral = if smooth {
                cubic.integral(x)
            } else {
                curve.integral(x)
            };
            velocity + factor * integral
        };
        let x = match smooth {
            true => cubic.stop(velocity, factor),
            false => curve.stop(velocity, factor),
        };
        assert!(x >= 0.0 && x.is_finite(), "{round}: {x}");
        stopped += usize::from(x > 0.0);
        let until = if x > 0.0 { x } else { 8.0 };
        for i in 0..4000 {
            let before = until * f64::from(i) / 4000.0;
            let v = at(before);
            let same = v * velocity > 0.0 || v.is_nan() || v.abs() < 1e-13;
            assert!(same, "{round}: {v} at {before} before {x}");
        }
        if x > 0.0 {
            assert!(at(x).abs() <= 1e-13, "{round}: {} at {x}", at(x));
        }
    }
    assert!((1000..2900).contains(&stopped), "{stopped}");
}
