//! `f64` with a faster, less accurate sine and cosine, to measure the cost of the exact ones.
//!
//! x = k π/2 + r with |r| ≤ π/4. π/2 has two parts, of which the first has 33 bits, so that its product with k is exact
//! (Cody and Waite 1980). Then
//!
//! sin r ≈ r + r³ (s₀ + s₁r² + s₂r⁴ + s₃r⁶),   cos r ≈ 1 + r² (c₀ + c₁r² + c₂r⁴ + c₃r⁶),
//!
//! and k mod 4 exchanges and negates them. The coefficients minimise the largest absolute error over \[0, π/4 + 2⁻³⁰\].
//! They were found by Remez's exchange of extrema in 50 digits and rounded to doubles. The remaining errors are
//! 2.4·10⁻¹² and 5.4·10⁻¹¹; the rounding of k π/2 and r adds |x| 2⁻⁵². Nothing branches and nothing is called, so loops
//! over several numbers become vector instructions.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A double whose sine and cosine are within 10⁻¹⁰ for |x| ≤ 10⁴. In everything else it is `f64`.
///
/// Beyond 10⁴ rad the error grows by |x| 2⁻⁵²; beyond 10⁹ rad the results are NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fast(pub f64);

/// 1.5 · 2⁵²: adding and subtracting it rounds to the nearest whole number; the last bits of the sum are those of that
/// number.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// π/2 to 33 bits, and the rest.
const QUARTER_TURN: [f64; 2] = [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11];
/// s₀ … s₃
const SINE: [f64; 4] = [
    -0.166_666_666_279_990_83,
    0.008_333_328_238_716_938,
    -0.000_198_390_437_708_291_4,
    2.716_014_019_897_684e-6,
];
/// c₀ … c₃
const COSINE: [f64; 4] = [
    -0.499_999_997_251_093_5,
    0.041_666_623_324_478_85,
    -0.001_388_676_379_859_015_5,
    2.439_045_107_929_203e-5,
];
/// Beyond this angle \[rad\], k would not be exact.
const LARGEST: f64 = 1e9;

/// An operator of `f64`.
macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Fast {
            type Output = Fast;
            #[inline(always)]
            fn $method(self, other: Fast) -> Fast {
                Fast(self.0.$method(other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Fast {
    type Output = Fast;
    #[inline(always)]
    fn neg(self) -> Fast {
        Fast(-self.0)
    }
}

impl AddAssign for Fast {
    #[inline(always)]
    fn add_assign(&mut self, other: Fast) {
        self.0 += other.0;
    }
}

/// (sin `x`, cos `x`) by the polynomials.
#[inline(always)]
fn sin_cos(x: f64) -> (f64, f64) {
    let x = if x.abs() < LARGEST { x } else { f64::NAN };
    let shifted = x * core::f64::consts::FRAC_2_PI + ROUND;
    let quarters = shifted - ROUND;
    let r = (x - quarters * QUARTER_TURN[0]) - quarters * QUARTER_TURN[1];
    let r2 = r * r;
    let polynomial = |c: [f64; 4]| ((c[3] * r2 + c[2]) * r2 + c[1]) * r2 + c[0];
    let sine = r + r * r2 * polynomial(SINE);
    let cosine = 1.0 + r2 * polynomial(COSINE);

    let odd = shifted.to_bits() & 1 != 0;
    let (sine, cosine) = if odd { (cosine, sine) } else { (sine, cosine) };
    // the second bit of k and of k + 1 as the sign
    let sign = |k: u64| (k & 2) << 62;
    let quarter = shifted.to_bits();
    (
        f64::from_bits(sine.to_bits() ^ sign(quarter)),
        f64::from_bits(cosine.to_bits() ^ sign(quarter + 1)),
    )
}

impl super::Real for Fast {
    type Mask = bool;
    without_slopes!();
    const FORM: Option<super::Form> = Some(super::Form::of(super::Base::Fast));

    #[inline(always)]
    fn put(self, _: usize, words: &mut [f64]) {
        words[0] = self.0;
    }

    #[inline(always)]
    fn of_words(_: usize, words: &[f64]) -> Self {
        Fast(words[0])
    }

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Fast(value)
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.0
    }

    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Fast(super::Real::mul_add(self.0, a.0, b.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Fast(super::Real::sqrt(self.0))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = sin_cos(self.0);
        (Fast(sine), Fast(cosine))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Fast(super::Real::atan2(self.0, x.0))
    }

    #[inline(always)]
    fn exp(self) -> Self {
        Fast(super::Real::exp(self.0))
    }

    #[inline(always)]
    fn ln(self) -> Self {
        Fast(super::Real::ln(self.0))
    }

    #[inline(always)]
    fn powf(self, power: Self) -> Self {
        Fast(super::Real::powf(self.0, power.0))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Fast(self.0.abs())
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.0 < other.0
    }

    #[inline(always)]
    fn select(mask: bool, then: Self, otherwise: Self) -> Self {
        if mask { then } else { otherwise }
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}
