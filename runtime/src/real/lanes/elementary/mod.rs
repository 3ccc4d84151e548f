//! The elementary functions over any [`Doubles`], written once.
//!
//! | file | functions | largest error |
//! |---|---|---|
//! | `circle` | [`sin_cos`] | 1 ulp |
//! | `remainder` | the reduction of angles beyond 2¹⁶ | |
//! | `exponential` | [`exp`] | 1 ulp |
//! | `logarithm` | [`ln`] | 1 ulp |
//! | `power` | [`powf`] | 1 ulp |
//! | `angle` | [`atan2`] | 1 ulp |
//! | `widened` | all of them for singles, by doubles | 0.500 000 01 ulp of singles |
//!
//! `f64` and `f32` alone have them, too. They use only arithmetic, bits and selection. So a lane has the same bits in
//! every register and whatever its neighbours hold, and no library of the platform is called. If a rare argument needs
//! another algorithm, a branch checks whether any lane has one.
//!
//! The bounds also hold where products and sums are rounded one after the other, except for `atan2`, whose error is
//! then 2 ulp.

mod angle;
mod circle;
mod exponential;
mod logarithm;
mod power;
mod remainder;
mod singles;
#[cfg(test)]
mod tests;

use angle::atan2;
use circle::sin_cos;
use exponential::exp;
use logarithm::ln;
use power::powf;

use super::register::Doubles;

/// A type that has these functions, with the meaning that they have in [`Real`](crate::Real).
pub trait Elementary: Sized {
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`).
    fn atan2(self, x: Self) -> Self;
    fn powf(self, power: Self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
}

impl<R: Doubles> Elementary for R {
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        sin_cos(self)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        atan2(self, x)
    }

    #[inline(always)]
    fn powf(self, power: Self) -> Self {
        powf(self, power)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        exp(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        ln(self)
    }
}
