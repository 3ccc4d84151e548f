//! Sine, exponential and their like over any [`Register`](super::register::Register), written once.
//!
//! | file | functions | largest error |
//! |---|---|---|
//! | `circle` | [`sin_cos`] | 1 ulp |
//! | `far` | what is left of an angle beyond 2¹⁶ | |
//! | `exponential` | [`exp`] | 1 ulp |
//! | `logarithm` | [`ln`] | 1 ulp |
//! | `power` | [`powf`] | 1 ulp |
//! | `angle` | [`atan2`] | 1 ulp |
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

pub use angle::atan2;
pub use circle::sin_cos;
pub use exponential::exp;
pub use logarithm::ln;
pub use power::powf;
