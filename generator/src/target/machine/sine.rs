//! Sine and cosine of doubles, written out as steps in place of a call.
//!
//! The steps follow the runtime (`runtime/src/real/lanes/elementary/circle.rs`, which explains them) operation by
//! operation, so they give the same bits. Angles beyond 2¹⁶ are rare; for them the code branches to the function of the
//! runtime: see `rare_branches`.

use super::numbers::Signed;
use super::operation::{Binary, Bitwise};
use super::steps::{Callee, Lowering};
use super::terms::Term;

/// The square of 2¹⁶, the largest angle that is not rare.
const LIMIT: f64 = 4_294_967_296.0;
/// 1.5 · 2⁵²: adding it to a number rounds the number to the nearest whole number; the last bits of the sum are those
/// of the whole number.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// π/2 in three parts: 37 bits, the next 37 bits, and the rest.
const QUARTER_TURN: [f64; 3] = [
    1.570_796_326_792_333_3,
    2.563_344_151_583_955_8e-12,
    1.056_299_906_698_742_8e-23,
];
/// Coefficients of the sine, from r³ on.
const SINE: [f64; 6] = [
    -0.166_666_666_666_666_32,
    0.008_333_333_333_322_49,
    -0.000_198_412_698_298_579_5,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
/// Coefficients of the cosine, from r⁴ on.
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_411,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

impl Lowering<'_> {
    /// Sine and cosine, with slopes (sin a)′ = cos a · a′ and (cos a)′ = −(sin a · a′).
    pub fn sin_cos(&mut self, a: Term) -> [Term; 2] {
        let [sine, cosine] = self.sin_cos_of_number(a.value);
        let mut times = |factor: Signed| {
            let slope = a.slope?;
            Some(self.numbers.scaled(Binary::Mul, factor, slope))
        };
        let (of_sine, of_cosine) = (times(cosine), times(sine));
        [
            Term {
                value: sine,
                slope: of_sine,
            },
            Term {
                value: cosine,
                slope: of_cosine.map(Signed::negated),
            },
        ]
    }

    /// (sin x, cos x)
    fn sin_cos_of_number(&mut self, x: Signed) -> [Signed; 2] {
        let n = &mut self.numbers;
        // k is the last bits of the large number `turned`; then r = hi − low
        let (turns, round) = (n.number(std::f64::consts::FRAC_2_PI), n.number(ROUND));
        let turned = n.mul_add(x, turns, round);
        let k = n.sum(turned, round.negated());
        let quarter = QUARTER_TURN.map(|part| n.number(part));
        let first = n.mul_add(k.negated(), quarter[0], x);
        let second = n.scaled(Binary::Mul, k, quarter[1]);
        let hi = n.sum(first, second.negated());
        let missing = n.sum(hi, first.negated());
        let missing = n.sum(missing, second);
        let low = n.mul_add(k, quarter[2], missing);

        let r2 = n.scaled(Binary::Mul, hi, hi);
        let s = n.horner(r2, SINE);
        let cubed = n.scaled(Binary::Mul, hi, r2);
        let lost = n.mul_add(cubed, s.negated(), low);
        let sine = n.sum(hi, lost.negated());
        // 1 − r²/2, and its rounding error
        let c = n.horner(r2, COSINE);
        let (half, one) = (n.number(-0.5), n.number(1.0));
        let large = n.mul_add(r2, half, one);
        let rest = n.sum(one, large.negated());
        let lost = n.mul_add(r2, half, rest);
        let fourth = n.scaled(Binary::Mul, r2, r2);
        let lost = n.mul_add(hi, low, lost);
        let small = n.mul_add(fourth, c, lost);
        let cosine = n.sum(large, small);

        // for odd k, sine and cosine are exchanged; the sine is negative for k mod 4 = 2, 3, the cosine for 1, 2
        let turned = n.with_sign(turned);
        let (second_bit, first_bit) = (n.shifted_left(turned, 62), n.shifted_left(turned, 63));
        // the only bit of the constant 2.0 is where the shift has put the first bit of k
        let two = n.constant(2.0);
        let odd = Signed::plain(n.bits(Bitwise::And, second_bit, two));
        let sign = n.constant(-0.0);
        let of_sine = n.bits(Bitwise::And, second_bit, sign);
        let of_cosine = n.bits(Bitwise::Xor, of_sine, first_bit);
        let zero = n.number(0.0);
        let mut chosen = |even: Signed, odd_one: Signed, sign: u32| {
            let chosen = n.select([zero, odd], odd_one, even);
            n.xor(chosen, sign)
        };
        let results = [
            chosen(sine, cosine, of_sine),
            chosen(cosine, sine, of_cosine),
        ];
        let size = n.scaled(Binary::Mul, x, x);
        let found = self.unless_rare(
            Callee::SinCos,
            1 + u32::from(self.slopes),
            (size, LIMIT),
            &[x],
            &results,
        );
        [found[0], found[1]]
    }
}
