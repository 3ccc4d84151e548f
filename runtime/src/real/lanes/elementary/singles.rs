//! The elementary functions of singles: those of doubles, rounded once more. A register of singles needs two registers
//! of doubles.
//!
//! An error of 1 ulp of a double is 2⁻²⁹ ulp of a single, so the rounded result is within 0.5 + 2⁻²⁹ ulp of a single:
//! it is the nearest single, except in one of some hundred million cases. A double has all exponents of results, so
//! singles overflow or become subnormal only in the last rounding.

use super::Elementary;
#[cfg(target_arch = "aarch64")]
use crate::real::lanes::NeonSingles;
use crate::real::lanes::register::{Doubles, Singles};
#[cfg(target_arch = "x86_64")]
use crate::real::lanes::scalar_register::Emulated;
use crate::real::lanes::scalar_register::{Alone, Apart, Fused};
#[cfg(target_arch = "x86_64")]
use crate::real::lanes::{Avx2Singles, Avx512Singles};

impl<R: Doubles> Elementary for [R; 2] {
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let [low, high] = self;
        let (low, high) = (super::sin_cos(low), super::sin_cos(high));
        ([low.0, high.0], [low.1, high.1])
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        [super::atan2(self[0], x[0]), super::atan2(self[1], x[1])]
    }

    #[inline(always)]
    fn powf(self, power: Self) -> Self {
        let ([x, y], [p, q]) = (self, power);
        [super::powf(x, p), super::powf(y, q)]
    }

    #[inline(always)]
    fn exp(self) -> Self {
        [super::exp(self[0]), super::exp(self[1])]
    }

    #[inline(always)]
    fn ln(self) -> Self {
        [super::ln(self[0]), super::ln(self[1])]
    }
}

/// The functions of a register of singles.
macro_rules! by_doubles {
    ($register:ty) => {
        impl Elementary for $register {
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let (sine, cosine) = self.widened().sin_cos();
                (Self::narrowed(sine), Self::narrowed(cosine))
            }

            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                Self::narrowed(self.widened().atan2(x.widened()))
            }

            #[inline(always)]
            fn powf(self, power: Self) -> Self {
                Self::narrowed(self.widened().powf(power.widened()))
            }

            #[inline(always)]
            fn exp(self) -> Self {
                Self::narrowed(self.widened().exp())
            }

            #[inline(always)]
            fn ln(self) -> Self {
                Self::narrowed(self.widened().ln())
            }
        }
    };
}

by_doubles!(Alone<f32, Apart>);
by_doubles!(Alone<f32, Fused>);
#[cfg(target_arch = "x86_64")]
by_doubles!(Alone<f32, Emulated>);
#[cfg(target_arch = "x86_64")]
by_doubles!(Avx2Singles);
#[cfg(target_arch = "x86_64")]
by_doubles!(Avx512Singles);
#[cfg(target_arch = "aarch64")]
by_doubles!(NeonSingles);
