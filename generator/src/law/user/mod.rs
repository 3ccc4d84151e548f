//! A force by a function of the user's.

pub(crate) mod check;
pub mod checked;
pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;

pub use checked::*;
