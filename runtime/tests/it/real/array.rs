//! Several doubles side by side.

use bryant_runtime::real::{Array2, Array4, Array8};
use bryant_runtime::real::{Dual, Mask, Real};

/// Numbers of many kinds.
const NUMBERS: [f64; 10] = [
    0.0,
    -0.0,
    0.3,
    -1.7,
    2.5,
    1e-300,
    -4e10,
    f64::INFINITY,
    f64::NAN,
    0.75,
];

fn bits(x: f64) -> u64 {
    match x.is_nan() {
        true => u64::MAX,
        false => x.to_bits(),
    }
}

/// A function of three arguments over any scalar.
trait Function {
    fn of<T: Real>(a: T, b: T, c: T) -> T;
}

macro_rules! functions {
    ($($name:ident: |$a:ident, $b:ident, $c:ident| $value:expr;)*) => {
        $(
            struct $name;
            impl Function for $name {
                fn of<T: Real>($a: T, $b: T, $c: T) -> T {
                    let _ = ($a, $b, $c);
                    $value
                }
            }
        )*
        #[test]
        fn lanes_are_doubles_with_their_slopes() {
            $(compare::<$name>(stringify!($name));)*
        }
    };
}

functions! {
    Sum: |a, b, c| a + b;
    Difference: |a, b, c| a - b;
    Product: |a, b, c| a * b;
    Quotient: |a, b, c| a / b;
    Fused: |a, b, c| a.mul_add(b, c);
    Root: |a, b, c| a.sqrt();
    Sine: |a, b, c| a.sin_cos().0;
    Cosine: |a, b, c| a.sin_cos().1;
    Angle: |a, b, c| a.atan2(b);
    Exponential: |a, b, c| a.exp();
    Logarithm: |a, b, c| a.abs().ln();
    Power: |a, b, c| a.abs().powf(b);
    Larger: |a, b, c| a.max(b);
    Smaller: |a, b, c| a.min(b);
    Chosen: |a, b, c| T::select(a.lt(b), c, -a);
    Negative: |a, b, c| -a;
}

fn compare<F: Function>(name: &str) {
    for (i, a) in NUMBERS.into_iter().enumerate() {
        for (j, b) in NUMBERS.into_iter().enumerate() {
            let c = NUMBERS[(i + 2 * j) % NUMBERS.len()];
            // one value in all lanes, or another in each; slopes differ
            for shift in [0, 1] {
                let at = |k: usize, x: f64, lane: usize| Dual {
                    value: if shift == 0 {
                        x
                    } else {
                        NUMBERS[(k + lane) % 10]
                    },
                    slope: NUMBERS[(3 * k + 7 * lane + j) % 10],
                };
                let lane = |lane| [at(i, a, lane), at(j, b, lane), at(i + j, c, lane)];
                let eight = [0, 1, 2].map(|k| Dual {
                    value: Array8(core::array::from_fn(|l| lane(l)[k].value)),
                    slope: Array8(core::array::from_fn(|l| lane(l)[k].slope)),
                });
                let four = [0, 1, 2].map(|k| Dual {
                    value: Array4(core::array::from_fn(|l| lane(l)[k].value)),
                    slope: Array4(core::array::from_fn(|l| lane(l)[k].slope)),
                });
                let two = [0, 1, 2].map(|k| Dual {
                    value: Array2(core::array::from_fn(|l| lane(l)[k].value)),
                    slope: Array2(core::array::from_fn(|l| lane(l)[k].slope)),
                });
                let two = F::of(two[0], two[1], two[2]);
                let eight = F::of(eight[0], eight[1], eight[2]);
                let four = F::of(four[0], four[1], four[2]);
                for l in 0..8 {
                    let [a, b, c] = lane(l);
                    let alone = F::of(a, b, c);
                    let alone = [alone.value, alone.slope].map(bits);
                    assert_eq!(
                        [eight.value.0[l], eight.slope.0[l]].map(bits),
                        alone,
                        "{name}"
                    );
                    if l < 2 {
                        assert_eq!([two.value.0[l], two.slope.0[l]].map(bits), alone, "{name}");
                    }
                    if l < 4 {
                        assert_eq!(
                            [four.value.0[l], four.slope.0[l]].map(bits),
                            alone,
                            "{name}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn masks_know_their_lanes() {
    let mask = Array4([1.0, 5.0, f64::NAN, 0.0]).lt(Array4([2.0; 4]));
    assert_eq!(mask.lanes(), 0b1001);
    assert_eq!(mask.not().lanes(), 0b0110);
    assert!(mask.any() && !mask.all() && mask.or(mask.not()).all());
    assert!(!mask.and(mask.not()).any());
    assert_eq!(<Array4 as Real>::Mask::of_lanes(!0).lanes(), 0b1111);
    assert!(!Array8([f64::NAN; 8]).is_finite() && Array8([1.0; 8]).is_finite());
    assert_eq!(Array4([1.0, 7.0, 3.0, -9.0]).to_f64(), 7.0);
}
