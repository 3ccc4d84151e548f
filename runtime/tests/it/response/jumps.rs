//! Signals with jumps between samples.

use bryant_runtime::Real;
use bryant_runtime::real::Dual;
use bryant_runtime::response::FallingLimit;
use bryant_runtime::response::*;

const EVERY: f64 = 1e-3;

fn kinds() -> Vec<Response> {
    let duration = 3.3e-3;
    vec![
        Response::Peak,
        Response::Minimum,
        Response::Magnitude,
        Response::TimeOfPeak,
        Response::TimeOfMinimum,
        Response::Range,
        Response::Excursion,
        Response::Integral,
        Response::Mean,
        Response::Final,
        Response::Value { at: 0.020_3 },
        Response::Value { at: 0.021_4 },
        Response::Value { at: 0.04 },
        Response::Hic { window: 15e-3 },
        Response::Hic { window: 3.7e-3 },
        Response::Clip { duration },
        Response::ContiguousClip { duration },
        Response::Exceedance { limit: FALLING },
    ]
}

/// A limit whose corners are within the signals here.
const FALLING: FallingLimit =
    match FallingLimit::new(&[[0.0, 300.0], [3.3e-3, 150.0], [8e-3, 60.0]]) {
        Some(limit) => limit,
        None => panic!("a limit that falls"),
    };

/// A ramp from 0 to `height` at `end`, where the signal drops to 0.
fn ramp<T: Real>(height: T, end: T) -> (Vec<T>, Vec<Jump<T>>) {
    let rate = height / end;
    let samples = (0..=40).map(|i| {
        let t = f64::from(i) * EVERY;
        let off = end.to_f64() < t;
        if off {
            T::from_f64(0.0)
        } else {
            rate * T::from_f64(t)
        }
    });
    let jump = Jump {
        t: end,
        before: height,
        after: T::from_f64(0.0),
    };
    (samples.collect(), vec![jump])
}

#[test]
fn a_ramp_that_ends_between_samples_is_known_in_closed_form() {
    // Windows of HIC from u E to the end E: L = (1 − u) E, mean (1 + u) h/2. L mean^2.5 is largest at u = 3/7, here on
    // a sample.
    let (h, e) = (300.0, 28e-3 / 3.0);
    let duration = 3.3e-3;
    let hic = |h: f64, e: f64| 4.0 / 7.0 * e * (5.0 / 7.0 * h / STANDARD_GRAVITY).powf(2.5);
    let answers = [
        (Response::Peak, h, [1.0, 0.0]),
        (Response::Range, h, [1.0, 0.0]),
        (Response::Excursion, h, [1.0, 0.0]),
        (Response::TimeOfPeak, e, [0.0, 1.0]),
        (Response::Integral, 0.5 * h * e, [0.5 * e, 0.5 * h]),
        (
            Response::Mean,
            0.5 * h * e / 0.04,
            [0.5 * e / 0.04, 0.5 * h / 0.04],
        ),
        (Response::Final, 0.0, [0.0, 0.0]),
        // on either side of the end, nearer to it than one interval
        (
            Response::Value { at: 9.2e-3 },
            h * 9.2e-3 / e,
            [9.2e-3 / e, -h * 9.2e-3 / e / e],
        ),
        (Response::Value { at: 9.5e-3 }, 0.0, [0.0, 0.0]),
        (
            Response::Clip { duration },
            h * (1.0 - duration / e),
            [1.0 - duration / e, h * duration / e / e],
        ),
        (
            Response::ContiguousClip { duration },
            h * (1.0 - duration / e),
            [1.0 - duration / e, h * duration / e / e],
        ),
        // h (1 - d/E) beside the limit: largest at the second corner
        (
            Response::Exceedance { limit: FALLING },
            h * (1.0 - duration / e) / 150.0,
            [(1.0 - duration / e) / 150.0, h * duration / e / e / 150.0],
        ),
        // the best window does not depend on its beginning
        (
            Response::Hic { window: 15e-3 },
            hic(h, e),
            [2.5 * hic(h, e) / h, hic(h, e) / e],
        ),
    ];
    for (kind, value, slopes) in answers {
        for (along, slope) in slopes.into_iter().enumerate() {
            let seed = |i: usize, value| Dual {
                value,
                slope: if i == along { 1.0 } else { 0.0 },
            };
            let (samples, jumps) = ramp(seed(0, h), seed(1, e));
            let found = reduce_with_jumps(kind, &samples, &jumps, EVERY);
            let near = |found: f64, exact: f64, size: f64| {
                assert!(
                    (found - exact).abs() <= 64.0 * f64::EPSILON * size,
                    "{kind:?} {along}: {found}, not {exact}"
                );
            };
            near(found.value, value, value.abs().max(1.0));
            near(found.slope, slope, slope.abs().max(h / e));
        }
    }
}

