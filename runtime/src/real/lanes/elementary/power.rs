//! Powers: xʸ = e^(y ln x), with ln x to 65 bits. Of these the result keeps 53 where y ln x is as large as possible.
//!
//! x = 2ᵏ m with √½ ≤ m < √2, and with s = (m − 1)/(m + 1)
//!
//! ln m = 2s (1 + w),   w = z/3 + z² Q(z),   z = s².
//!
//! Numbers of more than 53 bits are sums head + tail, where head is a double of 26 bits. Products of heads are exact,
//! fused or not. Q is interpolated at the eight roots of Chebyshev's polynomial in 60 digits; its relative error in ln
//! m is 2⁻⁷⁰.

use super::super::register::Doubles;
use super::circle::horner;
use super::exponential::{LN_2, exp_of_sum};
use super::logarithm::exponent_and_fraction;

/// Coefficients of Q.
const POLYNOMIAL: [f64; 8] = [
    0.2,
    0.142_857_142_857_146_82,
    0.111_111_111_108_281_16,
    0.090_909_091_676_572_02,
    0.076_922_974_854_477_29,
    0.066_674_021_191_126_73,
    0.058_531_242_704_611_93,
    0.058_615_255_140_488_765,
];
/// 1/3 minus the double nearest to it.
const THIRD_LOW: f64 = 1.850_371_707_708_594e-17;
/// All but the last 27 bits.
const HEAD: u64 = 0xffff_ffff_f800_0000;
/// 2⁶⁶: with a larger exponent, the power of any number but 1 is already 0 or ∞.
const LARGEST: f64 = 7.378_697_629_483_821e19;

/// `x` to the power `y`, within 1 ulp, also where the result is subnormal.
///
/// Zeros, infinities, NaN and negative numbers are treated as in the C standard (annex F.10.4.4) and Rust's `powf`: x⁰
/// = 1ʸ = 1 even for NaN, and the power of a negative number is NaN unless the exponent is whole.
#[inline(always)]
pub fn powf<R: Doubles>(x: R, y: R) -> R {
    let num = R::splat;
    let size = x.abs();
    let limited = y.max(num(-LARGEST)).min(num(LARGEST));
    let (log, log_tail) = logarithm(size);
    let (power, power_tail) = cut(limited);
    let exact = power.mul(log);
    let rest = power.mul_add(log_tail, power_tail.mul(log.add(log_tail)));
    let sum = exact.add(rest);
    let lost = exact.sub(sum).add(rest);
    // beyond the range of results, the exponential sees the bounds of the range
    let lost = R::select(sum.abs().lt(num(1000.0)), lost, num(0.0));
    let result = exp_of_sum(sum, lost);

    let infinity = num(f64::INFINITY);
    let plain = R::and(num(0.0).lt(x), R::and(x.lt(infinity), y.abs().lt(infinity)));
    if R::any(R::not(plain)) {
        unusual(x, y, result)
    } else {
        result
    }
}

/// ln `x` as head + tail, for positive finite `x`.
#[inline(always)]
fn logarithm<R: Doubles>(x: R) -> (R, R) {
    let num = R::splat;
    let one = num(1.0);
    let (k, m) = exponent_and_fraction(x);

    // s = f/d: the remainder of f after the product with the head of s is exact, except for a last rounding
    let f = m.sub(one);
    let inverse = one.div(m.add(one));
    let d = head(m.add(one));
    let d_tail = m.sub(d.sub(one));
    let s = head(f.mul(inverse));
    let left = s.neg().mul_add(d_tail, s.neg().mul_add(d, f));
    let s_tail = left.mul(inverse);

    // z, and w/z = 1/3 + z Q
    let square = s.mul(s);
    let z = head(square);
    let z_tail = square.sub(z).add(s_tail.mul(s.add(s).add(s_tail)));
    let whole_z = z.add(z_tail);
    let zq = whole_z.mul(horner(whole_z, POLYNOMIAL));
    let third = num(1.0 / 3.0);
    let factor = head(third.add(zq));
    let factor_tail = third.sub(factor).add(zq).add(num(THIRD_LOW));

    // w, s w, and s + s w
    let product = z.mul(factor);
    let product_tail = z.mul_add(factor_tail, z_tail.mul(factor.add(factor_tail)));
    let w = head(product);
    let w_tail = product.sub(w).add(product_tail);
    let more = s.mul(w);
    let more_tail = s.mul_add(w_tail, s_tail.mul(w.add(w_tail)));
    let half = s.add(more);
    let half_tail = s.sub(half).add(more).add(s_tail.add(more_tail));

    // k ln 2 + 2 (s + s w)
    let turned = k.mul(num(LN_2[0]));
    let large = turned.add(half.add(half));
    let lost = turned.sub(large).add(half.add(half));
    let small = lost.add(k.mul_add(num(LN_2[1]), half_tail.add(half_tail)));
    let log = head(large.add(small));
    (log, large.sub(log).add(small))
}

/// The first 26 bits.
#[inline(always)]
fn head<R: Doubles>(a: R) -> R {
    R::from_bits(R::bits_and(a.bits(), R::splat_bits(HEAD)))
}

/// `a` as head + tail, exactly.
#[inline(always)]
fn cut<R: Doubles>(a: R) -> (R, R) {
    let first = head(a);
    (first, a.sub(first))
}

/// Turns `size` = |`x`|ʸ into xʸ in the lanes where a number is not positive and finite.
#[cold]
#[inline(never)]
fn unusual<R: Doubles>(x: R, y: R, size: R) -> R {
    let mut result = size;
    for lane in 0..R::LANES {
        let (x, y) = (x.lane(lane), y.lane(lane));
        if !(0.0 < x && x < f64::INFINITY && y.abs() < f64::INFINITY) {
            result = result.with_lane(lane, unusual_power(x, y, size.lane(lane)));
        }
    }
    result
}

/// xʸ, given |x|ʸ, which is correct for finite `x` other than 0.
fn unusual_power(x: f64, y: f64, size: f64) -> f64 {
    if y == 0.0 || x == 1.0 {
        return 1.0;
    }
    if x.is_nan() || y.is_nan() {
        return f64::NAN;
    }
    let size = if x == 0.0 || x.is_infinite() {
        // 0 to a positive power, or ∞ to a negative one
        let vanishes = (x == 0.0) == (y > 0.0);
        if vanishes { 0.0 } else { f64::INFINITY }
    } else {
        size
    };
    // from 2⁵³ on, every number is even
    let small = y.abs() < 9_007_199_254_740_992.0;
    let count = if small { y as i64 } else { 0 };
    let whole = !small || count as f64 == y;
    if x.is_sign_positive() {
        size
    } else if whole && count & 1 == 1 {
        -size
    } else if whole || x == 0.0 || x.is_infinite() {
        size
    } else {
        f64::NAN
    }
}
