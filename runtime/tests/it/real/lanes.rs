//! Registers of all widths give the same bits as each other and as scalar arithmetic, for doubles and for singles.

use bryant_runtime::Task;
use bryant_runtime::real::lanes::{
    OfAnyWidth, Several, Width, with_emulated, with_width, with_width_of_singles,
};
use bryant_runtime::real::{Mask, Real};

/// Numbers of many kinds.
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
        // the ends of the range of singles
        1e-38,
        -1e-45,
        3e38,
        f32::MAX as f64,
        // far angles and large powers of singles
        1e30,
        -88.7,
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

/// The results of all functions for pairs of numbers, as bits; all NaN are equal.
struct Everything;

impl<F: Real> OfAnyWidth<F> for Everything {
    type Output = Vec<[u64; FUNCTIONS]>;
    fn run<T: Several<One = F>>(self) -> Self::Output {
        let (left, right): (Vec<F>, Vec<F>) = pairs::<F>().unzip();
        let mut results = Vec::new();
        let pad = |values: &[F]| {
            let mut lanes = [F::from_f64(0.0); bryant_runtime::real::lanes::MOST_LANES];
            lanes[..values.len()].copy_from_slice(values);
            T::of_lanes(&lanes)
        };
        for (x, y) in left.chunks(T::LANES).zip(right.chunks(T::LANES)) {
            let values = T::dispatch(Functions(pad(x), pad(y))).map(T::lanes);
            for lane in 0..x.len() {
                results.push(values.map(|value| bits(value[lane])));
            }
        }
        results
    }
}

/// Numbers of many kinds, in pairs.
fn pairs<F: Real>() -> impl Iterator<Item = (F, F)> {
    let all: Vec<F> = numbers().into_iter().map(F::from_f64).collect();
    let count = all.len();
    (0..count * 7).map(move |i| (all[i % count], all[(i * 13 + 5) % count]))
}