#[test]
fn windows_as_long_as_can_be_keep_their_length() {
    // the window ends with the ramp and begins on a sample: 4 ms of (1 − 2/E ms) h
    let (h, e) = (300.0, 12e-3);
    let window = 4e-3;
    for after in [0.0, 1e-9] {
        let (samples, jumps) = ramp(Dual::constant(h), Dual::variable(e + after));
        let found = reduce_with_jumps(Response::Hic { window }, &samples, &jumps, EVERY);
        let mean = h * (1.0 - 0.5 * window / e) / STANDARD_GRAVITY;
        let value = window * mean.powf(2.5);
        let slope = 2.5 * value / mean * h * 0.5 * window / (e * e) / STANDARD_GRAVITY;
        let near = |found: f64, exact: f64| (found / exact - 1.0).abs() < 1e-6;
        assert!(near(found.value, value), "{} {value}", found.value);
        assert!(near(found.slope, slope), "{} {slope}", found.slope);
    }
}

/// A wave with two jumps, whose times and values a parameter moves.
fn wave<T: Real>(p: T, every: f64) -> (Vec<T>, Vec<Jump<T>>) {
    let num = T::from_f64;
    let pieces = [num(0.0), num(90.0), num(-20.0)];
    let ends = [num(0.0113) * p, num(0.0207) * p * p];
    let x = |t: T, piece: usize| {
        let (sine, _) = (t * num(150.0) * p).sin_cos();
        sine * p * num(200.0) + pieces[piece] * p
    };
    let piece = |t: f64| ends.iter().filter(|end| end.to_f64() < t).count();
    let samples = (0..=(0.04 / every).round() as usize).map(|i| {
        let t = i as f64 * every;
        x(num(t), piece(t))
    });
    let jumps = ends.iter().enumerate().map(|(i, end)| Jump {
        t: *end,
        before: x(*end, i),
        after: x(*end, i + 1),
    });
    (samples.collect(), jumps.collect())
}

#[test]
fn derivatives_are_those_of_differences() {
    let (p, step) = (1.013, 1e-6);
    for kind in kinds() {
        let of = |p: f64| {
            let (samples, jumps) = wave(p, EVERY);
            reduce_with_jumps(kind, &samples, &jumps, EVERY)
        };
        let (samples, jumps) = wave(Dual::variable(p), EVERY);
        let found = reduce_with_jumps(kind, &samples, &jumps, EVERY);
        assert_eq!(found.value, of(p), "{kind:?}");
        let difference = (of(p + step) - of(p - step)) / (2.0 * step);
        // The phase goes up to 6, so that a third derivative is some hundred times the first: the error of the
        // difference is that times the square of the step. In addition, some hundred roundings of sums over forty
        // samples and of differences of neighbours, divided by the step.
        let bound = 1e-9 * found.slope.abs() + 1e3 * f64::EPSILON * found.value.abs() / step;
        assert!(
            (found.slope - difference).abs() <= bound,
            "{kind:?}: {} {difference}",
            found.slope
        );
        assert!(found.slope != 0.0, "{kind:?}");
    }
}

#[test]
fn values_are_those_of_much_finer_samples() {
    let p = 1.013;
    let (samples, jumps) = wave(p, EVERY);
    let fine = EVERY / 500.0;
    let (finely, _) = wave(p, fine);
    for kind in kinds() {
        let mut scratch = vec![0.0; kind.scratch(finely.len())];
        let exact = reduce(kind, &finely, fine, &mut scratch);
        let found = reduce_with_jumps(kind, &samples, &jumps, EVERY);
        // Both lines err, so twice: the wave bends by at most 200 · 152² between samples, h²/8 of that off the line.
        // The fine samples show a jump of 90 to within 2 µs, in windows of some ms. The criterion takes both to the
        // power of 2.5. Times of peaks move by a quarter of an interval where no jump marks them.
        let bend = 200.0 * 152.0 * 152.0 * EVERY * EVERY / 8.0;
        let level = bend + 110.0 * 2.0 * fine / 3.3e-3;
        let bound = match kind {
            Response::TimeOfPeak | Response::TimeOfMinimum => 0.25 * EVERY,
            Response::Integral => 0.04 * bend + 110.0 * 2.0 * fine,
            // relative to the mean over the best window, which is at least 150
            Response::Hic { .. } => 2.5 * exact * 2.0 * level / 150.0,
            _ => 2.0 * level,
        };
        assert!(
            (found - exact).abs() <= bound,
            "{kind:?}: {found}, not {exact}: {bound}"
        );
    }
}

