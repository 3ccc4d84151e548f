//! The numbers that step-size control and the search for events compute with: `f64` in a single run, a number for each
//! lane in a batch. A single run is the case of one lane, so both use the same formulas.

use super::{Mask, Real};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number, or one in each lane. `f64` is a [`Number`] even without a standard library, where it is no scalar of
/// models.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// [`Real::Mask`]
    type Mask: Mask;
    /// [`Real::from_f64`]
    fn from_f64(value: f64) -> Self;
    /// [`Real::lt`]
    fn lt(self, other: Self) -> Self::Mask;
    /// [`Real::select`]
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self;
    /// [`Real::abs`]
    fn abs(self) -> Self;

    /// [`Real::max`]
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }

    /// [`Real::min`]
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }
}

impl<T: Real> Number for T {
    type Mask = <T as Real>::Mask;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        <T as Real>::from_f64(value)
    }

    #[inline(always)]
    fn lt(self, other: Self) -> <T as Real>::Mask {
        Real::lt(self, other)
    }

    #[inline(always)]
    fn select(mask: <T as Real>::Mask, then: Self, otherwise: Self) -> Self {
        <T as Real>::select(mask, then, otherwise)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Real::abs(self)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Real::max(self, other)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Real::min(self, other)
    }
}

#[cfg(not(any(feature = "std", feature = "libm", test)))]
impl Number for f64 {
    type Mask = bool;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn select(mask: bool, then: Self, otherwise: Self) -> Self {
        if mask { then } else { otherwise }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
}
