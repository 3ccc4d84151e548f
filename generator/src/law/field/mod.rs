//! A uniform acceleration field.

pub(crate) mod check;
pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;
pub(crate) mod terms;

pub use check::*;