#[test]
fn jumps_by_nothing_or_outside_change_nothing() {
    let (samples, _) = wave(1.0_f64, EVERY);
    let top = (1..40)
        .max_by(|a, b| samples[*a].total_cmp(&samples[*b]))
        .unwrap();
    for kind in kinds() {
        let mut scratch = vec![0.0; kind.scratch(samples.len())];
        let plain = reduce(kind, &samples, EVERY, &mut scratch);
        // sums of forty samples and lengths; for HIC to the power of 2.5
        let bound = 40.0 * 4.0 * f64::EPSILON * plain.abs();
        for at in [top, 20, 21, 30] {
            let jump = Jump {
                t: at as f64 * EVERY,
                before: samples[at],
                after: samples[at],
            };
            let found = reduce_with_jumps(kind, &samples, &[jump], EVERY);
            assert!(
                (found - plain).abs() <= bound,
                "{kind:?}: {found}, not {plain}"
            );
            for t in [-1e-3, 40e-3, 41e-3] {
                let outside = Jump {
                    t,
                    after: 1e6,
                    ..jump
                };
                let found = reduce_with_jumps(kind, &samples, &[outside], EVERY);
                assert_eq!(found, plain, "{kind:?}");
            }
        }
    }
}

#[test]
fn a_push_that_is_as_long_as_the_window_fills_it() {
    // from 10 to 25 ms, at samples and between them
    for off in [0.0, 0.3e-3] {
        let [start, end] = [10e-3 + off, 25e-3 + off];
        let samples: Vec<f64> = (0..=40)
            .map(|i| f64::from(i) * EVERY)
            .map(|t| {
                if (start..end).contains(&t) {
                    300.0
                } else {
                    0.0
                }
            })
            .collect();
        let [begins, ends] = [[start, 0.0, 300.0], [end, 300.0, 0.0]]
            .map(|[t, before, after]| Jump { t, before, after });
        let window = 15e-3;
        let kind = Response::Hic { window };
        let found = reduce_with_jumps(kind, &samples, &[begins, ends], EVERY);
        let exact = window * (300.0 / STANDARD_GRAVITY).powf(2.5);
        assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
    }
}

#[test]
fn what_is_no_number_has_no_answer() {
    let (mut samples, jumps) = wave(1.0, EVERY);
    let broken = [
        jumps[0],
        Jump {
            after: f64::NAN,
            ..jumps[1]
        },
    ];
    for kind in kinds() {
        let looks = !matches!(kind, Response::Final | Response::Value { .. });
        let found = reduce_with_jumps(kind, &samples, &broken, EVERY);
        assert!(found.is_nan() || !looks, "{kind:?}");
    }
    samples[3] = f64::NAN;
    for kind in kinds() {
        let looks = !matches!(kind, Response::Final | Response::Value { .. });
        let found = reduce_with_jumps(kind, &samples, &jumps, EVERY);
        assert_eq!(found.is_nan(), looks, "{kind:?}");
    }
    assert!(reduce_with_jumps(Response::Peak, &[], &jumps, EVERY).is_nan());
    let long = Response::Clip { duration: 1.0 };
    let (samples, jumps) = wave(1.0_f64, EVERY);
    assert!(reduce_with_jumps(long, &samples, &jumps, EVERY).is_nan());
}

/// A step from b to a in the middle between two samples, moved by one interval either way, changes the two samples
/// there by b − a. The difference of both results over two intervals is the slope of the filtered signal, because a
/// filter is linear.
#[test]
fn filters_have_the_slope_that_a_moving_step_gives_them() {
    use bryant_runtime::response::filter::{Class, Standard, filtered};
    let (before, after) = (3.0, -2.0);
    let step = |from: usize| -> Vec<f64> {
        let value = |i: usize| if i < from { before } else { after };
        (0..200).map(value).collect()
    };
    let of = |samples: &[f64]| filtered(samples, EVERY, Class::Cfc60, Standard::Iso6487);
    let (late, early) = (of(&step(102)).unwrap(), of(&step(100)).unwrap());
    let constant = Dual::<f64>::from_f64;
    let mut samples: Vec<_> = step(101).into_iter().map(constant).collect();
    let t = Dual {
        value: 100.5 * EVERY,
        slope: 1.0,
    };
    let jump = Jump {
        t,
        before: constant(before),
        after: constant(after),
    };
    move_with_jumps(&mut samples, [jump].into_iter(), EVERY);
    assert!(samples.iter().zip(step(101)).all(|(a, b)| a.value == b));
    let found = filtered(&samples, EVERY, Class::Cfc60, Standard::Iso6487).unwrap();
    for (i, found) in found.iter().enumerate() {
        let expected = (late[i] - early[i]) / (2.0 * EVERY);
        // rounding of numbers of size 5, over an interval
        assert!((found.slope - expected).abs() < 1e-9, "{i}");
    }
}
