//! Curves of time in a compiled model: from files, smooth, stretched by parameters.

use bryant_runtime::simulate::{Settings, simulate};
use bryant_runtime::{Model, ParameterSet};
use bryant_tests::models::curves;
use bryant_tests::trees::Random;

/// Samples of t and the state, at a lengthening.
fn run(lengthening: f64) -> Vec<(f64, Vec<f64>)> {
    let mut parameters = curves::Parameters::<f64>::defaults();
    parameters.lengthening = lengthening;
    let model = curves::Mechanism::new(parameters);
    let mut samples = Vec::new();
    let settings = Settings::of(<curves::Mechanism<f64> as Model<f64>>::INFO);
    simulate(&model, &settings, &mut |sample| {
        samples.push((sample.t, sample.state.to_vec()));
    })
    .unwrap_or_else(|failure| panic!("{failure}"));
    samples
}

/// A piece of a curve: its beginning, its length, ordinates and slopes at both ends; a cubic, or a line.
struct Piece {
    from: f64,
    h: f64,
    ends: [[f64; 2]; 2],
}

/// Position and velocity at t of a motion that starts at rest and is accelerated by the pieces, and then by a line.
fn follow(pieces: &[Piece], last: [f64; 2], t: f64) -> [f64; 2] {
    let [mut x, mut v] = [0.0, 0.0];
    let mut end = 0.0;
    for piece in pieces {
        let [[y0, m0], [y1, m1]] = piece.ends;
        let h = piece.h;
        let (c2, c3) = (
            (3.0 * (y1 - y0) / h - 2.0 * m0 - m1) / h,
            (m0 + m1 - 2.0 * (y1 - y0) / h) / (h * h),
        );
        let s = (t - piece.from).clamp(0.0, h);
        x += v * s + s * s * (y0 / 2.0 + s * (m0 / 6.0 + s * (c2 / 12.0 + s * c3 / 20.0)));
        v += s * (y0 + s * (m0 / 2.0 + s * (c2 / 3.0 + s * c3 / 4.0)));
        end = piece.from + h;
    }
    let s = (t - end).max(0.0);
    let [y, m] = last;
    [
        x + v * s + s * s * (y / 2.0 + m * s / 6.0),
        v + s * (y + m * s / 2.0),
    ]
}

const PULSE: [[f64; 2]; 4] = [[0.0, 0.0], [0.02, 3.5], [0.05, -2.0], [0.09, 1.0]];

/// The pulse, stretched and scaled, with slopes at its points, and the line that follows it.
fn pulse(stretch: f64, times: f64, slopes: Option<[f64; 4]>) -> (Vec<Piece>, [f64; 2]) {
    let pieces = (0..3).map(|k| {
        let ([x, y], [next_x, next_y]) = (PULSE[k], PULSE[k + 1]);
        let secant = (next_y - y) / (next_x - x);
        let [m, next_m] = slopes.map_or([secant; 2], |m| [m[k], m[k + 1]]);
        Piece {
            from: stretch * x,
            h: stretch * (next_x - x),
            ends: [
                [times * y, times / stretch * m],
                [times * next_y, times / stretch * next_m],
            ],
        }
    });
    let after = slopes.map_or(0.0, |m| times / stretch * m[3]);
    (pieces.collect(), [times * PULSE[3][1], after])
}

/// Slopes of the smooth pulse in N/s: 0 at its extrema, and at the ends those of parabolas. Left: secants 175 and −183⅓
/// over 20 and 30 ms, (70·175 + 20·183⅓)/50 = 318⅓. Right: secants 75 and −183⅓ over 40 and 30 ms, (110·75 +
/// 40·183⅓)/70 = 222.6…, just less than three times the secant.
const SMOOTH: [f64; 4] = [
    (70.0 * 175.0 + 20.0 * 550.0 / 3.0) / 50.0,
    0.0,
    0.0,
    (110.0 * 75.0 + 40.0 * 550.0 / 3.0) / 70.0,
];

