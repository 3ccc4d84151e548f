//! The angle of a point.
//!
//! Let a be the shorter and b the longer of |x| and |y|. With t = a/b up to 1/2, and t = (a − b)/(a + b) beyond, the
//! angle is j π/4 ± arctan t with a whole j from 0 to 4, and
//!
//! arctan t = t + t³ A(t²),   |t| ≤ 1/2.
//!
//! The rounding error of t is added at the end. A is interpolated at the 13 roots of Chebyshev's polynomial in 60
//! digits; its relative error in arctan t is 2⁻⁶⁰.

use super::super::register::Doubles;
use super::circle::{SIGN, horner};

/// Coefficients of A.
const POLYNOMIAL: [f64; 13] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_994_85,
    -0.142_857_142_855_982_92,
    0.111_111_111_008_460_38,
    -0.090_909_086_174_044_1,
    0.076_922_946_423_465_84,
    -0.066_664_346_100_725_69,
    0.058_795_677_783_946_58,
    -0.052_400_287_643_869_586,
    0.046_277_152_068_335_18,
    -0.038_057_958_199_378_225,
    0.024_992_876_622_203_33,
    -0.009_206_337_670_391_992,
];
/// π/4 in two parts: 48 bits, and the rest.
const EIGHTH_TURN: [f64; 2] = [0.785_398_163_397_445_6, 2.695_151_429_079_059_5e-15];
/// 2⁶⁰⁰ and 2⁹⁰⁰.
const SCALE: f64 = f64::from_bits((1023 + 600) << 52);
const FAR: f64 = f64::from_bits((1023 + 900) << 52);

/// Angle of the point (`x`, `y`) \[rad\], in \[−π, π\], within 1 ulp.
///
/// Signs of zeros count. Points at infinity lie on axes and diagonals, as in the C standard (annex F.10.1.4) and Rust's
/// `atan2`.
#[inline(always)]
pub fn atan2<R: Doubles>(y: R, x: R) -> R {
    let num = R::splat;
    let (zero, one) = (num(0.0), num(1.0));
    let (up, right) = (y.abs(), x.abs());
    let steep = right.lt(up);
    let mut short = R::select(steep, right, up);
    let mut long = R::select(steep, up, right);
    // almost always: reciprocals of the coordinates exist
    let plain = R::and(num(1.0 / FAR).lt(long), long.lt(num(FAR)));
    if R::any(R::not(plain)) {
        // scales to another point in the same direction; NaN stays NaN
        let (most, least) = (num(f64::MAX), num(f64::from_bits(1)));
        let diagonal = R::select(most.lt(short), one, short.mul(zero));
        let infinite = most.lt(long);
        short = R::select(infinite, diagonal, short);
        long = R::select(R::or(infinite, long.lt(least)), one, long);
        // scales down to where reciprocals exist
        let down = R::select(num(FAR).lt(long), num(1.0 / SCALE), one);
        let scale = R::select(long.lt(num(1.0 / FAR)), num(SCALE), down);
        (short, long) = (short.mul(scale), long.mul(scale));
    }

    // t, the remainder of the division, and that of the sum below
    let beyond = long.mul(num(0.5)).lt(short);
    let above = R::select(beyond, short.sub(long), short);
    let below = R::select(beyond, short.add(long), long);
    let below_rest = R::select(beyond, short.sub(below.sub(long)), zero);
    let inverse = one.div(below);
    let t = above.mul(inverse);
    let rest = t.neg().mul_add(below_rest, t.neg().mul_add(below, above));
    let z = t.mul(t);
    let tail = t.mul(z).mul_add(horner(z, POLYNOMIAL), rest.mul(inverse));

    // the other eighth, quarter and half: the angle is then measured from 0, π/2 or π
    let left = R::bits_and(x.bits(), R::splat_bits(SIGN));
    let eighths = R::select(beyond, one, zero);
    let eighths = R::select(steep, num(2.0).sub(eighths), eighths);
    let eighths = R::select(R::bits_nonzero(left), num(4.0).sub(eighths), eighths);
    let flip = R::bits_xor(R::select(steep, num(-0.0), zero).bits(), left);
    let signed = |value: R| R::from_bits(R::bits_xor(value.bits(), flip));
    let (t, tail) = (signed(t), signed(tail));

    // the product is exact: its factors have 48 and 3 bits
    let first = eighths.mul(num(EIGHTH_TURN[0]));
    let large = first.add(t);
    let lost = first.sub(large).add(t);
    let small = eighths.mul_add(num(EIGHTH_TURN[1]), tail);
    let result = large.add(lost.add(small));
    let side = R::bits_and(y.bits(), R::splat_bits(SIGN));
    R::from_bits(R::bits_xor(result.bits(), side))
}
