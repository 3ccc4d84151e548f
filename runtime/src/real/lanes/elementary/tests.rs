//! Compares each function with [`DoubleDouble`], whose own errors are 10⁻³¹. Errors are in units of the last place.

mod angle;
mod circle;
mod exponential;
mod power;

use crate::real::lanes::register::Doubles;
use crate::real::lanes::scalar_register::{self, Alone};
use crate::{DoubleDouble, Real};
use std::sync::OnceLock;
use std::time::{SystemTime, UNIX_EPOCH};

/// The arithmetic of registers with fused multiply-adds.
type Fused = Alone<f64, scalar_register::Fused>;
/// The arithmetic of registers without them.
type Unfused = Alone<f64, scalar_register::Apart>;

/// The number of random points on which each bound is tried: other points in each run, and ten times as many with
/// `BRYANT_TESTS=all`.
fn points() -> usize {
    let all = std::env::var("BRYANT_TESTS").is_ok_and(|which| which == "all");
    if all { 1_000_000 } else { 100_000 }
}

/// Random numbers, others in each run (Steele, Lea and Flood 2014, "SplitMix"). A test that fails says where.
struct Random(u64);

impl Random {
    /// A sequence of its own for each seed.
    fn new(seed: u64) -> Self {
        static RUN: OnceLock<u64> = OnceLock::new();
        let run = RUN.get_or_init(|| {
            let now = SystemTime::now().duration_since(UNIX_EPOCH);
            now.map_or(0, |since| since.as_nanos() as u64)
        });
        Random(run.wrapping_add(seed << 40))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [−1, 1).
    fn even(&mut self) -> f64 {
        (self.bits() as i64) as f64 / 9_223_372_036_854_775_808.0
    }

    /// Any finite double; all exponents equally often.
    fn any(&mut self) -> f64 {
        loop {
            let x = f64::from_bits(self.bits());
            if x.is_finite() {
                return x;
            }
        }
    }
}

/// The first lane of a function of one argument.
fn of<R: Doubles>(function: impl Fn(R) -> R, x: f64) -> f64 {
    function(R::splat(x)).lane(0)
}

/// `x` and the next doubles around it.
fn around(x: f64) -> impl Iterator<Item = f64> {
    (-3_i64..=3).map(move |i| f64::from_bits((x.to_bits() as i64 + i) as u64))
}

/// The distance of `found` from the exact result, in units of its last place; infinite for NaN.
fn ulps(found: f64, exact: DoubleDouble) -> f64 {
    if found.to_bits() == exact.to_f64().to_bits() {
        // the best that is possible, as is an infinite one
        return 0.5;
    }
    let size = exact.to_f64().abs();
    let unit = (f64::from_bits(size.to_bits() + 1) - size).max(f64::from_bits(1));
    let error = (DoubleDouble::from_f64(found) - exact).to_f64().abs();
    // half of the smallest number is no double
    let error = error / unit;
    if error.is_nan() { f64::INFINITY } else { error }
}

/// The largest of several errors, and its place.
#[derive(Debug, Default)]
struct Worst {
    ulps: f64,
    at: [f64; 2],
}

impl Worst {
    fn consider(&mut self, ulps: f64, at: [f64; 2]) {
        if self.ulps < ulps {
            *self = Worst { ulps, at };
        }
    }

    #[track_caller]
    fn is_at_most(&self, bound: f64) {
        assert!(self.ulps <= bound, "{} ulp at {:?}", self.ulps, self.at);
    }
}
