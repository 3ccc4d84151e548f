//! Responses of signals whose answers are known in closed form, and their derivatives.

mod answer;
mod channel;
mod filter;
mod jumps;
mod olc;

use crate::scalars::Pair;
use bryant_runtime::real::{Dual, Real};
use bryant_runtime::response::{
    FallingLimit, Response, STANDARD_GRAVITY as G, exceedance_of, reduce,
};
use core::f64::consts::PI;

/// HIC 15 and 36.
const HIC_15: Response = Response::Hic { window: 15e-3 };
const HIC_36: Response = Response::Hic { window: 36e-3 };
const CLIP: Response = Response::Clip { duration: 3e-3 };
const CONTIGUOUS: Response = Response::ContiguousClip { duration: 3e-3 };
/// A limit whose corners are within the signals here.
const FALLING: Response = Response::Exceedance {
    limit: limit(&[[0.0, 300.0], [4e-3, 250.0], [9e-3, 100.0]]),
};

const fn limit(corners: &[[f64; 2]]) -> FallingLimit {
    match FallingLimit::new(corners) {
        Some(limit) => limit,
        None => panic!("a limit that falls"),
    }
}

/// The shape of a pulse between 0 and 1, at most 1.
type Shape = fn(f64) -> f64;

/// One response of each kind.
const ALL: [Response; 15] = [
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
    Response::Value { at: 0.012_345 },
    HIC_15,
    CLIP,
    CONTIGUOUS,
    FALLING,
];

fn response<T: Real>(response: Response, samples: &[T], every: f64) -> T {
    // the content of the scratch must not matter
    let mut scratch = vec![T::from_f64(f64::NAN); response.scratch(samples.len())];
    reduce(response, samples, every, &mut scratch)
}

/// A function of time, sampled from 0 to `end`.
fn sampled(end: f64, every: f64, signal: impl Fn(f64) -> f64) -> Vec<f64> {
    fn collect(end: f64, every: f64, signal: &dyn Fn(f64) -> f64) -> Vec<f64> {
        let count = (end / every).round() as usize;
        (0..=count).map(|i| signal(i as f64 * every)).collect()
    }
    collect(end, every, &signal)
}

/// A pulse of `amplitude` \[g\] between 0 and `length` \[s\], in m/s².
fn pulse(shape: Shape, amplitude: f64, length: f64, every: f64) -> Vec<f64> {
    sampled(1.5 * length, every, |t| {
        amplitude * G * if t <= length { shape(t / length) } else { 0.0 }
    })
}

fn half_sine(x: f64) -> f64 {
    (PI * x).sin().max(0.0)
}

fn haversine(x: f64) -> f64 {
    half_sine(x).powi(2)
}

fn triangle(x: f64) -> f64 {
    1.0 - (2.0 * x - 1.0).abs()
}

/// The error due to sampling: the trapezium rule errs by (π h/T)²/12 of a mean, and the ends of the window by an
/// interval, to the square.
fn bound(every: f64, length: f64) -> f64 {
    5.0 * (PI * every / length).powi(2)
}

#[track_caller]
fn assert_near(found: f64, expected: f64, bound: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(
        error <= bound,
        "{found}, not {expected}: {error:e} > {bound:e}"
    );
}

/// HIC = c A^2.5 T for pulses of amplitude A \[g\] and length T, where the window is long enough. c comes from
/// maximising the closed form of the mean over centred windows, in 16 digits; for the triangle it is (4/7) (5/7)^2.5.
#[test]
fn hic_of_pulses_is_in_proportion() {
    let (amplitude, length, every) = (80.0, 12e-3, 2e-5);
    let shapes: [(Shape, f64); 3] = [
        (half_sine, 0.414_645_649_541_51),
        (haversine, 0.302_938_854_957_9),
        (triangle, 4.0 / 7.0 * (5.0_f64 / 7.0).powf(2.5)),
    ];
    for (shape, factor) in shapes {
        let found = response(HIC_15, &pulse(shape, amplitude, length, every), every);
        let expected = factor * amplitude.powf(2.5) * length;
        assert_near(found, expected, bound(every, length));
    }
}

