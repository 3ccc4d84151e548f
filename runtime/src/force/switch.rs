//! Choices: one value where a < b, another elsewhere.

use crate::Real;

/// `then` where `a` < `b`, `otherwise` elsewhere. NaN where the comparison fails because one of them is not finite.
///
/// Both values are computed. The value that is not chosen has no effect, even if it is NaN.
#[inline(always)]
pub fn choose<T: Real>(a: T, b: T, then: T, otherwise: T) -> T {
    T::select(a.lt(b), then, otherwise + (a.taint() + b.taint()))
}
