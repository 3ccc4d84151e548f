//! Dual numbers.

use crate::scalars::Pair;
use bryant_runtime::real::Dual;
use bryant_runtime::{DoubleDouble, Mask, Real};

/// Name of a function, how a scalar computes it, and \[f, f′, f″\].
type Function<T> = (&'static str, fn(T) -> T, [f64; 3]);

/// Functions, at x > 0.
fn functions<T: Real>(x: f64) -> Vec<Function<T>> {
    let (s, k) = x.sin_cos();
    let (e, l, r) = (x.exp(), x.ln(), x.sqrt());
    let q = 1.0 + x * x;
    vec![
        ("x + x x", |x| x + x * x, [x + x * x, 1.0 + 2.0 * x, 2.0]),
        (
            "3 − 1/x",
            |x| T::from_f64(3.0) - T::from_f64(1.0) / x,
            [3.0 - 1.0 / x, 1.0 / (x * x), -2.0 / (x * x * x)],
        ),
        (
            "x/(1 + x²)",
            |x| x / x.mul_add(x, T::from_f64(1.0)),
            [
                x / q,
                (1.0 - x * x) / (q * q),
                2.0 * x * (x * x - 3.0) / (q * q * q),
            ],
        ),
        ("−√x", |x| -x.sqrt(), [-r, -0.5 / r, 0.25 / (x * r)]),
        ("sin", |x| x.sin_cos().0, [s, k, -s]),
        ("cos", |x| x.sin_cos().1, [k, -s, -k]),
        (
            "atan2(x, 1)",
            |x| x.atan2(T::from_f64(1.0)),
            [x.atan(), 1.0 / q, -2.0 * x / (q * q)],
        ),
        (
            "atan2(1, −x)",
            |x| T::from_f64(1.0).atan2(-x),
            [1.0_f64.atan2(-x), 1.0 / q, -2.0 * x / (q * q)],
        ),
        ("exp", |x| x.exp(), [e, e, e]),
        ("ln", |x| x.ln(), [l, 1.0 / x, -1.0 / (x * x)]),
        (
            "x^2.5",
            |x| x.powf(T::from_f64(2.5)),
            [x * x * r, 2.5 * x * r, 3.75 * r],
        ),
        ("2^x", |x| T::from_f64(2.0).powf(x), {
            let (two, l) = (2.0_f64.powf(x), 2.0_f64.ln());
            [two, two * l, two * l * l]
        }),
        ("x^x", |x| x.powf(x), {
            let p = x.powf(x);
            [p, p * (l + 1.0), p * ((l + 1.0) * (l + 1.0) + 1.0 / x)]
        }),
        (
            "|x − 2|³",
            |x| {
                let d = (x - T::from_f64(2.0)).abs();
                d * d * d
            },
            {
                let d = (x - 2.0).abs();
                [d * d * d, 3.0 * d * (x - 2.0), 6.0 * d]
            },
        ),
    ]
}

#[test]
fn slopes_are_the_derivatives() {
    for i in 1..60 {
        let x = 0.07 * f64::from(i);
        for (name, of, [value, first, second]) in functions::<Dual<f64>>(x) {
            let ours = of(Dual::variable(x));
            // a few operations on numbers of this size
            let bound = 32.0 * f64::EPSILON * (1.0 + value.abs() + first.abs() + second.abs());
            assert!(
                (ours.value - value).abs() <= bound,
                "{name} at {x}: {ours:?}"
            );
            assert!(
                (ours.slope - first).abs() <= bound,
                "{name} at {x}: {ours:?}, not {first}"
            );
        }
        for (name, of, [value, first, second]) in functions::<Dual<Dual<f64>>>(x) {
            let ours = of(Dual::variable(Dual::variable(x)));
            let bound = 32.0 * f64::EPSILON * (1.0 + value.abs() + first.abs() + second.abs());
            assert!((ours.value.slope - first).abs() <= bound, "{name} at {x}");
            assert_eq!(ours.value.slope, ours.slope.value, "{name} at {x}");
            assert!(
                (ours.slope.slope - second).abs() <= 4.0 * bound,
                "{name} at {x}: {ours:?}, not {second}"
            );
        }
    }
}

#[test]
fn values_are_those_of_the_scalar_below() {
    for i in 1..60 {
        let x = 0.07 * f64::from(i);
        for (dual, plain) in functions::<Dual<f64>>(x)
            .into_iter()
            .zip(functions::<f64>(x))
        {
            assert_eq!(
                dual.1(Dual::variable(x)).value,
                plain.1(x),
                "{} at {x}",
                plain.0
            );
        }
        let lanes = Pair([x, 2.0 * x]);
        for (dual, plain) in functions::<Dual<Pair>>(x)
            .into_iter()
            .zip(functions::<Dual<f64>>(x))
        {
            let both = dual.1(Dual::variable(lanes));
            // Pair has no exponential of its own
            if ["exp", "ln", "2^x", "x^x"].contains(&plain.0) {
                continue;
            }
            for lane in 0..2 {
                let alone = plain.1(Dual::variable(lanes.0[lane]));
                let expected = (alone.value, alone.slope);
                assert_eq!(
                    (both.value.0[lane], both.slope.0[lane]),
                    expected,
                    "{}",
                    plain.0
                );
            }
        }
        for (dual, (name, _, [value, first, second])) in functions::<Dual<f32>>(x)
            .into_iter()
            .zip(functions::<f32>(x))
        {
            let ours = dual.1(Dual::variable(x as f32));
            let bound =
                64.0 * f64::from(f32::EPSILON) * (1.0 + value.abs() + first.abs() + second.abs());
            assert!(
                (f64::from(ours.slope) - first).abs() <= bound,
                "{name} at {x}: {ours:?}"
            );
        }
    }
}

#[test]
fn slopes_have_all_digits_of_the_scalar_below() {
    // compared with a central difference in double-double: the error is h² = 10⁻²⁰ and the rounding 10⁻³⁰/h
    let h = DoubleDouble::from_f64(1e-10);
    for i in 1..20 {
        let x = DoubleDouble::from_f64(0.23 * f64::from(i));
        let plain = functions::<DoubleDouble>(x.to_f64());
        let twice = functions::<Dual<DoubleDouble>>(x.to_f64());
        for ((name, of, [value, first, second]), (_, dual, _)) in plain.into_iter().zip(twice) {
            let difference = (of(x + h) - of(x - h)) / (h + h);
            let slope = dual(Dual::variable(x)).slope;
            let off = (slope - difference).to_f64().abs();
            let size = 1.0 + value.abs() + first.abs() + second.abs();
            // third derivatives of these are below 100 times that
            assert!(off <= 1e-20 * 100.0 * size, "{name} at {x:?}: {off:e}");
        }
    }
}

#[test]
fn fused_and_separate_operations_agree() {
    let dual = |value: f64, slope: f64| Dual { value, slope };
    let (a, b, c) = (dual(0.3, 1.7), dual(-2.1, 0.4), dual(5.0, -0.9));
    let (fused, separate) = (a.mul_add(b, c), a * b + c);
    assert!((fused.value - separate.value).abs() <= 8.0 * f64::EPSILON);
    assert!((fused.slope - separate.slope).abs() <= 8.0 * f64::EPSILON);
    let back = a / b * b;
    assert!((back.value - a.value).abs() <= 4.0 * f64::EPSILON);
    assert!((back.slope - a.slope).abs() <= 16.0 * f64::EPSILON);
}

#[test]
fn where_there_is_no_derivative_what_stands_still_has_slope_0() {
    let (still, moving) = (Dual::constant(0.0_f64), Dual::variable(0.0_f64));
    let half = Dual::constant(0.5);
    assert_eq!(still.sqrt(), still);
    assert_eq!(moving.sqrt().slope, f64::INFINITY);
    assert!(!moving.sqrt().is_finite());
    assert_eq!(still.powf(half), still);
    assert_eq!(moving.powf(half).slope, f64::INFINITY);
    assert_eq!(moving.powf(Dual::constant(2.0)), still);
    assert_eq!(moving.powf(Dual::constant(1.0)), moving);
    assert_eq!(moving.powf(Dual::constant(0.0)), Dual::constant(1.0));
    // xᵖ ln x is 0 at 0
    assert_eq!(still.powf(Dual::variable(1.5)), still);
    assert_eq!(still.atan2(still), still);
    assert!(moving.atan2(still).slope.is_nan());
    assert_eq!(moving.atan2(Dual::constant(2.0)).slope, 0.5);
}

#[test]
fn second_derivatives_pass_places_where_the_first_is_0() {
    // √(1 + x²) at 0: its argument stands still, but its second derivative is not 0
    let x = Dual::variable(Dual::variable(0.0_f64));
    let one = Dual::constant(Dual::constant(1.0));
    let root = x.mul_add(x, one).sqrt();
    assert_eq!(
        [root.value.value, root.slope.value, root.slope.slope],
        [1.0, 0.0, 1.0]
    );
    let square = x.powf(Dual::constant(Dual::constant(2.0)));
    assert_eq!([square.slope.value, square.slope.slope], [0.0, 2.0]);
}

#[test]
fn choices_take_value_and_slope_together() {
    let dual = |value: f64, slope: f64| Dual { value, slope };
    let (a, b) = (dual(1.0, 3.0), dual(2.0, -4.0));
    assert_eq!([a.max(b), a.min(b), b.max(a), b.min(a)], [b, a, b, a]);
    // for equal arguments, the one on the left
    let other = dual(1.0, 7.0);
    assert_eq!([a.max(other), a.min(other), other.max(a)], [a, a, other]);
    assert_eq!(
        [dual(-2.0, 1.0).abs(), dual(0.0, 1.0).abs()],
        [dual(2.0, -1.0), dual(0.0, 1.0)]
    );
    assert!(a.lt(b).all() && !a.lt(other) && !other.lt(a));
    let nan = Dual::constant(f64::NAN);
    assert_eq!(Dual::select(true, a, nan), a);
    assert_eq!(a.to_f64(), 1.0);
}

#[test]
fn what_is_no_number_shows() {
    let nan = Dual::variable(f64::NAN);
    let one = Dual::constant(1.0);
    for x in [
        nan.taint(),
        nan.sqrt(),
        nan.abs(),
        nan.max(one),
        nan.powf(one),
        nan.atan2(one),
        one.atan2(nan),
        nan.exp(),
        nan.ln(),
        nan.sin_cos().0,
        nan * one,
        one / nan,
    ] {
        assert!(x.value.is_nan() && !x.is_finite(), "{x:?}");
    }
    let steep = Dual {
        value: 1.0,
        slope: f64::INFINITY,
    };
    assert!(!steep.is_finite() && steep.taint().slope.is_nan());
    assert_eq!(Dual::variable(2.0).taint(), Dual::constant(0.0));
}
