//! The cost of the approach of two ellipsoids and of a curve, over one double and over wide registers: nanoseconds for
//! each call.
//!
//! `cargo bench -p bryant-tests --bench contacts`

use bryant_runtime::force::approach::{plane, space};
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{Curve, Extrapolate, Real, Several, Task, Width};
use std::hint::black_box;
use std::time::Instant;

/// Two semi-axes of each shape \[m\]: shank and bumper, thigh and edge.
const SHAPES: [[f64; 2]; 4] = [[0.055, 0.24], [0.1, 0.1], [0.08, 0.24], [0.12, 0.1]];
/// Number of pairs in turn, so that branch prediction cannot learn one pair.
const PAIRS: usize = 64;
/// Distances of the centres, as shares of the distance at which bodies of this size touch.
const PLACES: [(&str, f64); 4] = [
    ("far", 1.8),
    ("near", 1.05),
    ("touching", 0.98),
    ("deep", 0.75),
];

/// Arguments of a call in the plane: two rotated shapes and their positions.
fn arguments(pair: usize, share: f64) -> [f64; 8] {
    let turned = |[a, b]: [f64; 2], angle: f64| {
        let (s, c) = angle.sin_cos();
        let (a, b) = (a * a, b * b);
        [
            a * c * c + b * s * s,
            a * s * s + b * c * c,
            (a - b) * c * s,
        ]
    };
    let at = pair as f64;
    let first = turned(SHAPES[pair % 2 * 2], 0.3 + 0.7 * at);
    let second = turned(SHAPES[1 + pair / 2 % 2 * 2], 0.1 + 1.1 * at);
    let (z, x) = (0.5 + 2.3 * at).sin_cos();
    let call = |way: f64| {
        let [a, b] = [first, second];
        [a[0], a[1], a[2], b[0], b[1], b[2], way * x, way * z]
    };
    let (mut inside, mut outside) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (inside + outside);
        let [a, b, c, d, e, f, x, z] = call(middle);
        match plane::approach(a, b, c, d, e, f, x, z)[2] > 0.0 {
            true => inside = middle,
            false => outside = middle,
        }
    }
    call(share * inside)
}

/// All pairs, one after the other.
struct All<'a, T>(&'a [[T; 8]], What);

#[derive(Clone, Copy)]
enum What {
    InPlane,
    InSpace,
    Curve,
}

const CURVE: Curve<4> = Curve::new(
    [[-0.1, 0.0], [0.0, 2.0], [0.05, 5.0], [0.1, 6.0]],
    Extrapolate::Linear,
);

impl<T: Real> Task for All<'_, T> {
    type Output = T;

    #[inline(always)]
    fn run(self) -> T {
        let mut sum = T::from_f64(0.0);
        for &[a, b, c, d, e, f, x, z] in self.0 {
            let zero = T::from_f64(0.0);
            let across = T::from_f64(0.01);
            sum += match self.1 {
                What::InPlane => plane::touch(a, b, c, d, e, f, x, z)[2],
                What::InSpace => {
                    let (p, q) = (across, across);
                    space::touch(a, p, b, zero, c, zero, d, q, e, zero, f, zero, x, zero, z)[3]
                }
                What::Curve => CURVE.value(x),
            };
        }
        sum
    }
}

/// The same in a separate function.
#[inline(never)]
fn all<T: Real>(calls: &[[T; 8]], what: What) -> T {
    T::dispatch(All(calls, what))
}

struct OfWidth<'a>(&'a str, &'a [[f64; 8]], What);

impl OfAnyWidth for OfWidth<'_> {
    type Output = ();

    fn run<T: Several<One = f64>>(self) {
        let OfWidth(name, calls, what) = self;
        let lanes: Vec<[T; 8]> = (0..calls.len())
            .map(|i| {
                let mut of_all = [T::from_f64(0.0); 8];
                for (k, lanes) in of_all.iter_mut().enumerate() {
                    for lane in 0..T::LANES {
                        *lanes = lanes.with_lane(lane, calls[(i + lane) % calls.len()][k]);
                    }
                }
                of_all
            })
            .collect();
        let name = format!("{name}, {} lanes, {PAIRS} calls", T::LANES);
        report(&name, || all(black_box(&lanes), what));
    }
}

/// Prints the median time of a call of `work` in 50 batches \[ns\].
fn report<T>(name: &str, mut work: impl FnMut() -> T) {
    const BATCH: u32 = 100;
    let mut times: Vec<f64> = (0..50)
        .map(|_| {
            let begin = Instant::now();
            for _ in 0..BATCH {
                black_box(work());
            }
            begin.elapsed().as_secs_f64() * 1e9 / f64::from(BATCH)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!("{name}: {:.0} ns", times[times.len() / 2]);
}

fn main() {
    for (place, share) in PLACES {
        let pairs: Vec<[f64; 8]> = (0..PAIRS).map(|pair| arguments(pair, share)).collect();
        for (name, what) in [("plane", What::InPlane), ("space", What::InSpace)] {
            let name = format!("touch in {name}, {place}");
            report(&format!("{name}, f64, {PAIRS} calls"), || {
                all(black_box(&pairs), what)
            });
            for width in [Width::Two, Width::Four, Width::Eight] {
                let _ = with_width(width, OfWidth(&name, &pairs, what));
            }
        }
        if place == "near" {
            let name = "curve of 4 points";
            report(&format!("{name}, f64, {PAIRS} calls"), || {
                all(black_box(&pairs), What::Curve)
            });
            for width in [Width::Two, Width::Four, Width::Eight] {
                let _ = with_width(width, OfWidth(name, &pairs, What::Curve));
            }
        }
    }
}
