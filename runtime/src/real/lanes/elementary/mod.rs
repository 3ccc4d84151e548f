//! Sine, exponential and their like over any [`Register`](super::register::Register), written once.
//!
//! | file | functions | largest error |
//! |---|---|---|
//! | `circle` | [`sin_cos`] | 1 ulp |
//! | `exponential` | [`exp`] | 1 ulp |
//! | `logarithm` | [`ln`] | 1 ulp |
//! | `power` | [`powf`] | 1 ulp |
//!
//! Everything is arithmetic, bits and selection, so that a lane has the same bits in every register and whatever its
//! neighbours hold, and nothing of the platform's library is called. Where a rare lane needs another way, a branch asks
//! whether there is any.
//!

mod circle;
mod exponential;
mod far;
mod logarithm;
mod power;
#[cfg(test)]
mod tests;

pub use circle::sin_cos;
pub use exponential::exp;
pub use logarithm::ln;
pub use power::powf;
