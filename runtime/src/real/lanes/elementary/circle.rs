//! Sine and cosine, computed together.
//!
//! x = k π/2 + r with |r| ≤ π/4. π/2 has three parts, of which the first two have 37 bits, so that their products with
//! k are exact up to |x| = 2¹⁶ (Cody and Waite 1980). r is a sum hi − low of two doubles. Then
//!
//! sin r ≈ r + r³ S(r²),   cos r ≈ 1 − r²/2 + r⁴ C(r²),
//!
//! with the coefficients of fdlibm 5.3 (`k_sin.c`, `k_cos.c`; relative error 2⁻⁵⁸). k mod 4 exchanges and negates them.

use super::super::register::Doubles;
use super::remainder::far;

/// Up to this angle \[rad\] r is accurate to all its digits: next to a multiple of π/2 it is at least 2⁻⁵⁵, and its
/// error is 2⁻¹¹¹.
pub(super) const REACH: f64 = 65_536.0;
/// 1.5 · 2⁵²: adding it rounds to the nearest whole number; the last bits of the sum are those of that number.
pub(super) const ROUND: f64 = 6_755_399_441_055_744.0;
/// π/2 in three parts: 37 bits, the next 37 bits, and the rest.
const QUARTER_TURN: [f64; 3] = [
    1.570_796_326_792_333_3,
    2.563_344_151_583_955_8e-12,
    1.056_299_906_698_742_8e-23,
];
/// Coefficients of S.
const SINE: [f64; 6] = [
    -0.166_666_666_666_666_32,
    0.008_333_333_333_322_49,
    -0.000_198_412_698_298_579_5,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
/// Coefficients of C.
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_411,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];
/// The bit of the sign.
pub(super) const SIGN: u64 = 1 << 63;

/// (sin `x`, cos `x`), `x` in radians; NaN where `x` is not finite.
///
/// The error of either is at most 1 ulp for all `x`, also next to multiples of π/2. sin(−0) = −0; the sine is exactly
/// odd and the cosine exactly even.
#[inline(always)]
pub fn sin_cos<R: Doubles>(x: R) -> (R, R) {
    let num = R::splat;

    // k, still in the last bits of a large number; then r = hi − low
    let mut turned = x.mul_add(num(core::f64::consts::FRAC_2_PI), num(ROUND));
    let k = turned.sub(num(ROUND));
    // the first product is exact, and so is the difference of the second one
    let first = k.neg().mul_add(num(QUARTER_TURN[0]), x);
    let second = k.mul(num(QUARTER_TURN[1]));
    let mut hi = first.sub(second);
    let mut low = k.mul_add(num(QUARTER_TURN[2]), hi.sub(first).add(second));
    let near = x.abs().lt(num(REACH));
    if R::any(R::not(near)) {
        (turned, hi, low) = far(x, turned, hi, low);
    }

    // the sine uses all of low except for the factor cos r: an error of less than 0.15 ulp
    let r2 = hi.mul(hi);
    let s = horner(r2, SINE);
    let sine = hi.sub(hi.mul(r2).mul_add(s.neg(), low));
    // 1 − r²/2, and its rounding error
    let c = horner(r2, COSINE);
    let large = r2.mul_add(num(-0.5), num(1.0));
    let lost = r2.mul_add(num(-0.5), num(1.0).sub(large));
    let small = r2.mul(r2).mul_add(c, hi.mul_add(low, lost));
    let cosine = large.add(small);

    // odd k: exchanged; the sine is negative for k mod 4 = 2, 3, the cosine for 1, 2
    let bits = turned.bits();
    let odd = R::bits_nonzero(R::bits_and(bits, R::splat_bits(1)));
    let of_sine = R::bits_and(R::bits_shl::<62>(bits), R::splat_bits(SIGN));
    let of_cosine = R::bits_xor(of_sine, R::bits_shl::<63>(bits));
    let with_sign = |value: R, sign| R::from_bits(R::bits_xor(value.bits(), sign));
    (
        with_sign(R::select(odd, cosine, sine), of_sine),
        with_sign(R::select(odd, sine, cosine), of_cosine),
    )
}

/// c₀ + c₁z + … by Horner's rule.
#[inline(always)]
pub(super) fn horner<R: Doubles, const N: usize>(z: R, coefficients: [f64; N]) -> R {
    let mut sum = R::splat(coefficients[N - 1]);
    let mut i = N - 1;
    while i > 0 {
        i -= 1;
        sum = sum.mul_add(z, R::splat(coefficients[i]));
    }
    sum
}
