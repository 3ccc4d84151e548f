//! The arithmetic of `f64` and `f32` that `core` lacks.
//!
//! Square roots and fused multiply-adds are correctly rounded everywhere, so they may come from the standard library or from `libm`. The elementary
//! functions are those of [`lanes`](super::lanes), with products and sums rounded one after the other: the same bits on every processor and system.
//! Those of the platform differ from one system to another.

use super::lanes::Alone;
use super::lanes::elementary::Elementary;

/// A number with the operations that it needs.
pub trait Plain: Sized {
    fn root(self) -> Self;
    /// `self` · `a` + `b` with one rounding: one instruction in code that is compiled for it, a slow function elsewhere.
    fn fused(self, a: Self, b: Self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn atan2(self, x: Self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn powf(self, power: Self) -> Self;
}

/// Implements [`Plain`], given the names of functions of `libm`.
macro_rules! plain {
    ($float:ident, $sqrt:ident, $fma:ident) => {
        impl Plain for $float {
            #[inline(always)]
            fn root(self) -> Self {
                #[cfg(any(feature = "std", test))]
                return $float::sqrt(self);
                #[cfg(not(any(feature = "std", test)))]
                return libm::$sqrt(self);
            }

            #[inline(always)]
            #[allow(clippy::disallowed_methods, reason = "it is asked for by name")]
            fn fused(self, a: Self, b: Self) -> Self {
                #[cfg(any(feature = "std", test))]
                return $float::mul_add(self, a, b);
                #[cfg(not(any(feature = "std", test)))]
                return libm::$fma(self, a, b);
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                let (sine, cosine) = Elementary::sin_cos(Alone::<$float, false>::of(self));
                (sine.number(), cosine.number())
            }

            // the others are long, and a law calls them often: each is compiled once, as a function of its own

            #[inline(never)]
            fn atan2(self, x: Self) -> Self {
                let [y, x] = [self, x].map(Alone::<$float, false>::of);
                Elementary::atan2(y, x).number()
            }

            #[inline(never)]
            fn exp(self) -> Self {
                Elementary::exp(Alone::<$float, false>::of(self)).number()
            }

            #[inline(never)]
            fn ln(self) -> Self {
                Elementary::ln(Alone::<$float, false>::of(self)).number()
            }

            #[inline(never)]
            fn powf(self, power: Self) -> Self {
                let [base, power] = [self, power].map(Alone::<$float, false>::of);
                Elementary::powf(base, power).number()
            }
        }
    };
}

plain!(f64, sqrt, fma);
plain!(f32, sqrtf, fmaf);
