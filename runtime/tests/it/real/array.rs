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

/// The results of functions of three arguments, with their names.
fn results<T: Real>([a, b, c]: [T; 3]) -> [(&'static str, T); 16] {
    [
        ("sum", a + b),
        ("difference", a - b),
        ("product", a * b),
        ("quotient", a / b),
        ("fused", a.mul_add(b, c)),
        ("root", a.sqrt()),
        ("sine", a.sin_cos().0),
        ("cosine", a.sin_cos().1),
        ("angle", a.atan2(b)),
        ("exponential", a.exp()),
        ("logarithm", a.abs().ln()),
        ("power", a.abs().powf(b)),
        ("larger", a.max(b)),
        ("smaller", a.min(b)),
        ("chosen", T::select(a.lt(b), c, -a)),
        ("negative", -a),
    ]
}

/// Value and slope of the lane of a dual number, in bits.
fn lane_of<T: Real>(dual: Dual<T>, lane: impl Fn(T) -> f64) -> [u64; 2] {
    [bits(lane(dual.value)), bits(lane(dual.slope))]
}

#[test]
fn lanes_are_doubles_with_their_slopes() {
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
                let lanes = [0, 1, 2, 3, 4, 5, 6, 7].map(lane);
                let values = |k: usize| lanes.map(|lane| lane[k].value);
                let slopes = |k: usize| lanes.map(|lane| lane[k].slope);
                let eight = results([0, 1, 2].map(|k| Dual {
                    value: Array8(values(k)),
                    slope: Array8(slopes(k)),
                }));
                let four = results([0, 1, 2].map(|k| Dual {
                    value: Array4(*values(k).first_chunk().unwrap()),
                    slope: Array4(*slopes(k).first_chunk().unwrap()),
                }));
                let two = results([0, 1, 2].map(|k| Dual {
                    value: Array2(*values(k).first_chunk().unwrap()),
                    slope: Array2(*slopes(k).first_chunk().unwrap()),
                }));
                for (l, arguments) in lanes.into_iter().enumerate() {
                    for (f, (name, alone)) in results(arguments).into_iter().enumerate() {
                        let alone = lane_of(alone, |x| x);
                        assert_eq!(lane_of(eight[f].1, |x| x.0[l]), alone, "{name}");
                        if l < 4 {
                            assert_eq!(lane_of(four[f].1, |x| x.0[l]), alone, "{name}");
                        }
                        if l < 2 {
                            assert_eq!(lane_of(two[f].1, |x| x.0[l]), alone, "{name}");
                        }
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