#[test]
fn hic_of_windows_that_are_too_short_is_that_of_the_longest() {
    // centred windows of w have the mean 2A T/(π w) sin(π w/2T)
    let every = 2e-5;
    let cases = [
        (100.0, 20e-3, HIC_15, 829.291_299_083),
        (100.0, 20e-3, HIC_36, 829.291_299_083),
        (100.0, 30e-3, HIC_36, 1_243.936_948_624_5),
        (100.0, 30e-3, HIC_15, 1_153.663_257_124_5),
        (60.0, 60e-3, HIC_36, 685.325_544_264_6),
        (60.0, 60e-3, HIC_15, 392.119_844_929_7),
    ];
    for (amplitude, length, hic, expected) in cases {
        let found = response(hic, &pulse(half_sine, amplitude, length, every), every);
        assert_near(found, expected, bound(every, length));
    }
}

#[test]
fn hic_of_a_constant_fills_the_window_whatever_the_interval() {
    // 15 ms are a whole number of samples of 1 ms, but not of 2 ms or 0.7 ms
    for every in [1e-3, 2e-3, 0.7e-3] {
        let samples = sampled(0.1, every, |_| 60.0 * G);
        for (hic, window) in [(HIC_15, 15e-3), (HIC_36, 36e-3)] {
            let expected = window * 60_f64.powf(2.5);
            assert_near(response(hic, &samples, every), expected, 1e-12);
        }
    }
    // for a signal shorter than the window, the whole signal counts
    let short = [60.0 * G; 6];
    assert_near(
        response(HIC_15, &short, 1e-3),
        5e-3 * 60_f64.powf(2.5),
        1e-12,
    );
}

/// The same, by trying every pair of samples with the original formula.
#[test]
fn hic_of_any_signal_is_the_largest_over_all_windows() {
    let every = 0.5e-3;
    for seed in 1..=5 {
        let samples: Vec<f64> = (0..90)
            .map(|i| 300.0 * (f64::from(i * seed % 17) - 6.0) + 40.0 * f64::from(i))
            .collect();
        let mut expected = 0.0_f64;
        for i in 0..samples.len() {
            for j in i + 1..samples.len().min(i + 31) {
                let velocity: f64 = (i..j)
                    .map(|k| 0.5 * every * (samples[k] + samples[k + 1]))
                    .sum();
                let length = (j - i) as f64 * every;
                expected = expected.max(length * (velocity.max(0.0) / (G * length)).powf(2.5));
            }
        }
        // velocities are summed over 90 terms
        assert_near(
            response(HIC_15, &samples, every),
            expected,
            300.0 * f64::EPSILON,
        );
    }
}

#[test]
fn without_acceleration_there_is_no_injury() {
    assert_eq!(response(HIC_15, &[0.0; 50], 1e-3), 0.0);
    assert_eq!(response(HIC_15, &[-30.0; 50], 1e-3), 0.0);
    let still = response(
        HIC_15,
        &[Dual {
            value: 0.0,
            slope: 0.0,
        }; 50],
        1e-3,
    );
    assert_eq!((still.value, still.slope), (0.0, 0.0));
}

#[test]
fn clips_of_one_pulse_are_alike() {
    // exceeded for d around the middle: A cos(π d/2T); a chord is at most A (π h/T)²/8 below its arc, and never above
    for (amplitude, length, every) in [
        (100.0, 20e-3, 1e-4),
        (100.0, 20e-3, 0.7e-4),
        (100.0, 20e-3, 0.35e-4),
        (100.0, 20e-3, 0.175e-4),
        (60.0, 60e-3, 1e-4),
        (80.0, 15e-3, 0.7e-4),
        (80.0, 15e-3, 0.8e-3),
        (80.0, 15e-3, 0.4e-3),
        (80.0, 15e-3, 0.2e-3),
    ] {
        let samples = pulse(half_sine, amplitude, length, every);
        let expected = (PI * 3e-3 / (2.0 * length)).cos();
        let below = (PI * every / length).powi(2) / 8.0;
        for clip in [CLIP, CONTIGUOUS] {
            let found = response(clip, &samples, every) / (amplitude * G);
            assert!(
                (-below - 1e-13..1e-13).contains(&(found - expected)),
                "{clip:?} every {every}: {found}, not {expected}"
            );
        }
    }
    // 1.5 ms · π/T: the cases of the reference, in g
    let level =
        |amplitude, length| response(CLIP, &pulse(half_sine, amplitude, length, 1e-4), 1e-4) / G;
    assert_near(level(100.0, 20e-3), 97.236_992_039_768, 1e-12);
    assert_near(level(60.0, 60e-3), 59.815_040_023_989, 1e-12);
}

