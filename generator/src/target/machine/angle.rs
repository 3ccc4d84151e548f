//! `atan2` of doubles, written out as steps in place of a call.
//!
//! The steps follow the runtime (`runtime/src/real/lanes/elementary/angle.rs`, which explains them) operation by
//! operation, so they give the same bits. Points so near to or far from the origin that reciprocals leave the range of
//! numbers are rare; for them the code branches to the function of the runtime: see `rare_branches`.

use super::numbers::Signed;
use super::operation::{Binary, Bitwise};
use super::steps::{Callee, Lowering};
use super::terms::Term;

/// 2⁸⁹⁹: half of the limit at which the runtime scales the point.
const LIMIT: f64 = f64::from_bits((1023 + 899) << 52);
/// Coefficients of arctan t, from t³ on.
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

impl Lowering<'_> {
    /// The angle of the point (x, y). Its slope is (x y′ − y x′)/(x² + y²), and 0 where the point stands still at the
    /// origin.
    pub fn angle(&mut self, y: Term, x: Term) -> Term {
        let value = self.angle_of_numbers(y.value, x.value);
        let slope = y.slope.zip(x.slope).map(|(of_y, of_x)| {
            let n = &mut self.numbers;
            let squared = n.scaled(Binary::Mul, y.value, y.value);
            let squared = n.mul_add(x.value, x.value, squared);
            let second = n.scaled(Binary::Mul, y.value, of_x);
            let across = n.mul_add(x.value, of_y, second.negated());
            let [of_y, of_x] = [of_y, of_x].map(|slope| n.size(slope));
            let motion = n.sum(of_y, of_x);
            let below = self.away_from_zero(squared, motion);
            self.numbers.scaled(Binary::Div, across, below)
        });
        Term { value, slope }
    }

    fn angle_of_numbers(&mut self, y: Signed, x: Signed) -> Signed {
        let n = &mut self.numbers;
        let [up, right] = [y, x].map(|side| n.size(side));
        let (zero, one) = (n.number(0.0), n.number(1.0));
        let steep = [right, up];
        let short = n.select(steep, right, up);
        let long = n.select(steep, up, right);

        // t, the rounding error of the division, and that of the sum below
        let half = n.number(0.5);
        let half = n.scaled(Binary::Mul, long, half);
        let beyond = [half, short];
        let difference = n.sum(short, long.negated());
        let above = n.select(beyond, difference, short);
        let sum = n.sum(short, long);
        let below = n.select(beyond, sum, long);
        let added = n.sum(below, long.negated());
        let missing = n.sum(short, added.negated());
        let below_rest = n.select(beyond, missing, zero);
        let inverse = n.scaled(Binary::Div, one, below);
        let t = n.scaled(Binary::Mul, above, inverse);
        let rest = n.mul_add(t.negated(), below, above);
        let rest = n.mul_add(t.negated(), below_rest, rest);
        let z = n.scaled(Binary::Mul, t, t);
        let cubed = n.scaled(Binary::Mul, t, z);
        let polynomial = n.horner(z, POLYNOMIAL);
        let of_rest = n.scaled(Binary::Mul, rest, inverse);
        let tail = n.mul_add(cubed, polynomial, of_rest);

        // the other eighths, quarters and halves of the circle: the angle is then measured from 0, π/2 or π
        let sign = n.constant(-0.0);
        let [of_x, of_y] = [x, y].map(|side| {
            let side = n.with_sign(side);
            n.bits(Bitwise::And, side, sign)
        });
        let eighths = n.select(beyond, one, zero);
        let (two, four) = (n.number(2.0), n.number(4.0));
        let other = n.sum(two, eighths.negated());
        let eighths = n.select(steep, other, eighths);
        let other = n.sum(four, eighths.negated());
        // 1 with the sign of x
        let side = n.xor(one, of_x);
        let eighths = n.select([side, zero], other, eighths);
        let flip = n.select(steep, zero.negated(), zero);
        let flip = n.xor(flip, of_x);
        let flip = n.with_sign(flip);
        let (t, tail) = (n.xor(t, flip), n.xor(tail, flip));

        let eighth = EIGHTH_TURN.map(|part| n.number(part));
        let first = n.scaled(Binary::Mul, eighths, eighth[0]);
        let large = n.sum(first, t);
        let lost = n.sum(first, large.negated());
        let lost = n.sum(lost, t);
        let small = n.mul_add(eighths, eighth[1], tail);
        let small = n.sum(lost, small);
        let angle = n.sum(large, small);
        let angle = n.xor(angle, of_y);
        let size = n.extreme(Binary::Max, below, inverse);
        self.unless_rare(
            Callee::Atan2,
            1 + u32::from(self.slopes),
            (size, LIMIT),
            &[y, x],
            &[angle],
        )[0]
    }
}
