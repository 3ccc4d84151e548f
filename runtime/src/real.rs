//! The scalar that equations are evaluated over.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A real scalar, or several side by side.
///
/// Generated code and force laws are generic over it: `f64` and `f32` here; registers of several scenarios, dual numbers
/// and double-double fit the same trait, because nothing in it branches: comparison yields a [`Mask`], and a choice is a
/// [`select`](Real::select), made per lane.
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// Result of a comparison, one truth value per lane.
    type Mask: Mask;

    /// The nearest scalar to a constant, in every lane.
    fn from_f64(value: f64) -> Self;
    /// The value of the least favourable use for control of steps: of lanes the largest, of duals the real part.
    fn to_f64(self) -> f64;
    /// `self · a + b`, fused into one rounding where the target does that fast, two roundings elsewhere.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// (sin, cos).
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`), in (−π, π].
    fn atan2(self, x: Self) -> Self;
    /// The larger one; `other` where `self` is NaN is not promised.
    fn max(self, other: Self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `self < other`, per lane; false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `then` where the mask is true, `otherwise` elsewhere. Both are evaluated: neither may be NaN by accident.
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self;
    /// True where every lane is finite.
    fn is_finite(self) -> bool;
}

/// Truth values, one per lane.
pub trait Mask: Copy {
    /// True in at least one lane.
    fn any(self) -> bool;
    /// True in every lane.
    fn all(self) -> bool;
}
