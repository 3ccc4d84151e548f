//! Supports of ellipsoids.

use crate::scalars::Pair;
use bryant_runtime::force::ellipsoid::support;
use bryant_runtime::{DoubleDouble, Dual, Real};

const NORMALS: [[f64; 3]; 5] = [
    [0.3, -0.5, 0.8],
    [0.0, 0.0, 1.0],
    [-1.0, 0.0, 0.0],
    [0.6, 0.0, -0.8],
    [1e-9, 1.0, -1e-5],
];

#[test]
fn of_degree_2_it_is_the_length() {
    for [x, y, z] in NORMALS {
        let [h, dx, dy, dz] = support(x, y, z, 2.0);
        let length = f64::sqrt(x * x + y * y + z * z);
        for (ours, expected) in [
            (h, length),
            (dx, x / length),
            (dy, y / length),
            (dz, z / length),
        ] {
            assert!((ours - expected).abs() <= 8.0 * f64::EPSILON * length);
        }
    }
}

#[test]
fn the_point_lies_on_the_surface_and_reaches_as_far_as_said() {
    for degree in [4.0, 6.0, 8.0, 20.0, 100.0] {
        let power = degree / (degree - 1.0);
        for [x, y, z] in NORMALS {
            let [h, dx, dy, dz] = support(x, y, z, power);
            // Σ |x_i/a_i|ⁿ = 1: the power n takes n times the rounding
            let on: f64 = [dx, dy, dz]
                .iter()
                .map(|d: &f64| d.abs().powf(degree))
                .sum();
            assert!((on - 1.0).abs() <= 8.0 * degree * f64::EPSILON, "{on}");
            let reach = x * dx + y * dy + z * dz;
            assert!((h - reach).abs() <= 8.0 * f64::EPSILON * h, "{h} {reach}");
            // no other point of the surface reaches further
            let other = [dx, dy, dz].map(|d| d + 0.01);
            let norm = other
                .iter()
                .map(|d| d.abs().powf(degree))
                .sum::<f64>()
                .powf(1.0 / degree);
            let further = (x * other[0] + y * other[1] + z * other[2]) / norm;
            assert!(further <= h * (1.0 + 8.0 * f64::EPSILON));
        }
    }
}

#[test]
fn slopes_are_those_of_the_reach() {
    for [x, y, z] in NORMALS {
        for along in 0..3 {
            let s: [Dual<f64>; 3] = std::array::from_fn(|i| Dual {
                value: [x, y, z][i],
                slope: f64::from(u8::from(i == along)),
            });
            let power = Dual::constant(4.0 / 3.0);
            let results = support(s[0], s[1], s[2], power);
            let (ours, expected) = (results[0].slope, results[1 + along].value);
            assert!((ours - expected).abs() <= 1e-12, "{ours} {expected}");
        }
    }
}

#[test]
fn more_digits_than_a_double_s_stay() {
    let c = DoubleDouble::from_f64;
    let u2 = 0.25 * f64::EPSILON * f64::EPSILON;
    for power in [2.0, 4.0 / 3.0, 1.25] {
        for [x, y, z] in NORMALS {
            let s = [x, y, z].map(c);
            for along in 0..3 {
                let mut moving = s.map(Dual::constant);
                moving[along].slope = c(1.0);
                let power = Dual::constant(c(power));
                let [h, dx, dy, dz] = support(moving[0], moving[1], moving[2], power);
                // h is the sum of its slopes times s (Euler). Powers of parts down to 10⁻²⁰⁰ have errors up to 40 · 460
                // u², but these parts of the sum are that much smaller; powers of parts above 10⁻⁹ have errors up to 40
                // · 21 u²
                let bound = 1024.0 * u2;
                let d = [dx.value, dy.value, dz.value];
                let euler = s[0] * d[0] + s[1] * d[1] + s[2] * d[2];
                assert!((euler - h.value).to_f64().abs() <= bound, "{euler:?} {h:?}");
                let off = (h.slope - d[along]).to_f64().abs();
                assert!(off <= 4.0 * bound, "{off:e}");
            }
        }
    }
}

#[test]
fn lanes_and_what_is_no_number_pass() {
    let both = support(
        Pair([0.3, 0.0]),
        Pair([0.1, 1.0]),
        Pair([0.2, 0.0]),
        Pair([1.5; 2]),
    );
    assert_eq!(both[0].0, [support(0.3, 0.1, 0.2, 1.5)[0], 1.0]);
    assert!(support(f64::NAN, 0.1, 0.2, 1.5)[0].is_nan());
}
