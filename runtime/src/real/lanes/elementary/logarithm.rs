//! The natural logarithm.
//!
//! x = 2ᵏ m with √½ ≤ m < √2. With f = m − 1 and s = f/(2 + f),
//!
//! ln m = f − f²/2 + s (f²/2 + R(s²)),
//!
//! where R is the polynomial of fdlibm 5.3 (`e_log.c`; relative error 2⁻⁵⁸).

use super::super::register::Doubles;
use super::circle::horner;
use super::exponential::LN_2;

/// Coefficients of R(z)/z.
const POLYNOMIAL: [f64; 7] = [
    0.666_666_666_666_673_5,
    0.399_999_999_994_094_2,
    0.285_714_287_436_623_9,
    0.222_221_984_321_497_84,
    0.181_835_721_616_180_5,
    0.153_138_376_992_093_73,
    0.147_981_986_051_165_86,
];
/// Bits of 1.
const ONE: u64 = 0x3ff0_0000_0000_0000;
/// Bits of √½.
const ROOT_OF_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
/// Sign and exponent.
const NOT_FRACTION: u64 = 0xfff0_0000_0000_0000;
/// 2⁵²: its last bits count.
const COUNT: f64 = 4_503_599_627_370_496.0;
/// 2⁵⁴, which makes subnormal numbers normal.
const UP: f64 = 1.801_439_850_948_198_4e16;

/// ln `x`, within 1 ulp; −∞ for ±0, NaN for negative `x`.
#[inline(always)]
pub fn ln<R: Doubles>(x: R) -> R {
    let num = R::splat;
    let (k, m) = exponent_and_fraction(x);
    let f = m.sub(num(1.0));
    let half_square = f.mul(f).mul(num(0.5));
    let s = f.div(f.add(num(2.0)));
    let z = s.mul(s);
    let rest = z.mul_add(horner(z, POLYNOMIAL), half_square);

    // k ln 2 + f, and its rounding error; the product is exact
    let first = k.mul(num(LN_2[0]));
    let large = first.add(f);
    let lost = first.sub(large).add(f);
    let small = s.mul_add(rest, k.mul(num(LN_2[1]))).sub(half_square);
    let result = large.add(lost.add(small));

    let zero = num(0.0);
    let below = R::select(x.lt(zero), num(f64::NAN), num(f64::NEG_INFINITY));
    let result = R::select(zero.lt(x), result, below);
    // ∞ and NaN are their own logarithms
    R::select(x.lt(num(f64::INFINITY)), result, x)
}

/// (k, m) with `x` = 2ᵏ m and √½ ≤ m < √2, for positive finite `x`.
#[inline(always)]
pub(super) fn exponent_and_fraction<R: Doubles>(x: R) -> (R, R) {
    let num = R::splat;
    let subnormal = x.lt(num(f64::MIN_POSITIVE));
    let bits = R::select(subnormal, x.mul(num(UP)), x).bits();
    // the bits above those of the fraction are k + 1023
    let raised = R::bits_add(bits, R::splat_bits(ONE - ROOT_OF_HALF));
    let count = R::bits_or(R::bits_shr::<52>(raised), R::splat_bits(COUNT.to_bits()));
    let of_zero = R::select(subnormal, num(COUNT + 1023.0 + 54.0), num(COUNT + 1023.0));
    let k = R::from_bits(count).sub(of_zero);
    let power = R::bits_and(raised, R::splat_bits(NOT_FRACTION));
    let m = R::bits_add(R::bits_sub(bits, power), R::splat_bits(ONE));
    (k, R::from_bits(m))
}
