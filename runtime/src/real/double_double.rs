//! Numbers of about 32 digits: an unevaluated sum hi + lo of two doubles, where lo is at most half a unit in the last
//! place of hi (Dekker 1971). They are for reference solutions, which must be exact and need not be quick.
//!
//! With u = 2⁻⁵³ the relative errors are bounded by (Joldes, Muller and Popescu, "Tight and rigorous error bounds for
//! basic building blocks of double-word arithmetic", 2017, algorithms 6, 10 and 17):
//!
//! | operation | bound |
//! |---|---|
//! | a + b, a − b | 3 u² + O(u³) |
//! | a · b | 7 u² |
//! | a / b | 15 u² |
//!
//! The bounds hold for products far from the ends of the range of doubles, between about 10⁻²⁹⁰ and 10²⁹⁰. Smaller
//! products lose the digits of lo. Overflow gives infinity or NaN in hi; lo is always finite.
//!
//! Nothing here needs the standard library or `libm`, and nothing calls a library. Operations of tens of instructions
//! are never inlined: generated models have thousands of them in a row, and as calls they compile nearly as quickly as
//! those of `f64`.

mod elementary;
#[cfg(test)]
mod tests;

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// hi + lo, with lo at most half a unit in the last place of hi: about 32 digits.
///
/// Sine and cosine are NaN beyond 2⁵⁰ rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    /// The number rounded to a double.
    hi: f64,
    /// The rest of the number.
    lo: f64,
}

impl DoubleDouble {
    const ZERO: Self = DoubleDouble { hi: 0.0, lo: 0.0 };
    const ONE: Self = DoubleDouble { hi: 1.0, lo: 0.0 };
    const NAN: Self = DoubleDouble {
        hi: f64::NAN,
        lo: 0.0,
    };

    /// `a` + `b`, exactly; infinite where that is beyond the range of doubles.
    pub const fn new(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, b);
        if hi.is_finite() {
            DoubleDouble { hi, lo }
        } else {
            DoubleDouble { hi, lo: 0.0 }
        }
    }

    /// \[hi, lo\]: the number rounded to a double, and the rest.
    pub const fn parts(self) -> [f64; 2] {
        [self.hi, self.lo]
    }

    /// `hi` + `lo`, where `lo` is the smaller one.
    #[inline(always)]
    const fn settled(hi: f64, lo: f64) -> Self {
        let (hi, lo) = quick_two_sum(hi, lo);
        DoubleDouble {
            hi,
            lo: if hi.is_finite() { lo } else { 0.0 },
        }
    }

    /// `self` / `n`, at compile time, `n` a whole number.
    const fn over(self, n: f64) -> Self {
        let quotient = self.hi / n;
        let (product, error) = two_product(quotient, n);
        let rest = ((self.hi - product) - error) + self.lo;
        DoubleDouble::settled(quotient, rest / n)
    }

    /// `self` · 2^`exponent`, exactly where it stays within the range of normal numbers; −2000 < `exponent` < 2000.
    fn scaled(self, exponent: i32) -> Self {
        let half = exponent / 2;
        let power = |n: i32| f64::from_bits(((n + 1023) as u64) << 52);
        let (a, b) = (power(half), power(exponent - half));
        DoubleDouble::settled(self.hi * a * b, self.lo * a * b)
    }
}

/// `a` + `b` = sum + error, exactly (Knuth).
#[inline(always)]
const fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// `a` + `b` = sum + error, exactly, where |a| ≥ |b| (Dekker).
#[inline(always)]
const fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// `a` · `b` = product + error, exactly, by halves whose products are exact (Dekker).
#[inline(always)]
const fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a_hi, a_lo), (b_hi, b_lo)) = (halves(a), halves(b));
    let error = ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo;
    (product, error)
}

/// `a` as a sum of two numbers of 26 bits (Veltkamp).
#[inline(always)]
const fn halves(a: f64) -> (f64, f64) {
    /// 2²⁷ + 1
    const SPLITTER: f64 = 134_217_729.0;
    /// Beyond it, the product with the splitter might overflow.
    const LARGE: f64 = 1e299;
    /// 2²⁸
    const DOWN: f64 = 268_435_456.0;
    if a.abs() > LARGE {
        let (hi, lo) = split(a / DOWN, SPLITTER);
        (hi * DOWN, lo * DOWN)
    } else {
        split(a, SPLITTER)
    }
}

#[inline(always)]
const fn split(a: f64, splitter: f64) -> (f64, f64) {
    let shifted = splitter * a;
    let hi = shifted - (shifted - a);
    (hi, a - hi)
}

impl Add for DoubleDouble {
    type Output = Self;

    #[inline(never)]
    fn add(self, other: Self) -> Self {
        let (sum, error) = two_sum(self.hi, other.hi);
        if !sum.is_finite() {
            return DoubleDouble { hi: sum, lo: 0.0 };
        }
        let (low, low_error) = two_sum(self.lo, other.lo);
        let (sum, error) = quick_two_sum(sum, error + low);
        DoubleDouble::settled(sum, error + low_error)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let (product, error) = two_product(self.hi, other.hi);
        if !product.is_finite() {
            return DoubleDouble {
                hi: product,
                lo: 0.0,
            };
        }
        DoubleDouble::settled(product, error + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let quotient = self.hi / other.hi;
        if quotient == 0.0 || !quotient.is_finite() {
            return DoubleDouble {
                hi: quotient,
                lo: 0.0,
            };
        }
        // the remainder of the division is a double
        let (product, error) = two_product(quotient, other.hi);
        let rest = ((self.hi - product) - error) + (self.lo - quotient * other.lo);
        DoubleDouble::settled(quotient, rest / other.hi)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        DoubleDouble {
            hi: -self.hi,
            lo: -self.lo,
        }
    }
}

impl AddAssign for DoubleDouble {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl super::Real for DoubleDouble {
    type Mask = bool;
    without_slopes!();
    const FORM: Option<super::Form> = Some(super::Form::of(super::Base::DoubleDouble));

    #[inline(always)]
    fn put(self, _: usize, words: &mut [f64]) {
        words[..2].copy_from_slice(&self.parts());
    }

    #[inline(always)]
    fn of_words(_: usize, words: &[f64]) -> Self {
        DoubleDouble {
            hi: words[0],
            lo: words[1],
        }
    }

    #[inline]
    fn from_f64(value: f64) -> Self {
        DoubleDouble { hi: value, lo: 0.0 }
    }

    #[inline]
    fn from_product(a: f64, b: f64) -> Self {
        Self::from_f64(a) * Self::from_f64(b)
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.hi + self.lo
    }

    #[inline(never)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }

    fn sqrt(self) -> Self {
        elementary::sqrt(self)
    }

    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }

    fn atan2(self, x: Self) -> Self {
        elementary::atan2(self, x)
    }

    fn exp(self) -> Self {
        elementary::exp(self)
    }

    fn ln(self) -> Self {
        elementary::ln(self)
    }

    fn powf(self, power: Self) -> Self {
        elementary::powf(self, power)
    }

    #[inline]
    fn abs(self) -> Self {
        if self.hi.is_sign_negative() {
            -self
        } else {
            self
        }
    }

    #[inline]
    fn lt(self, other: Self) -> bool {
        self.hi < other.hi || (self.hi == other.hi && self.lo < other.lo)
    }

    #[inline]
    fn select(mask: bool, then: Self, otherwise: Self) -> Self {
        if mask { then } else { otherwise }
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.hi.is_finite() && self.lo.is_finite()
    }
}
