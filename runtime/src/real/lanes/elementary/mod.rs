//! Sine, exponential and their like over any [`Doubles`](super::register::Doubles), written once.
//!
//! | file | functions | largest error |
//! |---|---|---|
//! | `circle` | [`sin_cos`] | 1 ulp |
//! | `far` | what is left of an angle beyond 2¹⁶ | |
//! | `exponential` | [`exp`] | 1 ulp |
//! | `logarithm` | [`ln`] | 1 ulp |
//! | `power` | [`powf`] | 1 ulp |
//! | `angle` | [`atan2`] | 1 ulp |
//! | `widened` | all of them for singles, by doubles | 0.500 000 01 ulp of singles |
//!
//! Everything is arithmetic, bits and selection, so that a lane has the same bits in every register and whatever its
//! neighbours hold, and nothing of the platform's library is called. Where a rare lane needs another way, a branch asks
//! whether there is any.
//!
//! Where products and sums are rounded one after the other, the bounds hold too, but for an angle's: that is 2 ulp then.

mod angle;
mod circle;
mod exponential;
mod far;
mod logarithm;
mod power;
#[cfg(test)]
mod tests;
mod widened;

use angle::atan2;
use circle::sin_cos;
use exponential::exp;
use logarithm::ln;
use power::powf;

use super::register::Doubles;

/// What has them, with the meaning that they have in [`Real`](crate::Real).
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
