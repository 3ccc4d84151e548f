//! The exponential function.
//!
//! x = k ln 2 + r with |r| ≤ ln 2/2, and e^x = 2ᵏ (1 + r + r² P(r)). ln 2 has two parts, the first of 41 bits, so that
//! its product with k is exact. The rounding error of r is added at the end. P is interpolated at the eleven roots of
//! Chebyshev's polynomial in 60 digits; its error is 2⁻⁶² of the result.

use super::super::register::Doubles;
use super::circle::{ROUND, horner};

/// ln 2 in two parts: 41 bits, and the rest.
pub(super) const LN_2: [f64; 2] = [0.693_147_180_559_663, 2.823_529_056_303_157_7e-13];
/// Coefficients of P.
const POLYNOMIAL: [f64; 11] = [
    0.5,
    0.166_666_666_666_666_7,
    0.041_666_666_666_666_67,
    0.008_333_333_333_326_084,
    0.001_388_888_888_888_371_1,
    0.000_198_412_698_750_022_8,
    2.480_158_732_567_746e-5,
    2.755_725_517_000_089e-6,
    2.755_727_347_871_858e-7,
    2.510_531_272_962_210_3e-8,
    2.091_475_532_589_32e-9,
];
/// Beyond these bounds the result is ∞ or 0 in any case.
const MOST: f64 = 710.0;
const LEAST: f64 = -746.0;

/// e^`x`, within 1 ulp, also where the result is subnormal; 0 below −745.2, ∞ above 709.8.
#[inline(always)]
pub fn exp<R: Doubles>(x: R) -> R {
    exp_of_sum(x, R::splat(0.0))
}

/// e^(`x` + `more`), where `more` is at most a unit in the last place of `x`.
#[inline(always)]
pub(super) fn exp_of_sum<R: Doubles>(x: R, more: R) -> R {
    let num = R::splat;
    let x = x.max(num(LEAST)).min(num(MOST));

    // k, still in the last bits of a large number, and r − low
    let shifted = x.mul_add(num(core::f64::consts::LOG2_E), num(ROUND));
    let k = shifted.sub(num(ROUND));
    let first = k.neg().mul_add(num(LN_2[0]), x);
    let second = k.mul_add(num(LN_2[1]), more.neg());
    let r = first.sub(second);
    let low = r.sub(first).add(second);

    // 1 + r, and its rounding error
    let large = r.add(num(1.0));
    let lost = r.sub(large.sub(num(1.0)));
    let tail = r.mul(r).mul_add(horner(r, POLYNOMIAL), low.neg());
    let result = large.add(lost.add(tail));

    // 2ᵏ in two factors, so that the result may be subnormal or infinite: n = k + 2 · 1023 is positive
    let of_zero = R::splat_bits(ROUND.to_bits() - 2 * 1023);
    let n = R::bits_sub(shifted.bits(), of_zero);
    let half = R::bits_shr::<1>(n);
    let power = |n| R::from_bits(R::bits_shl::<52>(n));
    result.mul(power(half)).mul(power(R::bits_sub(n, half)))
}