/// The bits of a number as a double; all NaN are equal.
fn bits<F: Real>(number: F) -> u64 {
    match number.to_f64() {
        number if number.is_nan() => u64::MAX,
        number => number.to_bits(),
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
    all_alike("doubles", |width| with_width(width, Everything));
    all_alike("singles", |width| with_width_of_singles(width, Everything));
}

#[test]
fn fused_by_a_function_the_bits_are_the_same() {
    let by_instruction = with_width(Width::widest(), Everything).expect("registers");
    let by_function = with_emulated(Everything);
    for (i, (one, other)) in by_function.iter().zip(&by_instruction).enumerate() {
        assert_eq!(one, other, "pair {i}");
    }
    assert_eq!(by_function.len(), by_instruction.len());
}

fn all_alike(what: &str, of: impl Fn(Width) -> Option<Vec<[u64; FUNCTIONS]>>) {
    let one = of(Width::One);
    for width in [Width::Two, Width::Four, Width::Eight] {
        if let (Some(wide), Some(one)) = (of(width), &one) {
            for (i, (wide, one)) in wide.iter().zip(one).enumerate() {
                assert_eq!(wide, one, "{what}, {width:?}, pair {i}");
            }
        }
    }
}

#[test]
fn what_ieee_754_defines_is_that_of_the_scalar() {
    struct Pairs;
    impl<F: Real<Mask = bool>> OfAnyWidth<F> for Pairs {
        type Output = ();
        fn run<T: Several<One = F>>(self) {
            for (x, y) in pairs::<F>() {
                let [mut a, mut b] = [1.0, 2.0].map(T::from_f64);
                for i in 0..T::LANES {
                    (a, b) = (a.with_lane(i, x), b.with_lane(i, y));
                }
                let same = |ours: T, theirs: F| {
                    let ours = ours.lane(T::LANES - 1);
                    assert_eq!(bits(ours), bits(theirs), "{x:?} {y:?}: {ours:?} {theirs:?}");
                };
                same(a + b, x + y);
                same(a - b, x - y);
                same(a * b, x * y);
                same(a / b, x / y);
                same(-a, -x);
                same(a.abs(), x.abs());
                same(a.abs().sqrt(), x.abs().sqrt());
                same(a.max(b), x.max(y));
                same(a.min(b), x.min(y));
                same(a.frozen(), x);
                assert_eq!(a.lt(b).any(), x.lt(y));
                assert_eq!(a.lt(b).all(), x.lt(y));
                assert_eq!(a.is_finite(), x.is_finite());
                assert_eq!(a == b, x == y);
            }
        }
    }
    for width in Width::ALL {
        with_width(width, Pairs);
        with_width_of_singles(width, Pairs);
    }
}

#[test]
fn products_and_sums_are_rounded_once_where_they_are_fused() {
    struct Residual;
    impl<F: Real> OfAnyWidth<F> for Residual {
        type Output = [f64; 2];
        fn run<T: Several<One = F>>(self) -> [f64; 2] {
            // (1 + ε)² = 1 + 2ε + ε²
            let x = T::from_f64(1.0 + T::EPSILON);
            let rest = x.mul_add(x, T::from_f64(-1.0 - 2.0 * T::EPSILON));
            [rest.to_f64(), T::EPSILON]
        }
    }
    for width in Width::ALL {
        let residuals = [
            with_width(width, Residual),
            with_width_of_singles(width, Residual),
        ];
        for [rest, epsilon] in residuals.into_iter().flatten() {
            assert_eq!(rest, epsilon * epsilon, "{width:?}");
        }
    }
}

/// −(a b + c) is −0 where a b and c cancel, and −(a b) − c is 0.
#[test]
fn a_sum_that_is_negated_is_computed_before() {
    struct Cancelled;
    impl<F: Real> OfAnyWidth<F> for Cancelled {
        type Output = [bool; 2];
        fn run<T: Several<One = F>>(self) -> [bool; 2] {
            let [a, b, c] = [3.0, 2.0, -6.0].map(|x| T::from_f64(std::hint::black_box(x)));
            // 1/±0
            let inverse = |zero: T| (T::from_f64(1.0) / zero).lane(0).to_f64();
            [-a.mul_add(b, c), (-a).mul_add(b, -c)].map(|zero| inverse(zero) < 0.0)
        }
    }
    for width in Width::ALL {
        for negative in [
            with_width(width, Cancelled),
            with_width_of_singles(width, Cancelled),
        ] {
            assert!(
                negative.is_none_or(|negative| negative == [true, false]),
                "{width:?}"
            );
        }
    }
}

#[test]
fn elementary_functions_of_singles_are_those_of_doubles_rounded() {
    struct Errors;
    impl OfAnyWidth<f32> for Errors {
        type Output = usize;
        fn run<T: Several<One = f32>>(self) -> usize {
            let mut off = 0;
            for (x, y) in pairs::<f32>() {
                let ours = T::dispatch(Functions(T::from_f64(x.into()), T::from_f64(y.into())));
                let (x, y) = (f64::from(x), f64::from(y));
                let (sine, cosine) = x.sin_cos();
                let exact = [
                    sine,
                    cosine,
                    x.exp(),
                    x.abs().ln(),
                    x.atan2(y),
                    x.abs().powf(y),
                ];
                for (k, (ours, exact)) in ours[10..16].iter().zip(exact).enumerate() {
                    let (ours, exact) = (ours.lane(0), exact as f32);
                    let near = [exact.next_down(), exact, exact.next_up()].contains(&ours);
                    assert!(
                        near || ours.is_nan() && exact.is_nan(),
                        "{k} of {x:e} {y:e}: {ours:e} {exact:e}"
                    );
                    off += usize::from(near && ours != exact);
                }
            }
            off
        }
    }
    for width in Width::ALL {
        // two doubles that both err by 1 ulp round to different singles in one of 2²⁸ cases
        assert_eq!(with_width_of_singles(width, Errors).unwrap_or(0), 0);
    }
}

#[test]
fn a_lane_is_what_was_put_there() {
    struct Places;
    impl<F: Real> OfAnyWidth<F> for Places {
        type Output = ();
        fn run<T: Several<One = F>>(self) {
            let number = |i: usize| F::from_f64(i as f64);
            let mut all = T::from_f64(-1.0);
            for i in 0..T::LANES {
                all = all.with_lane(i, number(i));
            }
            for i in 0..T::LANES {
                assert_eq!(all.lane(i), number(i));
                let mask = T::Mask::of_lanes(1 << i);
                assert_eq!(mask.lanes(), 1 << i);
                assert!(mask.any() && mask.all() == (T::LANES == 1));
                let picked = T::select(mask, T::from_f64(99.0), all);
                for k in 0..T::LANES {
                    assert_eq!(picked.lane(k), number(if k == i { 99 } else { k }));
                }
            }
            assert_eq!(all.to_f64(), (T::LANES - 1) as f64);
            assert_eq!((-all).to_f64(), 0.0);
            let turned: [u8; bryant_runtime::real::lanes::MOST_LANES] =
                std::array::from_fn(|i| ((3 * i + 1) % T::LANES) as u8);
            let ordered = all.ordered(T::order(&turned));
            for (i, lane) in turned.iter().enumerate().take(T::LANES) {
                assert_eq!(ordered.lane(i), number(usize::from(*lane)));
            }
        }
    }
    for width in Width::ALL {
        with_width(width, Places);
        with_width_of_singles(width, Places);
    }
}

#[test]
fn widths_have_names_and_the_widest_is_there() {
    for width in Width::ALL {
        assert_eq!(Width::named(width.name()), Some(width));
        assert_eq!(
            with_width(width, Lanes),
            width.is_available().then_some(width.lanes())
        );
        assert_eq!(
            with_width_of_singles(width, Lanes),
            width.is_available().then_some(width.lanes_of_singles())
        );
    }
    assert!(Width::widest().is_available() && Width::One.is_available());
    assert_eq!(Width::named("9"), None);
}

struct Lanes;

impl<F: Real> OfAnyWidth<F> for Lanes {
    type Output = usize;
    fn run<T: Several<One = F>>(self) -> usize {
        T::LANES
    }
}
