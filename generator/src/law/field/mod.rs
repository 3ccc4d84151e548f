//! A uniform acceleration field.

pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;

pub use keys::Field;