#[test]
fn a_triangle_is_clipped_exactly() {
    // A (1 − d/T), and its derivative for A; the top is a sample, the edges are not
    let (length, every) = (20e-3, 0.4e-3);
    for duration in [0.0, 0.1e-3, 0.4e-3, 0.7e-3, 3e-3, 5.2e-3, 17.77e-3] {
        for clip in [
            Response::Clip { duration },
            Response::ContiguousClip { duration },
        ] {
            let samples: Vec<Dual<f64>> = pulse(triangle, 1.0 / G, length, every)
                .iter()
                .map(|a| Dual::variable(80.0) * Dual::constant(*a))
                .collect();
            let found = response(clip, &samples, every);
            let expected = 1.0 - duration / length;
            assert!((found.value / 80.0 - expected).abs() < 1e-13, "{clip:?}");
            assert!(
                (found.slope - expected).abs() < 1e-13,
                "{clip:?}: {found:?}"
            );
        }
    }
}

/// Numbers between 0 and 1, the same for the same seed.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Noise, few values with plateaus, spikes, a random walk, a wave with plateaus on top.
fn jagged(seed: u64) -> Vec<f64> {
    let mut random = random(seed);
    let mut walk = 0.0;
    let count = 2 + (random() * 60.0) as usize;
    (0..count)
        .map(|i| match seed % 5 {
            0 => 200.0 * random() - 100.0,
            1 => (5.0 * random()).floor() - 2.0,
            2 if random() < 0.1 => 1e5 * random(),
            2 => random() - 0.5,
            3 => {
                walk += random() - 0.5;
                walk
            }
            _ => (3.0 * (0.4 * i as f64).sin()).clamp(-2.0, 1.5),
        })
        .collect()
}

/// Durations in intervals: whole and not whole, less than one, the whole signal.
fn durations(last: f64) -> impl Iterator<Item = f64> {
    let some = [
        0.0, 0.25, 0.5, 0.9375, 1.0, 1.3, 2.0, 2.71875, 3.5, 7.0, 8.6,
    ];
    let all = [last - 1.5, last - 1.0, last - 0.3, last];
    let fit = move |d: &f64| (0.0..=last).contains(d);
    some.into_iter().chain(all).filter(fit)
}

/// Largest absolute value.
fn size(samples: &[f64]) -> f64 {
    samples.iter().fold(0.0, |most, a| a.abs().max(most))
}

/// The largest value of a sample that is met or exceeded for as long as asked, and from there upwards in a straight
/// line.
#[test]
fn cumulative_clips_are_those_of_sorted_values() {
    let part = |a: f64, b: f64, level: f64, met: bool| match (a.min(b), a.max(b)) {
        (low, _) if low > level || (met && low == level) => 1.0,
        (low, high) if low < level && level < high => (high - level) / (high - low),
        (low, high) if low == level && level < high => 1.0,
        _ => 0.0,
    };
    for seed in 0..1000 {
        let samples = jagged(seed);
        let time = |level: f64, met: bool| -> f64 {
            let parts = samples.windows(2).map(|x| part(x[0], x[1], level, met));
            parts.sum()
        };
        let mut values = samples.clone();
        values.sort_by(|a, b| b.total_cmp(a));
        let last = (samples.len() - 1) as f64;
        // the sums over intervals err by ε each; a level falls by 2 · size per interval at most
        let bound = 8.0 * (last + 1.0) * f64::EPSILON * size(&samples);
        for duration in durations(last) {
            let place = values.iter().position(|x| time(*x, true) >= duration);
            let place = place.unwrap_or(values.len() - 1);
            let here = values[place];
            let mut expected = here;
            if place > 0 && time(here, false) > duration {
                let above = values[place - 1];
                let (most, least) = (time(here, false), time(above, true));
                expected += (most - duration) / (most - least) * (above - here);
            }
            let found = response(Response::Clip { duration }, &samples, 1.0);
            assert!(
                (found - expected).abs() <= bound,
                "{seed}, {duration}: {found}, not {expected}"
            );
        }
    }
}

