//! Registers of all widths give the same bits, and those of the scalar arithmetic.

use super::{OfAnyWidth, Several, Width, with_width};
use crate::Task;
use crate::real::{Mask, Real};

/// Numbers of all kinds.
fn numbers() -> Vec<f64> {
    let mut numbers = vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        1e-300,
        5e-324,
        -5e-324,
        f64::MIN_POSITIVE,
        1e300,
        f64::MAX,
        f64::MIN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        0.1,
        1e5,
        -1e9,
        65_536.0,
        core::f64::consts::FRAC_PI_2,
    ];
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for i in 0..1000 {
        // xorshift
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let unit = (state >> 11) as f64 / (1u64 << 53) as f64;
        numbers.push((unit - 0.5) * 10f64.powi(i % 40 - 20));
    }
    numbers
}

/// What all functions make of pairs of numbers, as bits; NaN is one.
struct Everything;

impl OfAnyWidth for Everything {
    type Output = Vec<[u64; FUNCTIONS]>;
    fn run<T: Several<One = f64>>(self) -> Self::Output {
        let all = numbers();
        let (left, right): (Vec<f64>, Vec<f64>) = (0..all.len() * 7)
            .map(|i| (all[i % all.len()], all[(i * 13 + 5) % all.len()]))
            .unzip();
        let mut results = Vec::new();
        let pad = |values: &[f64]| {
            let mut lanes = [0.0; super::MOST_LANES];
            lanes[..values.len()].copy_from_slice(values);
            T::of_lanes(&lanes)
        };
        for (x, y) in left.chunks(T::LANES).zip(right.chunks(T::LANES)) {
            let values = T::enable(Functions(pad(x), pad(y))).map(T::lanes);
            for lane in 0..x.len() {
                results.push(values.map(|value| match value[lane] {
                    number if number.is_nan() => u64::MAX,
                    number => number.to_bits(),
                }));
            }
        }
        results
    }
}

const FUNCTIONS: usize = 19;

struct Functions<T>(T, T);

impl<T: Real> Task for Functions<T> {
    type Output = [T; FUNCTIONS];
    #[inline(always)]
    fn run(self) -> [T; FUNCTIONS] {
        let Functions(x, y) = self;
        let (sine, cosine) = x.sin_cos();
        let less = x.lt(y);
        let more = y.lt(x);
        let [one, zero] = [1.0, 0.0].map(T::from_f64);
        [
            x + y,
            x - y,
            x * y,
            x / y,
            -x,
            x.mul_add(y, x),
            x.abs().sqrt(),
            x.abs(),
            x.max(y),
            x.min(y),
            sine,
            cosine,
            x.exp(),
            x.abs().ln(),
            x.atan2(y),
            x.abs().powf(y),
            T::select(less.or(more), x, y),
            T::select(less.not().and(more.not()), one, zero),
            T::select(T::Mask::of_lanes(less.lanes()), one, zero),
        ]
    }
}

#[test]
fn all_widths_give_the_same_bits() {
    let one = with_width(Width::One, Everything);
    for width in [Width::Four, Width::Eight] {
        if let (Some(wide), Some(one)) = (with_width(width, Everything), &one) {
            for (i, (wide, one)) in wide.iter().zip(one).enumerate() {
                assert_eq!(wide, one, "{width:?}, pair {i}");
            }
        }
    }
}

#[test]
fn what_ieee_754_defines_is_that_of_a_double() {
    struct Pairs;
    impl OfAnyWidth for Pairs {
        type Output = ();
        fn run<T: Several<One = f64>>(self) {
            let all = numbers();
            for (i, &x) in all.iter().enumerate() {
                let y = all[(i * 13 + 5) % all.len()];
                let (a, b) = (T::from_f64(x), T::from_f64(y));
                let same = |ours: T, theirs: f64| {
                    let ours = ours.lane(T::LANES - 1);
                    assert!(
                        ours.to_bits() == theirs.to_bits() || (ours.is_nan() && theirs.is_nan()),
                        "{x:?} {y:?}: {ours:?} {theirs:?}"
                    );
                };
                same(a + b, x + y);
                same(a - b, x - y);
                same(a * b, x * y);
                same(a / b, x / y);
                same(-a, -x);
                same(a.abs(), x.abs());
                same(a.abs().sqrt(), x.abs().sqrt());
                same(a.max(b), if x < y { y } else { x });
                same(a.min(b), if y < x { y } else { x });
                assert_eq!(a.lt(b).any(), x < y);
                assert_eq!(a.lt(b).all(), x < y);
                assert_eq!(a.is_finite(), x.is_finite());
                assert_eq!(a == b, x == y);
            }
        }
    }
    for width in Width::ALL {
        with_width(width, Pairs);
    }
}

#[test]
fn a_lane_is_what_was_put_there() {
    struct Places;
    impl OfAnyWidth for Places {
        type Output = ();
        fn run<T: Several<One = f64>>(self) {
            let mut all = T::from_f64(-1.0);
            for i in 0..T::LANES {
                all = all.with_lane(i, i as f64);
            }
            for i in 0..T::LANES {
                assert_eq!(all.lane(i), i as f64);
                let mask = T::Mask::of_lanes(1 << i);
                assert_eq!(mask.lanes(), 1 << i);
                assert!(mask.any() && mask.all() == (T::LANES == 1));
                let picked = T::select(mask, T::from_f64(9.0), all);
                for k in 0..T::LANES {
                    let expected = if k == i { 9.0 } else { k as f64 };
                    assert_eq!(picked.lane(k), expected);
                }
            }
            assert_eq!(all.to_f64(), (T::LANES - 1) as f64);
            let turned: [u8; super::MOST_LANES] =
                std::array::from_fn(|i| ((3 * i + 1) % T::LANES) as u8);
            let ordered = all.ordered(T::order(&turned));
            for (i, lane) in turned.iter().enumerate().take(T::LANES) {
                assert_eq!(ordered.lane(i), f64::from(*lane));
            }
        }
    }
    for width in Width::ALL {
        with_width(width, Places);
    }
}

#[test]
fn widths_have_names_and_the_widest_is_there() {
    for width in Width::ALL {
        assert_eq!(Width::named(width.name()), Some(width));
        assert_eq!(
            with_width(width, Lanes),
            width.there().then_some(width.lanes())
        );
    }
    assert!(Width::widest().there() && Width::Plain.there());
    assert_eq!(Width::named("9"), None);
}

struct Lanes;

impl OfAnyWidth for Lanes {
    type Output = usize;
    fn run<T: Several<One = f64>>(self) -> usize {
        T::LANES
    }
}
