//! Powers: e^x in the law of a rope on a drum, a ratio of pressures to a power in the law of a gas.

use crate::Real;

/// `base` to the power `exponent`; `base` must not be negative.
#[inline(always)]
pub fn power<T: Real>(base: T, exponent: T) -> T {
    base.powf(exponent)
}
