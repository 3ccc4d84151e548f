//! The remainder of a large angle after whole quarter turns, to all digits (Payne and Hanek 1983).
//!
//! x = m 2ᵉ with a whole m of 53 bits. Those 256 bits of 2/π are used that decide x · 2/π modulo 4. Their product with
//! m, modulo 2²⁵⁶, has a whole number of quarter turns in its first two bits, followed by a fraction exact to 2⁻²⁰¹. No
//! double is nearer to a multiple of π/2 than 2⁻⁶¹, so r has 140 bits.

use super::super::register::Doubles;
use super::circle::{REACH, ROUND};
use crate::real::{DoubleDouble, Real};

/// 2/π in binary: 64 zeros, of which the last is the units place, and 1280 bits after the point.
const TWO_OVER_PI: [u64; 21] = [
    0,
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
];
/// π/2 in two doubles.
const QUARTER_TURN: [f64; 2] = [core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];

/// (k + 1.5 · 2⁵², hi, low) with x = k π/2 + hi − low and k modulo 4, in the lanes whose angle is beyond [`REACH`]. In
/// all other lanes the arguments are returned unchanged.
#[cold]
#[inline(never)]
pub(super) fn far<R: Doubles>(x: R, turned: R, hi: R, low: R) -> (R, R, R) {
    let (mut turned, mut hi, mut low) = (turned, hi, low);
    for lane in 0..R::LANES {
        let angle = x.lane(lane);
        if angle.abs() < REACH {
            continue;
        }
        let (quarters, rest) = remainder(angle);
        turned = turned.with_lane(lane, ROUND + quarters);
        hi = hi.with_lane(lane, rest[0]);
        low = low.with_lane(lane, -rest[1]);
    }
    (turned, hi, low)
}

/// The number of whole quarter turns in |`x`| ≥ 2, modulo 4, and the remaining angle as a sum of two doubles; NaN where
/// `x` is not finite.
fn remainder(x: f64) -> (f64, [f64; 2]) {
    if !x.is_finite() {
        return (0.0, [f64::NAN; 2]);
    }
    let bits = x.abs().to_bits();
    let m = (bits & ((1 << 52) - 1)) | (1 << 52);
    // x = m 2ᵉ; the bit of 2/π that has the weight 2 in the product is number e − 1 after the point, and number e + 62
    // of the table
    let e = (bits >> 52) as i64 - 1075;
    let start = (e + 62).max(0) as usize;
    let (word, shift) = (start / 64, start % 64);
    let window = |i: usize| {
        let at = |j: usize| TWO_OVER_PI.get(j).copied().unwrap_or(0);
        let next = u128::from(at(word + i)) << 64 | u128::from(at(word + i + 1));
        ((next << shift) >> 64) as u64
    };
    // modulo 2²⁵⁶, the last word first
    let mut product = [0_u64; 4];
    let mut carry = 0_u128;
    for i in (0..4).rev() {
        carry += u128::from(m) * u128::from(window(i));
        product[i] = carry as u64;
        carry >>= 64;
    }

    // two bits before the point, and the fraction; a fraction above a half is one more quarter turn less the complement
    let mut quarters = (product[0] >> 62) as f64;
    for i in 0..4 {
        let next = product.get(i + 1).copied().unwrap_or(0);
        product[i] = product[i] << 2 | next >> 62;
    }
    let above = product[0] >> 63 == 1;
    if above {
        quarters += 1.0;
        // −f = !f + 1; the last bit does not matter
        product = product.map(|part| !part);
    }
    let mut fraction = DoubleDouble::from_f64(0.0);
    let mut unit = 1.0;
    for part in product {
        for half in [part >> 32, part & 0xffff_ffff] {
            unit *= 1.0 / 4_294_967_296.0;
            fraction += DoubleDouble::from_f64(half as f64 * unit);
        }
    }
    let rest = fraction * DoubleDouble::new(QUARTER_TURN[0], QUARTER_TURN[1]);
    let rest = if above { -rest } else { rest };
    if x < 0.0 {
        (-quarters, (-rest).parts())
    } else {
        (quarters, rest.parts())
    }
}