#[test]
fn curves_of_time_move_masses_exactly() {
    for lengthening in [1.7, 0.5, 1.0, 2.345_678] {
        for (t, state) in run(lengthening) {
            // for each system x, z, φ; then the velocities
            let (q, v) = state.split_at(12);
            let check = |what: &str, index: usize, (pieces, last): (Vec<Piece>, [f64; 2])| {
                let [x, speed] = follow(&pieces, last, t);
                // Between the points the solution is a polynomial of degree 3, or 5 for the smooth curve. The method of
                // order 5 errs only by rounding if every step ends on the points; within a step the interpolation of
                // order 4 is exact for degree 3, too. A hundred steps, a dozen roundings each.
                let bound = 1200.0 * f64::EPSILON;
                for (ours, expected) in [(q[index], x), (v[index], speed)] {
                    assert!(
                        (ours - expected).abs() <= bound * (1.0 + expected.abs()),
                        "{what} at {t} s, lengthened by {lengthening}: {ours} instead of {expected}"
                    );
                }
            };
            for of in [0, 3] {
                check("listed", of, pulse(1.0, 1.0, None));
                check("shortened", of + 1, pulse(0.3, 1.0, None));
            }
            check("stretched", 9, pulse(lengthening, 1.25, None));
            if t < 0.25 {
                continue;
            }
            check("smooth", 6, pulse(1.0, 0.5, Some(SMOOTH)));
            let twice = pulse(2.0 * lengthening, 1.25 / 2.0, Some(SMOOTH));
            check("stretched and smooth", 10, twice);
        }
    }
}

#[test]
fn kinks_of_constant_and_of_adjustable_curves_are_known() {
    let info = <curves::Mechanism<f64> as Model<f64>>::INFO;
    let expected = [0.0, 0.006, 0.015, 0.02, 0.027, 0.05, 0.09];
    assert_eq!(info.breakpoints.len(), expected.len());
    for (kink, expected) in info.breakpoints.iter().zip(expected) {
        assert!((kink - expected).abs() <= 2.0 * f64::EPSILON * expected);
    }
    let mut parameters = curves::Parameters::<f64>::defaults();
    parameters.lengthening = 2.0;
    let model = curves::Mechanism::new(parameters);
    let (mut t, mut kinks) = (0.0, Vec::new());
    while t < f64::INFINITY {
        t = model.kink_after(t);
        kinks.push(t);
    }
    let expected = [0.04, 0.08, 0.1, 0.18, 0.2, 0.36];
    assert_eq!(kinks.len(), expected.len() + 1);
    for (kink, expected) in kinks.iter().zip(expected) {
        assert!((kink - expected).abs() <= 4.0 * f64::EPSILON * expected);
    }
}

/// A curve as read and as compiled, with lines and with cubics; some of its points are on one line.
#[test]
fn the_kinks_of_a_curve_are_the_same_to_the_interpreter() {
    use bryant_generator::model::{Curve as Read, Extrapolate as Beyond, Interpolate};
    use bryant_runtime::curve::{Cubic, Curve, Extrapolate};
    let mut random = Random::new(7);
    let mut kinks = 0;
    for round in 0..300 {
        let mut points = [[random.uniform(-2.0, 0.0), random.uniform(-3.0, 3.0)]; 6];
        let mut slope = 0.0;
        for k in 1..6 {
            let [x, y] = points[k - 1];
            let h = random.uniform(0.1, 1.0);
            if random.below(2) == 0 {
                slope = random.uniform(-3.0, 3.0);
            }
            points[k] = [x + h, y + slope * h];
        }
        let (beyond, extrapolate) = [
            (Beyond::Linear, Extrapolate::Linear),
            (Beyond::Hold, Extrapolate::Hold),
            (Beyond::Error, Extrapolate::Error),
        ][round % 3];
        let read = |interpolate| Read {
            name: "c".to_string(),
            points: points.to_vec(),
            interpolate,
            extrapolate: beyond,
            states_extrapolation: true,
            thinned: None,
        };
        let (lines, cubics) = (read(Interpolate::Linear), read(Interpolate::Cubic));
        let slopes = [0, 1, 2, 3, 4, 5].map(|k| [points[k][0], points[k][1], cubics.tangent(k)]);
        let smooth = Cubic::new(slopes, extrapolate);
        let edged = Curve::new(points, extrapolate);
        for i in -20..=60 {
            let x = f64::from(i) / 10.0;
            assert_eq!(
                edged.breakpoint_indicator(x),
                lines.breakpoint_indicator(x),
                "{points:?} at {x}"
            );
            assert_eq!(
                smooth.breakpoint_indicator(x),
                cubics.breakpoint_indicator(x),
                "{points:?} at {x}"
            );
        }
        // points where the slope of the lines changes
        for (k, point) in points.iter().enumerate().skip(1).take(4) {
            let [before, after] =
                [k - 1, k].map(|k| lines.slope(0.5 * (points[k][0] + points[k + 1][0])));
            let bends = (after - before).abs() > 1e-9;
            assert_eq!(lines.kinks().contains(&point[0]), bends, "{points:?}: {k}");
            kinks += usize::from(bends);
        }
    }
    assert!((300..900).contains(&kinks), "{kinks}");
}