/// Over all windows that begin or end on samples, or have both ends on one level, in any two intervals: the largest of
/// the smallest values.
#[test]
fn contiguous_clips_are_those_of_all_windows() {
    for seed in 0..500 {
        let samples = jagged(seed);
        let last = (samples.len() - 1) as f64;
        let at = |t: f64| {
            let i = (t as usize).min(samples.len() - 2);
            samples[i] + (t - i as f64) * (samples[i + 1] - samples[i])
        };
        // times err by ε · last, on slopes of 2 · size
        let bound = 16.0 * (last + 1.0) * f64::EPSILON * size(&samples);
        for duration in durations(last) {
            let least = |start: f64| {
                let end = (start + duration).min(last);
                let inside = samples.iter().enumerate();
                let inside = inside.filter(|(i, _)| (start..=end).contains(&(*i as f64)));
                inside.fold(at(start).min(at(end)), |least, x| least.min(*x.1))
            };
            let mut starts = Vec::new();
            for i in 0..samples.len() {
                starts.extend([i as f64, i as f64 - duration]);
            }
            for (i, a) in samples.windows(2).enumerate() {
                for (j, b) in samples.windows(2).enumerate() {
                    // a₀ + (s − i) a′ = b₀ + (s + d − j) b′
                    let (i, j, rise, fall) = (i as f64, j as f64, a[1] - a[0], b[1] - b[0]);
                    let start = (b[0] - a[0] + i * rise + (duration - j) * fall) / (rise - fall);
                    if (i..=i + 1.0).contains(&start) && (j..=j + 1.0).contains(&(start + duration))
                    {
                        starts.push(start);
                    }
                }
            }
            starts.retain(|start| (0.0..=last - duration).contains(start));
            let levels = starts.into_iter().map(least);
            let expected = levels.fold(f64::NEG_INFINITY, f64::max);
            let found = response(Response::ContiguousClip { duration }, &samples, 1.0);
            assert!(
                (found - expected).abs() <= bound,
                "{seed}, {duration}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn pulses_add_up_to_the_cumulative_clip() {
    // each of the two exceeds the level for half of the time: A cos(π d/4T), less a chord
    for every in [0.7e-4, 0.35e-4, 0.175e-4] {
        let samples = sampled(50e-3, every, |t| {
            half_sine(t / 10e-3) * f64::from(t < 10e-3)
                + half_sine((t - 20e-3) / 10e-3) * f64::from((20e-3..30e-3).contains(&t))
        });
        let error = response(CLIP, &samples, every) - (PI * 3e-3 / 40e-3).cos();
        let below = (PI * every / 10e-3).powi(2) / 8.0;
        assert!((-below - 1e-13..1e-13).contains(&error), "{every}: {error}");
    }
}

/// The limits of UN R94: tension and shear of the neck, femur.
const R94: [FallingLimit; 3] = [
    limit(&[[0.0, 3300.0], [35e-3, 2900.0], [60e-3, 1100.0]]),
    limit(&[
        [0.0, 3100.0],
        [25e-3, 1500.0],
        [35e-3, 1500.0],
        [45e-3, 1100.0],
    ]),
    limit(&[[0.0, 9070.0], [10e-3, 7580.0]]),
];

/// The largest ratio to a limit, and the duration where it occurs.
fn exceedance<T: Real>(samples: &[T], limit: FallingLimit, every: f64) -> [T; 2] {
    let kind = Response::Exceedance { limit };
    let mut scratch = vec![T::from_f64(f64::NAN); kind.scratch(samples.len())];
    let found = exceedance_of(samples, &limit, every, &mut scratch);
    assert_eq!(found.ratio, response(kind, samples, every));
    [found.ratio, found.duration]
}

#[test]
fn a_limit_that_falls_is_a_polygon() {
    let [tension, shear, _] = R94;
    for (limit, duration, level) in [
        (tension, 0.0, 3300.0),
        (tension, 17.5e-3, 3100.0),
        (tension, 35e-3, 2900.0),
        (tension, 47.5e-3, 2000.0),
        (tension, 60e-3, 1100.0),
        (tension, 9.0, 1100.0),
        (shear, 30e-3, 1500.0),
        (shear, 40e-3, 1300.0),
    ] {
        assert!((limit.at(duration) - level).abs() < 1e-9, "{duration}");
    }
    for corners in [
        &[][..],
        &[[1e-3, 5.0]],
        &[[0.0, 5.0], [0.0, 4.0]],
        &[[0.0, 5.0], [1e-3, 6.0]],
        &[[0.0, 5.0], [1e-3, 0.0]],
        &[[0.0, f64::NAN]],
        &[[0.0, 5.0]; 5],
    ] {
        assert!(FallingLimit::new(corners).is_none(), "{corners:?}");
    }
}

/// A force that has the level of a corner for the duration of this corner keeps the limit just so, one that is a
/// thousandth higher or 1 % longer does not; behind the last corner the duration does not matter.
#[test]
fn rectangles_meet_the_corners_of_their_limit() {
    for limit in R94 {
        let corners = limit.corners().iter().map(|[duration, _]| *duration);
        let corners: Vec<f64> = corners.collect();
        let last = corners[corners.len() - 1];
        for duration in corners.into_iter().filter(|duration| *duration > 0.0) {
            for every in [1e-4, 0.5e-4] {
                let rectangle = |size: f64, length: f64, sign: f64| {
                    let steps = (length / every).round() as usize;
                    let inside = 100..=100 + steps;
                    let of = |i: usize| sign * size * f64::from(inside.contains(&i));
                    (0..2000).map(of).collect::<Vec<f64>>()
                };
                let level = limit.at(duration);
                for sign in [1.0, -1.0] {
                    let [ratio, at] = exceedance(&rectangle(level, duration, sign), limit, every);
                    assert!(ratio <= 1.0 && ratio > 1.0 - 1e-11, "{duration}: {ratio}");
                    assert!((at - duration).abs() < 1e-12, "{duration}: {at}");
                }
                let higher = rectangle(1.001 * level, duration, 1.0);
                assert!((exceedance(&higher, limit, every)[0] - 1.001).abs() < 1e-11);
                let lower = exceedance(&rectangle(0.999 * level, duration, 1.0), limit, every);
                assert!((lower[0] - 0.999).abs() < 1e-11);
                let longer = exceedance(&rectangle(level, 1.04 * duration, 1.0), limit, every);
                let expected = level / limit.at(1.04 * duration);
                assert!((longer[0] - expected).abs() < 1e-3 * expected, "{longer:?}");
                let falls = duration < last && limit.at(1.04 * duration) < level;
                assert_eq!(longer[0] > 1.0 + 1e-3, falls, "{duration}: {longer:?}");
            }
        }
    }
    // behind the last corner the duration is that of the whole load
    let long: Vec<f64> = (0..1000)
        .map(|i| 1100.0 * f64::from((100..=900).contains(&i)))
        .collect();
    let [ratio, at] = exceedance(&long, R94[0], 1e-4);
    assert!(ratio <= 1.0 && ratio > 1.0 - 1e-11 && (at - 80e-3).abs() < 1e-12);
    // two rectangles count together
    let twice = |i: usize| 2900.0 * f64::from((100..=275).contains(&i) || (500..=675).contains(&i));
    let twice: Vec<f64> = (0..1000).map(twice).collect();
    let [ratio, at] = exceedance(&twice, R94[0], 1e-4);
    assert!((ratio - 1.0).abs() < 1e-11 && (at - 35e-3).abs() < 1e-12);
}

/// A triangle of this length has the level h (1 - d/T) for d, so the ratio is a quotient that is monotonic between
/// corners.
#[test]
fn a_triangle_exceeds_a_falling_limit_at_a_corner() {
    for (length, duration) in [(70e-3, 0.0), (100e-3, 60e-3)] {
        let samples: Vec<Dual<f64>> = pulse(triangle, 1.0 / G, length, 1e-3)
            .iter()
            .map(|a| Dual::variable(2000.0) * Dual::constant(*a))
            .collect();
        let [ratio, at] = exceedance(&samples, R94[0], 1e-3);
        let expected = (1.0 - duration / length) / R94[0].at(duration);
        // rounding of durations does not count
        assert!((ratio.value / (2000.0 * expected) - 1.0).abs() < 1e-11);
        assert!((ratio.slope / expected - 1.0).abs() < 1e-11);
        assert!((at.value - duration).abs() < 1e-9);
    }
}

/// No level of any duration is higher beside the limit than the one found, which is that of its duration.
#[test]
fn no_duration_exceeds_a_falling_limit_by_more() {
    let limit = limit(&[[0.0, 3.0], [0.8, 2.5], [3.5, 2.0], [7.0, 0.4]]);
    for seed in 0..1000 {
        let samples = jagged(seed);
        let sizes: Vec<f64> = samples.iter().map(|a| a.abs()).collect();
        let last = (samples.len() - 1) as f64;
        let at =
            |duration: f64| response(Response::Clip { duration }, &sizes, 1.0) / limit.at(duration);
        let [ratio, duration] = exceedance(&samples, limit, 1.0);
        let here = at(duration.min(last));
        assert!(
            (here - ratio).abs() <= 1e-9 * ratio,
            "{seed}: {here} {ratio}"
        );
        for k in 0..=600 {
            let other = at(last * f64::from(k) / 600.0);
            assert!(
                other <= ratio * (1.0 + 1e-9),
                "{seed}, {k}: {other} {ratio}"
            );
        }
    }
}

#[test]
fn clips_of_a_lane_do_not_depend_on_others() {
    for seed in 0..300 {
        let mut one = jagged(seed);
        let mut other = jagged(seed / 3 + 1000);
        let count = one.len().min(other.len());
        one.truncate(count);
        other.truncate(count);
        if seed % 7 == 0 {
            other[count / 2] = f64::NAN;
        }
        let pairs: Vec<Pair> = one
            .iter()
            .zip(&other)
            .map(|(a, b)| Pair([*a, *b]))
            .collect();
        for duration in durations((count - 1) as f64) {
            for clip in [
                Response::Clip { duration },
                Response::ContiguousClip { duration },
                FALLING,
            ] {
                let Pair(found) = response(clip, &pairs, 1.0);
                for (found, samples) in found.iter().zip([&one, &other]) {
                    let alone = response(clip, samples, 1.0);
                    assert!(
                        found.to_bits() == alone.to_bits() || found.is_nan() && alone.is_nan(),
                        "{clip:?} of {seed}: {found}, {alone} alone"
                    );
                }
            }
        }
    }
}

#[test]
fn a_fall_is_clipped_exactly_between_samples() {
    // 7 − t/0.4 ms exceeds 7 − d/0.4 ms for d
    let samples: Vec<f64> = (0..40).map(|i| 7.0 - f64::from(i)).collect();
    for duration in [0.0, 0.3e-3, 1.0e-3, 3e-3, 15.6e-3] {
        let expected = 7.0 - duration / 0.4e-3;
        for clip in [
            Response::Clip { duration },
            Response::ContiguousClip { duration },
        ] {
            let found = response(clip, &samples, 0.4e-3);
            assert!((found - expected).abs() < 1e-12, "{clip:?}: {found}");
        }
        let back: Vec<f64> = samples.iter().rev().copied().collect();
        let found = response(Response::ContiguousClip { duration }, &back, 0.4e-3);
        assert!((found - expected).abs() < 1e-12, "{duration}: {found}");
    }
}

#[test]
fn two_pulses_add_up_only_where_breaks_do_not_matter() {
    // 2 ms of 50 twice, and 3 ms of 20
    let samples = sampled(30e-3, 1e-4, |t| {
        let within = |from: f64, to: f64| from <= t && t < to;
        match () {
            () if within(3e-3, 5e-3) || within(10e-3, 12e-3) => 50.0,
            () if within(20e-3, 23.2e-3) => 20.0,
            () => 0.0,
        }
    });
    assert_eq!(response(CLIP, &samples, 1e-4), 50.0);
    assert_eq!(response(CONTIGUOUS, &samples, 1e-4), 20.0);
}

#[test]
fn peaks_are_samples_and_their_times_lie_between() {
    // a parabola is found exactly: 3 − 2 (t − 0.4321)²
    let every = 0.01;
    let samples = sampled(1.0, every, |t| 3.0 - 2.0 * (t - 0.4321_f64).powi(2));
    assert_eq!(response(Response::Peak, &samples, every), samples[43]);
    let time = response(Response::TimeOfPeak, &samples, every);
    // differences of neighbours are 2·10⁻⁴, of numbers of 3
    assert!((time - 0.4321).abs() < 1e-12, "{time}");
    let below: Vec<f64> = samples.iter().map(|a| -a).collect();
    assert_eq!(response(Response::Minimum, &below, every), -samples[43]);
    assert_eq!(response(Response::TimeOfMinimum, &below, every), time);
    assert_eq!(response(Response::Magnitude, &below, every), samples[43]);
}

#[test]
fn peaks_at_the_ends_and_on_plateaus_stay_there() {
    let time = |samples: &[f64]| response(Response::TimeOfPeak, samples, 0.5);
    assert_eq!(time(&[3.0, 2.0, 1.0]), 0.0);
    assert_eq!(time(&[1.0, 2.0, 3.0]), 1.0);
    assert_eq!(time(&[4.0]), 0.0);
    // the first of equal peaks; on a plateau, between its first two samples
    assert_eq!(time(&[0.0, 3.0, 0.0, 3.0, 0.0]), 0.5);
    assert_eq!(time(&[0.0, 3.0, 3.0, 3.0, 0.0]), 0.75);
    assert_eq!(time(&[2.0, 2.0, 2.0]), 0.0);
}

#[test]
fn ranges_and_excursions_are_differences() {
    let samples = [1.0, 4.0, -3.0, 2.0];
    assert_eq!(response(Response::Range, &samples, 1.0), 7.0);
    assert_eq!(response(Response::Excursion, &samples, 1.0), 4.0);
    assert_eq!(response(Response::Final, &samples, 1.0), 2.0);
}

#[test]
fn lines_are_integrated_exactly() {
    let samples = [1.0, 2.0, 3.0, 4.0, 5.0];
    assert_eq!(response(Response::Integral, &samples, 0.25), 3.0);
    assert_eq!(response(Response::Mean, &samples, 0.25), 3.0);
    assert_eq!(response(Response::Mean, &[7.0], 0.25), 7.0);
    assert_eq!(response(Response::Integral, &[7.0], 0.25), 0.0);
}

#[test]
fn cubics_are_interpolated_exactly() {
    let cubic = |t: f64| 1.0 + t * (2.0 - t * (3.0 + t));
    let samples = sampled(1.0, 0.1, cubic);
    for at in [0.0, 0.03, 0.1, 0.57, 0.98, 1.0] {
        let found = response(Response::Value { at }, &samples, 0.1);
        assert!((found - cubic(at)).abs() < 1e-14, "{at}: {found}");
    }
    // a line through two
    assert_eq!(
        response(Response::Value { at: 0.25 }, &[1.0, 3.0], 1.0),
        1.5
    );
}

#[test]
fn questions_without_an_answer_are_answered_by_nan() {
    for kind in ALL {
        assert!(response::<f64>(kind, &[], 0.1).is_nan(), "{kind:?}");
        for every in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(response(kind, &[1.0_f64; 9], every).is_nan(), "{kind:?}");
        }
        if kind.scratch(9) > 0 {
            assert!(
                reduce(kind, &[1.0_f64; 9], 1e-3, &mut [0.0; 8]).is_nan(),
                "{kind:?}"
            );
        }
    }
    let outside = [
        Response::Value { at: 0.9 },
        Response::Value { at: -0.1 },
        Response::Value { at: f64::NAN },
        Response::Clip { duration: 0.9 },
        Response::ContiguousClip { duration: 0.9 },
        Response::Clip { duration: -1.0 },
        Response::Hic { window: 0.0 },
        Response::Hic { window: f64::NAN },
    ];
    for kind in outside {
        assert!(response(kind, &[1.0_f64; 9], 0.1).is_nan(), "{kind:?}");
    }
    assert!(response(HIC_15, &[1.0_f64], 0.1).is_nan());
}

#[test]
fn a_sample_that_is_no_number_shows() {
    for place in [0, 7, 20, 40] {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut samples = sampled(40e-3, 1e-3, |t| (100.0 * t).sin());
            samples[place] = bad;
            for kind in ALL {
                let local = matches!(kind, Response::Final | Response::Value { .. });
                let found = response(kind, &samples, 1e-3);
                assert!(
                    local || found.is_nan(),
                    "{kind:?} of {bad} at {place}: {found}"
                );
            }
        }
    }
}

#[test]
fn lanes_equal_scalar() {
    let one = sampled(40e-3, 0.3e-3, |t| {
        900.0 * (150.0 * t).sin() + 200.0 * (700.0 * t).cos()
    });
    let other = sampled(40e-3, 0.3e-3, |t| 500.0 * (90.0 * t).cos() - 300.0 * t);
    let pairs: Vec<Pair> = one
        .iter()
        .zip(&other)
        .map(|(a, b)| Pair([*a, *b]))
        .collect();
    for kind in ALL {
        let found = response(kind, &pairs, 0.3e-3);
        let alone = [&one, &other].map(|samples| response(kind, samples, 0.3e-3));
        assert_eq!(found, Pair(alone), "{kind:?}");
    }
}

/// A pulse with an oscillation; a parameter changes its height and width.
fn of_parameter<T: Real>(p: T) -> Vec<T> {
    let num = T::from_f64;
    (0..200)
        .map(|i| {
            let t = num(2e-4 * f64::from(i));
            let (sine, _) = (t * num(130.0) * p).sin_cos();
            let (_, ripple) = (t * num(611.3) + p).sin_cos();
            (sine * p * num(700.0)) + ripple * num(90.0)
        })
        .collect()
}

#[test]
fn derivatives_by_duals_are_those_by_differences() {
    let (p, step) = (1.031, 1e-6);
    let clips = [0.07e-3, 0.31e-3, 2.9e-3, 7.77e-3].map(|duration| {
        [
            Response::Clip { duration },
            Response::ContiguousClip { duration },
        ]
    });
    for kind in ALL.into_iter().chain(clips.into_iter().flatten()) {
        let exact = response(kind, &of_parameter(Dual::variable(p)), 2e-4);
        let at = |p: f64| response(kind, &of_parameter(p), 2e-4);
        assert_eq!(exact.value, at(p), "{kind:?}");
        let difference = (at(p + step) - at(p - step)) / (2.0 * step);
        // rounding of the values over the step, twice as much where neighbours are subtracted
        let bound = 1e-7 * exact.slope.abs() + 1e3 * f64::EPSILON * exact.value.abs() / step;
        assert!(
            (exact.slope - difference).abs() <= bound,
            "{kind:?}: {} {difference}",
            exact.slope
        );
        assert!(exact.slope != 0.0, "{kind:?}");
    }
}
